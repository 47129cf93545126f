// SPDX-License-Identifier: Apache-2.0
// From a scene to its matrix of form factors: enclosure, method, what is enforced, in this order.
#pragma once

#include <string>

#include "exitance/formfactor/closure.h"
#include "exitance/formfactor/method.h"
#include "exitance/formfactor/scene_enclosure.h"

namespace exitance {

struct FormFactorOptions {
    EnclosureOptions enclosure;
    std::string method;
    MethodOptions sampling;
    std::string enforce = "none";
    int threads = 0;  ///< 0 = all cores

    FormFactorOptions();
};

/// Every member of `options` with its name, unit, range and reason.
Options describe(FormFactorOptions& options);

struct FormFactors {
    Enclosure enclosure;
    FormFactorMatrix F;
    MatrixQuality computed;  ///< as the method left it
    MatrixQuality enforced;  ///< as it is now
    std::uint64_t rays = 0, evaluations = 0;
    std::uint64_t unreached = 0;  ///< factors, or rows, whose accuracy was not reached

    std::vector<std::string> names() const;
};

/// Throws Error(could_not_finish) if `cancel` was requested: rows are missing.
FormFactors form_factors(const Scene& scene, const FormFactorOptions& options,
                         const Observer& observe = {}, const Cancel* cancel = nullptr);

}  // namespace exitance
