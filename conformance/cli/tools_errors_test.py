#!/usr/bin/env python3
"""Tests how the tools report errors of the input, the output and the stream.

    tools_errors_test.py --bin BUILD/bin [unittest arguments, such as BadInput]
"""

import math
import os
import struct
import subprocess
import sys
import zlib

from tools_testing import INPUTS, ROOT, Tools, ToolsTest, limited, main, run, write_pc2

sys.path.insert(0, str(ROOT / "conformance" / "specdec"))
from specdec_testing import stream_of, units_of

METADATA = 0x83
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


class BadInput(ToolsTest):
    """Expects the exit code, one line that names the file, and no output file."""

    def refused(self, words, *arguments):
        self.path("out.rlpc").unlink(missing_ok=True)
        self.fails(1, words, "rlpcenc", *arguments, "-o", self.path("out.rlpc"))
        self.assertFalse(self.path("out.rlpc").exists())
        self.assertEqual([name for name in self.files() if "partial" in name], [])

    def test_threads(self):
        for threads in (0, 257, -1, "all"):
            self.fails(64, ("--threads", "1 to 256"), "rlpcdec", "in.rlpc", "--verify",
                       "--threads", threads)
            self.fails(64, ("--threads", "1 to 256"), "rlpcenc", "in.obj", "-o", "out.rlpc",
                       "--threads", threads)

    def accepted(self, *arguments):
        """Encodes, decodes and compares; returns the report."""
        report = self.ok("rlpcenc", *arguments, "-o", self.path("out.rlpc"), "--keep-order",
                         "--json").json()
        self.ok("rlpcdec", self.path("out.rlpc"), "-o", self.path("decoded.rlpd"))
        points = ["--points-a", arguments[2]] if "--points" in arguments else []
        compared = self.ok("rlpccmp", arguments[0], *points, self.path("out.rlpc"), "--json").json()
        self.expect_same_metrics(report, compared)
        self.assertTrue(report["target_met"])
        return report

    def obj(self, text, name="mesh.obj"):
        path = self.path(name)
        if isinstance(text, bytes):
            path.write_bytes(text)
        else:
            path.write_text(text)
        return path

    def test_a_file_that_is_not_obj(self):
        self.refused("none.obj", self.path("none.obj"))
        self.refused("mesh.obj", self.obj(""))
        self.refused("mesh.obj", self.obj("# nothing\n"))
        self.refused("mesh.obj", self.obj(bytes(range(256)) * 40))
        self.refused("mesh.obj", self.obj(b"v 0 0 0\nv \xff\xfe 0 0\n"))
        self.refused("mesh.txt", self.obj("to be a mesh\n", "mesh.txt"))
        self.path("empty").mkdir()
        self.refused("empty", self.path("empty"))

    def test_obj_with_bad_values(self):
        self.refused(["mesh.obj", "4"], self.obj(TRIANGLE.replace("1 2 3", "1 2 4")))
        self.refused("mesh.obj", self.obj(TRIANGLE.replace("1 2 3", "1 2 0")))
        self.refused("mesh.obj", self.obj(TRIANGLE.replace("1 2 3", "1 2 -4")))
        self.refused("mesh.obj", self.obj(TRIANGLE.replace("1 2 3", "1 2")))
        for value in ("nan", "inf", "-inf", "1e39", "x", ""):
            self.refused("mesh.obj", self.obj(TRIANGLE.replace("v 1 0 0", f"v 1 0 {value}")))

    def test_point_cache_that_does_not_fit(self):
        mesh = self.obj(TRIANGLE)
        cache = self.path("c.pc2")
        write_pc2(cache, [[0.0] * 12] * 2)
        self.refused(["c.pc2", "4 points", "3 vertices"], mesh, "--points", cache)
        write_pc2(cache, [[0.0] * 9] * 3)
        whole = cache.read_bytes()
        for size in (0, 5, 31, 32, 33, len(whole) - 1):
            cache.write_bytes(whole[:size])
            self.refused("c.pc2", mesh, "--points", cache)
        cache.write_bytes(whole + b"\0")
        self.refused("c.pc2", mesh, "--points", cache)
        cache.write_bytes(whole[:28] + struct.pack("<i", 0))
        self.refused("c.pc2", mesh, "--points", cache)
        for value in (math.nan, math.inf, -math.inf):
            write_pc2(cache, [[0.0] * 9, [1.0] * 5 + [value] + [1.0] * 3])
            self.refused(["c.pc2", "frame 1"], mesh, "--points", cache)
        self.refused("none.pc2", mesh, "--points", self.path("none.pc2"))
        self.refused("c.pc2", cache)

    def test_sequences_that_change(self):
        self.obj(TRIANGLE, "f_1.obj")
        self.obj(TRIANGLE.replace("1 2 3", "1 3 2"), "f_2.obj")
        self.refused(["f_2.obj", "frame 1"], self.path("f_%d.obj"))
        self.obj(TRIANGLE + "v 1 1 1\n", "f_2.obj")
        self.refused(["f_2.obj", "frame 1"], self.path("f_*.obj"))
        self.path("f_2.obj").unlink()
        self.obj(TRIANGLE, "f_3.obj")
        self.refused("f_2.obj", self.path("f_%d.obj"))
        self.refused("g_%d.obj", self.path("g_%d.obj"))

    def test_unusual_meshes_work(self):
        quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 1 0\nf 1 2 3 4\nf 1/1/1 3//2 4/4 5\n"
        self.assertEqual(self.accepted(self.obj(quad))["num_triangles"], 4)
        self.assertEqual(self.accepted(self.obj("v 1 2 3\nv 3 2 1\nv 0 0 1\n"))["num_triangles"], 0)
        self.assertEqual(self.accepted(self.obj("v 1 2 3\n"))["num_vertices"], 1)
        self.assertEqual(self.accepted(self.obj(TRIANGLE))["num_frames"], 1)
        self.accepted(self.obj(TRIANGLE.replace("1 0", "0 0").replace("0 1", "0 0")))
        self.accepted(self.obj(TRIANGLE.replace("f 1 2 3", "f 1 1 1")))
        # No grid holds the normal of a triangle of which one side is 1e30 times another.
        long = self.obj(TRIANGLE.replace("v 1 0 0", "v 1e30 0 0"))
        self.accepted(long, "--kg", 0.1)
        self.fails(2, "--normals", "rlpcenc", long, "-o", self.path("out.rlpc"))
        self.accepted(self.obj(TRIANGLE.replace("v 1 0 0", "v 1e-30 0 0").replace("1 0", "0 0")))
        self.refused("scale", self.obj(TRIANGLE.replace("v 1 0 0", "v 3e38 0 0")))
        mesh, cache = self.obj(TRIANGLE), self.path("c.pc2")
        write_pc2(cache, [[1.0] * 9] * 5)
        self.accepted(mesh, "--points", cache)
        write_pc2(cache, [[0.0, 0, 0, 1, 0, 0, 0, 1, 0], [1e30, 0, 0, 1, 0, 0, 0, -1e30, 0]])
        self.accepted(mesh, "--points", cache)

    def test_more_than_a_level_allows(self):
        mesh, cache = self.obj("v 0 0 0\n"), self.path("c.pc2")
        write_pc2(cache, [[0.0, 1.0, 2.0]] * 16385)
        self.refused("no level allows", mesh, "--points", cache, "--gof", "all", "-q")
        self.refused("no level allows", mesh, "--points", cache, "--gof", 20000, "-q")

    def test_usage(self):
        mesh = self.obj(TRIANGLE)
        self.fails(64, "", "rlpcenc", mesh)
        self.fails(64, "", "rlpcenc", mesh, "-o")
        for options in ("--kg 0", "--kg -1", "--kg a", "--kg nan", "--bpvf inf", "--kg 0,3",
                        "--max-error 1mm", "--kg 1 --bpvf 1", "--gof 0", "--gof 1x", "--gof -3",
                        "--fps 0", "--fps a", "--preset best", "--clusters 0", "--qu 1",
                        "--influences 0", "--influences 5", "--frame y", "--partition metis",
                        "--profile scalable",
                        "--nonsense"):
            self.fails(64, "", "rlpcenc", mesh, "-o", self.path("x"), *options.split())
        self.assertEqual(self.files(), ["mesh.obj"])
        for words, options in (("found `0,3`", "--kg 0,3"), ("fast,medium,slow", "--preset best")):
            self.fails(64, words, "rlpcenc", mesh, "-o", self.path("x"), *str(options).split())
        for tool in ("rlpcenc", "rlpcdec", "rlpcinfo", "rlpccmp"):
            self.assertRegex(self.ok(tool, "--version").out, rb"\d+\.\d+\.\d+")
            self.fails(64, "", tool)

    def test_settings_that_contradict(self):
        mesh = self.obj(TRIANGLE)
        paper = (mesh, "--profile", "baseline", "--qu", 12)
        for words, options in (("both", [*paper, "--components", 2]),
                               ("target", [*paper, "--qc", 12, "--components", 2, "--kg", 1]),
                               ("--components", [*paper, "--qc", 12]),
                               ("--components", [mesh, "--profile", "baseline", "--no-rdo"])):
            self.fails(64, words, "rlpcenc", *options, "-o", self.path("out.rlpc"))
        self.refused("m.json", mesh, "--metadata", self.obj("{", "m.json"))

    def test_options_of_the_other_profile(self):
        mesh = self.obj(TRIANGLE)
        for profile, other, options in (
                ("baseline", "main", ("--clusters 2", "--qu 12", "--qc 12", "--qdelta 12",
                                      "--no-rdo", "--rdo-rate vectors", "--frame lcf",
                                      "--seeds spread", "--partition kway",
                                      "--motion plain")),
                ("main", "baseline", ("--bones 2", "--influences 2", "--prediction none",
                                      "--basis-steps cobra", "--no-geometry-weights",
                                      "--no-outer-ring", "--no-layer-steps",
                                      "--no-temporal-weights", "--component-groups 2",
                                      "--layer-groups 2")),
                ("high", "main", ("--adaptive-factors 4", "--rest order", "--track-levels 2",
                                  "--temporal-layers 2"))):
            for option in options:
                self.fails(64, f"{option.split()[0]} needs --profile {profile}", "rlpcenc", mesh,
                           "-o", self.path("out.rlpc"), "--profile", other, *option.split())
        self.fails(64, "--frame needs --profile baseline", "rlpcenc", mesh, "-o",
                   self.path("out.rlpc"), "--frame", "world")  # main is the default
        for options in ("--profile baseline --frame world --no-rdo --components 1",
                        "--no-outer-ring --bones 1"):
            self.ok("rlpcenc", mesh, "-o", self.path("out.rlpc"), *options.split())


