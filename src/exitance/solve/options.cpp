// SPDX-License-Identifier: Apache-2.0
#include "exitance/solve/options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "exitance/run/error.h"
#include "exitance/solve/element_methods.h"

namespace exitance {

namespace {

std::vector<std::string> solver_names() {
    std::vector<std::string> names{std::string(adaptive_gathering), std::string(adaptive_shooting)};
    for (const ElementMethod& method : element_methods()) names.emplace_back(method.name);
    return names;
}

[[noreturn]] void refuse(const std::string& what) {
    throw Error(Fault::wrong_use, what);
}

}  // namespace

Options describe(SolveOptions& o) {
    return {
        {"error", &o.error,
         "RMS error of irradiance relative to its mean to aim at; mesh, samples and stopping "
         "follow",
         "", 1e-4, 1},
        {"view", &o.view,
         "refine for what this camera of the scene sees; elsewhere the solution stays rough and is "
         "not view-independent"},
        {"grid", &o.grid,
         "the same for the sensors of this grid of the scene, alone or besides --view"},
        {"time", &o.time, "stop after this long and keep the best solution so far", "s", 0},
        {"memory", &o.memory,
         "most memory that the whole process takes, by count: elements are not divided further "
         "where it ends, which the summary says; for gathering",
         "MB", 1, 1e9},
        {"solver", &o.solver,
         "how the system is solved: gathering = a rough balance on stored ray hits and one "
         "gathering step where light needs it, shooting = progressive refinement; both divide "
         "elements where light needs it; the others are for one exitance per element; default: "
         "gathering, jacobi where a --transport other than on-the-fly asks for it, or shooting "
         "where "
         "--unshot, --next-shot, --no-overshoot, --no-occlusion or --form-factor disk do",
         "", 0, 0, solver_names()},
        {"transport",
         &o.transport,
         "how the solvers of elements hold their form factors: in a matrix, one without its zeros, "
         "not at all, as links between clusters and elements, which are divided where light needs "
         "it, or as fresh rays in every product; default: dense, above 10000 elements sparse",
         "",
         0,
         0,
         {transports.begin(), transports.end()}},
        {"factors",
         &o.factors,
         "where the matrix of elements comes from: rays over each element's hemisphere, or the "
         "exact factors of all pairs; default: hemisphere, for up to 256 elements pairs",
         "",
         0,
         0,
         {"hemisphere", "pairs"}},
        {"vertices",
         &o.vertices,
         "how vertices get light from solved elements: one gathering step, or the mean of the "
         "elements around; default: gather",
         "",
         0,
         0,
         {"gather", "average"}},
        {"element-rays", &o.element_rays,
         "rays over the hemisphere of an element that tell its form factors; of --transport "
         "stochastic, rays per element and product; default: from --error",
         "", 16, 1 << 20},
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
        {"element-size", &o.element_size,
         "patches are divided evenly into elements with edges no longer than this; default: from "
         "--error, not at all for shooting and gathering, which divide where it matters",
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

namespace {

bool asks_for_shooting(const SolveOptions& o) {
    return o.unshot || o.next_shot || !o.overshoot || !o.occlusion || o.form_factor != "lambert";
}

}  // namespace

std::string solver_of(const SolveOptions& options) {
    if (options.solver) return *options.solver;
    if (goes_with_transport(options)) return "jacobi";  // which every transport goes with
    return std::string(asks_for_shooting(options) ? adaptive_shooting : adaptive_gathering);
}

bool goes_with_transport(const SolveOptions& options) {
    return !options.solver && options.transport && *options.transport != "on-the-fly";
}

bool by_elements(const SolveOptions& options) {
    const std::string solver = solver_of(options);
    return solver != adaptive_shooting && solver != adaptive_gathering;
}

bool of_elements(const std::string& option) {
    return option == "transport" || option == "factors" || option == "vertices" ||
           option == "element-rays" || option == "element-size";
}

namespace {

// As messages name it.
std::string solver_text(const SolveOptions& o) {
    return "--solver " + solver_of(o) +
           (goes_with_transport(o) ? " (for --transport " + *o.transport + ")" : "");
}

// "--solver jacobi or stochastic"
std::string solvers_for(const std::string& transport) {
    std::vector<std::string> names;
    for (const ElementMethod& method : element_methods())
        if (go_together(method, transport)) names.emplace_back(method.name);
    const std::string last = names.back();
    names.pop_back();
    return fmt::format("--solver {} or {}", fmt::join(names, ", "), last);
}

// Others do not know what matters to whom.
void require_focus_possible(const SolveOptions& o) {
    const std::string solver = solver_of(o);
    if ((!o.view && !o.grid) || solver == adaptive_gathering) return;
    refuse(std::string(o.view ? "--view " + *o.view : "--grid " + *o.grid) +
           " cannot be had with " + solver_text(o) +
           ", which refines for all places alike; expected --solver gathering");
}

// Others hold what they need at once.
void require_memory_possible(const SolveOptions& o) {
    if (!o.memory || solver_of(o) == adaptive_gathering) return;
    refuse("--memory cannot be had with " + solver_text(o) +
           ", which cannot do with less than its elements and form factors take; expected "
           "--solver gathering");
}

// Of the solvers that divide elements as light needs it.
void require_adaptive(const SolveOptions& o) {
    const std::string solver = solver_of(o), with = " cannot be had with --solver " + solver;
    const std::string elements = "; expected a solver of elements, as --solver jacobi";
    if (o.transport && *o.transport != "on-the-fly")
        refuse("--transport " + *o.transport + with +
               ", which holds no form factors of elements; expected " + solvers_for(*o.transport));
    if (o.factors) refuse("--factors" + with + ", which has no matrix of elements" + elements);
    if (o.vertices)
        refuse("--vertices" + with + ", which solves for the vertices themselves" + elements);
    if (o.element_rays) refuse("--element-rays" + with + ", which has no rows" + elements);
    if (solver == adaptive_shooting) return;
    const std::string shooting = "; expected --solver shooting";
    if (o.unshot) refuse("--unshot" + with + ", which is done with all light at once" + shooting);
    if (o.next_shot) refuse("--next-shot" + with + ", which does not shoot" + shooting);
    if (!o.overshoot) refuse("--no-overshoot" + with + ", which does not shoot" + shooting);
    if (!o.occlusion)
        refuse("--no-occlusion" + with +
               ": rays tell what a vertex sees, and they end where they hit" + shooting);
    if (o.form_factor != "lambert")
        refuse("--form-factor " + o.form_factor + with +
               ": rays tell what a vertex sees of what reflects" + shooting);
}

}  // namespace

void require_possible(const SolveOptions& o) {
    require_focus_possible(o);
    require_memory_possible(o);
    if (!by_elements(o)) return require_adaptive(o);
    const std::string solver = solver_of(o), with = " cannot be had with " + solver_text(o);
    const bool links = o.transport == "links";
    if (o.min_area && !links)
        refuse("--min-area" + with +
               ": its elements stay as they are; expected --element-size, or --transport links");
    if (o.transport && !go_together(element_method(solver), *o.transport))
        refuse("--transport " + *o.transport + with +
               (links ? ": a sample of its rows costs more than a whole product over links"
                      : ", which needs the same operator in every step") +
               "; expected " + solvers_for(*o.transport));
    if (o.factors && (links || o.transport == "stochastic"))
        refuse("--factors cannot be had with --transport " + *o.transport +
               ", which has no matrix; expected dense or sparse");
    if (o.next_shot && solver != "southwell")
        refuse("--next-shot" + with +
               ", which does not choose what to shoot next; expected --unshot");
    if (!o.occlusion)
        refuse("--no-occlusion" + with +
               ": rays tell what an element sees, and they end where they hit; expected --solver "
               "shooting");
    if (o.form_factor != "lambert")
        refuse("--form-factor " + o.form_factor + with +
               ": the factor of a vertex and a patch has no part in a matrix of elements; expected "
               "--solver shooting");
}

void require_resumable(const SolveOptions& o) {
    if (solver_of(o) == adaptive_gathering) return;
    refuse("--resume cannot be had with " + solver_text(o) +
           ": what is still to be distributed is not in a file; expected --solver gathering");
}

}  // namespace exitance
