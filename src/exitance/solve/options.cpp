// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/options.h"

namespace exitance {

Options describe(SolveOptions& o) {
    return {
        {"error", &o.error,
         "RMS error of irradiance relative to its mean to aim at; mesh, samples and stopping "
         "follow",
         "", 1e-4, 1},
        {"time", &o.time, "stop after this long and keep the best solution so far", "s", 0},
        {"solver",
         &o.solver,
         "how the system is solved: shooting = progressive refinement",
         "",
         0,
         0,
         {"shooting"}},
        {"groups",
         &o.groups,
         "light groups that can be dimmed later: one for all, per lamp, per material, or as the "
         "file names them",
         "",
         0,
         0,
         {"none", "luminaire", "material", "file"}},
        {"unshot", &o.unshot,
         "stop when this share of the emitted energy is still to be distributed; default: from "
         "--error",
         "", 0, 1},
        {"next-shot", &o.next_shot,
         "stop when the next patch to shoot holds less than this share of the emitted energy", "",
         0, 1},
        {"patch-size", &o.patch_size,
         "longest edge of a shooting patch where the file does not divide; default: from --error",
         "m", 1e-6},
        {"min-area", &o.min_area,
         "elements are not subdivided below this area; default: from --error", "m²", 0},
        {"adaptive", &o.adaptive,
         "subdivide elements at shadow boundaries and where interpolation fails"},
        {"merge", &o.merge, "merge elements again where the finished solution is smooth"},
        {"occlusion", &o.occlusion, "test visibility; off = every patch sees every vertex"},
        {"overshoot", &o.overshoot,
         "shoot the estimated ambient share along with each patch (fewer shots to converge)"},
        {"form-factor",
         &o.form_factor,
         "factor from a vertex to a patch: exact (Lambert 1760) or disk approximation (Wallace "
         "1989)",
         "",
         0,
         0,
         {"lambert", "disk"}},
        {"threads", &o.threads, "worker threads; 0 = all cores; the result does not depend on it",
         "", 0, 1024},
        {"seed", &o.seed, "seed of the random numbers; same seed, same bytes"},
    };
}

}  // namespace exitance
