// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/json_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr std::size_t deepest = 64;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

// Offset of the first bracket that nests deeper than `deepest`; npos if none does.
std::size_t too_deep_at(std::string_view text) {
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > deepest) return i;
        } else if (c == ']' || c == '}') {
            if (depth > 0) --depth;
        }
    }
    return std::string_view::npos;
}

// Walks over JSON that has been parsed before, so it is known to be well formed.
class Walker {
  public:
    /// `visit(path, offset, is_object)` is called for every value, outer ones first; it tells
    /// whether the names of the values inside are wanted.
    using Visit = std::function<bool(const std::string&, std::size_t, bool)>;
    Walker(std::string_view text, Visit visit) : text_(text), visit_(std::move(visit)) {}

    void walk() { value("", true); }

  private:
    void skip_space() {
        while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    }
    // At a value, or at the comma or bracket that closes one.
    char here() {
        skip_space();
        return at_ < text_.size() ? text_[at_] : '\0';
    }
    std::string_view string() {
        const std::size_t begin = ++at_;
        while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
        const std::string_view inside = text_.substr(std::min(begin, text_.size()), at_ - begin);
        ++at_;
        return inside;
    }
    void value(const std::string& path, bool wanted) {
        const char first = here();
        const bool inside = wanted && visit_(path, at_, first == '{');
        if (first == '{') {
            ++at_;
            while (here() == '"') {
                const std::string_view key = string();
                here();
                ++at_;  // the colon
                value(inside ? (path.empty() ? "" : path + ".") + std::string(key) : "", inside);
                if (here() == ',') ++at_;
            }
            ++at_;
        } else if (first == '[') {
            ++at_;
            for (std::size_t i = 0; at_ < text_.size() && here() != ']'; ++i) {
                value(inside ? path + "[" + std::to_string(i) + "]" : "", inside);
                if (here() == ',') ++at_;
            }
            ++at_;
        } else if (first == '"') {
            string();
        } else {
            while (at_ < text_.size() && !is_space(text_[at_]) && text_[at_] != ',' &&
                   text_[at_] != ']' && text_[at_] != '}')
                ++at_;
        }
    }

    std::string_view text_;
    Visit visit_;
    std::size_t at_ = 0;
};

// Is `outer` the path of `path` or of a value around it?
bool leads_to(const std::string& outer, const std::string& path) {
    if (path.compare(0, outer.size(), outer) != 0) return false;
    if (outer.empty() || outer.size() == path.size()) return true;
    return path[outer.size()] == '.' || path[outer.size()] == '[';
}

// What the library says after its own prefix and position.
std::string reason(const std::string& what) {
    for (const char* before : {"column ", "] "}) {
        std::size_t begin = what.find(before);
        if (begin == std::string::npos) continue;
        begin += std::string(before).size();
        if (before[0] == 'c') begin = what.find(": ", begin) + 2;
        std::string text = as_utf8(what.substr(begin));
        if (text.size() > 200) text = as_utf8(text.substr(0, 200)) + "…";
        return text;
    }
    return what;
}

}  // namespace

JsonText::JsonText(std::string file, std::string_view text, bool lines)
    : file_(std::move(file)), text_(text), lines_(lines) {
    const auto fail = [&](std::size_t offset, const std::string& message) {
        if (lines_) throw Error(place_at(file_, text_, offset), message);
        throw Error({file_, 0, 0}, fmt::format("in its JSON, byte {}: {}", offset + 1, message));
    };
    const std::size_t deep = too_deep_at(text);
    if (deep != std::string_view::npos)
        fail(deep, fmt::format("found JSON nested deeper than {} levels", deepest));
    try {
        root_ = std::make_shared<const nlohmann::json>(nlohmann::json::parse(text));
    } catch (const nlohmann::json::parse_error& error) {
        fail(error.byte > 0 ? error.byte - 1 : 0, "not JSON: " + reason(error.what()));
    } catch (const nlohmann::json::exception& error) {  // a number beyond double
        const std::string message = error.what();
        const std::size_t open = message.find('\''), close = message.rfind('\'');
        const std::size_t at = close > open + 1 && close != std::string::npos
                                   ? text.find(message.substr(open + 1, close - open - 1))
                                   : std::string_view::npos;
        fail(at == std::string_view::npos ? 0 : at, "not JSON: " + reason(message));
    }
    if (!lines_) return;
    line_begins_.push_back(0);
    for (std::size_t i = 0; i < text.size(); ++i)
        if (text[i] == '\n') line_begins_.push_back(i + 1);
    Walker(text, [&](const std::string& path, std::size_t at, bool is_object) {
        if (is_object) objects_.emplace(path, at);
        return true;
    }).walk();
}

