// SPDX-License-Identifier: Apache-2.0
#include "exitance/solution/file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "exitance/run/error.h"
#include "exitance/run/random.h"
#include "scene/lamps.h"
#include "solution/hand_made.h"

namespace exitance {
namespace {

namespace fs = std::filesystem;

class SolutionFile : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() /
                  ("exitance_file_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void put_bytes(const fs::path& path, const std::string& bytes) {
    fs::remove(path);  // some file systems wait for the disk when a file is written over
    std::ofstream(path, std::ios::binary) << bytes;
}

hand_made::Light noise(const Solution& s) {
    return [columns = s.columns()](const Vec3& p, const Vec3&) {
        std::vector<float> H(columns);
        const auto place = static_cast<std::uint64_t>(p.x * 1000 + p.y * 7919 + p.z * 104729);
        for (std::size_t c = 0; c < columns; ++c)
            H[c] = static_cast<float>(100 * uniform(place, c));
        return H;
    };
}

/// Two groups, three materials of which one is black in blue and one emits; a camera and a grid.
Solution small_solution(std::vector<std::string> bands = {"R", "G", "B"}) {
    Solution s = hand_made::empty_solution({{"lamp", 0.75}, {"sun", 1.5}}, std::move(bands));
    const auto fill = [&](std::initializer_list<double> start) {
        Spectrum out(start);
        out.resize(s.bands.size(), 0.5);
        return out;
    };
    const auto white = hand_made::add_material(s, "white", fill({0.8, 0.75, 0.7}));
    const auto red = hand_made::add_material(s, "red", fill({0.6, 0.02, 0.0}));
    const auto lamp =
        hand_made::add_material(s, "lamp", fill({0.5, 0.5, 0.5}), fill({1000, 900, 800}));
    const auto light = noise(s);
    hand_made::add_sheet(s, "floor", white, 0, {0, 0, 0}, {0, 0, 2}, {3, 0, 0}, 2, 3, light);
    hand_made::add_sheet(s, "curtain", red, 0, {0, 0, 0}, {3, 0, 0}, {0, 2.5, 0}, 2, 2, light);
    hand_made::add_sheet(s, "wall", white, 0, {0, 0, 0}, {0, 2.5, 0}, {0, 0, 2}, 1, 2, light);
    hand_made::add_sheet(s, "lamp", lamp, 1, {1, 2, 1}, {0.5, 0, 0}, {0, 0, 0.5}, 1, 1, light);
    Camera camera;
    camera.name = "door";
    camera.eye = {1.1, 1.6, 1.9};
    camera.look_at = {0.3, 0.2, 0.1};
    camera.fov_y = 61.7;
    camera.aspect = 1.5;
    s.cameras.push_back(camera);
    SensorGrid grid;
    grid.name = "desk";
    grid.origin = {0.1, 0.75, 0.1};
    grid.u = {1, 0, 0};
    grid.v = {0, 0, 1};
    grid.normal = {0, 1, 0};
    grid.columns = 7;
    grid.rows = 5;
    s.grids.push_back(grid);
    s.energy = {10, 6, 1, 2.5, 0.5};
    s.error = ErrorEstimate{0.0123, 0.001, 256};
    s.options = {{"error", "0.02"}, {"solver", "shooting"}};
    s.counters = {{"rays", 123456789.0}, {"shots", 17}};
    return s;
}

/// The place, light and exitance of every triangle corner, in the order of parts and triangles.
struct Corner {
    Vec3f position, normal;
    std::vector<float> H, B;
};
std::vector<Corner> corners_of(const Solution& s) {
    std::vector<Corner> out;
    for (const SolutionPart& part : s.parts)
        for (std::uint32_t t = 0; t < part.triangles; ++t)
            for (const std::uint32_t v : s.triangles[part.first_triangle + t]) {
                const auto H = s.irradiance[VertexId(v)];
                std::vector<float> B(s.columns());
                s.exitance(v, part, B);
                out.push_back({s.positions[v],
                               s.normals[v],
                               {H.begin(), H.begin() + std::ptrdiff_t(s.columns())},
                               B});
            }
    return out;
}

void expect_same(const Solution& a, const Solution& b) {
    EXPECT_EQ(a.title, b.title);
    EXPECT_EQ(a.quantity, b.quantity);
    EXPECT_EQ(a.bands, b.bands);
    ASSERT_EQ(a.groups.size(), b.groups.size());
    for (std::size_t g = 0; g < a.groups.size(); ++g) {
        EXPECT_EQ(a.groups[g].name, b.groups[g].name);
        EXPECT_EQ(a.groups[g].weight, b.groups[g].weight);
    }
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t p = 0; p < a.parts.size(); ++p) {
        EXPECT_EQ(a.parts[p].name, b.parts[p].name);
        EXPECT_EQ(a.parts[p].material, b.parts[p].material);
        EXPECT_EQ(a.parts[p].group, b.parts[p].group);
        EXPECT_EQ(a.parts[p].first_triangle, b.parts[p].first_triangle);
        EXPECT_EQ(a.parts[p].triangles, b.parts[p].triangles);
    }
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t m = 0; m < a.materials.size(); ++m) {
        EXPECT_EQ(a.materials[m].name, b.materials[m].name);
        EXPECT_EQ(a.materials[m].reflectance, b.materials[m].reflectance);
        EXPECT_EQ(a.materials[m].exitance, b.materials[m].exitance);
    }
    const auto ca = corners_of(a), cb = corners_of(b);
    ASSERT_EQ(ca.size(), cb.size());
    for (std::size_t i = 0; i < ca.size(); ++i) {
        EXPECT_EQ(ca[i].position, cb[i].position);
        EXPECT_EQ(ca[i].normal, cb[i].normal);
        for (std::size_t c = 0; c < a.columns(); ++c) {
            // B = ρ H and H = B / ρ round once each: two half steps of 2⁻²⁴ relative.
            EXPECT_NEAR(ca[i].H[c], cb[i].H[c], 1.3e-7 * std::abs(ca[i].H[c]));
            EXPECT_NEAR(ca[i].B[c], cb[i].B[c], 1.3e-7 * std::abs(ca[i].B[c]));
        }
    }
}

