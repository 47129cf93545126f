// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/render.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "exitance/render/automatic_view.h"
#include "exitance/render/camera_rays.h"
#include "render/lamp_room.h"

namespace exitance {
namespace {

constexpr double pi = std::numbers::pi;

Camera camera_at(const Vec3& eye, const Vec3& look_at, double fov = 60) {
    Camera camera;
    camera.eye = eye;
    camera.look_at = look_at;
    camera.fov_y = fov;
    return camera;
}

/// A wall at z = 0 from −2 to 2, facing +z, whose irradiance is 10 + 3 x + 2 y times 1, 2, 3.
Solution linear_wall() {
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.25, 0.1}, {1, 0, 0});
    hand_made::add_sheet(s, "wall", grey, 0, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, 3, 5,
                         [](const Vec3& p, const Vec3&) {
                             const auto H = static_cast<float>(10 + 3 * p.x + 2 * p.y);
                             return std::vector<float>{H, 2 * H, 3 * H};
                         });
    return s;
}

TEST(Render, radiance_of_a_wall_is_exact) {
    const Solution s = linear_wall();
    const Surfaces surfaces(s, Backs::open);
    // 90 degrees from 1 m away: pixel (x, y) sees the wall at (2x/n − 1, 1 − 2y/n).
    const Camera camera = camera_at({0, 0, 1}, {0, 0, 0}, 90);
    const Image image = render_radiance(surfaces, camera, {32, 32}, {.samples = 64});
    for (std::uint32_t j = 0; j < 32; ++j)
        for (std::uint32_t i = 0; i < 32; ++i) {
            const double x = (i + 0.5) / 16 - 1, y = 1 - (j + 0.5) / 16;
            const double H = 10 + 3 * x + 2 * y;
            // A linear picture is not changed by a symmetric filter, but for the sampling of its
            // centre: 64 stratified positions, each off by half a pixel = 1/32 m, average to 1 %.
            EXPECT_NEAR(image.at(i, j).x, (1 + 0.5 * H) / pi, 0.005);
            EXPECT_NEAR(image.at(i, j).y, 0.25 * 2 * H / pi, 0.005);
            EXPECT_NEAR(image.at(i, j).z, 0.1 * 3 * H / pi, 0.005);
        }
}

TEST(Render, backs_do_not_show_and_nothing_is_black) {
    Solution s = linear_wall();
    const auto black = hand_made::add_material(s, "screen", {0, 0, 0});
    // In front of the wall, facing away from the camera.
    hand_made::add_sheet(s, "screen", black, 0, {-2, -2, 0.5}, {0, 4, 0}, {4, 0, 0}, 1, 1,
                         hand_made::uniform(s, 0));
    const Surfaces surfaces(s, Backs::open);
    const Image front = render_radiance(surfaces, camera_at({0, 0, 1}, {}), {8, 8}, {});
    for (const Vec3f& pixel : front.pixels) EXPECT_GT(pixel.x, 0.5f);
    const Image away = render_radiance(surfaces, camera_at({0, 0, 1}, {0, 0, 2}), {8, 8}, {});
    for (const Vec3f& pixel : away.pixels) EXPECT_EQ(pixel, Vec3f{});
    // From behind, the screen hides the wall, whose back does not show either.
    const Image behind = render_radiance(surfaces, camera_at({0, 0, -1}, {}), {8, 8}, {});
    for (const Vec3f& pixel : behind.pixels) EXPECT_EQ(pixel, Vec3f{});
}

TEST(Render, groups_are_dimmed_by_name) {
    const Solution s = hand_made::lamp_room(8);
    const Surfaces surfaces(s, Backs::open);
    const auto mean = [&](const RenderOptions& options) {
        Vec3 sum;
        for (const Vec3f& p : render_radiance(surfaces, s.cameras[0], {24, 24}, options).pixels)
            sum += Vec3(p) / 576;
        return sum;
    };
    const Vec3 both = mean({}), lamp = mean({.group_weights = {{"glow", 0}}}),
               glow = mean({.group_weights = {{"lamp", 0}}}),
               half = mean({.group_weights = {{"lamp", 0.5}}});
    for (std::size_t i = 0; i < 3; ++i) {
        // Light is linear; sums of 9216 floats.
        EXPECT_NEAR(both[i], lamp[i] + glow[i], 1e-5 * both[i]);
        EXPECT_NEAR(half[i], 0.5 * lamp[i] + glow[i], 1e-5 * both[i]);
        EXPECT_GT(lamp[i], 0);
        EXPECT_GT(glow[i], 0);
    }
    EXPECT_THROW(mean({.group_weights = {{"lamb", 1}}}), Error);
}

TEST(Render, edges_are_smooth) {
    const Solution s = linear_wall();
    const Surfaces surfaces(s, Backs::open);
    // The wall's edge x = 2 crosses the picture: brightness falls monotonically to nothing.
    const Camera camera = camera_at({2, 0, 2}, {2, 0, 0}, 30);
    const Image image = render_radiance(surfaces, camera, {21, 21}, {.samples = 256});
    const float whole = image.at(8, 10).x;
    EXPECT_NEAR(image.at(10, 10).x, whole / 2, 0.05f * whole);
    EXPECT_GT(image.at(9, 10).x, 0.8f * whole);
    EXPECT_LT(image.at(11, 10).x, 0.2f * whole);
    EXPECT_EQ(image.at(13, 10).x, 0.0f);
}

