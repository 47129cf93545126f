// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/distant_column.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "exitance/math/frame.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/transport/ray_count.h"

namespace exitance {

namespace {

constexpr std::size_t width = RayPacket::width;

// In tolerances: cells are halved until they can bring no more than this before anything is known
// of them; and while they are seen partly, until they bring less than that. What four rays say of
// such a cell is wrong by a quarter of it; there are a hundred of them at the edge of a window.
constexpr double unseen_cell = 8, partly_seen_cell = 0.3, horizon_cell = 0.3;
constexpr std::uint32_t finest_probe = 6, finest_edge = 11;

/// Rays from one place to infinity, sixteen at a time.
class SkyRays {
  public:
    SkyRays(const RayCaster& caster, const Vec3f& origin) : caster_(caster) {
        packet_.origin_x.fill(origin.x), packet_.origin_y.fill(origin.y);
        packet_.origin_z.fill(origin.z);
        packet_.near.fill(0.0f), packet_.far.fill(std::numeric_limits<float>::infinity());
        packet_.direction_x.fill(0), packet_.direction_y.fill(1), packet_.direction_z.fill(0);
    }

    /// Ray `lane` of the next packet.
    void aim(std::size_t lane, const Vec3& d) {
        packet_.direction_x[lane] = static_cast<float>(d.x);
        packet_.direction_y[lane] = static_cast<float>(d.y);
        packet_.direction_z[lane] = static_cast<float>(d.z);
        packet_.active |= 1u << lane;
    }

    /// Casts what was aimed; share of the light that gets through, per lane.
    const std::array<float, width>& cast(bool occlusion) {
        through_.fill(1.0f);
        if (occlusion && packet_.active) {
            const std::uint32_t blocked = caster_.occluded(packet_, through_);
            for (std::size_t i = 0; i < width; ++i)
                if (blocked >> i & 1u) through_[i] = 0;
            count += static_cast<std::uint64_t>(__builtin_popcount(packet_.active));
        }
        packet_.active = 0;
        return through_;
    }

    std::uint64_t count = 0;

  private:
    const RayCaster& caster_;
    RayPacket packet_{};
    std::array<float, width> through_{};
};

/// One receiver under the sky.
class Skyward {
  public:
    Skyward(const SkySource& sky, const Vec3& normal, double tolerance, std::uint64_t key,
            bool occlusion, SkyRays& rays)
        : sky_(sky),
          normal_(normal),
          tolerance_(tolerance),
          key_(key),
          occlusion_(occlusion),
          rays_(rays) {}

    void run(SkyEntry& entry, std::span<float> bands) {
        sums_.assign(bands.size(), 0.0);
        for (const SkySource::Cell& root : sky_.roots()) probe(root);
        while (!open_.empty()) cast_open();
        for (std::size_t b = 0; b < bands.size(); ++b) bands[b] = static_cast<float>(sums_[b]);
        entry = {static_cast<float>(all_), static_cast<float>(seen_),
                 static_cast<float>(variance_)};
    }

  private:
    struct Open {
        SkySource::Cell cell;
        double light = 0;   ///< what it can bring
        bool fresh = true;  ///< nothing is known of it yet
    };

    void probe(const SkySource::Cell& cell) {
        const SkySource::Cone cone = sky_.cone(cell);
        const double facing = dot(cone.axis, normal_);
        const bool bounded = cone.sine < 1;
        if (bounded && facing <= -cone.sine) return;
        const Vec3 J = sky_.vector(cell);
        const double most = length(J);
        if (!(most > 0)) return;
        const bool cut = !bounded || facing < cone.sine;
        const double light = std::max(0.0, dot(J, normal_));
        // Where the receiver's horizon cuts it, n · J counts what is behind as negative light.
        const double error = cut ? most * std::min(1.0, 2 * cone.sine) : 0;
        const bool split = cell.level < SkySource::coarsest ||
                           (light > unseen_cell * tolerance_ && cell.level < finest_probe) ||
                           (light > 64 * unseen_cell * tolerance_ && cell.level < sky_.finest()) ||
                           (error > horizon_cell * tolerance_ && cell.level < sky_.finest());
        if (split) {
            for (std::uint32_t k = 0; k < 4; ++k) probe(cell.child(k));
        } else if (light > 0) {
            all_ += light;
            open_.push_back({cell, light, true});
        }
    }

