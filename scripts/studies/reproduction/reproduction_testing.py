"""Shared by the tests of the reproductions."""

import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / folder)
                for folder in ("scripts/studies/comparison", "scripts/studies/figures",
                               "scripts/studies/reproduction", "conformance/cli")]
from bench import Run
from tools_testing import INPUTS, read_obj, read_pc2, write_obj, write_pc2


class Tools:
    folder = None  # --bin


def runs(*points, clusters=10):
    """points: L, bpvf, KG error."""
    return [Run("", clusters, components, bpvf, kg, 0.0, 0.0) for components, bpvf, kg in points]


class Reproduced(unittest.TestCase):
    """Runs scripts/reproduce; skipped without --bin."""

    def setUp(self):
        if Tools.folder is None:
            self.skipTest("no --bin")
        temporary = tempfile.TemporaryDirectory(prefix="rlpc-reproduce-test-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.out = self.folder / "out"

    def reproduce(self, *arguments, code=0, tools=None):
        done = subprocess.run([ROOT / "scripts" / "reproduce", *arguments, "--bin",
                               tools or Tools.folder, "-o", self.out],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def short_arm(self, num_frames):
        """Mesh, point cache and frames of an animation of the user."""
        _, triangles = read_obj(INPUTS / "robot_arm.obj")
        frames = read_pc2(INPUTS / "robot_arm.pc2")[:num_frames]
        mesh, points = self.folder / "my arm.obj", self.folder / "my cache.pc2"
        write_obj(mesh, frames[0], triangles)
        write_pc2(points, frames)
        return mesh, points, frames

    def rows(self, name):
        with open(self.out / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def expect_pages(self, plots):
        """Both reports hold these plots and claims; streams are gone."""
        report = (self.out / "report.md").read_text(encoding="utf-8")
        for name in plots:
            xml.etree.ElementTree.parse(self.out / f"{name}.svg")
            self.assertIn(f"({name}.svg)", report)
        self.assertRegex(report, r"\n- (Holds|Does not hold)")
        page = (self.out / "index.html").read_text(encoding="utf-8")
        xml.etree.ElementTree.fromstring(page.split("\n", 1)[1])
        self.assertEqual({p.suffix for p in self.out.iterdir()}
                         - {".csv", ".html", ".md", ".pdf", ".png", ".svg"}, set())


def main(description):
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--bin", type=pathlib.Path)
    options, rest = parser.parse_known_args()
    Tools.folder = options.bin.resolve() if options.bin else None
    unittest.main(argv=[sys.argv[0], *rest])
