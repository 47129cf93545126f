// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/element_methods.h"

#include "exitance/run/error.h"
#include "exitance/solve/jacobi.h"
#include "exitance/solve/krylov.h"
#include "exitance/solve/relaxation.h"
#include "exitance/solve/stochastic.h"

namespace exitance {

namespace {

template <class Method>
std::unique_ptr<ElementSolver> make(const ElementSystem& system, Transport& transport,
                                    const ElementSolverOptions& options) {
    return std::make_unique<Method>(system, transport, options);
}

constexpr std::array methods{
    ElementMethod{"jacobi", "gathering, all rows at once", make<Jacobi>, true, false},
    ElementMethod{"gauss-seidel", "one row after the other", make<GaussSeidel>, false, false},
    ElementMethod{"southwell", "the row with most unshot light first", make<Southwell>, false,
                  false},
    ElementMethod{"krylov", "conjugate gradients on the symmetrised system", make<Krylov>, false,
                  false},
    ElementMethod{"stochastic", "gathering from random samples", make<StochasticJacobi>, true,
                  true},
};

}  // namespace

std::span<const ElementMethod> element_methods() {
    return methods;
}

const ElementMethod& element_method(const std::string& name) {
    std::vector<std::string> names;
    for (const ElementMethod& method : methods) {
        if (method.name == name) return method;
        names.emplace_back(method.name);
    }
    throw Error(Fault::wrong_use, "unknown solver '" + name + "'" + suggestion(name, names));
}

bool go_together(const ElementMethod& method, std::string_view transport) {
    if (transport == "links") return !method.samples_rows;
    return method.bears_samples || transport != "stochastic";
}

}  // namespace exitance