    /// What four rays say of a cell.
    struct Seen {
        double all = 0, seen = 0;
        float least = 1, most = 0;
        bool partly() const { return all > 0 && least < most; }
    };

    // Four rays into the quarters of each open cell; those seen partly are opened further, and at
    // first those beside others that are seen differently: an edge passes near.
    void cast_open() {
        std::vector<Open> now;
        now.swap(open_);
        const bool first_time = now.front().fresh;
        std::vector<Seen> seen(now.size());
        for (std::size_t first = 0; first < now.size(); first += width / 4) {
            const std::size_t n = std::min(width / 4, now.size() - first);
            std::array<double, width> weight{};
            for (std::size_t lane = 0; lane < 4 * n; ++lane) {
                const SkySource::Cell& cell = now[first + lane / 4].cell;
                const std::uint64_t own = hash_bits(key_, cell.index, cell.level);
                const double s = uniform(own, 2 * (lane % 4)), t = uniform(own, 2 * (lane % 4) + 1);
                const Vec3 d = cell.direction(0.5 * (double(lane & 1u) + s),
                                              0.5 * (double(lane >> 1 & 1u) + t));
                weight[lane] = std::max(0.0, dot(d, normal_));
                if (weight[lane] > 0) rays_.aim(lane, d);
            }
            const auto& through = rays_.cast(occlusion_);
            for (std::size_t lane = 0; lane < 4 * n; ++lane) {
                if (!(weight[lane] > 0)) continue;
                Seen& s = seen[first + lane / 4];
                s.all += weight[lane], s.seen += weight[lane] * double(through[lane]);
                s.least = std::min(s.least, through[lane]);
                s.most = std::max(s.most, through[lane]);
            }
        }
        std::vector<char> at_edge(now.size(), 0);
        if (first_time) find_edges(now, seen, at_edge);
        for (std::size_t i = 0; i < now.size(); ++i) decide(now[i], seen[i], at_edge[i] != 0);
    }

    // Cells with a neighbour of the same level that is seen differently.
    static void find_edges(const std::vector<Open>& cells, const std::vector<Seen>& seen,
                           std::vector<char>& at_edge) {
        constexpr std::uint32_t side = 1u << finest_probe;
        constexpr float unknown = -1;
        std::array<std::vector<float>, finest_probe + 1> levels;
        const auto place = [](const SkySource::Cell& cell, int right, int down) {
            const auto n = static_cast<int>(1u << cell.level);
            const int column = static_cast<int>(std::lround(cell.u * n)) + right;
            const int row = static_cast<int>(std::lround(cell.v * n)) + down;
            const bool outside = column < 0 || row < 0 || column >= n || row >= n;
            return outside ? std::size_t{2} * side * side
                           : static_cast<std::size_t>((cell.lower ? n * n : 0) + row * n + column);
        };
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const SkySource::Cell& cell = cells[i].cell;
            if (cell.level > finest_probe) continue;
            auto& level = levels[cell.level];
            if (level.empty()) level.assign(std::size_t{2} << (2 * cell.level), unknown);
            level[place(cell, 0, 0)] =
                seen[i].all > 0 ? static_cast<float>(seen[i].seen / seen[i].all) : unknown;
        }
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const SkySource::Cell& cell = cells[i].cell;
            if (cell.level > finest_probe) continue;
            const auto& level = levels[cell.level];
            const float here = level[place(cell, 0, 0)];
            constexpr std::array<std::array<int, 2>, 4> steps{{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
            for (const auto& [right, down] : steps) {
                const std::size_t beside = place(cell, right, down);
                if (beside < level.size() && level[beside] != unknown &&
                    std::abs(level[beside] - here) > 0.01f)
                    at_edge[i] = 1;
            }
        }
    }

    void decide(const Open& open, const Seen& found, bool at_edge) {
        const bool partly = found.partly();
        if ((partly || at_edge) && open.light > partly_seen_cell * tolerance_ &&
            open.cell.level < finest_edge) {
            for (std::uint32_t k = 0; k < 4; ++k) {
                const SkySource::Cell child = open.cell.child(k);
                const double light = std::max(0.0, dot(sky_.vector(child), normal_));
                if (light > 0) open_.push_back({child, light, false});
            }
            return;
        }
        // No ray above the receiver's horizon: what little there is counts as seen.
        const double share = found.all > 0 ? found.seen / found.all : 1.0;
        seen_ += open.light * share;
        if (partly) variance_ += open.light * open.light * 0.0625;
        for (std::size_t b = 0; share > 0 && b < sums_.size(); ++b)
            sums_[b] += share * std::max(0.0, dot(sky_.vector(open.cell, b), normal_));
    }

