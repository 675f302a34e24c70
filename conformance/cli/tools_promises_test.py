#!/usr/bin/env python3
"""Tests the promises of rlpcenc about errors, computed here from the numbers in the input.

    tools_promises_test.py --bin BUILD/bin
"""

import array
import base64
import json
import math
import random
import struct

from tools_testing import (INPUTS, NAMES, ToolsTest, main, read_obj, read_pc2, squared_angles,
                           write_obj, write_pc2)

TRIANGLES = [(0, 1, 2), (2, 1, 3)]


def as_float(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def rounding(frames):
    """The largest distance of a vertex from the floats nearest to its numbers."""
    return max(math.dist(frame[i:i + 3], [as_float(x) for x in frame[i:i + 3]])
               for frame in frames for i in range(0, len(frame), 3))


class Promises(ToolsTest):
    def far_away(self):
        """Frames of four vertices at the coordinates of a map."""
        random.seed(48)
        return [[x + 3 * random.random() for x in (431229.5, 312.3, 5967885.75) * 4]
                for _ in range(4)]

    def write_objs(self, frames):
        folder = self.path("frames")
        folder.mkdir(exist_ok=True)
        for f, frame in enumerate(frames):
            lines = ["v %.17g %.17g %.17g" % tuple(frame[i:i + 3]) for i in range(0, 12, 3)]
            lines += ["f %d %d %d" % tuple(v + 1 for v in t) for t in TRIANGLES]
            (folder / f"f_{f}.obj").write_text("\n".join(lines) + "\n")
        return folder

    def write_plys(self, frames, number_type):
        folder = self.path("plys")
        folder.mkdir(exist_ok=True)
        for f, frame in enumerate(frames):
            header = ("ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
                      + "".join(f"property {number_type} {c}\n" for c in "xyz")
                      + "element face 2\nproperty list uchar int vertex_indices\nend_header\n")
            body = struct.pack("<12d", *frame)
            body += b"".join(struct.pack("<B3i", 3, *t) for t in TRIANGLES)
            (folder / f"f_{f}.ply").write_bytes(header.encode() + body)
        return folder

    def write_gltf(self, frame, offset):
        """One mesh whose node takes it to an offset."""
        data = array.array("f", frame).tobytes()
        indices = struct.pack("<6H", *(v for t in TRIANGLES for v in t))
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0, "translation": offset}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3",
                 "min": [min(frame[c::3]) for c in range(3)],
                 "max": [max(frame[c::3]) for c in range(3)]},
                {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteLength": len(data)},
                            {"buffer": 0, "byteOffset": len(data), "byteLength": 12}],
            "buffers": [{"byteLength": len(data) + 12,
                         "uri": "data:application/octet-stream;base64,"
                         + base64.b64encode(data + indices).decode()}]}
        self.path("a.gltf").write_text(json.dumps(document))
        return self.path("a.gltf")

    def check_bound(self, source, frames, bound, *options):
        report = self.ok("rlpcenc", source, "-o", self.path("a.rlpc"), "--max-error", bound,
                         "--keep-order", "--json", *options).json()
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        largest = max(math.dist(frame[i:i + 3], decoded[i:i + 3])
                      for frame, decoded in zip(frames, read_pc2(self.path("a.pc2")))
                      for i in range(0, 12, 3))
        self.assertLessEqual(largest, bound, options)
        return report, largest

    def rms_of_normals(self, name):
        """RMS deviation of vertex normals in all frames of a bundled animation."""
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        triangles = read_obj(INPUTS / f"{name}.obj")[1]
        total, area = 0.0, 0.0
        for original, decoded in zip(read_pc2(INPUTS / f"{name}.pc2"),
                                     read_pc2(self.path("a.pc2")), strict=True):
            frames = [[frame[i:i + 3] for i in range(0, len(frame), 3)]
                      for frame in (original, decoded)]
            angles = squared_angles(triangles, *frames)
            total, area = total + angles[0], area + angles[1]
        return math.sqrt(total / area)

    def test_normals_deviate_at_most_as_asked(self):
        for name in NAMES:
            for profile, degrees, others in (("main", 0.5, ()), ("high", 3, ("--kg", 10))):
                with self.subTest(name=name, profile=profile):
                    result = self.ok("rlpcenc", INPUTS / f"{name}.obj", "--points",
                                     INPUTS / f"{name}.pc2", "--normals", degrees,
                                     "-o", self.path("a.rlpc"), "--keep-order", "--json",
                                     "--profile", profile, "--preset", "fast", *others)
                    self.assertNotIn("smaller than requested", result.err)
                    report = result.json()
                    self.assertTrue(report["target_met"])
                    found = self.rms_of_normals(name)
                    self.assertLessEqual(found, degrees * (1 + 1e-9))
                    self.assertGreater(found, 0.9 * degrees)
                    self.assertAlmostEqual(
                        report["metrics"]["vertex_normal_rms_degrees"], found, delta=1e-6)

    def test_with_a_kg_error_both_are_bounds(self):
        name = "elephant"
        nearest = []
        for kg in (0.02, 2):
            report = self.ok("rlpcenc", INPUTS / f"{name}.obj", "--points",
                             INPUTS / f"{name}.pc2", "--normals", 1, "--kg", kg, "-o",
                             self.path("a.rlpc"), "--keep-order", "--json").json()
            error = report["metrics"]["kg_error_percent"]
            normals = self.rms_of_normals(name)
            self.assertLessEqual(error, kg)
            self.assertLessEqual(normals, 1 + 1e-9)
            nearest.append(normals > error / kg)
            self.assertGreater(max(error / kg, normals), 0.98)
        self.assertEqual(nearest, [False, True])

    def test_the_stream_does_not_depend_on_the_threads(self):
        streams = set()
        for threads in (1, 3):
            self.ok("rlpcenc", INPUTS / "curtain.obj", "--points", INPUTS / "curtain.pc2",
                    "--normals", 2, "--profile", "high", "--threads", threads, "-o",
                    self.path("a.rlpc"))
            streams.add(self.path("a.rlpc").read_bytes())
        self.assertEqual(len(streams), 1)

    def test_normals_alone_do_not_lose_the_motion(self):
        """A square that slides within its plane, a line, and points: any error leaves normals as
        they are."""
        square = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
        line = [0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0]
        for shape, triangles in ((square, [(0, 1, 2), (0, 2, 3)]), (line, [(0, 1, 2)])):
            frames = [[x + 0.37 * f * (i % 3 == 0) for i, x in enumerate(shape)]
                      for f in range(20)]
            write_obj(self.path("a.obj"), frames[0], triangles)
            write_pc2(self.path("a.pc2"), frames)
            for profile in ("main", "high"):
                self.ok("rlpcenc", self.path("a.obj"), "--points", self.path("a.pc2"),
                        "--normals", 1, "--profile", profile, "-o", self.path("a.rlpc"))
                self.ok("rlpccmp", self.path("a.obj"), "--points", self.path("a.pc2"),
                        self.path("a.rlpc"), "--max-kg", 1)

    def test_what_bounds_normals_cannot_be_combined_with(self):
        for options in (("--bpvf", 2), ("--max-error", 1), ("--lossless",),
                        ("--quality", "good"), ("--profile", "high", "--low-delay")):
            self.fails(64, "--normals", "rlpcenc", INPUTS / "elephant.obj", "-o",
                       self.path("b.rlpc"), "--normals", 1, *options)
        self.fails(64, "--normals", "rlpcenc", INPUTS / "elephant.obj", "-o",
                   self.path("b.rlpc"), "--normals", 0)

    def test_errors_are_those_of_the_numbers_in_the_input(self):
        frames = self.far_away()
        coarse = rounding(frames)
        self.assertGreater(coarse, 0.1)
        for source in (self.write_objs(frames), self.write_plys(frames, "double")):
            report, largest = self.check_bound(source, frames, 2 * coarse)
            self.assertAlmostEqual(report["metrics"]["max_error"], largest, delta=1e-9)
            self.assertAlmostEqual(report["largest_rounding"], coarse, delta=1e-9)
            self.check_bound(source, frames, 8 * coarse, "--profile", "high", "--low-delay")

    def test_low_delay_measures_by_the_numbers_in_the_input(self):
        frames = self.far_away()
        coarse = rounding(frames)
        for target in (("--lossless", 20), ("--kg", 20), ("--max-error", 8 * coarse)):
            report = self.ok("rlpcenc", self.write_objs(frames), "-o", self.path("a.rlpc"),
                             "--keep-order", "--json", "--profile", "high", "--low-delay",
                             *target).json()
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
            squared = [math.dist(frame[i:i + 3], decoded[i:i + 3]) ** 2
                       for frame, decoded in zip(frames, read_pc2(self.path("a.pc2")))
                       for i in range(0, 12, 3)]
            metrics = report["metrics"]
            self.assertAlmostEqual(metrics["max_error"], math.sqrt(max(squared)), delta=1e-9)
            self.assertAlmostEqual(metrics["rms_error"], math.sqrt(sum(squared) / len(squared)),
                                   delta=1e-9)
            self.assertAlmostEqual(report["largest_rounding"], coarse, delta=1e-9)

    def test_a_bound_below_the_spacing_of_floats_is_refused(self):
        frames = self.far_away()
        shape = [-1, 0, 0.1, 1, 0, 0.2, 0, 1, 0.3, 1, 1, 0.7]
        offset = [431229.3, 312.3, 5967885.6]
        sources = (self.write_objs(frames), self.write_plys(frames, "double"),
                   self.write_gltf(shape, offset))
        for source in sources:
            for options in ((), ("--profile", "high"), ("--profile", "high", "--low-delay"),
                            ("--axes", "x,z,-y")):
                self.fails(1, ["frame ", "vertex ", "nearest 32-bit floats", "cannot be 0.01",
                               "origin"], "rlpcenc", source, "-o", self.path("a.rlpc"),
                           "--max-error", 0.01, "-q", *options)
                self.assertFalse(self.path("a.rlpc").exists(), options)

    def test_floats_have_no_rounding(self):
        report = self.encode(self.path("a.rlpc"), "--max-error", 0.01)
        self.assertEqual(report["largest_rounding"], 0)

    def test_lossless_says_what_it_keeps(self):
        frames = [[0.25 * (i + 1) + 1e-12 + f for i in range(12)] for f in range(3)]
        folder = self.write_objs(frames)
        lossless = ("rlpcenc", folder, "-o", self.path("a.rlpc"), "--profile", "high",
                    "--lossless", "--keep-order")
        said = self.ok(*lossless).out.decode()
        self.assertIn("as 32-bit floats, up to 1.73e-12 from the numbers of INPUT", said)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        self.assertEqual([list(frame) for frame in read_pc2(self.path("a.pc2"))],
                         [[as_float(x) for x in frame] for frame in frames])
        write_pc2(self.path("b.pc2"), read_pc2(self.path("a.pc2")))
        said = self.ok("rlpcenc", folder / "f_0.obj", "--points", self.path("b.pc2"), "-o",
                       self.path("b.rlpc"), "--profile", "high", "--lossless").out.decode()
        self.assertNotIn("32-bit floats", said)
        self.assertIn("largest 0 ", said)

    def test_what_was_lossless_once_is_lossless_again(self):
        self.encode(self.path("a.rlpc"), "--profile", "high", "--lossless", 6, "--keep-order")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        for options in ((), ("--preset", "fast"), ("--patches", 4), ("--gof", 7)):
            self.ok("rlpcenc", INPUTS / "elephant.obj", "--points", self.path("a.pc2"), "-o",
                    self.path("b.rlpc"), "--profile", "high", "--lossless", "--keep-order",
                    *options)
            self.ok("rlpcdec", self.path("b.rlpc"), "-o", self.path("b.pc2"))
            self.assertEqual(self.path("a.pc2").read_bytes(), self.path("b.pc2").read_bytes(),
                             options)

    def test_a_pipe_gets_what_a_file_gets(self):
        cow = (INPUTS / "elephant.obj", "--points", INPUTS / "elephant.pc2", "--preset", "fast")
        self.ok("rlpcenc", *cow, "-o", self.path("a.rlpc"), "--verify")
        piped = self.ok("rlpcenc", *cow, "-o", "-", "-q", "--verify")
        self.assertEqual(piped.out, self.path("a.rlpc").read_bytes())

    def many_attributes(self, count):
        source = json.loads(self.write_gltf([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0],
                                            [0, 0, 0]).read_text())
        data = b"".join(struct.pack("<8f", 0, 0, 1, 0, 0, 1, 1, i / 128) for i in range(count))
        source["buffers"].append(
            {"byteLength": len(data), "uri": "data:application/octet-stream;base64,"
             + base64.b64encode(data).decode()})
        attributes = source["meshes"][0]["primitives"][0]["attributes"]
        for i in range(count):  # equal sets would be coded once
            attributes[f"TEXCOORD_{i}"] = len(source["accessors"])
            source["accessors"].append({"bufferView": len(source["bufferViews"]),
                                        "componentType": 5126, "count": 4, "type": "VEC2"})
            source["bufferViews"].append({"buffer": 1, "byteOffset": 32 * i, "byteLength": 32})
        self.path("many.gltf").write_text(json.dumps(source))
        return self.path("many.gltf")

    def test_attributes_that_a_stream_has_no_room_for_are_named(self):
        for count, dropped in ((64, []), (65, ["uv64"]),
                               (67, ["uv64", "uv65", "uv66"])):
            result = self.ok("rlpcenc", self.many_attributes(count), "-o", self.path("a.rlpc"))
            self.assertEqual("a stream has at most 64 attributes" in result.err, bool(dropped))
            if dropped:
                self.assertIn("dropped " + ", ".join(dropped), result.err)
            info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
            self.assertEqual(len(info["attributes"]), 64)

    def test_a_rate_includes_everything(self):
        _, triangles = read_obj(INPUTS / "elephant.obj")
        frames = read_pc2(INPUTS / "elephant.pc2")
        # Many GOFs, whose index counts.
        small = [frame[:36] for frame in frames]
        write_obj(self.path("small.obj"), small[0], [t for t in triangles if max(t) < 12])
        write_pc2(self.path("small.pc2"), small)
        for profile in ("baseline", "main", "high"):
            for bits in (20, 33, 60):
                result = self.ok("rlpcenc", self.path("small.obj"), "--points",
                                 self.path("small.pc2"), "-o", self.path("a.rlpc"), "--bpvf",
                                 bits, "--gof", 3, "--profile", profile, "-q")
                size = self.path("a.rlpc").stat().st_size
                self.assertLessEqual(8 * size / 12 / len(frames), bits, (profile, result.err))


if __name__ == "__main__":
    main()
