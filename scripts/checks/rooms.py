"""Which folder may include what: the source layout of CONTRIBUTING.md, as a table.

A room is a folder. It may include its own files, files of the folders named (not of folders in
them), and single files; other libraries only where LIBRARIES says so.
"""

import pathlib

# Kinds of GOF: a folder of each side has these names.
_KINDS = sorted(path.name for path in (pathlib.Path(__file__).parents[2] / "common").glob("*_gof"))


def _of_kinds(folder):
    return {folder.format(kind) for kind in _KINDS}


_BITS = {"common", "common/bitstream"}
_MESH = _BITS | {"common/mesh"}
_GOFS = _MESH | {"common/syntax", "common/components", "common/rest"} | _of_kinds("common/{}")
_RECON = {"common/kernels", "common/mesh_prediction", "common/parallel"} | _of_kinds("common/{}/recon")
_PARSE = {"decoder/parse", "decoder/parse/sequence"}
_PUBLIC_DECODER = {"decoder"}
_ENCODER = _GOFS | _RECON | {"encoder", "encoder/gof", "encoder/math", "encoder/rest",
                            "encoder/write"}
_QUANTISE = {"encoder/skinned_gof/fit", "encoder/skinned_gof/tracks"}
_SKINNED = _QUANTISE | {"encoder/skinned_gof/quantise", "encoder/skinned_gof/search",
                        "encoder/skinned_gof/reuse"}

