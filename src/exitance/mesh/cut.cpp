// SPDX-License-Identifier: Apache-2.0
#include "exitance/mesh/cut.h"

#include <algorithm>
#include <cmath>

#include "exitance/math/polygon.h"

namespace exitance {

namespace {

// A piece of up to five corners, while it is being cut.
struct Loop {
    std::vector<std::uint32_t> corners;
    std::vector<Piece::Side> sides;

    void add(std::uint32_t corner, const Piece::Side& side) {
        corners.push_back(corner);
        sides.push_back(side);
    }
};

class Cutting {
  public:
    Cutting(std::span<const Vec3> corners, double snap)
        : snap_(snap), normal_(unit_normal(corners)), sides_(corners.size()) {
        out_.places.assign(corners.begin(), corners.end());
        const auto n = static_cast<std::uint32_t>(corners.size());
        Loop whole;
        for (std::uint32_t i = 0; i < n; ++i) {
            out_.lines.push_back({i, (i + 1) % n, {}, {}});
            whole.add(i, {i, 0, 1});
        }
        loops_.push_back(whole);
    }

    void cut_along(const Contact& contact) {
        const std::size_t count = loops_.size();
        for (std::size_t k = 0; k < count; ++k) cut_loop(k, contact);
    }

    CutPolygon finish(std::span<const Contact> contacts) {
        for (const Loop& loop : loops_) {
            Piece piece;
            piece.count = static_cast<std::uint32_t>(loop.corners.size());
            std::copy(loop.corners.begin(), loop.corners.end(), piece.corners.begin());
            std::copy(loop.sides.begin(), loop.sides.end(), piece.sides.begin());
            out_.pieces.push_back(piece);
        }
        for (std::size_t k = 0; k < contacts.size(); ++k) note(contacts, k);
        return std::move(out_);
    }

  private:
    const Vec3& place(std::uint32_t i) const { return out_.places[i]; }

    // Divides a loop in two where the contact runs through it.
    void cut_loop(std::size_t k, const Contact& contact) {
        const Loop loop = loops_[k];
        const std::size_t n = loop.corners.size();
        const double whole = length(contact.to - contact.from);
        const Vec3 along = (contact.to - contact.from) / whole;
        const Vec3 across = cross(normal_, along);
        std::vector<double> d(n);
        bool left = false, right = false;
        for (std::size_t i = 0; i < n; ++i) {
            d[i] = dot(place(loop.corners[i]) - contact.from, across);
            if (std::abs(d[i]) < snap_) d[i] = 0;
            left |= d[i] > 0, right |= d[i] < 0;
        }
        if (!left || !right) return;
        // Where the whole line would pass through the loop, and whether the contact does.
        double low = INFINITY, high = -INFINITY;
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t j = (i + 1) % n;
            if (d[i] != 0 && d[i] * d[j] >= 0) continue;
            const double t = d[i] == 0 ? 0 : d[i] / (d[i] - d[j]);
            const Vec3 p = place(loop.corners[i]) * (1 - t) + place(loop.corners[j]) * t;
            const double s = dot(p - contact.from, along);
            low = std::min(low, s), high = std::max(high, s);
        }
        if (std::min(high, whole) - std::max(low, 0.0) < 10 * snap_) return;

        std::array<Loop, 2> half;
        std::array<std::uint32_t, 2> cuts{};
        std::size_t found = 0;
        const auto seam = static_cast<std::uint32_t>(out_.lines.size());
        // Each half runs along the loop, and back along the seam after it leaves the other's side.
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t j = (i + 1) % n;
            const std::uint32_t corner = loop.corners[i];
            const Piece::Side& side = loop.sides[i];
            if (d[i] == 0) {
                for (std::size_t h = 0; h < 2; ++h) {
                    // The half that goes on along the loop, and the one that turns into the seam.
                    const bool goes_on = h == 0 ? d[j] > 0 : d[j] < 0;
                    half[h].add(corner, goes_on ? side : Piece::Side{seam, 0, 0});
                }
                if (found < 2) cuts[found++] = corner;
                continue;
            }
            Loop& own = half[d[i] > 0 ? 0 : 1];
            if (d[i] * d[j] >= 0) {
                own.add(corner, side);
                continue;
            }
            const double t = side.begin + (side.end - side.begin) * (d[i] / (d[i] - d[j]));
            const Mark at = mark(side.line, t);
            own.add(corner, {side.line, side.begin, at.t});
            own.add(at.place, {seam, 0, 0});
            half[d[i] > 0 ? 1 : 0].add(at.place, {side.line, at.t, side.end});
            if (found < 2) cuts[found++] = at.place;
        }
        for (Loop& part : half) {
            drop_repeated(part);
            if (part.corners.size() < 3) return;
        }
        out_.lines.push_back({cuts[0], cuts[1], {}, {}});
        for (Loop& part : half)
            for (std::size_t i = 0; i < part.sides.size(); ++i)
                if (part.sides[i].line == seam) {
                    const bool forward = part.corners[i] == cuts[0];
                    part.sides[i].begin = forward ? 0 : 1;
                    part.sides[i].end = forward ? 1 : 0;
                }
        loops_[k] = half[0];
        loops_.push_back(half[1]);
        split_pentagon(k);
        split_pentagon(loops_.size() - 1);
    }

