#!/usr/bin/env python3
"""The .glb files of rlpcdec: read back by rlpcenc and rlpccmp, and in third-party programs: the
Khronos validator, and three.js in node and in Chromium. A test is skipped if its program is not
installed.

    tools_glb_test.py --bin BUILD/bin [unittest arguments, such as GltfValidator]
"""

import http.server
import json
import os
import pathlib
import queue
import re
import shutil
import struct
import subprocess
import tempfile
import threading

from tools_testing import INPUTS, ROOT, ToolsTest, main, read_obj, read_pc2


def node(script, *args):
    """Runs JavaScript, which finds npm packages in a parent folder or by NODE_PATH."""
    return subprocess.run(["node", "-e", script, *map(str, args)], cwd=ROOT, capture_output=True,
                          text=True, check=True).stdout


def main_file(package):
    """The main file of an npm package; None if node or the package is missing."""
    if not shutil.which("node"):
        return None
    try:
        return pathlib.Path(node(f"console.log(require.resolve('{package}'))").strip())
    except subprocess.CalledProcessError:
        return None


VALIDATE = """
const validator = require('gltf-validator');
const fs = require('fs');
const check = file => validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
Promise.all(process.argv.slice(1).map(check)).then(
    reports => console.log(JSON.stringify(reports.map(report => report.issues))));
"""


def document(path):
    """The JSON chunk of a .glb file."""
    data = path.read_bytes()
    size, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + size])


class SkinTest(ToolsTest):
    NUMBER = r"([\d.e+-]+)"

    def encode_clips(self, *options):
        """An animation with two clips as a.rlpc."""
        self.ok("rlpcenc", INPUTS / "tulip.glb", "--animation", "all", "--fps", 30, "--kg", 0.2,
                "--preset", "fast", "-o", self.path("a.rlpc"), "--quiet", *options)
        return self.path("a.rlpc")

    def write(self, stream, *options, name="a.glb"):
        """(KG error in per cent, RMS and largest error, joints, targets), as rlpcdec states
        them."""
        answer = self.ok("rlpcdec", stream, "-o", self.path(name), "--json", "--no-attributes",
                         *options).json()
        (remark,) = answer["remarks"]
        found = re.search(rf"(\d+) bones? and (\d+) morph targets?; differs from the stream by "
                          rf"KG error {self.NUMBER} %, RMS {self.NUMBER}, largest {self.NUMBER}",
                          remark)
        self.assertTrue(found, remark)
        joints, targets, *errors = found.groups()
        return [float(x) for x in errors], int(joints), int(targets)


class SkinReadBack(SkinTest):
    """rlpccmp and rlpcenc read the frames of a skin with the errors that rlpcdec has stated."""

    def check(self, stream, *options, clips=1):
        (kg, rms, largest), joints, targets = self.write(stream, "--as", "skin", *options)
        glb = document(self.path("a.glb"))
        self.assertEqual(len(glb["skins"][0]["joints"]), joints)
        self.assertEqual(len(glb["meshes"][0]["primitives"][0].get("targets", [])), targets)
        self.assertEqual(len(glb["animations"]), clips)
        seen = self.ok("rlpccmp", stream, self.path("a.glb"), "--json", "--no-weld-b",
                       *(["--animation-b", "all"] if clips > 1 else [])).json()
        self.assertAlmostEqual(seen["metrics"]["kg_error_percent"], kg, delta=0.001 * kg + 1e-4)
        self.assertAlmostEqual(seen["metrics"]["max_error"], largest, delta=0.001 * largest + 1e-5)
        return kg, joints, targets

    def test_of_bones(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.2, name="robot_arm")
        kg, joints, _ = self.check(self.path("a.rlpc"))
        self.assertGreater(joints, 4)
        self.assertLess(kg, 0.2)
        without, _, targets = self.check(self.path("a.rlpc"), "--max-targets", 0)
        self.assertEqual(targets, 0)
        self.assertGreaterEqual(without, kg)
        again = self.ok("rlpcenc", self.path("a.glb"), "-o", self.path("b.rlpc"), "--kg", 1,
                        "--preset", "fast", "--json").json()
        self.assertEqual((again["num_vertices"], again["num_frames"]), (404, 75))

    def test_of_groups_of_frames_with_bones_of_their_own(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.2, "--gof", 20, name="elephant")
        kg, _, targets = self.check(self.path("a.rlpc"))
        self.assertLess(kg, 0.2)
        self.assertGreater(targets, 0)

    def test_of_clusters(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.3, "--profile", "baseline", name="elephant")
        kg, _, _ = self.check(self.path("a.rlpc"))
        self.assertLess(kg, 0.3)

    def test_of_clips(self):
        self.check(self.encode_clips(), clips=2)
        names = [a["name"] for a in document(self.path("a.glb"))["animations"]]
        self.assertEqual(names, ["Sway", "Visit"])

    def test_of_a_coarse_mesh(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.2, name="robot_arm")
        self.write(self.path("a.rlpc"), "--as", "skin", "--coarse", 5)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("b.glb"), "--as", "morph",
                "--coarse", 5)
        seen = self.ok("rlpccmp", self.path("b.glb"), self.path("a.glb"), "--json", "--no-weld-a",
                       "--no-weld-b").json()
        self.assertLess(seen["metrics"]["kg_error_percent"], 0.2)