class BadOutput(ToolsTest):
    """An output that cannot be completed is not created, and an existing file is kept."""

    def encode_to(self, output, **options):
        return run("rlpcenc", INPUTS / "elephant.obj", "--points", INPUTS / "elephant.pc2", "-o",
                   output, "--kg", 1,
                   "--preset", "fast", **options)

    def expect_untouched(self, result, code, *names):
        self.assertEqual(result.code, code, result.err)
        self.assertEqual(result.err.count("\n"), 1, result.err)
        self.assertEqual(self.files(), sorted(names))

    def test_places_that_cannot_be_written(self):
        self.path("folder").mkdir()
        for output in (self.path("none/a.rlpc"), self.path("folder"), "/dev/full"):
            result = self.encode_to(output)
            self.expect_untouched(result, 1, "folder")
            self.assertIn(str(output), result.err)

    def test_a_full_disk_while_encoding(self):
        for before in (None, b"what was there"):
            if before:
                self.path("a.rlpc").write_bytes(before)
            result = self.encode_to(self.path("a.rlpc"), **limited(2000))
            self.expect_untouched(result, 1, *(["a.rlpc"] if before else []))
            self.assertIn("a.rlpc", result.err)
            if before:
                self.assertEqual(self.path("a.rlpc").read_bytes(), before)

    def test_a_full_disk_while_decoding(self):
        self.assertEqual(self.encode_to(self.path("a.rlpc")).code, 0)
        for output in ("b.rlpd", "b.pc2", "folder", "new/f_%d.obj"):
            result = run("rlpcdec", self.path("a.rlpc"), "-o", self.path(output), **limited(9000))
            self.expect_untouched(result, 4, "a.rlpc")
        result = run("rlpcdec", self.path("a.rlpc"), "-o", "/dev/full")
        self.assertEqual(result.code, 4, result.err)
        result = run("rlpcdec", self.path("a.rlpc"), "-o", self.path("none/b.rlpd"))
        self.expect_untouched(result, 4, "a.rlpc")

    def test_other_files(self):
        result = run("rlpcenc", INPUTS / "elephant.obj", "-o", self.path("b.rlpc"), "--order-map",
                     self.path("none/x"))
        self.assertEqual(result.code, 1, result.err)
        self.assertIn("none/x", result.err)
        self.assertEqual(self.files(), [])  # detected before encoding
        result = run("rlpccmp", INPUTS / "elephant.pc2", INPUTS / "elephant.pc2", "--csv",
                     self.path("none/x"))
        self.assertEqual(result.code, 2, result.err)
        self.assertIn("none/x", result.err)

    def test_a_full_disk_on_standard_output(self):
        self.assertEqual(self.encode_to(self.path("a.rlpc")).code, 0)
        stream, mesh = self.path("a.rlpc"), INPUTS / "elephant.obj"
        for code, command in (
                (4, ["rlpcinfo", stream]), (4, ["rlpcinfo", stream, "--json"]),
                (4, ["rlpcinfo", stream, "--trace"]),
                (4, ["rlpcdec", stream, "--verify", "--json"]),
                (4, ["rlpcval", stream]), (4, ["rlpcval", "--explain", "R-UNT-03"]),
                (2, ["rlpccmp", stream, stream]), (2, ["rlpccmp", stream, stream, "--json"]),
                (1, ["rlpcenc", mesh, "--dry-run"]), (1, ["rlpcenc", mesh, "--dry-run", "--json"])):
            with open("/dev/full", "wb") as full:
                done = subprocess.run([Tools.folder / command[0], *command[1:]], stdout=full,
                                      stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(done.returncode, code, command)
            self.assertIn("standard output: No space left", done.stderr, command)


class BadStreams(ToolsTest):
    """Tests reports of damage; conformance/roundtrip/robustness_test.cpp damages every byte."""

    def setUp(self):
        super().setUp()
        self.encode(self.path("a.rlpc"), "--kg", 1, "--gof", 20)
        self.stream = self.path("a.rlpc").read_bytes()

    def expect(self, code, words, stream):
        bad = self.path("bad.rlpc")
        bad.write_bytes(stream)
        for output in ("x.rlpd", "x.pc2", "folder"):
            self.fails(code, ["bad.rlpc", words], "rlpcdec", bad, "-o", self.path(output))
            self.assertFalse(self.path(output).exists())
        self.fails(code, ["bad.rlpc", words], "rlpcdec", bad, "--verify")
        self.fails(code, "bad.rlpc", "rlpcinfo", bad)
        self.fails(2, "bad.rlpc", "rlpccmp", bad, bad)
        self.assertEqual(self.files(), ["a.rlpc", "bad.rlpc"])

    def test_damage_is_an_error_and_leaves_no_output(self):
        middle, last = len(self.stream) // 2, len(self.stream) - 1
        self.expect(1, "R-", b"")
        self.expect(1, "R-", b"\x89PNG\r\n\x1a\n" + self.stream[8:])
        for size in (4, 9, 20, middle, last):
            self.expect(1, "cut off", self.stream[:size])
        for at in (30, middle, last):
            damaged = bytearray(self.stream)
            damaged[at] ^= 4
            self.expect(1, "R-UNT-03", bytes(damaged))
        self.expect(1, "R-END-02", self.stream + b"\0")
        self.expect(2, "R-STR-02", self.stream[:8] + b"\2" + self.stream[9:])

    def test_pipes_and_what_is_no_file(self):
        info = self.ok("rlpcinfo", self.path("a.rlpc")).out.split(b"\n", 1)[1]
        self.assertEqual(self.ok("rlpcinfo", "-", input=self.stream).out.split(b"\n", 1)[1], info)
        self.ok("rlpcval", "-", input=self.stream)
        cut = self.ok("rlpcinfo", "-", "--extract", "components=0", "-o", "-",
                      input=self.stream).out
        self.ok("rlpcval", "-", input=cut)
        pipe = self.path("pipe")
        os.mkfifo(pipe)
        with subprocess.Popen(["/bin/sh", "-c", f"cat '{self.path('a.rlpc')}' > '{pipe}'"]):
            self.ok("rlpcdec", pipe, "--verify")
        for tool in ("rlpcdec", "rlpcinfo", "rlpcval"):
            verify = ["--verify"] if tool == "rlpcdec" else []
            self.fails(4, "it is a folder", tool, self.folder, *verify)
            self.fails(4, "no such file", tool, self.path("none.rlpc"), *verify)

    def test_any_metadata_can_be_shown(self):
        for text in ('{"a": 1}', "no JSON \x1b[31m", "[" * 100000 + "]" * 100000, '"\\ud800"'):
            self.path("meta.json").write_text('{"a": 1}')
            self.encode(self.path("m.rlpc"), "--metadata", self.path("meta.json"))
            stream = self.path("m.rlpc").read_bytes()
            metadata = struct.pack(">I", len(text)) + zlib.compress(text.encode())
            changed = [(code, metadata if code == METADATA else payload)
                       for code, payload in units_of(stream)]
            self.path("m.rlpc").write_bytes(stream_of(stream, changed))
            shown = self.ok("rlpcinfo", self.path("m.rlpc"), "--json").json()["metadata"]
            self.assertEqual(shown, {"a": 1} if text[0] == "{" else text)
            self.assertNotIn(b"\x1b", self.ok("rlpcinfo", self.path("m.rlpc")).out)

    def test_limits(self):
        for option in (["--max-vertices", 500], ["--max-memory", "50KiB"]):
            self.fails(3, "than the limit (--max-", "rlpcdec", self.path("a.rlpc"), "-o",
                       self.path("x.rlpd"), *option)
        self.assertEqual(self.files(), ["a.rlpc"])
        self.ok("rlpcdec", self.path("a.rlpc"), "--verify", "--max-vertices", 538, "--max-memory",
                "100MiB")

    def test_missing(self):
        for tool, arguments in (("rlpcdec", ["--verify"]), ("rlpcinfo", [])):
            self.fails(4, "none.rlpc", tool, self.path("none.rlpc"), *arguments)
        self.fails(64, "-o OUT", "rlpcdec", self.path("a.rlpc"))


if __name__ == "__main__":
    main()
