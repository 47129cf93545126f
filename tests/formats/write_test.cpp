// SPDX-License-Identifier: Apache-2.0
// What is written is read back and is the same, as far as the format can carry it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "exitance/scene/formats/afit.h"
#include "exitance/scene/formats/afit_reflectance.h"
#include "exitance/scene/formats/write_scene.h"
#include "exitance/scene/merge.h"
#include "exitance/scene/read.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::Folder;

// A red floor of 2 × 3 m, a grey gable of 1 m² with a smooth normal, and a lamp of 0.5 m² that
// faces down, 2 m up.
Scene room() {
    Scene scene;
    scene.title = "room";
    scene.quantity = Quantity::photometric;
    const auto material = [&](const char* name, Spectrum rho, Spectrum e, bool two_sided) {
        Material m;
        m.name = name;
        m.reflectance = std::move(rho);
        m.exitance = std::move(e);
        m.two_sided = two_sided;
        return scene.add_material(std::move(m));
    };
    const auto red = material("red", {0.6, 0.1, 0.05}, {0, 0, 0}, false);
    const auto grey = material("grey", {0.5, 0.5, 0.5}, {0, 0, 0}, true);
    const auto lamp = material("lamp", {0, 0, 0}, {1000, 800, 600}, false);
    const auto polygon = [&](std::uint32_t surface, const std::vector<Vec3>& corners,
                             const Vec3& normal = {}) {
        Polygon p;
        for (std::size_t i = 0; i < corners.size(); ++i)
            p.corners[i] = scene.add_point(corners[i], normal);
        p.surface = surface;
        scene.polygons.push_back(p);
    };
    polygon(scene.add_surface("room/floor", red), {{0, 0, 0}, {0, 0, 3}, {2, 0, 3}, {2, 0, 0}});
    polygon(scene.add_surface("gable", grey), {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}},
            normalized(Vec3{0, 0.1, 1}));
    polygon(scene.add_surface("lamp", lamp), {{0, 2, 0}, {1, 2, 0}, {1, 2, .5}, {0, 2, .5}});
    Camera camera;
    camera.name = "door";
    camera.eye = {1, 1, 5};
    camera.look_at = {1, 1, 0};
    camera.fov_y = 40;
    camera.aspect = 1.5;
    scene.cameras.push_back(camera);
    return scene;
}

struct Facts {
    double area = 0, flux = 0;
    Spectrum reflectance;
};

// By name of material: area, flux (in lm or as numbers), reflectance.
std::map<std::string, Facts> facts(const Scene& scene) {
    std::map<std::string, Facts> out;
    for (const Polygon& polygon : scene.polygons) {
        const Material& m = scene.material(polygon);
        Facts& f = out[m.name];
        f.area += scene.area(polygon);
        f.flux += scene.area(polygon) * luminance(m.exitance) *
                  (scene.quantity == Quantity::radiometric ? luminous_efficacy : 1);
        f.reflectance = m.reflectance;
    }
    return out;
}

std::set<std::string> names(const Scene& scene) {
    std::set<std::string> out;
    for (const Surface& surface : scene.surfaces) out.insert(surface.name);
    return out;
}

bool told(const std::vector<std::string>& lost, const std::string& words) {
    return std::any_of(lost.begin(), lost.end(), [&](const std::string& line) {
        return line.find(words) != std::string::npos;
    });
}

void expect_same(const std::map<std::string, Facts>& a, const std::map<std::string, Facts>& b,
                 double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (const auto& [name, facts] : a) {
        ASSERT_TRUE(b.contains(name)) << name;
        const Facts& other = b.at(name);
        EXPECT_NEAR(other.area, facts.area, tolerance * facts.area) << name;
        EXPECT_NEAR(other.flux, facts.flux, tolerance * facts.flux) << name;
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(other.reflectance[i], facts.reflectance[i], tolerance) << name;
    }
}

struct Written {
    Scene scene;
    std::vector<std::string> lost;
};

