#!/usr/bin/env python3
"""File formats of the tools, in and out, as people run them.

    tools_formats_test.py --bin BUILD/bin [unittest arguments, such as FormatsIn]
"""

import math
import re
import struct
import subprocess

from tools_testing import (INPUTS, Tools, ToolsTest, main, read_obj, read_pc2, read_rlpd, write_obj,
                           write_pc2)

OUTPUTS = ("a.rlpd", "a.pc2", "a.mdd", "a.glb", "obj", "ply/f%d.ply", "text/f_%04d.ply")
ENCODE = ["--preset", "fast", "--kg", 0.5, "--quiet"]


def ply(xyz, polygons, encoding):
    """A frame with vertex colours; polygons stay polygons."""
    header = (f"ply\nformat {encoding} 1.0\nelement vertex {len(xyz) // 3}\n"
              "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
              f"element face {len(polygons)}\nproperty list uchar int vertex_indices\nend_header\n")
    points = [xyz[i:i + 3] for i in range(0, len(xyz), 3)]
    if encoding == "ascii":
        body = "".join("%.9g %.9g %.9g 255\n" % tuple(p) for p in points)
        body += "".join(" ".join(map(str, (len(p), *p))) + "\n" for p in polygons)
        return (header + body).encode()
    order = "<" if "little" in encoding else ">"
    return (header.encode() + b"".join(struct.pack(order + "3fB", *p, 255) for p in points)
            + b"".join(struct.pack(f"{order}B{len(p)}i", len(p), *p) for p in polygons))


def off(xyz, polygons):
    lines = ["OFF", f"{len(xyz) // 3} {len(polygons)} 0"]
    lines += ["%.9g %.9g %.9g" % tuple(xyz[i:i + 3]) for i in range(0, len(xyz), 3)]
    lines += [" ".join(map(str, (len(p), *p))) for p in polygons]
    return ("\n".join(lines) + "\n").encode()


def mdd(frames, times=None):
    head = struct.pack(f">ii{len(frames)}f", len(frames), len(frames[0]) // 3,
                       *(times or [f / 30 for f in range(len(frames))]))
    return head + b"".join(struct.pack(f">{len(xyz)}f", *xyz) for xyz in frames)


