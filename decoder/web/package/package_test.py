#!/usr/bin/env python3
"""The npm package in node: its decoder decodes what rlpcdec decodes; its types.

  package_test.py --bin FOLDER [Node|Files|Modules|Types]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "player"))
import textured_box
from player_testing import (MODULES, PACKAGE, ROOT, STREAMS, Decoded, InFolder,
                            float_frames, main, need_node, need_player)

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

    def suite_streams(self, version):
        entries = json.loads((STREAMS / version / "SUITE.json").read_text())["streams"]
        return {expect: [STREAMS / version / entry["path"] for entry in entries
                         if entry["expect"] == expect and entry["tier"] != "stress"]
                for expect in ("accept", "reject")}

    def check_suite(self, version):
        streams = self.suite_streams(version)
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
        for result in self.compare(self.suite_streams("v1.2")["accept"]):
            self.assertNotIn("error", result, result["path"])

    def test_streams_of_the_encoder(self):
        streams = [self.encode(f"{profile}-{order}.rlpc", "--profile", profile, "--gof", "20",
                               *(["--keep-order"] if order == "kept" else []))
                   for profile in ("main", "baseline", "high") for order in ("own", "kept")]
        for stream, result in zip(streams, self.compare(streams)):
            self.assertEqual(result["frames"], 60)
            self.assertEqual(result["compared"], 60)  # with the hashes of the stream
            self.assertEqual(result["floats"], Decoded(stream, self.folder).floats(self.folder))


class Files(InFolder):
    """Streams as files, in node."""

    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        if not (MODULES / "three").is_dir():
            raise unittest.SkipTest("three.js is not there: scripts/player")
        super().setUpClass()
        modules = cls.folder / "node_modules"
        modules.mkdir()
        (modules / "rlpc").symlink_to(PACKAGE)
        (modules / "three").symlink_to(MODULES / "three")

    def run_script(self, body, cwd=None):
        script = self.folder / "script.mjs"
        script.write_text(f"""
            import {{ RlpcDecoder }} from "rlpc";
            import {{ RLPCLoader, RLPCMesh }} from "rlpc/three";
            console.log(JSON.stringify(await (async () => {{ {body} }})()));""")
        done = subprocess.run(["node", "--preserve-symlinks", script], cwd=cwd or self.folder,
                              capture_output=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return json.loads(done.stdout.splitlines()[-1])

    def test_paths_and_file_urls(self):
        stream = self.encode("a walk#1 50%.rlpc", "--gof", "20")
        (self.folder / "sub").mkdir()
        hashes = [hashlib.sha256(frame).hexdigest() for frame in float_frames(stream, self.folder)]
        addresses = [f"../{stream.name}", str(stream), stream.as_uri()]
        result = self.run_script(f"""
            const {{ createHash }} = await import("node:crypto");
            const all = [];
            for (const address of {json.dumps(addresses)}) {{
              const mesh = await new RLPCLoader().loadAsync(address);
              const decoder = await RlpcDecoder.open(address.startsWith("file:")
                ? new URL(address) : address);
              const {{ positions }} = await decoder.frame(41);
              await mesh.seek(17 / 30);
              all.push([positions, mesh.geometry.attributes.position.array].map((floats) =>
                createHash("sha256").update(floats).digest("hex")));
              mesh.dispose();
              decoder.close();
            }}
            return all;""", cwd=self.folder / "sub")
        self.assertEqual(result, [[hashes[41], hashes[17]]] * 3)

    def test_a_file_that_is_not_there(self):
        told = self.run_script("""
            const { kind, message } = await new RLPCLoader().loadAsync("no such.rlpc")
              .catch((error) => error);
            return [kind, message];""")
        self.assertEqual(told[0], "source")
        self.assertIn("no such.rlpc", told[1])

    def test_equal_texture_coordinates_are_there_again(self):
        """The encoder codes one of them, and the loader makes one attribute of them."""
        self.encode_box("equal", uv_sets=3)
        for options in ("{}", "{ material: new MeshBasicMaterial() }", "{ textures: false }"):
            told = self.run_script(f"""
                const {{ MeshBasicMaterial }} = await import("three");
                const decoder = await RlpcDecoder.open("equal.rlpc");
                const coded = [...(await decoder.attributes()).keys()];
                decoder.close();
                const mesh = await new RLPCLoader().setOptions({options}).loadAsync("equal.rlpc");
                const {{ attributes }} = mesh.geometry;
                const names = Object.keys(attributes).sort();
                const isOne = attributes.uv === attributes.uv1 && attributes.uv === attributes.uv2;
                mesh.dispose();
                return {{ coded, names, isOne }};""")
            self.assertEqual(told["coded"], ["material", "normal", "uv0"])
            self.assertEqual(told["names"], ["normal", "position", "uv", "uv1", "uv2"])
            self.assertTrue(told["isOne"])

    def test_levels_have_the_positions_and_values_of_the_whole_mesh(self):
        """On a tube, u is the angle in turns: texture coordinates of all triangles fit."""
        self.encode_glb("tube", textured_box.tube(24, 36))
        for options in ("{}", "{ attributes: false }", "{ coarseLayers: 18 }"):
            told = self.run_script(f"""
                const mesh = await new RLPCLoader().setOptions({options}).loadAsync("tube.rlpc");
                const whole = mesh.geometry.attributes;
                const names = Object.keys(whole).sort();
                const vertexOf =
                  ({{ position }}, i) => position.array.slice(3 * i, 3 * i + 3).join();
                const sizes = [mesh.geometry.index.count];
                const clone = mesh.clone();
                await mesh.seek(0);
                const wrong = [];
                for (const [layers, distance] of [[16, 10], [14, 20], [12, 30]]) {{
                  const level = await mesh.addLevel({{ layers, distance }});
                  mesh.level = 0;
                  const vertices = new Set(Array.from({{ length: whole.position.count }},
                    (_, i) => vertexOf(whole, i)));
                  mesh.level = level;
                  const {{ attributes, index, groups }} = mesh.geometry;
                  const {{ position, uv }} = attributes;
                  for (let i = 0; i < position.count; ++i) {{
                    if (!vertices.has(vertexOf(attributes, i))) wrong.push(["position", i]);
                    const turns = Math.atan2(-position.getZ(i), position.getX(i)) / (2 * Math.PI);
                    const off = uv ? uv.getX(i) - turns : 0;
                    if (Math.abs(off - Math.round(off)) > 0.01) wrong.push(["u", i, off]);
                  }}
                  for (let t = 0; uv && t < index.count; t += 3) {{
                    const us = [0, 1, 2].map((k) => uv.getX(index.array[t + k]));
                    if (Math.max(...us) - Math.min(...us) > 0.5) wrong.push(["triangle", t, us]);
                  }}
                  if (Math.max(...index.array) >= position.count) wrong.push(["index"]);
                  const drawn = groups.reduce((sum, {{ count }}) => sum + count, 0);
                  if (groups.length > 0 && drawn !== index.count) wrong.push(["groups"]);
                  sizes.push(index.count);
                  await clone.seek(mesh.time);
                  clone.level = level;
                  if (clone.geometry.index.count !== index.count) wrong.push(["clone"]);
                }}
                const far = await mesh.addLevel({{ layers: 99 }}).catch((error) => error.name);
                mesh.dispose();
                clone.dispose();
                return {{ sizes, names, far, wrong }};""")
            self.assertEqual(told["wrong"], [])
            self.assertEqual(sorted(told["sizes"], reverse=True), told["sizes"])
            self.assertEqual(len(set(told["sizes"])), 4)
            self.assertEqual(told["far"], "RangeError")
            self.assertEqual("uv" in told["names"], "false" not in options)


class Modules(unittest.TestCase):
    """Modules that need no decoder."""

    def run_in_node(self, name):
        need_node()
        done = subprocess.run(["node", "--test", HERE / "testing" / name], capture_output=True,
                              timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stdout.decode())

    def test_the_version_is_that_of_the_project(self):
        project = re.search(r"project\(rlpc VERSION (\S+)",
                            (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertEqual(json.loads((HERE / "package.json").read_text())["version"], project)

    def test_playback(self):
        self.run_in_node("playback_test.mjs")

    def test_byte_ranges(self):
        self.run_in_node("byte_ranges_test.mjs")

    def test_http_source(self):
        self.run_in_node("http_source_test.mjs")

    def test_asset_limit(self):
        self.run_in_node("asset_limit_test.mjs")

    def test_wasm_decoder(self):
        self.run_in_node("wasm_decoder_test.mjs")

    def test_coarse_surface(self):
        self.run_in_node("coarse_surface_test.mjs")

    def test_mesh(self):
        """RLPCMesh with a decoder that the test makes."""
        if not (MODULES / "three").is_dir():
            raise unittest.SkipTest("three.js is not there: scripts/player")
        with tempfile.TemporaryDirectory() as folder:
            for name in ("src", "testing"):
                shutil.copytree(HERE / name, pathlib.Path(folder) / name)
            (pathlib.Path(folder) / "node_modules").symlink_to(MODULES)
            for name in ("mesh_test.mjs", "shared_frames_test.mjs"):
                self.run_in_node(pathlib.Path(folder) / "testing" / name)


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
