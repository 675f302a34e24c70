#!/usr/bin/env python3
"""Only common/json/ parses and prints JSON with the library.

Its functions limit how deeply texts nest, and the memory and time for their trees, and print any
bytes. Tests may call the library.
"""

import re
import sys

import cpp_source

FOLDER = "common/json"

_LIBRARY = re.compile(r"\bnlohmann\b")
_ALIAS = re.compile(r"\busing\s+(\w+)\s*=\s*nlohmann::")
_TYPE = r"(?:nlohmann::\w+|\w*[jJ]son|{aliases})"
_CALLS = r"""\b{type}\s*(?:<[^;{{}}()]*>)?::\s*(?:parse|accept|sax_parse|from_\w+)\b
           | (?:\.|->)\s*(?:dump|parse)\s*\(
           | \bnlohmann::detail\b
           | (?:>>|<<)\s*(?:std::setw\([^)]*\)\s*<<\s*)?\w*[jJ]son\b\s*(?:;|<<)
           | "_json\b"""


def calls_of(code):
    aliases = "|".join(sorted(set(_ALIAS.findall(code)))) or "json"
    pattern = _CALLS.format(type=_TYPE.format(aliases=aliases))
    return re.finditer(pattern, code, re.VERBOSE)


def check(root):
    complaints, num_files = [], 0
    for path in cpp_source.files(root, cpp_source.LAYERS):
        text = cpp_source.read(path)
        name = path.relative_to(root).as_posix()
        if cpp_source.is_test(path) or not (_LIBRARY.search(text) or "GltfJson" in text
                                            or "common/json/json.h" in text):
            continue
        num_files += 1
        if name.startswith(FOLDER + "/"):
            continue
        for match in calls_of(cpp_source.code_only(text)):
            line = cpp_source.line_of(text, match.start())
            complaints.append(f"{name}:{line}: {match.group().strip()}: only {FOLDER}/json.h "
                              "parses and prints JSON (read_json, json_text)")
    if num_files == 0:
        complaints.append("no source uses JSON")
    return complaints, f"{num_files} files with JSON leave parsing and printing to {FOLDER}/"


if __name__ == "__main__":
    sys.exit(cpp_source.run("json", __doc__, check))