class FormatsIn(ToolsTest):
    def stream(self, *source, **options):
        self.ok("rlpcenc", *source, "-o", self.path("out.rlpc"), *ENCODE, **options)
        return self.path("out.rlpc").read_bytes()

    def test_every_format_gives_the_same_stream(self):
        triangles, frames = self.clip(12)
        wanted = self.stream(self.path("clip.obj"), "--points", self.path("clip.pc2"))
        self.path("clip.mdd").write_bytes(mdd(frames))
        mesh = off(frames[0], triangles)
        self.path("clip.off").write_bytes(mesh)
        self.assertEqual(
            self.stream(self.path("clip.off"), "--points", self.path("clip.mdd")), wanted)
        self.assertEqual(self.stream("-", "--points", self.path("clip.mdd"), input=mesh), wanted)
        for cache in ("clip.mdd", "clip.pc2"):
            data = self.path(cache).read_bytes()
            self.assertEqual(self.stream(self.path("clip.off"), "--points", "-", input=data),
                             wanted)
        writers = {"off": lambda xyz: off(xyz, triangles)}
        for encoding in ("ascii", "binary_little_endian", "binary_big_endian"):
            writers[encoding] = lambda xyz, e=encoding: ply(xyz, triangles, e)
        for name, write in writers.items():
            self.path(name).mkdir()
            extension = "off" if name == "off" else "PLY"
            for f, xyz in enumerate(frames, start=1):
                (self.path(name) / f"f{f}.{extension}").write_bytes(write(xyz))
            self.assertEqual(self.stream(self.path(name)), wanted, name)
            self.assertEqual(self.stream(self.path(name) / f"f%d.{extension}"), wanted, name)

    def test_polygons_become_the_same_triangles_in_every_format(self):
        xyz = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0.5, 1.5, 0, 0, 1, 0]
        polygon = [(0, 1, 2, 3, 4)]
        text = "".join("v %g %g %g\n" % tuple(xyz[i:i + 3]) for i in range(0, 15, 3))
        self.path("a.obj").write_text(text + "f 1 2 3 4 5\n")
        wanted = self.stream(self.path("a.obj"))
        for data in (off(xyz, polygon), ply(xyz, polygon, "ascii"),
                     ply(xyz, polygon, "binary_big_endian"), self.path("a.obj").read_bytes()):
            self.assertEqual(self.stream("-", input=data), wanted)

    def test_clusters_of_a_point_cloud(self):
        self.path("cloud").mkdir()
        for f, xyz in enumerate(read_pc2(INPUTS / "robot_arm.pc2")):
            (self.path("cloud") / f"f{f:02d}.ply").write_bytes(ply(xyz, [], "binary_little_endian"))

        def size(*options):
            report = self.ok("rlpcenc", self.path("cloud"), "-o", self.path("cloud.rlpc"), "--kg",
                             0.3, "--profile", "baseline", "--json", *options).json()
            self.ok("rlpcval", self.path("cloud.rlpc"))
            return report["bytes"]
        self.assertLess(size("--clusters", 6, "--frame", "lcf"),
                        0.5 * size("--clusters", 1, "--frame", "world"))

    def test_a_long_header_is_read_in_time(self):
        names = "".join(f"property float p{i}\n" for i in range(500000))
        head = "ply\nformat ascii 1.0\nelement vertex 1\n"
        self.path("a.ply").write_text(f"{head}{names}property float p0\nend_header\n")
        self.fails(1, "a.ply:500004: a second property \"p0\"", "rlpcenc", self.path("a.ply"), "-o",
                   self.path("out.rlpc"))

    def test_options_of_other_formats_are_refused(self):
        self.clip(2)
        mesh, points = self.path("clip.obj"), self.path("clip.pc2")
        stream = self.path("out.rlpc")
        self.stream(mesh, "--points", points)
        words = "clip.obj: --no-weld is for .glb and .gltf files"
        self.fails(1, words, "rlpcenc", mesh, "--points", points, "--no-weld", "-o", stream)
        self.fails(2, words, "rlpccmp", points, stream, "--no-weld")
        self.fails(2, "out.rlpc: --no-weld is for .glb", "rlpccmp", points, stream, "--no-weld-b")
        self.fails(2, "out.rlpc: --animation is for .glb", "rlpccmp", points, stream,
                   "--animation-b", "Walk")
        self.fails(64, "--fps: neither A nor B", "rlpccmp", points, stream, "--fps", 25)

    def test_broken_files_are_named(self):
        self.clip(2)
        out = ["-o", self.path("out.rlpc")]
        good = ply([0.0] * 9, [(0, 1, 2)], "binary_little_endian")
        huge = good.replace(b"vertex 3", b"vertex 3000000000")
        for name, data, words in (
                ("a.ply", good[:-1], ["a.ply: byte", "complete?"]),
                ("a.ply", huge, ["a.ply: element \"vertex\"", "39000000000 bytes"]),
                ("a.ply", ply([0.0] * 8 + [float("nan")], [], "ascii"), ["a.ply:13:", "nan"]),
                ("a.off", b"OFF\n900000000 1 0\n0 0 0\n", ["a.off:2:", "complete?"])):
            self.path(name).write_bytes(data)
            self.fails(1, words, "rlpcenc", self.path(name), *out)
        self.path("a.mdd").write_bytes(struct.pack(">ii", 2000000000, 538))
        self.fails(1, ["a.mdd: 8 bytes", "truncated"], "rlpcenc", self.path("clip.obj"), "--points",
                   self.path("a.mdd"), *out)
        data = self.path("clip.pc2").read_bytes()
        for bad in (data[1:], b"", data[:1]):
            self.fails(1, ["standard input: not a PC2 point cache", "nor an MDD one"], "rlpcenc",
                       self.path("clip.obj"), "--points", "-", *out, input=bad)
        self.path("far.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 2e30 0\nf 1 2 3\n")
        self.fails(1, "far.obj: frame 0 (from 0) has coordinates beyond 2^100", "rlpcenc",
                   self.path("far.obj"), *out)
        self.fails(1, "standard input: the file is empty", "rlpcenc", "-", "--points",
                   self.path("clip.pc2"), *out, input=b"")
        self.fails(1, "standard input: unknown kind of file", "rlpcenc", "-", *out, input=b"hello")


