// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/ies.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "exitance/scene/formats/ies_opening.h"
#include "exitance/scene/lamp_figures.h"
#include "formats/samples.h"

namespace exitance {
namespace {

using testing::expect_refused;
using testing::expect_sound;
using Shape = LuminousOpening::Shape;

constexpr double pi = std::numbers::pi;

TiltFile no_tilt(const std::string& name) {
    throw Error({name, 0, 0}, "there is no such file");
}

LampFile parse(const std::string& text) {
    return parse_ies("t.ies", text, no_tilt);
}

Vec3 direction(double c, double gamma) {
    const double g = gamma * pi / 180, a = c * pi / 180;
    return {std::sin(g) * std::cos(a), std::sin(g) * std::sin(a), -std::cos(g)};
}

// A small lamp whose parts can be replaced: 1000 lm, 10 W, 100 cd straight down.
struct Sample {
    std::string head =
        "IESNA:LM-63-2002\n[TEST] none\n[MANUFAC] Works\n[LUMCAT] W-1\n"
        "[LUMINAIRE] A lamp\n[MORE] of two lines\n[LAMP] LED\n";
    std::string tilt = "TILT=NONE\n";
    std::string lamp = "1 1000 1 3 1 1 2 0 0 0\n";
    std::string ballast = "1 1 10\n";
    std::string table = "0 45 90\n0\n100 60 0\n";

