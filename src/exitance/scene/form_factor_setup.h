// SPDX-License-Identifier: Apache-2.0
// What a file asks of its form factors, for whoever computes them: which surfaces count, which are
// added up, with what settings.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace exitance {

enum class FormFactorRole {
    normal,      ///< has form factors of its own
    mask,        ///< part of its base that does not count; no geometry
    null,        ///< hole in its base; no geometry
    obstruction  ///< only stands between others
};

struct FormFactorSurface {
    std::uint32_t surface = 0;  ///< into Scene::surfaces
    FormFactorRole role = FormFactorRole::normal;
    std::optional<std::uint32_t> base;     ///< the entry that it is cut out of
    std::optional<std::uint32_t> combine;  ///< the entry that its results are added to
    double emissivity = 1;                 ///< 0 … 1
};

struct FormFactorSetup {
    std::vector<FormFactorSurface> surfaces;  ///< in the order of the file; empty = none
    std::vector<std::pair<std::string, std::string>> options;  ///< key and value, as written
};

}  // namespace exitance
