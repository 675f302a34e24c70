#!/usr/bin/env python3
"""Names of attribute sets are literals in one place of each language.

* The names of HEADER are those of Table F-1, "uv" for "uv0", "uv1" and so on.
* No other C++ source of a side, except tests, has such a literal, unless OTHERS lists it.
* No JavaScript but MODULE has one as the name of a set.
"""

import re
import sys

import cpp_source

HEADER = "common/codec/attributes/attribute_names.h"
MODULE = "decoder/web/package/src/sets.js"
LAYERS = ("common", "decoder", "encoder")
# Literals that mean something else: members of glTF, words of reports and messages.
OTHERS = {"decoder/meshes/gltf/glb_mesh.cpp": {"material"},
          "decoder/programs/rlpcinfo/rlpcinfo_report.cpp": {"part"},
          "encoder/meshes/gltf/document/document.cpp": {"material"},
          "encoder/meshes/materials/mtl_reader.cpp": {"material"},
          "encoder/meshes/obj/obj_reader.cpp": {"normal"}}

_CONSTANT = re.compile(r'constexpr const char\* k\w+(Name|Prefix) = "(\w+)";')
_LITERAL = re.compile(r'"(\w+)"')
_ROW = re.compile(r"\| `(\w+?)(\d*)`[^|]*\| [012, ]+ \|")


def names_of(root):
    """(names, prefixes) of the header."""
    path = root / HEADER
    found = _CONSTANT.findall(cpp_source.read(path)) if path.is_file() else []
    return ({name for kind, name in found if kind == "Name"},
            {name for kind, name in found if kind == "Prefix"})


def check_table(root, names, prefixes):
    path = root / "spec" / "annex-f-attributes.md"
    rows = _ROW.findall(cpp_source.read(path)) if path.is_file() else []
    if {name for name, _ in rows} == names | prefixes and rows:
        return []
    return [f"{HEADER}: the names differ from those of Table F-1"]


def check_sources(root, names, prefixes):
    complaints = []
    for path in cpp_source.files(root, LAYERS):
        name = path.relative_to(root).as_posix()
        if name == HEADER or cpp_source.is_test(path):
            continue
        code = cpp_source.without_comments(cpp_source.read(path))
        for match in _LITERAL.finditer(code):
            word = match.group(1)
            if word in OTHERS.get(name, ()):
                continue
            if word in names or word.rstrip("0123456789") in prefixes:
                line = cpp_source.line_of(code, match.start())
                complaints.append(f'{name}:{line}: "{word}" is a name of Table F-1: use {HEADER}')
    return complaints


def check_scripts(root, names, prefixes):
    """JavaScript has the words for other things, too: these patterns are names of sets."""
    starts = "|".join(sorted(prefixes))
    pattern = re.compile(rf'get\("(?:{"|".join(sorted(names))})"\)|"(?:{starts})\d+"|'
                         rf'`(?:{starts})\$\{{|/\^(?:{starts})|startsWith\("(?:{starts})"\)')
    complaints, count = [], 0
    for path in cpp_source.files(root, ("decoder/web",), (".js",)):
        name = path.relative_to(root).as_posix()
        if name == MODULE or "testing" in path.parts or "node_modules" in path.parts:
            continue
        count += 1
        text = cpp_source.read(path)
        for match in pattern.finditer(text):
            line = cpp_source.line_of(text, match.start())
            complaints.append(f"{name}:{line}: {match.group()} is a name of Table F-1: use "
                              f"{MODULE}")
    return complaints if count else [*complaints, "decoder/web: no JavaScript to check for names"]


def check(root):
    names, prefixes = names_of(root)
    if not names or not prefixes:
        return [f"{HEADER}: has no names"], ""
    complaints = [*check_table(root, names, prefixes), *check_sources(root, names, prefixes),
                  *check_scripts(root, names, prefixes)]
    return complaints, f"{len(names | prefixes)} names of attributes have one place"


if __name__ == "__main__":
    sys.exit(cpp_source.run("attributes", __doc__, check))