    std::string text() const { return head + tilt + lamp + ballast + table; }
    LampFile read() const { return parse(text()); }
};

TEST(Ies, ReadsWhatAFileSays) {
    const LampFile lamp = Sample{}.read();
    const Photometry& p = lamp.photometry;
    EXPECT_EQ(lamp.format, "IES LM-63-2002");
    EXPECT_EQ(p.name, "A lamp");
    EXPECT_EQ(p.maker, "Works");
    EXPECT_EQ(p.catalogue, "W-1");
    EXPECT_EQ(p.lamp, "LED");
    EXPECT_EQ(p.lamp_lumens, 1000);
    EXPECT_EQ(p.watts, 10);
    EXPECT_FALSE(p.absolute);
    EXPECT_EQ(p.planes, std::vector<double>{0});
    EXPECT_EQ(p.gammas, (std::vector<double>{0, 45, 90}));
    EXPECT_EQ(p.candela, (std::vector<double>{100, 60, 0}));
    EXPECT_EQ(p.opening.shape, Shape::point);
    EXPECT_TRUE(lamp.warnings.empty());
}

TEST(Ies, EveryEditionByItsFirstLine) {
    for (const auto& [line, name] :
         {std::pair{"", "1986"}, std::pair{"IESNA91", "1991"},
          std::pair{"IESNA:LM-63-1995", "1995"}, std::pair{"IESNA95", "1995"},
          std::pair{"IESNA:LM-63-2002", "2002"}, std::pair{"IES:LM-63-2019", "2019"}}) {
        Sample s;
        s.head = *line ? std::string(line) + "\r\n[LUMCAT] x\r\n" : "Some works, a lamp\n";
        const LampFile lamp = s.read();
        EXPECT_EQ(lamp.format, fmt::format("IES LM-63-{}", name));
        EXPECT_EQ(lamp.photometry.candela[0], 100) << line;
        EXPECT_TRUE(lamp.warnings.empty());
    }
    Sample later;
    later.head = "IES:LM-63-2031\n";
    EXPECT_EQ(later.read().warnings.size(), 1U);
    Sample free;  // since 1986 has no keywords, its first line is a name
    free.head = "Downlight 7\nof the works\n";
    EXPECT_EQ(free.read().photometry.name, "Downlight 7");
}

TEST(Ies, NumbersWrapAndAreSeparatedByAnything) {
    Sample s;
    s.lamp = "1,1000 ,1\n3\n1 1 2\t0\n0 0";
    s.ballast = " 1\n1 10\r\n";
    s.table = "0,45,90 0 100\n60\n\n0\n";
    EXPECT_EQ(s.read().photometry.candela, (std::vector<double>{100, 60, 0}));
    s.table =
        "0 45 90" + std::string(5000, ' ') + "0 +1.0e2 6.E1 0\x1a";  // long line, old end mark
    EXPECT_EQ(s.read().photometry.candela, (std::vector<double>{100, 60, 0}));
    EXPECT_TRUE(s.read().warnings.empty());
}

TEST(Ies, MultiplierAndBallastFactorsScaleTheCandelas) {
    Sample s;
    s.lamp = "2 1000 0.5 3 1 1 2 0 0 0\n";
    s.ballast = "0.9 0.8 10\n";
    // The second factor is the ballast-lamp photometric factor until 1995, reserved since.
    EXPECT_NEAR(s.read().photometry.candela[0], 100 * 0.5 * 0.9, 1e-12);
    EXPECT_EQ(s.read().photometry.lamp_lumens, 2000);
    s.head = "IESNA91\n";
    EXPECT_NEAR(s.read().photometry.candela[0], 100 * 0.5 * 0.9 * 0.8, 1e-12);
}

TEST(Ies, MinusOneLumensIsAbsolutePhotometry) {
    Sample s;
    s.lamp = "1 -1 1 3 1 1 2 0 0 0\n";
    const Photometry p = s.read().photometry;
    EXPECT_TRUE(p.absolute);
    EXPECT_FALSE(p.lamp_lumens.has_value());
    EXPECT_FALSE(figures_of(p).output_ratio.has_value());
}

TEST(Ies, FeetBecomeMetres) {
    Sample s;
    s.lamp = "1 1000 1 3 1 1 1 2 4 0\n";
    const LuminousOpening o = s.read().photometry.opening;
    EXPECT_EQ(o.shape, Shape::box);
    // Width lies along C90, length along C0.
    EXPECT_NEAR(o.size.x, 4 * 0.3048, 1e-12);
    EXPECT_NEAR(o.size.y, 2 * 0.3048, 1e-12);
}

TEST(Ies, SymmetryFillsTheCircle) {
    // I = 100 + C of the measured range, at γ = 45.
    const auto table = [](const std::vector<double>& planes) {
        std::string angles, values;
        for (const double c : planes) {
            angles += fmt::format("{} ", c);
            values += fmt::format("50 {} 0\n", 100 + c);
        }
        return fmt::format("0 45 90\n{}\n{}", angles, values);
    };
    const auto at = [&](const std::vector<double>& planes, double c) {
        Sample s;
        s.lamp = fmt::format("1 1000 1 3 {} 1 2 0 0 0\n", planes.size());
        s.table = table(planes);
        return s.read().photometry.at(c, 45);
    };
    const std::vector<double> quarter{0, 45, 90}, half{0, 90, 180}, back{90, 180, 270};
    for (const double c : {30.0, 150.0, 210.0, 330.0}) EXPECT_NEAR(at(quarter, c), 130, 1e-9) << c;
    for (const double c : {120.0, 240.0}) EXPECT_NEAR(at(half, c), 220, 1e-9) << c;
    // Since 1995 also the half about C90–C270.
    EXPECT_NEAR(at(back, 200), 300, 1e-9);
    EXPECT_NEAR(at(back, -20), 300, 1e-9) << "C340 mirrors C200";
    EXPECT_NEAR(at(back, 20), 260, 1e-9) << "C20 mirrors C160";
    EXPECT_NEAR(at({0, 120, 240, 360}, 300), 220, 1e-9) << "C360 is C0, the first counts";
    EXPECT_NEAR(at({0, 120, 240}, 300), 220, 1e-9) << "closed with its first plane";
    EXPECT_NEAR(at({0}, 77), 100, 1e-9) << "one plane is the same all round";
}

TEST(Ies, HalfTheSphereIsDark) {
    Sample s;
    s.table = "90 135 180\n0\n0 60 100\n";
    const Photometry p = s.read().photometry;
    EXPECT_EQ(p.at(0, 89), 0);
    EXPECT_EQ(p.at(0, 180), 100);
    EXPECT_EQ(p.flux_below(), 0);
}

TEST(Ies, TiltInTheFileOrBesideIt) {
    const std::string tilt = "1\n3\n0 45 90\n1 0.9 0.7\n";
    Sample s;
    s.tilt = "TILT=INCLUDE\n" + tilt;
    EXPECT_NEAR(s.read().photometry.tilt.factor(67.5), 0.8, 1e-12);
    EXPECT_EQ(s.read().photometry.candela[0], 100);
    s.tilt = "TILT = lamp.tlt\r\n";
    const LampFile lamp = parse_ies("t.ies", s.text(), [&](const std::string& name) {
        EXPECT_EQ(name, "lamp.tlt");
        return TiltFile{"lamp.tlt", tilt};
    });
    EXPECT_NEAR(lamp.photometry.tilt.factor(45), 0.9, 1e-12);
    EXPECT_EQ(lamp.photometry.candela[0], 100);
    expect_refused([&] { s.read(); }, "t.ies:8:1", "lamp.tlt: there is no such file");
    for (const char* elsewhere : {"../up.tlt", "/etc/passwd", "C:\\tilt", ".."}) {
        s.tilt = fmt::format("TILT={}\n", elsewhere);
        expect_refused([&] { s.read(); }, "t.ies:8:1", "expected the name of one beside");
    }
}

TEST(Ies, TypesAAndBAreRotatedIntoCPlanes) {
    // I is linear in the direction, so that it is known in every frame. LM-63: nadir is (0, 0) for
    // type B and (0, −90) for A; C0 at the horizon is (0, 90) and (0, 0); positive H is clockwise
    // seen from above, towards C270.
    const Vec3 w{0.3, -0.5, 0.4};
    const auto I = [&](const Vec3& d) { return 1000 * (1 + dot(d, w)); };
    for (const bool a : {false, true}) {
        std::string angles, table;
        for (int h = -90; h <= 90; h += 5) {
            angles += fmt::format("{} ", h);
            for (int v = -90; v <= 90; v += 5) {
                const double ch = std::cos(h * pi / 180), sh = std::sin(h * pi / 180);
                const double cv = std::cos(v * pi / 180), sv = std::sin(v * pi / 180);
                const Vec3 d = a ? Vec3{cv * ch, -cv * sh, sv} : Vec3{ch * sv, -sh, -ch * cv};
                table += fmt::format("{:.6f} ", I(d));
            }
            table += "\n";
        }
        Sample s;
        s.lamp = fmt::format("1 1000 1 37 37 {} 2 0 0 0\n", a ? 3 : 2);
        s.table = angles + "\n" + angles + "\n" + table;
        const Photometry p = s.read().photometry;
        // 0.2 %: 5° of bilinear interpolation, twice.
        for (const auto& [c, gamma] : {std::pair{0.0, 60.0}, std::pair{30.0, 85.0},
                                       std::pair{300.0, 50.0}, std::pair{80.0, 89.0}}) {
            const double exact = I(direction(c, gamma));
            EXPECT_NEAR(p.at(c, gamma), exact, 2e-3 * exact) << a << " C" << c << " γ" << gamma;
        }
        EXPECT_EQ(a ? p.at(180, 60) : p.at(0, 120), 0) << "behind the measured half";
        EXPECT_NEAR(length(p.forward - (a ? Vec3{1, 0, 0} : Vec3{0, 0, -1})), 0, 1e-12);
        // ∫ over the half-sphere around f: 1000 (2π + π f·w). The rim of type B is γ = 90, where
        // the table ends; that of type A is blurred over half a cell, 1.25° of light that real
        // lamps do not send there.
        const double exact = 1000 * (2 * pi + pi * dot(p.forward, w));
        EXPECT_NEAR(p.flux(), exact, (a ? 0.03 : 1e-3) * exact);
    }
}

TEST(Ies, TypeBFromZeroIsTheSameOnBothSides) {
    Sample s;
    s.lamp = "1 1000 1 3 2 2 2 0 0 0\n";
    s.table = "-90 0 90\n0 90\n0 100 0\n0 0 0\n";
    const Photometry p = s.read().photometry;
    EXPECT_NEAR(p.at(90, 45), 50, 1e-6);
    EXPECT_NEAR(p.at(270, 45), 50, 1e-6);
}

TEST(Ies, OpeningsByTheirSigns) {
    struct Row {
        double w, l, h;
        Shape shape;
        Vec3 size;
        std::uint32_t axis;
    };
    const auto expect = [](IesEdition edition, const std::vector<Row>& rows) {
        for (const Row& r : rows) {
            const LuminousOpening o = ies_opening(r.w, r.l, r.h, edition);
            EXPECT_EQ(o.shape, r.shape) << r.w << " " << r.l << " " << r.h;
            EXPECT_EQ(o.size, r.size) << r.w << " " << r.l << " " << r.h;
            if (r.shape == Shape::cylinder) {
                EXPECT_EQ(o.axis, r.axis) << r.w << " " << r.l << " " << r.h;
            }
        }
    };
    const std::vector<Row> any{{0, 0, 0, Shape::point, {}, 2},
                               {2, 3, 0, Shape::box, {3, 2, 0}, 2},
                               {2, 3, 1, Shape::box, {3, 2, 1}, 2}};
    expect(IesEdition::y1986, any);
    expect(IesEdition::y2019, any);
    expect(IesEdition::y1995, {{-2, 0, 0, Shape::cylinder, {2, 2, 0}, 2},
                               {-2, 0, -2, Shape::ellipsoid, {2, 2, 2}, 2},
                               {-2, 0, 3, Shape::cylinder, {2, 2, 3}, 2},
                               {0, 3, -1, Shape::cylinder, {3, 1, 1}, 0},
                               {3, 0, -1, Shape::cylinder, {1, 3, 1}, 1},
                               {-2, 3, 1, Shape::cylinder, {3, 2, 1}, 2},
                               {2, -3, 1, Shape::cylinder, {3, 2, 1}, 2},
                               {-2, 3, -1, Shape::ellipsoid, {3, 2, 1}, 2}});
    expect(IesEdition::y2002, {{-2, -2, 0, Shape::cylinder, {2, 2, 0}, 2},
                               {-2, -3, 0, Shape::cylinder, {3, 2, 0}, 2},
                               {-2, -2, 3, Shape::cylinder, {2, 2, 3}, 2},
                               {-2, -2, -2, Shape::ellipsoid, {2, 2, 2}, 2},
                               {-2, -3, -1, Shape::ellipsoid, {3, 2, 1}, 2},
                               {-1, 3, -1, Shape::cylinder, {3, 1, 1}, 0},
                               {3, -1, -1, Shape::cylinder, {1, 3, 1}, 1},
                               {-2, 0, -2, Shape::cylinder, {0, 2, 2}, 0}});
}

TEST(Ies, SmallNegativeCandelasAreZeroWithAWarning) {
    Sample s;
    s.table = "0 45 90\n0\n100 60 -0.05\n";
    const LampFile lamp = s.read();
    EXPECT_EQ(lamp.photometry.candela[2], 0);
    ASSERT_EQ(lamp.warnings.size(), 1U);
    EXPECT_EQ(lamp.warnings[0].place.text(), "t.ies:13:8");
    s.table = "0 45 90\n0\n100 60 -5\n";
    expect_refused([&] { s.read(); }, "t.ies:13:8", "found the candela value -5, expected 0 or");
}

TEST(Ies, LinesEndInAnyWayAndBlankOnesComeFirst) {
    Sample s;
    const Photometry plain = s.read().photometry;
    for (const std::string end : {"\r", "\r\n", "\n"}) {
        std::string text;
        for (const char c : "\n \n" + s.text()) text += c == '\n' ? end : std::string(1, c);
        const LampFile lamp = parse(text);
        EXPECT_EQ(lamp.format, "IES LM-63-2002");
        EXPECT_EQ(lamp.photometry.name, "A lamp");
        EXPECT_EQ(lamp.photometry.candela, plain.candela);
        EXPECT_TRUE(lamp.warnings.empty());
    }
    s.table = "0 45 90\r0\r100 sixty 0\r";
    std::string text = s.text();
    std::replace(text.begin(), text.end(), '\n', '\r');
    expect_refused([&] { parse(text); }, "t.ies:13:5", "'sixty'");
}

TEST(Ies, ACircleThatStaysOpenIsAWarning) {
    Sample s;
    s.lamp = "1 1000 1 3 4 1 2 0 0 0\n";
    const std::string rows = "\n1 1 0\n1 1 0\n1 1 0\n1 1 0\n";
    s.table = "0 45 90\n0 90 180 270" + rows;
    ASSERT_EQ(s.read().warnings.size(), 1U);
    EXPECT_NE(s.read().warnings[0].what.find("end at 270, expected 360"), std::string::npos);
    s.table = "0 45 90\n0 90 180 360" + rows;
    EXPECT_TRUE(s.read().warnings.empty());
}

TEST(Ies, WhatFollowsTheTableIsAWarning) {
    Sample s;
    s.table += "17\n";
    ASSERT_EQ(s.read().warnings.size(), 1U);
    EXPECT_EQ(s.read().warnings[0].place.text(), "t.ies:14:1");
}

TEST(Ies, RefusalsNamePlaceFoundAndExpected) {
    const auto refused = [](auto change, const std::string& place, const std::string& words) {
        Sample s;
        change(s);
        expect_refused([&] { s.read(); }, place, words);
    };
    refused([](Sample& s) { s.lamp = "1 1000 x 3 1 1 2 0 0 0\n"; }, "t.ies:9:8",
            "found 'x', expected the candela multiplier, a number");
    refused([](Sample& s) { s.lamp = "1 1000 1 3 1 4 2 0 0 0\n"; }, "t.ies:9:14",
            "found '4', expected the photometric type: 1 (C), 2 (B) or 3 (A), from 1 to 3");
    refused([](Sample& s) { s.lamp = "1 1000 1 3 1 1 0 0 0 0\n"; }, "t.ies:9:16",
            "expected the units: 1 (feet) or 2 (metres)");
    refused([](Sample& s) { s.lamp = "1 1000 1 999999999 1 1 2 0 0 0\n"; }, "t.ies:9:10",
            "found '999999999', expected the number of vertical angles");
    refused([](Sample& s) { s.lamp = "1 1000 1 3 77777 1 2 0 0 0\n"; }, "t.ies:9:12",
            "no more than the file has room for");
    refused([](Sample& s) { s.lamp = "1 1000 1 2.5 1 1 2 0 0 0\n"; }, "t.ies:9:10",
            "a whole number");
    refused([](Sample& s) { s.table = "0 45 45\n0\n1 1 1\n"; }, "t.ies:11:6",
            "found '45', expected a vertical angle above the one before, 45");
    refused([](Sample& s) { s.table = "0 45 190\n0\n1 1 1\n"; }, "t.ies:11:6",
            "a vertical angle, from 0 to 180");
    refused([](Sample& s) { s.table = "0 45 90\n0\n100 60"; }, "t.ies:13:7",
            "the file ends here, expected a candela value");
    refused([](Sample& s) { s.table = "0 45 90\n0\nnan 60 0"; }, "t.ies:13:1", "found 'nan'");
    refused([](Sample& s) { s.tilt = "TILT=\n"; }, "t.ies:8:1", "found nothing after TILT=");
    refused([](Sample& s) { s.tilt = ""; }, "t.ies:13:1", "ends without a line TILT=");
    refused(
        [](Sample& s) {
            s.lamp = "1 1000 1 3 2 1 2 0 0 0\n";
            s.table = "0 45 90\n0 70\n1 1 1 1 1 1\n";
        },
        "t.ies:12:3", "found horizontal angles from 0 to 70, expected 0, or from 0 to 90");
    EXPECT_EQ(testing::refusal([] { parse(""); }).substr(0, 9), "t.ies:1:1");
}

RC_GTEST_PROP(Ies, DamagedFilesEndInALampOrARefusal, ()) {
    std::string text = Sample{}.text();
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto count = *rc::gen::inRange<std::size_t>(0, 12);
    text.replace(at, count,
                 *rc::gen::container<std::string>(
                     rc::gen::elementOf(std::string("0123456789-.e, \n\t=[]TILN"))));
    expect_sound([&] { figures_of(parse(text).photometry).flux; }, "t.ies", true);
}

TEST(Ies, TheExampleOfMgfHasTheOutputRatioOfItsFixture) {
    const auto path = testing::beside_project("mgf/examp1.ies");
    if (!path) GTEST_SKIP() << "no shared scenes beside the project";
    const LampFile lamp = read_lamp_file(*path);
    const LampFigures f = figures_of(lamp.photometry);
    EXPECT_EQ(lamp.format, "IES LM-63-1995") << "its first line is IESNA95";
    // The file states no flux of the luminaire: 5800 lm of lamps, of which 5297 lm leave. The zonal
    // sum over the mean of the planes, which catalogues print, is the independent count here.
    EXPECT_NEAR(f.flux, 5297, 0.001 * 5297);
    EXPECT_EQ(lamp.photometry.lamp_lumens, 5800);
    EXPECT_EQ(lamp.photometry.watts, 63.7);
    EXPECT_EQ(f.symmetry, LampSymmetry::both);
    EXPECT_TRUE(lamp.warnings.empty());
    double zonal = 0;
    for (int j = 0; j < 72; ++j) {
        const double a = 2.5 * j * pi / 180, b = 2.5 * (j + 1) * pi / 180;
        double mean = 0;
        for (int i = 0; i < 16; ++i) mean += lamp.photometry.at(22.5 * i, 2.5 * j + 1.25) / 16;
        zonal += 2 * pi * (std::cos(a) - std::cos(b)) * mean;
    }
    EXPECT_NEAR(f.flux, zonal, 1e-3 * zonal);
}

}  // namespace
}  // namespace exitance
