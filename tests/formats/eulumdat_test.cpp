// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/eulumdat.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "exitance/scene/lamp_figures.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::expect_sound;
using Shape = LuminousOpening::Shape;

LampFile parse(const std::string& text, std::uint32_t set = 1) {
    return parse_eulumdat("t.ldt", text, set);
}

// Eight C-planes, three angles; I = 100 + 10 i cd/klm in plane i as measured, at γ = 45.
struct Sample {
    int symmetry = 0;
    std::size_t measured = 8;
    std::string company = "Works";
    std::string sizes = "1200\n200\n80\n1100\n150\n0\n0\n0\n0\n";
    std::string rest = "100\n80\n1\n0\n";  // downward, LORL, conversion, tilt
    std::string lamps = "1\n2\nT16\n5000\n4000 K\n1B\n70\n";
    std::string end = "\r\n";

    std::string text() const {
        std::string out = company + "\n3\n" + std::to_string(symmetry) +
                          "\n8\n45\n3\n45\nreport\nA lamp\nW-1\nlamp.ldt\ntoday\n" + sizes + rest +
                          lamps;
        for (int i = 0; i < 10; ++i) out += "0.5\n";
        for (int i = 0; i < 8; ++i) out += fmt::format("{}\n", 45 * i);
        out += "0\n45\n90\n";
        for (std::size_t i = 0; i < measured; ++i) out += fmt::format("50\n{}\n0\n", 100 + 10 * i);
        std::string ended;
        for (const char c : out) ended += c == '\n' ? end : std::string(1, c);
        return ended;
    }
    LampFile read(std::uint32_t set = 1) const { return parse(text(), set); }
    // cd/klm at γ = 45.
    double at(double c) const { return read().photometry.at(c, 45) / 5; }
};

TEST(Eulumdat, ReadsWhatAFileSays) {
    const LampFile lamp = Sample{}.read();
    const Photometry& p = lamp.photometry;
    EXPECT_EQ(lamp.format, "EULUMDAT");
    EXPECT_EQ(p.maker, "Works");
    EXPECT_EQ(p.name, "A lamp");
    EXPECT_EQ(p.catalogue, "W-1");
    EXPECT_EQ(p.lamp, "T16");
    EXPECT_EQ(p.lamp_lumens, 5000);
    EXPECT_EQ(p.watts, 70);
    EXPECT_NEAR(*p.stated_lor, 0.8, 1e-12);
    EXPECT_EQ(p.gammas, (std::vector<double>{0, 45, 90}));
    EXPECT_EQ(p.planes.size(), 9U) << "closed with C360";
    EXPECT_NEAR(p.at(0, 0), 250, 1e-9) << "50 cd/klm of 5000 lm";
    // Lengths lie along C90, for lamps lie across C0.
    EXPECT_EQ(p.opening.shape, Shape::box);
    EXPECT_NEAR(length(p.opening.size - Vec3{0.15, 1.1, 0}), 0, 1e-12);
    EXPECT_NEAR(length(*p.housing - Vec3{0.2, 1.2, 0.08}), 0, 1e-12);
    EXPECT_TRUE(lamp.warnings.empty());
}

TEST(Eulumdat, EverySymmetry) {
    Sample all;
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(all.at(45 * i), 100 + 10 * i, 1e-9);
    EXPECT_NEAR(all.at(337.5), 0.5 * (170 + 100), 1e-9) << "round the circle";
    Sample rotational{1, 1};
    EXPECT_NEAR(rotational.at(123), 100, 1e-9);
    Sample about_c0{2, 5};
    EXPECT_NEAR(about_c0.at(135), 130, 1e-9);
    EXPECT_NEAR(about_c0.at(225), 130, 1e-9);
    Sample about_c90{3, 5};  // given from C270 over C0 to C90
    EXPECT_NEAR(about_c90.at(270), 100, 1e-9);
    EXPECT_NEAR(about_c90.at(315), 110, 1e-9);
    EXPECT_NEAR(about_c90.at(225), 110, 1e-9) << "mirrors C315";
    EXPECT_NEAR(about_c90.at(0), 120, 1e-9);
    EXPECT_NEAR(about_c90.at(180), 120, 1e-9);
    EXPECT_NEAR(about_c90.at(90), 140, 1e-9);
    Sample both{4, 3};
    for (const double c : {45.0, 135.0, 225.0, 315.0}) EXPECT_NEAR(both.at(c), 110, 1e-9) << c;
    EXPECT_NEAR(both.at(270), 120, 1e-9);
}