class SkinChoice(SkinTest):
    """Tests what --as auto writes, and what --as skin refuses."""

    def targets(self, stream, *options):
        self.ok("rlpcdec", stream, "-o", self.path("a.glb"), *options)
        glb = document(self.path("a.glb"))
        return "skins" in glb, len(glb["meshes"][0]["primitives"][0].get("targets", []))

    def test_auto_writes_bones_that_are_near_enough(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.2, name="robot_arm")
        is_skin, targets = self.targets(self.path("a.rlpc"))
        self.assertTrue(is_skin)
        self.assertLess(targets, 20)
        size = self.path("a.glb").stat().st_size
        self.assertEqual(self.targets(self.path("a.rlpc"), "--as", "morph"), (False, 74))
        self.assertLess(2 * size, self.path("a.glb").stat().st_size)

    def test_auto_writes_frames_where_bones_are_not_near_enough(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.2, name="elephant")
        said = self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.glb"), "--max-targets",
                       1).err
        self.assertIn("would leave an error", said)
        self.assertNotIn("skins", document(self.path("a.glb")))

    def test_auto_writes_no_frames_that_viewers_cannot_hold(self):
        self.ok("make_tentacle", 40, 2100, self.path("t"))
        self.ok("rlpcenc", self.path("t.obj"), "--points", self.path("t.pc2"), "-o",
                self.path("a.rlpc"), "--kg", 0.1, "--preset", "fast")
        said = self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.glb"), "--max-targets",
                       0).err
        self.assertRegex(said, r"0 morph targets; differs from the stream by KG error [\d.]+ %")
        self.assertIn("--as morph is exact, but takes 2099 morph targets", said)
        self.assertIn("skins", document(self.path("a.glb")))

    def test_auto_weighs_the_error_against_the_bytes(self):
        self.ok("make_tentacle", 400, 600, self.path("t"))
        self.ok("rlpcenc", self.path("t.obj"), "--points", self.path("t.pc2"), "-o",
                self.path("a.rlpc"), "--kg", 0.2, "--preset", "fast", "--gof", 128, "--gof-kind",
                "skinned")
        # A small error does not outweigh 50 times the bytes; a large one does.
        self.assertEqual(self.targets(self.path("a.rlpc"), "--max-targets", 8), (True, 8))
        self.assertEqual(self.targets(self.path("a.rlpc"), "--max-targets", 1), (False, 599))

    def test_frames_predicted_from_frames_have_no_bones(self):
        self.encode(self.path("a.rlpc"), "--profile", "high", "--low-delay", "--kg", 0.5)
        self.fails(64, ["--as skin", "no bones", "--as morph"], "rlpcdec", self.path("a.rlpc"),
                   "-o", self.path("a.glb"), "--as", "skin")
        self.assertEqual(self.files(), ["a.rlpc"])
        self.assertFalse(self.targets(self.path("a.rlpc"))[0])

    def test_a_skin_needs_memory_for_all_frames(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.2, name="robot_arm")
        limit = ["--max-memory", "1300KiB", "--threads", 1]
        self.fails(3, ["--as skin", "--max-memory"], "rlpcdec", self.path("a.rlpc"), "-o",
                   self.path("a.glb"), "--as", "skin", *limit)
        self.assertFalse(self.targets(self.path("a.rlpc"), *limit)[0])

    def test_only_glb_files_have_bones(self):
        self.encode(self.path("a.rlpc"), "--kg", 1, name="robot_arm")
        for options in (["--as", "morph"], ["--max-targets", 0]):
            self.fails(64, [options[0], "is for .glb files"], "rlpcdec", self.path("a.rlpc"), "-o",
                       self.path("a.pc2"), *options)
        self.assertEqual(self.files(), ["a.rlpc"])

    def test_clips_as_morph_targets(self):
        self.encode_clips()
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.glb"), "--as", "morph",
                "--no-attributes")
        names = [a["name"] for a in document(self.path("a.glb"))["animations"]]
        self.assertEqual(names, ["Sway", "Visit"])
        seen = self.ok("rlpccmp", self.path("a.rlpc"), self.path("a.glb"), "--json", "--no-weld-b",
                       "--animation-b", "all").json()
        self.assertEqual(seen["metrics"]["max_error"], 0)

    def test_a_warning_above_what_viewers_hold(self):
        self.ok("make_tentacle", 40, 2100, self.path("t"))
        self.ok("rlpcenc", self.path("t.obj"), "--points", self.path("t.pc2"), "-o",
                self.path("a.rlpc"), "--kg", 2, "--preset", "fast", "--profile", "baseline")
        said = self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.glb"), "--as",
                       "morph").err
        self.assertIn("more than the 2,000 or so", said)
        self.assertIn("--as skin", said)


