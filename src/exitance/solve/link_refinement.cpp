// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/link_refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "exitance/run/parallel.h"
#include "exitance/solve/cast_emission.h"

namespace exitance {

namespace {

// Lamps' light is interpolated between corners where it is looked at: of a step that leaves about a
// quarter of what one value would be wrong by, of smooth light less.
constexpr double interpolated = 0.5;
// Links measured between two questions whether to go on.
constexpr std::size_t at_once = 8192;
// Scaling the rows in the end mends a part of what is estimated here.
constexpr double overestimate = 1.5;
// Light is gathered over links once they are right to this share of it: before, most are guesses.
constexpr double right_enough = 0.25;
// To this share they are something to show.
constexpr double nearly_right = 0.1;
// Links that were enough for the light as it was are, if they are off by this much with the solved.
constexpr double still_enough = 1.1;

}  // namespace

LinkRefinement::LinkRefinement(Radiosity& radiosity, const ElementScene& scene, LinkOptions options)
    : radiosity_(radiosity),
      scene_(scene),
      options_(std::move(options)),
      clusters_(radiosity.mesh),
      exchange_(scene, clusters_, options_.column.seed) {
    find_rows();
    for (ElementField* field : {&direct_, &received_, &reflected_})
        *field = ElementField(radiosity.mesh.elements().size(), radiosity.columns.count);
    admit_leaves(rows_.elements);
    find_rows();
}

// Open area and lamps' light of leaves that are new.
void LinkRefinement::admit_leaves(const std::vector<ElementId>& leaves) {
    const std::size_t elements = radiosity_.mesh.elements().size();
    for (ElementField* field : {&direct_, &received_, &reflected_}) field->resize_rows(elements);
    uneven_.resize(elements, 0.0f);
    area_.resize(elements, 0.0f);
    const ElementRows made = make_element_rows(scene_, leaves);
    const RowPoints points = make_row_points(scene_, made);
    const Columns& columns = radiosity_.columns;
    std::vector<std::uint32_t> everyone(points.receivers.size());
    std::iota(everyone.begin(), everyone.end(), 0u);
    Received received;
    received.reset(everyone.size(), columns.stride);
    rays_ += cast_emission(radiosity_, Lamps(radiosity_), points.receivers, everyone,
                           options_.tolerance, options_.column, received);
    std::vector<float> off(columns.stride);
    for (std::size_t i = 0; i < made.size(); ++i) {
        const ElementId leaf = made.elements[i];
        area_[leaf.index()] = made.area[i];
        const auto D = direct_[leaf];
        const auto each = [&](const auto& visit) {
            for (std::uint32_t k = points.begin[i]; k < points.begin[i + 1]; ++k)
                visit(points.weight[k], received.row(k, columns.stride));
        };
        each([&](float weight, std::span<const float> row) {
            for (std::size_t c = 0; c < D.size(); ++c) D[c] += weight * row[c];
        });
        float square = 0;
        each([&](float weight, std::span<const float> row) {
            for (std::size_t c = 0; c < D.size(); ++c) off[c] = row[c] - D[c];
            square += weight * columns.magnitude(off) * columns.magnitude(off);
        });
        uneven_[leaf.index()] = std::sqrt(square);
    }
}

void LinkRefinement::find_rows() {
    rows_ = {};
    const Mesh& mesh = radiosity_.mesh;
    for (const Patch& patch : mesh.patches())
        mesh.for_leaves(patch.root, [&](ElementId id) { rows_.elements.push_back(id); });
    for (const ElementId id : rows_.elements)
        rows_.area.push_back(id.index() < area_.size() ? area_[id.index()] : 0.0f);
    nodes_ = std::make_unique<LinkNodes>(clusters_, rows_);
}

RowField LinkRefinement::of_rows(const ElementField& field) const {
    RowField out(rows_.size(), radiosity_.columns.count);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto row = field[rows_.elements[i]];
        std::copy(row.begin(), row.end(), out[RowId(i)].begin());
    }
    return out;
}

RowField LinkRefinement::direct() const {
    return of_rows(direct_);
}

RowField LinkRefinement::reflected() const {
    return of_rows(reflected_);
}

RowField LinkRefinement::irradiance() const {
    RowField out = direct();
    for (std::size_t i = 0; i < rows_.size(); ++i)
        for (std::size_t c = 0; c < out.columns(); ++c)
            out[RowId(i)][c] += received_[rows_.elements[i]][c];
    return out;
}

