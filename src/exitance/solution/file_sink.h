// SPDX-License-Identifier: Apache-2.0
// How the numbers of a solution file leave: collected, and none that is not finite.
#pragma once

#include <cmath>
#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

#include "exitance/math/vector.h"
#include "exitance/run/error.h"

namespace exitance::solution_file {

[[noreturn]] inline void not_finite(const std::string& what) {
    throw Error(Fault::could_not_finish, "the solution holds a value that is not finite: " + what);
}

/// Collects small writes; checks that what leaves is finite.
class Sink {
  public:
    explicit Sink(std::ostream& out) : out_(&out) { buffer_.reserve(capacity); }
    ~Sink() { flush(); }
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;

    template <class T>
    void put(T value) {
        if constexpr (std::is_floating_point_v<T>)
            if (!std::isfinite(value)) not_finite("a vertex or an emitter");
        if (buffer_.size() + sizeof value > capacity) flush();
        const auto* bytes = reinterpret_cast<const char*>(&value);
        buffer_.insert(buffer_.end(), bytes, bytes + sizeof value);
    }
    template <class T>
    void put(const Vector3<T>& v) {
        put(v.x), put(v.y), put(v.z);
    }

  private:
    void flush() {
        out_->write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
        buffer_.clear();
    }
    static constexpr std::size_t capacity = 1 << 20;
    std::ostream* out_;
    std::vector<char> buffer_;
};

}  // namespace exitance::solution_file