class GltfValidator(ToolsTest):
    """The Khronos validator finds no error in what rlpcdec writes."""

    def test_of_the_streams_of_the_suite(self):
        self.check("v1.*/accept/*/*.rlpc", "--as", "morph")

    def test_of_skins(self):
        self.check("v1.*/accept/*/*.rlpc", "--as", "skin")

    def check(self, pattern, *options):
        if main_file("gltf-validator") is None:
            self.skipTest("needs node, and the npm package gltf-validator where node finds it "
                          "(npm install gltf-validator, or NODE_PATH)")
        files = []
        for number, stream in enumerate(sorted((ROOT / "streams").glob(pattern))):
            file = self.path(f"{number}.glb")
            if self.ran(stream, file, *options):
                files.append(file)
        self.assertGreater(len(files), 100)
        for file, issues in zip(files, json.loads(node(VALIDATE, *files)), strict=True):
            wrong = [m for m in issues["messages"] if m["severity"] < 2]  # errors and warnings
            self.assertEqual(wrong, [], file)

    def ran(self, stream, file, *options):
        """Returns False if the positions are too large for floats, or have no bones."""
        try:
            self.ok("rlpcdec", stream, "-o", file, "--quiet", *options)
        except AssertionError as error:
            if "too large for glTF" not in str(error) and "no bones" not in str(error):
                raise
            return False
        return True


# Measures the frames of a .glb file, as three.js computes them, against those of a .pc2 file.
MEASURE = """
const [script, glb, pc2, spans, rate] = process.argv.slice(1);
globalThis.self = globalThis;  // a name that browsers have
const fs = require('fs');
const {pathToFileURL} = require('url');
const load = path => import(pathToFileURL(script + path));
(async () => {
  const THREE = await load('/build/three.module.js');
  const {GLTFLoader} = await load('/examples/jsm/loaders/GLTFLoader.js');
  const bytes = fs.readFileSync(glb);
  const file = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const gltf = await new GLTFLoader().parseAsync(file, '');
  const mesh = gltf.scene.getObjectByProperty('isMesh', true);
  const cache = fs.readFileSync(pc2);
  const count = cache.readInt32LE(16);
  let squares = 0, largest = 0, places = 0;
  JSON.parse(spans).forEach(([first, frames], i) => {
    const mixer = new THREE.AnimationMixer(gltf.scene);
    const action = mixer.clipAction(gltf.animations[i]);
    action.setLoop(THREE.LoopOnce);
    action.clampWhenFinished = true;
    action.play();
    for (let f = 0; f < frames; f++) {
      mixer.setTime(f / rate);
      gltf.scene.updateMatrixWorld(true);
      for (let v = 0; v < count; v++, places++) {
        const p = mesh.getVertexPosition(v, new THREE.Vector3()).toArray();
        const at = 32 + 12 * ((first + f) * count + v);
        const square = p.reduce((sum, x, c) => sum + (x - cache.readFloatLE(at + 4 * c)) ** 2, 0);
        squares += square;
        largest = Math.max(largest, Math.sqrt(square));
      }
    }
    mixer.stopAllAction();
    mixer.uncacheRoot(gltf.scene);
  });
  console.log(JSON.stringify({rms: Math.sqrt(squares / places), largest, places,
                              durations: gltf.animations.map(a => a.duration)}));
})();
"""


