// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/ies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "exitance/scene/formats/c_planes.h"
#include "exitance/scene/formats/ies_opening.h"
#include "exitance/scene/formats/ies_rotation.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr double feet = 0.3048;
constexpr double most_candela = 1e15;

bool same_letters(std::string_view a, std::string_view b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
               return std::tolower(static_cast<unsigned char>(x)) ==
                      std::tolower(static_cast<unsigned char>(y));
           });
}

std::string_view trimmed(std::string_view s) {
    constexpr std::string_view blanks = " \t\r\v\f";
    const std::size_t begin = s.find_first_not_of(blanks);
    if (begin == std::string_view::npos) return {};
    return s.substr(begin, s.find_last_not_of(blanks) - begin + 1);
}

/// Numbers between blanks, commas and line ends; lines mean nothing.
class Numbers {
  public:
    Numbers(std::string file, std::string_view text, std::size_t at)
        : file_(std::move(file)), text_(text), at_(at) {}

    double number(const std::string& what, double least, double most) {
        skip();
        begin_ = at_;
        const std::size_t end = std::min(text_.find_first_of(separators, at_), text_.size());
        const std::string_view word = text_.substr(at_, end - at_);
        if (word.empty()) throw Error(place(), "the file ends here, expected " + what);
        at_ = end;
        const auto value = finite_number(word.starts_with('+') ? word.substr(1) : word);
        if (!value) refuse(word, what + ", a number");
        if (!(*value >= least && *value <= most)) refuse(word, what + ", " + range(least, most));
        return *value;
    }
    // `most` beyond what the rest of the file can hold is no reason to believe it.
    std::size_t count(const std::string& what, double most) {
        const double value = number(what, 1, most);
        if (value != std::floor(value)) refuse(last(), what + ", a whole number");
        if (value > static_cast<double>(text_.size() - at_))
            refuse(last(), what + ", no more than the file has room for");
        return static_cast<std::size_t>(value);
    }
    std::vector<double> increasing(const std::string& what, std::size_t size, double least,
                                   double most) {
        std::vector<double> out;
        for (std::size_t i = 0; i < size; ++i) {
            out.push_back(number(what, least, most));
            if (i > 0 && !(out[i] > out[i - 1]))
                refuse(last(), fmt::format("{} above the one before, {:g}", what, out[i - 1]));
        }
        return out;
    }
    bool more() {
        skip();
        begin_ = at_;
        return at_ < text_.size();
    }
    /// Of the number taken last.
    Place place() const { return place_at(file_, text_, begin_); }
    [[noreturn]] void refuse(std::string_view found, const std::string& expected) const {
        throw Error(place(), fmt::format("found {}, expected {}", in_quotes(found), expected));
    }
    std::string_view last() const { return text_.substr(begin_, at_ - begin_); }

  private:
    static constexpr std::string_view separators{" \t\r\n\v\f,;\x1a\0", 9};

    static std::string range(double least, double most) {
        if (most >= 1e9) return fmt::format("{:g} or more", least);
        return fmt::format("from {:g} to {:g}", least, most);
    }
    void skip() { at_ = std::min(text_.find_first_not_of(separators, at_), text_.size()); }

    std::string file_;
    std::string_view text_;
    std::size_t at_, begin_ = 0;
};

LampTilt tilt_table(Numbers& numbers) {
    numbers.number("the lamp-to-luminaire geometry", 1, 3);
    const std::size_t size = numbers.count("the number of tilt angles", limits::elements);
    LampTilt tilt;
    tilt.angles = numbers.increasing("a tilt angle", size, -180, 360);
    for (std::size_t i = 0; i < size; ++i)
        tilt.factors.push_back(numbers.number("a tilt factor", 0, 1e3));
    return tilt;
}

class IesReader {
  public:
    IesReader(const std::string& file, std::string_view text, const ReadTilt& read_tilt)
        : file_(file), text_(text), read_tilt_(read_tilt) {}

    LampFile read() {
        read_labels();
        Numbers numbers(file_, text_, at_);
        read_tilt(numbers);
        read_lamp(numbers);
        read_table(numbers);
        if (numbers.more())
            out_.warnings.push_back({numbers.place(), "what follows the candelas is not read"});
        return std::move(out_);
    }

