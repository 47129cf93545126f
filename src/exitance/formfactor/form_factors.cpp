// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/form_factors.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include "exitance/run/error.h"

namespace exitance {

namespace {

std::vector<std::string> names_of(const Enclosure& enclosure) {
    std::vector<std::string> names;
    for (const ExchangeSurface& surface : enclosure.surfaces) names.push_back(surface.name);
    return names;
}

}  // namespace

FormFactorOptions::FormFactorOptions() : method(form_factor_methods().front().name) {}

std::vector<std::string> FormFactors::names() const {
    return names_of(enclosure);
}

Options describe(FormFactorOptions& o) {
    std::vector<std::string> methods;
    std::string what = "how they are computed";
    const char* separator = ": ";
    for (const FormFactorMethod& method : form_factor_methods()) {
        methods.emplace_back(method.name);
        what += separator + std::string(method.name) + " = " + method.what;
        separator = "; ";
    }
    Options options{{"method", &o.method, what, "", 0, 0, methods}};
    for (Option& option : describe(o.enclosure)) options.push_back(std::move(option));
    for (Option& option : describe(o.sampling)) options.push_back(std::move(option));
    options.push_back({"enforce",
                       &o.enforce,
                       "reciprocity: A F symmetric; closure: rows add up to 1; both: the nearest "
                       "matrix (least squares) with both",
                       "",
                       0,
                       0,
                       {"none", "reciprocity", "closure", "both"}});
    options.push_back({"threads", &o.threads,
                       "worker threads; 0 = all cores; the result does not depend on it", "", 0,
                       1024});
    return options;
}

FormFactors form_factors(const Scene& scene, const FormFactorOptions& options,
                         const Observer& observe, const Cancel* cancel) {
    const tbb::global_control threads(
        tbb::global_control::max_allowed_parallelism,
        options.threads > 0 ? static_cast<std::size_t>(options.threads)
                            : static_cast<std::size_t>(tbb::info::default_concurrency()));
    const FormFactorMethod& method = find_form_factor_method(options.method);
    if (options.sampling.samples && !method.takes_samples)
        throw Error(
            Fault::wrong_use,
            fmt::format("--samples does nothing with --method {}, whose effort follows from "
                        "--accuracy",
                        method.name));
    Enclosure enclosure = make_enclosure(scene, options.enclosure);
    const std::vector<std::string> names = names_of(enclosure);
    MethodCounters counters;
    FormFactorMatrix F = method.compute({enclosure, options.sampling, observe, cancel, counters});
    if (cancel && cancel->requested())
        throw Error(Fault::could_not_finish, "stopped: the matrix is not complete");
    const MatrixQuality computed = quality(F);
    const Enforce what = enforce_by_name(options.enforce);
    F = enforced(std::move(F), what, names);
    const MatrixQuality now = what == Enforce::none ? computed : quality(F);
    return {std::move(enclosure), std::move(F),         computed,          now,
            counters.rays,        counters.evaluations, counters.unreached};
}

}  // namespace exitance