TEST(Eulumdat, CommasLineEndsAndLatin1) {
    Sample s;
    for (const char* end : {"\n", "\r\n", "\r"}) {
        s.end = end;
        EXPECT_EQ(s.read().photometry.watts, 70);
    }
    s.rest = "100\n80,5\n0,5\n0\n";
    s.company = "M\xfcller";
    const Photometry p = s.read().photometry;
    EXPECT_NEAR(*p.stated_lor, 0.805, 1e-12);
    EXPECT_NEAR(p.at(0, 0), 125, 1e-9) << "conversion factor 0,5";
    EXPECT_EQ(p.maker, "Müller");
    s.company = "\xef\xbb\xbfM\xc3\xbcller";
    EXPECT_EQ(s.read().photometry.maker, "Müller") << "UTF-8 stays, its mark goes";
}

TEST(Eulumdat, OpeningsAndTheirSides) {
    Sample s;
    s.sizes = "300\n0\n100\n250\n0\n0\n0\n0\n0\n";
    EXPECT_EQ(s.read().photometry.opening.shape, Shape::cylinder);
    EXPECT_NEAR(length(s.read().photometry.opening.size - Vec3{0.25, 0.25, 0}), 0, 1e-12);
    s.sizes = "300\n0\n100\n0\n0\n0\n0\n0\n0\n";
    EXPECT_EQ(s.read().photometry.opening.shape, Shape::point);
    s.sizes = "1200\n200\n80\n1100\n150\n40\n0\n50\n0\n";
    const LuminousOpening o = s.read().photometry.opening;
    EXPECT_NEAR(o.size.z, 0.05, 1e-12);
    EXPECT_FALSE(o.sides_shine);
    EXPECT_NEAR(o.sides[0], 0.04, 1e-12);
    // Bottom, top, and the sides to C0 and C180.
    EXPECT_EQ(facets(o).size(), 4U);
}

TEST(Eulumdat, OneOfSeveralSetsOfLamps) {
    Sample s;
    s.lamps = "2\n1\nsmall\n5000\nww\n1B\n70\n2\nlarge\n10000\nnw\n1A\n130\n";
    EXPECT_EQ(s.read().lamp_sets, 2U);
    EXPECT_EQ(s.read().photometry.lamp, "small");
    const Photometry second = s.read(2).photometry;
    EXPECT_EQ(second.lamp, "large");
    EXPECT_EQ(second.watts, 130);
    EXPECT_NEAR(second.flux(), 2 * s.read().photometry.flux(), 1e-9);
    expect_refused([&] { s.read(3); }, "t.ldt:26:1", "found 2 sets of lamps, expected a set 3");
}

TEST(Eulumdat, ANegativeNumberOfLampsIsAbsolutePhotometry) {
    Sample s;
    s.lamps = "1\n-1\nLED\n5000\n4000\n80\n70\n";
    const Photometry p = s.read().photometry;
    EXPECT_TRUE(p.absolute);
    EXPECT_NEAR(p.at(0, 0), 250, 1e-9);
    EXPECT_FALSE(figures_of(p).output_ratio.has_value());
}

TEST(Eulumdat, ACircleThatStaysOpenIsAWarning) {
    Sample sample;
    std::string text = sample.text();
    EXPECT_TRUE(parse(text).warnings.empty());
    // The last plane at 290° instead of 315°: 70° to the first one, where others are 45° apart.
    text.replace(text.find("\r\n315\r\n"), 7, "\r\n290\r\n");
    ASSERT_EQ(parse(text).warnings.size(), 1U);
    EXPECT_NE(parse(text).warnings[0].what.find("the C-planes end at 290°"), std::string::npos);
}

