#!/usr/bin/env python3
"""Streams that are encoded and decoded while their frames are made.

    tools_live_test.py --bin BUILD/bin [unittest arguments, such as Live]
"""

import os
import struct
import subprocess
import time

from tools_testing import INPUTS, Tools, ToolsTest, main, read_pc2, run

MESH = INPUTS / "elephant.obj"
OPTIONS = ("--profile", "high", "--low-delay")
HEADER = 32  # bytes of a PC2 file before its frames


class Live(ToolsTest):
    def setUp(self):
        super().setUp()
        data = (INPUTS / "elephant.pc2").read_bytes()
        self.num_vertices, _, _, self.num_frames = struct.unpack("<iffi", data[16:32])
        size = 12 * self.num_vertices
        self.head = data[:28] + struct.pack("<i", 0)  # the number of frames is not known
        self.frames = [data[HEADER + f * size:HEADER + (f + 1) * size]
                       for f in range(self.num_frames)]

    def encode_pipe(self, data, *options, points=True, code=0):
        words = ([MESH, "--points", "-"] if points else ["-"])
        done = run("rlpcenc", *words, *OPTIONS, *options, input=data)
        self.assertIn(done.code, (code, 2) if code == 0 else (code,), done.err)  # 2: target missed
        return done

    def test_a_frame_comes_out_before_the_next_goes_in(self):
        encoder = subprocess.Popen(
            [Tools.folder / "rlpcenc", MESH, "--points", "-", "-o", "-", *OPTIONS, "--kg", "0.5"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        decoder = subprocess.Popen(
            [Tools.folder / "rlpcdec", "-", "-o", "-", "--format", "pc2", "--quiet"],
            stdin=encoder.stdout, stdout=subprocess.PIPE)
        encoder.stdout.close()
        self.addCleanup(decoder.stdout.close)
        os.set_blocking(decoder.stdout.fileno(), False)
        out, max_lag = b"", 0
        encoder.stdin.write(self.head)
        for number, frame in enumerate(self.frames[:6]):
            encoder.stdin.write(frame)
            encoder.stdin.flush()
            # The next frame is not sent before this one has come out.
            deadline = time.monotonic() + 60
            while len(out) < HEADER + (number + 1) * len(frame):
                self.assertLess(time.monotonic(), deadline, f"frame {number} does not come out")
                out += decoder.stdout.read() or b""
                time.sleep(0.005)
            max_lag = max(max_lag, number + 1 - (len(out) - HEADER) // len(frame))
        self.assertEqual(max_lag, 0)
        encoder.stdin.close()
        self.assertEqual(encoder.wait(), 0)
        self.assertEqual(decoder.wait(), 0)
        self.assertEqual(out[:28], self.head[:28])

    def test_pipes_of_either_format(self):
        stream, again = self.path("a.rlpc"), self.path("b.rlpc")
        self.encode_pipe(self.head + b"".join(self.frames), "-o", stream, "--kg", 0.5)
        info = self.ok("rlpcinfo", stream, "--json").json()
        self.assertTrue(info["open_ended"])
        self.assertEqual(info["num_frames"], self.num_frames)
        self.ok("rlpcval", stream)
        said = self.ok("rlpcdec", stream, "--verify").err
        self.assertIn(f"{self.num_frames} frames", said)
        self.assertIn("hashes agree", said)
        decoded = self.path("a.rlpd")
        self.ok("rlpcdec", stream, "-o", decoded)
        self.encode_pipe(decoded.read_bytes(), "-o", again, "--lossless", 12, points=False)
        self.assertEqual(self.ok("rlpcinfo", again, "--json").json()["num_frames"], self.num_frames)

    def test_gofs_of_any_length_and_seeking(self):
        stream = self.path("a.rlpc")
        self.encode_pipe(self.head + b"".join(self.frames[:25]), "-o", stream, "--gof", 10)
        gofs = self.ok("rlpcinfo", stream, "--json").json()["gofs"]
        self.assertEqual([gof["num_frames"] for gof in gofs], [10, 10, 5])
        self.ok("rlpcdec", stream, "-o", self.path("all.pc2"))
        every = read_pc2(self.path("all.pc2"))
        for frame in (0, 9, 10, 17, 24):
            part = self.path(f"{frame}.pc2")
            self.ok("rlpcdec", stream, "-o", part, "--frames", f"{frame}-{frame}")
            self.assertEqual(read_pc2(part), every[frame:frame + 1])
        self.fails(3, "open_end_flag: more frames than the limit (--max-frames 100)", "rlpcdec",
                   stream, "--verify", "--max-frames", 100)
        self.fails(64, "within 0-24", "rlpcdec", stream, "-o", self.path("x.pc2"), "--frames",
                   "25-")

    def test_a_known_number_of_frames_gives_no_open_end(self):
        stream = self.path("a.rlpc")
        self.ok("rlpcenc", MESH, "--points", INPUTS / "elephant.pc2", "-o", stream, *OPTIONS)
        self.assertFalse(self.ok("rlpcinfo", stream, "--json").json()["open_ended"])
        self.ok("rlpcdec", stream, "--verify")

    def test_the_largest_error_is_kept(self):
        stream = self.path("a.rlpc")
        said = self.ok("rlpcenc", MESH, "--points", INPUTS / "elephant.pc2", "-o", stream, *OPTIONS,
                       "--max-error", 0.01, "--json").json()
        self.assertTrue(said["target_met"])
        self.assertLess(said["metrics"]["max_error"], 0.01)
        self.assertGreater(said["metrics"]["max_error"], 0.004)

    def test_a_producer_that_dies_within_a_frame(self):
        stream = self.path("a.rlpc")
        data = self.head + b"".join(self.frames[:7]) + self.frames[7][:100]
        done = self.encode_pipe(data, "-o", stream, code=1)
        self.assertIn("ends within frame 7 (from 0), after 100 of its", done.err)
        self.assertIn("The stream ends with the 7 frames before", done.err)
        self.assertEqual(self.ok("rlpcinfo", stream, "--json").json()["num_frames"], 7)
        self.ok("rlpcval", stream)
        self.ok("rlpcdec", stream, "--verify")

    def test_a_frame_that_is_not_a_number(self):
        stream = self.path("a.rlpc")
        bad = bytearray(self.frames[5])
        struct.pack_into("<f", bad, 12 * 3 + 4, float("nan"))
        many = self.frames[:5] * 200
        done = self.encode_pipe(self.head + b"".join(many) + bad + self.frames[6], "-o", stream,
                                "--kg", 2, code=1)
        self.assertIn("frame 1000 (from 0), vertex 3: y is nan", done.err)
        self.assertEqual(self.ok("rlpcinfo", stream, "--json").json()["num_frames"], 1000)
        self.ok("rlpcdec", stream, "--verify")

    def test_frames_that_leave_the_box(self):
        stream = self.path("a.rlpc")
        moved = struct.pack(f"<{3 * self.num_vertices}f", *[1e6] * (3 * self.num_vertices))
        done = self.encode_pipe(self.head + self.frames[0] + moved, "-o", stream, code=1)
        self.assertIn("outside the box announced", done.err)
        self.assertIn("see --box", done.err)
        self.assertEqual(self.ok("rlpcinfo", stream, "--json").json()["num_frames"], 1)
        wide = self.path("b.rlpc")
        self.encode_pipe(self.head + self.frames[0] + moved, "-o", wide, "--max-error", 1, "--box",
                         "-2e6,-2e6,-2e6,2e6,2e6,2e6")
        self.assertEqual(self.ok("rlpcinfo", wide, "--json").json()["num_frames"], 2)

    def test_input_that_is_none(self):
        out = self.path("a.rlpc")
        wrong = self.head[:16] + struct.pack("<i", self.num_vertices + 1) + self.head[20:]
        for data, words in ((b"", "ends before its first frame"),
                            (self.head, "has no frames"),
                            (b"x" * 40, "does not begin with POINTCACHE2"),
                            (wrong + self.frames[0], "points per frame, but"),
                            (self.head + self.frames[0][:-1], "ends within frame 0")):
            done = self.encode_pipe(data, "-o", out, code=1)
            self.assertIn(words, done.err)
            self.assertFalse(out.exists())
        done = self.encode_pipe(b"RLPD" + bytes(40), "-o", out, points=False, code=1)
        self.assertIn("version 0", done.err)

    def test_a_stream_that_is_cut_off(self):
        stream, cut = self.path("a.rlpc"), self.path("b.rlpc")
        self.encode_pipe(self.head + b"".join(self.frames[:9]), "-o", stream)
        data = stream.read_bytes()
        cut.write_bytes(data[:-40])
        done = run("rlpcdec", "-", "-o", "-", "--format", "pc2", input=cut.read_bytes())
        self.assertEqual(done.code, 1)
        frames = (len(done.out) - HEADER) // len(self.frames[0])
        self.assertIn(frames, (8, 9))
        self.fails(1, "is unknown. Write .rlpd", "rlpcdec", cut, "-o", self.path("x.pc2"))
        self.assertFalse(self.path("x.pc2").exists())

    def units(self, data):
        """(type, start, end) of the units."""
        found, at = [], 10
        while at < len(data):
            size = 9 + int.from_bytes(data[at + 1:at + 5], "big")
            found.append((data[at], at, at + size))
            at += size
        return found

    def conceal(self, data, options, code=1):
        """Returns the messages of rlpcdec, and the frames."""
        stream, out = self.path("d.rlpc"), self.path("d.pc2")
        stream.write_bytes(data)
        done = run("rlpcdec", stream, "-o", out, "--conceal", *options)
        self.assertEqual(done.code, code, done.err)
        return done.err, read_pc2(out)

    def test_damage_is_concealed_up_to_the_next_gof(self):
        stream = self.path("a.rlpc")
        self.encode_pipe(self.head + b"".join(self.frames[:30]), "-o", stream, "--gof", 10)
        data = stream.read_bytes()
        self.ok("rlpcdec", stream, "-o", self.path("a.pc2"))
        good = read_pc2(self.path("a.pc2"))
        frames = [unit for unit in self.units(data) if unit[0] == 8]
        gofs = [unit for unit in self.units(data) if unit[0] == 4]
        _, start, end = frames[13]  # in the second GOF
        damaged = bytearray(data)
        damaged[end - 1] ^= 1
        self.fails(1, "R-UNT-03", "rlpcdec", self.write("x.rlpc", damaged), "-o",
                   self.path("x.pc2"))
        for threads in ((), ("--threads", 3)):
            said, found = self.conceal(damaged, threads)
            self.assertIn("frames 13 to 19 are lost, and repeat the one before", said)
            self.assertEqual(found, good[:13] + 7 * [good[12]] + good[20:])
            said, found = self.conceal(data[:start] + data[end:], threads)  # lost on the way
            self.assertIn("R-FRM-03", said)
            self.assertEqual(found, good[:13] + 7 * [good[12]] + good[20:])
            said, found = self.conceal(data[:gofs[1][1]] + data[gofs[1][2]:], threads)
            self.assertIn("frames 10 to 19 are lost", said)
            self.assertEqual(found, good[:10] + 10 * [good[9]] + good[20:])
        last = bytearray(data)
        last[frames[25][2] - 1] ^= 1
        said, found = self.conceal(last, ())
        self.assertIn("frames 25 to 29 are lost", said)
        self.assertEqual(found, good[:25] + 5 * [good[24]])
        first = bytearray(data)
        first[frames[0][2] - 1] ^= 1
        self.fails(1, "R-UNT-03", "rlpcdec", self.write("y.rlpc", first), "-o", self.path("y.pc2"),
                   "--conceal")

    def test_damage_in_other_gofs_is_concealed_as_well(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--kg", 1, "--gof", 20)
        data = bytearray(stream.read_bytes())
        self.ok("rlpcdec", stream, "-o", self.path("a.pc2"))
        good = read_pc2(self.path("a.pc2"))
        data[[unit for unit in self.units(data) if unit[0] == 4][1][2] - 1] ^= 1
        gof = self.ok("rlpcinfo", stream, "--json").json()["gofs"][1]
        first, end = gof["first_frame"], gof["first_frame"] + gof["num_frames"]
        for threads in ((), ("--threads", 3)):
            said, found = self.conceal(data, threads)
            self.assertIn(f"frames {first} to {end - 1} are lost", said)
            self.assertEqual(found, good[:first] + (end - first) * [good[first - 1]] + good[end:])

    def write(self, name, data):
        self.path(name).write_bytes(data)
        return self.path(name)

    def test_settings_that_contradict(self):
        for options, words in ((("--bpvf", 3), "a rate cannot be searched for"),
                               (("--frame-pattern", "dyadic:4"), "coded in their order"),
                               (("--gof-kind", "skinned"), "needs inter GOFs"),
                               (("--lossless",), "needs a number of bits"),
                               (("--dry-run",), "excludes")):
            code = 1 if options == ("--lossless",) else 64
            self.fails(code, words, "rlpcenc", MESH, "--points", INPUTS / "elephant.pc2", *OPTIONS,
                       *options, *(() if "--dry-run" in options else ("-o", self.path("a.rlpc"))))
        self.fails(64, "needs --profile high", "rlpcenc", MESH, "--low-delay", "-o",
                   self.path("a.rlpc"))
        self.fails(64, "--box needs --low-delay", "rlpcenc", MESH, "--box", "0,0,0,1,1,1", "-o",
                   self.path("a.rlpc"))


if __name__ == "__main__":
    main()
