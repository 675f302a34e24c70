#!/usr/bin/env python3
"""The resources that the tools use, whatever the input: memory, and bytes written.

    tools_limits_test.py --bin BUILD/bin [unittest arguments, such as Endless]
"""

import itertools
import json
import os
import random
import re
import struct
import subprocess
import threading

from tools_testing import INPUTS, NAMES, Result, Tools, ToolsTest, main, run, write_pc2

MIB = 1 << 20
SIGNATURE = b"\x89RLPC\r\n\x1a"


class MeasuredTest(ToolsTest):
    SLACK = 20 * MIB

    def measured(self, tool, *arguments, feed=None):
        """(result, peak memory of the tool). feed(file) writes its standard input, which the tool
        may close early."""
        out, err = self.path("stdout"), self.path("stderr")
        with open(out, "wb") as stdout, open(err, "wb") as stderr:
            with subprocess.Popen([Tools.folder / tool, *map(str, arguments)], stdout=stdout,
                                  stderr=stderr, stdin=subprocess.PIPE) as running:
                writer = threading.Thread(target=self.write, args=(feed, running.stdin))
                writer.start()
                _, status, usage = os.wait4(running.pid, 0)
                running.returncode = os.waitstatus_to_exitcode(status)
                writer.join()
        done = subprocess.CompletedProcess([], running.returncode, out.read_bytes(),
                                           err.read_bytes())
        return Result(done), usage.ru_maxrss * 1024

    @staticmethod
    def write(feed, pipe):
        try:
            if feed:
                feed(pipe)
            pipe.close()
        except BrokenPipeError:
            pass

    def takes(self, max_growth, code, words, tool, *arguments, feed=None):
        result, memory = self.measured(tool, *arguments, feed=feed)
        self.assertEqual(result.code, code, f"{tool} {arguments}: {result.err}")
        text = result.err + result.out.decode(errors="replace")
        for word in [words] if isinstance(words, str) else words:
            self.assertIn(word, text)
        # The peak of a tool that does nothing, which includes memory of this interpreter.
        usual = self.measured(tool, "--version")[1]
        if b"__asan_init" not in (Tools.folder / tool).read_bytes():  # it needs much itself
            self.assertLess(memory, usual + max_growth + self.SLACK, f"{tool} {arguments}")


def endless(begin, block=bytes(MIB)):
    """Writes up to 2 GB, or until the reader closes the pipe."""
    def feed(pipe):
        pipe.write(begin)
        for _ in range(2000):
            pipe.write(block)
    return feed


