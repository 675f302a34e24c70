"""Shared by the tests of the tools: running them, and files to run them on."""

import argparse
import array
import json
import math
import os
import pathlib
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
INPUTS = ROOT / "streams" / "inputs"
NAMES = ("elephant", "curtain", "robot_arm")


def vertex_normals(triangles, points):
    """[vertex]: the sum of the normals of its triangles, weighted by area, and a third of their
    area."""
    found = [[[0.0, 0.0, 0.0], 0.0] for _ in points]
    for t in triangles:
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (points[v] for v in t)
        ux, uy, uz, vx, vy, vz = bx - ax, by - ay, bz - az, cx - ax, cy - ay, cz - az
        n = (uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx)
        for v in t:
            for c in range(3):
                found[v][0][c] += n[c]
            found[v][1] += math.hypot(*n) / 6
    return [(tuple(n), area) for n, area in found]


def unit_or_zero(n):
    size = math.hypot(*n)
    return tuple(c / size for c in n) if size else (0.0, 0.0, 0.0)


def squared_angles(triangles, a, b):
    """Of the vertex normals of two frames: the sum of squared degrees times area; the sum of
    areas; and the errors as vectors."""
    total, areas, errors = [], [], []
    for (n, area), (m, _) in zip(vertex_normals(triangles, a), vertex_normals(triangles, b)):
        n, m = unit_or_zero(n), unit_or_zero(m)
        errors.append((tuple(y - x for x, y in zip(n, m)), area if any(n) else 0.0))
        if any(n):
            cross = (n[1] * m[2] - n[2] * m[1], n[2] * m[0] - n[0] * m[2],
                     n[0] * m[1] - n[1] * m[0])
            along = sum(x * y for x, y in zip(n, m))
            angle = math.degrees(math.atan2(math.hypot(*cross), along)) if any(m) else 90.0
            total.append(angle ** 2 * area)
            areas.append(area)
    return math.fsum(total), math.fsum(areas), errors


def searched(few, many):
    """How much a random search tries: `many` where `scripts/test --all` runs it."""
    return many if os.environ.get("RLPC_LONG") else few


class Tools:
    folder = ROOT / "build" / "release" / "bin"  # --bin


class Result:
    def __init__(self, done):
        self.code = done.returncode
        self.out = done.stdout
        self.err = done.stderr.decode(errors="replace")

    def json(self):
        return json.loads(self.out)


def run(tool, *args, **options):
    result = _run(tool, args, options)
    if tool == "rlpcenc" and result.code in (0, 2):  # 2: written, but the target was out of reach
        check_encoded(args, result)
    return result


def _run(tool, args, options):
    command = [str(Tools.folder / tool), *map(str, args)]
    return Result(subprocess.run(command, capture_output=True, check=False, **options))


def check_encoded(args, result):
    """Requires that rlpcval finds no error in what rlpcenc wrote."""
    places = [args[i + 1] for i, arg in enumerate(args[:-1]) if arg in ("-o", "--output")]
    if not places or (places[0] != "-" and not pathlib.Path(places[0]).is_file()):
        return  # --help, or a device
    options = {"input": result.out} if places[0] == "-" else {}
    found = _run("rlpcval", places[:1], options)
    if found.code != 0:
        raise AssertionError(f"rlpcenc {args} wrote a stream with errors:\n"
                             + found.out.decode(errors="replace") + found.err)


def write_pc2(path, frames):
    """frames: lists of 3 V floats."""
    header = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(frames[0]) // 3, 0.0, 1.0,
                         len(frames))
    path.write_bytes(header + b"".join(array.array("f", frame).tobytes() for frame in frames))


def write_mdd(path, frames):
    points = len(frames[0]) // 3
    data = struct.pack(f">ii{len(frames)}f", len(frames), points,
                       *(f / 25 for f in range(len(frames))))
    path.write_bytes(data + b"".join(struct.pack(f">{len(f)}f", *f) for f in frames))