Written written(const std::string& name) {
    const Folder folder;
    Written out;
    const auto path = folder.path() / name;
    out.lost = write_scene(room(), path);
    out.scene = read_scene(path);
    return out;
}

void expect_camera(const Scene& scene) {
    ASSERT_EQ(scene.cameras.size(), 1U);
    const Camera& camera = scene.cameras[0];
    EXPECT_NEAR(length(camera.eye - Vec3(1, 1, 5)), 0, 1e-12);
    EXPECT_NEAR(length(normalized(camera.look_at - camera.eye) - Vec3(0, 0, -1)), 0, 1e-12);
    EXPECT_NEAR(camera.fov_y, 40, 1e-9);
    EXPECT_NEAR(camera.aspect.value(), 1.5, 1e-9);
}

void expect_normals(const Scene& scene) {
    // Turned with what is up: y in the room, z in MGF.
    const bool z_up = scene.up == Vec3{0, 0, 1};
    const Vec3 expected = normalized(z_up ? Vec3{0, -1, 0.1} : Vec3{0, 0.1, 1});
    std::size_t smooth = 0;
    for (const Polygon& polygon : scene.polygons)
        for (const std::uint32_t i : polygon.indices())
            smooth += length(scene.normals[i] - expected) < 1e-6;
    EXPECT_EQ(smooth, 3U);
}

TEST(Write, GltfKeepsNamesMaterialsLightAndCameras) {
    for (const char* name : {"t.glb", "t.gltf"}) {
        const auto [scene, lost] = written(name);
        expect_same(facts(room()), facts(scene), 1e-6);  // float
        EXPECT_EQ(names(scene), names(room()));
        EXPECT_EQ(scene.quantity, Quantity::photometric);
        EXPECT_FALSE(scene.materials[0].two_sided);
        EXPECT_TRUE(scene.materials[1].two_sided);
        EXPECT_EQ(scene.cameras.at(0).name, "door");
        expect_camera(scene);
        expect_normals(scene);
        EXPECT_TRUE(scene.warnings.empty());
        EXPECT_EQ(lost, std::vector<std::string>{"2 quads become two triangles each"});
    }
}

TEST(Write, ObjKeepsNamesAndMaterials) {
    const auto [scene, lost] = written("t.obj");
    expect_same(facts(room()), facts(scene), 1e-6);  // Assimp's float
    EXPECT_EQ(names(scene), names(room()));
    EXPECT_EQ(scene.polygons.size(), room().polygons.size());
    expect_normals(scene);
    EXPECT_TRUE(told(lost, "1 one-sided material becomes"));
    EXPECT_TRUE(told(lost, "1 camera is left out"));
    EXPECT_TRUE(told(lost, "lm/m², is lost"));
}

TEST(Write, AfitKeepsTheFirstCamera) {
    const auto [scene, lost] = written("t.geom");
    auto expected = facts(room());
    expected = {{"attribute 1", expected["red"]},
                {"attribute 2", expected["grey"]},
                {"attribute 3", expected["lamp"]}};
    expect_same(expected, facts(scene), 1e-15);
    expect_camera(scene);
    expect_normals(scene);
    EXPECT_TRUE(told(lost, "names of materials are lost"));
    EXPECT_TRUE(told(lost, "1 one-sided material becomes"));  // the grey one is two-sided
}

TEST(Write, MgfKeepsColoursThroughTheirChromaticity) {
    const auto [scene, lost] = written("t.mgf");
    expect_same(facts(room()), facts(scene), 1e-9);
    EXPECT_EQ(names(scene), names(room()));
    EXPECT_EQ(scene.quantity, Quantity::photometric);
    EXPECT_FALSE(scene.materials[0].two_sided);
    EXPECT_TRUE(scene.materials[1].two_sided);
    expect_normals(scene);
    EXPECT_EQ(lost, std::vector<std::string>{"1 camera is left out"});
}

