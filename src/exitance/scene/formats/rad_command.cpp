// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/rad_command.h"

#include <fmt/format.h>

#include <array>
#include <span>

#include "exitance/math/vector.h"
#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

using Words = std::span<const std::string>;

// Words of the commands between pipes, with quotes taken off.
std::vector<std::vector<std::string>> split(const std::string& line, const Place& place) {
    std::vector<std::vector<std::string>> out(1);
    std::string word;
    bool in_word = false;
    char quote = 0;
    const auto end_word = [&] {
        if (in_word) out.back().push_back(word);
        word.clear();
        in_word = false;
    };
    for (const char c : line) {
        if (quote != 0) {
            if (c == quote)
                quote = 0;
            else
                word += c;
        } else if (c == '\'' || c == '"') {
            quote = c;
            in_word = true;
        } else if (c == ' ' || c == '\t') {
            end_word();
        } else if (c == '|') {
            end_word();
            out.emplace_back();
        } else if (c == '#' && !in_word) {
            break;
        } else if (std::string_view(";&<>$`(){}*?~\\").find(c) != std::string_view::npos) {
            throw Error(place, fmt::format("found '{}' in the command {}, expected plain words: "
                                           "nothing is executed",
                                           c, in_quotes(line)));
        } else {
            word += c;
            in_word = true;
        }
    }
    if (quote != 0)
        throw Error(place, fmt::format("found a quote that does not end in the command {}",
                                       in_quotes(line)));
    end_word();
    return out;
}

class CommandWords {
  public:
    CommandWords(Words words, const Place& place) : words_(words), place_(place) {}

    bool ended() const { return at_ == words_.size(); }
    const std::string& peek() const { return words_[at_]; }
    const std::string& next(const std::string& expected) {
        if (ended()) refuse("the end of the command", expected);
        return words_[at_++];
    }
    double number(const std::string& expected) {
        const std::string& word = next(expected);
        const auto value = finite_number(word);
        if (!value || std::abs(*value) > limits::coordinate) refuse(in_quotes(word), expected);
        return *value;
    }
    [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
        throw Error(place_, fmt::format("found {} in the command '{}', expected {}", found,
                                        words_[0], expected));
    }
    Words rest() const { return words_.subspan(at_); }
    void skip(std::size_t count) { at_ += count; }
    const Place& place() const { return place_; }

  private:
    Words words_;
    const Place& place_;
    std::size_t at_ = 1;  // after the command's name
};

std::string polygon_text(const std::string& modifier, const std::string& name, std::size_t number,
                         std::span<const Vec3> corners) {
    std::string out =
        fmt::format("{} polygon {}.{} 0 0 {}", modifier, name, number, 3 * corners.size());
    for (const Vec3& c : corners) out += fmt::format(" {} {} {}", c.x, c.y, c.z);
    return out + "\n";
}

std::string reversed_polygon_text(const std::string& modifier, const std::string& name,
                                  std::size_t number, std::vector<Vec3> corners, bool reverse) {
    if (reverse) std::reverse(corners.begin(), corners.end());
    return polygon_text(modifier, name, number, corners);
}

// genbox modifier name x y z [-i] [-r radius | -b bevel]
std::string genbox(CommandWords& words, std::vector<std::string>& ignored) {
    const std::string modifier = words.next("a modifier"), name = words.next("a name");
    Vec3 size;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        size[axis] = words.number("three sizes above 0");
        if (!(size[axis] > 0))
            words.refuse(fmt::format("the size {:g}", size[axis]), "one above 0");
    }
    bool inward = false;
    while (!words.ended()) {
        const std::string option = words.next("");
        if (option == "-i") {
            inward = true;
        } else if (option == "-r" || option == "-b") {
            words.number("a length after " + option);
            ignored.push_back("genbox " + option);
        } else {
            words.refuse(in_quotes(option), "-i, -r or -b");
        }
    }
    std::string out;
    std::size_t number = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool far : {false, true}) {
            const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
            std::vector<Vec3> corners(4);
            for (std::size_t c = 0; c < 4; ++c) {
                corners[c][axis] = far ? size[axis] : 0;
                corners[c][j] = c == 1 || c == 2 ? size[j] : 0;
                corners[c][k] = c >= 2 ? size[k] : 0;
            }
            // j, k, axis are right-handed: this order faces along +axis.
            out += reversed_polygon_text(modifier, name, ++number, corners, far == inward);
        }
    return out;
}