std::unique_ptr<LinkTransport> LinkRefinement::transport() const {
    return std::make_unique<LinkTransport>(*nodes_, links_, rows_.size(), options_.error);
}

// R = ρ (D + H).
void LinkRefinement::reflect() {
    for (const ElementId id : rows_.elements) {
        const auto rho = radiosity_.rho(id);
        for (std::size_t c = 0; c < rho.size(); ++c)
            reflected_[id][c] = rho[c] * (direct_[id][c] + received_[id][c]);
    }
}

void LinkRefinement::gather() {
    gathered_ = true;
    const std::unique_ptr<LinkTransport> operator_now = transport();
    RowField H(rows_.size(), radiosity_.columns.count);
    operator_now->gather(reflected(), H);
    for (std::size_t i = 0; i < rows_.size(); ++i)
        std::copy_n(H[RowId(i)].begin(), H.stride(), received_[rows_.elements[i]].begin());
    reflect();
}

void LinkRefinement::guess_ambient() {
    // The ambient light that the first reflection would make: Σ A ρ D / Σ A (1 − ρ).
    const std::size_t columns = radiosity_.columns.count;
    std::vector<double> flux(columns, 0.0), absorbing(columns, 0.0);
    for (const ElementId id : rows_.elements)
        for (std::size_t c = 0; c < columns; ++c) {
            const auto rho = double(radiosity_.rho(id)[c]);
            flux[c] += double(area_[id.index()]) * rho * double(direct_[id][c]);
            absorbing[c] += double(area_[id.index()]) * (1 - rho);
        }
    for (const ElementId id : rows_.elements)
        for (std::size_t c = 0; c < columns; ++c)
            received_[id][c] = absorbing[c] > 0 ? static_cast<float>(flux[c] / absorbing[c]) : 0.0f;
    reflect();
}

bool LinkRefinement::can_divide(NodeId node) const {
    if (clusters_.child_count(node) > 0) return true;
    const Element& leaf = radiosity_.mesh[clusters_.element(node)];
    return options_.divide && leaf.area > options_.min_area && leaf.level < Mesh::max_level;
}

// One value on a stands for B_b F, with F of a place on a to all of b: B_b σ(F) is wrong. Where b
// is uneven as well, its brighter places may be those that a sees: at most A_b / A_a · σ(B_b)
// σ(F_b).
LinkRefinement::Fault LinkRefinement::fault(const Link& link, const State& state) const {
    Fault out;
    if (!can_divide(link)) return out;
    const std::size_t a = nodes_->position(link.a), b = nodes_->position(link.b);
    const double A_a = nodes_->area(a), A_b = nodes_->area(b);
    if (!(A_a > 0 && A_b > 0)) return out;
    const auto s_a = double(link.spread_a), s_b = double(link.spread_b);
    out.by_a_on_a = double(state.mean[b]) * s_a;
    out.by_a_on_b = A_a / A_b * double(state.deviation[a]) * s_a;
    out.on_a = out.by_a_on_a + A_b / A_a * double(state.deviation[b]) * s_b;
    out.by_b_on_b = double(state.mean[a]) * s_b;
    out.on_b = out.by_a_on_b + out.by_b_on_b;
    return out;
}

double LinkRefinement::lamps_fault(ElementId leaf) const {
    return can_divide(clusters_.node(leaf)) ? interpolated * double(uneven_[leaf.index()]) : 0.0;
}

