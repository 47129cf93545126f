// SPDX-License-Identifier: Apache-2.0
#include "exitance/scene/formats/similarity_arguments.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "exitance/scene/formats/limits.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr std::uint64_t most_copies = std::uint64_t{1} << 63;

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
    return a > most_copies / b ? most_copies : a * b;
}

// Quarter turns exactly: a model full of -rz 90 keeps its right angles.
Transform rotation(std::size_t axis, double degrees) {
    const double angle = std::remainder(degrees, 360.0);
    const double radians = angle * std::numbers::pi / 180.0;
    double c = std::cos(radians), s = std::sin(radians);
    if (std::remainder(angle, 90.0) == 0) c = std::round(c), s = std::round(s);
    Transform out;
    const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
    Vec3 to_j{}, to_k{};
    to_j[j] = c, to_j[k] = s;
    to_k[j] = -s, to_k[k] = c;
    const auto image = [&](std::size_t of) -> Vec3& {
        return of == 0 ? out.x : of == 1 ? out.y : out.z;
    };
    image(j) = to_j;
    image(k) = to_k;
    return out;
}

Transform power(Transform base, std::uint64_t exponent) {
    Transform out;
    for (; exponent > 0; exponent >>= 1U) {
        if ((exponent & 1U) != 0) out = base.after(out);
        base = base.after(base);
    }
    return out;
}

}  // namespace

void SimilarityArguments::parse(std::span<const std::string_view> words) {
    std::size_t at = 0;
    const auto wrong = [&](const char* expected) {
        wrong_ = at;
        expected_ = expected;
    };
    const auto number = [&](const char* expected, double least, double most) {
        const auto value = at < words.size() ? finite_number(words[at]) : std::nullopt;
        if (!value || *value < least || *value > most) {
            wrong(expected);
            return 0.0;
        }
        ++at;
        return *value;
    };
    while (at < words.size() && expected_ == nullptr) {
        const std::string_view flag = words[at];
        const bool turns = flag == "-rx" || flag == "-ry" || flag == "-rz";
        const bool mirrors = flag == "-mx" || flag == "-my" || flag == "-mz";
        if (!turns && !mirrors && flag != "-t" && flag != "-s" && flag != "-i" && flag != "-a")
            break;
        ++at;
        Transform step;
        if (flag == "-t") {
            for (std::size_t axis = 0; axis < 3 && expected_ == nullptr; ++axis)
                step.origin[axis] = number("a distance (three numbers after -t)",
                                           -limits::coordinate, limits::coordinate);
        } else if (turns) {
            step = rotation(static_cast<std::size_t>(flag[2] - 'x'),
                            number("an angle in degrees", -1e9, 1e9));
        } else if (flag == "-s") {
            const double factor = number("a scale, not zero", -1e9, 1e9);
            if (expected_ == nullptr && std::abs(factor) < 1e-12) {
                --at;
                wrong("a scale, not zero");
            }
            step = Transform::scale(factor);
        } else if (mirrors) {
            (flag[2] == 'x' ? step.x.x : flag[2] == 'y' ? step.y.y : step.z.z) = -1;
        } else {
            const double count = number("a whole number, at least 1", 1, 1e15);
            if (expected_ == nullptr && count != std::floor(count)) {
                --at;
                wrong("a whole number, at least 1");
            }
            parts_.push_back({{}, static_cast<std::uint64_t>(count), flag == "-a"});
            continue;
        }
        parts_.back().map = step.after(parts_.back().map);
    }
    taken_ = at;
}

void SimilarityArguments::refuse(std::span<const std::string_view> words,
                                 const Place& place) const {
    throw Error(place, fmt::format("found {}, expected {}",
                                   wrong_ < words.size() ? in_quotes(words[wrong_])
                                                         : std::string("the end of the line"),
                                   expected_));
}

bool SimilarityArguments::is_array() const {
    for (const Part& part : parts_)
        if (part.array) return true;
    return false;
}

std::uint64_t SimilarityArguments::copies() const {
    std::uint64_t out = 1;
    for (const Part& part : parts_)
        if (part.array) out = product(out, part.count);
    return out;
}

std::vector<std::uint64_t> SimilarityArguments::indices(std::uint64_t index) const {
    std::vector<std::uint64_t> out;
    for (auto part = parts_.rbegin(); part != parts_.rend(); ++part)
        if (part->array) {
            out.insert(out.begin(), index % part->count);
            index /= part->count;
        }
    return out;
}

Transform SimilarityArguments::copy(std::uint64_t index) const {
    const std::vector<std::uint64_t> elements = indices(index);
    Transform out;
    std::size_t array = 0;
    for (const Part& part : parts_)
        out = power(part.map, part.array ? elements[array++] : part.count).after(out);
    return out;
}

double scale_of(const Transform& similarity) {
    return std::cbrt(std::abs(similarity.determinant()));
}

}  // namespace exitance
