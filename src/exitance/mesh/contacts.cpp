// SPDX-License-Identifier: Apache-2.0
#include "exitance/mesh/contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "exitance/math/box_tree.h"
#include "exitance/math/polygon.h"
#include "exitance/run/parallel.h"

namespace exitance {

namespace {

/// A flat polygon with its plane.
struct Flat {
    std::array<Vec3, 4> at;
    std::uint32_t count = 0;
    Vec3 normal;

    std::span<const Vec3> corners() const { return {at.data(), count}; }
};

struct Range {
    double low, high;
};

// The part of the line origin + t · direction, `range` of it, that lies within the polygon.
std::optional<Range> clip(const Flat& polygon, const Vec3& origin, const Vec3& direction,
                          Range range, double tolerance) {
    for (std::uint32_t i = 0; i < polygon.count; ++i) {
        const Vec3& a = polygon.at[i];
        const Vec3 inward =
            normalized(cross(polygon.normal, polygon.at[(i + 1) % polygon.count] - a));
        const double start = dot(origin - a, inward), slope = dot(direction, inward);
        if (std::abs(slope) < 1e-9) {
            if (start < -tolerance) return std::nullopt;
            continue;
        }
        const double t = (-start) / slope;
        if (slope > 0)
            range.low = std::max(range.low, t);
        else
            range.high = std::min(range.high, t);
        if (range.low >= range.high) return std::nullopt;
    }
    return range;
}

// Where `other` meets the plane of `base`, within `base`.
std::optional<Contact> contact_of(const Flat& base, const Flat& other, double tolerance) {
    std::array<double, 4> distance{};
    double low = INFINITY, high = -INFINITY;
    for (std::uint32_t i = 0; i < other.count; ++i) {
        double d = dot(other.at[i] - base.at[0], base.normal);
        if (std::abs(d) < tolerance) d = 0;
        distance[i] = d;
        low = std::min(low, d), high = std::max(high, d);
    }
    if (low > 0 || high < 0 || low == high) return std::nullopt;

    // The corners in the plane and the crossings of edges: two of them, or the ends of a row.
    std::array<Vec3, 8> met;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < other.count; ++i) {
        const std::uint32_t j = (i + 1) % other.count;
        if (distance[i] == 0) met[count++] = other.at[i];
        if (distance[i] * distance[j] < 0)
            met[count++] = other.at[i] + (other.at[j] - other.at[i]) *
                                             (distance[i] / (distance[i] - distance[j]));
    }
    if (count < 2) return std::nullopt;
    Vec3 from = met[0], to = met[1];
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 1; j < count; ++j)
            if (length(met[j] - met[i]) > length(to - from)) from = met[i], to = met[j];
    const double whole = length(to - from);
    if (whole <= tolerance) return std::nullopt;
    const Vec3 direction = (to - from) / whole;
    const auto part = clip(base, from, direction, {0, whole}, tolerance);
    if (!part) return std::nullopt;
    return Contact{from + direction * part->low, from + direction * part->high, 0};
}

// The sides of a lamp that lies in the plane of `base`, as far as they lie within it.
void add_outline(const Flat& base, const Flat& lamp, std::uint32_t number, double tolerance,
                 std::vector<Contact>& out) {
    for (const Vec3& corner : lamp.corners())
        if (std::abs(dot(corner - base.at[0], base.normal)) > tolerance) return;
    for (std::uint32_t i = 0; i < lamp.count; ++i) {
        const Vec3 from = lamp.at[i], side = lamp.at[(i + 1) % lamp.count] - from;
        const double whole = length(side);
        if (whole <= tolerance) continue;
        const Vec3 direction = side / whole;
        if (const auto part = clip(base, from, direction, {0, whole}, tolerance))
            out.push_back({from + direction * part->low, from + direction * part->high, number});
    }
}

}  // namespace

std::vector<std::vector<Contact>> find_contacts(const Scene& scene, double shortest,
                                                double tolerance) {
    std::vector<Flat> flat(scene.polygons.size());
    std::vector<Box> boxes;
    std::vector<std::uint32_t> large;  // only these can have contacts long enough
    for (std::size_t p = 0; p < scene.polygons.size(); ++p) {
        Flat& f = flat[p];
        f.at = scene.corners(scene.polygons[p]);
        f.count = scene.polygons[p].size();
        f.normal = unit_normal(f.corners());
        Box box;
        for (const Vec3& c : f.corners()) box.add(c);
        if (box.diagonal() < shortest || planarity_error(f.corners()) > tolerance) continue;
        box.lower = box.lower - Vec3{tolerance, tolerance, tolerance};
        box.upper = box.upper + Vec3{tolerance, tolerance, tolerance};
        boxes.push_back(box);
        large.push_back(static_cast<std::uint32_t>(p));
    }
    const BoxTree tree(boxes);
    std::vector<Box> lamp_boxes;
    std::vector<std::uint32_t> lamps;
    for (std::size_t p = 0; p < flat.size(); ++p) {
        if (!scene.material(scene.polygons[p]).emits() || !(area(flat[p].corners()) > 0)) continue;
        lamp_boxes.emplace_back();
        for (const Vec3& c : flat[p].corners()) lamp_boxes.back().add(c);
        lamps.push_back(static_cast<std::uint32_t>(p));
    }
    const BoxTree tree_of_lamps(lamp_boxes);
    std::vector<std::vector<Contact>> out(scene.polygons.size());
    parallel_for(large.size(), [&](std::size_t k) {
        const Flat& base = flat[large[k]];
        std::vector<Contact>& contacts = out[large[k]];
        tree.for_overlapping(boxes[k], [&](std::uint32_t other) {
            if (other == k) return;
            auto contact = contact_of(base, flat[large[other]], tolerance);
            if (!contact || length(contact->to - contact->from) < shortest) return;
            contact->polygon = large[other];
            contacts.push_back(*contact);
        });
        if (!scene.material(scene.polygons[large[k]]).emits())
            tree_of_lamps.for_overlapping(boxes[k], [&](std::uint32_t lamp) {
                add_outline(base, flat[lamps[lamp]], lamps[lamp], tolerance, contacts);
            });
        std::sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) {
            const double x = length(a.to - a.from), y = length(b.to - b.from);
            return x != y ? x > y : a.polygon < b.polygon;
        });
    });
    return out;
}

}  // namespace exitance
