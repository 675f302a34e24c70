#!/usr/bin/env python3
"""The table of the encoder's stages, and one real encoding.

  encoder_stages_test.py --bin FOLDER
"""

import argparse
import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import encoder_stages

BIN = pathlib.Path(__file__).resolve().parents[3] / "build" / "release" / "bin"
RUNS = [{"animation": "cow", "vertex_frames": 600000, "bytes": 120000,
         "stages": {"other": 0.01, "bones": 1.0, "components": 0.5, "reading": 0.004}},
        {"animation": "a fox", "vertex_frames": 50000, "bytes": 4000,
         "stages": {"bones": 0.05, "rig recovery": 0.15}}]


class Table(unittest.TestCase):
    def test_stages_that_take_most_come_first(self):
        self.assertEqual(encoder_stages.order(RUNS), ["bones", "rig recovery", "components"])

    def test_shares_and_speeds(self):
        self.assertEqual(encoder_stages.table(RUNS), [
            "                            cow  a fox",
            "seconds                    1.51   0.20",
            "million vertex-frames/s   0.396  0.250",
            "bytes                    120000   4000",
            "bones, %                     66     25",
            "rig recovery, %               0     75",
            "components, %                33      0"])


class Encoding(unittest.TestCase):
    def encode(self, *words):
        with tempfile.TemporaryDirectory() as folder, \
                contextlib.redirect_stdout(io.StringIO()) as out:
            path = pathlib.Path(folder) / "new" / "stages.json"
            encoder_stages.main([str(BIN), str(path), *map(str, words)])
            return json.loads(path.read_text(encoding="utf-8")), out.getvalue()

    def test_the_stages_are_all_of_the_time(self):
        arm = encoder_stages.ROOT / "streams" / "inputs" / "robot_arm.obj"
        runs, text = self.encode("--preset", "fast", arm)
        self.assertEqual([run["animation"] for run in runs], ["robot_arm"])
        stages = runs[0]["stages"]
        for stage in ("reading", "connectivity", "bones", "components", "skinned GOFs",
                      "metrics", "verification"):
            self.assertGreater(stages[stage], 0.0, stage)
        self.assertLess(stages["other"], 0.2 * sum(stages.values()))
        self.assertIn("million vertex-frames/s", text)

    def test_what_cannot_be_encoded_is_told(self):
        for words in (["missing.obj"], ["--profile", "none"]):
            with self.assertRaises(SystemExit) as stopped:
                self.encode(*words)
            self.assertRegex(str(stopped.exception), "^bench: .*(no such file|profile)")


class Command(unittest.TestCase):
    def test_help(self):
        done = subprocess.run([sys.executable, "-B", encoder_stages.__file__, "--help"],
                              capture_output=True, text=True, check=True)
        self.assertIn("scripts/bench --stages", done.stdout)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, default=BIN)
    given, left = parser.parse_known_args()
    BIN = given.bin
    unittest.main(argv=[sys.argv[0], *left])
