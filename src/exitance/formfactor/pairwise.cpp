// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/pairwise.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <numeric>

#include "exitance/formfactor/facet_tree.h"
#include "exitance/formfactor/pair_exchange.h"
#include "exitance/formfactor/pair_visibility.h"
#include "exitance/run/error.h"
#include "exitance/run/parallel.h"
#include "exitance/run/random.h"
#include "exitance/visibility/shaft.h"

namespace exitance {

namespace {

// Lengths are in diagonals of the scene; what is nearer than this counts as touching.
constexpr double slack = 1e-7;
constexpr std::size_t group_size = 16;  // facets that go through the tree together

/// Consecutive facets of one row or of several whole rows.
struct Group {
    std::vector<std::uint32_t> facets;
    std::vector<std::uint32_t> rows;
    bool whole = true;  ///< not just a piece of a row
};

struct Problem {
    double scale = 1;
    std::vector<SampledFacet> facets;
    std::vector<std::uint32_t> number;  ///< of each facet in the enclosure
    std::vector<std::uint32_t> rows;    ///< of each facet
    std::vector<Blocker> blockers;
    std::vector<double> row_area;
    double total_area = 0;

    explicit Problem(const Enclosure& enclosure) : row_area(enclosure.surfaces.size()) {
        Box bounds;
        for (const Facet& facet : enclosure.facets)
            for (const Vec3& corner : facet.corners()) bounds.add(corner);
        scale = bounds.diagonal() > 0 ? bounds.diagonal() : 1;
        const Vec3 middle = bounds.empty() ? Vec3{} : bounds.centre();
        std::vector<SmallPolygon> outlines;
        for (std::uint32_t i = 0; i < enclosure.facets.size(); ++i) {
            const Facet& facet = enclosure.facets[i];
            SmallPolygon outline;
            for (const Vec3& corner : facet.corners()) outline.add((corner - middle) / scale);
            outlines.push_back(outline);
            if (facet.row == Facet::only_blocks) continue;
            facets.emplace_back(outline.corners());
            number.push_back(i);
            rows.push_back(facet.row);
            row_area[facet.row] += facets.back().area;
            total_area += facets.back().area;
        }
        std::vector<std::span<const Vec3>> polygons;
        for (const SmallPolygon& outline : outlines) polygons.push_back(outline.corners());
        blockers = find_blockers(polygons);
    }

    std::vector<Group> groups() const {
        std::vector<std::vector<std::uint32_t>> of_row(row_area.size());
        for (std::uint32_t i = 0; i < facets.size(); ++i) of_row[rows[i]].push_back(i);
        std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
        for (std::uint32_t r = 0; r < of_row.size(); ++r)
            if (!of_row[r].empty()) order.push_back({spatial_key(facets[of_row[r][0]]), r});
        std::sort(order.begin(), order.end());
        std::vector<Group> made;
        for (const auto& [key, row] : order) {
            const auto& of = of_row[row];
            if (of.size() > 4 * group_size) {
                for (std::size_t k = 0; k < of.size(); k += group_size) {
                    const auto begin = of.begin() + static_cast<std::ptrdiff_t>(k);
                    const std::size_t n = std::min(group_size, of.size() - k);
                    made.push_back({{begin, begin + static_cast<std::ptrdiff_t>(n)}, {row}, false});
                }
                continue;
            }
            if (made.empty() || !made.back().whole ||
                made.back().facets.size() + of.size() > group_size)
                made.emplace_back();
            made.back().rows.push_back(row);
            made.back().facets.insert(made.back().facets.end(), of.begin(), of.end());
        }
        return made;
    }
};

/// Rays between the facets of an enclosure, for pairs with very much between. What the rays meet
/// is set up when the first pair asks.
class RaysBetweenPairs {
  public:
    RaysBetweenPairs(const Enclosure& enclosure, const Problem& problem)
        : enclosure_(enclosure), problem_(problem) {}

    double operator()(const Pair& pair, double free, double tolerance) {
        std::call_once(built_, [&] { caster_ = std::make_unique<FacetCaster>(enclosure_); });
        const std::uint32_t f = problem_.number[pair.facet_a], g = problem_.number[pair.facet_b];
        const double unit = problem_.scale * problem_.scale;
        return visible_exchange_area(*caster_, enclosure_.facets[f], enclosure_.facets[g],
                                     hash_bits(f, g), free * unit, tolerance * unit, counters) /
               unit;
    }

    MethodCounters counters;