TEST(Write, WhatIsUpStaysUp) {
    const Folder folder;
    for (const char* name : {"t.mgf", "t.rad"}) {
        const Scene scene = written(name).scene;
        EXPECT_EQ(scene.up, Vec3(0, 0, 1));
        EXPECT_EQ(scene.bounds().upper, Vec3(2, 0, 2));  // the lamp hangs 2 m above
        EXPECT_EQ(scene.bounds().lower, Vec3(0, -3, 0));
        write_scene(scene, folder.path() / "back.glb");
        const Scene back = read_scene(folder.path() / "back.glb");
        EXPECT_EQ(back.bounds().upper, Vec3(2, 2, 3));
        EXPECT_EQ(back.bounds().lower, Vec3(0, 0, 0));
    }
}

TEST(Write, RadianceKeepsFluxAtItsEfficacy) {
    const auto [scene, lost] = written("t.rad");
    expect_same(facts(room()), facts(scene), 1e-12);
    EXPECT_EQ(names(scene), names(room()));
    EXPECT_EQ(scene.quantity, Quantity::radiometric);
    EXPECT_TRUE(told(lost, "written as W/m² at 179 lm/W"));
    EXPECT_TRUE(told(lost, "3 shading normals are lost"));
}

TEST(Write, MirrorsAndGlassInMgfAndRadiance) {
    Scene scene = room();
    Material& grey = scene.materials[1];
    grey.specular = {0.1, 0.1, 0.1};
    grey.roughness = 0.05;
    grey.reflectance = {0.2, 0.2, 0.2};
    grey.transmittance = {0.3, 0.3, 0.3};
    grey.diffuse_transmittance = {0.1, 0.1, 0.1};
    const Folder folder;
    for (const char* name : {"t.mgf", "t.rad"}) {
        write_scene(scene, folder.path() / name);
        const Scene back = read_scene(folder.path() / name);
        const Material& m = back.materials.at(1);
        for (std::size_t b = 0; b < 3; ++b) {
            EXPECT_NEAR(m.reflectance[b], 0.2, 1e-9);
            EXPECT_NEAR(m.specular[b], 0.1, 1e-9);
            EXPECT_NEAR(m.transmittance[b], 0.3, 1e-9);
            EXPECT_NEAR(m.diffuse_transmittance[b], 0.1, 1e-9);
        }
        EXPECT_NEAR(m.roughness, 0.05, 1e-12);
    }
    const auto lost = write_scene(scene, folder.path() / "t.glb");
    EXPECT_TRUE(told(lost, "1 material loses its mirror-like reflection"));
    EXPECT_TRUE(told(lost, "1 material loses its transmittance"));
}

TEST(Write, OpacityInObj) {
    Scene scene = room();
    scene.materials[1].reflectance = {0.1, 0.2, 0.3};
    scene.materials[1].transmittance = {0.6, 0.6, 0.6};
    const Folder folder;
    write_scene(scene, folder.path() / "t.obj");
    const Scene back = read_scene(folder.path() / "t.obj");
    const auto grey = std::find_if(back.materials.begin(), back.materials.end(),
                                   [](const Material& m) { return m.name == "grey"; });
    ASSERT_NE(grey, back.materials.end());
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_NEAR(grey->reflectance[b], scene.materials[1].reflectance[b], 1e-6);
        EXPECT_NEAR(grey->transmittance[b], 0.6, 1e-6);
    }
}

TEST(Write, NamesBecomeWordsThatAreDifferent) {
    Scene scene = room();
    scene.materials[0].name = "old oak";
    scene.materials[1].name = "old_oak";
    const Folder folder;
    const auto lost = write_scene(scene, folder.path() / "t.mgf");
    const Scene back = read_scene(folder.path() / "t.mgf");
    EXPECT_EQ(back.materials.at(0).name, "old_oak");
    EXPECT_EQ(back.materials.at(1).name, "old_oak_2");
    EXPECT_TRUE(told(lost, "2 names of materials are changed"));
}

