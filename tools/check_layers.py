#!/usr/bin/env python3
"""Fails if a file includes what its layer must not see, or calls what the library must not call, or if two files
define a type of the same name in the same namespace: linked together they would share one destructor.

Layers (HACKING.md): a file may include from its own layer and from layers of a lower rank. Private headers in
src/LAYER are seen by that layer alone; those of src/kernel, which has no public ones, by every layer above it.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ORDER = [["core"], ["poly", "kernel"], ["basis"], ["spline"], ["make", "path", "query"],
         ["intersect", "fit", "animate", "colour"], ["trim", "region"], ["mesh"], ["model"], ["shape"],
         ["io", "gpu", "font"],
         ["paint"], ["apps", "bindings"]]
RANK = {layer: rank for rank, layers in enumerate(ORDER) for layer in layers}

# Other people's headers, and the only folders or files that may include them.
THIRD_PARTY = [
    (r".*\.hxx", ["apps/occt", "bench/compare"]),
    (r"nlohmann/.*", ["tests"]),
    (r"pugixml.hpp", ["src/io/svg.cpp"]),
    (r"CLI/.*", ["apps/cli/command_line.cpp"]),
    (r"(oneapi/)?tbb/.*", ["src/core"]),
    (r"(epoxy|EGL|GL)/.*|png\.h", ["src/gpu"]),
    (r"cairo.*\.h", ["src/paint"]),
    (r"ft2build\.h|freetype/.*", ["src/font/freetype.cpp", "tests/font"]),
    (r"hb.*\.h", ["src/font/harfbuzz.cpp"]),
    (r"fontconfig/.*", ["src/font/fontconfig.cpp"]),
    (r"iostream", ["apps", "bench"]),
]

# In the library: what depends on the locale, throws, dispatches at run time, prints or ends the process.
BANNED = [
    (r"\b(strtod|strtof|strtold|strtol|strtoll|strtoul|strtoull|atof|atoi|atol|sscanf|fscanf)\s*\(", "use std::from_chars"),
    (r"\bsto(d|f|ld|i|l|ll|ul|ull)\s*\(", "use std::from_chars"),
    (r"\b(std::)?to_string\s*\(", "use text() or std::to_chars"),
    (r"\bv?(f|s|sn)?printf\s*\(", "use text()"),
    (r"\bthrow\b", "return a Refusal"),
    (r"\bvirtual\b", "use a concept or a variant"),
    (r"\bstd::(cout|cerr|clog)\b", "the library does not print"),
    (r"\b(exit|_exit|quick_exit|abort|terminate)\s*\(", "return a Refusal"),
    (r"\bsetlocale\s*\(", "the library leaves the process alone"),
]
# The one place that may print and abort, FF_REQUIRE, and a child process that could not become the reader.
EXEMPT = {
    "include/freiform/core/result.hpp": r"std::fprintf\(stderr, \"%s:%d: REQUIRES",
    "src/io/exchange.cpp": r"::_exit\(12[67]\)",
}

STRIP = re.compile(r'//[^\n]*|/\*.*?\*/|R"([^(\s]*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'', re.S)
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)


def layer_of(path):
    """'basis' for include/freiform/basis/x.hpp and src/basis/x.cpp; None for the header that includes all."""
    parts = path.parts
    if parts[0] in ("apps", "bindings"):
        return parts[0]
    if parts[:2] == ("include", "freiform"):
        return parts[2] if len(parts) > 3 else {"shape.hpp": "shape"}.get(parts[2])
    return parts[1] if parts[0] == "src" and len(parts) > 2 else None


def may_see(layer, other):
    return layer == other or RANK[other] < RANK[layer]


def check_include(path, layer, bracket, name):
    if name.startswith("freiform/"):
        other = layer_of(pathlib.PurePosixPath("include") / name)
        if not (ROOT / "include" / name).is_file():
            return f"includes {name}, which is not there"
        if layer and (other is None or not may_see(layer, other)):
            return f"layer {layer} must not see {name}"
        return None
    if bracket == '"':
        beside = (ROOT / path).parent / name
        target = beside if beside.is_file() else ROOT / "src" / name
        if not target.is_file():
            return None
        other = layer_of(target.resolve().relative_to(ROOT))
        if layer and other != layer and not (other == "kernel" and may_see(layer, other)):
            return f"layer {layer} must not see the private header {name}"
    for pattern, folders in THIRD_PARTY:
        if re.fullmatch(pattern, name) and not any(path.is_relative_to(f) for f in folders):
            return f"{name} is for {', '.join(folders)} only"
    return None


def check(path):
    source = (ROOT / path).read_text()
    layer = layer_of(path)
    if layer and layer not in RANK:
        yield 1, f"folder {layer} is no layer"
        return
    if path.suffix == ".hpp" and not re.search(r"^#pragma once$", source, re.M):
        yield 1, "no #pragma once"
    for m in INCLUDE.finditer(source):
        problem = check_include(path, layer, m[1], m[2])
        if problem:
            yield source.count("\n", 0, m.start()) + 1, problem
    if path.parts[0] in ("src", "include"):
        exempt = EXEMPT.get(str(path))
        lines = source.split("\n")
        code = STRIP.sub(lambda m: " " + "\n" * m[0].count("\n"), source)
        for number, line in enumerate(code.split("\n"), 1):
            if exempt and re.search(exempt, lines[number - 1]):
                continue
            for pattern, instead in BANNED:
                m = re.search(pattern, line)
                if m:
                    yield number, f"`{m[0].strip()}`: {instead}"


SCOPE = re.compile(r"namespace\s+(?P<space>[\w:]+)?\s*\{|\b(?:struct|class|union|enum(?:\s+class)?)\s+(?P<type>\w+)"
                   r"(?:\s+final)?(?:\s*:(?!:)[^;{()]*)?\s*\{|[{}]")


def types_of(path):
    """The types with linkage that a file defines: (line, name with its namespace)."""
    code = STRIP.sub(lambda m: " " + "\n" * m[0].count("\n"), (ROOT / path).read_text())
    open_scopes = []  # of each brace: the namespace, or None for anything else
    for m in SCOPE.finditer(code):
        if m[0] == "}":
            if open_scopes:
                open_scopes.pop()
            continue
        if m["type"] and None not in open_scopes:
            yield code.count("\n", 0, m.start()) + 1, "::".join([*open_scopes, m["type"]])
        named = m[0].startswith("namespace") and m["space"]
        open_scopes.append(m["space"] if named else None)


def twins(files):
    first = {}
    for path in files:
        if path.parts[0] not in ("include", "src", "apps"):
            continue
        for line, name in types_of(path):
            if name in first and first[name][0] != path:
                yield f"{path}:{line}: {name} is defined in {first[name][0]}:{first[name][1]} too"
            first.setdefault(name, (path, line))


def main():
    files = [p.relative_to(ROOT) for top in ("include", "src", "apps", "bindings", "tests", "bench")
             for p in sorted((ROOT / top).rglob("*")) if p.suffix in (".hpp", ".cpp", ".inl")]
    problems = [f"{path}:{line}: {problem}" for path in files for line, problem in check(path)]
    problems += twins(files)
    print("\n".join(problems) or f"{len(files)} files: layers and calls are in order")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
