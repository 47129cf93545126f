// SPDX-License-Identifier: Apache-2.0
#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "exitance/scene/formats/source_text.h"
#include "human_number.h"

namespace exitance::cli {

namespace {

std::string group_names(const Solution& solution) {
    constexpr std::size_t most_named = 12;
    const std::size_t count = solution.groups.size();
    const std::size_t named = count > most_named ? most_named - 1 : count;
    std::string out;
    for (std::size_t g = 0; g < named; ++g) out += ", " + solution.groups[g].name;
    if (named < count) out += fmt::format(" and {} more", count - named);
    return out.substr(2);
}

std::string energy_line(const Solution& solution) {
    const EnergyBalance energy = shown(solution.energy);
    const std::string unit = flux_unit(solution.quantity);
    if (energy.emitted <= 0) return "nothing is emitted";
    const auto share = [&](double part) { return human_percent(part / energy.emitted); };
    return fmt::format(
        "{} emitted = {} absorbed + {} by backs and lamps + {} escaped + {} unshot; balance off by "
        "{}",
        human_quantity(energy.emitted, unit), share(energy.absorbed), share(energy.absorbed_behind),
        share(energy.escaped), share(energy.unshot), human_percent(std::abs(energy.imbalance())));
}

// How far the balance may be off before it is worth a warning.
double tolerable_imbalance(const Solution& solution) {
    const auto asked = solution.options.find("error");
    const auto error =
        asked == solution.options.end() ? std::nullopt : finite_number(asked->second);
    return std::max(0.05, 2 * error.value_or(0));
}

std::string balance_warning(const Solution& solution) {
    const double off = shown(solution.energy).imbalance();
    // Where nobody looks light is left as it is.
    if (solution.refined_for) return "";
    if (!(std::abs(off) > tolerable_imbalance(solution))) return "";
    return fmt::format(
        "the light that arrived is {} {} than what was emitted: most often {}a lamp is very close "
        "to a surface or inside of one (exitance info names those within 1 mm), where the mesh is "
        "too coarse for it",
        human_percent(std::abs(off)), off > 0 ? "less" : "more",
        solution.ended == Ended::out_of_time ? "there was too little time to divide the mesh, or "
                                             : "");
}

}  // namespace

EnergyBalance shown(EnergyBalance energy) {
    energy.unshot = std::max(0.0, energy.unshot);
    return energy;
}

void print_findings(const Scene& scene) {
    for (const Problem& note : scene.notes)
        std::fprintf(stderr, "note: %s: %s\n", note.place.text().c_str(), note.what.c_str());
    std::size_t number = 0;
    for (const Problem& warning : scene.warnings) {
        const std::string place = warning.place.text();
        std::fprintf(stderr, "warning %zu: %s%s%s\n", ++number, place.c_str(),
                     place.empty() ? "" : ": ", warning.what.c_str());
    }
}

void print_choice(const SolveOptions& options) {
    if (!goes_with_transport(options)) return;
    require_possible(options);
    fmt::print(stderr, "note: --transport {} is solved by --solver {}, for none was asked for\n",
               *options.transport, solver_of(options));
}

void print_lit_anew(const std::filesystem::path& scene) {
    const std::string ending = lower_extension(scene);
    if (ending != ".glb" && ending != ".gltf") return;
    fmt::print(stderr,
               "exitance: {} is a model, not a solution: it is lit anew, by its own lamps alone\n",
               scene.string());
}

std::string focus_text(const RefinedFor& what) {
    std::string out;
    if (what.camera) out = "what camera '" + *what.camera + "' sees";
    if (what.grid) out += (out.empty() ? "grid '" : " and grid '") + *what.grid + "'";
    return out;
}

std::string memory_text(const Solution& solution) {
    const auto limit = solution.options.find("memory");
    if (limit == solution.options.end()) return "";
    const auto counter = [&](const char* name) {
        const auto found = solution.counters.find(name);
        return found == solution.counters.end() ? std::nullopt : std::optional(found->second);
    };
    std::string out;
    if (const auto vertices = counter("vertices_by_memory"))
        out = fmt::format(
            "elements were not divided beyond a mesh of {} vertices (triangles add some in the "
            "file)",
            human_count(*vertices));
    if (const auto rays = counter("patch_rays_by_memory"))
        out += fmt::format("{}the balance had {} rays per patch", out.empty() ? "" : ", ",
                           human_count(*rays));
    return out.empty() ? out
                       : fmt::format("{}: --memory {} MB has room for no more", out, limit->second);
}

std::string error_text(const Solution& solution) {
    const ErrorEstimate& error = *solution.error;
    // Few points with most of the error tell little more than how large it may be.
    const std::string value =
        tells_a_value(error)
            ? fmt::format("{} ± {}", human_percent(error.rms), human_percent(error.confidence))
            : "below " + human_percent(error.rms + error.confidence);
    const std::string where =
        solution.refined_for ? " chosen for " + focus_text(*solution.refined_for) : "";
    return fmt::format("{} (RMS of irradiance over its mean, {} held-out points{})", value,
                       error.points, where);
}

std::string summary(const Solution& solution, const std::filesystem::path& file, double seconds,
                    const std::optional<Aim>& aim) {
    std::string out = fmt::format("{}: {}, {}, light groups: {}\n", file.string(),
                                  plural(solution.positions.size(), "vertex", "vertices"),
                                  plural(solution.triangles.size(), "triangle", "triangles"),
                                  group_names(solution));
    out += fmt::format("  energy  {}\n", energy_line(solution));
    const std::string warning = balance_warning(solution);
    if (!warning.empty()) out += fmt::format("  warning {}\n", warning);
    if (solution.refined_for)
        out += fmt::format("  refined for {}: rough elsewhere, not view-independent\n",
                           focus_text(*solution.refined_for));
    if (const std::string memory = memory_text(solution); !memory.empty())
        out += fmt::format("  memory  {}\n", memory);
    if (solution.error) out += fmt::format("  error   {}\n", error_text(solution));
    const std::string unreached = aim ? unreached_text(solution, *aim) : "";
    if (!unreached.empty()) out += fmt::format("  warning {}\n", unreached);
    const auto things = [&](const char* name, const char* one) -> std::string {
        const auto found = solution.counters.find(name);
        if (found == solution.counters.end() || found->second == 0) return {};
        const std::string number = human_count(found->second);
        return number + " " + (number == "1" ? one : name) + ", ";
    };
    out += fmt::format("  work    {}{}{:.3g} s\n", things("shots", "shot"), things("rays", "ray"),
                       seconds);
    return out;
}

}  // namespace exitance::cli
