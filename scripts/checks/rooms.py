"""Includes allowed between folders: the source layout of CONTRIBUTING.md, as a table.

A room is a folder. It may include its own files, files of the folders named (not of folders in
them), and single files; other libraries only where LIBRARIES says so.
"""

import pathlib
import re

# Kinds of GOF: a folder of each side has these names.
_KINDS = sorted(path.name for path in (
    pathlib.Path(__file__).parents[2] / "common" / "codec" / "kinds").glob("*") if path.is_dir())


def _of_kinds(folder):
    return {folder.format(kind) for kind in _KINDS}


_KIND = "common/codec/kinds/{}"
_BITS = {"common", "common/memory", "common/codec/bits"}
_MESH = _BITS | {"common/codec/mesh"}
_SHAPE = _MESH | {"common/codec/components", "common/codec/rest"}
_GOFS = _SHAPE | {"common/codec/syntax"} | _of_kinds(_KIND)
_RECON = {"common/codec/kernels", "common/codec/mesh_prediction", "common/parallel"}
_RECON |= _of_kinds(_KIND + "/recon")
_KIND_DECODER = _GOFS | _RECON | {"common/codec/kinds", "decoder/codec/parse",
                                  "decoder/codec/recon", "decoder/codec/slice_cut.h",
                                  "decoder/codec/summary"}
_ATTRIBUTES = {"common/codec/attributes", "common/codec/attributes/recon"}
_DECODER_KIND = "decoder/codec/kinds/{}"
_DECODER_KINDS = _of_kinds(_DECODER_KIND)
_PARSE_KINDS = _of_kinds(_DECODER_KIND + "/parse")
_PARSE = {"decoder/codec/parse", "decoder/codec/parse/sequence"} | _PARSE_KINDS
_PUBLIC_DECODER = {"decoder"}
_CHOICES = {"encoder/codec", "encoder/meshes/frame_source.h", "encoder/meshes/source_rig.h"}
_ENCODER = _GOFS | _RECON | _CHOICES | {"encoder/codec/math", "encoder/codec/rest",
                                        "encoder/codec/spans", "encoder/codec/write"}
_ENCODER_KINDS = _of_kinds("encoder/codec/kinds/{}")
_SKINNED = "encoder/codec/kinds/skinned"
_QUANTISE = {_SKINNED + "/fit", _SKINNED + "/tracks"}
_RECOVER = _SKINNED + "/recover"
_SKINNED_ROOMS = _QUANTISE | {
    _RECOVER, _SKINNED + "/quantise", _SKINNED + "/search", _SKINNED + "/reuse"}
# Readers and writers of mesh files know these, and nothing of coding.
_MESH_FILES = {"common", "common/memory", "common/codec/attributes/attribute_names.h",
               "common/codec/bits/fixed_point.h", "common/codec/mesh", "common/files",
               "common/json"}
_READERS = "encoder/meshes"
# Formats of mesh files: the folders that define one.
_FORMATS = {
    f"{_READERS}/{path.parent.name}"
    for path in (pathlib.Path(__file__).parents[2] / _READERS).glob("*/*.cpp")
    if re.search(r"^const InputFormat \w+\{", path.read_text(encoding="utf-8"), re.MULTILINE)}