ROOMS = {
    # Integers only, shared by readers and writers of streams.
    "common": set(),
    "common/bitstream": {"common"},
    "common/mesh": _BITS,
    "common/components": _BITS,
    # Texture coordinates, normals and the like (Annex F).
    "common/attributes": _MESH,
    "common/attributes/recon": _MESH | {"common/attributes"},
    # Positions in an order of their own (8.18): rest positions, first frames.
    "common/rest": _MESH,
    # Rotations of the surface of a frame, which players show and encoders expect; floats (F.8.5).
    "common/surface": {"common", "common/mesh"},
    "common/syntax": _GOFS,
    **dict.fromkeys(_of_kinds("common/{}"), _MESH | {"common/syntax", "common/components", "common/rest"}),
    "common/kernels": {"common", "common/components"},
    "common/parallel": {"common/owned.h"},
    "common/mesh_prediction": {"common", "common/components", "common/mesh", "common/kernels",
                               "common/parallel", "common/rest"},
    **dict.fromkeys(_of_kinds("common/{}/recon"), _GOFS | _RECON),
    # What encoders verify their streams by: declared here, implemented by decoder/verify and
    # conformance/rlpcval, joined when programs are linked, so that neither side includes the
    # other.
    "common/verify": {"common"},
    "common/c_api": {"common"},
    "common/testing": _GOFS,
    # Files and terminals, for programs and for readers and writers of files; floats (7.3).
    "common/io": {"common", "common/mesh"},
    # Command lines of programs.
    "common/tools": {"common/io"},
    # All reading and writing of JSON.
    "common/json": {"common"},
    # Bits to structures; no reconstruction, no files.
    "decoder/parse": _GOFS | {"decoder/slice_cut.h"},
    "decoder/parse/sequence": _GOFS | {"decoder/parse"},
    "decoder/parse/attributes": _MESH | {"common/attributes", "decoder/parse"},
    # Structures to positions.
    # It parses, too, where frames are decoded before their GOF has been read.
    "decoder/recon": _GOFS | _RECON | {"decoder/parse", "decoder/stream"},
    "decoder/stream": _GOFS | _PARSE | _PUBLIC_DECODER,
    "decoder": _GOFS | {"common/attributes", "common/attributes/recon", "common/io",
                        "common/parallel", "decoder/parse/attributes",
                        "decoder/parse/sequence/parse_asset.h", "decoder/stream",
                        "decoder/recon"},
    "decoder/extract": {"common/json"} | _GOFS | _PARSE | {"decoder/parse/attributes"} | {"decoder/recon", "decoder/stream"} | _PUBLIC_DECODER,
    "decoder/report": _GOFS | {"common/json", "decoder/stream", "decoder/output",
                               "common/skinned_gof/recon/model_recon.h"} | _PUBLIC_DECODER,
    # Attributes and vertices as programs draw them.
    "decoder/surface": {"common", "common/attributes", "common/attributes/recon", "common/mesh",
                        "common/surface"},
    "decoder/verify": {"common/verify", "decoder/stream"} | _PUBLIC_DECODER,
    "decoder/c_api": {"common/c_api", "common/owned.h", "common/io/clip_time.h",
                      "common/io/float_position.h",
                      "common/mesh", "decoder/surface"} | _PUBLIC_DECODER,
    # Writers of mesh files know nothing of coding.
    "decoder/output": {"common", "common/attributes", "common/io", "common/json", "common/mesh",
                       "decoder/surface"},
    # A skin is made from all frames at once, on several threads.
    "decoder/output/gltf": {"common", "common/attributes", "common/io", "common/json",
                            "common/mesh", "common/parallel",
                            "decoder/output", "decoder/surface"},
    # The decoder for JavaScript.
    "decoder/js/wasm": {"common", "common/attributes", "common/bitstream", "common/io",
                        "common/mesh", "decoder/stream", "decoder/recon/prefetch.h",
                        "decoder/surface"} | _PUBLIC_DECODER,
    "decoder/player": {"common/io", "common/json", "decoder/output", "decoder/stream", "decoder/tools"}
                      | _PUBLIC_DECODER,
    "decoder/tools": _GOFS | {"common/io", "common/json", "common/tools", "decoder/extract", "decoder/output",
                              "decoder/player",
                              "decoder/report", "decoder/stream"} | _PUBLIC_DECODER,
    "decoder/fuzz": _GOFS | _RECON | _PARSE | {"common/testing", "decoder/stream"}
                    | _PUBLIC_DECODER,
    # Floating point, decisions, structures to bits.
    "encoder": {"common/mesh", "common/frame_gof", "encoder/attributes", "common/skinned_gof", "common/syntax", "encoder/input",
                "encoder/metrics"},
    "encoder/math": {"common/parallel"},
    "encoder/metrics": {"common/mesh", "encoder/math"},
    "encoder/write": _GOFS | {"common/attributes", "encoder/math/det_math.h"},
    "encoder/attributes": _MESH | {"common/attributes", "common/attributes/recon",
                                   "common/parallel", "common/surface",
                                   "encoder/input/source_attribute.h", "encoder/math",
                                   "encoder/write"},
    "encoder/gof": _ENCODER,
    # Parts of a mesh, whatever they are for.
    "encoder/partition": {"common/mesh", "common/parallel", "encoder", "encoder/gof",
                          "encoder/math"},
    **dict.fromkeys(_of_kinds("encoder/{}"), _ENCODER | {"encoder/partition"}),
    "encoder/skinned_gof": _ENCODER | _SKINNED,
    **dict.fromkeys(("encoder/skinned_gof/fit", "encoder/skinned_gof/tracks"), _ENCODER),
    "encoder/rest": _ENCODER,
    "encoder/skinned_gof/quantise": _ENCODER | _QUANTISE,
    "encoder/skinned_gof/search": _ENCODER | _QUANTISE | {"encoder/skinned_gof/quantise"},
    "encoder/skinned_gof/reuse": _ENCODER | _SKINNED - {"encoder/skinned_gof/reuse"},
    "encoder/sequence/choices": _ENCODER | _of_kinds("encoder/{}") | {
        "encoder/input", "encoder/input/formats"},
    "encoder/sequence/target": _ENCODER | {"encoder/input", "encoder/metrics"},
    "encoder/sequence": _ENCODER | _of_kinds("encoder/{}") | {
        "encoder/sequence/choices", "encoder/sequence/target", "encoder/attributes",
        "common/attributes/attribute_set.h", "common/io", "common/verify", "encoder/input", "encoder/input/formats", "encoder/metrics"},
    "encoder/c_api": {"common/c_api", "encoder"},
    # Readers of mesh files know nothing of coding.
    "encoder/input": {"common", "common/attributes/attribute_set.h", "common/io", "common/json",
                      "common/mesh",
                      "common/syntax/stream_format.h",
                      "encoder/input/formats", "encoder/input/gltf", "encoder/input/polygons"},
    # The order of frames, by the names of their files.
    "encoder/input/names": {"common/io", "encoder/input/frame_source.h"},
    # Polygons as triangles.
    "encoder/input/polygons": {"common/io", "common/mesh", "encoder/input/mesh_reader.h"},
    "encoder/input/formats": {"common", "common/io", "common/mesh", "encoder/input",
                              "encoder/input/names", "encoder/input/polygons",
                              "encoder/math/det_math.h"},
    "encoder/input/gltf/document": {"common", "common/io", "common/json", "common/mesh", "encoder/input"},
    "encoder/input/gltf": {"common", "common/io", "common/json", "common/mesh", "common/syntax/sequence_header.h",
                           "encoder/input", "encoder/input/formats", "encoder/input/gltf/document",
                           "encoder/math/det_math.h"},
    "encoder/input/fuzz": {"common/testing", "encoder/input", "encoder/input/formats",
                           "encoder/input/gltf", "encoder/input/gltf/document"},
    "encoder/tools": {"common/io", "common/json", "common/syntax", "common/tools", "encoder", "encoder/input",
                      "encoder/metrics", "encoder/frame_gof", "encoder/sequence",
                      "encoder/sequence/target"},
}
# Files that a room must not include although their folder is open to it: vertex layers are made
# with the connectivity (8.9), not while a GOF is parsed.
CLOSED = {room: {"common/mesh/vertex_layers.h"} for room in _PARSE}
# A room must not call by name the functions that headers of these folders and files declare,
# whichever header makes them visible.
NOT_CALLED = {room: (*sorted(_of_kinds("common/{}/recon")), "common/mesh_prediction",
                     "common/kernels", "decoder/recon", "common/mesh/vertex_layers.h",
                     "common/io") for room in _PARSE}
