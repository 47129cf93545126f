// SPDX-License-Identifier: Apache-2.0
// One field per line (Stockmar 1990); numbers in the comments below count these lines from 1.
#include "exitance/scene/formats/eulumdat.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exitance/scene/formats/c_planes.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr double millimetre = 1e-3;
constexpr double most_candela = 1e15;

/// Lines one after the other, ended by LF, CR LF or CR; blank ones are empty fields.
class Fields {
  public:
    Fields(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
    }

    std::string text(const std::string& what) { return as_utf8(next(what)); }

    double number(const std::string& what, double least, double most) {
        const std::string_view field = next(what);
        std::string word(field.starts_with('+') ? field.substr(1) : field);
        const std::size_t comma = word.find(',');
        if (comma != std::string::npos && word.find('.') == std::string::npos) word[comma] = '.';
        const auto value = finite_number(word);
        if (!value) refuse(what + ", a number");
        if (!(*value >= least && *value <= most)) {
            if (most >= 1e9) refuse(fmt::format("{}, {:g} or more", what, least));
            refuse(fmt::format("{}, from {:g} to {:g}", what, least, most));
        }
        return *value;
    }
    /// A whole number; a file that has not so many lines left is not believed.
    std::size_t count(const std::string& what, double least, double most) {
        const double value = number(what, least, most);
        if (value != std::floor(value)) refuse(what + ", a whole number");
        if (value > static_cast<double>(text_.size() - at_))
            refuse(what + ", no more than the file has room for");
        return static_cast<std::size_t>(value);
    }
    void skip(std::size_t lines, const std::string& what) {
        for (std::size_t i = 0; i < lines; ++i) next(what);
    }
    bool more() {
        const std::size_t found = text_.find_first_not_of(" \t\r\n\x1a", at_);
        if (found == std::string_view::npos) return false;
        begin_ = found;
        return true;
    }
    /// Of the field taken last.
    Place place() const { return place_at(file_, text_, begin_); }
    [[noreturn]] void refuse(const std::string& expected) const {
        throw Error(place(), fmt::format("found {}, expected {}", in_quotes(field_), expected));
    }

  private:
    std::string_view next(const std::string& what) {
        begin_ = at_;
        if (at_ >= text_.size()) throw Error(place(), "the file ends here, expected " + what);
        const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
        field_ = text_.substr(at_, end - at_);
        at_ = std::min(end + (text_.substr(end, 2) == "\r\n" ? 2 : 1), text_.size());
        const std::size_t first = field_.find_first_not_of(" \t\x1a");
        if (first == std::string_view::npos) {
            field_ = {};
        } else {
            begin_ += first;
            field_ = field_.substr(first, field_.find_last_not_of(" \t\x1a") - first + 1);
        }
        return field_;
    }

    std::string file_;
    std::string_view text_, field_;
    std::size_t at_ = 0, begin_ = 0;
};

// Length is along C90, for lamps lie across C0; no width means round.
Vec3 extents(double length, double width, double height) {
    if (width == 0) return {length * millimetre, length * millimetre, height * millimetre};
    return {width * millimetre, length * millimetre, height * millimetre};
}

class EulumdatReader {
  public:
    EulumdatReader(const std::string& file, std::string_view text, std::uint32_t lamp_set)
        : fields_(file, text), lamp_set_(lamp_set) {}

    LampFile read() {
        out_.format = "EULUMDAT";
        read_head();
        read_sizes();
        read_lamps();
        fields_.skip(10, "a direct ratio");  // 27
        read_table();
        if (fields_.more())
            out_.warnings.push_back({fields_.place(), "what follows the intensities is not read"});
        return std::move(out_);
    }

  private:
    void read_head() {
        Photometry& p = out_.photometry;
        p.maker = fields_.text("the manufacturer");                                 // 1
        fields_.number("the type of luminaire", 0, 9);                              // 2
        symmetry_ = static_cast<int>(fields_.count("the symmetry, 0 to 4", 0, 4));  // 3
        planes_ = fields_.count("the number of C-planes", 1, 1e9);                  // 4
        plane_place_ = fields_.place();
        fields_.skip(1, "the distance between C-planes");  // 5
        gammas_ = fields_.count("the number of intensities in a C-plane, two at least", 2, 1e9);
        fields_.skip(1, "the distance between intensities");        // 7
        fields_.skip(1, "the number of the measurement report");    // 8
        p.name = fields_.text("the name of the luminaire");         // 9
        p.catalogue = fields_.text("the number of the luminaire");  // 10
        fields_.skip(1, "the name of the file");                    // 11
        fields_.skip(1, "date and user");                           // 12
    }

