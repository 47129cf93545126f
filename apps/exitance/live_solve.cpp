// SPDX-License-Identifier: Apache-2.0
#include "live_solve.h"

#include <algorithm>
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "exitance/pipeline.h"
#include "exitance/solution/file.h"
#include "progress_bar.h"

namespace exitance::cli {

namespace {

/// When the next picture of the solution so far is due: soon at first, then so that making them
/// takes at most a tenth of the time.
class Pace {
  public:
    bool due() const { return clock_.seconds() >= next_; }
    void took(double seconds) { next_ = clock_.seconds() + std::max(0.5, 10 * seconds); }

  private:
    Stopwatch clock_;
    double next_ = 0.2;
};

std::string told(const Progress& progress, bool paused) {
    nlohmann::json line = nlohmann::json::parse(json_line(progress));
    line["done"] = share_done(progress);
    line["paused"] = paused;
    return line.dump();
}

}  // namespace

Lit solve_live(const Scene& scene, const SolveOptions& options, ViewServer& server,
               const std::filesystem::path& file, const Observer& observe, const Cancel& interrupt,
               bool keep, const Snapshots& snapshots, Resumption* resumed) {
    Cancel cancel;
    std::atomic<bool> paused = false;
    server.on_command([&](ViewCommand command) {
        paused = command == ViewCommand::pause;
        if (command == ViewCommand::stop) cancel.request();
    });
    const auto look_around = [&] {
        const bool deserted = server.deserted();
        if (interrupt.requested() || (!keep && deserted)) cancel.request();
        if (deserted) paused = false;  // nobody is left who could resume
    };
    Pace pace;
    Stopwatch since_told;
    double last_told = -1;
    const Observer watch = [&](const Progress& progress) {
        if (observe) observe(progress);
        look_around();
        if (paused) server.tell_progress(told(progress, true));
        while (paused && !cancel.requested()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            look_around();
        }
        if (since_told.seconds() - last_told < 0.1) return;
        last_told = since_told.seconds();
        server.tell_progress(told(progress, false));
    };
    Snapshots shown = snapshots;
    shown.unshot = true;
    shown.take = [&](Solution so_far) {
        const Stopwatch clock;
        write_solution(so_far, file);
        server.show(file);
        pace.took(clock.seconds());
        if (snapshots.take) snapshots.take(std::move(so_far));
    };
    shown.wanted = [&](const Progress&) { return server.has_pages() && pace.due(); };
    Solution solution = light(scene, options, watch, &cancel, shown, resumed);
    server.on_command({});
    write_solution(solution, file);
    server.show(file);
    Progress done;
    done.phase = "done", done.fraction_left = 0;
    if (solution.error) done.error = solution.error->rms;
    server.tell_progress(told(done, false));
    return {std::move(solution), cancel.requested()};
}

}  // namespace exitance::cli
