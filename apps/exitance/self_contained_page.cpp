// SPDX-License-Identifier: Apache-2.0
#include "self_contained_page.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string>
#include <string_view>

#include "exitance/run/error.h"
#include "exitance/solution/file.h"
#include "grid_readings.h"
#include "viewer_assets.h"

namespace exitance::cli {

namespace {

constexpr std::uintmax_t most_bytes = 256u << 20;

// What nothing but the page itself may do when it is opened from disk.
constexpr const char* security_policy =
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
    "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
    "base-uri 'none'; form-action 'none'\">";

std::string_view asset(std::string_view name) {
    for (const ViewerAsset& each : viewer_assets())
        if (each.name == name) return each.content;
    throw Error(Fault::could_not_finish, "the program was built without " + std::string(name));
}

void replace(std::string& page, std::string_view what, const std::string& by) {
    const auto at = page.find(what);
    if (at == std::string::npos)
        throw Error(Fault::could_not_finish, "the page has no '" + std::string(what) + "'");
    page.replace(at, what.size(), by);
}

/// Base64 (RFC 4648, section 4).
void write_base64(std::ostream& out, std::istream& in) {
    constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<char, 3 * 4096> block;
    std::string text;
    do {
        in.read(block.data(), block.size());
        const auto got = static_cast<std::size_t>(in.gcount());
        text.clear();
        for (std::size_t i = 0; i < got; i += 3) {
            const auto byte = [&](std::size_t k) {
                return i + k < got ? static_cast<unsigned char>(block[i + k]) : 0u;
            };
            const unsigned bits = byte(0) << 16 | byte(1) << 8 | byte(2);
            text += digits[bits >> 18];
            text += digits[bits >> 12 & 63];
            text += i + 1 < got ? digits[bits >> 6 & 63] : '=';
            text += i + 2 < got ? digits[bits & 63] : '=';
        }
        out << text;
    } while (in);
}

}  // namespace

void write_self_contained_page(std::ostream& out, const std::filesystem::path& solution) {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(solution, unknown);
    if (unknown || size > most_bytes)
        throw Error(Fault::could_not_finish,
                    fmt::format("{} has {} MiB; a page of its own can hold 256: view it with the "
                                "server",
                                solution.string(), size >> 20));
    std::ifstream in(solution, std::ios::binary);
    if (!in) throw Error(Fault::could_not_finish, "cannot read " + solution.string());

    constexpr std::string_view script = R"(<script type="module" crossorigin src="./viewer.js">)";
    constexpr std::string_view style = R"(<link rel="stylesheet" crossorigin href="./viewer.css">)";
    std::string page(asset("index.html"));
    // Scripts of the head run after the body is there only as modules.
    replace(page, script, "<script type=\"module\">" + std::string(asset("viewer.js")));
    replace(page, style, "<style>" + std::string(asset("viewer.css")) + "</style>");
    replace(page, "<head>", std::string("<head>") + security_policy);
    const auto end = page.rfind("</body>");
    out << page.substr(0, end) << "<script type=\"application/octet-stream\" id=\"solution\">";
    write_base64(out, in);
    out << "</script>";
    // Numbers only: nothing that could end a script.
    out << "<script type=\"application/json\" id=\"grids\">"
        << grid_readings(read_solution(solution)) << "</script>" << page.substr(end);
}

}  // namespace exitance::cli
