#!/usr/bin/env python3
"""The layer rules: who may include, import or link whom.

common includes neither side; encoder and decoder never reach each other, nor conformance;
readers and writers of mesh files know nothing of coding; Eigen stays in the encoder; the
specification interpreter and the judge are plain Python.
"""

import argparse
import ast
import pathlib
import re
import sys

import cpp_source

# What a layer may include of ours, and of other libraries (by first part of the path).
OURS = {
    "common": {"common"},
    "decoder": {"common", "decoder"},
    "encoder": {"common", "encoder"},
    "conformance": {"common", "decoder", "encoder", "conformance"},
}
# What readers and writers of mesh files may include of their own layer: folders, and files.
FORMATS = {
    "decoder/output": {"decoder/output", "decoder/float_position.h"},
    "encoder/input": {"encoder/input", "encoder/input/formats", "encoder/input/gltf"},
    "encoder/input/formats": {"encoder/input", "encoder/input/formats"},
    "encoder/input/gltf": {"encoder/input", "encoder/input/formats", "encoder/input/gltf",
                           "encoder/math/det_math.h"},
}
TOOLS = {"CLI", "nlohmann", "zlib.h", "sys"}
PEERS = {"draco", "meshoptimizer.h", "zfp.h"}  # other codecs, to compare with
LIBRARIES = {
    "common": {"zlib.h", "immintrin.h", "wasm_simd128.h"},
    "decoder": TOOLS | {"tiny_gltf.h"},
    "encoder": TOOLS | {"tiny_gltf.h", "tiny_obj_loader.h", "Eigen"},
    "conformance": TOOLS | {"tiny_gltf.h", "tiny_obj_loader.h", "Eigen"} | PEERS,
}
TEST_LIBRARIES = {"gtest", "gmock", "benchmark"}
# common computes; it neither reads, writes nor logs.
INPUT_OUTPUT = {"cstdio", "filesystem", "fstream", "iomanip", "ios", "iostream", "istream",
                "ostream", "streambuf", "syncstream"}
PUBLIC_HEADERS = ("common/c_api/rlpc_status.h", "decoder/c_api/rlpc_decode.h", "decoder/rlpc_decoder.h",
                  "encoder/frame_encoder.h", "encoder/c_api/rlpc_encode.h", "encoder/rlpc_encoder.h")
# That headers in C include.
C_HEADERS = {"stddef.h", "stdint.h"}
# Folder: other folders whose modules it may import.
PLAIN_PYTHON = {"conformance/specdec": (), "conformance/judge": ("conformance/specdec",)}

_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include\b[ \t]*(.*)$", re.MULTILINE)


def includes(text):
    """(line, bracket, path) of every include; bracket is '"', '<', or '' for a macro."""
    for match in _INCLUDE.finditer(cpp_source.without_comments(text)):
        target = re.match(r'(["<])([^">]+)[">]', match.group(1))
        line = cpp_source.line_of(text, match.start())
        yield (line, *target.groups()) if target else (line, "", match.group(1).strip())


def check_ours(root, layer, path, included):
    first = included.split("/")[0]
    if first not in OURS or ".." in included.split("/"):
        return f'"{included}" is not spelled from the top, like "common/result.h"'
    if first not in OURS[layer]:
        return f"{layer}/ must not include {first}/ (it includes \"{included}\")"
    if not (root / included).is_file():
        return f'"{included}" does not exist'
    folder = path.parent.relative_to(root).as_posix()
    if folder in FORMATS and first != "common" and not FORMATS[folder] & {
            included, pathlib.PurePosixPath(included).parent.as_posix()}:
        return f"{folder}/ must know nothing of coding (it includes \"{included}\")"
    if path.name.startswith("parse_") and pathlib.Path(included).name.startswith("recon_"):
        return f'parsing must not know reconstruction (it includes "{included}")'
    return None


def check_library(layer, path, included):
    first = included.split("/")[0]
    if first in OURS:
        return f'<{included}> is ours: write "{included}"'
    if first in LIBRARIES[layer] or (cpp_source.is_test(path) and first in TEST_LIBRARIES):
        return None
    if "/" in included or first in set().union(TEST_LIBRARIES, *LIBRARIES.values()):
        return f"{layer}/ must not use <{included}>"
    if layer == "common" and not cpp_source.is_test(path):
        if included in INPUT_OUTPUT:
            return f"common/ does no input or output (it includes <{included}>)"
        if included.endswith(".h"):
            return f"common/ uses only the standard library (it includes <{included}>)"
    return None


def check_file(root, path):
    relative = path.relative_to(root)
    layer = relative.parts[0]
    for line, bracket, included in includes(path.read_text(encoding="utf-8")):
        if bracket == '"':
            complaint = check_ours(root, layer, path, included)
        elif bracket == "<":
            complaint = check_library(layer, path, included)
        else:
            complaint = f"an include that cannot be followed: {included}"
        if complaint:
            yield f"{relative}:{line}: {complaint}"


def check_public_header(root, header):
    """A user of the installed header has our headers and the standard library, no more."""
    queue, seen = [header], set()
    while queue:
        current = queue.pop()
        if current in seen or not (root / current).is_file():
            continue
        seen.add(current)
        for line, bracket, included in includes((root / current).read_text(encoding="utf-8")):
            if bracket == '"':
                queue.append(included)
            elif included not in C_HEADERS and ("/" in included or included.endswith(".h")):
                yield (f"{current}:{line}: the public {header} reaches <{included}>; "
                       "only the standard library may be visible there")


def check_links(root):
    """A library is not linked where it must not be included."""
    for layer in ("common", "decoder", "encoder"):
        for path in sorted((root / layer).rglob("CMakeLists.txt")):
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                code = line.split("#")[0]
                for other in re.findall(r"\brlpc(?:_|::)(decoder|encoder)\b", code):
                    if other not in OURS[layer]:
                        yield (f"{path.relative_to(root)}:{number}: "
                               f"{layer}/ must not link rlpc_{other}")
                if layer != "encoder" and "Eigen" in code:
                    yield f"{path.relative_to(root)}:{number}: {layer}/ must not use Eigen"


def check_python(root, folder, others):
    """Only the standard library, and modules beside the file's own or in other folders."""
    base = root / folder
    local = {base.name} | {path.stem for path in base.rglob("*.py")}
    local |= {path.stem for other in others for path in (root / other).rglob("*.py")}
    local |= {path.name for path in base.rglob("*") if path.is_dir()}
    for path in sorted(base.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"), str(path))):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module]
            for name in names:
                top = name.split(".")[0]
                if top not in sys.stdlib_module_names and top not in local:
                    yield (f"{path.relative_to(root)}:{node.lineno}: "
                           f"{folder} must not import {name}")


def check(root):
    paths = cpp_source.files(root, cpp_source.LAYERS)
    complaints = [c for path in paths for c in check_file(root, path)]
    for header in PUBLIC_HEADERS:
        complaints += check_public_header(root, header)
    complaints += check_links(root)
    for folder, others in PLAIN_PYTHON.items():
        complaints += check_python(root, folder, others)
    return complaints, f"{len(paths)} files keep to their layer"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=pathlib.Path, default=cpp_source.repository_root())
    return cpp_source.report("layers", *check(parser.parse_args().root))


if __name__ == "__main__":
    sys.exit(main())