TEST(Render, same_seed_same_picture) {
    const Solution s = hand_made::lamp_room(8);
    const Surfaces surfaces(s, Backs::open);
    const RenderOptions options{.samples = 5, .wireframe = true, .normals = true};
    const Image a = render_display(surfaces, s.cameras[0], {70, 50}, options);
    const Image b = render_display(surfaces, s.cameras[0], {70, 50}, options);
    EXPECT_EQ(a.pixels, b.pixels);
}

TEST(Render, false_colours_tell_the_value) {
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    hand_made::add_sheet(s, "wall", grey, 0, {-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, 1, 1,
                         hand_made::uniform(s, 40));
    const Surfaces surfaces(s, Backs::open);
    const Camera camera = camera_at({0, 0, 1}, {});
    const auto centre = [&](const char* quantity, double low, double high) {
        RenderOptions options;
        options.false_colour = quantity;
        options.range = {{low, high}};
        return render_display(surfaces, camera, {64, 64}, options).at(10, 32);
    };
    const auto expect_same = [](const Vec3f& a, const Vec3f& b) {
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-5f);
    };
    expect_same(centre("irradiance", 0, 80), centre("exitance", 0, 40));
    expect_same(centre("irradiance", 0, 40), centre("irradiance", 0, 10));
    EXPECT_GT(centre("irradiance", 0, 40).x, centre("irradiance", 0, 100).x);
    EXPECT_THROW(centre("irradiance", 5, 5), Error);
}

TEST(Render, wireframe_marks_edges_only) {
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    hand_made::add_sheet(s, "wall", grey, 0, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 1, 1,
                         hand_made::uniform(s, 1));
    const Surfaces surfaces(s, Backs::open);
    const Camera camera = camera_at({0, 0, 1}, {}, 90);
    const RenderOptions plain{.samples = 64};
    RenderOptions lined = plain;
    lined.wireframe = true;
    const Image without = render_display(surfaces, camera, {40, 40}, plain);
    const Image with = render_display(surfaces, camera, {40, 40}, lined);
    // The diagonal runs from the lower left to the upper right.
    EXPECT_GT(length(with.at(20, 19) - without.at(20, 19)), 0.02f);
    EXPECT_EQ(with.at(10, 10), without.at(10, 10));
    EXPECT_EQ(with.at(30, 30), without.at(30, 30));
}

TEST(CameraRays, project_undoes_direction) {
    const CameraRays rays(camera_at({1, 2, 3}, {-2, 0, 1}, 50), 640, 480);
    for (const double x : {0.5, 320.0, 600.0})
        for (const double y : {3.0, 240.0, 470.0}) {
            const auto back = rays.project(rays.eye() + rays.direction(x, y) * 7.0);
            ASSERT_TRUE(back.has_value());
            EXPECT_NEAR((*back)[0], x, 1e-9);
            EXPECT_NEAR((*back)[1], y, 1e-9);
        }
    EXPECT_FALSE(rays.project(rays.eye() - rays.direction(320, 240)).has_value());
    // A line through two points keeps its distance to the image of a third.
    const Vec3 a = rays.eye() + rays.direction(100, 50) * 2.0,
               b = rays.eye() + rays.direction(100, 400) * 5.0;
    EXPECT_NEAR(rays.distance_to_line(130, 200, a, b), 30, 1e-9);
    EXPECT_THROW(CameraRays(camera_at({1, 1, 1}, {1, 1, 1}), 4, 4), Error);
    EXPECT_THROW(CameraRays(camera_at({}, {1, 1, 1}, 180), 4, 4), Error);
}

TEST(AutomaticView, stands_inside_a_room_and_outside_a_body) {
    Solution room = hand_made::empty_solution();
    const auto grey = hand_made::add_material(room, "grey", {0.5, 0.5, 0.5});
    hand_made::add_room(room, grey, {0, 0, 0}, {4, 3, 5}, 2, hand_made::uniform(room, 1));
    Solution body = room;
    for (auto& t : body.triangles) std::swap(t[1], t[2]);
    const auto covered = [](const Solution& s, const Camera& camera) {
        const Surfaces surfaces(s, Backs::open);
        int lit = 0;
        for (const Vec3f& p : render_radiance(surfaces, camera, {20, 15}, {}).pixels)
            lit += p.x > 0 ? 1 : 0;
        return lit / 300.0;
    };
    const Camera inside = automatic_view(Surfaces(room, Backs::open), {0, 1, 0});
    EXPECT_GT(inside.eye.x, 0);
    EXPECT_LT(inside.eye.x, 4);
    EXPECT_GT(inside.eye.z, 0);
    EXPECT_LT(inside.eye.z, 5);
    EXPECT_EQ(covered(room, inside), 1);
    const Camera outside = automatic_view(Surfaces(body, Backs::open), {0, 1, 0});
    EXPECT_GT(length(outside.eye - Vec3{2, 1.5, 2.5}), 5);
    EXPECT_GT(covered(body, outside), 0.2);
    EXPECT_LT(covered(body, outside), 0.95);
}

TEST(RenderOptions, sizes) {
    EXPECT_EQ(parse_size("1280x720").width, 1280u);
    EXPECT_EQ(parse_size("1280x720").height, 720u);
    for (const char* bad : {"", "1280", "x", "0x5", "5x0", "-5x5", "5x5x5", "99999x5", "5 x 5",
                            "99999999999999999999x5"})
        EXPECT_THROW(parse_size(bad), Error) << bad;
    Camera wide;
    wide.aspect = 2;
    EXPECT_EQ(size_of_picture({}, wide).width, 1536u);
}

}  // namespace
}  // namespace exitance
