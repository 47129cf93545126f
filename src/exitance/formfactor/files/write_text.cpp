// SPDX-License-Identifier: Apache-2.0
// Matrices as text: CSV, Matrix Market, View3D, Elmer, OpenFOAM.
#include <fmt/format.h>

#include <cstring>

#include "exitance/formfactor/files/write_form_factors.h"

namespace exitance {

namespace {

using Entry = FormFactorMatrix::Entry;
using Row = std::span<const Entry>;

// The row with its zeros.
void spread(Row entries, std::vector<float>& dense) {
    std::fill(dense.begin(), dense.end(), 0.0f);
    for (const Entry& e : entries) dense[e.column] = e.value;
}

// Whole buffers are put out: a row of numbers at a time.
void put(std::ostream& out, fmt::memory_buffer& line) {
    out.write(line.data(), static_cast<std::streamsize>(line.size()));
    line.clear();
}

template <class Values>
void append_row(fmt::memory_buffer& line, const Values& values, const char* format,
                char separator) {
    bool first = true;
    for (const auto value : values) {
        if (!first) line.push_back(separator);
        first = false;
        fmt::format_to(std::back_inserter(line), fmt::runtime(format), value);
    }
    line.push_back('\n');
}

template <class T>
void put_bytes(std::ostream& out, const std::vector<T>& values) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(T)));
}

std::string one_line(std::string name) {
    for (char& c : name)
        if (c == '\n' || c == '\r') c = ' ';
    return name;
}

void open_foam_header(std::ostream& out, const char* kind, const char* object, std::size_t rows) {
    out << fmt::format(
        "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n"
        "    class       {};\n    location    \"constant\";\n    object      {};\n}}\n\n"
        "{}\n(\n",
        kind, object, rows);
}

}  // namespace

void write_csv(std::ostream& out, const FormFactorResult& result) {
    std::vector<float> dense(result.F.rows());
    fmt::memory_buffer line;
    result.F.for_rows([&](std::size_t, Row entries) {
        spread(entries, dense);
        append_row(line, dense, "{:.9g}", ',');
        put(out, line);
    });
}

void write_matrix_market(std::ostream& out, const FormFactorResult& result) {
    std::uint64_t count = 0;
    result.F.for_rows([&](std::size_t, Row entries) { count += entries.size(); });
    out << fmt::format("%%MatrixMarket matrix coordinate real general\n");
    out << fmt::format("% form factors; row, area [m2], emissivity, name:\n");
    for (std::size_t i = 0; i < result.surfaces.size(); ++i) {
        const ExchangeSurface& surface = result.surfaces[i];
        out << fmt::format("% {} {:.9g} {:.6g} {}\n", i + 1, surface.area, surface.emissivity,
                           one_line(surface.name));
    }
    out << fmt::format("{} {} {}\n", result.F.rows(), result.F.rows(), count);
    fmt::memory_buffer line;
    result.F.for_rows([&](std::size_t i, Row entries) {
        for (const Entry& e : entries)
            fmt::format_to(std::back_inserter(line), "{} {} {:.9g}\n", i + 1, e.column + 1,
                           e.value);
        put(out, line);
    });
}

void write_view3d(std::ostream& out, const FormFactorResult& result) {
    std::string header =
        fmt::format("Exitance {} {:d} {:d} {:d} {}", result.version, result.view3d_binary,
                    result.closed, result.interchange, result.F.rows());
    header.resize(30, ' ');
    std::vector<float> areas, emissivities, dense(result.F.rows());
    for (const ExchangeSurface& surface : result.surfaces) {
        areas.push_back(static_cast<float>(surface.area));
        emissivities.push_back(static_cast<float>(surface.emissivity));
    }
    if (result.view3d_binary) {
        out << header << "\r\n";
        put_bytes(out, areas);
        result.F.for_rows([&](std::size_t, Row entries) {
            spread(entries, dense);
            put_bytes(out, dense);
        });
        put_bytes(out, emissivities);
        return;
    }
    fmt::memory_buffer line;
    out << header << '\n';
    append_row(line, areas, "{:g}", ' ');
    put(out, line);
    result.F.for_rows([&](std::size_t, Row entries) {
        spread(entries, dense);
        append_row(line, dense, "{:.6f}", ' ');
        put(out, line);
    });
    append_row(line, emissivities, "{:.3f}", ' ');
    put(out, line);
}

void write_elmer(std::ostream& out, const FormFactorResult& result) {
    fmt::memory_buffer line;
    result.F.for_rows([&](std::size_t i, Row entries) {
        fmt::format_to(std::back_inserter(line), "{}\n", entries.size());
        for (const Entry& e : entries)
            fmt::format_to(std::back_inserter(line), "{} {} {:.9g}\n", i + 1, e.column + 1,
                           e.value);
        put(out, line);
    });
}

void write_openfoam_factors(std::ostream& out, const FormFactorResult& result) {
    open_foam_header(out, "scalarListList", "F", result.F.rows());
    fmt::memory_buffer line;
    result.F.for_rows([&](std::size_t, Row entries) {
        fmt::format_to(std::back_inserter(line), "{}(", entries.size());
        for (std::size_t k = 0; k < entries.size(); ++k)
            fmt::format_to(std::back_inserter(line), "{}{:.9g}", k ? " " : "", entries[k].value);
        fmt::format_to(std::back_inserter(line), ")\n");
        put(out, line);
    });
    out << ")\n";
}

void write_openfoam_faces(std::ostream& out, const FormFactorResult& result) {
    open_foam_header(out, "labelListList", "globalFaceFaces", result.F.rows());
    fmt::memory_buffer line;
    result.F.for_rows([&](std::size_t, Row entries) {
        fmt::format_to(std::back_inserter(line), "{}(", entries.size());
        for (std::size_t k = 0; k < entries.size(); ++k)
            fmt::format_to(std::back_inserter(line), "{}{}", k ? " " : "", entries[k].column);
        fmt::format_to(std::back_inserter(line), ")\n");
        put(out, line);
    });
    out << ")\n";
}

}  // namespace exitance
