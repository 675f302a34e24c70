#!/usr/bin/env python3
"""Attributes and assets in node: those of rlpcdec.

  attributes_test.py --bin FOLDER [Attributes]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import base64
import hashlib
import json
import math
import pathlib
import re
import struct
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "player"))
import textured_box
from player_testing import (PACKAGE, STREAMS, InFolder, main, need_node,
                            need_player, run)

DOMAINS = ("vertex", "corner", "triangle")
KINDS = ("integers", "unitVectors", "floats", "smoothing")
SUITE = STREAMS / "v1.2"


def sha256(words):
    return hashlib.sha256(struct.pack(f"<{len(words)}I", *words)).hexdigest()


def float_bits(number):
    try:
        return struct.unpack("<I", struct.pack("<f", number))[0]
    except OverflowError:
        return float_bits(math.copysign(math.inf, number))


class Rlpa:
    """The sets of an OUT.rlpa (F.9). It does not say whether unit vectors have faces: `told`, sets
    of the same stream, decides."""

    def __init__(self, data, told):
        self.data, self.at = data, 4
        _, _, self.triangles, count = self.words(4)
        self.sets = [self.set(one) for one in told[:count]]
        self.is_whole = self.at == len(data)

    def words(self, count, kind="I"):
        values = struct.unpack_from(f"<{count}{kind}", self.data, self.at)
        self.at += 4 * count
        return values

    def set(self, told):
        size, = self.words(1)
        name = self.data[self.at:self.at + size].decode()
        self.at += (size + 3) // 4 * 4
        domain, kind, scale, _, components, bits = self.words(6)
        step, = self.words(1, "i")
        origin = self.words(components, "i")
        count, = self.words(1)
        one = {"name": name, "domain": DOMAINS[domain], "kind": KINDS[kind], "count": count,
               "components": 3 if kind == 1 else components}
        if domain == 1:
            one["corners"] = sha256(self.words(3 * self.triangles))
        start = self.at
        values = self.words(count * components)
        if kind == 3 or kind == 1 and sha256(values) != told["integers"]:
            self.at = start + 4 * self.triangles
            values = self.words(count * components)
        one["integers"] = sha256(values)
        one["values"] = self.numbers(kind, scale, step, origin, bits, values)
        return one

    @staticmethod
    def numbers(kind, scale, step, origin, bits, values):
        """Bits of the floats (F.3, F.8.4)."""
        if kind == 1:
            half = 2 ** (bits - 1) - 1
            return [float_bits(x) for i in range(0, len(values), 2)
                    for x in Rlpa.vector(values[i] - half, values[i + 1] - half, half)]
        if kind == 2:
            return list(values)
        if scale == 1:
            values = [math.ldexp(value + origin[i % len(origin)], step)
                      for i, value in enumerate(values)]
        elif scale == 2:
            values = [value / (2**bits - 1) for value in values]
        return [float_bits(value) for value in values]

    @staticmethod
    def vector(x, y, half):
        z = half - abs(x) - abs(y)
        if z < 0:
            x, y = (c + (-z if c < 0 else z) for c in (x, y))
        length = math.sqrt(x * x + y * y + z * z)
        return x / length, y / length, z / length


class Attributes(InFolder):
    """Streams of the suite and of the encoder."""

    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        super().setUpClass()

    def in_node(self, streams):
        done = subprocess.run(["node", HERE / "testing" / "attributes.mjs", PACKAGE, *streams],
                              capture_output=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return [json.loads(line) for line in done.stdout.splitlines()]

    def native(self, stream, told):
        """The sets that rlpcdec decodes."""
        out = self.folder / "out.rlpa"
        run("rlpcdec", "decode", stream, out)
        rlpa = Rlpa(out.read_bytes(), told)
        self.assertTrue(rlpa.is_whole)
        return rlpa.sets

    def test_the_streams_of_the_suite(self):
        streams = sorted((SUITE / "accept" / "ATT").glob("*.rlpc"))
        self.assertGreater(len(streams), 30)
        kinds = set()
        for stream, told in zip(streams, self.in_node(streams)):
            with self.subTest(stream=stream.name):
                self.assertNotIn("error", told)
                self.assertEqual(told["sets"], self.native(stream, told["sets"]))
                kinds.update((one["domain"], one["kind"]) for one in told["sets"])
        self.assertEqual(len(kinds), 11)  # all that there are

    def test_clips_end_with_the_stream(self):
        streams = sorted((SUITE / "accept" / "CLP").glob("*.rlpc"))
        for stream, told in zip(streams, self.in_node(streams)):
            info = json.loads(run("rlpcinfo", stream, "--json").stdout)
            clips = [(c["name"], c["first_frame"], c["num_frames"]) for c in info["clips"]
                     if c["first_frame"] < info["num_frames"]]
            found = [(c["name"], c["firstFrame"], c["frames"]) for c in told["clips"]]
            self.assertEqual((found, told["numFrames"]), (clips, info["num_frames"]), stream)

    def test_damaged_attributes_and_assets(self):
        streams = sorted(stream for area in ("ATT", "AST")
                         for stream in (SUITE / "either" / area).glob("*.rlpc"))
        errors = 0
        for stream, told in zip(streams, self.in_node(streams)):
            expected = json.loads(stream.with_suffix(".json").read_text())["attributes"]
            with self.subTest(stream=stream.name):
                if expected.startswith("R-"):
                    # An asset of 4 GB is beyond the limit on memory here.
                    rule, kind = told["error"]["rule"], told["error"]["kind"]
                    self.assertEqual("R-AST-01" if kind == "limit" else rule, expected)
                    errors += 1
                else:
                    self.assertNotIn("error", told)
        self.assertGreater(errors, 10)

    def test_the_asset_is_that_of_the_encoder(self):
        told, = self.in_node([self.encode_box("box")])
        asset = base64.b64decode(told["asset"])
        self.assertTrue(asset.startswith(b"glTF"))
        self.assertIn(textured_box.png(textured_box.ROWS), asset)
        self.assertEqual(told["drawn"], 24)  # three at each corner of the box
        self.assertEqual([one["name"] for one in told["sets"]], ["material", "normal", "uv0"])

    def normals_of_ply(self, pattern, frame, count):
        ply = (self.folder / pattern.replace("%d", str(frame))).read_text()
        header, _, rows = ply.partition("end_header\n")
        first = re.findall(r"property float (\w+)", header).index("nx")
        return [[float(word) for word in row.split()[first:first + 3]]
                for row in rows.splitlines()[:count]]

    def furthest(self, some, others):
        """How far a vector of one list is from the nearest of the other at most."""
        return max(min(math.dist(a, b) for b in others) for a in some)

    def test_normals_of_a_frame_are_those_of_rlpcdec(self):
        """Where the surface turns, they turn; where it leans, they follow the source, which has the
        same normals in all frames, as near as normals that follow a surface can."""
        last = textured_box.FRAMES - 1
        for name, turns in (("leans", False), ("turns", True)):
            stream = self.encode_box(name, turns=turns)
            told, = self.in_node([stream])
            done = run("rlpcdec", "-q", stream, "-o", self.folder / f"{name}-%d.ply", "--ascii")
            self.assertEqual(done.returncode, 0, done.stderr)
            native = self.normals_of_ply(f"{name}-%d.ply", last, told["drawn"])
            ours = [told["normals"][i:i + 3] for i in range(0, len(told["normals"]), 3)]
            self.assertEqual(len(native), len(ours))
            for some, others in ((native, ours), (ours, native)):
                self.assertLess(self.furthest(some, others), 1e-6)
            before = self.normals_of_ply(f"{name}-%d.ply", 0, told["drawn"])
            self.assertGreater(self.furthest(ours, before), 0.1)  # another frame has others
            cos, sin = ((f(last * textured_box.TURN) if turns else f(0))
                        for f in (math.cos, math.sin))
            source = [(cos * x - sin * y, sin * x + cos * y, z)
                      for (x, y, z), _, _ in textured_box.FACES]
            self.assertLess(self.furthest(ours, source), 0.01 if turns else 0.15)


if __name__ == "__main__":
    main()