class PointClouds(ToolsTest):
    """Clusters and local frames need no triangles: seeds are then neighbours in space."""

    def roundtrip(self, *options):
        """(bytes, cluster count, LCF flags) of the only GOF."""
        stream, cloud = self.path("cloud.rlpc"), self.path("cloud.obj")
        report = self.ok("rlpcenc", cloud, "--points", self.path("clip.pc2"), "-o", stream,
                         "--json", "--keep-order", "--profile", "baseline", "--kg", 0.5,
                         *options).json()
        self.assertTrue(report["target_met"])
        self.ok("rlpcdec", stream, "-o", self.path("out.pc2"), "-q")
        self.assertEqual(read_obj(self.path("out.obj"))[1], [])
        compared = self.ok("rlpccmp", cloud, self.path("out.pc2"), "--points-a",
                           self.path("clip.pc2"), "--json").json()
        self.assertAlmostEqual(compared["metrics"]["kg_error_percent"],
                               report["metrics"]["kg_error_percent"], 5)
        info = self.ok("rlpcinfo", stream, "--json").json()
        trace = self.ok("rlpcinfo", stream, "--trace").out.decode()
        return (report["bytes"], info["gofs"][0]["num_clusters"],
                re.findall(r" lcf_flag = (\d)", trace))

    def test_clusters_and_local_frames(self):
        """A cloud of two parts, one of which spins."""
        _, frames = self.clip(12)
        parts = [frames[0][:600], frames[0][600:1200]]
        clip = []
        for t in range(12):
            c, s = math.cos(0.3 * t), math.sin(0.3 * t)
            spinning = []
            for x, y, z in zip(*[iter(parts[1])] * 3):
                spinning += [9 + c * x - s * y, s * x + c * y, z]
            clip.append([*parts[0], *spinning])
        write_obj(self.path("cloud.obj"), clip[0], [])
        write_pc2(self.path("clip.pc2"), clip)
        world = self.roundtrip("--frame", "world")
        local = self.roundtrip("--frame", "lcf")
        eight = self.roundtrip("--clusters", 8)
        both = self.roundtrip("--clusters", 8, "--frame", "lcf")
        self.assertEqual(set(world[2]), {"0"})
        self.assertEqual((set(local[2]), set(both[2])), ({"1"}, {"1"}))
        self.assertEqual((eight[1], both[1]), (8, 8))
        self.assertLess(local[0], world[0])


class MddTimes(ToolsTest):
    def rate_of(self, times, *options):
        _, frames = self.clip(len(times))
        self.path("clip.mdd").write_bytes(mdd(frames, times))
        self.ok("rlpcenc", self.path("clip.obj"), "--points", self.path("clip.mdd"), "-o",
                self.path("out.rlpc"), "--kg", 5, "--preset", "fast", *options)
        return self.ok("rlpcinfo", self.path("out.rlpc"), "--json").json()["frame_rate"]

    def test_evenly_spaced_they_are_the_frame_rate(self):
        for rate, expected in ((24, [24, 1]), (30000 / 1001, [30000, 1001]), (12.5, [25, 2]),
                               (60, [60, 1])):
            self.assertEqual(self.rate_of([3 + f / rate for f in range(12)]), expected)
        self.assertEqual(self.rate_of([f / 24 for f in range(12)], "--fps", 50), [50, 1])

    def test_others_tell_nothing(self):
        nan = float("nan")
        for times in ([0] * 5, [0, 1, 2, 3, 4], [0, 0.1, 0.15, 0.3, 0.4], [0.4, 0.3, 0.2, 0.1, 0],
                      [nan] * 5, [0, nan, 0.2, 0.3, 0.4], [0, 1e-9, 2e-9], [7]):
            self.assertEqual(self.rate_of(times), [30, 1], times)

    def test_invalid_times_are_reported(self):
        _, frames = self.clip(3)
        encode = ["rlpcenc", self.path("clip.obj"), "-o", self.path("out.rlpc"), "--kg", 5,
                  "--preset", "fast", "--points"]
        nan, cache = float("nan"), self.path("clip.mdd")
        for times, warned in (([0.2, 0.1, 0], True), ([0, nan, 1], True), ([0, 1, math.inf], True),
                              ([0, 0, 0], False), ([0, 0.1, 0.3], False), ([0, 0.1, 0.2], False)):
            cache.write_bytes(mdd(frames, times))
            self.assertEqual("not finite and ascending" in self.ok(*encode, cache).err, warned,
                             times)
            # The times are lost, whatever sets the rate.
            self.assertEqual("ascending" in self.ok(*encode, cache, "--fps", 10).err, warned, times)
        cache = self.path("clip.pc2")
        good = cache.read_bytes()
        for at, value, warned in ((20, nan, True), (24, nan, True), (24, -math.inf, True),
                                  (24, 0, False)):
            cache.write_bytes(good[:at] + struct.pack("<f", value) + good[at + 4:])
            self.assertEqual("the file may be damaged" in self.ok(*encode, cache).err, warned,
                             value)