NOT_CALLED |= {room: ("common/io",) for room in ("decoder/recon", "decoder/stream")}
# May include both sides; nothing includes it.
BOTH_SIDES = "conformance"

# Layers that neither throw nor catch, except the C interface, programs, and threads.
NEITHER_THROW_NOR_CATCH = {"common", "decoder"}
MAY_CATCH = {"common/c_api", "common/io", "common/parallel", "common/tools", "decoder/c_api",
             "decoder/tools", "decoder/recon/async.cpp"}

# Folders without floating point, with all folders in them except FILES and SURFACE.
INTEGER_FOLDERS = ("common", "decoder/parse", "decoder/recon", "decoder/stream",
                   "decoder/extract")
FILES = "common/io"
SURFACE = "common/surface"

_TOOLS = {"CLI", "nlohmann", "zlib.h", "sys"}
_PEERS = {"draco", "meshoptimizer.h", "zfp.h"}  # other codecs, for comparisons
# Other libraries that a folder and those in it may use, by the first part of an include's path.
LIBRARIES = {
    "common": {"zlib.h", "immintrin.h", "wasm_simd128.h"},
    FILES: {"sys"},
    "common/json": {"nlohmann"},
    "common/tools": {"CLI"},
    "decoder": _TOOLS,
    "decoder/output/gltf": {"Eigen", "nlohmann"},
    "encoder": _TOOLS | {"Eigen"},
    "conformance": _TOOLS | _PEERS | {"Eigen"},
}
TEST_LIBRARIES = {"gtest", "gmock", "benchmark"}


def layer_of(folder):
    return folder.split("/")[0]


def libraries_within(layer):
    """Of all folders of the layer."""
    return set().union(*(names for folder, names in LIBRARIES.items() if layer_of(folder) == layer))


def allowed(folder, included, is_test):
    """Whether a file of the folder may include `included`, a path from the top.

    A test may include all of its side: it builds what it needs to test one thing.
    """
    target = included.rpartition("/")[0]
    if included in CLOSED.get(folder, ()) and not is_test:
        return False
    if folder == BOTH_SIDES or folder.startswith(BOTH_SIDES + "/"):
        return True
    if is_test and layer_of(target) in ("common", layer_of(folder)):
        return True
    return target == folder or target in ROOMS[folder] or included in ROOMS[folder]
