#!/usr/bin/env python3
"""RLPCLoader of the packed package, and the mesh that it makes, in Chromium.

  loader_browser_test.py --bin FOLDER

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "testing"))
from in_scene import InScene
import textured_box
from player_testing import STREAMS, main


COLOURS = {(True, False, False): "red", (False, True, False): "green",
           (False, False, True): "blue", (True, True, True): "white"}


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

    def test_a_material_of_ones_own(self):
        self.assertEqual(self.run_script("""
            const made = [];
            const material = (decoder) => {
              made.push(decoder.info.vertices);
              return new THREE.MeshBasicMaterial({ color: 0xff0000 });
            };
            await show('walk.rlpc', { material, normals: false });
            return [made, pixel(-0.2, 0.03)];"""), [[538], [255, 0, 0, 255]])

    def colours(self, script):
        """Of four places on the front of a mesh, from the upper left; "other" if it is not one of
        those of the texture."""
        places = "[[-0.1, 0.1], [0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]]"
        pixels = self.run_script(f"""
            {script}
            lookAtFront();
            return pixels({places});""")
        return [COLOURS.get(tuple(value > 90 for value in pixel[:3]), "other") for pixel in pixels]

    def test_a_texture_is_the_right_way_up(self):
        self.assertEqual(self.colours("await show('box.rlpc');"),
                         ["red", "green", "blue", "white"])
        self.browser.screenshot(self.folder / "texture.png")

    def test_it_looks_as_gltf_loader_shows_the_source(self):
        """A box that turns: one that leans has normals that are some degrees off."""
        self.encode_box("turning", turns=True)
        pixels = self.run_script("""
            const hemisphere = Array.from({ length: 400 }, (_, i) =>
              [(i % 20) / 40 - 0.25, Math.floor(i / 20) / 40 - 0.25]);
            const all = [];
            const mesh = await show('turning.rlpc');
            const gltf = (await new GLTFLoader().loadAsync('turning.glb')).scene;
            for (const one of [gltf, mesh]) {
              one.scale.copy(mesh.scale);
              one.position.copy(mesh.position);
              scene.remove(mesh, gltf);
              scene.add(one);
              camera.position.set(1, 2, 4);
              camera.lookAt(0, 0, 0);
              all.push(pixels(hemisphere));
            }
            return all;""")
        differing = [a for a, b in zip(*pixels) if max(abs(x - y) for x, y in zip(a, b)) > 4]
        self.assertLess(len(differing), 16)  # at edges: positions are not exact
        self.assertGreater(len({tuple(pixel) for pixel in pixels[0]}), 5)

    def test_colours_of_vertices(self):
        colours, look = self.run_script("""
            const mesh = await show('colours.rlpc');
            lookAtFront();
            const { attributes, groups } = mesh.geometry;
            return [pixel(0.1, 0.1), [mesh.material.map(({ vertexColors }) => vertexColors),
              Object.keys(attributes).sort(), groups.map(({ count }) => count)]];""")
        self.assertGreater(colours[1], colours[0] + 80)
        self.assertEqual(look, [[True, True], ["color", "normal", "position"], [30, 6]])

    def test_materials_and_what_they_need(self):
        told = self.run_script("""
            const { geometry, material } = await show('box.rlpc');
            const { attributes, groups } = geometry;
            return { names: Object.keys(attributes).sort(), groups,
              vertices: attributes.position.count,
              colours: material.map(({ color }) => color.toArray()),
              maps: material.map(({ map }) => map && [map.flipY, map.colorSpace]),
              vertexColors: material.some(({ vertexColors }) => vertexColors) };""")
        self.assertEqual(told["names"], ["normal", "position", "uv"])
        self.assertEqual(told["vertices"], 24)
        self.assertEqual(told["groups"], [{"start": 0, "count": 30, "materialIndex": 0},
                                          {"start": 30, "count": 6, "materialIndex": 1}])
        self.assertEqual(told["colours"], [[1, 1, 1], [1, 0, 1]])
        self.assertEqual(told["maps"], [[False, "srgb"], None])
        self.assertFalse(told["vertexColors"])

    def test_normals_are_those_of_the_frame(self):
        self.assertTrue(self.run_script("""
            const mesh = await show('box.rlpc');
            mesh.time = 4 / 30;
            while (!mesh.update(0)) await new Promise((next) => setTimeout(next, 5));
            const { normals } = await mesh.decoder.frame(4, { drawn: true, normals: true });
            return normals.every((x, i) => x === mesh.geometry.attributes.normal.array[i]);"""))

    def test_less_than_the_stream_has(self):
        plain = self.run_script("""
            const told = ({ geometry, material }) => [Object.keys(geometry.attributes).sort(),
              geometry.groups.length, [material].flat().map(({ map }) => map !== null)];
            return [told(await show('box.rlpc', { attributes: false })),
                    told(await show('box.rlpc', { textures: false })),
                    told(await show('walk.rlpc'))];""")
        self.assertEqual(plain, [[["normal", "position"], 0, [False]],
                                 [["normal", "position", "uv"], 2, [False, False]],
                                 [["normal", "position"], 0, [False]]])
        self.assertEqual(self.run_script("return warnings;"), [])

    def test_materials_and_loaders_of_ones_own(self):
        self.assertEqual(self.run_script("""
            const own = (color) => new THREE.MeshBasicMaterial({ color });
            const one = await show('box.rlpc', { material: own(0xff0000) });
            lookAtFront();
            const first = pixel(0.1, 0.1);
            one.removeFromParent();
            const two = await show('box.rlpc', { material: [own(0x00ff00), own(0x0000ff)] });
            lookAtFront();
            const numbers = two.geometry.groups.map(({ materialIndex }) => materialIndex);
            two.removeFromParent();
            let parsed = 0;
            const gltfLoader = new GLTFLoader();
            gltfLoader.register((parser) => ({ name: "COUNTS", beforeRoot: () => void ++parsed }));
            await show('box.rlpc', { gltfLoader });
            return [first, numbers, parsed, "uv" in one.geometry.attributes];"""),
                         [[255, 0, 0, 255], [0, 1], 1, True])

    def test_without_gltf_loader_it_says_what_to_do(self):
        page = (self.folder / "scene.html").read_text()
        lines = [line for line in page.splitlines() if "three/addons" not in line]
        (self.folder / "bare.html").write_text("\n".join(lines).replace("GLTFLoader, Rlpc", "Rlpc"))
        self.browser.open(f"{self.server.address}/bare.html")
        self.browser.wait_for("globalThis.isReady")
        told = self.run_script("""
            const meshes = [await show('box.rlpc'), await show('box.rlpc')];
            return [warnings, meshes[0].material.isMeshStandardMaterial,
                    "uv" in meshes[0].geometry.attributes];""")
        self.assertEqual((len(told[0]), told[1], told[2]), (1, True, True))
        self.assertIn('"three/addons/" to the import map', told[0][0])

    def test_a_content_security_policy(self):
        """The README names what textures need."""
        page = (self.folder / "scene.html").read_text()
        told = []
        for name, blobs in (("open", "blob:"), ("closed", "")):
            policy = ("default-src 'self'; style-src 'unsafe-inline'; script-src 'self' "
                      f"'unsafe-inline' 'wasm-unsafe-eval'; connect-src 'self' {blobs}; "
                      f"img-src 'self' data: {blobs}")
            meta = f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
            (self.folder / f"{name}.html").write_text(page.replace('<meta charset="utf-8">',
                                                                   f'<meta charset="utf-8">{meta}'))
            self.browser.open(f"{self.server.address}/{name}.html")
            self.browser.wait_for("globalThis.isReady")
            told.append(self.run_script("""
                const mesh = await show('box.rlpc');
                return [mesh.material].flat().some(({ map }) => map?.image?.width > 0);"""))
        self.assertEqual(told, [True, False])

    def test_damaged_attributes_and_assets_leave_a_plain_mesh(self):
        suite = STREAMS / "v1.2" / "either"
        for name, source, text in (("attributes", "ATT/ATT-0001x2", "R-ATT-03"),
                                   ("asset", "AST/AST-0001x1", "R-AST-01")):
            shutil.copy(suite / f"{source}.rlpc", self.folder / f"{name}.rlpc")
            told = self.run_script(f"""
                const mesh = await show('{name}.rlpc');
                return [mesh.frame, mesh.material.isMeshStandardMaterial, warnings.splice(0)];""")
            self.assertEqual((told[0], told[1], len(told[2])), (0, True, 1))
            self.assertIn(text, told[2][0])

    def test_units_with_a_wrong_crc_leave_a_plain_mesh(self):
        stream, at, damaged = bytearray((self.folder / "box.rlpc").read_bytes()), 10, 0
        while at < len(stream):
            size = 5 + int.from_bytes(stream[at + 1:at + 5], "big")
            if stream[at] in (0x83, 0x88, 0x89, 0x8A):  # metadata, attributes, asset, clips
                stream[at + size] ^= 1
                damaged += 1
            at += size + 4
        self.assertGreater(damaged, 1)
        (self.folder / "crc.rlpc").write_bytes(stream)
        told = self.run_script("""
            const mesh = await show('crc.rlpc');
            const strict = await RlpcDecoder.open('crc.rlpc', { skipDamagedUnits: false })
              .catch((error) => error);
            return [mesh.frame, mesh.material.isMeshStandardMaterial, warnings.splice(0),
                    mesh.decoder.info.damagedUnits, strict.rule];""")
        self.assertEqual((told[0], told[1], told[3], told[4]), (0, True, damaged, "R-UNT-03"))
        self.assertEqual(told[2], ["RLPCLoader: attributes, materials, clips or metadata are "
                                   "damaged, and left out"])

    def test_an_asset_that_is_no_glb(self):
        told = self.run_script("""
            const { constructor: RLPCMesh } = await show('box.rlpc');
            const all = [];
            for (const options of [{}, { textures: false }]) {
              const decoder = await RlpcDecoder.open('box.rlpc');
              decoder.asset = async () => new Uint8Array(40);
              const mesh = await RLPCMesh.create(decoder, options);
              all.push([mesh.frame, mesh.material.isMeshStandardMaterial, warnings.splice(0)]);
            }
            return all;""")
        for frame, is_plain, warnings in told:
            self.assertEqual((frame, is_plain), (0, True))
            self.assertIn("materials are left out", warnings[0])

    def test_textures_are_disposed_of(self):
        self.assertEqual(self.run_script("""
            const mesh = await show('box.rlpc');
            renderer.render(scene, camera);
            const { textures } = renderer.info.memory;
            mesh.removeFromParent();
            mesh.dispose();
            return textures - renderer.info.memory.textures;"""), 1)

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
            const mesh = await new RLPCLoader().loadAsync('walk.rlpc',
              (event) => steps.push(event));
            const error = await new RLPCLoader().loadAsync('none.rlpc').catch((error) => error);
            const failed = [];
            const bytes = new Uint8Array(await (await fetch('walk.rlpc')).arrayBuffer());
            bytes[bytes.length / 2 | 0] ^= 16;
            const damaged = await new RLPCLoader().open(bytes);
            damaged.addEventListener('error',
              ({ error, index }) => failed.push([index, error.rule]));
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
            const empty = { ...renderer.info.memory };
            const copy = mesh.clone();
            scene.add(copy);
            renderer.render(scene, camera);
            const before = renderer.info.memory.geometries;
            mesh.removeFromParent();
            mesh.dispose();
            copy.update(0);
            renderer.render(scene, camera); // the clone needs nothing of it
            const open = await copy.decoder.frame(0).then(({ index }) => index);
            copy.removeFromParent();
            copy.dispose();
            const error = await mesh.decoder.frame(0).catch((error) => error);
            return { freed: before - renderer.info.memory.geometries, open, kind: error.kind,
                     isOwn: copy.geometry !== mesh.geometry && copy.type };""")
        self.assertEqual(result, {"freed": 2, "open": 0, "kind": "closed", "isOwn": "RLPCMesh"})

    def test_what_is_between_frames(self):
        result = self.run_script("""
            const mesh = await show('walk.rlpc');
            const [a, b] = [await mesh.decoder.frame(20), await mesh.decoder.frame(21)];
            await mesh.seek(20.25 / 30);
            const shown = mesh.geometry.attributes.position.array;
            const off = shown.reduce((most, x, i) =>
              Math.max(most, Math.abs(x - 0.75 * a.positions[i] - 0.25 * b.positions[i])), 0);
            const moved = a.positions.reduce((most, x, i) =>
              Math.max(most, Math.abs(x - b.positions[i])), 0);
            mesh.interpolate = false;
            await mesh.seek(20.25 / 30);
            return { off, moved, hash: await sha256(mesh.geometry.attributes.position.array) };""")
        self.assertLess(result["off"], 1e-6)
        self.assertGreater(result["moved"], 1e-3)
        self.assertEqual(result["hash"], self.hash_of(20))

    def test_actions_and_clones_with_few_decoded_frames(self):
        result = self.run_script("""
            const mesh = await show('walk.rlpc');
            const { decoder } = mesh;
            let decoded = 0;
            const frame = decoder.frame.bind(decoder);
            decoder.frame = (...options) => {
              ++decoded;
              return frame(...options);
            };
            const clones = Array.from({ length: 50 }, () => mesh.clone());
            const mixers = clones.map((clone, i) => {
              const mixer = new THREE.AnimationMixer(clone);
              const [walk, wave] = clone.animations.map((clip) => mixer.clipAction(clip));
              walk.play();
              wave.play().time = i / 45;
              walk.crossFadeTo(wave, 0.5, true);
              scene.add(clone);
              return mixer;
            });
            for (let i = 0; i < 40; ++i) {
              for (const mixer of mixers) mixer.update(1 / 60);
              renderer.render(scene, camera);
              await new Promise((next) => setTimeout(next, 5));
            }
            await Promise.all(clones.map((clone) => clone.ready()));
            // The fade is over: each shows its place in the second clip.
            let off = 0;
            for (const [i, clone] of clones.entries()) {
              const action = mixers[i].existingAction(clone.animations[1]);
              const place = 20 + 30 * action.time;
              const [a, b] = await Promise.all([Math.floor(place), Math.floor(place) + 1].map(
                (index) => frame(Math.min(index, 59))));
              clone.geometry.attributes.position.array.forEach((x, k) => {
                const part = place - Math.floor(place);
                const mixed = (1 - part) * a.positions[k] + part * b.positions[k];
                off = Math.max(off, Math.abs(x - mixed));
              });
            }
            return { decoded, off };""")
        self.assertLess(result["off"], 1e-4)
        self.assertLessEqual(result["decoded"], 60)  # each frame once

    def test_levels_of_detail_have_the_texture(self):
        """Around the tube, its colours are where they are in the finest mesh."""
        self.encode_glb("tube", textured_box.tube(24, 36))
        told = self.run_script("""
            const mesh = await show('tube.rlpc');
            const turns = [0.6, 1.3, 2.2, 2.9, 3.8, 4.4, 5.3, 6.1];
            const colours = () => turns.flatMap((turn) => {
              mesh.rotation.y = turn;
              return [pixel(0, -0.1), pixel(0, 0.1)].map((rgb) => rgb.slice(0, 3));
            });
            lookAtFront();
            const all = [colours()];
            const sizes = [mesh.geometry.index.count / 3];
            for (const [layers, distance] of [[17, 10], [15, 20]]) {
              mesh.level = await mesh.addLevel({ layers, distance });
              all.push(colours());
              sizes.push(mesh.geometry.index.count / 3);
            }
            const coarse = await show('tube.rlpc', { coarseLayers: 15 });
            const levels = [3, 11, 9.5, 8.5, 30, 19, 12].map((distance) => {
              camera.position.set(0, 0, distance + 0.001);
              camera.updateMatrixWorld();
              mesh.updateMatrixWorld();
              return mesh.selectLevel(camera).level;
            });
            return { all, sizes, levels, coarse: [coarse.geometry.index.count / 3,
              Object.keys(coarse.geometry.attributes).sort(), coarse.material.length] };""")
        self.browser.screenshot(self.folder / "level.png")
        finest, *coarser = told["all"]
        self.assertEqual(len({tuple(x > 90 for x in colour) for colour in finest}), 5)
        for colours in coarser:
            off = [max(abs(x - y) for x, y in zip(a, b)) for a, b in zip(finest, colours)]
            self.assertLess(sum(one > 60 for one in off), 3, (finest, colours))
        self.assertEqual(told["sizes"], sorted(told["sizes"], reverse=True))
        self.assertEqual(told["levels"], [0, 1, 0, 0, 2, 1, 1])
        self.assertEqual(told["coarse"],
                         [told["sizes"][2], ["normal", "position", "uv"], 2])

    def test_the_crowd(self):
        self.browser.open(f"{self.server.address}/node_modules/rlpc/examples/crowd.html"
                          "?src=/walk.rlpc&count=200&layers=5")
        self.browser.wait_for("globalThis.measured?.rate > 0")
        told = self.browser.evaluate("document.getElementById('told').textContent")
        print(f"in Chromium, drawn by the processor: {told}")
        self.browser.screenshot(self.folder / "crowd.png")
        self.assertIn("200 clones", told)
        measured = self.browser.evaluate("globalThis.measured")
        self.assertGreater(measured["decoded"], 10)
        self.assertLessEqual(measured["decoded"], len(self.frames))  # each once, for all clones

    def test_the_example(self):
        self.browser.open(f"{self.server.address}/node_modules/rlpc/examples/index.html"
                          "?src=/box.rlpc")
        self.browser.wait_for("document.querySelector('canvas') !== null")
        middle = """(() => {
          const canvas = document.querySelector('canvas');
          const copy = document.createElement('canvas');
          Object.assign(copy, { width: canvas.width, height: canvas.height });
          const context = copy.getContext('2d');
          return new Promise((done) => requestAnimationFrame(() => {
            context.drawImage(canvas, 0, 0);
            const [red, green, blue] =
              context.getImageData(0.48 * copy.width, 0.45 * copy.height, 1, 1).data;
            done(Math.max(red, green, blue) - Math.min(red, green, blue)); // of the texture
          }));
        })()"""
        self.browser.wait_for(f"(async () => await {middle} > 80)()")
        self.browser.screenshot(self.folder / "example.png")


if __name__ == "__main__":
    main()
