// SPDX-License-Identifier: Apache-2.0
// Every way to form factors has this one interface and stands in one list.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "exitance/formfactor/enclosure.h"
#include "exitance/formfactor/form_factor_matrix.h"
#include "exitance/run/options.h"
#include "exitance/run/progress.h"

namespace exitance {

/// What follows from `accuracy` where it is not set.
struct MethodOptions {
    /// Error to aim at: of A_i F_ij in units of the smaller area, that is of the factor from the
    /// smaller of the two surfaces.
    double accuracy = 1e-4;
    std::optional<double> samples{};     ///< instead of sampling until the accuracy is reached
    std::optional<double> resolution{};  ///< of a hemicube: cells along its edge
    bool rotate = true;                  ///< each hemicube by an angle of its own
    std::uint64_t seed = 0;
};

/// Every member of `options` with its name, unit, range and reason.
Options describe(MethodOptions& options);

struct MethodCounters {
    std::atomic<std::uint64_t> rays{0};
    std::atomic<std::uint64_t> evaluations{0};  ///< kernels, or hemicubes
    std::atomic<std::uint64_t> unreached{0};    ///< factors whose accuracy was not reached
};

/// What a method is called with. `observe` is called by one thread at a time.
struct MethodCall {
    const Enclosure& enclosure;
    const MethodOptions& options;
    const Observer& observe;
    const Cancel* cancel;
    MethodCounters& counters;
};

struct FormFactorMethod {
    const char* name;
    const char* what;    ///< one line, with its source
    bool takes_samples;  ///< MethodOptions::samples
    /// Rows are missing where the call was cancelled. Deterministic for any number of threads.
    FormFactorMatrix (*compute)(const MethodCall&);
};

std::span<const FormFactorMethod> form_factor_methods();

/// Throws Error(wrong_use) with a suggestion if there is none of that name.
const FormFactorMethod& find_form_factor_method(const std::string& name);

std::vector<double> surface_areas(const Enclosure& enclosure);

/// Counts finished work and tells the observer, one thread at a time.
class WorkDone {
  public:
    /// Of `all`; `rays` are told along.
    WorkDone(const Observer& observe, const Cancel* cancel, const std::atomic<std::uint64_t>& rays,
             double all)
        : observe_(observe), cancel_(cancel), rays_(rays), all_(all) {}
    WorkDone(const MethodCall& call, double all)
        : WorkDone(call.observe, call.cancel, call.counters.rays, all) {}
    /// False if the work was cancelled.
    bool wanted() const { return !(cancel_ && cancel_->requested()); }
    void add(double work);

  private:
    const Observer& observe_;
    const Cancel* cancel_;
    const std::atomic<std::uint64_t>& rays_;
    double all_;
    double done_ = 0;
    std::mutex telling_{};
    Stopwatch clock_{};
};

}  // namespace exitance