  private:
    // The first line names the edition, or is a label already (1986).
    void read_edition(std::string_view line) {
        const auto names = [&](std::string_view year) {
            return line.find(year) != std::string_view::npos;
        };
        std::string head(line.substr(0, 3));
        if (same_letters(head, "IES")) {
            for (const auto& [year, edition] :
                 {std::pair{"2019", IesEdition::y2019}, std::pair{"2002", IesEdition::y2002},
                  std::pair{"95", IesEdition::y1995}, std::pair{"91", IesEdition::y1991},
                  std::pair{"86", IesEdition::y1986}})
                if (names(year)) {
                    edition_ = edition;
                    named_ = true;
                    break;
                }
            if (!named_ && line.find(':') != std::string_view::npos) {
                edition_ = IesEdition::y2002;  // an edition that is not known, likely a later one
                out_.warnings.push_back({place_at(file_, text_, 0),
                                         fmt::format("{} is read as LM-63-2002", in_quotes(line))});
                named_ = true;
            }
        }
        out_.format = fmt::format("IES LM-63-{}", static_cast<int>(edition_));
    }

    // Lines up to TILT=: "[KEY] value" since 1991, free text before.
    void read_labels() {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
        std::string key;
        for (bool first = true; at_ < text_.size();) {
            // Lines end with LF, CR LF, or CR alone.
            const std::size_t begin = at_,
                              end = std::min(text_.find_first_of("\r\n", at_), text_.size());
            const std::string_view line = trimmed(text_.substr(begin, end - begin));
            at_ = std::min(end + (text_.substr(end, 2) == "\r\n" ? 2 : 1), text_.size());
            if (first && line.empty()) continue;
            if (first) read_edition(line);
            if (std::exchange(first, false) && named_) continue;
            if (same_letters(line.substr(0, 4), "TILT")) {
                std::string_view rest = trimmed(line.substr(4));
                if (rest.starts_with('=')) {
                    tilt_ = trimmed(rest.substr(1));
                    tilt_place_ = place_at(file_, text_,
                                           static_cast<std::size_t>(line.data() - text_.data()));
                    return;
                }
            }
            label(line, key);
        }
        throw Error(place_at(file_, text_, text_.size()),
                    "the file ends without a line TILT=, expected IES LM-63 photometry");
    }

