#!/usr/bin/env python3
"""The player in Chromium.

  player_browser_test.py --bin FOLDER [Browser.test_NAME]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import re
import struct

from in_browser import InBrowser
from player_testing import PLAYER, STREAMS, Decoded, main, run


class Browser(InBrowser):
    """Pages that rlpcdec writes; each has the frames that rlpcdec decodes."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.stream = cls.encode("clip.rlpc", "--gof", "20")

    def open(self, stream, fragment="", *arguments, code=0):
        page = self.folder / f"{stream.stem}.html"
        done = run("rlpcdec", stream, "--html", page, "--player", PLAYER, *arguments)
        self.assertEqual(done.returncode, code, done.stderr)
        self.browser.open("about:blank")
        self.browser.open(f"{page.as_uri()}#{fragment}")
        self.browser.wait_for("document.body?.dataset.state === 'ready'")

    def wait_for_check(self):
        """And until the page says so, which it does with the next picture."""
        self.browser.wait_for("player.states.isComplete")
        self.browser.evaluate("new Promise((next) => requestAnimationFrame(() => "
                              "requestAnimationFrame(() => next(true))))")

    def states(self):
        return self.browser.evaluate("[...player.states.states]")

    def test_frames_are_those_of_rlpcdec(self):
        self.open(self.stream, "frame=33")
        self.wait_for_check()
        self.wait_for_frame(33)
        crcs = Decoded(self.stream, self.folder).crcs
        self.assertEqual(self.browser.evaluate("[...player.states.crcs]"), crcs)
        self.assertEqual(self.states(), [2] * 60)
        self.assertIn("bit-exact", self.text("hash"))
        self.assertIn(f"{crcs[33]:08x}", self.text("hash"))
        self.assertIn("60 of 60 frames", self.text("hash"))

    def test_the_mesh_is_seen(self):
        self.open(self.stream, "frame=20")
        self.wait_for_frame(20)
        shot = self.folder / "shot.png"
        self.browser.screenshot(shot)
        self.assertTrue(shot.read_bytes().startswith(b"\x89PNG"))
        # The middle of the view is opaque and lit; without the surface, one sees through it.
        middle = """(() => {
          player.viewer.set({ wire: 'MODE' });
          player.viewer.draw();
          const { gl } = player.viewer;
          const pixel = new Uint8Array(4);
          gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA,
                        gl.UNSIGNED_BYTE, pixel);
          return [...pixel];
        })()"""
        *colour, opacity = self.browser.evaluate(middle.replace("MODE", "off"))
        self.assertEqual(opacity, 255)
        self.assertGreater(min(colour), 40)
        self.assertLess(self.browser.evaluate(middle.replace("MODE", "alone"))[3], 255)

    def test_it_says_what_one_waits_for(self):
        """The page as it is before its end has come, then a stream whose frames do not come."""
        whole = self.folder / "whole.html"
        self.assertEqual(run("rlpcdec", self.stream, "--html", whole, "--player",
                             PLAYER).returncode, 0)
        begun = self.folder / "begun.html"
        begun.write_bytes(whole.read_bytes().partition(b"<script")[0])
        self.browser.open("about:blank")
        self.browser.open(begun.as_uri())
        self.browser.wait_for("document.getElementById('message')?.checkVisibility()")
        self.assertEqual(self.text("message"), "Loading …")
        self.open(self.stream, "frame=0")
        self.wait_for_frame(0)
        self.assertFalse(self.browser.evaluate(
            "document.getElementById('message').checkVisibility()"))
        self.browser.evaluate("""(() => {
          const request = player.request.bind(player);
          const released = new Promise((resolve) => (globalThis.release = resolve));
          player.request = (...args) => released.then(() => request(...args));
          player.open('again', player.session.stream);
        })()""")
        self.browser.wait_for("document.body.dataset.state === 'ready'")
        self.assertEqual(self.text("message"), "Decoding …")
        self.browser.evaluate("release()")
        self.browser.wait_for("document.getElementById('message').hidden")

    def test_keys(self):
        self.open(self.stream, "frame=10")
        self.wait_for_frame(10)
        for key, frame in [("ArrowRight", 11), ("ArrowUp", 21), ("ArrowLeft", 20), ("Home", 0),
                           ("ArrowLeft", 59)]:
            self.browser.press(key)
            self.wait_for_frame(frame)
        self.browser.press(" ")
        self.browser.wait_for("player.playback.playing && player.shownFrame < 50")
        self.browser.press(" ")
        self.assertFalse(self.browser.evaluate("player.playback.playing"))
        self.browser.press("w")
        self.browser.wait_for("player.viewer.wire === 'over' && player.viewer.numEdges > 0")
        # Closed and of genus 0 in each part, it has 3/2 edges for each triangle.
        self.assertEqual(self.browser.evaluate("2 * player.viewer.numEdges"),
                         self.browser.evaluate("3 * player.info.triangles"))
        self.browser.press("n")
        self.browser.wait_for("player.viewer.flat")

    def test_the_time_line(self):
        self.open(self.stream, "frame=0")
        self.wait_for_frame(0)
        self.browser.evaluate("""(() => {
          const slider = document.getElementById('slider');
          slider.value = 47;
          slider.dispatchEvent(new Event('input'));
        })()""")
        self.wait_for_frame(47)
        self.assertIn("47", self.text("clock"))

    def test_it_plays_by_itself(self):
        self.open(self.stream)
        self.browser.wait_for("player.shownFrame > 5")
        self.browser.wait_for("player.shownFrame < 5")  # it starts again

    def test_a_hash_that_differs(self):
        stream = STREAMS / "v1.0" / "reject" / "HSH" / "HSH-0001x1.rlpc"
        self.open(stream, "frame=0", code=1)
        self.wait_for_frame(0)
        self.wait_for_check()
        self.assertIn("hash mismatch", self.text("hash"))
        states = self.states()
        self.assertEqual(states[0], 3)
        self.assertEqual(set(states[1:]), {2})  # the others are found to be right
        # It is shown all the same, and is the frame of the stream with the right hash.
        right = Decoded(STREAMS / "v1.0" / "accept" / "HSH" / "HSH-0001a.rlpc", self.folder)
        self.assertEqual(self.browser.evaluate("[...player.states.crcs]"), right.crcs)

    def damaged(self):
        """The stream, with an error in the second of its three GOFs."""
        data = bytearray(self.stream.read_bytes())
        data[len(data) // 2] ^= 0x10
        damaged = self.folder / "damaged.rlpc"
        damaged.write_bytes(data)
        return damaged

    def test_a_damaged_frame(self):
        self.open(self.damaged(), "frame=30", code=1)
        self.wait_for_check()
        self.assertEqual(self.states(), [2] * 20 + [4] * 20 + [2] * 20)
        self.browser.wait_for("document.getElementById('hash').dataset.state === 'error'")
        self.assertIn("R-UNT-", self.text("hash"))
        self.browser.evaluate("player.seek(50)")
        self.browser.wait_for("document.getElementById('hash').dataset.state === 'agrees'")
        self.assertIn("frame 50", self.text("hash"))

    def test_a_damaged_reference_is_no_fault_of_the_stream(self):
        self.open(self.stream, "frame=30", "--reference", self.damaged())
        self.wait_for_frame(30)
        self.wait_for_check()
        self.assertEqual(self.states(), [2] * 60)
        self.assertIn("bit-exact", self.text("hash"))
        self.assertRegex(self.text("deviation"), "reference cannot be decoded: .*R-UNT-")
        self.assertNotIn("RMS", self.text("deviation"))
        self.assertEqual(self.browser.evaluate("player.viewer.deviationScale"), 0)
        self.browser.evaluate("player.seek(50)")
        self.wait_for_frame(50)
        self.assertIn("largest 0, RMS 0", self.text("deviation"))
        self.assertNotIn("decoded", self.text("deviation"))

    def test_a_reference_whose_hash_differs(self):
        hashes = STREAMS / "v1.0"
        self.open(hashes / "accept" / "HSH" / "HSH-0001a.rlpc", "frame=0",
                  "--reference", hashes / "reject" / "HSH" / "HSH-0001x1.rlpc")
        self.wait_for_frame(0)
        self.wait_for_check()
        self.assertEqual(set(self.states()), {2})
        self.assertRegex(self.text("deviation"), "reference does not fit its hash: .*R-HSH-02")
        self.assertIn("largest 0, RMS 0", self.text("deviation"))

    def test_cards_leave_each_other_room(self):
        box = self.encode_box("box")
        for stream in (self.stream, box):
            self.open(stream, "frame=0", "--reference", stream)
            self.wait_for_frame(0)
            self.check_cards()

    def check_cards(self):
        overlaps = """(() => {
          const boxes = [...document.querySelectorAll('.card')].map((card) =>
            card.getBoundingClientRect());
          const inside = boxes.every((a) => a.left >= 0 && a.right <= innerWidth && a.width > 0);
          return !inside || boxes.some((a, i) => boxes.some((b, j) => i < j && a.left < b.right &&
            b.left < a.right && a.top < b.bottom && b.top < a.bottom));
        })()"""
        for width in (1280, 800, 420, 360):
            self.browser.resize(width, 800)
            self.assertFalse(self.browser.evaluate(overlaps), width)
        self.browser.resize(1280, 800)

    def test_playing_goes_on_if_the_check_fails(self):
        self.open(self.stream, "frame=0")
        self.wait_for_check()
        self.browser.evaluate("""(() => {
          player.session.options.worker = () => { throw new Error('no room'); };
          player.checkAll();
        })()""")
        self.browser.wait_for("document.getElementById('hash').innerText.includes('no room')")
        self.assertIn("Not all are checked", self.text("hash"))
        self.browser.evaluate("player.seek(12)")
        self.wait_for_frame(12)
        self.assertEqual(self.browser.evaluate("document.body.dataset.state"), "ready")

    def test_distance_from_a_reference(self):
        coarse = self.encode("coarse.rlpc", "--kg", "2")
        self.open(coarse, "frame=7", "--reference", self.stream)
        self.wait_for_frame(7)
        deviation = self.text("deviation")
        largest = float(re.search(r"largest ([\d.e-]+)", deviation)[1])
        rms = float(re.search(r"RMS ([\d.e-]+)", deviation)[1])
        for shown, native in zip((largest, rms), self.native_deviation(coarse, self.stream, 7)):
            self.assertAlmostEqual(shown / native, 1, delta=0.006)  # of three digits

    def native_deviation(self, stream, reference, frame, num_frames=60):
        """Largest and root mean square distance."""
        frames = []
        for source in (stream, reference):
            out = self.folder / "frame.f32"
            run("rlpcdec", "decode", source, out)
            values = struct.unpack(f"<{out.stat().st_size // 4}f", out.read_bytes())
            size = len(values) // num_frames
            frames.append(values[size * frame:size * (frame + 1)])
        squares = [(a - b) ** 2 for a, b in zip(*frames)]
        distances = [sum(squares[i:i + 3]) for i in range(0, len(squares), 3)]
        return max(distances) ** 0.5, (sum(distances) / len(distances)) ** 0.5

    def test_a_stream_that_is_dropped_takes_the_place_of_another(self):
        held = "[live.size, player.viewer.buffers.size]"
        drawn = "player.shownFrame === 3 && player.viewer.numEdges > 0 && player.viewer.isDrawn"
        self.open(self.stream, "frame=3&wire=over")
        self.browser.wait_for(drawn)
        self.browser.evaluate("""(() => {
          globalThis.live = new Set(player.viewer.buffers.values());
          const { gl } = player.viewer;
          for (const kind of ["Buffer", "VertexArray", "Texture", "Program"]) {
            const [create, destroy] = [gl[`create${kind}`], gl[`delete${kind}`]];
            gl[`create${kind}`] = () => {
              const made = create.call(gl);
              live.add(made);
              return made;
            };
            gl[`delete${kind}`] = (made) => {
              live.delete(made);
              destroy.call(gl, made);
            };
          }
          live.add(player.viewer.vertices);
        })()""")
        before = self.browser.evaluate(held)
        self.browser.evaluate("globalThis.addresses = 0;"
                              "URL.createObjectURL = () => String(++addresses)")
        for _ in range(2):
            self.browser.evaluate("player.shownFrame = undefined;"
                                  "player.open('dropped.rlpc', player.session.stream)")
            self.browser.wait_for(drawn)
        self.assertEqual(self.browser.evaluate(held), before)
        self.assertEqual(self.browser.evaluate("addresses"), 0)

    def test_without_a_stream(self):
        self.browser.open("about:blank")
        self.browser.open(PLAYER.as_uri())
        self.browser.wait_for("document.body?.dataset.state === 'empty'")
        self.assertIn("Drop", self.text("message"))
        self.browser.choose_file("file", self.stream)
        self.browser.wait_for("player.shownFrame > 0")
        self.assertEqual(self.text("name"), "clip.rlpc")

    def test_what_is_not_a_stream_and_then_one(self):
        self.open(self.stream, "frame=0")
        self.browser.choose_file("file", PLAYER)
        self.browser.wait_for("document.body.dataset.state === 'failed'")
        self.assertIn("R-STR-01", self.text("message"))
        self.browser.choose_file("file", self.stream)
        self.browser.wait_for("document.body.dataset.state === 'ready' && player.shownFrame === 0")

    def front(self):
        """Colours of four places on the front of a box, from the upper left."""
        return self.browser.evaluate("""(() => {
          const { viewer } = player;
          Object.assign(viewer.camera, { yaw: 0, pitch: 0, offset: [0, 0, 0] });
          const { gl } = viewer;
          const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
          return [[-1, 1], [1, 1], [-1, -1], [1, -1]].map(([x, y]) => {
            viewer.isDrawn = false;
            viewer.draw();
            const out = new Uint8Array(4);
            gl.readPixels(width / 2 + 0.06 * x * height, height / 2 + 0.06 * y * height, 1, 1,
              gl.RGBA, gl.UNSIGNED_BYTE, out);
            return [...out].slice(0, 3);
          });
        })()""")

    @staticmethod
    def hue(colour):
        """red, green, blue, or grey."""
        highest, lowest = max(colour), min(colour)
        return "grey" if highest - lowest < 50 else ("red", "green", "blue")[colour.index(highest)]

    def test_a_texture_and_without_it(self):
        self.open(self.encode_box("box"), "frame=0")
        self.wait_for_frame(0)
        self.assertEqual([*map(self.hue, self.front())], ["red", "green", "blue", "grey"])
        self.browser.screenshot(self.folder / "textured.png")
        self.assertEqual(self.browser.evaluate("player.viewer.numVertices"), 24)
        self.browser.press("t")
        self.assertEqual({*map(self.hue, self.front())}, {"grey"})
        self.assertEqual(self.browser.evaluate("plain.ariaPressed"), "false")
        self.browser.press("t")
        self.assertEqual(self.hue(self.front()[0]), "red")
        self.assertEqual(self.text("problems"), "")

    def test_colours_of_vertices(self):
        self.open(self.encode_box("colours", [0, 0.5, 0]), "frame=0")
        self.wait_for_frame(0)
        self.assertEqual({*map(self.hue, self.front())}, {"green"})

    def test_normal_maps(self):
        # The key light comes from above, and from the right of the face that is seen.
        up, down, right, left = (128, 218, 218), (128, 38, 218), (218, 128, 218), (38, 128, 218)
        self.open(self.encode_box("bumps", rows=((up, down), (right, left)),
                                  material={"normalTexture": {"index": 0}}), "frame=0")
        self.wait_for_frame(0)
        self.browser.screenshot(self.folder / "bumps.png")
        light = [sum(colour) for colour in self.front()]
        self.assertGreater(light[0], 1.2 * light[1])
        self.assertGreater(light[2], 1.2 * light[3])
        self.browser.press("t")
        self.assertLess(max(map(sum, self.front())), 1.02 * min(map(sum, self.front())))

    def test_emission(self):
        dark = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]},
                "emissiveFactor": [1, 0.2, 0.2], "emissiveTexture": {"index": 0}}
        self.open(self.encode_box("glow", material=dark), "frame=0")
        self.wait_for_frame(0)
        hues = [self.hue(colour) for colour in self.front()]
        self.assertEqual(hues, ["red", "green", "blue", "red"])

    def test_a_stream_without_attributes_takes_the_place_of_a_textured_one(self):
        self.open(self.encode_box("box"), "frame=0")
        self.wait_for_frame(0)
        self.browser.choose_file("file", self.stream)
        self.browser.wait_for("player.shownFrame === 0 && player.viewer.numVertices === 538")
        self.assertEqual({*map(self.hue, self.front())}, {"grey"})
        self.assertTrue(self.browser.evaluate("plain.hidden"))

    def test_edges_of_drawn_vertices(self):
        self.open(self.encode_box("box"), "frame=0&wire=over")
        self.browser.wait_for("player.viewer.numEdges > 0 && player.shownFrame === 0")
        self.assertEqual(self.browser.evaluate("player.viewer.numEdges"), 18)
        self.assertTrue(self.browser.evaluate("""(async () => {
          const edges = await player.session.decoder.edges();
          const { vertices } = player.session.drawn;
          return player.edges.every((drawn, i) => vertices[drawn] === edges[i]);
        })()"""))

    def test_distances_at_drawn_vertices(self):
        fine = self.encode_box("fine")
        coarse = self.folder / "coarse-box.rlpc"
        done = run("rlpcenc", "-q", self.folder / "fine.glb", "-o", coarse, "--preset", "fast",
                   "--kg", "5")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.open(coarse, "frame=4", "--reference", fine)
        self.wait_for_frame(4)
        largest, rms = (float(word) for word in
                        re.search(r"largest ([\d.e-]+), RMS ([\d.e-]+)",
                                  self.text("deviation")).groups())
        native = self.native_deviation(coarse, fine, 4, 5)
        self.assertGreater(largest, 0)
        for shown, value in zip((largest, rms), native):
            self.assertAlmostEqual(shown / value, 1, delta=0.006)

    def test_damaged_attributes_and_assets_are_told_and_left_out(self):
        suite = STREAMS / "v1.2" / "either"
        lost = self.folder / "lost.rlpc"
        whole = (STREAMS / "v1.2" / "accept" / "AST" / "AST-0001a.rlpc").read_bytes()
        lost.write_bytes(whole.replace(b"glTF", b"GLTF"))
        self.assertNotEqual(lost.read_bytes(), whole)
        for stream, text in (
                (suite / "ATT/ATT-0001x2.rlpc", r"attributes cannot be decoded: .*R-ATT-03"),
                (suite / "AST/AST-0001x1.rlpc", r"materials cannot be read: .*R-AST-01"),
                (suite / "AST/AST-0001x2.rlpc", r"materials cannot be read: .*no GLB"),
                (lost, r"are damaged, and left out")):
            self.browser.open("about:blank")
            self.browser.open(PLAYER.as_uri())
            self.browser.wait_for("document.body?.dataset.state === 'empty'")
            self.browser.choose_file("file", stream)
            self.browser.wait_for("player.shownFrame >= 0")
            self.assertRegex(self.text("problems"), text)
            self.wait_for_check()
            self.assertEqual(self.browser.evaluate("player.states.counts[4]"), 0)

    def test_clips(self):
        stream = self.encode("clips.rlpc", "--gof", "20", "--clip", "Walk:10-19", "--clip",
                             "<b>&:30-34", "--clip", "Walk:40-49")
        self.open(stream, "clip=Walk")
        self.browser.wait_for("player.shownFrame > 14")
        self.browser.wait_for("player.shownFrame < 14")  # it starts again
        self.assertEqual(self.browser.evaluate("[slider.min, slider.max]"), ["10", "19"])
        self.assertIn("9", self.text("clock"))
        self.assertEqual(self.browser.evaluate("[...clip.options].map((one) => one.text)"),
                         ["All clips", "Walk", "<b>&", "Walk"])
        self.browser.evaluate("clip.value = '2'; clip.dispatchEvent(new Event('change'))")
        self.browser.wait_for("player.shownFrame > 45")  # the other of this name
        self.browser.evaluate("clip.value = '1'; clip.dispatchEvent(new Event('change'))")
        self.browser.wait_for("player.shownFrame === 34")
        self.browser.press("Home")
        self.browser.press(" ")
        self.browser.press("ArrowLeft")
        self.wait_for_frame(34)  # the last of the clip
        self.browser.evaluate("clip.value = ''; clip.dispatchEvent(new Event('change'))")
        self.wait_for_frame(0)


if __name__ == "__main__":
    main()