ROOMS = {
    "common": set(),
    # Memory of callers, for containers of the decoder.
    "common/memory": {"common"},
    "common/parallel": {"common/memory"},

    # Integers only, shared by readers and writers of streams.
    "common/codec/bits": {"common", "common/memory"},
    "common/codec/mesh": _BITS,
    "common/codec/components": _BITS,
    # Positions in an order of their own (8.18): rest positions, first frames.
    "common/codec/rest": _MESH,
    "common/codec/syntax": _MESH,
    # Shared by the kinds of GOF: an access unit holds one of any.
    "common/codec/kinds": _GOFS,
    **dict.fromkeys(_of_kinds(_KIND), _SHAPE | {"common/codec/syntax"}),
    **dict.fromkeys(_of_kinds(_KIND + "/recon"), _GOFS | _RECON),
    "common/codec/kernels": _BITS | {"common/codec/components"},
    "common/codec/mesh_prediction": _SHAPE | {"common/codec/kernels", "common/parallel"},
    # Texture coordinates, normals and the like (Annex F).
    "common/codec/attributes": _MESH,
    "common/codec/attributes/recon": _MESH | {"common/codec/attributes"},

    # Rotations of the surface of a frame, which players show and encoders expect; floats (F.8.5).
    "common/surface": {"common", "common/memory", "common/codec/mesh"},
    # Files and terminals, for programs and for readers and writers of files; floats (7.3).
    "common/files": _MESH,
    # All reading and writing of JSON.
    "common/json": {"common", "common/memory"},
    # Command lines of programs.
    "common/cli": {"common/files"},
    # Interface for verification by encoders: declared here, implemented by decoder/verify and
    # conformance/rlpcval, joined when programs are linked, so that neither side includes the
    # other.
    "common/verify": {"common"},
    "common/c_api": {"common", "common/memory"},
    "common/testing": _GOFS,

    # Settings of callers.
    "decoder/codec": _BITS | {"common/codec/syntax"},
    # Bits to structures; no reconstruction, no files.
    "decoder/codec/parse": _GOFS | {"common/codec/kinds", "decoder/codec/slice_cut.h"},
    "decoder/codec/parse/sequence": _GOFS | {"decoder/codec/parse"},
    "decoder/codec/parse/attributes": _MESH | {"common/codec/attributes", "decoder/codec/parse"},
    **dict.fromkeys(_PARSE_KINDS, _GOFS | {"common/codec/kinds", "decoder/codec/parse",
                                           "decoder/codec/slice_cut.h"}),
    # Structures to positions: the interface, and what GOFs share.
    "decoder/codec/recon": _GOFS | _RECON,
    # What programs show of GOFs, whatever their kind.
    "decoder/codec/summary": _GOFS | {"common/codec/kinds", "decoder/codec/slice_cut.h"},
    # How each kind is decoded, and the table of them.
    **{kind: _KIND_DECODER | {kind + "/parse"} for kind in _DECODER_KINDS},
    "decoder/codec/kinds": _GOFS | _DECODER_KINDS | {"common/codec/kinds"},
    # Units to access units. The table of kinds is open to it; it calls their parsers alone.
    "decoder/codec/units": _GOFS | _PARSE | {
        "common/codec/kinds", "decoder/codec", "decoder/codec/kinds",
        "decoder/codec/kinds/skinned/rig_figures.h", "decoder/codec/summary"},
    # Access units to frames. Parses, too, where frames are decoded before the end of their GOF.
    "decoder/codec/gofs": _GOFS | _RECON | {
        "common/codec/kinds", "decoder/codec", "decoder/codec/kinds",
        "decoder/codec/kinds/inter/parse", "decoder/codec/parse", "decoder/codec/recon",
        "decoder/codec/units"},
    "decoder": _GOFS | _ATTRIBUTES | {
        "common/files", "common/parallel", "decoder/codec", "decoder/codec/gofs",
        "decoder/codec/parse/attributes", "decoder/codec/parse/sequence/parse_asset.h",
        "decoder/codec/units"},
    "decoder/codec/extract": _GOFS | _PARSE | _PUBLIC_DECODER | {
        "common/codec/kinds", "common/json", "decoder/codec", "decoder/codec/gofs",
        "decoder/codec/parse/attributes", "decoder/codec/recon", "decoder/codec/summary",
        "decoder/codec/units"},
    "decoder/verify": {"common/verify", "decoder/codec/units"} | _PUBLIC_DECODER,
    # Attributes and vertices as programs draw them.
    "decoder/surface": _ATTRIBUTES | {"common", "common/memory", "common/codec/mesh",
                                      "common/surface"},
    # Writers of mesh files.
    "decoder/meshes": _MESH_FILES | {"common/codec/attributes", "decoder/surface"},
    # A skin is made from all frames at once, on several threads.
    "decoder/meshes/gltf": _MESH_FILES | {"common/codec/attributes", "common/parallel",
                                          "decoder/meshes", "decoder/surface"},
    "decoder/report": _GOFS | _PUBLIC_DECODER | {
        "common/codec/kinds", "common/json", "decoder/codec/kinds", "decoder/codec/summary",
        "decoder/codec/units", "decoder/meshes"},
    "decoder/c_api": _PUBLIC_DECODER | {
        "common/c_api", "common/codec/mesh", "common/files/clip_time.h",
        "common/files/float_position.h", "common/memory", "decoder/surface"},
    # The decoder for JavaScript.
    "decoder/web/wasm": _PUBLIC_DECODER | {
        "common", "common/codec/attributes", "common/codec/bits", "common/codec/mesh",
        "common/files", "common/memory", "decoder/codec/gofs/prefetch.h", "decoder/codec/units",
        "decoder/surface"},
    # The page that rlpcdec puts streams in.
    "decoder/web/player": _PUBLIC_DECODER | {"common/files", "common/json", "decoder/codec/units",
                                             "decoder/meshes"},
    "decoder/programs": _PUBLIC_DECODER | {"common", "common/cli", "common/files",
                                           "decoder/codec/units"},
    "decoder/programs/rlpcdec": _PUBLIC_DECODER | {
        "common", "common/cli", "common/codec/mesh", "common/codec/syntax", "common/files",
        "common/json", "decoder/meshes", "decoder/programs", "decoder/web/player"},
    "decoder/programs/rlpcinfo": _PUBLIC_DECODER | {
        "common", "common/cli", "common/codec/mesh", "common/codec/syntax", "common/files",
        "common/json", "decoder/codec/extract", "decoder/codec/units", "decoder/programs",
        "decoder/report"},
    "decoder/testing": _GOFS | _PARSE | {"common/codec/kinds", "common/testing"},
    "decoder/fuzz": _GOFS | _RECON | _PARSE | _PUBLIC_DECODER | {
        "common/codec/kinds", "common/testing", "decoder/codec/units"},

    # Floating point, decisions, structures to bits.
    "encoder": {"common/codec/mesh", "encoder/codec", "encoder/codec/sequence", "encoder/meshes",
                "encoder/meshes/open"},
    # Settings of callers, and reports to them.
    "encoder/codec": {"common/codec/kinds/inter", "common/codec/kinds/skinned",
                      "common/codec/mesh", "common/codec/syntax", "encoder/codec/attributes",
                      "encoder/codec/metrics", "encoder/meshes"},
    "encoder/codec/math": {"common/parallel"},
    "encoder/codec/metrics": {"common/codec/mesh", "encoder/codec/math"},
    "encoder/codec/write": _GOFS | {"common/codec/attributes", "common/codec/kinds",
                                    "encoder/codec/math/det_math.h"},
    "encoder/codec/attributes": _MESH | _ATTRIBUTES | {
        "common/parallel", "common/surface", "encoder/codec/math", "encoder/codec/write",
        "encoder/meshes/source_attribute.h"},
    "encoder/codec/spans": _ENCODER,
    # Parts of a mesh, whatever they are for.
    "encoder/codec/partition": _CHOICES | {"common/codec/mesh", "common/parallel",
                                           "encoder/codec/math", "encoder/codec/spans"},
    "encoder/codec/rest": _ENCODER,
    **dict.fromkeys(_ENCODER_KINDS, _ENCODER | {"encoder/codec/partition"}),
    _SKINNED: _ENCODER | _SKINNED_ROOMS,
    **dict.fromkeys(_QUANTISE, _ENCODER),
    _SKINNED + "/quantise": _ENCODER | _QUANTISE,
    _RECOVER: _ENCODER | {_SKINNED + "/fit"},
    _SKINNED + "/search": _ENCODER | _QUANTISE | {_RECOVER, _SKINNED + "/quantise"},
    _SKINNED + "/reuse": _ENCODER | _SKINNED_ROOMS - {_SKINNED + "/reuse"},
    "encoder/codec/sequence/choices": _ENCODER | _ENCODER_KINDS | {"encoder/meshes"},
    "encoder/codec/sequence/target": _ENCODER | {"encoder/codec/metrics", "encoder/meshes"},
    "encoder/codec/sequence": _ENCODER | _ENCODER_KINDS | {
        "common/codec/attributes/attribute_set.h", "common/files", "common/verify",
        "encoder/codec/attributes", "encoder/codec/metrics", "encoder/codec/sequence/choices",
        "encoder/codec/sequence/target", "encoder/meshes"},
    "encoder/c_api": {"common/c_api", "encoder", "encoder/codec/kind_choices.h"},
    # Readers of mesh files: the interface, and what formats share.
    "encoder/meshes": _MESH_FILES | {"common/codec/attributes/attribute_set.h",
                                     "encoder/codec/math/det_math.h",
                                     "encoder/meshes/polygons"},
    # The order of frames, by the names of their files.
    "encoder/meshes/names": {"common/files", "encoder/meshes"},
    # Polygons as triangles.
    "encoder/meshes/polygons": {"common/codec/mesh", "common/files"},
    # Families of formats.
    "encoder/meshes/materials": _MESH_FILES | {"encoder/meshes"},
    **dict.fromkeys(_FORMATS, _MESH_FILES | {"encoder/meshes"}),
    "encoder/meshes/rlpd": _MESH_FILES | {"encoder/codec/math/det_math.h", "encoder/meshes"},
    "encoder/meshes/point_cache": _MESH_FILES | {"encoder/meshes", "encoder/meshes/materials"},
    "encoder/meshes/sequence": _MESH_FILES | {"encoder/meshes", "encoder/meshes/materials",
                                              "encoder/meshes/names"},
    "encoder/meshes/gltf/document": _MESH_FILES | {"encoder/meshes"},
    "encoder/meshes/gltf": _MESH_FILES | {"common/codec/syntax/sequence_header.h",
                                          "encoder/codec/math/det_math.h", "encoder/meshes",
                                          "encoder/meshes/gltf/document"},
    # All of them, by name or contents.
    "encoder/meshes/open": _MESH_FILES | _FORMATS | {
        "common/codec/attributes/attribute_set.h", "common/codec/syntax/stream_format.h",
        "encoder/meshes", "encoder/meshes/names", "encoder/meshes/sequence"},
    "encoder/meshes/fuzz": _FORMATS | {"common/testing", "encoder/meshes",
                                       "encoder/meshes/gltf/document"},
    "encoder/programs": {"common/cli"},
    "encoder/programs/rlpcenc": {
        "common/cli", "common/codec/attributes/attribute_names.h", "common/codec/syntax",
        "common/files", "common/json", "encoder", "encoder/codec/kind_choices.h",
        "encoder/codec/kinds/inter", "encoder/codec/metrics",
        "encoder/codec/sequence", "encoder/codec/sequence/target",
        "encoder/codec/stage_clock.h", "encoder/meshes", "encoder/meshes/open",
        "encoder/programs"},
    "encoder/testing": _ENCODER | _QUANTISE | _MESH_FILES | {
        "common/testing", "encoder/codec/kinds/skinned", "encoder/codec/partition",
        "encoder/meshes", "encoder/meshes/gltf", "encoder/meshes/open"},
}
# Files that a room must not include although their folder is open to it: vertex layers are made
# with the connectivity (8.9), not while a GOF is parsed.
CLOSED = {room: {"common/codec/mesh/vertex_layers.h"} for room in _PARSE}
# A room must not call by name the functions that headers of these folders and files declare,
# whichever header makes them visible.
NOT_CALLED = {room: (*sorted(_of_kinds(_KIND + "/recon")), "common/codec/mesh_prediction",
                     "common/codec/kernels", "decoder/codec/gofs", "decoder/codec/recon",
                     "common/codec/mesh/vertex_layers.h", "common/files")
              for room in _PARSE | {"decoder/codec/units"}}