LinkRefinement::State LinkRefinement::state() const {
    RowField moments(rows_.size(), 2);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const float B = radiosity_.columns.magnitude(reflected_[rows_.elements[i]]);
        moments[RowId(i)][0] = B, moments[RowId(i)][1] = B * B;
    }
    const std::size_t n = nodes_->size(), stride = moments.stride();
    std::vector<float> sums;
    nodes_->pull(moments, {}, sums);
    State out;
    for (std::size_t k = 0; k < n; ++k) {
        const double A = nodes_->area(k);
        const double mean = A > 0 ? double(sums[k * stride]) / A : 0.0;
        const double square = A > 0 ? double(sums[k * stride + 1]) / A : 0.0;
        out.mean.push_back(static_cast<float>(mean));
        out.deviation.push_back(static_cast<float>(std::sqrt(std::max(0.0, square - mean * mean))));
    }
    // What the links of a node bring to each of its places more than to the others, with its sign.
    constexpr std::size_t places = Cluster::places_count;
    std::vector<float> off(n * places, 0.0f), bound(n, 0.0f), square(n * stride, 0.0f);
    for (const Link& link : links_) {
        const Fault wrong = fault(link, out);
        const std::size_t a = nodes_->position(link.a), b = nodes_->position(link.b);
        const auto add = [&](std::size_t to, float from, const auto& departures, double on) {
            if (link.bound) {
                bound[to] += static_cast<float>(on);
                return;
            }
            for (std::size_t k = 0; k < places; ++k) off[to * places + k] += from * departures[k];
            square[to * stride] += static_cast<float>(on * on);
        };
        if (!(wrong.on_a > 0 || wrong.on_b > 0)) continue;
        const bool all = link.bound;
        add(a, out.mean[b], link.off_a, wrong.on_a - (all ? 0.0 : wrong.by_a_on_a));
        add(b, out.mean[a], link.off_b, wrong.on_b - (all ? 0.0 : wrong.by_b_on_b));
    }
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t count = clusters_.is_cluster(nodes_->node(k)) ? places : 4;
        float sum = 0;
        for (std::size_t p = 0; p < count; ++p) sum += off[k * places + p] * off[k * places + p];
        square[k * stride] += sum / static_cast<float>(count) + bound[k] * bound[k];
    }
    // E² is pushed down as irradiance is, and its mean over every node pulled up.
    RowField E(rows_.size(), 1);
    nodes_->push(square, {}, E);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const auto lamps = static_cast<float>(lamps_fault(rows_.elements[i]));
        E[RowId(i)][0] += lamps * lamps;
    }
    nodes_->pull(E, {}, sums);
    for (std::size_t k = 0; k < n; ++k)
        out.error.push_back(nodes_->area(k) > 0 ? static_cast<float>(std::sqrt(
                                                      double(sums[k * stride]) / nodes_->area(k)))
                                                : 0.0f);
    out.total = n > 0 ? double(sums[0]) : 0.0;
    return out;
}

double LinkRefinement::allowed() const {
    double flux = 0, area = 0;
    for (const ElementId id : rows_.elements) {
        const auto A = double(area_[id.index()]);
        area += A;
        flux += A * double(radiosity_.columns.magnitude(direct_[id]) +
                           radiosity_.columns.magnitude(received_[id]));
    }
    return area > 0 ? flux * flux / area : 0.0;
}

// The end whose division helps more; of a link that is only bounded the larger cluster.
bool LinkRefinement::divide_a(const Link& link, const State& state) const {
    if (!can_divide(link.b)) return true;
    if (!can_divide(link.a)) return false;
    if (link.bound) {
        const auto size = [&](NodeId node) {
            return clusters_.is_cluster(node) ? clusters_.cluster(node).box.diagonal() : 0.0;
        };
        return size(link.a) >= size(link.b);
    }
    const std::size_t a = nodes_->position(link.a), b = nodes_->position(link.b);
    const double on_a = nodes_->area(a) * double(state.error[a]);
    const double on_b = nodes_->area(b) * double(state.error[b]);
    const Fault wrong = fault(link, state);
    return 2 * (on_a * wrong.by_a_on_a + on_b * wrong.by_a_on_b) >=
           on_a * wrong.on_a + on_b * wrong.on_b;
}

// Measured links are added; false if interrupted.
bool LinkRefinement::measure(const std::vector<Pair>& pairs) {
    for (std::size_t first = 0; first < pairs.size(); first += at_once) {
        if (options_.go_on && !options_.go_on(rays_)) return false;
        const std::size_t count = std::min(at_once, pairs.size() - first);
        std::vector<Link> found(count);
        std::vector<Meeting> meeting(count);
        rays_ += parallel_sum<std::uint64_t>(
            count,
            [&](std::size_t begin, std::size_t end) {
                std::uint64_t rays = 0;
                for (std::size_t i = begin; i < end; ++i) {
                    const auto [a, b] = pairs[first + i];
                    meeting[i] =
                        exchange_.measure(a, b, nodes_->area(nodes_->position(a)),
                                          nodes_->area(nodes_->position(b)), found[i], rays);
                }
                return rays;
            },
            64);
        for (std::size_t i = 0; i < count; ++i)
            if (meeting[i] != Meeting::none) links_.push_back(found[i]);
    }
    return true;
}