class FormatsOut(ToolsTest):
    def setUp(self):
        super().setUp()
        self.clip(12)
        self.ok("rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"), "--fps", "24",
                "-o", self.path("a.rlpc"), *ENCODE)

    def test_what_is_written_reads_back_exactly(self):
        self.check_outputs()

    def test_coarse_meshes_read_back_exactly(self):
        self.check_outputs("--coarse", 4)

    def check_outputs(self, *options):
        streams = []
        for name in OUTPUTS:
            out = self.path(name)
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", out, *options,
                    *(["--ascii"] if "text" in name else []),
                    *(["--as", "morph"] if name == "a.glb" else []))
            source = [out, "--no-weld"] if name == "a.glb" else [out]
            if name in ("a.pc2", "a.mdd"):
                source = [self.path("a.obj"), "--points", out]
            self.ok("rlpcenc", *source, "-o", self.path("b.rlpc"), *ENCODE, "--no-attributes")
            streams.append(self.path("b.rlpc").read_bytes())
        # Frame rate and triangles are compared as well.
        self.assertEqual(streams, streams[:1] * len(OUTPUTS))

    def test_standard_output(self):
        for name, options in (("a.glb", []), ("a.rlpd", []), ("a.ply", ["--frames", "3"]),
                              ("a.obj", ["--frames", "3"])):
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path(name), *options)
            piped = self.ok("rlpcdec", self.path("a.rlpc"), "-o", "-", "--format", name[2:],
                            *options)
            self.assertEqual(piped.out, self.path(name).read_bytes(), name)
        again = self.ok("rlpcenc", "-", "-o", "-", *ENCODE, input=self.path("a.glb").read_bytes())
        self.path("b.rlpc").write_bytes(again.out)
        self.ok("rlpcdec", self.path("b.rlpc"), "-o", self.path("b.rlpd"))
        self.assertEqual(len(read_rlpd(self.path("b.rlpd"))[2]), 12)

    def test_standard_output_that_is_a_file(self):
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"))
        out = self.path("standard output")
        with out.open("wb") as file:
            subprocess.run([Tools.folder / "rlpcenc", self.path("a.rlpd"), "-o", "-", "--quiet"],
                           stdout=file, check=True)
        self.ok("rlpcdec", out, "--verify")
        self.assertFalse(self.path("-").exists())

    def test_the_format_may_differ_from_the_name(self):
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("out"), "--format", "ply")
        self.assertTrue((self.path("out") / "frame_0011.ply").is_file())
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("data.bin"), "--format", "glb")
        self.assertEqual(self.path("data.bin").read_bytes()[:4], b"glTF")

    def test_what_cannot_be_written_is_reported(self):
        stream = self.path("a.rlpc")
        self.fails(64, "needs --format", "rlpcdec", stream, "-o", "-")
        self.fails(64, "--json", "rlpcdec", stream, "-o", "-", "--format", "glb", "--json")
        self.fails(64, "--ascii", "rlpcdec", stream, "-o", self.path("a.rlpd"), "--ascii")
        self.fails(64, "--ascii", "rlpcdec", stream, "-o", self.path("frames"), "--ascii")
        self.fails(64, "--ascii", "rlpcdec", stream, "--verify", "--ascii")
        self.fails(64, "--format", "rlpcdec", stream, "--verify", "--format", "ply")
        self.fails(64, "needs the mesh", "rlpcdec", stream, "-o", "-", "--format", "mdd")
        self.fails(64, "a single frame as .ply", "rlpcdec", stream, "-o", "-", "--format", "ply")
        self.fails(64, "holds one frame", "rlpcdec", stream, "-o", self.path("x.ply"))
        self.fails(64, "numbered names", "rlpcdec", stream, "-o", self.path("x%d.glb"))
        self.fails(64, "numbered names", "rlpcdec", stream, "-o", self.path("x%d.ply"),
                   "--format", "rlpd")
        self.assertEqual(self.files(), ["a.rlpc", "clip.obj", "clip.pc2"])


if __name__ == "__main__":
    main()
