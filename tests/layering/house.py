# SPDX-License-Identifier: Apache-2.0
"""The rules of the house that can be read off the files. Every rule returns its offences as lines
"file:line: what"; an empty list means that the tree at `root` keeps the rule."""
import re
import subprocess
from pathlib import Path

SOURCES = {".h", ".cpp"}
SCRIPTS = {".py", ".sh", ".cmake", ".mjs", ".js", ".ts"}
MAX_FILES_OF_RUN = 8
MAX_LINES_OF_PIPELINE = 40
HEAVY = re.compile(r"(CLI/|assimp/|toml\+\+/|tiny_gltf\.h|nlohmann/json\.hpp|OpenEXR/|gtest/|rapidcheck)")
VAGUE = {"util", "utils", "misc", "common", "helpers"}
PRINTS = re.compile(
    r"\b(?:v?f?printf|fputs|puts|putchar|perror|fmt::print|std::print|"
    r"exit|_exit|_Exit|quick_exit|abort|std::terminate)\s*\(|"
    r"\bstd::(?:cout|cerr|clog)\b|\b(?:stdout|stderr)\b")
# Runs what may crash in a child process, which has to end without returning.
ENDS_ITS_CHILD = Path("src/exitance/scene/formats/contained_call.cpp")
# Written in two halves, so that this file does not name them itself.
REGISTRIES = re.compile("|".join(re.escape(a + b) for a, b in [
    ("registry.npm", "js.org"), ("npm", "js.com"), ("py", "pi.org"), ("pythonhosted", ".org"),
    ("deb.debian", ".org"), ("crates", ".io"), ("proxy.golang", ".org"), ("ghcr", ".io"),
    ("registry.yarn", "pkg.com"), ("npm.pkg.", "github.com"), ("docker", ".io/")]))


def files(root):
    """What git tracks or would track, relative to root."""
    listed = subprocess.run(
        ["git", "-C", root, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        check=True, capture_output=True, text=True).stdout
    return [Path(name) for name in sorted(set(listed.split("\0"))) if name
            and (Path(root) / name).is_file()]


def lines(root, path):
    text = (Path(root) / path).read_text(encoding="utf-8", errors="replace")
    return list(enumerate(text.splitlines(), start=1))


def code_lines(root, path):
    """The lines of a C++ file without comments and the contents of strings."""
    text = (Path(root) / path).read_text(encoding="utf-8", errors="replace")
    pieces = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"', re.DOTALL)

    def blank(match):
        quotes = '""' if match.group(0)[0] in 'R"' else " "
        return quotes + "\n" * match.group(0).count("\n")

    return list(enumerate(pieces.sub(blank, text).splitlines(), start=1))


def stage_order(root):
    cmake = (Path(root) / "src/exitance/CMakeLists.txt").read_text(encoding="utf-8")
    return re.findall(r"^exitance_stage\((\w+)", cmake, re.MULTILINE)


def stage_of(path):
    """"scene" for src/exitance/scene/formats/gltf.cpp; None outside the stages."""
    parts = path.parts
    return parts[2] if parts[:2] == ("src", "exitance") and len(parts) > 3 else None


def library(root):
    return [p for p in files(root) if p.parts[0] == "src" and p.suffix in SOURCES]


def includes_to_the_right(root):
    """A stage includes itself and stages to its left; run/ includes no stage but math."""
    order = stage_order(root)
    offences = []
    for path in library(root):
        stage = stage_of(path)
        if stage is None:
            continue
        if stage not in order:
            offences.append(f"{path}:1: folder '{stage}' is no stage of src/exitance/CMakeLists.txt")
            continue
        allowed = {"math", "run"} if stage == "run" else set(order[:order.index(stage) + 1])
        for number, line in lines(root, path):
            quoted = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
            if not quoted:
                continue
            parts = Path(quoted.group(1)).parts
            if parts[0] != "exitance" or ".." in parts:
                offences.append(f"{path}:{number}: write the path from src/: {line.strip()}")
            elif len(parts) < 3 or parts[1] not in allowed:
                offences.append(f"{path}:{number}: {stage} may not include {quoted.group(1)}")
    return offences


def heavy_headers(root):
    """A header that is slow to compile is included by .cpp files, or by a header that only .cpp
    files of its own folder include."""
    sources = [p for p in files(root) if p.suffix in SOURCES and p.parts[0] in ("src", "apps")]
    users = {}
    for path in sources:
        for _, line in lines(root, path):
            quoted = re.match(r'\s*#\s*include\s*"([^"]+)"', line)
            if quoted:
                users.setdefault(Path(quoted.group(1)).name, []).append(path)

    def is_private(header):
        return all(user.suffix == ".cpp" and user.parent == header.parent
                   for user in users.get(header.name, []))

    return [f"{path}:{number}: {line.strip()}" for path in sources if path.suffix == ".h"
            for number, line in lines(root, path)
            if re.match(r"\s*#\s*include", line) and HEAVY.search(line) and not is_private(path)]


def crowded_run(root):
    run = [p for p in library(root) if stage_of(p) == "run"]
    return [] if len(run) <= MAX_FILES_OF_RUN else [
        f"src/exitance/run: {len(run)} files, at most {MAX_FILES_OF_RUN}"]


def printing_library(root):
    """The library returns or throws; only apps/ print or exit."""
    return [f"{path}:{number}: {line.strip()}" for path in library(root)
            for number, line in code_lines(root, path) if PRINTS.search(line)
            and not (path == ENDS_ITS_CHILD and line.strip() == "::_exit(sent ? 0 : 1);")]


def long_pipeline(root):
    """The function that names the stages in order fits a screen."""
    path = Path("src/exitance/pipeline.cpp")
    text = lines(root, path)
    starts = [number for number, line in text if re.match(r"Solution light\(", line)]
    if len(starts) != 1:
        return [f"{path}: expected one function 'Solution light(…)', found {len(starts)}"]
    end = next(number for number, line in text if number > starts[0] and line == "}")
    length = end - starts[0] + 1
    return [] if length < MAX_LINES_OF_PIPELINE else [
        f"{path}:{starts[0]}: light() has {length} lines, fewer than {MAX_LINES_OF_PIPELINE} wanted"]


def licence_lines(root):
    """Every source file says its licence in its first lines."""
    offences = []
    for path in files(root):
        first = [line for _, line in lines(root, path)[:3]]
        source = (path.suffix in SOURCES | SCRIPTS or path.name in ("CMakeLists.txt", "Makefile")
                  or (first and first[0].startswith("#!")))
        if source and not any("SPDX-License-Identifier: Apache-2.0" in line for line in first):
            offences.append(f"{path}:1: no SPDX line")
    return offences


def registry_names(root):
    """No file says where packages are fetched from: that is the machine's affair."""
    offences = []
    for path in files(root):
        for number, line in lines(root, path):
            if REGISTRIES.search(line):
                offences.append(f"{path}:{number}: {line.strip()[:80]}")
            elif path.name == "package-lock.json" and '"resolved"' in line:
                offences.append(f"{path}:{number}: a lock file without 'resolved', please")
    return offences


def vague_names(root):
    return [f"{path}: name the concept" for path in files(root)
            if VAGUE & {Path(part).stem for part in path.parts}]


RULES = [includes_to_the_right, heavy_headers, crowded_run, printing_library, long_pipeline,
         licence_lines, registry_names, vague_names]