bool LinkRefinement::replace_links(double threshold, const State& state) {
    std::vector<Link> before;
    before.swap(links_);
    std::vector<Pair> pairs;
    if (!begun_) {
        // A link of everything with itself: of the children of every cluster with one another.
        std::vector<NodeId> open{clusters_.root()};
        while (!open.empty()) {
            const NodeId node = open.back();
            open.pop_back();
            if (!clusters_.is_cluster(node) || clusters_.cluster(node).plane) continue;
            const auto [first, second] = clusters_.cluster(node).children;
            pairs.push_back({first, second});
            open.push_back(first);
            open.push_back(second);
        }
    }
    for (const Link& link : before) {
        const Fault wrong = fault(link, state);
        const std::size_t a = nodes_->position(link.a), b = nodes_->position(link.b);
        const double part = nodes_->area(a) * double(state.error[a]) * wrong.on_a +
                            nodes_->area(b) * double(state.error[b]) * wrong.on_b;
        if (!(part > threshold)) {
            links_.push_back(link);
            continue;
        }
        const bool by_a = divide_a(link, state);
        const NodeId parent = by_a ? link.a : link.b, other = by_a ? link.b : link.a;
        const std::size_t children = clusters_.child_count(parent);
        if (children == 0) {  // is divided first
            wanted_.push_back(clusters_.element(parent));
            links_.push_back(link);
        }
        for (std::size_t c = 0; c < children; ++c)
            pairs.push_back({clusters_.child(parent, c), other});
    }
    if (!measure(pairs)) {
        links_.swap(before);
        wanted_.clear();
        return false;
    }
    begun_ = true;
    return true;
}

bool LinkRefinement::divide_elements(double threshold, const State& state) {
    Mesh& mesh = radiosity_.mesh;
    for (const ElementId id : rows_.elements) {
        const std::size_t k = nodes_->position(clusters_.node(id));
        if (nodes_->area(k) * double(state.error[k]) * lamps_fault(id) > threshold)
            wanted_.push_back(id);
    }
    std::sort(wanted_.begin(), wanted_.end());
    wanted_.erase(std::unique(wanted_.begin(), wanted_.end()), wanted_.end());
    std::vector<ElementId> divided;
    for (const ElementId id : wanted_) {
        if (!mesh[id].leaf()) continue;  // another's split took it along
        const auto done = mesh.split(id);
        divided.insert(divided.end(), done.begin(), done.end());
    }
    wanted_.clear();
    if (divided.empty()) return false;
    radiosity_.admit_new_vertices();
    std::vector<ElementId> leaves;
    for (ElementField* field : {&direct_, &received_, &reflected_})
        field->resize_rows(mesh.elements().size());
    for (const ElementId id : divided)
        for (std::size_t c = 0; c < 4; ++c) {
            const ElementId child(mesh[id].first_child.index() + c);
            // What the whole received, its parts receive.
            std::copy_n(received_[id].begin(), received_.stride(), received_[child].begin());
            if (mesh[child].leaf()) leaves.push_back(child);
        }
    admit_leaves(leaves);
    find_rows();
    reflect();
    return true;
}

bool LinkRefinement::refine(const RowField& reflected) {
    if (rows_.size() == 0) return false;
    const double enough = (begun_ ? still_enough : 1.0) * overestimate * options_.error;
    if (begun_)
        for (std::size_t i = 0; i < rows_.size(); ++i)
            std::copy_n(reflected[RowId(i)].begin(), reflected.stride(),
                        reflected_[rows_.elements[i]].begin());
    else
        guess_ambient();
    for (bool changed = false;; changed = true) {
        if (options_.each_round) options_.each_round(*this);
        const State now = state();
        const double all = allowed();
        worth_showing_ = gathered_ && now.total <= nearly_right * nearly_right * all;
        if (begun_ && now.total <= enough * enough * all) return changed;
        if (options_.go_on && !options_.go_on(rays_)) return changed;
        // Links that contribute more than others do.
        const double threshold = now.total / double(links_.size() + rows_.size());
        const std::size_t before = links_.size();
        if (!replace_links(threshold, now)) return changed;
        const bool divided = divide_elements(threshold, now);
        if (!divided && links_.size() == before) return changed;
        if (now.total <= std::max(right_enough * right_enough, enough * enough) * all) gather();
    }
}

}  // namespace exitance