TEST_F(SolutionFile, comes_back_as_it_was) {
    const Solution s = small_solution();
    write_solution(s, folder_ / "s.glb");
    const Solution r = read_solution(folder_ / "s.glb");
    expect_same(s, r);
    ASSERT_EQ(r.cameras.size(), 1u);
    EXPECT_EQ(r.cameras[0].name, "door");
    EXPECT_EQ(r.cameras[0].eye, s.cameras[0].eye);
    EXPECT_EQ(r.cameras[0].fov_y, 61.7);
    EXPECT_EQ(r.cameras[0].aspect, 1.5);
    EXPECT_FALSE(r.cameras[0].near.has_value());
    ASSERT_EQ(r.grids.size(), 1u);
    EXPECT_EQ(r.grids[0].origin, s.grids[0].origin);
    EXPECT_EQ(r.grids[0].columns, 7u);
    EXPECT_EQ(r.options, s.options);
    EXPECT_EQ(r.counters, s.counters);
    EXPECT_EQ(r.scene_digest, s.scene_digest);
    EXPECT_EQ(r.energy.escaped, 2.5);
    ASSERT_TRUE(r.error.has_value());
    EXPECT_EQ(r.error->rms, 0.0123);
    EXPECT_EQ(r.error->points, 256u);
    ASSERT_EQ(r.emitters.size(), 1u);
    EXPECT_EQ(r.emitters[0].corners, s.emitters[0].corners);
    EXPECT_EQ(r.emitters[0].part, 3u);
    EXPECT_TRUE(is_solution(folder_ / "s.glb"));
}

TEST_F(SolutionFile, carries_any_number_of_bands) {
    for (const std::size_t bands : {1u, 2u, 4u, 7u}) {
        std::vector<std::string> names;
        for (std::size_t b = 0; b < bands; ++b) names.push_back(std::to_string(400 + 50 * b));
        const Solution s = small_solution(names);
        write_solution(s, folder_ / "s.glb");
        expect_same(s, read_solution(folder_ / "s.glb"));
    }
}

TEST_F(SolutionFile, vertices_shared_by_two_materials_keep_both_exitances) {
    Solution s = hand_made::empty_solution();
    const auto grey = hand_made::add_material(s, "grey", {0.5, 0.5, 0.5});
    const auto black = hand_made::add_material(s, "black", {0, 0, 0});
    hand_made::add_sheet(s, "both", grey, 0, {}, {1, 0, 0}, {0, 1, 0}, 1, 1,
                         hand_made::uniform(s, 8));
    s.parts = {{"one", grey, 0, 0, 1}, {"two", black, 0, 1, 1}};
    write_solution(s, folder_ / "s.glb");
    const Solution r = read_solution(folder_ / "s.glb");
    EXPECT_EQ(r.positions.size(), 6u);
    expect_same(s, r);
}

TEST_F(SolutionFile, same_solution_same_bytes) {
    write_solution(small_solution(), folder_ / "a.glb");
    write_solution(small_solution(), folder_ / "b.glb");
    EXPECT_EQ(bytes_of(folder_ / "a.glb"), bytes_of(folder_ / "b.glb"));
}

