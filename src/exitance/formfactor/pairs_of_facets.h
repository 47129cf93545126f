// SPDX-License-Identifier: Apache-2.0
// Methods that look at two facets at a time differ in one function of a pair.
#pragma once

#include <vector>

#include "exitance/formfactor/method.h"
#include "exitance/run/parallel.h"

namespace exitance {

/// Numbers of the facets of each row.
std::vector<std::vector<std::uint32_t>> facets_of_rows(const Enclosure& enclosure);

/// Whether each has a corner before the other's front.
bool may_see(const Facet& a, const Facet& b);

/// Adds up pair(f, g) [m²], symmetric in facets f and g, into the rows of the enclosure.
template <class Pair>
ExchangeAreas exchange_by_pairs(const MethodCall& call, const Pair& pair) {
    const Enclosure& enclosure = call.enclosure;
    const auto facets = facets_of_rows(enclosure);
    const std::size_t rows = facets.size();
    ExchangeAreas S(rows);
    WorkDone done(call, 0.5 * static_cast<double>(rows) * static_cast<double>(rows + 1));
    parallel_for(
        rows,
        [&](std::size_t reverse) {
            if (!done.wanted()) return;
            const std::size_t i = rows - 1 - reverse;  // the longest rows first
            std::vector<float> areas(i + 1);
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = 0;
                for (const std::uint32_t f : facets[i])
                    for (const std::uint32_t g : facets[j])
                        if (f != g && may_see(enclosure.facets[f], enclosure.facets[g]))
                            sum += pair(std::max(f, g), std::min(f, g));
                areas[j] = static_cast<float>(sum);
            }
            S.set_row(i, areas);
            done.add(static_cast<double>(i + 1));
        },
        1);
    return S;
}

}  // namespace exitance
