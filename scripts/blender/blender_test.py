#!/usr/bin/env python3
"""Runs what README.md shows: animations from Blender to RLPC and back, compared in Blender.

Skipped where there is no Blender (`scripts/setup --blender`).
"""

import argparse
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
TESTED_VERSION = "3.4"
FIRST_FRAME = 11  # first frame of the scenes of example.py
ROUNDING = 1e-5   # floats, and six decimals


class Programs:
    folder = HERE.parents[1] / "build" / "release" / "bin"  # --bin


def recipes():
    """{heading: [(language, text) of each block]}"""
    found, heading, page = {}, None, (HERE / "README.md").read_text(encoding="utf-8")
    for match in re.finditer(r"^#+ ([^\n]*)$|^```(\w+)\n(.*?)^```$", page,
                             re.MULTILINE | re.DOTALL):
        if match.group(1):
            heading = match.group(1)
        else:
            found.setdefault(heading, []).append(match.group(2, 3))
    return found


def run(command, folder):
    # Blender takes relative paths from PWD, and its Python library from where PATH has a python3.
    first = [str(Programs.folder), str(pathlib.Path(shutil.which("blender")).parent)]
    environment = {**os.environ, "PWD": str(folder),
                   "PATH": os.pathsep.join([*first, os.environ["PATH"]])}
    done = subprocess.run(command, cwd=folder, capture_output=True, check=False, text=True,
                          env=environment)
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def blender(folder, scene, scripts, *arguments):
    options = [word for script in scripts for word in ("--python", str(script))]
    return run(["blender", "-b", "--factory-startup", *scene, "--python-exit-code", "1", *options,
                "--", *arguments], folder)


def distance(left, right):
    """The largest distance of a vertex, in any frame."""
    return max(math.dist(a, b) for ours, theirs in zip(left, right, strict=True)
               for a, b in zip(ours, theirs, strict=True))


@unittest.skipUnless(shutil.which("blender"), "no Blender: scripts/setup --blender installs it")
class Blender(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        version = run(["blender", "--version"], HERE).split()[1]
        if not version.startswith(TESTED_VERSION + "."):
            raise unittest.SkipTest(f"Blender {version}: the page is for {TESTED_VERSION}")
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="rlpc-blender-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.recipes = recipes()
        blender(cls.folder, [], [HERE / "example.py"], ".")

    def scripts_of(self, heading, change=str):
        """Files with the blocks in Python of the page under a heading."""
        found = []
        for number, (language, text) in enumerate(self.recipes[heading]):
            if language == "python":
                found.append(self.folder / f"{heading} {number}.py")
                found[-1].write_text(change(text), encoding="utf-8")
        self.assertTrue(found, heading)
        return found

    def shell(self, heading, change=str):
        """Runs the blocks of commands; what they print."""
        texts = [text for language, text in self.recipes[heading] if language == "sh"]
        self.assertTrue(texts, heading)
        return "".join(run(["sh", "-e", "-c", change(text)], self.folder) for text in texts)

    def encode(self, heading):
        """The largest error that rlpcenc reports."""
        said = self.shell(heading)
        contents = json.loads(run(["rlpcinfo", "walk.rlpc", "--json"], self.folder))
        self.assertEqual((contents["num_frames"], contents["frame_rate"]), (24, [24, 1]))
        self.assertNotIn("other axes", said)
        return float(re.search(r"largest (\S+)", said).group(1)) + ROUNDING

    def positions(self, scene, scripts=(), first=FIRST_FRAME):
        blender(self.folder, [scene], [*scripts, HERE / "positions.py"], "found.json", str(first))
        return json.loads((self.folder / "found.json").read_text(encoding="utf-8"))

    def check(self, truth, found, largest):
        """Equal within the error of the encoder, which is far below what a frame moves."""
        self.assertEqual([len(frame) for frame in found], [len(frame) for frame in truth])
        error = distance(truth, found)
        self.assertGreater(error, 0)
        self.assertLessEqual(error, largest)
        self.assertGreater(distance(truth[1:], found[:-1]), 20 * largest)

    def test_point_caches(self):
        ways = ("OBJ sequence", "PC2", "MDD")
        scripts = [script for way in ways for script in self.scripts_of(way)]
        truth = self.positions("modifiers.blend", scripts)
        new_object = self.scripts_of("A new object")
        for way in ways:
            with self.subTest(way):
                largest = self.encode(way)
                self.shell("A new object")
                self.check(truth, self.positions("empty.blend", new_object), largest)
        self.shell("The original object")
        self.check(truth, self.positions("modifiers.blend", self.scripts_of("The original object")),
                   largest)
        self.shell("Shape keys")
        self.check(truth, self.positions("empty.blend", self.scripts_of("Shape keys")), largest)
        from_mdd = self.scripts_of("A new object",
                                   lambda text: text.replace("PC2", "MDD").replace("pc2", "mdd"))
        self.check(truth, self.positions("empty.blend", from_mdd), largest)

        # The commands do what the page says, also without --axes.
        z_up = self.shell("MDD", lambda text: text.replace(" --axes x,z,-y", ""))
        self.assertIn("--axes x,z,-y turns it", z_up)
        self.shell("The original object")
        as_they_are = self.scripts_of("The original object",
                                      lambda text: re.sub(r"cache\.forward_axis.*\n", "", text))
        self.check(truth, self.positions("modifiers.blend", as_they_are), largest)

    def test_gltf(self):
        truth = self.positions("rig.blend", self.scripts_of("glb"))
        largest = self.encode("glb")
        self.shell("glTF")
        self.check(truth, self.positions("empty.blend", self.scripts_of("glTF"), first=0), largest)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default=Programs.folder)
    options, rest = parser.parse_known_args()
    Programs.folder = options.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest], verbosity=2)  # says why it skips