class SkinInThreeJs(SkinTest):
    """three.js computes the frames of a skin with the errors that rlpcdec has stated."""

    def setUp(self):
        super().setUp()
        main_js = main_file("three")
        if main_js is None:
            self.skipTest("needs node, and the npm package three where node finds it "
                          "(npm install three, or NODE_PATH)")
        self.three = main_js.parents[1]

    def check(self, stream, spans, rate, *options):
        (_, rms, largest), _, _ = self.write(stream, "--as", "skin", *options)
        self.ok("rlpcdec", stream, "-o", self.path("a.pc2"))
        answer = json.loads(node(MEASURE, self.three, self.path("a.glb"), self.path("a.pc2"),
                                 json.dumps(spans), rate))
        frames = read_pc2(self.path("a.pc2"))
        self.assertEqual(answer["places"],
                         len(frames[0]) // 3 * sum(count for _, count in spans))
        size = max(map(abs, frames[0]))
        self.assertAlmostEqual(answer["rms"], rms, delta=0.002 * rms + 1e-6 * size)
        self.assertAlmostEqual(answer["largest"], largest, delta=0.002 * largest + 1e-5 * size)
        for duration, (_, count) in zip(answer["durations"], spans, strict=True):
            self.assertAlmostEqual(duration, (count - 1) / rate, places=5)

    def test_of_bones(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.2, "--fps", 24, name="robot_arm")
        self.check(self.path("a.rlpc"), [[0, 75]], 24)
        self.check(self.path("a.rlpc"), [[0, 75]], 24, "--max-targets", 0)

    def test_of_clusters(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.3, "--profile", "baseline", "--fps", 30,
                    name="elephant")
        self.check(self.path("a.rlpc"), [[0, 60]], 30)

    def test_of_clips(self):
        stream = self.encode_clips()
        clips = self.ok("rlpcinfo", stream, "--json").json()["clips"]
        self.assertEqual(len(clips), 2)
        self.check(stream, [[c["first_frame"], c["num_frames"]] for c in clips], 30)

    def test_of_models_of_others(self):
        models = ROOT.parent / "shared" / "data" / "gltf"
        if not models.is_dir():
            self.skipTest("needs the models in ../shared/data/gltf")
        for name in ("cesium-man", "fox"):
            self.ok("rlpcenc", models / f"{name}.glb", "--animation", "all", "--preset", "fast",
                    "-o", self.path("a.rlpc"), "--quiet")
            info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
            clips = info.get("clips") or [{"first_frame": 0, "num_frames": info["num_frames"]}]
            self.check(self.path("a.rlpc"), [[c["first_frame"], c["num_frames"]] for c in clips],
                       24)


# Plays the animation up to each time; posts its duration, and the positions of vertices.
PAGE = """<!DOCTYPE html>
<script type="importmap">
{"imports": {"three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"}}
</script>
<script type="module">
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
async function play({file, times, vertices}) {
  const gltf = await new GLTFLoader().loadAsync(file);
  const mesh = gltf.scene.getObjectByProperty('isMesh', true);
  const mixer = new THREE.AnimationMixer(gltf.scene);
  const action = mixer.clipAction(gltf.animations[0]);
  action.setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  const positions = times.map(time => {
    mixer.setTime(time);
    return vertices.map(v => mesh.getVertexPosition(v, new THREE.Vector3()).toArray());
  });
  return {duration: gltf.animations[0].duration, count: mesh.geometry.attributes.position.count,
          triangles: Array.from(mesh.geometry.index.array), positions};
}
const answer = await fetch('/task').then(task => task.json()).then(play)
    .catch(error => ({error: String(error)}));
await fetch('/answer', {method: 'POST', body: JSON.stringify(answer)});
</script>
"""


class Server(http.server.ThreadingHTTPServer):
    """Serves the page and the files it requests, and receives its answer."""

    def __init__(self, three, task, file):
        super().__init__(("127.0.0.1", 0), Handler)
        self.three = three
        self.texts = {"/": PAGE.encode(), "/task": json.dumps(task).encode(),
                      task["file"]: file.read_bytes()}
        self.answers = queue.Queue()


class Handler(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        data = self.server.texts.get(self.path)
        if data is None and self.path.startswith("/three/"):
            data = (self.server.three / self.path.removeprefix("/three/")).read_bytes()
        self.send_response(404 if data is None else 200)
        self.send_header("Content-Type", "text/javascript" if self.path.endswith(".js")
                         else "text/html")
        self.end_headers()
        self.wfile.write(data or b"")

    def do_POST(self):
        data = self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(200)
        self.end_headers()
        self.server.answers.put(json.loads(data))

    def log_message(self, *_):
        pass


class ThreeJs(ToolsTest):
    """three.js in a browser plays what rlpcdec writes."""

    def setUp(self):
        super().setUp()
        main_js = main_file("three")
        self.browser = shutil.which("chromium")
        if main_js is None or self.browser is None:
            self.skipTest("needs chromium, node, and the npm package three where node finds it "
                          "(npm install three, or NODE_PATH)")
        self.three = main_js.parents[1]

    def answer(self, task, file):
        with Server(self.three, task, file) as server, tempfile.TemporaryDirectory() as home:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            options = ["--headless", "--disable-gpu", "--no-first-run", "--disable-sync",
                       "--disable-background-networking", "--disable-component-update",
                       f"--user-data-dir={home}/profile"]
            if os.geteuid() == 0:
                options.append("--no-sandbox")  # Chromium has no sandbox for root
            with subprocess.Popen([self.browser, *options,
                                   f"http://127.0.0.1:{server.server_port}/"],
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as browser:
                try:
                    return server.answers.get(timeout=90)
                finally:
                    browser.terminate()
                    browser.wait()
                    server.shutdown()

    def play(self, name, rate):
        stream = self.path("a.rlpc")
        self.ok("rlpcenc", INPUTS / f"{name}.obj", "--points", INPUTS / f"{name}.pc2", "--fps",
                rate, "-o", stream, "--preset", "fast", "--kg", 0.5, "--quiet")
        self.ok("rlpcdec", stream, "-o", self.path("a.glb"), "--as", "morph")
        self.ok("rlpcdec", stream, "-o", self.path("a.pc2"))
        frames = read_pc2(self.path("a.pc2"))
        last = len(frames) - 1
        places = [0, 1, 2.25, 7.5, last / 2, last - 1, last]  # in frames
        vertices = range(0, len(frames[0]) // 3, 7)
        task = {"file": "/a.glb", "times": [p / rate for p in places], "vertices": [*vertices]}
        answer = self.answer(task, self.path("a.glb"))
        self.assertNotIn("error", answer)
        self.assertEqual(answer["count"], len(frames[0]) // 3)
        self.assertEqual(answer["triangles"],
                         [v for t in read_obj(self.path("a.obj"))[1] for v in t])
        self.assertAlmostEqual(answer["duration"], last / rate, places=5)
        for place, positions in zip(places, answer["positions"], strict=True):
            a, b = frames[int(place)], frames[min(int(place) + 1, last)]
            for v, position in zip(vertices, positions, strict=True):
                for c, x in enumerate(position, start=3 * v):
                    wanted = a[c] + (place % 1) * (b[c] - a[c])
                    self.assertAlmostEqual(x, wanted, delta=1e-5, msg=f"frame {place}, vertex {v}")

    def test_a_body_that_moves_everywhere(self):
        self.play("elephant", 24)

    def test_rigid_parts_of_which_some_rest(self):
        self.play("robot_arm", 30)


if __name__ == "__main__":
    main()