TEST(Write, DisplayFilesAreReadBack) {
    AfitDisplay display;
    display.comment = "a comment";
    display.eye = {1, 2, 3};
    display.look_at = {0, 0, 0.1};
    display.fov_x = 50;
    display.fov_y = 30;
    display.near = 0.1;
    display.far = 20;
    display.width = 320;
    display.height = 200;
    display.diameter = 2;
    display.ambient = true;
    display.threshold = 0.5;
    std::ostringstream text;
    write_afit_display(display, text);
    const AfitDisplay back = parse_afit_display("t.display", text.str());
    EXPECT_EQ(back.comment, display.comment);
    EXPECT_EQ(back.eye, display.eye);
    EXPECT_EQ(back.look_at, display.look_at);
    EXPECT_EQ(back.up, display.up);
    EXPECT_EQ(back.fov_x, 50);
    EXPECT_EQ(back.fov_y, 30);
    EXPECT_EQ(back.near, 0.1);
    EXPECT_EQ(back.far, 20);
    EXPECT_EQ(back.width, 320U);
    EXPECT_EQ(back.height, 200U);
    EXPECT_EQ(back.diameter, 2);
    EXPECT_EQ(back.ambient, true);
    EXPECT_EQ(back.threshold, 0.5);
}

TEST(AfitReflectance, IsReadAndWritten) {
    const std::string text = "lval 2 Ks 0.25 Kd 0.5\n0.125\n0.25\n-0.5\n";
    const AfitReflectance read = parse_afit_reflectance("1.reflectance", text);
    EXPECT_EQ(read.specular, 0.25);
    EXPECT_EQ(read.diffuse, 0.5);
    EXPECT_EQ(read.coefficients, (std::vector<double>{0.125, 0.25, -0.5}));
    std::ostringstream out;
    write_afit_reflectance(read, out);
    EXPECT_EQ(out.str(), text);
    const auto expect = [](const std::string& bad, const std::string& place,
                           const std::string& words) {
        expect_refused([&] { parse_afit_reflectance("r", bad); }, place, words);
    };
    expect("", "r:1:1", "lval");
    expect("lval 2000000000 Ks 0 Kd 1\n", "r:1:6", "the highest degree");
    expect("lval 1 Ks .6 Kd .6\n", "r:1:17", "at most 1");
    expect("lval 1 Ks .6 Kd .4\n1\n", "r:3:1", "a_1 of a_1");
    expect("lval 0 Ks .6 Kd .4\nnan\n", "r:2:1", "a_0");
    expect("lval 0 Ks .6 Kd .4\n1\n2\n", "r:3:1", "the end of the file");
}

TEST(AfitReflectance, SharesTheColourOfItsMaterial) {
    const std::string geometry =
        "t\nccw\npoints 3 patches 1 attributes 2\n0 0 0\n1 0 0\n0 1 0\n3 1 2 3\n"
        "color .8 .4 .2 material 7\ncolor .5 .5 .5 material 8\n";
    const Folder folder;
    folder.write("7.reflectance", "lval 0 Ks 0.25 Kd 0.5\n1\n");
    const Scene scene = read_scene(folder.write("t.geom", geometry));
    EXPECT_EQ(scene.materials[0].reflectance, (Spectrum{0.4, 0.2, 0.1}));
    EXPECT_EQ(scene.materials[0].specular, (Spectrum{0.2, 0.1, 0.05}));
    EXPECT_EQ(scene.materials[1].reflectance, (Spectrum{0.5, 0.5, 0.5}));
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].what.find("no 8.reflectance"), std::string::npos);
    folder.write("t.7.reflectance", "lval 0 Ks 0 Kd 1\n1\n");  // the closer name
    EXPECT_EQ(read_scene(folder.path() / "t.geom").materials[0].reflectance,
              (Spectrum{0.8, 0.4, 0.2}));
}

}  // namespace
}  // namespace exitance