TEST_F(SolutionFile, an_empty_solution_is_one_too) {
    Solution s = hand_made::empty_solution();
    write_solution(s, folder_ / "s.glb");
    EXPECT_TRUE(read_solution(folder_ / "s.glb").triangles.empty());
}

TEST_F(SolutionFile, unwritable_or_not_finite_leaves_nothing_behind) {
    Solution s = small_solution();
    try {
        write_solution(s, folder_ / "nowhere" / "s.glb");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::could_not_finish);
    }
    s.irradiance[VertexId(0)][0] = std::nanf("");
    EXPECT_THROW(write_solution(s, folder_ / "s.glb"), Error);
    s.irradiance[VertexId(0)][0] = 0;
    s.energy.emitted = INFINITY;
    EXPECT_THROW(write_solution(s, folder_ / "s.glb"), Error);
    EXPECT_TRUE(fs::is_empty(folder_));
}

void expect_refused(const fs::path& path, const std::string& what) {
    try {
        read_solution(path);
        ADD_FAILURE() << "accepted: " << what;
    } catch (const Error& error) {
        EXPECT_EQ(error.fault(), Fault::bad_input) << what;
        EXPECT_NE(std::string(error.what()).find(path.filename().string()), std::string::npos);
    }
}

TEST_F(SolutionFile, every_truncation_is_refused) {
    write_solution(small_solution(), folder_ / "s.glb");
    const std::string whole = bytes_of(folder_ / "s.glb");
    for (std::size_t n = 0; n < whole.size(); ++n) {
        std::string cut = whole.substr(0, n);
        put_bytes(folder_ / "cut.glb", cut);
        expect_refused(folder_ / "cut.glb", std::to_string(n) + " bytes");
        // Also with a header that agrees with the shorter length.
        if (n < 12) continue;
        const auto length = static_cast<std::uint32_t>(n);
        cut.replace(8, 4, reinterpret_cast<const char*>(&length), 4);
        put_bytes(folder_ / "cut.glb", cut);
        expect_refused(folder_ / "cut.glb", std::to_string(n) + " bytes, length adjusted");
    }
}

TEST_F(SolutionFile, flipped_bytes_never_crash) {
    write_solution(small_solution(), folder_ / "s.glb");
    const std::string whole = bytes_of(folder_ / "s.glb");
    std::size_t refused = 0;
    for (std::uint64_t i = 0; i < 4000; ++i) {
        std::string broken = whole;
        for (std::uint64_t k = 0; k < 3; ++k) {
            const auto at = static_cast<std::size_t>(uniform(i, 2 * k) * double(broken.size()));
            broken[at] = static_cast<char>(hash_bits(i, k));
        }
        put_bytes(folder_ / "broken.glb", broken);
        try {
            read_solution(folder_ / "broken.glb");
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::bad_input);
            ++refused;
        }
    }
    EXPECT_GT(refused, 1000u);
}

/// The file `whole` with its JSON chunk replaced and the lengths put right.
std::string with_json(const std::string& whole, std::string json) {
    const auto word = [](std::size_t value) {
        const auto v = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&v), 4);
    };
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::uint32_t old_length = 0;
    std::memcpy(&old_length, whole.data() + 12, 4);
    std::string out = whole;
    out.replace(20, old_length, json);
    out.replace(12, 4, word(json.size()));
    return out.replace(8, 4, word(out.size()));
}

std::string json_of(const std::string& whole) {
    std::uint32_t length = 0;
    std::memcpy(&length, whole.data() + 12, 4);
    return whole.substr(20, length);
}

