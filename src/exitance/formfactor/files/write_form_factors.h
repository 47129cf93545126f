// SPDX-License-Identifier: Apache-2.0
// Files that other programs read form factors from.
#pragma once

#include <filesystem>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "exitance/formfactor/enclosure.h"
#include "exitance/formfactor/form_factor_matrix.h"

namespace exitance {

/// What is written: the matrix and what its rows stand for.
struct FormFactorResult {
    const FormFactorMatrix& F;
    std::span<const ExchangeSurface> surfaces;
    std::string version;         ///< of the program
    bool closed = false;         ///< the enclosure was said to be closed
    bool interchange = false;    ///< F are total interchange factors (script-F)
    bool view3d_binary = false;  ///< .vf in View3D's binary form
};

/// One line per row, n numbers with nine digits, separated by commas.
void write_csv(std::ostream& out, const FormFactorResult& result);
/// Matrix Market, coordinate real general; areas, emissivities and names are comments.
void write_matrix_market(std::ostream& out, const FormFactorResult& result);
/// View3D 3.x: a header of 31 characters, areas, rows with six decimals, emissivities. Binary: the
/// same in 32 bytes and floats.
void write_view3d(std::ostream& out, const FormFactorResult& result);
/// Elmer's ViewFactors.dat: for each row its number of entries, then "row column F".
void write_elmer(std::ostream& out, const FormFactorResult& result);
/// OpenFOAM's F (scalarListList) and globalFaceFaces (labelListList), columns from 0.
void write_openfoam_factors(std::ostream& out, const FormFactorResult& result);
void write_openfoam_faces(std::ostream& out, const FormFactorResult& result);
/// NumPy's .npz as scipy.sparse.save_npz writes a CSR matrix, with areas, emissivities and names
/// beside it. `out` must allow to go back (a regular file).
void write_npz(std::ostream& out, const FormFactorResult& result);

struct FormFactorFormat {
    const char* name;    ///< as --format takes it
    const char* ending;  ///< ".csv"; "" = a folder
    const char* what;    ///< one line
    void (*write)(std::ostream&, const FormFactorResult&);
};

std::span<const FormFactorFormat> form_factor_formats();

/// By name, or by the ending of `path` where the name is empty. Throws Error(wrong_use).
const FormFactorFormat& find_form_factor_format(const std::string& name,
                                                const std::filesystem::path& path);

/// Writes `path`, or F and globalFaceFaces in the folder `path`, each whole or not at all. Throws
/// Error(could_not_finish).
void write_form_factors(const std::filesystem::path& path, const FormFactorFormat& format,
                        const FormFactorResult& result);

}  // namespace exitance
