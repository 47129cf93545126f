// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/links.h"

#include <algorithm>
#include <cmath>

#include "exitance/run/parallel.h"

namespace exitance {

namespace {

// Each halves what the sums miss; as in exchange_by_casting.cpp.
constexpr int scalings = 12;
// A row of few links must not be trusted to scale all others.
constexpr float most_scaling = 2;

}  // namespace

LinkNodes::LinkNodes(const Clusters& clusters, const ElementRows& rows)
    : position_(clusters.nodes(), none), of_row_(rows.size()), row_area_(rows.area) {
    if (rows.size() == 0) return;
    const auto admit = [&](NodeId node, std::uint32_t parent) {
        position_[node.index()] = static_cast<std::uint32_t>(order_.size());
        order_.push_back(node);
        parent_.push_back(parent);
    };
    admit(clusters.root(), 0);
    for (std::uint32_t k = 0; k < order_.size(); ++k) {
        const NodeId node = order_[k];
        for (std::size_t c = 0; c < clusters.child_count(node); ++c)
            admit(clusters.child(node, c), k);
    }
    row_.assign(order_.size(), none);
    area_.assign(order_.size(), 0.0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        of_row_[i] = position_[clusters.node(rows.elements[i]).index()];
        row_[of_row_[i]] = static_cast<std::uint32_t>(i);
        area_[of_row_[i]] = double(rows.area[i]);
    }
    for (std::size_t k = order_.size() - 1; k > 0; --k) area_[parent_[k]] += area_[k];
}

void LinkNodes::pull(const RowField& exitance, std::span<const float> scale,
                     std::vector<float>& flux) const {
    const std::size_t stride = exitance.stride();
    flux.assign(size() * stride, 0.0f);
    for (std::size_t k = size(); k-- > 0;) {
        if (row_[k] != none) {
            const auto B = exitance[RowId(row_[k])];
            const float area = row_area_[row_[k]] * (scale.empty() ? 1.0f : scale[row_[k]]);
            for (std::size_t c = 0; c < stride; ++c) flux[k * stride + c] = area * B[c];
        }
        if (k == 0) break;
        for (std::size_t c = 0; c < stride; ++c)
            flux[parent_[k] * stride + c] += flux[k * stride + c];
    }
}

void LinkNodes::push(std::vector<float>& received, std::span<const float> scale,
                     RowField& irradiance) const {
    const std::size_t stride = irradiance.stride();
    for (std::size_t k = 0; k < size(); ++k) {
        float* H = &received[k * stride];
        if (k > 0)
            for (std::size_t c = 0; c < stride; ++c) H[c] += received[parent_[k] * stride + c];
        if (row_[k] == none) continue;
        const auto row = irradiance[RowId(row_[k])];
        const float factor = scale.empty() ? 1.0f : scale[row_[k]];
        for (std::size_t c = 0; c < stride; ++c) row[c] += factor * H[c];
    }
}

std::size_t LinkNodes::bytes() const {
    return order_.capacity() * (sizeof(NodeId) + 2 * sizeof(std::uint32_t) + sizeof(double)) +
           position_.capacity() * sizeof(std::uint32_t) +
           of_row_.capacity() * (sizeof(std::uint32_t) + sizeof(float));
}

LinkTransport::LinkTransport(const LinkNodes& nodes, std::span<const Link> links, std::size_t rows,
                             double accuracy)
    : nodes_(nodes), rows_(rows), accuracy_(accuracy), begin_(nodes.size() + 1, 0) {
    const auto carries = [&](const Link& link) {
        return link.area > 0 && nodes.area(nodes.position(link.a)) > 0 &&
               nodes.area(nodes.position(link.b)) > 0;
    };
    for (const Link& link : links) {
        if (!carries(link)) continue;
        ++begin_[nodes.position(link.a) + 1];
        ++begin_[nodes.position(link.b) + 1];
    }
    for (std::size_t k = 0; k < nodes.size(); ++k) begin_[k + 1] += begin_[k];
    partner_.resize(begin_.back());
    share_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (const Link& link : links) {
        if (!carries(link)) continue;
        const std::size_t a = nodes.position(link.a), b = nodes.position(link.b);
        const auto share = static_cast<float>(double(link.area) / (nodes.area(a) * nodes.area(b)));
        partner_[next[a]] = static_cast<std::uint32_t>(b), share_[next[a]++] = share;
        partner_[next[b]] = static_cast<std::uint32_t>(a), share_[next[b]++] = share;
    }
}

// Sinkhorn's scaling of a symmetric matrix, D S D.
void LinkTransport::scale_to(std::span<const float> wanted) {
    scale_.assign(rows_, 1.0f);
    RowField ones(rows_, 1), sums(rows_, 1);
    for (std::size_t i = 0; i < rows_; ++i) ones[RowId(i)][0] = 1;
    const TransportCounters before = counters_;
    for (int step = 0; step < scalings; ++step) {
        gather(ones, sums);
        for (std::size_t i = 0; i < rows_; ++i) {
            const float sum = sums[RowId(i)][0];
            if (sum > 0 && wanted[i] > 0)
                scale_[i] = std::clamp(scale_[i] * std::sqrt(wanted[i] / sum), 1 / most_scaling,
                                       most_scaling);
        }
    }
    counters_ = before;
}

void LinkTransport::gather(const RowField& exitance, RowField& irradiance) {
    ++counters_.gathers;
    const std::size_t stride = exitance.stride();
    std::vector<float> flux, received(nodes_.size() * stride, 0.0f);
    nodes_.pull(exitance, scale_, flux);
    parallel_for(
        nodes_.size(),
        [&](std::size_t k) {
            float* H = &received[k * stride];
            for (std::size_t l = begin_[k]; l < begin_[k + 1]; ++l) {
                const float* B = &flux[partner_[l] * stride];
                for (std::size_t c = 0; c < stride; ++c) H[c] += share_[l] * B[c];
            }
        },
        64);
    for (std::size_t i = 0; i < rows_; ++i)
        std::fill(irradiance[RowId(i)].begin(), irradiance[RowId(i)].end(), 0.0f);
    nodes_.push(received, scale_, irradiance);
}

void LinkTransport::shoot(RowId from, std::span<const float> exitance, RowField& irradiance) {
    ++counters_.shots;
    const std::size_t stride = exitance.size();
    std::vector<float> received(nodes_.size() * stride, 0.0f), flux(stride);
    const float own = scale_.empty() ? 1.0f : scale_[from.index()];
    bool first = true;
    nodes_.for_ancestors(from, [&](std::size_t k) {
        if (first)
            for (std::size_t c = 0; c < stride; ++c)
                flux[c] = static_cast<float>(nodes_.area(k)) * own * exitance[c];
        first = false;
        for (std::size_t l = begin_[k]; l < begin_[k + 1]; ++l) {
            float* H = &received[partner_[l] * stride];
            for (std::size_t c = 0; c < stride; ++c) H[c] += share_[l] * flux[c];
        }
    });
    nodes_.push(received, scale_, irradiance);
}

}  // namespace exitance
