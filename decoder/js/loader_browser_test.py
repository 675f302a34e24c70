#!/usr/bin/env python3
"""RLPCLoader of the packed package, and the mesh that it makes, in Chromium.

  loader_browser_test.py --bin FOLDER

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "testing"))
from in_scene import InScene  # noqa: E402
from player_testing import main  # noqa: E402


class Loader(InScene):
    """RLPCLoader, and the mesh that it makes."""

    def test_the_mesh_is_drawn_and_moves(self):
        result = self.run_script("""
            globalThis.mesh = await show('walk.rlpc');
            const [first, background] = [pixel(-0.2, 0.03), pixel(-0.6, 0.4)];
            const before = mesh.geometry.attributes.position.array.slice();
            mesh.play();
            const start = performance.now();
            while (mesh.frame < 20 && performance.now() - start < 20000) {
              mesh.update(1 / 30);
              renderer.render(scene, camera);
              await new Promise((next) => setTimeout(next, 5));
            }
            const after = mesh.geometry.attributes.position.array;
            return { first, background, frame: mesh.frame, hash: await sha256(after),
                     moved: after.some((x, i) => x !== before[i]) };""")
        self.browser.screenshot(self.folder / "scene.png")
        self.assertGreater(sum(result["first"][:3]) - sum(result["background"][:3]), 60)
        self.assertTrue(result["moved"])
        self.assertEqual(result["frame"], 20)
        self.assertEqual(result["hash"], self.hash_of(20))

    def test_bounds_are_those_of_the_frame(self):
        self.assertTrue(self.run_script("""
            const mesh = await show('walk.rlpc');
            mesh.time = 1;
            while (!mesh.update(0)) await new Promise((next) => setTimeout(next, 5));
            const { boundingBox, boundingSphere, attributes } = mesh.geometry;
            const box = new THREE.Box3().setFromBufferAttribute(attributes.position);
            const point = new THREE.Vector3();
            for (let i = 0; i < attributes.position.count; ++i) {
              point.fromBufferAttribute(attributes.position, i);
              if (boundingSphere.distanceToPoint(point) > 1e-6) return false;
            }
            return mesh.frame === 30 && box.equals(boundingBox);"""))

    def play(self, script, until="false", ticks=400):
        """The frames that are shown, with a picture each 1/30 s."""
        return self.run_script(f"""
            const mesh = await show('walk.rlpc');
            const shown = [];
            let finished = 0;
            mesh.addEventListener('frame', ({{ index }}) => shown.push(index));
            mesh.addEventListener('finished', () => ++finished);
            {script}
            for (let i = 0; i < {ticks} && !({until}); ++i) {{
              mesh.update(1 / 30);
              await new Promise((next) => setTimeout(next, 2));
            }}
            return {{ shown, finished, playing: mesh.playing, time: mesh.time,
                      duration: mesh.duration, clip: mesh.clip?.name ?? null }};""")

    def test_a_clip_is_repeated(self):
        result = self.play("mesh.play('Walk');", "shown.length >= 30")
        self.assertEqual(result["shown"][:26], [*range(4, 16), *range(4, 16), 4, 5])
        self.assertEqual(result["clip"], "Walk")
        self.assertAlmostEqual(result["duration"], 0.4)

    def test_a_clip_is_played_once(self):
        result = self.play("mesh.loop = THREE.LoopOnce; mesh.play('Walk');", "finished")
        self.assertEqual(result["shown"], [*range(4, 16)])
        self.assertEqual((result["finished"], result["playing"]), (1, False))

    def test_a_clip_to_and_fro(self):
        result = self.play("mesh.loop = THREE.LoopPingPong; mesh.play('Walk');",
                           "shown.length >= 26")
        self.assertEqual(result["shown"][:24], [*range(4, 16), *range(14, 3, -1), 5])

    def test_backwards(self):
        result = self.play("mesh.speed = -1; mesh.play('Walk');", "shown.length >= 14")
        self.assertEqual(result["shown"][:14], [*range(15, 3, -1), 15, 14])

    def test_pause_stop_and_time(self):
        result = self.run_script("""
            const mesh = await show('walk.rlpc');
            const settle = async () => {
              for (let i = 0; i < 40; ++i) {
                mesh.update(0.03);
                await new Promise((next) => setTimeout(next, 5));
              }
              return mesh.frame;
            };
            mesh.play('Wave "again"').pause();
            mesh.time = 0.5;
            const frames = [await settle()];
            mesh.stop();
            frames.push(await settle());
            mesh.play(null).pause();
            frames.push(await settle());
            return frames;""")
        self.assertEqual(result, [35, 20, 0])

    def test_a_clip_that_is_not_there(self):
        error = self.error_of("(await show('walk.rlpc')).play('Run');")
        self.assertEqual(error["name"], "RangeError")
        self.assertIn('"Walk", "Wave "again""', error["message"])

    def test_a_material_of_ones_own(self):
        self.assertEqual(self.run_script("""
            const made = [];
            const material = (decoder) => {
              made.push(decoder.info.vertices);
              return new THREE.MeshBasicMaterial({ color: 0xff0000 });
            };
            await show('walk.rlpc', { material, normals: false });
            return [made, pixel(-0.2, 0.03)];"""), [[538], [255, 0, 0, 255]])

    def test_a_ray_hits_what_is_shown(self):
        self.assertTrue(self.run_script("""
            const mesh = await show('walk.rlpc');
            scene.updateMatrixWorld(true);
            const { center } = mesh.geometry.boundingSphere;
            const target = mesh.localToWorld(center.clone());
            const ray = new THREE.Raycaster(camera.position,
              target.sub(camera.position).normalize());
            return ray.intersectObject(mesh).length > 0;"""))

    def test_errors_and_progress(self):
        result = self.run_script("""
            const steps = [];
            const mesh = await new RLPCLoader().loadAsync('walk.rlpc', (event) => steps.push(event));
            const error = await new RLPCLoader().loadAsync('none.rlpc').catch((error) => error);
            const failed = [];
            const bytes = new Uint8Array(await (await fetch('walk.rlpc')).arrayBuffer());
            bytes[bytes.length / 2 | 0] ^= 16;
            const damaged = await new RLPCLoader().open(bytes);
            damaged.addEventListener('error', ({ error, index }) => failed.push([index, error.rule]));
            damaged.play();
            for (let i = 0; i < 400 && damaged.frame < 50; ++i) {
              damaged.update(1 / 30);
              await new Promise((next) => setTimeout(next, 2));
            }
            return { step: steps.at(-1), kind: error.kind, failed: failed.length,
                     rule: failed[0]?.[1], frame: damaged.frame };""")
        self.assertTrue(result["step"]["lengthComputable"])
        self.assertEqual(result["kind"], "network")
        self.assertEqual((result["failed"], result["rule"]), (3, "R-UNT-03"))
        self.assertGreaterEqual(result["frame"], 50)

    def test_nothing_is_left_after_dispose(self):
        result = self.run_script("""
            const mesh = await show('walk.rlpc');
            renderer.render(scene, camera);
            const copy = mesh.clone();
            const before = renderer.info.memory.geometries;
            mesh.removeFromParent();
            mesh.dispose();
            const error = await mesh.decoder.frame(0).catch((error) => error);
            return { freed: before - renderer.info.memory.geometries, kind: error.kind,
                     shared: copy.geometry === mesh.geometry && copy.type };""")
        self.assertEqual(result, {"freed": 1, "kind": "closed", "shared": "Mesh"})

    def test_the_example(self):
        self.browser.open(f"{self.server.address}/node_modules/rlpc/examples/index.html"
                          "?src=/walk.rlpc")
        self.browser.wait_for("document.querySelector('canvas') !== null")
        middle = """(() => {
          const canvas = document.querySelector('canvas');
          const copy = document.createElement('canvas');
          Object.assign(copy, { width: canvas.width, height: canvas.height });
          const context = copy.getContext('2d');
          return new Promise((done) => requestAnimationFrame(() => {
            context.drawImage(canvas, 0, 0);
            done(Math.max(...context.getImageData(copy.width / 2, copy.height / 2, 1, 1).data
              .slice(0, 3)));
          }));
        })()"""
        self.browser.wait_for(f"(async () => await {middle} > 80)()")
        self.browser.screenshot(self.folder / "example.png")


if __name__ == "__main__":
    main()
