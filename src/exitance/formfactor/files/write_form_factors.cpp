// SPDX-License-Identifier: Apache-2.0
#include "exitance/formfactor/files/write_form_factors.h"

#include <fmt/format.h>

#include <array>

#include "exitance/run/atomic_file.h"
#include "exitance/scene/formats/source_text.h"

namespace exitance {

namespace {

constexpr std::array formats{
    FormFactorFormat{"csv", ".csv", "plain rows of F", write_csv},
    FormFactorFormat{"mtx", ".mtx", "Matrix Market, sparse", write_matrix_market},
    FormFactorFormat{"npz", ".npz", "SciPy sparse matrix with areas and names", write_npz},
    FormFactorFormat{"vf", ".vf", "View3D", write_view3d},
    FormFactorFormat{"elmer", ".dat", "Elmer's ViewFactors.dat", write_elmer},
    FormFactorFormat{"openfoam", "", "OpenFOAM's F and globalFaceFaces, in a folder", nullptr},
};

}  // namespace

std::span<const FormFactorFormat> form_factor_formats() {
    return formats;
}

const FormFactorFormat& find_form_factor_format(const std::string& name,
                                                const std::filesystem::path& path) {
    std::vector<std::string> names, endings;
    for (const FormFactorFormat& format : formats) {
        if (!name.empty() && name == format.name) return format;
        if (name.empty() && *format.ending && lower_extension(path) == format.ending) return format;
        names.emplace_back(format.name);
        if (*format.ending) endings.emplace_back(format.ending);
    }
    if (!name.empty())
        throw Error(Fault::wrong_use,
                    fmt::format("--format: unknown format '{}'{}", name, suggestion(name, names)));
    throw Error(Fault::wrong_use,
                fmt::format("--output: '{}' is not allowed, expected a name that ends in {}, or "
                            "--format",
                            path.string(), fmt::join(endings, ", ")));
}

void write_form_factors(const std::filesystem::path& path, const FormFactorFormat& format,
                        const FormFactorResult& result) {
    if (format.write) {
        write_atomically(path, [&](std::ostream& out) { format.write(out, result); });
        return;
    }
    AtomicFile factors(path / "F"), faces(path / "globalFaceFaces");
    write_openfoam_factors(factors.stream(), result);
    write_openfoam_faces(faces.stream(), result);
    factors.commit();
    faces.commit();
}

}  // namespace exitance