class Endless(MeasuredTest):
    """Endless input is refused: at once if it is neither stream nor mesh, otherwise at a limit."""

    def setUp(self):
        super().setUp()
        self.out = self.path("out.rlpc")
        (self.path("clip.obj")).write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")

    def decoders(self, name):
        return (("rlpcdec", name, "--verify"), ("rlpcdec", name, "-o", self.path("out.rlpd")),
                ("rlpcinfo", name), ("rlpcval", name),
                ("rlpcinfo", name, "--extract", "layers=1", "-o", self.out))

    def test_that_is_no_stream(self):
        for command in self.decoders("-"):
            self.takes(0, 1, "R-STR-01", *command, feed=endless(bytes(64)))
        for command in self.decoders("/dev/zero"):
            self.takes(0, 1, "R-STR-01", *command)
        pipe = self.path("pipe")
        os.mkfifo(pipe)
        for command in self.decoders(pipe):
            with subprocess.Popen(["dd", "if=/dev/zero", f"of={pipe}", "bs=1M", "count=2000"],
                                  stderr=subprocess.DEVNULL):
                self.takes(0, 1, "R-STR-01", *command)
        zeros = self.path("zeros.rlpc")
        zeros.symlink_to("/dev/zero")
        self.takes(0, 2, "R-STR-01", "rlpccmp", zeros, zeros)

    def test_that_begins_like_a_stream(self):
        for command in self.decoders("-"):
            self.takes(20 * MIB, 3, "limit", *command, "--max-memory", "20MiB",
                       feed=endless(SIGNATURE))

    def test_what_is_kept_of_a_pipe_counts(self):
        self.encode(self.path("a.rlpc"), "--kg", 1)
        stream = self.path("a.rlpc").read_bytes()
        feed = lambda pipe: pipe.write(stream)  # noqa: E731
        need = 400 * 538 + 120 * 1074  # approximate size of the mesh
        self.takes(0, 3, "limit", "rlpcdec", "-", "--verify", "--max-memory",
                   len(stream) + 1000, feed=feed)
        self.takes(0, 3, "limit", "rlpcdec", "-", "--verify", "--max-memory", len(stream) - 1,
                   feed=feed)
        self.takes(0, 0, "", "rlpcdec", "-", "--verify", "--max-memory",
                   len(stream) + 20 * need, feed=feed)

    def test_that_is_no_mesh(self):
        mesh = self.path("clip.obj")
        for arguments in (["-"], ["-", "--points", mesh], [mesh, "--points", "-"]):
            self.takes(0, 1, "standard input", "rlpcenc", *arguments, "-o", self.out,
                       feed=endless(bytes(64)))
            self.assertFalse(self.out.exists())
        self.takes(0, 2, "standard input", "rlpccmp", "-", mesh, feed=endless(bytes(64)))
        for name in ("/dev/zero", "/dev/null"):
            self.takes(0, 1, name, "rlpcenc", name, "-o", self.out)
            self.takes(0, 1, name, "rlpcenc", mesh, "--points", name, "-o", self.out)

    def test_that_begins_like_a_mesh(self):
        mesh = self.path("clip.obj")
        for begin in (b"ply\n", b"OFF\n", b"# \n", b"glTF", b"{", b"RLPD", b"v 0 0 0\n"):
            for tool, code, last in (("rlpcenc", 1, ["-o", self.out]), ("rlpccmp", 2, [mesh])):
                self.takes(40 * MIB, code, ["standard input", "limit of 20 MiB (--max-memory)"],
                           tool, "-", *last, "--max-memory", "20MiB",
                           feed=endless(begin, b" " * MIB))
        for begin in (b"POINTCACHE2\0", struct.pack(">2i", 1000000000, 3)):
            self.takes(40 * MIB, 1, ["standard input", "limit of 20 MiB (--max-memory)"],
                       "rlpcenc", mesh, "--points", "-", "-o", self.out, "--max-memory", "20MiB",
                       feed=endless(begin))

    def test_small_files_that_are_not(self):
        self.encode(self.path("a.rlpc"), "--kg", 1)
        stream, mesh = self.path("a.rlpc"), self.path("clip.obj")
        zero = self.path("zero.json")
        zero.symlink_to("/dev/zero")
        self.takes(0, 2, "cannot be read", "rlpccmp", stream, stream, "--order-map", zero)
        self.takes(100 * MIB, 4, "cannot read the player", "rlpcdec", stream, "--html",
                   self.path("a.html"), "--player", zero)
        self.path("big.json").write_bytes(b" " * (2 * MIB))
        for name in (zero, self.path("big.json")):
            self.takes(0, 1, "more than 1 MiB", "rlpcenc", mesh, "-o", self.out, "--metadata", name)
        self.path("p.obj").symlink_to("/dev/zero")
        self.takes(0, 4, "p.obj: already exists", "rlpcdec", stream, "-o", self.path("p.pc2"))