TEST(Eulumdat, RefusalsNamePlaceFoundAndExpected) {
    const std::string good = [] {
        Sample s;
        s.end = "\n";
        return s.text();
    }();
    const auto refused = [&](std::size_t line, const std::string& field, const std::string& place,
                             const std::string& words) {
        std::string text;
        std::size_t number = 1, at = 0;
        for (std::size_t end; (end = good.find('\n', at)) != std::string::npos; at = end + 1)
            text += (number++ == line ? field : good.substr(at, end - at)) + "\n";
        expect_refused([&] { parse(text); }, place, words);
    };
    refused(3, "5", "t.ldt:3:1", "found '5', expected the symmetry, 0 to 4");
    refused(4, "99999999", "t.ldt:4:1", "no more than the file has room for");
    refused(4, "8.5", "t.ldt:4:1", "a whole number");
    refused(6, "1", "t.ldt:6:1", "two at least");
    refused(13, " long", "t.ldt:13:2", "found 'long', expected the length of the luminaire in mm");
    refused(24, "-1", "t.ldt:24:1", "found '-1', expected the conversion factor of intensities, 0");
    refused(26, "400000000", "t.ldt:26:1", "no more than the file has room for");
    refused(44, "0", "t.ldt:44:1", "found '0', expected a C-plane beyond the last");
    refused(52, "0", "t.ldt:52:1", "found '0', expected an angle γ beyond the last");
    refused(54, "nan", "t.ldt:54:1", "found 'nan', expected an intensity in cd/klm");
    Sample cut;
    cut.measured = 7;
    expect_refused([&] { cut.read(); }, "t.ldt:75:1",
                   "the file ends here, expected an intensity in cd/klm");
    EXPECT_EQ(testing::refusal([] { parse(""); }).substr(0, 9), "t.ldt:1:1");
    Sample more;
    more.measured = 9;
    ASSERT_EQ(more.read().warnings.size(), 1U);
    EXPECT_EQ(more.read().warnings[0].place.text(), "t.ldt:78:1");
}

RC_GTEST_PROP(Eulumdat, DamagedFilesEndInALampOrARefusal, ()) {
    std::string text = Sample{}.text();
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto count = *rc::gen::inRange<std::size_t>(0, 12);
    text.replace(
        at, count,
        *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789-.,e \r\n"))));
    expect_sound([&] { figures_of(parse(text).photometry).flux; }, "t.ldt", true);
}

TEST(Eulumdat, RealFilesHoldTheLumensTheyState) {
    // Stated flux = lamp lumens × light output ratio; within 0.2 % for all of them. Downward
    // fractions as the files state them, rounded to whole percent there.
    struct Row {
        const char* file;
        double lumens, downward;
    };
    for (const Row& row :
         {Row{"sample1", 1983, 0.87}, Row{"sample2", 4600, 1}, Row{"sample3", 12800, 0.183},
          Row{"sample4", 5540, 0.999}, Row{"sample5", 611.9, 1}, Row{"sample10", 7000, 0.33}}) {
        const auto path = testing::beside_project(fmt::format("ldt/{}.ldt", row.file));
        if (!path) GTEST_SKIP() << "no shared scenes beside the project";
        const LampFile lamp = read_lamp_file(*path);
        const Photometry& p = lamp.photometry;
        const double stated = *p.lamp_lumens * p.stated_lor.value_or(1);
        EXPECT_NEAR(stated, row.lumens, 1e-6 * row.lumens) << row.file;
        EXPECT_NEAR(p.flux(), stated, 2e-3 * stated) << row.file;
        EXPECT_NEAR(p.flux_below() / p.flux(), row.downward, 6e-3) << row.file;
        EXPECT_TRUE(lamp.warnings.empty()) << row.file;
    }
}

}  // namespace
}  // namespace exitance