def read_pc2(path):
    data = path.read_bytes()
    points, _, _, samples = struct.unpack_from("<iffi", data, 16)
    values = array.array("f", data[32:])
    size = 3 * points
    return [values[size * f:size * f + size] for f in range(samples)]


def write_obj(path, xyz, triangles):
    lines = ["v %.9g %.9g %.9g" % tuple(xyz[3 * v:3 * v + 3]) for v in range(len(xyz) // 3)]
    lines += ["f " + " ".join(str(v + 1) for v in triangle) for triangle in triangles]
    path.write_text("\n".join(lines) + "\n")


def read_obj(path):
    xyz, triangles = array.array("f"), []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            xyz.extend(map(float, words[1:4]))
        elif words[:1] == ["f"]:
            triangles.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:]))
    return xyz, triangles


def triangle_set(triangles):
    return sorted(min(t, t[1:] + t[:1], t[2:] + t[:2]) for t in triangles)


def read_rlpd(path):
    """(header fields, triangles, the bytes of each frame present: A.2)"""
    data = path.read_bytes()
    magic, version, vertices, num_triangles, frames, *rest = struct.unpack_from("<4s6Ii3i", data)
    assert magic == b"RLPD" and version == 1
    corners = struct.unpack_from(f"<{3 * num_triangles}I", data, 44)
    at = 44 + 12 * num_triangles
    size = 12 * vertices
    present = (len(data) - at) // size
    assert len(data) == at + size * present and present <= frames
    triangles = [corners[3 * t:3 * t + 3] for t in range(num_triangles)]
    return rest, triangles, [data[at + size * f:at + size * f + size] for f in range(present)]


def limited(size):
    """Call it before a tool starts: writing a file beyond `size` bytes fails (EFBIG)."""
    return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)),
            "restore_signals": False}


class ToolsTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="rlpc-tools-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return self.folder / name

    def expect_same_metrics(self, report, compared):
        """rlpcenc reports what rlpccmp measures; normals, where any triangle has an area."""
        metrics = dict(report["metrics"])
        normals = metrics.pop("vertex_normal_rms_degrees", None)
        self.assertEqual(compared["metrics"], metrics)
        if normals is not None:
            surface = compared.get("surface", {})
            self.assertAlmostEqual(normals, surface.get("vertex_normal_rms_degrees") or 0,
                                   delta=1e-9)

    def ok(self, tool, *args, **options):
        result = run(tool, *args, **options)
        self.assertEqual(result.code, 0, f"{tool} {args}: {result.err}")
        return result

    def fails(self, code, words, tool, *args, **options):
        """Expects the exit code, and a message of one line that contains all of `words`."""
        result = run(tool, *args, **options)
        self.assertEqual(result.code, code, f"{tool} {args}: {result.err}")
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, result.err)
        if code != 64:
            self.assertEqual(result.err.count("\n"), 1, result.err)
        return result

    def encode(self, output, *options, name="elephant", preset="fast"):
        return self.ok("rlpcenc", INPUTS / f"{name}.obj", "--points", INPUTS / f"{name}.pc2", "-o",
                       output,
                       "--json", "--preset", preset, *options).json()

    def clip(self, frames):
        """The first frames of the elephant as clip.obj and clip.pc2; (triangles, frames)."""
        _, triangles = read_obj(INPUTS / "elephant.obj")
        positions = read_pc2(INPUTS / "elephant.pc2")[:frames]
        write_obj(self.path("clip.obj"), positions[0], triangles)
        write_pc2(self.path("clip.pc2"), positions)
        return triangles, positions

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())


def main():
    """--bin BUILD/bin, then the arguments of unittest, such as the name of a class."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default=Tools.folder)
    options, rest = parser.parse_known_args()
    Tools.folder = options.bin.resolve()
    unittest.main(module="__main__", argv=[sys.argv[0], *rest])
