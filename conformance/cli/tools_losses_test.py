#!/usr/bin/env python3
"""Tests that notes report the contents of inputs that streams lose, with right figures; the rest
comes back."""

import math
import random
import re
import struct

from tools_testing import ToolsTest, main, run, write_pc2

SIDE = 4
CORNERS = [a for j in range(SIDE - 1) for a in range(j * SIDE, (j + 1) * SIDE - 1)]
FACES = ([(a, a + 1, a + SIDE) for a in CORNERS]
         + [(a + 1, a + SIDE + 1, a + SIDE) for a in CORNERS])
SHEET = "".join(f"v {i % SIDE} {i // SIDE} 0\n" for i in range(SIDE * SIDE))


def sheet(corner, lines=""):
    """A flat sheet whose corners `corner` describes, {v} being the number of the vertex."""
    return SHEET + lines + "".join("f " + " ".join(corner.format(v=v + 1) for v in face) + "\n"
                                   for face in FACES)


class Losses(ToolsTest):
    def put(self, name, text):
        path = self.path(name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def encode_file(self, path, *options):
        return self.ok("rlpcenc", path, "-o", self.path("a.rlpc"), "-q", *options)

    def decoded_lines(self, keyword, *options):
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("b.obj"), "--quiet", *options)
        return [line.split()[1:] for line in self.path("b.obj").read_text().splitlines()
                if line.startswith(keyword + " ")]

    def test_one_far_texture_coordinate_leaves_the_others_where_they_are(self):
        draw = random.Random(1)
        for far in (1000, 100000, -1e9):
            uv = [(draw.random(), draw.random()) for _ in range(SIDE * SIDE)]
            uv[5] = (0.5, far)
            lines = "".join(f"vt {u} {v}\n" for u, v in uv)
            self.encode_file(self.put("m.obj", sheet("{v}/{v}", lines)), "--keep-order")
            found = [tuple(map(float, words)) for words in self.decoded_lines("vt")]
            for u, v in uv[:5] + uv[6:]:
                self.assertLess(min(math.hypot(u - x, v - y) for x, y in found), 2 / 1024, far)

    def test_normals_that_turn_on_a_still_sheet(self):
        """In any frame, also a single one."""
        for turned in ((1, 2), (3,), (5,)):
            degrees = {f: 40 * (1 + turned.index(f)) for f in turned}
            for f in range(6):
                a = math.radians(degrees.get(f, 0))
                self.put(f"n{turned[0]}/f_{f}.obj",
                         sheet("{v}//{v}", f"vn {math.sin(a)} 0 {math.cos(a)}\n" * SIDE * SIDE))
            said = self.encode_file(self.path(f"n{turned[0]}")).err
            worst = max(degrees, key=degrees.get)
            found = re.search(r"normals are off by ([\d.]+) degrees on average in frame (\d+)",
                              said)
            self.assertTrue(found, said)
            self.assertEqual(int(found[2]), worst)
            self.assertAlmostEqual(float(found[1]), degrees[worst], delta=1)
        live = self.ok("rlpcenc", self.path("n1"), "-o", self.path("a.rlpc"), "--low-delay",
                       "--profile", "high")
        self.assertIn("compares only the normals of the first frame", live.err)

    def test_exact_texture_coordinates_are_written_as_they_were(self):
        draw = random.Random(2)
        texts = ["0.0000034", "0.1", "0.7", "1", "0", "0.333333"] + [
            f"{draw.random():.6f}".rstrip("0") for _ in range(SIDE * SIDE - 6)]
        lines = "".join(f"vt 0.5 {v}\n" for v in texts)
        self.encode_file(self.put("m.obj", sheet("{v}/{v}", lines)), "--exact-attributes",
                         "--keep-order")
        found = {float(v) for _, v in self.decoded_lines("vt")}
        self.assertEqual(found, {float(v) for v in texts})

    def test_exact_normals_and_colours_have_all_their_digits(self):
        draw = random.Random(4)
        colours = [[draw.randrange(1000000) / 1e6 for _ in range(3)] for _ in range(SIDE * SIDE)]
        normals = []
        for _ in range(SIDE * SIDE):
            n = [draw.uniform(-0.5, 0.5), draw.uniform(-0.5, 0.5), 1]
            normals.append([x / math.hypot(*n) for x in n])
        text = sheet("{v}//{v}", "".join("vn {} {} {}\n".format(*n) for n in normals))
        for v, colour in enumerate(colours):
            place = f"v {v % SIDE} {v // SIDE} 0\n"
            text = text.replace(place, place[:-1] + " {} {} {}\n".format(*colour), 1)
        self.encode_file(self.put("m.obj", text), "--exact-attributes", "--keep-order")
        found = [[float(x) for x in words[3:]] for words in self.decoded_lines("v")]
        for colour, decoded in zip(colours, found):
            for x, y in zip(colour, decoded):
                self.assertAlmostEqual(x, y, delta=3e-7)
        found = [list(map(float, words)) for words in self.decoded_lines("vn")]
        for normal in normals:
            nearest = max(found, key=lambda n: sum(x * y for x, y in zip(n, normal)))
            self.assertLess(math.dist(nearest, normal), 4.5e-5)  # half a step of 16 bits

    def test_bounds_of_a_box_are_checked(self):
        mesh = self.put("m.obj", sheet("{v}"))
        for box, words in (("0,0,0,1,-1,1", "smallest y is above the largest"),
                           ("0,0,inf,1,1,1", "not finite"), ("nan,0,0,1,1,1", "not finite"),
                           ("0,0,0,-1e30,1,1", "smallest x")):
            result = self.fails(64, ("--box", words), "rlpcenc", mesh, "-o", self.path("b.rlpc"),
                                "--low-delay", "--profile", "high", "--box", box)
            self.assertFalse(self.path("b.rlpc").exists(), result.err)

    def test_advice_to_move_an_animation_to_the_origin_where_it_is_far_from_it(self):
        draw = random.Random(3)
        for offset in (0, 1e6):
            frames = [[c for y in range(SIDE) for x in range(SIDE)
                       for c in (x + offset + draw.random(), y + draw.random(), draw.random())]
                      for _ in range(6)]
            mesh = self.put("m.obj", sheet("{v}"))
            write_pc2(self.path("m.pc2"), frames)
            done = run("rlpcenc", mesh, "--points", self.path("m.pc2"), "-o", self.path("c.rlpc"),
                       "--kg", 1e-5)
            self.assertEqual("from the origin" in done.err, offset > 0, done.err)

    def test_rlpccmp_says_what_is_rounding_alone(self):
        for lossless, words in ((True, True), (False, False)):
            text = "".join(f"v {1 + i % SIDE / 10} {1 + i // SIDE / 10} 0\n"
                           for i in range(SIDE * SIDE))
            mesh = self.put("m.obj", sheet("{v}").replace(SHEET, text))
            quality = ["--lossless", "--profile", "high"] if lossless else ["--kg", 1]
            self.encode_file(mesh, *quality, "--keep-order")
            out = self.ok("rlpccmp", mesh, self.path("a.rlpc")).out.decode()
            self.assertEqual("is the float nearest" in out, words, out)

    def test_generators_are_noted_unless_quiet(self):
        positions = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
        self.path("m.bin").write_bytes(positions)
        mesh = self.put("m.gltf", """{
            "asset":{"version":"2.0","generator":"X"},"scenes":[{"nodes":[0]}],
            "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
            "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",
                          "min":[0,0,0],"max":[1,1,0]}],
            "bufferViews":[{"buffer":0,"byteLength":36}],
            "buffers":[{"byteLength":36,"uri":"m.bin"}]}""")
        self.assertEqual(self.encode_file(mesh).err, "")
        self.assertIn("asset.generator", self.ok("rlpcenc", mesh, "-o", self.path("a.rlpc")).err)


if __name__ == "__main__":
    main()