class Expansion(ToolsTest):
    """A few bytes can encode millions of positions; limits keep them from being written."""

    def setUp(self):
        super().setUp()
        self.path("m.obj").write_text("v 0 0 0\n" * 100)
        write_pc2(self.path("m.pc2"), [[0.0] * 300] * 1000)
        self.stream = self.path("m.rlpc")
        self.ok("rlpcenc", self.path("m.obj"), "--points", self.path("m.pc2"), "-o", self.stream,
                "--gof", "all", "--preset", "fast", "-q")
        self.before = self.files()

    def test_frames(self):
        for output in (["--verify"], ["-o", self.path("out.pc2")]):
            self.fails(3, "--max-frames", "rlpcdec", self.stream, *output, "--max-frames", 999)
            self.assertEqual(self.files(), self.before)
        self.ok("rlpcdec", self.stream, "--verify", "--max-frames", 1000)

    def test_output(self):
        self.assertLess(self.stream.stat().st_size, 400)
        for output in ("out.rlpd", "out.pc2", "out.mdd", "out", "f_%d.obj", "f_%d.ply"):
            self.fails(3, "--max-output", "rlpcdec", self.stream, "-o", self.path(output),
                       "--max-output", "100KiB")
            self.assertEqual(self.files(), self.before)
        for name in ("rlpd", "glb"):
            done = self.fails(3, "--max-output", "rlpcdec", self.stream, "-o", "-", "--format",
                              name, "--max-output", "1KiB")
            self.assertLessEqual(len(done.out), 1024)
        self.ok("rlpcdec", self.stream, "-o", self.path("out.rlpd"), "--max-output", 1200044)
        self.fails(3, "--max-output", "rlpcdec", self.stream, "-o", self.path("out.rlpd"),
                   "--max-output", 1200043)
        self.assertEqual(self.path("out.rlpd").stat().st_size, 1200044)
        self.ok("rlpcdec", self.stream, "-o", self.path("out.pc2"))  # no limit