    const SkySource& sky_;
    Vec3 normal_;
    double tolerance_;
    std::uint64_t key_;
    bool occlusion_;
    SkyRays& rays_;
    std::vector<Open> open_;
    std::vector<double> sums_;
    double all_ = 0, seen_ = 0, variance_ = 0;
};

Vec3f origin_of(const Receivers& receivers, std::uint32_t r, double clearance) {
    return Vec3f(Vec3(receivers.point(r)) + Vec3(receivers.normal(r)) * clearance);
}

}  // namespace

std::uint64_t compute_sun_column(const RayCaster& caster, const DistantLight& sun, double tolerance,
                                 std::uint32_t number, const Receivers& receivers,
                                 std::span<const std::uint32_t> which, const ColumnOptions& options,
                                 std::span<ColumnEntry> entries) {
    std::atomic<std::uint64_t> cast{0};
    const Frame frame(sun.direction);
    const double radius = std::tan(sun.diameter / 2);
    parallel_blocks(which.size(), 64, [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t r = which[i];
            const Vec3 normal(receivers.normal(r));
            const double light = sun.irradiance * std::max(0.0, dot(sun.direction, normal));
            entries[i] = {static_cast<float>(light), 1.0f, 0.0f};
            if (!(light > 0)) continue;
            const auto most =
                radius > 0 ? static_cast<std::uint32_t>(rays_for(light / tolerance)) : 1u;
            std::uint32_t goal = std::clamp(most / 2, 1u, 64u), samples = 0;
            SkyRays rays(caster, origin_of(receivers, r, caster.clearance()));
            const std::uint64_t key = hash_bits(options.seed, number, receivers.key[r]);
            double all = 0, seen = 0;
            float least = 1, brightest = 0;
            for (;;) {
                while (samples < goal) {
                    const auto n = std::min<std::uint32_t>(width, goal - samples);
                    std::array<bool, width> aimed{};
                    for (std::uint32_t lane = 0; lane < n; ++lane, ++samples) {
                        const auto [a, b] = low_discrepancy(key, samples);
                        const double across = radius * std::sqrt(a);
                        const double angle = 2 * std::numbers::pi * b;
                        const Vec3 d = sun.direction + frame.tangent * (across * std::cos(angle)) +
                                       frame.bitangent * (across * std::sin(angle));
                        aimed[lane] = dot(d, normal) > 0;
                        if (aimed[lane]) rays.aim(lane, d);
                    }
                    const auto& through = rays.cast(options.occlusion);
                    for (std::uint32_t lane = 0; lane < n; ++lane) {
                        if (!aimed[lane]) continue;
                        all += 1, seen += double(through[lane]);
                        least = std::min(least, through[lane]);
                        brightest = std::max(brightest, through[lane]);
                    }
                }
                const bool undecided = all == 0 || least < brightest;
                if (!undecided || goal >= most) break;
                goal = std::min(most, std::max(8u, 2 * goal));
            }
            count += rays.count;
            if (!(all > 0)) continue;
            entries[i].visible = static_cast<float>(seen / all);
            if (least < brightest) entries[i].deviation = penumbra_deviation(samples);
        }
        cast.fetch_add(count, std::memory_order_relaxed);
    });
    return cast.load();
}

std::uint64_t compute_sky_column(const RayCaster& caster, const SkySource& sky, double tolerance,
                                 std::uint32_t number, const Receivers& receivers,
                                 std::span<const std::uint32_t> which, const ColumnOptions& options,
                                 std::span<SkyEntry> entries, std::span<float> bands) {
    std::atomic<std::uint64_t> cast{0};
    const std::size_t n = sky.bands();
    parallel_blocks(which.size(), 16, [&](std::size_t begin, std::size_t end) {
        std::uint64_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t r = which[i];
            SkyRays rays(caster, origin_of(receivers, r, caster.clearance()));
            Skyward receiver(sky, Vec3(receivers.normal(r)), tolerance,
                             hash_bits(options.seed, number, receivers.key[r]), options.occlusion,
                             rays);
            receiver.run(entries[i], bands.subspan(i * n, n));
            count += rays.count;
        }
        cast.fetch_add(count, std::memory_order_relaxed);
    });
    return cast.load();
}

}  // namespace exitance
