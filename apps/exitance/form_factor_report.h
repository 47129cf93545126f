// SPDX-License-Identifier: Apache-2.0
// A matrix of form factors in a few lines.
#pragma once

#include <optional>
#include <string>

#include "exitance/formfactor/form_factors.h"

namespace exitance::cli {

/// Size, row sums and reciprocity before and after enforcement, whether the accuracy was reached.
std::string form_factor_report(const FormFactors& made, const FormFactorOptions& options);

/// One line per factor that is not zero; only of row or column `row`, `column` (from 1) if given.
std::string factor_list(const FormFactorMatrix& F, const std::vector<std::string>& names,
                        std::optional<std::size_t> row, std::optional<std::size_t> column);

}  // namespace exitance::cli