NOT_CALLED["decoder/codec/gofs"] = ("common/files",)
# May include both sides; nothing includes it.
BOTH_SIDES = "conformance"

# Layers that neither throw nor catch, except the C interface, programs, and threads.
NEITHER_THROW_NOR_CATCH = {"common", "decoder"}
MAY_CATCH = {"common/c_api", "common/files", "common/parallel", "common/cli", "decoder/c_api",
             "decoder/programs", "decoder/programs/rlpcdec", "decoder/programs/rlpcinfo",
             "decoder/codec/gofs/async.cpp", "common/memory/owned.cpp"}

# Folders without floating point, with all folders in them except FILES and SURFACE.
INTEGER_FOLDERS = ("common", "decoder/codec")
FILES = "common/files"
SURFACE = "common/surface"

_TOOLS = {"CLI", "nlohmann", "zlib.h", "sys"}
_PEERS = {"draco", "meshoptimizer.h", "zfp.h"}  # other codecs, for comparisons
# Other libraries that a folder and those in it may use, by the first part of an include's path.
LIBRARIES = {
    "common": {"zlib.h", "immintrin.h", "wasm_simd128.h"},
    FILES: {"sys"},
    "common/json": {"nlohmann"},
    "common/cli": {"CLI"},
    "decoder": _TOOLS,
    "decoder/meshes/gltf": {"Eigen", "nlohmann"},
    "encoder": _TOOLS | {"Eigen"},
    "conformance": _TOOLS | _PEERS | {"Eigen"},
}
TEST_LIBRARIES = {"gtest", "gmock", "benchmark"}


def layer_of(folder):
    return folder.split("/")[0]


def libraries_within(layer):
    """Rooms of all folders of the layer."""
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