Place JsonText::place(const std::string& path) const {
    if (!lines_) return {file_, 0, 0};
    std::size_t offset = 0;
    if (const auto known = objects_.find(path); known != objects_.end()) {
        offset = known->second;
    } else {
        Walker(text_, [&](const std::string& outer, std::size_t at, bool) {
            if (!leads_to(outer, path)) return false;
            offset = at;
            return true;
        }).walk();
    }
    const auto after = std::upper_bound(line_begins_.begin(), line_begins_.end(), offset);
    const std::size_t begin = *(after - 1);
    Place place = place_at(file_, text_.substr(begin), offset - begin);
    place.line = static_cast<std::size_t>(after - line_begins_.begin());
    return place;
}

void JsonText::refuse(const std::string& path, const std::string& message) const {
    throw Error(place(path), path.empty() ? message : path + ": " + message);
}

void JsonNode::expected(const std::string& what) const {
    const std::string found =
        value->is_structured()
            ? value->is_array() ? "an array" : "an object"
            : in_quotes(value->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace));
    text->refuse(path, fmt::format("found {}, expected {}", found, what));
}

JsonNode JsonNode::member(const std::string& key) const {
    if (!value->is_object()) expected("an object");
    const auto found = value->find(key);
    return {text, found == value->end() ? nullptr : &*found, path.empty() ? key : path + "." + key};
}

JsonNode JsonNode::required(const std::string& key) const {
    JsonNode node = member(key);
    if (!node) text->refuse(path, fmt::format("'{}' is missing", key));
    return node;
}

JsonNode JsonNode::element(std::size_t i) const {
    return {text, &(*value)[i], fmt::format("{}[{}]", path, i)};
}

std::size_t JsonNode::array_size() const {
    if (!value->is_array()) expected("an array");
    return value->size();
}

double JsonNode::number(double least, double most, const std::string& what) const {
    if (!value->is_number()) expected(what);
    const double number = value->get<double>();
    if (!(number >= least && number <= most)) expected(what);
    return number;
}

std::size_t JsonNode::whole(std::size_t least, std::size_t most, const std::string& what) const {
    if (!value->is_number_unsigned()) expected(what);
    const auto number = value->get<std::size_t>();
    if (number < least || number > most) expected(what);
    return number;
}

std::size_t JsonNode::index(std::size_t count, const std::string& what) const {
    if (count == 0) expected("nothing here: the file has no " + what);
    return whole(0, count - 1, fmt::format("an index of {}, 0 to {}", what, count - 1));
}

const std::string& JsonNode::string() const {
    if (!value->is_string()) expected("a string");
    return value->get_ref<const std::string&>();
}

bool JsonNode::boolean() const {
    if (!value->is_boolean()) expected("true or false");
    return value->get<bool>();
}

void JsonNode::numbers(std::size_t size, double least, double most) const {
    if (array_size() != size) expected(fmt::format("an array of {} numbers", size));
    for (std::size_t i = 0; i < size; ++i)
        element(i).number(least, most, fmt::format("a number from {:g} to {:g}", least, most));
}

}  // namespace exitance
