#!/usr/bin/env python3
"""A small run of scripts/compare_gltf. Skipped where node does not find gltfpack and three.js."""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
HERE = pathlib.Path(__file__).resolve().parent
TULIP = ROOT / "streams" / "inputs" / "tulip.glb"
sys.path[:0] = [str(HERE), str(ROOT / "scripts" / "studies" / "comparison"),
                str(ROOT / "decoder" / "web" / "player")]
import chromium


class Tools:
    folder = ROOT / "build" / "release" / "bin"  # --bin


def package(name):
    """The folder of an npm package that node finds; None: there is none."""
    if not shutil.which("node"):
        return None
    done = subprocess.run(["node", "-e", f"console.log(require.resolve('{name}'))"], cwd=ROOT,
                          capture_output=True, text=True, check=False)
    main = pathlib.Path(done.stdout.strip())
    return next((p for p in main.parents if p.name == name), None) if done.returncode == 0 else None


class Run(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="rlpc-gltf-run-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def compare(self, *arguments, code=0):
        done = subprocess.run(
            [sys.executable, "-B", ROOT / "scripts" / "compare_gltf", "--bin", Tools.folder,
             "--out", self.folder / "out", *arguments], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def use_packages(self):
        """Packages that node finds, in place of those from npm."""
        modules = self.folder / "out" / "npm" / "node_modules"
        modules.mkdir(parents=True)
        for name in ("gltfpack", "three"):
            found = package(name)
            if found is None:
                self.skipTest("needs node, and the npm packages gltfpack and three where node "
                              "finds them (npm install gltfpack three, or NODE_PATH)")
            shutil.copytree(found, modules / name)
        shutil.copy(HERE / "package.json", modules.parent)

    def test_beside_gltfpack(self):
        self.use_packages()
        pictures = chromium.program() is not None
        more = ("--pictures", self.folder / "pictures") if pictures else ()
        found = json.loads(self.compare(TULIP, "--settings", "default,equal", "--json",
                                        *more).stdout)
        model, = found["models"]
        self.assertEqual((model["name"], model["num_clips"]), ("tulip", 2))
        self.assertEqual(model["source_bytes"], TULIP.stat().st_size)
        packed, ours, equal = (model["files"][name] for name in ("gltfpack", "default", "equal"))
        self.assertLessEqual(ours["kg_error_percent"], 0.1)
        self.assertLessEqual(equal["kg_error_percent"], packed["kg_error_percent"])
        for file in (packed, ours, equal):
            self.assertLess(file["kg_error_percent"], 0.5)
            drawn = file["drawn"]
            self.assertLess(drawn["kg_error_percent"], 0.5)
            self.assertEqual(drawn["closed"], drawn["together"])
            self.assertTrue(drawn["same_clip_names"])
        if pictures:
            for picture in found["pictures"]:
                self.assertLess(picture["mean"], 3, picture)
                self.assertTrue((self.folder / "pictures" / picture["picture"]).is_file())
        self.assertIn("| tulip |",
                      (self.folder / "out" / "comparison.md").read_text(encoding="utf-8"))

    def test_beside_draco(self):
        self.use_packages()
        if not shutil.which("draco_encoder"):
            self.skipTest("needs draco_encoder (scripts/setup --compare)")
        found, = json.loads(self.compare("--draco", TULIP, "--json").stdout)
        self.assertGreater(found["draco"]["connectivity"], found["triangles"] // 8)
        self.assertLess(found["rlpc"]["connectivity"], found["draco"]["connectivity"])

    def test_wrong_usage(self):
        self.assertIn("not a .glb", self.compare(TULIP.with_suffix(".obj"), code=1).stderr)
        self.assertIn("no such file", self.compare("missing.glb", code=1).stderr)
        self.assertIn("unknown setting", self.compare("--settings", "best", TULIP, code=64).stderr)
        self.assertIn("--pictures", self.compare("--draco", "--pictures", "a", TULIP,
                                                 code=64).stderr)


if __name__ == "__main__":
    options = argparse.ArgumentParser()
    options.add_argument("--bin", type=pathlib.Path, default=Tools.folder)
    known, rest = options.parse_known_args()
    Tools.folder = known.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest])
