// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/method.h"

#include <array>

#include "exitance/formfactor/contour.h"
#include "exitance/formfactor/disk.h"
#include "exitance/formfactor/hemicube.h"
#include "exitance/formfactor/hemisphere.h"
#include "exitance/formfactor/monte_carlo.h"
#include "exitance/formfactor/pairwise_method.h"
#include "exitance/run/error.h"

namespace exitance {

Options describe(MethodOptions& o) {
    return {
        {"accuracy", &o.accuracy,
         "error to aim at: of each form factor, seen from the smaller of its two surfaces; of "
         "auto, of all factors of a row together. Every method's effort follows from it",
         "", 1e-6, 0.1},
        {"samples", &o.samples,
         "effort instead of --accuracy: contour: segments an edge; disk: cells a polygon; "
         "hemicube: hemicubes a polygon; hemisphere: rays a polygon; monte-carlo: rays a pair",
         "", 1, 1e9},
        {"resolution", &o.resolution,
         "cells along the edge of a hemicube; default: 4/√accuracy, 32 to 1024", "", 2, 8192},
        {"rotate", &o.rotate,
         "turn each hemicube by an angle of its own, so that their aliasing differs"},
        {"seed", &o.seed, "seed of the random numbers; same seed, same bytes"},
    };
}

std::span<const FormFactorMethod> form_factor_methods() {
    static constexpr std::array methods{
        FormFactorMethod{"auto", "exact integrals, with shafts to find what is between", false,
                         pairwise_form_factors},
        FormFactorMethod{"analytic", "closed form of each pair, with rays to find what is between",
                         false, analytic_form_factors},
        FormFactorMethod{"contour", "numeric double contour integral (Goral et al. 1984)", true,
                         contour_form_factors},
        FormFactorMethod{"disk", "polygons as discs, with a ray to each (Wallace et al. 1989)",
                         true, disk_form_factors},
        FormFactorMethod{"hemicube", "item buffers on half a cube (Cohen & Greenberg 1985)", true,
                         hemicube_form_factors},
        FormFactorMethod{"hemisphere", "cosine-distributed rays (Malley 1988)", true,
                         hemisphere_form_factors},
        FormFactorMethod{"monte-carlo", "pairs of random places with a ray between them", true,
                         monte_carlo_form_factors},
    };
    return methods;
}

const FormFactorMethod& find_form_factor_method(const std::string& name) {
    std::vector<std::string> names;
    for (const FormFactorMethod& method : form_factor_methods()) {
        if (method.name == name) return method;
        names.emplace_back(method.name);
    }
    throw Error(Fault::wrong_use,
                "unknown form factor method '" + name + "'" + suggestion(name, names));
}

std::vector<double> surface_areas(const Enclosure& enclosure) {
    std::vector<double> areas;
    for (const ExchangeSurface& surface : enclosure.surfaces) areas.push_back(surface.area);
    return areas;
}

void WorkDone::add(double work) {
    const std::lock_guard lock(telling_);
    done_ += work;
    if (!observe_) return;
    Progress progress;
    progress.phase = "factors";
    progress.even = true;
    progress.seconds = clock_.seconds();
    progress.fraction_left = 1 - done_ / all_;
    progress.fraction_target = 0;
    progress.rays = rays_;
    observe_(progress);
}

}  // namespace exitance