    void read_sizes() {
        Photometry& p = out_.photometry;
        const auto size = [&](const char* what) { return fields_.number(what, 0, 1e6); };
        const double length = size("the length of the luminaire in mm");  // 13
        const double width = size("its width in mm");                     // 14
        const double height = size("its height in mm");                   // 15
        if (length > 0 && height > 0) p.housing = extents(length, width, height);
        const double opening_length = size("the length of the luminous area in mm");  // 16
        const double opening_width = size("its width in mm");                         // 17
        std::array<double, 4> sides;
        for (double& side : sides) side = size("a height of the luminous area in mm");  // 18 – 21
        fields_.number("the downward flux fraction in percent", 0, 1000);               // 22
        const double ratio = fields_.number("the light output ratio in percent", 0, 1000);  // 23
        if (ratio > 0) p.stated_lor = ratio / 100;
        factor_ = fields_.number("the conversion factor of intensities", 0, 1e9);  // 24
        fields_.number("the tilt during measurement in degrees", -360, 360);       // 25

        LuminousOpening& opening = p.opening;
        const double tallest = *std::max_element(sides.begin(), sides.end());
        if (opening_length == 0 && opening_width == 0 && tallest == 0) return;
        opening.size = extents(opening_length, opening_width, tallest);
        const bool round = opening_width == 0 && opening_length > 0;
        opening.shape = round ? LuminousOpening::Shape::cylinder : LuminousOpening::Shape::box;
        if (round) return;
        opening.sides_shine = false;
        for (std::size_t i = 0; i < 4; ++i) opening.sides[i] = sides[i] * millimetre;
    }

    void read_lamps() {
        Photometry& p = out_.photometry;
        const std::size_t sets = fields_.count("the number of sets of lamps", 1, 1e9);  // 26
        if (lamp_set_ < 1 || lamp_set_ > sets)
            throw Error(fields_.place(),
                        fmt::format("found {} of lamps, expected a set {}",
                                    sets == 1 ? "1 set" : fmt::format("{} sets", sets), lamp_set_));
        out_.lamp_sets = static_cast<std::uint32_t>(sets);
        for (std::size_t set = 1; set <= sets; ++set) {
            const double lamps = fields_.number("the number of lamps", -1e6, 1e6);
            const std::string type = fields_.text("the type of lamps");
            const double lumens =
                fields_.number("the lumens of the lamps together", 0, most_candela);
            fields_.skip(2, "colour temperature and colour rendering of the lamps");
            const double watts = fields_.number("the input watts", 0, 1e9);
            if (set != lamp_set_) continue;
            p.lamp = type;
            // A negative number of lamps: lumens and watts are the luminaire's own.
            p.absolute = lamps < 0;
            p.lamp_lumens = lumens;
            if (watts > 0) p.watts = watts;
            factor_ *= lumens / 1000;  // candelas are for lamps of 1000 lm
        }
    }

    void read_table() {
        Photometry& p = out_.photometry;
        std::vector<double> angles;  // 28
        for (std::size_t i = 0; i < planes_; ++i) {
            angles.push_back(fields_.number("the angle of a C-plane", 0, 360));
            if (i > 0 && !(angles[i] > angles[i - 1])) fields_.refuse("a C-plane beyond the last");
        }
        for (std::size_t j = 0; j < gammas_; ++j) {  // 29
            p.gammas.push_back(fields_.number("an angle γ", 0, 180));
            if (j > 0 && !(p.gammas[j] > p.gammas[j - 1]))
                fields_.refuse("an angle γ beyond the last");
        }
        std::vector<CPlane> table;  // 30
        for (const double c : given(angles)) {
            CPlane& plane = table.emplace_back(CPlane{c, {}});
            for (std::size_t j = 0; j < gammas_; ++j)
                plane.candela.push_back(factor_ *
                                        fields_.number("an intensity in cd/klm", 0, most_candela));
        }
        if (symmetry_ == 0 && angles.size() > 1) {
            double step = 0;
            for (std::size_t i = 1; i < angles.size(); ++i)
                step = std::max(step, angles[i] - angles[i - 1]);
            const double gap = angles.front() + 360 - angles.back();
            if (gap > 1.5 * step)
                out_.warnings.push_back(
                    {plane_place_, fmt::format("the C-planes end at {:g}°, {:g}° from the first "
                                               "one, with which they are taken to go on",
                                               angles.back(), gap)});
        }
        set_planes(p, std::move(table), symmetry());
    }

    LampSymmetry symmetry() const {
        constexpr std::array<LampSymmetry, 5> of_number{
            LampSymmetry::none, LampSymmetry::rotational, LampSymmetry::about_c0,
            LampSymmetry::about_c90, LampSymmetry::both};
        return of_number[static_cast<std::size_t>(symmetry_)];
    }

    // The planes whose intensities follow: all, the first, C0 to C180, C270 over C0 to C90, or C0
    // to C90.
    std::vector<double> given(const std::vector<double>& angles) const {
        constexpr double rounding = 1e-3;
        std::vector<double> out;
        const auto take = [&](double from, double to) {
            for (const double c : angles)
                if (c >= from - rounding && c <= to + rounding) out.push_back(c);
        };
        switch (symmetry_) {
            case 0:
                take(0, 360);
                break;
            case 1:
                out = {angles.front()};
                break;
            case 2:
                take(0, 180);
                break;
            case 3:
                take(270, 359);
                take(0, 90);
                break;
            default:
                take(0, 90);
        }
        const std::size_t least = symmetry_ <= 1 ? 1 : 2;
        if (out.size() < least)
            throw Error(plane_place_,
                        fmt::format("found no C-planes that fit the symmetry {}", symmetry_));
        return out;
    }

    Fields fields_;
    std::uint32_t lamp_set_;
    int symmetry_ = 0;
    std::size_t planes_ = 0, gammas_ = 0;
    Place plane_place_;
    double factor_ = 1;
    LampFile out_;
};

}  // namespace

LampFile parse_eulumdat(const std::string& file, std::string_view text, std::uint32_t lamp_set) {
    return EulumdatReader(file, text, lamp_set).read();
}

}  // namespace exitance
