// SPDX-License-Identifier: Apache-2.0
#include "exitance/pipeline.h"

#include "exitance/run/error.h"

namespace exitance {

Solution light(const Scene&, const SolveOptions&, const Observer&, const Cancel*) {
    throw Error(Fault::could_not_finish, "the solver is being built");
}

}  // namespace exitance
