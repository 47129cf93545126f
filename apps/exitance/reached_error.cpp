// SPDX-License-Identifier: Apache-2.0
#include "reached_error.h"

#include <fmt/format.h>

#include "exitance/scene/formats/source_text.h"
#include "exitance/solve/element_methods.h"
#include "human_number.h"

namespace exitance::cli {

namespace {

// Empty if the file does not tell.
std::string option(const Solution& solution, const std::string& name) {
    const auto found = solution.options.find(name);
    return found == solution.options.end() ? "" : found->second;
}

std::string time_text(const Solution& solution) {
    const std::string seconds = option(solution, "time");
    return seconds.empty() ? "--time" : "--time " + seconds + " s";
}

// What kept the solver from more, and what would not.
std::string reason(const Solution& solution, Ended ended) {
    const std::string solver = option(solution, "solver");
    const bool gathering = solver == adaptive_gathering;
    if (ended == Ended::out_of_time)
        return time_text(solution) + " was over; " +
               (gathering ? "more time, or --resume from this file, goes on" : "more time goes on");
    if (ended == Ended::cancelled)
        return std::string("it was stopped before") +
               (gathering ? "; --resume goes on from this file" : "");
    for (const char* rule : {"next-shot", "unshot"})
        if (const std::string value = option(solution, rule); !value.empty())
            return fmt::format("--{} {} ended the work; --error alone goes on until it is reached",
                               rule, value);
    if (solver != adaptive_gathering && solver != adaptive_shooting)
        return fmt::format(
            "--solver {} ends when its elements are in balance; the default solver divides them "
            "until the error is reached, and a smaller {} helps this one",
            solver, option(solution, "transport") == "links" ? "--error" : "--element-size");
    if (option(solution, "adaptive") == "false") return "--no-adaptive forbids to divide elements";
    if (solution.counters.contains("vertices_by_memory"))
        return "there was no memory for more; give it more --memory, or refine only what a "
               "--view or --grid needs";
    if (const std::string area = option(solution, "min-area"); !area.empty())
        return fmt::format(
            "elements were not divided below --min-area {} m²; a smaller one or a smaller "
            "--patch-size may help",
            area);
    // Where a lamp lights little that lights the rest, that much sends the light of all.
    return "smaller elements made it no better; a smaller --patch-size may, for patches are what "
           "sends light on, and exitance info tells what may be wrong with the scene";
}

}  // namespace

std::optional<Aim> aim_of(const Solution& solution) {
    const auto error = finite_number(option(solution, "error"));
    if (!error) return std::nullopt;
    return Aim{*error, solution.ended};
}

bool tells_a_value(const ErrorEstimate& estimate) {
    return estimate.confidence < estimate.rms;
}

std::optional<bool> reached(const Solution& solution, const Aim& aim) {
    if (!solution.error) return std::nullopt;
    const ErrorEstimate& estimate = *solution.error;
    if (estimate.rms - estimate.confidence > aim.error) return false;
    const bool well_known = 2 * estimate.confidence < estimate.rms;
    if (!well_known && estimate.rms + estimate.confidence > aim.error) return std::nullopt;
    return true;
}

std::string unreached_text(const Solution& solution, const Aim& aim) {
    if (!solution.error) return "";
    const auto is = reached(solution, aim);
    if (!is)
        return fmt::format(
            "whether the error aimed at, {}, is reached is uncertain: a few of the points have "
            "most of it; a smaller --error makes sure",
            human_percent(aim.error));
    if (*is) return "";
    return fmt::format("the error aimed at, {}, is not reached: {}", human_percent(aim.error),
                       reason(solution, aim.ended));
}

std::string stopped_text(const Solution& solution) {
    if (solution.ended == Ended::out_of_time) return "stopped by " + time_text(solution);
    if (solution.ended == Ended::cancelled) return "stopped early";
    return "";
}

}  // namespace exitance::cli
