#!/usr/bin/env python3
"""What is compiled for browsers needs nothing that the library of Emscripten lacks: Debian's has
no algorithms of ranges. scripts/player, which would fail, is no part of scripts/test.

Tests, writers of mesh files, programs, and what only programs link may use them.
"""

import re
import sys

import cpp_source

# Folders that decoder/web/wasm links, with all folders in them except NOT_FOR_WEB.
FOLDERS = ("common", "decoder")
NOT_FOR_WEB = ("common/c_api", "common/cli", "common/files", "common/json", "common/testing",
               "decoder/c_api", "decoder/codec/extract", "decoder/fuzz", "decoder/meshes",
               "decoder/programs", "decoder/report", "decoder/testing", "decoder/verify")
_LACKING = re.compile(r"\bstd::(?:ranges|views)::\w+|<(?:ranges|format)>")


def covered(root):
    paths = []
    for path in cpp_source.files(root, FOLDERS):
        folder = path.parent.relative_to(root).as_posix()
        if not cpp_source.is_test(path) and not any(
                folder == other or folder.startswith(other + "/") for other in NOT_FOR_WEB):
            paths.append(path)
    return paths


def check(root):
    complaints = [f"{folder}/ has no sources"
                  for folder in NOT_FOR_WEB if not cpp_source.files(root, (folder,))]
    paths = covered(root)
    if not paths:
        complaints.append("no source is compiled for browsers")
    for path in paths:
        text = cpp_source.read(path)
        for match in _LACKING.finditer(cpp_source.code_only(text)):
            line = cpp_source.line_of(text, match.start())
            complaints.append(f"{path.relative_to(root)}:{line}: {match.group()} is not in the "
                              "library of Emscripten")
    return complaints, f"{len(paths)} files can be compiled for browsers"


if __name__ == "__main__":
    sys.exit(cpp_source.run("web", __doc__, check))