class WorstCases(MeasuredTest):
    """Streams at the limits of level 1, with fewer frames and components than make_worst_case
    usually gives them."""

    KINDS = ("cluster", "skinned", "shared-rig", "inter")
    GOF = 4  # unit_type
    NEEDED = re.compile(r"needs at least (\d+) (KiB|MiB) of memory")

    def make(self, kind, *options):
        self.ok("make_worst_case", 1, kind, self.path("a.rlpc"), *options)
        return self.path("a.rlpc")

    def needed(self, stream):
        """The least --max-memory: each refusal says how much is needed so far."""
        estimate = 1
        while True:
            result = run("rlpcdec", stream, "--verify", "--max-memory", estimate)
            if result.code == 0:
                return estimate
            self.assertEqual(result.code, 3, result.err)
            number, unit = self.NEEDED.search(result.err).groups()
            more = int(number) * (1024 if unit == "KiB" else MIB)
            self.assertGreater(more, estimate)
            estimate = more

    def test_take_less_memory_than_estimated(self):
        usual = self.measured("rlpcdec", "--version")[1]
        for kind in self.KINDS:
            stream = self.make(kind, "--frames", 4, "--components", 20)
            self.ok("rlpcval", stream)
            estimate = self.needed(stream)
            self.assertGreater(estimate, 20 * MIB)  # much more than the program itself
            self.fails(3, "--max-memory", "rlpcdec", stream, "--verify", "--max-memory",
                       estimate - MIB)
            result, memory = self.measured("rlpcdec", stream, "--verify", "--threads", 1,
                                           "--max-memory", estimate)
            self.assertEqual(result.code, 0, result.err)
            if b"__asan_init" not in (Tools.folder / "rlpcdec").read_bytes():
                self.assertLess(memory, usual + estimate, kind)

    def refused(self, rule, stream):
        self.fails(1, rule, "rlpcdec", stream, "--verify")
        self.assertIn(rule, run("rlpcval", stream).out.decode())

    def test_one_more_than_the_level_allows(self):
        for kind, what, rule in (("cluster", "vertices", "R-LVL-01"),
                                 ("cluster", "frames", "R-LVL-04"),
                                 ("skinned", "values", "R-LVL-04"),
                                 ("cluster", "factors", "R-LVL-05"),
                                 ("cluster", "clusters", "R-LVL-06"),
                                 ("skinned", "clusters", "R-LVL-06"),
                                 ("shared-rig", "clusters", "R-LVL-06"),
                                 ("shared-rig", "adaptive", "R-LVL-09")):
            with self.subTest(kind=kind, what=what):
                self.refused(rule, self.make(kind, "--frames", 16, "--beyond", what))

    def test_a_unit_larger_than_the_level_allows(self):
        stream = self.make("cluster", "--frames", 1, "--components", 1)
        data = bytearray(stream.read_bytes())
        at = 10
        while data[at] != self.GOF:
            at += 5 + int.from_bytes(data[at + 1:at + 5], "big") + 4
        data[at + 1:at + 5] = (2 ** 25 + 1).to_bytes(4, "big")
        stream.write_bytes(data)
        self.refused("R-LVL-07", stream)

    def noise(self, name, side, frames):
        """Writes a square grid of vertices that have nothing in common in any two frames."""
        random_numbers = random.Random(48)
        with open(self.path(name + ".obj"), "w") as mesh:
            for v in range(side * side):
                mesh.write(f"v {v % side} {v // side} 0\n")
            for a in range(1, side * (side - 1)):
                if a % side:
                    mesh.write(f"f {a} {a + 1} {a + side}\nf {a + 1} {a + side + 1} {a + side}\n")
        write_pc2(self.path(name + ".pc2"),
                  [[random_numbers.random() for _ in range(3 * side * side)]
                   for _ in range(frames)])

    def test_random_motion_is_encoded_within_the_limit(self):
        """Frames without anything in common take most: the largest basis, every kind of GOF. In
        short GOFs, what is fitted to vertices takes more than what is kept of frames."""
        self.noise("long", 50, 50)
        self.noise("short", 50, 4)
        cases = [("long", profile, ()) for profile in ("baseline", "main", "high")]
        cases += [("short", profile, ("--gof", 2)) for profile in ("main", "high")]
        if os.environ.get("RLPC_LONG"):
            cases += [(name, profile, ("--gof", gof, "--preset", preset))
                      for name, gofs in (("long", (1, 10)), ("short", (1, 2, 8)))
                      for gof in gofs for profile in ("main", "high")
                      for preset in ("fast", "medium", "slow")]
        for name, profile, options in cases:
            with self.subTest(name=name, profile=profile, options=options):
                command = ["rlpcenc", self.path(name + ".obj"), "--points",
                           self.path(name + ".pc2"), "-q", "-o", self.path("a.rlpc"), "--profile",
                           profile, *options]
                refused = self.fails(1, ["--max-memory"], *command, "--max-memory", "10MB")
                need = int(re.search(r"may need (\d+) MiB", refused.err)[1])
                result, memory = self.measured(*command, "--max-memory", f"{need}MiB")
                self.assertEqual(result.code, 0, result.err)
                if b"__asan_init" not in (Tools.folder / "rlpcenc").read_bytes():
                    self.assertLess(memory, need * MIB)


class Threads(MeasuredTest):
    """The stream does not depend on the number of threads."""

    def streams(self, counts, *arguments):
        for threads in counts:
            self.ok("rlpcenc", *arguments, "-o", self.path(f"{threads}.rlpc"), "-q", "--threads",
                    threads)
        return {self.path(f"{threads}.rlpc").read_bytes() for threads in counts}

    def test_any_number_gives_the_same_bytes(self):
        settings = (("--preset", "fast", "--gof", 16), ("--preset", "medium"),
                    ("--preset", "medium", "--gof", 8, "--hash", "frame"),
                    ("--preset", "medium", "--profile", "high", "--gof", 16),
                    ("--preset", "medium", "--profile", "baseline"))
        for name, options in zip(itertools.cycle(NAMES), settings):
            inputs = INPUTS / f"{name}.obj", "--points", INPUTS / f"{name}.pc2"
            found = self.streams((1, 3), *inputs, "--kg", 0.3, *options)
            self.assertEqual(len(found), 1, f"{name} {options}")

    def test_fewer_where_memory_is_short(self):
        mesh, cache = self.path("m.obj"), self.path("m.pc2")
        mesh.write_text("".join(f"v {v} 0 0\n" for v in range(1000)))
        write_pc2(cache, [[(v * f % 71) * 0.1 for v in range(3000)] for f in range(400)])
        inputs = mesh, "--points", cache, "--gof", 50, "--preset", "fast"
        self.assertEqual(len(self.streams((1, 8), *inputs)), 1)
        self.takes(80 * MIB, 0, "", "rlpcenc", *inputs, "--max-memory", "80MiB", "--threads", 8,
                   "-o", self.path("8.rlpc"))
        self.assertEqual(self.path("8.rlpc").read_bytes(), self.path("1.rlpc").read_bytes())