    static void drop_repeated(Loop& loop) {
        for (std::size_t i = loop.corners.size(); i-- > 0;) {
            if (loop.corners[i] != loop.corners[(i + 1) % loop.corners.size()]) continue;
            loop.corners.erase(loop.corners.begin() + static_cast<std::ptrdiff_t>(i));
            loop.sides.erase(loop.sides.begin() + static_cast<std::ptrdiff_t>(i));
        }
    }

    struct Mark {
        double t;
        std::uint32_t place;
    };
    // The place at t of a line, one that exists if it is near.
    Mark mark(std::uint32_t line_number, double t) {
        CutLine& line = out_.lines[line_number];
        const Vec3 from = place(line.from), to = place(line.to);
        const double near = snap_ / length(to - from);
        if (t < near) return {0, line.from};
        if (t > 1 - near) return {1, line.to};
        for (const CutLine::Mark& m : line.marks)
            if (std::abs(m.at - t) < near) return {m.at, m.place};
        const auto fresh = static_cast<std::uint32_t>(out_.places.size());
        out_.places.push_back(from + (to - from) * t);
        line.marks.push_back({t, fresh});
        return {t, fresh};
    }

    // Into a quadrilateral and the triangle that leaves both in best shape.
    void split_pentagon(std::size_t k) {
        const Loop loop = loops_[k];
        const std::size_t n = loop.corners.size();
        if (n <= 4) return;
        const auto quality = [&](std::initializer_list<std::size_t> which) {
            std::vector<Vec3> p;
            for (const std::size_t i : which) p.push_back(place(loop.corners[i % n]));
            const double longest = longest_side(p);
            return area(p) / (longest * longest);
        };
        std::size_t best = 0;
        double best_quality = -1;
        for (std::size_t i = 0; i < n; ++i) {
            const double q =
                std::min(quality({i, i + 1, i + 2}), quality({i, i + 2, i + 3, i + 4}));
            if (q > best_quality) best_quality = q, best = i;
        }
        const auto at = [&](std::size_t i) { return (best + i) % n; };
        const auto seam = static_cast<std::uint32_t>(out_.lines.size());
        out_.lines.push_back({loop.corners[at(0)], loop.corners[at(2)], {}, {}});
        Loop triangle, rest;
        for (const std::size_t i : {0, 1}) triangle.add(loop.corners[at(i)], loop.sides[at(i)]);
        triangle.add(loop.corners[at(2)], {seam, 1, 0});
        rest.add(loop.corners[at(0)], {seam, 0, 1});
        for (const std::size_t i : {2, 3, 4}) rest.add(loop.corners[at(i)], loop.sides[at(i)]);
        loops_[k] = triangle;
        loops_.push_back(rest);
    }

    // Says of every line where contact k stands on it.
    void note(std::span<const Contact> contacts, std::size_t k) {
        const Contact& contact = contacts[k];
        for (CutLine& line : out_.lines) {
            const Vec3 from = place(line.from), to = place(line.to);
            const double whole = length(to - from);
            const Vec3 along = (to - from) / whole;
            const auto off = [&](const Vec3& p) { return length(cross(p - from, along)); };
            if (off(contact.from) > 2 * snap_ || off(contact.to) > 2 * snap_) continue;
            double a = dot(contact.from - from, along), b = dot(contact.to - from, along);
            bool open_a = is_open(contacts, k, contact.from),
                 open_b = is_open(contacts, k, contact.to);
            if (a > b) std::swap(a, b), std::swap(open_a, open_b);
            if (std::min(b, whole) - std::max(a, 0.0) < snap_) continue;
            const bool inside_a = a > snap_, inside_b = b < whole - snap_;
            line.contacts.push_back({inside_a ? a / whole : 0, inside_b ? b / whole : 1,
                                     open_a && inside_a, open_b && inside_b, contact.polygon});
        }
    }

    // Whether light gets round the end of contact k: neither the polygon's border nor another
    // contact is there.
    bool is_open(std::span<const Contact> contacts, std::size_t k, const Vec3& end) const {
        const auto near = [&](const Vec3& a, const Vec3& b) {
            const Vec3 along = b - a;
            const double t = std::clamp(dot(end - a, along) / dot(along, along), 0.0, 1.0);
            return length(end - a - along * t) < 2 * snap_;
        };
        // The polygon's own sides come first among the lines.
        for (const CutLine& line : out_.lines)
            if (is_border(line) && near(place(line.from), place(line.to))) return false;
        for (std::size_t other = 0; other < contacts.size(); ++other)
            if (other != k && near(contacts[other].from, contacts[other].to)) return false;
        return true;
    }

    bool is_border(const CutLine& line) const {
        return static_cast<std::size_t>(&line - out_.lines.data()) < sides_;
    }

    double snap_;
    Vec3 normal_;
    std::size_t sides_;
    CutPolygon out_;
    std::vector<Loop> loops_;
};

}  // namespace

CutPolygon cut(std::span<const Vec3> corners, std::span<const Contact> contacts, double snap) {
    Cutting cutting(corners, snap);
    for (const Contact& contact : contacts) cutting.cut_along(contact);
    return cutting.finish(contacts);
}

}  // namespace exitance