  private:
    const Enclosure& enclosure_;
    const Problem& problem_;
    std::once_flag built_;
    std::unique_ptr<FacetCaster> caster_;
};

/// One group against all facets in rows up to its own.
class GroupWork {
  public:
    GroupWork(const Problem& problem, const FacetTree& tree, const Group& group, double accuracy,
              RaysBetweenPairs& rays)
        : problem_(problem),
          tree_(tree),
          group_(group),
          extent_(problem.facets, group.facets, slack),
          accuracy_(accuracy),
          pair_(accuracy, slack, std::ref(rays)) {
        for (const std::uint32_t row : group.rows) {
            sums_.emplace_back(row + 1, 0.0);
            last_row_ = std::max(last_row_, row);
        }
        for (const std::uint32_t i : group.facets) {
            boxes_.emplace_back();
            for (const Vec3& c : problem.facets[i].outline()) boxes_.back().add(c);
            const auto at = std::find(group.rows.begin(), group.rows.end(), problem.rows[i]);
            slot_.push_back(static_cast<std::size_t>(at - group.rows.begin()));
        }
    }

    void run() {
        std::vector<std::uint32_t> all(problem_.blockers.size());
        std::iota(all.begin(), all.end(), 0u);
        descend(0, all);
        settle();
    }

    std::vector<std::vector<double>>& sums() { return sums_; }
    const PairwiseCounters& counters() const { return pair_.counters; }

  private:
    void descend(std::uint32_t at, const std::vector<std::uint32_t>& blockers) {
        const FacetTree::Node& node = tree_.nodes[at];
        if (node.least_row > last_row_ || extent_.turns_away_from(node.extent, slack) ||
            node.extent.turns_away_from(extent_, slack))
            return;
        std::vector<std::uint32_t> between;
        if (!blockers.empty()) {
            const Shaft shaft(extent_.box, node.extent.box);
            for (const std::uint32_t b : blockers) {
                const Blocker& blocker = problem_.blockers[b];
                if (shaft.misses(blocker.bounds)) continue;
                if (hides(blocker, extent_.box, node.extent.box)) return;
                between.push_back(b);
            }
        }
        if (node.right == 0) return meet(node, between);
        descend(at + 1, between);
        descend(node.right, between);
    }

    void meet(const FacetTree::Node& node, const std::vector<std::uint32_t>& blockers) {
        const FacetTree::Block& block = tree_.blocks[node.block];
        if (heights_.size() < blockers.size()) heights_.resize(blockers.size());
        measured_.assign(blockers.size(), 0);
        FarExchange far;
        for (std::size_t f = 0; f < group_.facets.size(); ++f) {
            const std::uint32_t i = group_.facets[f];
            const SampledFacet& facet = problem_.facets[i];
            far_exchange(facet, block.lanes, static_cast<float>(slack), far);
            LaneMask open = far.faces & ((1u << block.lanes.outlines.count) - 1);
            for (LaneMask m = open; m; m &= m - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(m));
                const std::uint32_t j = block.facet[lane];
                const std::uint32_t row = problem_.rows[j], own = problem_.rows[i];
                if (row > own || (row == own && j >= i)) open &= ~(1u << lane);
            }
            if (!open) continue;
            pair_.counters.pairs += static_cast<std::uint64_t>(std::popcount(open));
            candidates_.clear();
            std::array<Vec3, 4> corners = facet.corners;
            if (!blockers.empty()) {
                const Shaft shaft(boxes_[f], node.extent.box);
                for (std::size_t k = 0; k < blockers.size() && open; ++k) {
                    const Blocker& blocker = problem_.blockers[blockers[k]];
                    if (shaft.misses(blocker.bounds)) continue;
                    if (!measured_[k]) {
                        measure(blocker, block.lanes.outlines, static_cast<float>(slack),
                                heights_[k]);
                        measured_[k] = 1;
                    }
                    const Standing standing =
                        stand_between(blocker, heights_[k], corners, static_cast<float>(slack));
                    const LaneMask hidden = standing.hides & open;
                    pair_.counters.hidden += static_cast<std::uint64_t>(std::popcount(hidden));
                    open &= ~hidden;
                    const LaneMask between = open & ~standing.apart;
                    if (between) candidates_.push_back({&blocker, between});
                }
            }
            for (LaneMask m = open; m; m &= m - 1) {
                const auto lane = static_cast<std::size_t>(std::countr_zero(m));
                const std::uint32_t j = block.facet[lane];
                const Pair pair{&facet,
                                &problem_.facets[j],
                                (far.wholly >> lane & 1) != 0,
                                static_cast<double>(far.area[lane]),
                                static_cast<double>(far.distance[lane]),
                                i,
                                j};
                const std::size_t begin = later_blockers_.size();
                for (const Candidate& c : candidates_)
                    if (c.lanes >> lane & 1) later_blockers_.push_back(c.blocker);
                const std::uint32_t row = problem_.rows[j];
                if (later_blockers_.size() > begin) {
                    later_.push_back({pair, f, row, begin, later_blockers_.size()});
                    continue;
                }
                ++pair_.counters.separated;
                add(f, row, pair_.free(pair));
            }
        }
    }

    // In a row of several facets each pair stands for both its directions.
    void add(std::size_t facet, std::uint32_t row, double area) {
        const std::size_t slot = slot_[facet];
        sums_[slot][row] += row == group_.rows[slot] ? 2 * area : area;
    }