class EncoderMemory(MeasuredTest):
    """rlpcenc refuses input that may need more than --max-memory, before allocating it."""

    def refused(self, max_growth, words, *arguments):
        self.takes(max_growth, 1, ["--max-memory", *words], "rlpcenc", *arguments, "-o",
                   self.path("out.rlpc"), "-q")
        self.assertFalse(self.path("out.rlpc").exists())

    def gltf(self, **parts):
        """One triangle, plus what a test adds."""
        self.path("data.bin").write_bytes(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                    "nodes": [{"mesh": 0}],
                    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3,
                                   "type": "VEC3"}],
                    "bufferViews": [{"buffer": 0, "byteLength": 36}],
                    "buffers": [{"uri": "data.bin", "byteLength": 36}], **parts}
        self.path("a.gltf").write_text(json.dumps(document, separators=(",", ":")))
        return self.path("a.gltf")

    def test_instances(self):
        """A small document stands for millions of vertices."""
        primitive = {"attributes": {"POSITION": 0}}
        document = self.gltf(scenes=[{"nodes": list(range(3000))}], nodes=[{"mesh": 0}] * 3000,
                             meshes=[{"primitives": [primitive] * 3000}])
        self.assertLess(document.stat().st_size, 200000)
        self.refused(200 * MIB, ["a.gltf"], document, "--max-memory", "200MiB")

    def test_json(self):
        """Each JSON bracket becomes an object of many bytes."""
        document = self.gltf(extras=[{}] * 2000000)
        self.refused(20 * MIB, ["a.gltf"], document, "--max-memory", "100MiB")

    def test_text(self):
        """Polygons with one character per corner."""
        mesh = self.path("fan.obj")
        mesh.write_text("v 0 0 0\n" * 3 + "f" + " 1" * 10000000 + "\n")
        self.refused(100 * MIB, ["fan.obj:4"], mesh, "--max-memory", "100MiB")
        self.refused(0, ["fan.obj"], mesh, "--max-memory", "10MiB")

    def test_frames(self):
        mesh, cache = self.path("m.obj"), self.path("m.pc2")
        mesh.write_text("".join(f"v {v} 0 0\n" for v in range(1000)))
        write_pc2(cache, [[0.0] * 3000] * 1000)
        self.refused(0, ["a smaller --gof needs less".capitalize()], mesh, "--points", cache,
                     "--gof", "all", "--max-memory", "150MiB")
        self.takes(150 * MIB, 0, "", "rlpcenc", mesh, "--points", cache, "--gof", 20,
                   "--preset", "fast", "--max-memory", "150MiB", "-o", self.path("out.rlpc"))

    def test_default(self):
        self.clip(2)
        self.ok("rlpcenc", self.path("clip.obj"), "-o", self.path("out.rlpc"))
        for tool in ("rlpcenc", "rlpccmp", "rlpcdec", "rlpcinfo", "rlpcval"):
            self.assertIn(b"--max-memory", self.ok(tool, "--help-all").out)
        self.assertIn(b"32GiB", self.ok("rlpcenc", "--help-all").out)


if __name__ == "__main__":
    main()
