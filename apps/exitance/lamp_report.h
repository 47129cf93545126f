// SPDX-License-Identifier: Apache-2.0
// What info says about a photometric file.
#pragma once

#include <filesystem>
#include <string>

#include "exitance/scene/formats/lamp_file.h"
#include "exitance/scene/lamp_figures.h"

namespace exitance::cli {

class LampReport {
  public:
    LampReport(LampFile lamp, std::filesystem::path file);

    std::string text() const;
    std::string json() const;

  private:
    LampFile lamp_;
    LampFigures figures_;
    std::filesystem::path file_;
};

/// "point", "rectangle 1.16 × 0.21 m" …
std::string opening_text(const LuminousOpening& opening);

}  // namespace exitance::cli