// genprism modifier name N x1 y1 … xN yN [-l x y z] [-r radius] [-c] [-e]
std::string genprism(CommandWords& words, std::vector<std::string>& ignored) {
    const std::string modifier = words.next("a modifier"), name = words.next("a name");
    const double wanted = words.number("a number of corners on the command line, 3 or more");
    if (!(wanted >= 3) || wanted != std::floor(wanted))
        words.refuse(fmt::format("{:g} corners", wanted), "a whole number, 3 or more");
    std::vector<Vec3> base;
    while (static_cast<double>(base.size()) < wanted) {
        const double x = words.number("the x of a corner");
        base.push_back({x, words.number("the y of a corner"), 0});
    }
    Vec3 along{0, 0, 1};
    bool open = false, ends = true;
    while (!words.ended()) {
        const std::string option = words.next("");
        if (option == "-l") {
            for (std::size_t axis = 0; axis < 3; ++axis)
                along[axis] = words.number("three numbers after -l");
        } else if (option == "-r") {
            words.number("a radius after -r");
            ignored.push_back("genprism -r");
        } else if (option == "-c") {
            open = true;
        } else if (option == "-e") {
            ends = false;
        } else {
            words.refuse(in_quotes(option), "-l, -r, -c or -e");
        }
    }
    std::string out;
    std::size_t number = 0;
    std::vector<Vec3> top;
    for (const Vec3& c : base) top.push_back(c + along);
    if (ends) {
        out += polygon_text(modifier, name, ++number, base);
        out += reversed_polygon_text(modifier, name, ++number, top, true);
    }
    for (std::size_t i = 0; i + (open ? 1 : 0) < base.size(); ++i) {
        const std::size_t j = (i + 1) % base.size();
        out += polygon_text(modifier, name, ++number, std::array{base[i], top[i], top[j], base[j]});
    }
    return out;
}

RadXform xform(CommandWords& words) {
    RadXform out;
    while (!words.ended()) {
        const std::string& option = words.peek();
        if (option == "-n") {
            words.skip(1);
            out.name = words.next("a name after -n");
        } else if (option == "-m") {
            words.skip(1);
            out.modifier = words.next("a modifier after -m");
        } else if (option == "-I") {
            words.skip(1);
            out.invert = true;
        } else if (option == "-c" || option == "-e") {  // who expands commands: we always do
            words.skip(1);
        } else {
            break;
        }
    }
    std::vector<std::string_view> rest(words.rest().begin(), words.rest().end());
    out.arguments =
        SimilarityArguments(rest, [&](std::size_t) -> const Place& { return words.place(); });
    words.skip(out.arguments.taken());
    if (!words.ended() && words.peek().size() > 1 && words.peek()[0] == '-')
        words.refuse(in_quotes(words.peek()),
                     "-n, -m, -I, -c, -e, then -t, -rx, -ry, -rz, -s, -mx, -my, -mz, -i, -a, then "
                     "files");
    return out;
}

}  // namespace

RadCommand understand_rad_command(const std::string& line, const Place& place) {
    RadCommand out;
    const auto commands = split(line, place);
    for (std::size_t i = 0; i < commands.size(); ++i) {
        const std::string name = commands[i].empty() ? "" : commands[i][0];
        CommandWords words(commands[i], place);
        if (i == 0 && name == "genbox") {
            out.generated = genbox(words, out.ignored);
        } else if (i == 0 && name == "genprism") {
            out.generated = genprism(words, out.ignored);
        } else if (name == "xform") {
            out.xforms.push_back(xform(words));
            if (i == 0 && words.ended())
                words.refuse("the end of the command", "the name of a file");
            if (i > 0 && !words.ended())
                words.refuse(in_quotes(words.peek()), "the end of the command: it reads a pipe");
            while (!words.ended()) out.files.push_back(words.next(""));
        } else {
            throw Error(place,
                        fmt::format("found the command {}, expected xform, genbox or genprism{}; "
                                    "commands are never executed",
                                    in_quotes(name), i == 0 ? "" : " piped into xform"));
        }
    }
    return out;
}

}  // namespace exitance