    // Pairs with something between. Work goes with 1 / error, so that a given sum of errors costs
    // least when each goes with the root of what it is an error of; the sum over a facet's pairs is
    // to be the accuracy of its area. What is above the diagonal is taken to be as what is
    // below.
    void settle() {
        std::vector<double> roots(group_.facets.size());
        const auto weight = [](const Later& pair) {
            const double least = std::min(pair.pair.a->area, pair.pair.b->area);
            // Some that cut each other's planes have no Gauss point before them.
            return std::sqrt(std::max(pair.pair.by_points, 1e-6 * least) * least);
        };
        for (const Later& pair : later_) roots[pair.facet] += weight(pair);
        for (const Later& pair : later_) {
            const double share = weight(pair) / roots[pair.facet];
            const double tolerance =
                accuracy_ * std::min(weight(pair), 0.9 * pair.pair.a->area * share);
            add(pair.facet, pair.row,
                pair_.seen(pair.pair,
                           std::span(later_blockers_)
                               .subspan(pair.begin_blocker, pair.end_blocker - pair.begin_blocker),
                           tolerance));
        }
    }

    /// A pair with something between.
    struct Later {
        Pair pair;
        std::size_t facet;  ///< of the group
        std::uint32_t row;
        std::size_t begin_blocker, end_blocker;
    };
    struct Candidate {
        const Blocker* blocker;
        LaneMask lanes;
    };
    const Problem& problem_;
    const FacetTree& tree_;
    const Group& group_;
    FacetExtent extent_;
    double accuracy_;
    PairExchanger pair_;
    std::uint32_t last_row_ = 0;
    std::vector<std::vector<double>> sums_;  // of each row of the group
    std::vector<Box> boxes_;                 // of each facet of the group
    std::vector<std::size_t> slot_;          // of each facet: its row's place in sums_
    std::vector<BlockHeights> heights_;
    std::vector<char> measured_;
    std::vector<Candidate> candidates_;
    std::vector<Later> later_;
    std::vector<const Blocker*> later_blockers_;
};

void add(PairwiseCounters& to, const PairwiseCounters& more) {
    to.pairs += more.pairs;
    to.separated += more.separated;
    to.hidden += more.hidden;
    to.visible += more.visible;
    to.partial += more.partial;
    to.sampled += more.sampled;
    to.viewpoints += more.viewpoints;
}

}  // namespace

ExchangeAreas pairwise_exchange_areas(const Enclosure& enclosure, const PairwiseOptions& options,
                                      const Observer& observer, const Cancel* cancel,
                                      PairwiseCounters* counters) {
    const Problem problem(enclosure);
    const FacetTree tree(problem.facets, problem.rows, slack);
    const std::vector<Group> groups = problem.groups();
    RaysBetweenPairs rays(enclosure, problem);
    const double unit = problem.scale * problem.scale;
    // S_ij below this share of A_i A_j: all of a row's together are a tenth of the accuracy.
    const double share = 0.1 * options.accuracy / std::max(problem.total_area, 1e-300);
    ExchangeAreas areas(enclosure.surfaces.size());
    const auto keep = [&](std::uint32_t row, std::span<const double> sums) {
        std::vector<float> kept(sums.size());
        for (std::size_t j = 0; j < sums.size(); ++j)
            if (sums[j] >= share * problem.row_area[row] * problem.row_area[j])
                kept[j] = static_cast<float>(sums[j] * unit);
        areas.set_row(row, kept);
    };

    std::vector<std::vector<double>> pieces(groups.size());
    std::vector<PairwiseCounters> counted(groups.size());
    WorkDone done(observer, cancel, rays.counters.rays, static_cast<double>(groups.size()));
    parallel_for(
        groups.size(),
        [&](std::size_t g) {
            if (!done.wanted()) return;
            GroupWork work(problem, tree, groups[g], options.accuracy, rays);
            work.run();
            counted[g] = work.counters();
            if (!groups[g].whole) {
                pieces[g] = std::move(work.sums()[0]);
            } else {
                for (std::size_t k = 0; k < groups[g].rows.size(); ++k)
                    keep(groups[g].rows[k], work.sums()[k]);
            }
            done.add(1);
        },
        1);
    if (!done.wanted())
        throw Error(Fault::could_not_finish, "form factors: interrupted, nothing is written");

    for (std::size_t g = 0; g < groups.size(); ++g) {
        if (counters) add(*counters, counted[g]);
        if (groups[g].whole) continue;
        std::vector<double> sum = std::move(pieces[g]);
        const std::uint32_t row = groups[g].rows[0];
        for (; g + 1 < groups.size() && !groups[g + 1].whole && groups[g + 1].rows[0] == row; ++g) {
            for (std::size_t j = 0; j < sum.size(); ++j) sum[j] += pieces[g + 1][j];
            if (counters) add(*counters, counted[g + 1]);
        }
        keep(row, sum);
    }
    if (counters) {
        counters->rays += rays.counters.rays;
        counters->unreached += rays.counters.unreached;
    }
    return areas;
}

}  // namespace exitance
