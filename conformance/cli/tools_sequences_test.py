#!/usr/bin/env python3
"""Sequences of mesh files, and what is said of an input that a stream does not carry.

    tools_sequences_test.py --bin BUILD/bin [unittest arguments, such as Sequences]
"""

import struct

from tools_testing import ToolsTest, main, read_pc2, run

FACES = "f 1 2 3\nf 3 2 4\n"


def mesh(x, faces=FACES, more=""):
    return f"v {x} 0 0\nv {x + 1} 0 0\nv {x} 1 0\nv {x + 1} 1 0\n{more}{faces}"


class Sequences(ToolsTest):
    def put(self, names, **options):
        """Frames that move along x; returns the folder."""
        folder = self.path("frames")
        folder.mkdir(exist_ok=True)
        for x, name in enumerate(names):
            (folder / name).write_text(mesh(x, **options))
        return folder

    def positions(self, *inputs):
        """The smallest x of each decoded frame, rounded."""
        stream, decoded = self.path("a.rlpc"), self.path("a.pc2")
        self.ok("rlpcenc", *inputs, "-o", stream, "--kg", 0.01)
        self.ok("rlpcdec", stream, "-o", decoded)
        return [round(min(frame[::3])) for frame in read_pc2(decoded)]

    def test_frames_are_in_the_order_of_their_numbers(self):
        for names in (["sim.-002.obj", "sim.-001.obj", "sim.0000.obj", "sim.0001.obj"],
                      ["f_1.obj", "f_1.25.obj", "f_1.5.obj", "f_2.obj"],
                      ["a_v003.998.m01.obj", "a_v003.999.m01.obj", "a_v003.1000.m01.obj"]):
            folder = self.put(names)
            wanted = list(range(len(names)))
            self.assertEqual(self.positions(folder), wanted)
            self.assertEqual(self.positions(f"{folder}/*.obj"), wanted)
            files = sorted(folder.iterdir())
            self.assertEqual(self.positions(*files), wanted)
            for file in files:
                file.unlink()
        folder = self.put(["sim.-002.obj", "sim.-001.obj", "sim.0000.obj", "sim.0001.obj"])
        self.assertEqual(self.positions(folder / "sim.%04d.obj"), [0, 1, 2, 3])

    def test_times_are_in_order_or_refused_with_both_orders(self):
        for pattern in ("t={}.obj", "v2_{}.obj"):
            names = [pattern.format(round(i / 24, 6)) for i in range(8)]
            folder = self.put(names)
            self.assertEqual(self.positions(folder), list(range(8)))
            for name in names:
                (folder / name).unlink()
        folder = self.put([f"f-{3 - i / 5:.2f}.obj" for i in range(6)])
        out = self.path("out.rlpc")
        said = self.fails(1, "two orders", "rlpcenc", folder, "-o", out).err
        self.assertFalse(out.exists())
        for pattern, order in (("f%g.obj", [0, 1, 2, 3, 4, 5]), ("f-%g.obj", [5, 4, 3, 2, 1, 0])):
            self.assertIn(str(folder / pattern), said)
            self.assertEqual(self.positions(folder / pattern), order)

    def test_patterns_take_signs_and_runs_and_tell_what_they_leave_out(self):
        folder = self.put(["f_-2.obj", "f_-1.obj", "f_+0.obj", "f_+1.obj"])
        self.assertEqual(self.positions(folder / "f_%d.obj"), [0, 1, 2, 3])
        (folder / "f_0.5.obj").write_text(mesh(9))
        self.assertIn("1 file is left out", self.ok("rlpcenc", folder / "f_%d.obj", "-o",
                                                    self.path("a.rlpc"), "--quiet").err)
        self.put(["g_0000.obj", "g_0001.obj"])
        self.assertEqual(self.positions(folder / "g_####.obj"), [0, 1])
        self.fails(1, "write %04d", "rlpcenc", folder / "g_%4d.obj", "-o", self.path("a.rlpc"))
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("h_##.obj"))
        self.assertTrue(self.path("h_01.obj").exists())
        self.fails(64, "write %04d", "rlpcdec", self.path("a.rlpc"), "-o",
                   self.path("h_%4d.obj"))

    def test_what_is_no_frame_is_an_error_that_says_how_to_choose(self):
        folder = self.put(["f_0000.obj", "f_0001.obj", "f_0002.obj"])
        (folder / "restpose.obj").write_text(mesh(9))
        said = self.fails(1, "restpose.obj", "rlpcenc", folder, "-o", self.path("a.rlpc")).err
        self.assertFalse(self.path("a.rlpc").exists())
        self.assertIn("f_%04d.obj", said)
        self.assertEqual(self.positions(folder / "f_%04d.obj"), [0, 1, 2])
        self.fails(64, "several INPUTs", "rlpcenc", folder / "f_0000.obj", folder / "f_0001.obj",
                   "--points", "a.pc2", "-o", self.path("a.rlpc"))
        self.fails(64, "is also an input", "rlpcenc", folder / "f_0000.obj",
                   folder / "f_0001.obj", "-o", folder / "f_0001.obj")

    def test_losses_are_told_even_when_quiet(self):
        self.put(["f_0.obj", "f_1.obj"], more="l 1 2\n")
        encode = ["rlpcenc", self.path("frames"), "-o", self.path("a.rlpc"), "--kg", 1]
        self.assertIn("dropped: lines (1)", self.ok(*encode, "--quiet").err)
        self.put(["f_0.obj", "f_1.obj", "f_5.obj"])
        self.assertIn("the gap is closed", self.ok(*encode).err)
        self.assertEqual(self.ok(*encode, "--quiet").err, "")

    def test_a_pipe_tells_its_losses(self):
        self.path("m.obj").write_text(mesh(0))
        cache = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 4, 7.0, 1.0, 1) + bytes(48)
        cache += struct.pack("<12f", *(float(i % 5) for i in range(12)))
        result = run("rlpcenc", self.path("m.obj"), "--points", "-", "-o", self.path("a.rlpc"),
                     "--profile", "high", "--low-delay", "--kg", 1, "--quiet", input=cache)
        self.assertIn("start 7", result.err)

    def test_collapsed_edges_are_no_measure_of_what_is_seen(self):
        # A sheet, and three times as many triangles that are points.
        for f in range(3):
            text = "".join(f"v {x} {y} {0.2 * f * (x % 3)}\n" for x in range(8) for y in range(8))
            faces = "".join(f"f {8 * x + y + 1} {8 * x + y + 2} {8 * x + y + 9}\n"
                            for x in range(7) for y in range(7))
            for i in range(150):
                text += f"v 3 3 {1e-5 * (i % 2)}\n" * 3
                faces += f"f {65 + 3 * i} {66 + 3 * i} {67 + 3 * i}\n"
            self.path(f"c_{f}.obj").write_text(text + faces)
        result = self.ok("rlpcenc", self.path("c_%d.obj"), "-o", self.path("a.rlpc"), "--json")
        self.assertNotIn("may be visible", result.err)
        self.assertGreater(result.json()["visibility"]["median_edge_length"], 0.5)

    def test_advice_is_what_helps(self):
        folder = self.path("frames")
        folder.mkdir()
        for f in range(12):
            rows = "".join(f"v {i % 8} {i // 8} {((i * 7919 + f * f * 104729) % 97) / 40}\n"
                           for i in range(64))
            faces = "".join(f"f {8 * y + x + 1} {8 * y + x + 2} {8 * y + x + 9}\n"
                            for x in range(7) for y in range(7))
            (folder / f"n{f}.obj").write_text(rows + faces)
        options = ["--profile", "baseline", "--clusters", 2, "--gof", "all"]
        for components, bits, advice in ((1, 12, "Try more --components"),
                                         (12, 3, "Try larger --qu and --qc")):
            said = self.ok("rlpcenc", folder, "-o", self.path("a.rlpc"), *options, "--components",
                           components, "--qu", bits, "--qc", bits, "--qdelta", 12, "--no-rdo").err
            self.assertIn(advice, said)


if __name__ == "__main__":
    main()
