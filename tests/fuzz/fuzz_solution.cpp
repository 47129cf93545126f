// SPDX-License-Identifier: Apache-2.0
// Solutions, whose reader opens files: in memory, under a path of its own.
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "exitance/solution/file.h"
#include "fuzz/reads_or_refuses.h"

namespace {

using namespace exitance;

class FileInMemory {
  public:
    FileInMemory(const std::uint8_t* data, std::size_t size)
        : file_(::memfd_create("solution", MFD_CLOEXEC)) {
        if (file_ < 0 || ::write(file_, data, size) != static_cast<ssize_t>(size)) std::abort();
    }
    ~FileInMemory() { ::close(file_); }
    FileInMemory(const FileInMemory&) = delete;
    FileInMemory& operator=(const FileInMemory&) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

  private:
    int file_;
};

// What is accepted can be used: every index leads somewhere and light has a value.
void use(const Solution& s) {
    std::vector<float> exitance(s.columns());
    for (const SolutionPart& part : s.parts) {
        if (part.material >= s.materials.size() || part.group >= s.groups.size()) std::abort();
        for (std::uint32_t t = 0; t < part.triangles; ++t)
            for (const std::uint32_t v : s.triangles.at(part.first_triangle + t)) {
                if (v >= s.positions.size()) std::abort();
                s.exitance(v, part, exitance);
            }
    }
    for (const Emitter& emitter : s.emitters)
        if (emitter.part >= s.parts.size()) std::abort();
    for (const SolutionLuminaire& placed : s.luminaires)
        if (!(placed.luminaire.intensity({0, -1, 0}) >= 0)) std::abort();
    for (const SolutionDistantLight& placed : s.distant)
        if (std::isnan(luminance(placed.light.radiance({0, 1, 0})))) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const FileInMemory file(data, size);
    is_solution(file.path());
    return fuzz::reads_or_refuses(file.path(), [&] {
        use(read_solution(file.path()));
        return Scene{};
    });
}
