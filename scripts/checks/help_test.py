#!/usr/bin/env python3
"""The scripts answer --help on one screen, with what they do and an example or the options; and
they refuse wrong usage with exit code 64."""

import os
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINES, COLUMNS = 48, 80
LARGER = {"compare": (64, 100)}  # it has as many options as a program
OTHERS = ("conformance/judge/run", "conformance/judge/encode", "conformance/judge/export_fluster",
          "conformance/rlpcgen/rlpcgen", "conformance/rlpccov/rlpccov",
          "conformance/specdec/specdec.py")


def scripts():
    own = [path for path in sorted((ROOT / "scripts").iterdir())
           if path.is_file() and os.access(path, os.X_OK)]
    return [*own, *(ROOT / other for other in OTHERS)]


class Help(unittest.TestCase):
    def test_every_script_has_a_page(self):
        self.assertGreater(len(scripts()), 15)
        for script in scripts():
            done = subprocess.run([script, "--help"], capture_output=True, text=True, check=False,
                                  env={**os.environ, "COLUMNS": str(COLUMNS)})
            self.assertEqual((done.returncode, done.stderr), (0, ""), script)
            max_lines, max_columns = LARGER.get(script.name, (LINES, COLUMNS))
            lines = done.stdout.splitlines()
            self.assertGreater(len(lines), 2, script)
            self.assertLessEqual(len(lines), max_lines, script)
            for line in lines:
                self.assertLessEqual(len(line), max_columns, (script, line))

    def test_wrong_usage_is_refused(self):
        for script, *arguments in (("scripts/mutate", "--jobs", "0"),
                                   ("scripts/mutate", "--jobs", "many"),
                                   ("scripts/streams", "check", "--jobs", "0"),
                                   ("scripts/streams", "check", "--jobs", "-1"),
                                   ("scripts/streams", "stress", "--seeds", "-1"),
                                   ("scripts/fuzz", "--minutes", "0"),
                                   ("scripts/determinism", "--frames", "-1"),
                                   ("scripts/worst_case", "--kind", "nothing"),
                                   ("scripts/large", "tree", "mesh"),
                                   ("scripts/compare_gltf", "--settings", "best", "a.glb"),
                                   ("scripts/worst_case", "4", "1"),
                                   ("conformance/rlpccov/rlpccov", "streams", "--jobs", "0"),
                                   ("conformance/judge/run", "--decoder", "x", "--jobs", "0")):
            done = subprocess.run([ROOT / script, *arguments], capture_output=True, text=True,
                                  check=False)
            self.assertEqual(done.returncode, 64, (script, arguments, done.stderr))
            self.assertIn(arguments[-2], done.stderr)


if __name__ == "__main__":
    unittest.main()