    void label(std::string_view line, std::string& key) {
        if (line.starts_with('[')) {
            const std::size_t close = line.find(']');
            if (close == std::string_view::npos) return;
            key = std::string(line.substr(1, close - 1));
            std::transform(key.begin(), key.end(), key.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
            line = trimmed(line.substr(close + 1));
        } else if (!named_) {
            key = out_.photometry.name.empty() ? "LUMINAIRE" : "";
        }
        Photometry& p = out_.photometry;
        const auto keep = [&](std::string& text) {
            if (!line.empty()) text += (text.empty() ? "" : " ") + as_utf8(line);
        };
        if (key == "MORE") return;  // goes on with a label; what is kept fits one line
        if (key == "LUMINAIRE") keep(p.name);
        if (key == "MANUFAC") keep(p.maker);
        if (key == "LUMCAT") keep(p.catalogue);
        if (key == "LAMP") keep(p.lamp);
    }

    void read_tilt(Numbers& numbers) {
        Photometry& p = out_.photometry;
        if (same_letters(tilt_, "NONE")) return;
        if (same_letters(tilt_, "INCLUDE")) {
            p.tilt = tilt_table(numbers);
            return;
        }
        if (tilt_.empty())
            throw Error(tilt_place_, "found nothing after TILT=, expected NONE, INCLUDE or a file");
        // A file beside this one, and no other.
        if (tilt_.find_first_of("/\\:") != std::string_view::npos || !is_printable(tilt_) ||
            tilt_ == "." || tilt_ == "..")
            throw Error(tilt_place_, fmt::format("found the tilt file {}, expected the name of one "
                                                 "beside this file",
                                                 in_quotes(tilt_)));
        try {
            const TiltFile beside = read_tilt_(std::string(tilt_));
            Numbers of_file(beside.name, beside.text, 0);
            p.tilt = tilt_table(of_file);
        } catch (const Error& error) {
            throw Error(tilt_place_, error.what());
        }
    }
    static bool is_printable(std::string_view s) {
        return std::all_of(s.begin(), s.end(),
                           [](unsigned char c) { return c >= 0x20 && c != 0x7f; });
    }

    void read_lamp(Numbers& numbers) {
        Photometry& p = out_.photometry;
        const double lamps = numbers.number("the number of lamps", 0, 1e6);
        const double lumens = numbers.number("the lumens per lamp, or −1", -1, most_candela);
        p.absolute = lumens < 0;
        if (!p.absolute) p.lamp_lumens = lamps * lumens;
        factor_ = numbers.number("the candela multiplier", 0, 1e9);
        gammas_ = numbers.count("the number of vertical angles", limits::elements);
        planes_ = numbers.count("the number of horizontal angles", limits::elements);
        type_ =
            static_cast<int>(numbers.number("the photometric type: 1 (C), 2 (B) or 3 (A)", 1, 3));
        const double unit = numbers.number("the units: 1 (feet) or 2 (metres)", 1, 2);
        const double metres = unit < 2 ? feet : 1;
        const auto size = [&](const char* what) {
            return metres * numbers.number(what, -1e4, 1e4);
        };
        const double width = size("the width of the luminous opening");
        const double length = size("its length"), height = size("its height");
        p.opening = ies_opening(width, length, height, edition_);
        factor_ *= numbers.number("the ballast factor", 0, 1e3);
        // The ballast-lamp photometric factor until 1995; later reserved, or the kind of file.
        const double second = numbers.number("the ballast-lamp photometric factor", -1e9, 1e9);
        if (edition_ <= IesEdition::y1995) {
            if (second < 0) numbers.refuse(numbers.last(), "a factor of 0 or more");
            factor_ *= second;
        }
        const double watts = numbers.number("the input watts", -1, 1e9);
        if (watts > 0) p.watts = watts;
    }

    void read_table(Numbers& numbers) {
        Photometry& p = out_.photometry;
        if (gammas_ < 2)
            throw Error(numbers.place(),
                        "found one vertical angle in this file, expected two at "
                        "least");
        const bool c = type_ == 1;
        std::vector<double> gammas =
            numbers.increasing("a vertical angle", gammas_, c ? 0 : -90, c ? 180 : 90);
        const std::vector<double> planes =
            numbers.increasing("a horizontal angle", planes_, c ? 0 : -180, c ? 360 : 180);
        const Place last = numbers.place();
        std::vector<CPlane> table(planes_);
        double peak = 0, least = 0;
        Place negative;
        for (std::size_t i = 0; i < planes_; ++i) {
            table[i].c = planes[i];
            for (std::size_t j = 0; j < gammas_; ++j) {
                const double value = numbers.number("a candela value", -most_candela, most_candela);
                if (value < least) {
                    least = value;
                    negative = numbers.place();
                }
                peak = std::max(peak, value);
                table[i].candela.push_back(std::max(0.0, value) * factor_);
            }
        }
        // Measurements around zero come out a little below it.
        if (-least > 1e-3 * peak)
            throw Error(negative,
                        fmt::format("found the candela value {:g}, expected 0 or more", least));
        if (least < 0)
            out_.warnings.push_back({negative, fmt::format("candela values down to {:g} are taken "
                                                           "as 0",
                                                           least)});
        if (c) {
            p.gammas = std::move(gammas);
            set_planes(p, std::move(table), c_symmetry(planes, last));
        } else {
            rotate_to_c_planes(p, type_ == 3 ? IesType::a : IesType::b, gammas,
                               mirrored_sides(std::move(table), last));
        }
    }

    // What the range of horizontal angles leaves to symmetry (type C).
    LampSymmetry c_symmetry(const std::vector<double>& planes, const Place& last) {
        const auto near = [](double x, double y) { return std::abs(x - y) < 0.01; };
        if (planes.size() == 1) return LampSymmetry::rotational;
        const double from = planes.front(), to = planes.back();
        if (near(from, 0) && near(to, 90)) return LampSymmetry::both;
        if (near(from, 0) && near(to, 180)) return LampSymmetry::about_c0;
        if (near(from, 90) && near(to, 270)) return LampSymmetry::about_c90;
        if (near(from, 0) && to > 180) {
            if (!near(to, 360))
                out_.warnings.push_back(
                    {last, fmt::format("the horizontal angles end at {:g}, expected 360; the plane "
                                       "of 0 closes the circle",
                                       to)});
            return LampSymmetry::none;
        }
        throw Error(last, fmt::format("found horizontal angles from {:g} to {:g}, expected 0, or "
                                      "from 0 to 90, 180 or 360, or from 90 to 270",
                                      from, to));
    }

    // Types A and B: from 0 the other side is the same.
    static std::vector<CPlane> mirrored_sides(std::vector<CPlane> table, const Place& last) {
        if (table.front().c > 0)
            throw Error(last, fmt::format("found horizontal angles from {:g}, expected them from 0 "
                                          "or below",
                                          table.front().c));
        if (table.front().c < 0) return table;
        std::vector<CPlane> out;
        for (std::size_t i = table.size(); i-- > 1;) out.push_back({-table[i].c, table[i].candela});
        out.insert(out.end(), table.begin(), table.end());
        return out;
    }

    std::string file_;
    std::string_view text_;
    const ReadTilt& read_tilt_;
    std::size_t at_ = 0;
    IesEdition edition_ = IesEdition::y1986;
    bool named_ = false;
    std::string_view tilt_;
    Place tilt_place_;
    double factor_ = 1;
    std::size_t gammas_ = 0, planes_ = 0;
    int type_ = 1;
    LampFile out_;
};

}  // namespace

LampFile parse_ies(const std::string& file, std::string_view text, const ReadTilt& read_tilt) {
    return IesReader(file, text, read_tilt).read();
}

}  // namespace exitance