TEST_F(SolutionFile, luminaires_come_back_as_they_were) {
    Solution s = small_solution();
    const auto opening = exitance::testing::opening(LuminousOpening::Shape::cylinder, {1, 2, 0.5});
    for (int i = 0; i < 2; ++i)
        s.luminaires.push_back({exitance::testing::hanging(
                                    exitance::testing::crooked_photometry(opening), {1, 2, 3}, 0.3),
                                1});
    s.luminaires[1].luminaire.photometry = s.luminaires[0].luminaire.photometry;
    write_solution(s, folder_ / "s.glb");
    const std::string whole = bytes_of(folder_ / "s.glb"), sound = json_of(whole);
    const Solution r = read_solution(folder_ / "s.glb");
    ASSERT_EQ(r.luminaires.size(), 2u);
    const Luminaire &a = r.luminaires[0].luminaire, &b = s.luminaires[0].luminaire;
    EXPECT_EQ(r.luminaires[1].luminaire.photometry, a.photometry) << "kept once";
    EXPECT_EQ(r.luminaires[0].group, 1u);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.nadir, b.nadir);
    EXPECT_EQ(a.multiplier, b.multiplier);
    EXPECT_EQ(a.colour, b.colour);
    EXPECT_EQ(a.photometry->planes, b.photometry->planes);
    EXPECT_EQ(a.photometry->candela, b.photometry->candela);
    EXPECT_EQ(a.photometry->opening.shape, opening.shape);
    EXPECT_EQ(a.photometry->opening.size, opening.size);
    for (const auto& [from, to] :
         {std::pair{"\"photometry\":0", "\"photometry\":7"},
          std::pair{"\"gammas\":[0.0", "\"gammas\":[99.0"},
          std::pair{"\"nadir\":[", "\"nadir\":[3,"}, std::pair{"\"candela\":[", "\"candela\":[-1,"},
          std::pair{"\"axis\":2", "\"axis\":3"}, std::pair{"\"shape\":\"cyl", "\"shape\":\"col"}}) {
        std::string json = sound;
        ASSERT_NE(json.find(from), std::string::npos) << from;
        json.replace(json.find(from), std::strlen(from), to);
        std::ofstream(folder_ / "bad.glb", std::ios::binary) << with_json(whole, json);
        EXPECT_THROW(read_solution(folder_ / "bad.glb"), Error) << to;
    }
}

TEST_F(SolutionFile, hostile_json_is_refused) {
    write_solution(small_solution(), folder_ / "s.glb");
    const std::string whole = bytes_of(folder_ / "s.glb"), sound = json_of(whole);
    const std::pair<std::string, std::string> changes[] = {
        {"\"count\":18", "\"count\":4000000000"},
        {"\"count\":18", "\"count\":-1"},
        {"\"count\":18", "\"count\":18446744073709551615"},
        {"\"count\":1}", "\"count\":4000000000}"},
        {"\"byteLength\":", "\"byteLength\":9"},
        {"\"byteOffset\":", "\"byteOffset\":18446744073709551"},
        {"\"byteStride\":12", "\"byteStride\":0"},
        {"\"bufferView\":1", "\"bufferView\":99"},
        {"\"componentType\":5126", "\"componentType\":5125"},
        {"\"format\":1", "\"format\":2"},
        {"\"weight\":0.75", "\"weight\":\"much\""},
        {"\"order\":2", "\"order\":0"},
        {"\"order\":2", "\"order\":99"},
        {"\"triangles\":12", "\"triangles\":18446744073709551615"},
        {"\"material\":1", "\"material\":3"},
        {"\"group\":1", "\"group\":2"},
        {"\"indices\":13", "\"indices\":5"},
        {"\"reflectance\":[0.8", "\"reflectance\":[1.8"},
        {"\"reflectance\":[0.8,", "\"reflectance\":[0.8,0.8,"},
        {"\"bands\":[\"R\",", "\"bands\":["},
        {"\"quantity\":\"radiometric\"", "\"quantity\":\"loud\""},
        {"{\"accessors\":", "{\"accessors\":7,\"old\":"},
        {"{\"accessors\":", std::string(100000, '[')},
        {"\"parts\"", "\"traps\""}};
    for (const auto& [from, to] : changes) {
        std::string json = sound;
        const std::size_t at = json.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        json.replace(at, from.size(), to);
        put_bytes(folder_ / "hostile.glb", with_json(whole, json));
        expect_refused(folder_ / "hostile.glb", from + " -> " + to.substr(0, 60));
    }
}

TEST_F(SolutionFile, a_small_file_cannot_demand_much_memory) {
    write_solution(small_solution(), folder_ / "s.glb");
    const std::string whole = bytes_of(folder_ / "s.glb");
    std::string json = json_of(whole);
    // The first primitive a hundred times over, all on the same accessors.
    const std::string list = "\"primitives\":[";
    const std::size_t begin = json.find(list) + list.size();
    const std::string primitive =
        json.substr(begin, json.find("},{\"attributes", begin) + 2 - begin);
    for (int i = 0; i < 100; ++i) json.insert(begin, primitive);
    put_bytes(folder_ / "bomb.glb", with_json(whole, json));
    try {
        read_solution(folder_ / "bomb.glb");
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("overlap"), std::string::npos) << error.what();
    }
}

TEST_F(SolutionFile, other_files_are_not_solutions) {
    put_bytes(folder_ / "text.glb", "not a glTF at all");
    put_bytes(folder_ / "empty.glb", "");
    for (const char* name : {"text.glb", "empty.glb", "missing.glb", "."}) {
        EXPECT_FALSE(is_solution(folder_ / name)) << name;
        EXPECT_THROW(read_solution(folder_ / name), Error) << name;
    }
}

}  // namespace
}  // namespace exitance
