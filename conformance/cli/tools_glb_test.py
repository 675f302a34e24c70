#!/usr/bin/env python3
"""The .glb files of rlpcdec in third-party programs: the Khronos validator, and three.js in
Chromium. A test is skipped if its program is not installed.

    tools_glb_test.py --bin BUILD/bin [unittest arguments, such as GltfValidator]
"""

import http.server
import json
import os
import pathlib
import queue
import shutil
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


class GltfValidator(ToolsTest):
    """The Khronos validator finds no error in what rlpcdec writes."""

    def test_of_the_streams_of_the_suite(self):
        if main_file("gltf-validator") is None:
            self.skipTest("needs node, and the npm package gltf-validator where node finds it "
                          "(npm install gltf-validator, or NODE_PATH)")
        files = []
        for number, stream in enumerate(sorted((ROOT / "streams").glob("v1.*/accept/*/*.rlpc"))):
            file = self.path(f"{number}.glb")
            if self.ran(stream, file):
                files.append(file)
        self.assertGreater(len(files), 100)
        for file, issues in zip(files, json.loads(node(VALIDATE, *files)), strict=True):
            wrong = [m for m in issues["messages"] if m["severity"] < 2]  # errors and warnings
            self.assertEqual(wrong, [], file)

    def ran(self, stream, file):
        """Returns False if the positions are too large for floats."""
        try:
            self.ok("rlpcdec", stream, "-o", file, "--quiet")
        except AssertionError as error:
            if "too large for glTF" not in str(error):
                raise
            return False
        return True


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
        self.ok("rlpcdec", stream, "-o", self.path("a.glb"))
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
