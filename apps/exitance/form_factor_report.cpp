// SPDX-License-Identifier: Apache-2.0
#include "form_factor_report.h"

#include <fmt/format.h>

#include "human_number.h"

namespace exitance::cli {

namespace {

std::string quality_lines(const MatrixQuality& q, const std::vector<std::string>& names) {
    return fmt::format(
        "  row sums     {:.6f} ({}) … {:.6f} ({}), mean {:.6f}\n"
        "  reciprocity  A_i F_ij and A_j F_ji differ by at most {:.2g} of the smaller area\n",
        q.least_sum, names[q.least_row], q.most_sum, names[q.most_row], q.mean_sum,
        q.reciprocity_defect);
}

}  // namespace

std::string form_factor_report(const FormFactors& made, const FormFactorOptions& options) {
    const std::vector<std::string> names = made.names();
    const std::size_t rows = made.F.rows();
    std::string out =
        fmt::format("{} surfaces of {} facets, {} of {} factors are not zero, {}B\n", rows,
                    made.enclosure.facets.size(), human_count(double(made.enforced.entries)),
                    human_count(double(rows) * double(rows)), human_count(double(made.F.bytes())));
    out += fmt::format("by {}, accuracy {:g}{}{}\n", options.method, options.sampling.accuracy,
                       options.sampling.samples ? " replaced by --samples" : "",
                       made.rays ? ", " + human_count(double(made.rays)) + " rays" : "");
    out += quality_lines(made.computed, names);
    if (options.enforce != "none")
        out += fmt::format("after --enforce {}\n", options.enforce) +
               quality_lines(made.enforced, names);
    if (made.unreached)
        out += fmt::format(
            "the accuracy was not reached everywhere: {} times the method's most effort was not "
            "enough\n",
            made.unreached);
    return out;
}

std::string factor_list(const FormFactorMatrix& F, const std::vector<std::string>& names,
                        std::optional<std::size_t> row, std::optional<std::size_t> column) {
    std::string out =
        fmt::format("{:>6} {:>6} {:>12} {:>12}  from, to\n", "row", "column", "F", "A F [m²]");
    F.for_rows([&](std::size_t i, std::span<const FormFactorMatrix::Entry> entries) {
        if (row && i + 1 != *row) return;
        for (const auto& e : entries) {
            if (column && e.column + 1 != *column) continue;
            const double value = static_cast<double>(e.value);
            out += fmt::format("{:>6} {:>6} {:>12.6g} {:>12.6g}  {}, {}\n", i + 1, e.column + 1,
                               value, value * F.areas()[i], names[i], names[e.column]);
        }
    });
    return out;
}

}  // namespace exitance::cli
