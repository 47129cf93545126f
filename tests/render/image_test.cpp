// SPDX-License-Identifier: Apache-2.0
#include "exitance/render/image.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "exitance/run/error.h"
#include "exitance/run/random.h"

namespace exitance {
namespace {

namespace fs = std::filesystem;

class ImageFile : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("exitance_image_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()) +
                   "_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    static Image noise(std::uint32_t width, std::uint32_t height, float scale) {
        Image image(width, height);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = Vec3f(Vec3{uniform(1, i), uniform(2, i), uniform(3, i)}) * scale;
        return image;
    }

    fs::path folder_;
};

TEST_F(ImageFile, exr_keeps_every_bit) {
    const Image image = noise(37, 19, 1e5f);
    write_image(image, folder_ / "a.exr");
    Imf::InputFile file((folder_ / "a.exr").c_str());
    const auto window = file.header().dataWindow();
    ASSERT_EQ(window.max.x - window.min.x + 1, 37);
    ASSERT_EQ(window.max.y - window.min.y + 1, 19);
    Image back(37, 19);
    Imf::FrameBuffer frame;
    const char* names[] = {"R", "G", "B"};
    for (std::size_t i = 0; i < 3; ++i)
        frame.insert(names[i], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(&back.pixels[0][i]),
                                          sizeof(Vec3f), 37 * sizeof(Vec3f)));
    file.setFrameBuffer(frame);
    file.readPixels(0, 18);
    EXPECT_EQ(back.pixels, image.pixels);
}

TEST_F(ImageFile, png_holds_srgb_codes) {
    Image image(3, 2);
    image.pixels = {{0, 0, 0}, {1, 1, 1}, {0.5f, 0.2f, 0.05f}, {2, -1, NAN}, {0.001f, 0, 1}, {}};
    write_image(image, folder_ / "a.png");
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_file(&png, (folder_ / "a.png").c_str()));
    ASSERT_EQ(png.width, 3u);
    ASSERT_EQ(png.height, 2u);
    png.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> bytes(18);
    ASSERT_TRUE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
    // IEC 61966-2-1 by hand: 0.5 → 187.5, 0.2 → 123.6, 0.05 → 63.3, 0.001 → 3.3.
    EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0, 0, 0, 255, 255, 255, 188, 124, 63, 255, 0, 0, 3,
                                                0, 255, 0, 0, 0}));
}

TEST_F(ImageFile, hdr_is_within_its_steps) {
    const Image image = noise(40, 7, 300.0f);
    write_image(image, folder_ / "a.hdr");
    std::ifstream in(folder_ / "a.hdr", std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    ASSERT_TRUE(bytes.starts_with("#?RADIANCE\n"));
    const std::string size = "-Y 7 +X 40\n";
    std::size_t at = bytes.find(size);
    ASSERT_NE(at, std::string::npos);
    at += size.size();
    // Adaptive run-length encoding per scan line and component (Ward 1991).
    const auto byte = [&] { return static_cast<unsigned char>(bytes.at(at++)); };
    for (std::uint32_t y = 0; y < 7; ++y) {
        ASSERT_EQ(byte(), 2);
        ASSERT_EQ(byte(), 2);
        ASSERT_EQ(byte() << 8 | byte(), 40);
        std::array<std::vector<int>, 4> line;
        for (auto& component : line)
            while (component.size() < 40) {
                const int code = byte();
                if (code > 128) {
                    component.insert(component.end(), static_cast<std::size_t>(code - 128), byte());
                } else {
                    for (int k = 0; k < code; ++k) component.push_back(byte());
                }
            }
        for (std::uint32_t x = 0; x < 40; ++x) {
            const double scale = std::ldexp(1.0, line[3][x] - 136);
            const Vec3f& exact = image.at(x, y);
            const double step = double(std::max({exact.x, exact.y, exact.z})) / 127;
            for (std::size_t i = 0; i < 3; ++i)
                EXPECT_NEAR(line[i][x] * scale, double(exact[i]), step);
        }
    }
}

TEST_F(ImageFile, failures_leave_nothing) {
    const Image image = noise(4, 4, 1);
    for (const char* name : {"a.jpg", "a", "a.PNG.gif"}) {
        try {
            write_image(image, folder_ / name);
            FAIL() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::wrong_use);
        }
    }
    for (const char* name : {"no/a.png", "no/a.exr", "no/a.hdr"}) {
        try {
            write_image(image, folder_ / name);
            FAIL() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.fault(), Fault::could_not_finish);
        }
    }
    EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace exitance
