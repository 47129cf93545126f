// SPDX-License-Identifier: Apache-2.0
#include "exitance/transport/exchange_by_casting.h"

#include <algorithm>
#include <cmath>

#include "exitance/run/parallel.h"

namespace exitance {

namespace {

constexpr std::size_t rows_at_once = 1024;
// Scaling the rows halves what their sums miss each time; what is left of a sum's noise after so
// many is below a ten-thousandth.
constexpr int scalings = 12;
// A row of few rays must not be trusted to scale all others.
constexpr double most_scaling = 2;

using Hits = std::vector<RowHits>;  // ascending rows

void add_up(Hits& hits) {
    std::sort(hits.begin(), hits.end(), [](const RowHits& a, const RowHits& b) {
        return a.row != b.row ? a.row < b.row : a.rays < b.rays;
    });
    std::size_t kept = 0;
    for (const RowHits& hit : hits) {
        if (kept > 0 && hits[kept - 1].row == hit.row)
            hits[kept - 1].rays += hit.rays;
        else
            hits[kept++] = hit;
    }
    hits.resize(kept);
    hits.shrink_to_fit();
}

/// Lower triangle by rows: who hit whom, both ways, as exchange areas.
struct Triangle {
    std::vector<std::vector<std::uint32_t>> columns;
    std::vector<std::vector<float>> areas;

    template <class Visit>
    void for_pairs(const Visit& visit) const {
        for (std::size_t i = 0; i < columns.size(); ++i)
            for (std::size_t k = 0; k < columns[i].size(); ++k)
                visit(i, std::size_t{columns[i][k]}, double(areas[i][k]));
    }
};

Triangle merge(std::vector<Hits>& hits, const std::vector<double>& area_per_ray) {
    const std::size_t n = hits.size();
    // The other half: hits of later rows on earlier ones, by the row that was hit.
    std::vector<Hits> others(n);
    for (std::size_t i = 0; i < n; ++i)
        for (const RowHits& hit : hits[i])
            if (hit.row > i) others[hit.row].push_back({static_cast<std::uint32_t>(i), hit.rays});
    Triangle out;
    out.columns.resize(n), out.areas.resize(n);
    parallel_for(
        n,
        [&](std::size_t i) {
            Hits& both = others[i];
            for (const RowHits& hit : hits[i])
                if (hit.row <= i)
                    both.push_back({hit.row, hit.rays * (hit.row == i ? 2.0f : 1.0f)});
            hits[i] = {};
            add_up(both);
            for (const RowHits& pair : both) {
                const double a = area_per_ray[i], b = area_per_ray[pair.row];
                if (!(a > 0 && b > 0)) continue;
                out.columns[i].push_back(pair.row);
                out.areas[i].push_back(static_cast<float>(double(pair.rays) / (1 / a + 1 / b)));
            }
            both = {};
        },
        16);
    return out;
}

// Sinkhorn's scaling of a symmetric matrix: D S D with the row sums that are asked for.
void scale_to(Triangle& triangle, const std::vector<double>& wanted) {
    const std::size_t n = wanted.size();
    std::vector<double> d(n, 1.0), sum(n);
    for (int step = 0; step < scalings; ++step) {
        std::fill(sum.begin(), sum.end(), 0.0);
        triangle.for_pairs([&](std::size_t i, std::size_t j, double area) {
            sum[i] += area * d[i] * d[j];
            if (i != j) sum[j] += area * d[i] * d[j];
        });
        for (std::size_t i = 0; i < n; ++i)
            if (sum[i] > 0 && wanted[i] > 0)
                d[i] = std::clamp(d[i] * std::sqrt(wanted[i] / sum[i]), 1 / most_scaling,
                                  most_scaling);
    }
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < triangle.columns[i].size(); ++k)
            triangle.areas[i][k] *= static_cast<float>(d[i] * d[triangle.columns[i][k]]);
}

/// What the rays of all rows have met.
struct Cast {
    std::vector<Hits> hits;
    std::vector<double> met;          ///< rays of a row that met anything
    std::vector<std::uint32_t> rays;  ///< of each row, from its open places
    bool whole = false;               ///< not interrupted

    Cast(const ElementCaster& caster, const ElementRows& rows,
         const std::function<bool(std::uint64_t rays)>& go_on, const LookAtEnds& look)
        : hits(rows.size()), met(rows.size(), 0.0), rays(rows.size(), 0) {
        std::uint64_t so_far = 0;
        for (std::size_t first = 0; first < rows.size(); first += rows_at_once) {
            if (!go_on(so_far)) return;
            const std::size_t count = std::min(rows_at_once, rows.size() - first);
            parallel_for(
                count,
                [&](std::size_t k) {
                    const std::size_t i = first + k;
                    if (!(rows.area[i] > 0)) return;
                    rays[i] = caster.cast_places(i, [&](const ElementCaster::Ends& ends) {
                        for (std::uint32_t e = 0; e < ends.count; ++e) {
                            if (!(rows.area[ends.row[e]] > 0)) continue;
                            hits[i].push_back({ends.row[e], ends.rays[e]});
                            met[i] += double(ends.rays[e]);
                        }
                        if (look) look(i, ends);
                    });
                    add_up(hits[i]);
                },
                8);
            so_far += std::uint64_t{caster.rays()} * count;
        }
        go_on(so_far);
        whole = true;
    }
};

ExchangeAreas exchange_areas(Cast& cast, std::span<const float> area) {
    const std::size_t n = area.size();
    ExchangeAreas out(n);
    if (!cast.whole) return out;
    std::vector<double> area_per_ray(n, 0.0), wanted(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        if (cast.rays[i] == 0) continue;
        area_per_ray[i] = double(area[i]) / cast.rays[i];
        wanted[i] = area_per_ray[i] * cast.met[i];
    }
    Triangle triangle = merge(cast.hits, area_per_ray);
    scale_to(triangle, wanted);
    for (std::size_t i = 0; i < n; ++i)
        out.set_row(i, std::move(triangle.columns[i]), std::move(triangle.areas[i]));
    return out;
}

}  // namespace

ExchangeAreas cast_exchange_areas(const ElementCaster& caster, const ElementRows& rows,
                                  const std::function<bool(std::uint64_t rays)>& go_on) {
    Cast cast(caster, rows, go_on, {});
    return exchange_areas(cast, rows.area);
}

ExchangeAreas cast_exchange_areas(const ElementCaster& caster, ElementRows& rows,
                                  const std::function<bool(std::uint64_t rays)>& go_on,
                                  const LookAtEnds& look, const Mesh& mesh) {
    Cast cast(caster, rows, go_on, look);
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows.area[i] > 0)
            rows.area[i] = mesh[rows.elements[i]].area * static_cast<float>(cast.rays[i]) /
                           static_cast<float>(caster.rays());
    return exchange_areas(cast, rows.area);
}

}  // namespace exitance
