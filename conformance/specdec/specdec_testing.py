"""Shared by the tests of the specification as a decoder."""

import io
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import specdec

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = specdec.program_of(ROOT / "spec")
STREAM_HEADER_BYTES, UNIT_HEADER_BYTES, CRC_BYTES = 10, 5, 4


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


def run_stream(data, program=PROGRAM, trace=None, widths=False):
    """(exit code, rule or None, number of frames, output) of specdec."""
    output = io.BytesIO()
    decoder = specdec.Decoder(program, data, output.write, trace, widths)
    code, rule = specdec.DONE, None
    try:
        decoder.call("stream")
    except specdec.Verdict as verdict:
        code, rule = verdict.code, verdict.rule
    return code, rule, decoder.place()[1], output.getvalue()


def run_attributes(data, widths=False):
    """(exit code, rule or None, .rlpa) of specdec."""
    output = io.BytesIO()
    decoder = specdec.Decoder(PROGRAM, data, lambda frames: None, widths=widths,
                              write_attributes=output.write)
    try:
        decoder.call(specdec.WITH_ATTRIBUTES)
    except specdec.Verdict as verdict:
        return verdict.code, verdict.rule, b""
    return specdec.DONE, None, output.getvalue()


def units_of(stream):
    """(type, payload) of every unit."""
    place, units = STREAM_HEADER_BYTES, []
    while place < len(stream):
        kind, size = struct.unpack_from(">BI", stream, place)
        place += UNIT_HEADER_BYTES
        units.append((kind, stream[place:place + size]))
        place += size + CRC_BYTES
    return units


def stream_of(stream, units):
    """A stream with the header of `stream`, and these units with sizes and CRCs that fit."""
    result = stream[:STREAM_HEADER_BYTES]
    for kind, payload in units:
        unit = struct.pack(">BI", kind, len(payload)) + payload
        result += unit + struct.pack(">I", zlib.crc32(unit))
    return result


def coarse_mesh(v, layers):
    """8.9.8 for a decoder with these variables, whose connectivity has been decoded: the vertices,
    in decoded order, and the triangles of them. The variables of 8.9 are then not those of
    MakeLayers( )."""
    v["MakeLayers"]()
    rest = list(range(v["NumVertices"]))
    v["InitRest"]()
    v.update(RemovedInPass=[0] * len(rest), LockedInPass=[0] * len(rest))
    for number in range(1, v["NumLayers"] - layers + 1):
        v["NumPasses"] = number
        rest = v["RemoveLayer"](rest)
    return rest, [t for t, is_there in zip(v["RestTriangles"], v["InRest"]) if is_there]


def cut_animation(folder, name, frames):
    """The first frames of a bundled animation: (mesh, point cache)."""
    inputs = ROOT / "streams" / "inputs"
    mesh = shutil.copy(inputs / f"{name}.obj", folder)
    data = (inputs / f"{name}.pc2").read_bytes()
    points = struct.unpack_from("<i", data, 16)[0]
    cache = folder / f"{name}.pc2"
    cache.write_bytes(data[:28] + struct.pack("<i", frames) + data[32:32 + 12 * points * frames])
    return mesh, cache


def soup_animation(folder):
    """Triangles that no surface would have, some of them degenerate, and loose vertices."""
    r = random.Random(7)
    points = [[r.random() for _ in range(3)] for _ in range(40)]
    triangles = [[r.randrange(38) for _ in range(3)] for _ in range(70)]
    mesh, cache = folder / "soup.obj", folder / "soup.pc2"
    mesh.write_text("".join("v %f %f %f\n" % tuple(p) for p in points)
                    + "".join("f %d %d %d\n" % tuple(v + 1 for v in t) for t in triangles))
    frames = [[c + 0.1 * f * p[(k + 1) % 3] for p in points for k, c in enumerate(p)]
              for f in range(7)]
    header = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(points), 0.0, 1.0, len(frames))
    cache.write_bytes(header + b"".join(struct.pack(f"<{len(f)}f", *f) for f in frames))
    return mesh, cache


def encode(tools, folder, animation, *settings, profile="baseline"):
    """The stream that rlpcenc, in the folder `tools`, makes of it."""
    mesh, cache = animation
    stream = folder / "stream.rlpc"
    subprocess.run([tools / "rlpcenc", mesh, "--points", cache, "-o", stream, "-q", "--profile",
                    profile, *settings], check=True)
    return stream.read_bytes()
