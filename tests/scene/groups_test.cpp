// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/groups.h"

#include <gtest/gtest.h>

#include "scene/small_scenes.h"

namespace exitance {
namespace {

// Surfaces: wall (dark), lamp a and lamp b of group "desk", sign without a group.
Scene three_emitters() {
    Scene scene;
    testing::add_surface(scene, "wall");
    testing::add_surface(scene, "lamp a", 0, 1);
    testing::add_surface(scene, "sign", 0, 1);
    testing::add_surface(scene, "lamp b", 0, 1);
    scene.materials[1].group = scene.materials[3].group = "desk";
    scene.surfaces.push_back({"second sign", 2, false, {}});
    return scene;
}

std::vector<std::string> names(const LightGroups& groups) {
    std::vector<std::string> out;
    for (const LightGroup& group : groups.groups) out.push_back(group.name);
    return out;
}

using Names = std::vector<std::string>;
using Indices = std::vector<std::uint32_t>;

TEST(Groups, NonePutsAllLightTogether) {
    const LightGroups groups = make_groups(three_emitters(), Grouping::none);
    EXPECT_EQ(names(groups), Names{"all"});
    EXPECT_EQ(groups.group_of_surface, (Indices{0, 0, 0, 0, 0}));
}

TEST(Groups, FileFollowsTheNamesOfTheFile) {
    const LightGroups groups = make_groups(three_emitters(), Grouping::file);
    EXPECT_EQ(names(groups), (Names{"desk", "light"}));
    EXPECT_EQ(groups.group_of_surface, (Indices{0, 0, 1, 0, 1}));
}

TEST(Groups, MaterialAndLuminaireSplitFurther) {
    EXPECT_EQ(names(make_groups(three_emitters(), Grouping::material)),
              (Names{"lamp a", "sign", "lamp b"}));
    const LightGroups each = make_groups(three_emitters(), Grouping::luminaire);
    EXPECT_EQ(names(each), (Names{"lamp a", "sign", "lamp b", "second sign"}));
    EXPECT_EQ(each.group_of_surface, (Indices{0, 0, 1, 2, 3}));
}

TEST(Groups, ADarkSceneStillHasOne) {
    Scene scene;
    testing::add_surface(scene, "wall");
    EXPECT_EQ(names(make_groups(scene, Grouping::luminaire)), Names{"all"});
}

}  // namespace
}  // namespace exitance
