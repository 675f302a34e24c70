#!/usr/bin/env python3
"""Small runs of scripts/compare: cached results, inputs of every kind, a codec of the user."""

import argparse
import csv
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "conformance" / "cli"))
from tools_testing import INPUTS, read_obj, read_pc2, write_obj, write_pc2


class Tools:
    folder = ROOT / "build" / "release" / "bin"  # --bin


class SmallRun(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="rlpc-compare-test-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        (self.folder / "in put").mkdir()
        _, triangles = read_obj(INPUTS / "robot_arm.obj")
        frames = read_pc2(INPUTS / "robot_arm.pc2")[:12]
        write_obj(self.folder / "in put" / "arm.obj", frames[0], triangles)
        write_pc2(self.folder / "in put" / "arm.pc2", frames)

    def compare(self, *arguments, code=0, tools=None):
        done = subprocess.run(
            [sys.executable, "-B", ROOT / "scripts" / "compare", "--bin", tools or Tools.folder,
             "--out", self.folder / "out", "--kg", "0.3,1.0", *arguments],
            capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def points(self):
        with open(self.folder / "out" / "points.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_lossless_beside_what_is_installed(self):
        self.compare("--lossless", self.folder / "in put")
        points = self.points()
        self.assertEqual([p["BITS"] for p in points if p["animation"] == "arm"], ["12", "14", "16"])
        for p in points[:3]:
            self.assertLess(float(p["RLPC"]), float(p["time delta + xz -9e"]))
        self.assertEqual(points[3]["animation"], "geometric mean")
        said = self.compare("--lossless", "--codecs", "baseline", code=64)
        self.assertIn("--lossless takes no codecs", said.stderr)

    def test_run_and_run_again(self):
        arguments = ("--codecs", "baseline,lorenzo-xz", self.folder / "in put")
        self.compare(*arguments)
        points = self.points()
        self.assertEqual({p["codec"] for p in points}, {"baseline", "lorenzo-xz"})
        for p in points:
            self.assertAlmostEqual(float(p["bpvf"]), 8 * int(p["bytes"]) / (404 * 12), 6)
        baseline = {p["settings"]: p for p in points if p["codec"] == "baseline"}
        found = baseline["--profile baseline --kg 0.3"]
        self.assertLessEqual(float(found["kg_error_percent"]), 0.3)
        self.assertGreater(float(found["encode_seconds"]), 0)
        steps = sorted((int(p["settings"]), float(p["kg_error_percent"]))
                       for p in points if p["codec"] == "lorenzo-xz")
        self.assertTrue(any(kg <= 0.3 for _, kg in steps) and any(kg >= 1.0 for _, kg in steps))
        # A bit more halves the error.
        for (bits, kg), (more, less) in zip(steps, steps[1:]):
            self.assertAlmostEqual(kg / less / 2 ** (more - bits), 1, delta=0.15)
        out = self.folder / "out"
        self.assertIn("| arm |", (out / "comparison.md").read_text(encoding="utf-8"))
        page = (out / "index.html").read_text(encoding="utf-8")
        xml.etree.ElementTree.fromstring(page.split("\n", 1)[1])
        xml.etree.ElementTree.parse(out / "arm.svg")

        # Cached results are used again, missing ones are measured.
        kept = sorted((out / "cache").iterdir())
        self.assertEqual(len(kept), len(points))
        changed = json.loads(kept[0].read_text(encoding="utf-8"))
        kept[0].write_text(json.dumps({**changed, "encode_seconds": 12345.0}), encoding="utf-8")
        kept[1].unlink()
        self.compare(*arguments)
        again = self.points()
        self.assertEqual([p["bytes"] for p in again], [p["bytes"] for p in points])
        self.assertEqual([p["encode_seconds"] for p in again].count("12345"), 1)
        self.assertEqual(len(list((out / "cache").iterdir())), len(points))

    def decode(self, *outputs):
        """The arm in other formats, with little loss."""
        arm = self.folder / "in put" / "arm"
        stream = self.folder / "arm.rlpc"
        subprocess.run([Tools.folder / "rlpcenc", arm.with_suffix(".obj"), "--points",
                        arm.with_suffix(".pc2"), "-o", stream, "-q", "--kg", "0.01",
                        "--keep-order"], check=True)
        for output in outputs:
            (self.folder / output).parent.mkdir(exist_ok=True)
            subprocess.run([Tools.folder / "rlpcdec", stream, "-q", "-o", self.folder / output],
                           check=True)

    def test_inputs_of_every_kind(self):
        self.decode("decoded.rlpd", "cache.pc2", "other.mdd", "walk.glb", "seq/f_%03d.ply")
        (self.folder / "cache.obj").rename(self.folder / "mesh.obj")
        names = ("decoded.rlpd", "mesh.obj", "cache.pc2", "other.obj", "walk.glb", "seq")
        self.compare("--codecs", "baseline", "--no-weld", "--fps", "24",
                     *(self.folder / name for name in names))
        found = {p["sequence"]: p for p in self.points() if p["settings"].endswith("--kg 0.3")}
        self.assertEqual(set(found), {"decoded", "mesh", "other", "walk", "seq"})
        for name, p in found.items():
            frames = 10 if name == "walk" else 12  # 0.37 s at 24 frames a second, not 30
            self.assertAlmostEqual(float(p["bpvf"]), 8 * int(p["bytes"]) / (404 * frames), 6, name)
            self.assertLessEqual(float(p["kg_error_percent"]), 0.3, name)
        done = self.compare("--codecs", "baseline", "--animation", "Run", self.folder / "walk.glb",
                            code=1)
        self.assertIn("Run", done.stderr)

    CODEC = """
import array, pathlib, sys, zlib
verb, step, source, target = sys.argv[1:5]
data = pathlib.Path(source).read_bytes()
if verb == "encode":
    values = array.array("f", data[32:])
    coded = array.array("i", [round(v * 2 ** int(step)) for v in values])
    coded = step.encode().ljust(4) + data[:32] + coded.tobytes()
    pathlib.Path(target).write_bytes(zlib.compress(coded))
else:
    data = zlib.decompress(data)
    values = array.array("i", data[36:])
    floats = array.array("f", [v / 2 ** int(data[:4]) for v in values])
    pathlib.Path(target).write_bytes(data[4:36] + floats.tobytes())
"""

    def test_a_codec_of_the_user(self):
        script = self.folder / "co dec.py"
        script.write_text(self.CODEC)
        python = f"'{sys.executable}' -B '{script}'"
        command = ("--codecs", "baseline", "--codec", "mine",
                   python + " encode {step} {points} {file}", python + " decode 0 {file} {out}.pc2",
                   "1..14", self.folder / "in put")
        self.compare(*command)
        steps = sorted((int(p["settings"]), float(p["kg_error_percent"]))
                       for p in self.points() if p["codec"] == "mine")
        self.assertTrue(any(kg <= 0.3 for _, kg in steps) and any(kg >= 1.0 for _, kg in steps))
        for (bits, kg), (more, less) in zip(steps, steps[1:]):
            self.assertAlmostEqual(kg / less / 2 ** (more - bits), 1, delta=0.15)
        self.assertIn("| mine |", (self.folder / "out/comparison.md").read_text(encoding="utf-8"))

        # Cached results of the old script are not used.
        script.write_text("raise SystemExit('no such codec')")
        done = self.compare(*command, code=1)
        self.assertRegex(done.stderr, "arm, mine: failed: sh: .*no such codec")
        script.write_text("")
        self.assertIn("the encoder wrote no {file}", self.compare(*command, code=1).stderr)

    def test_missing_codecs_are_named_with_the_remedy(self):
        tools = self.folder / "few"
        tools.mkdir()
        for name in ("rlpcenc", "rlpcdec", "rlpccmp", "plot_svg"):
            (tools / name).symlink_to(Tools.folder / name)
        done = self.compare("--codecs", "baseline,lorenzo-xz,draco", self.folder / "in put",
                            tools=tools)
        self.assertIn(f"Skipped: Lorenzo + xz, draco per frame: peer_codec is not in {tools}; "
                      "leave out --bin", done.stderr)
        self.assertIn("Skipped: Lorenzo", (self.folder / "out/index.html").read_text("utf-8"))
        done = self.compare("--codecs", "lorenzo-xz", self.folder / "in put", tools=tools, code=1)
        self.assertIn("no codec is left", done.stderr)
        (tools / "plot_svg").unlink()
        done = self.compare("--codecs", "baseline", self.folder / "in put", tools=tools, code=1)
        self.assertIn("plot_svg is not in", done.stderr)

    def test_usage(self):
        self.compare("--codecs", "baseline,nobody", code=64)
        self.compare("--gof", "few", code=64)
        for number in ("0", "-1"):
            self.assertIn("positive", self.compare("--jobs", number, code=64).stderr)
        done = self.compare("--codecs", "baseline", self.folder / "nowhere.obj", code=1)
        self.assertIn("nowhere.obj", done.stderr)

    def test_a_failure_is_reported_and_does_not_stop_the_rest(self):
        (self.folder / "in put" / "bad.obj").write_text("v 0 0 0\n")
        shutil.copy(self.folder / "in put" / "arm.pc2", self.folder / "in put" / "bad.pc2")
        done = self.compare("--codecs", "baseline", self.folder / "in put", code=1)
        self.assertIn("bad, Baseline: failed: rlpcenc: ", done.stderr)
        self.assertEqual({p["sequence"] for p in self.points()}, {"arm"})


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default=Tools.folder)
    options, rest = parser.parse_known_args()
    Tools.folder = options.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
