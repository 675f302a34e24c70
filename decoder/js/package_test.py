#!/usr/bin/env python3
"""The npm package in node: its decoder decodes what rlpcdec decodes; its types.

  package_test.py --bin FOLDER [Node|Modules|Types]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "player"))
from player_testing import (MODULES, PACKAGE, ROOT, STREAMS, Decoded, InFolder, main,  # noqa: E402
                            need_node, need_player)

EXIT_CODES = {"truncated": 1, "invalid": 1, "unsupported": 2, "limit": 3}


class Node(InFolder):
    """Streams of the suites and of the encoder."""

    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        super().setUpClass()

    def compare(self, streams):
        done = subprocess.run(["node", HERE / "testing" / "decode_streams.mjs", PACKAGE, *streams],
                              capture_output=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        results = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual(len(results), len(streams))
        for stream, result in zip(streams, results):
            with self.subTest(stream=stream.name):
                self.compare_one(Decoded(stream, self.folder), result)
        return results

    def compare_one(self, native, result):
        error = result.get("error")
        self.assertEqual(native.code, EXIT_CODES[error["kind"]] if error else 0)
        for name, value in native.verdict.items():
            self.assertEqual(error[name], value, name)
        self.assertEqual(result["frames"], len(native.crcs))
        self.assertEqual(result["positions"], native.positions)
        if native.triangles:
            self.assertEqual(result["triangles"], hashlib.sha256(native.triangles).hexdigest())

    def of_suite(self, version):
        entries = json.loads((STREAMS / version / "SUITE.json").read_text())["streams"]
        return {expect: [STREAMS / version / entry["path"] for entry in entries
                         if entry["expect"] == expect and entry["tier"] != "stress"]
                for expect in ("accept", "reject")}

    def check_suite(self, version):
        streams = self.of_suite(version)
        self.assertGreater(min(map(len, streams.values())), 30)
        for result in self.compare(streams["accept"]):
            self.assertNotIn("error", result, result["path"])
        for result in self.compare(streams["reject"]):
            self.assertIn("error", result, result["path"])

    def test_the_streams_of_version_1_0(self):
        self.check_suite("v1.0")

    def test_the_streams_of_version_1_1(self):
        self.check_suite("v1.1")

    def test_the_streams_of_version_1_2(self):
        """But those that are rejected: of a stream with an open end, nothing tells the number of
        frames if its end is damaged."""
        for result in self.compare(self.of_suite("v1.2")["accept"]):
            self.assertNotIn("error", result, result["path"])

    def test_streams_of_the_encoder(self):
        streams = [self.encode(f"{profile}-{order}.rlpc", "--profile", profile, "--gof", "20",
                               *(["--keep-order"] if order == "kept" else []))
                   for profile in ("main", "baseline", "high") for order in ("own", "kept")]
        for stream, result in zip(streams, self.compare(streams)):
            self.assertEqual(result["frames"], 60)
            self.assertEqual(result["compared"], 60)  # with the hashes of the stream
            self.assertEqual(result["floats"], Decoded(stream, self.folder).floats(self.folder))


class Modules(unittest.TestCase):
    """Modules that need no decoder."""

    def run_in_node(self, name):
        need_node()
        done = subprocess.run(["node", "--test", HERE / "testing" / name], capture_output=True,
                              timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stdout.decode())

    def test_the_version_is_that_of_the_project(self):
        project = re.search(r"project\(rlpc VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(json.loads((HERE / "package.json").read_text())["version"], project)

    def test_playback(self):
        self.run_in_node("playback_test.mjs")

    def test_byte_ranges(self):
        self.run_in_node("byte_ranges_test.mjs")

    def test_http_source(self):
        self.run_in_node("http_source_test.mjs")

    def test_wasm_decoder(self):
        self.run_in_node("wasm_decoder_test.mjs")


class Types(InFolder):
    """The TypeScript types."""

    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        super().setUpClass()

    def test_a_program_that_uses_all_of_the_package(self):
        for name in ("usage.ts", "tsconfig.json"):
            shutil.copy(HERE / "testing" / name, self.folder)
        modules = self.folder / "node_modules"
        shutil.copytree(PACKAGE, modules / "rlpc")
        for name in ("three", "@types"):
            (modules / name).symlink_to(MODULES / name)
        done = subprocess.run(["node", MODULES / "typescript" / "bin" / "tsc", "-p", "."],
                              cwd=self.folder, capture_output=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stdout.decode())


if __name__ == "__main__":
    main()
