#!/usr/bin/env python3
"""The player: pages that rlpcdec writes, the WebAssembly decoder in node, pages in Chromium.

  player_test.py --bin FOLDER [Writing|Node|Playing|Browser]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import argparse
import base64
import hashlib
import json
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import chromium

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
STREAMS = ROOT / "streams"
PLAYER = ROOT / "build" / "player" / "player.html"
WASM = ROOT / "build" / "player" / "wasm" / "bin" / "rlpc_player.wasm"
PLACE = "<!-- rlpcdec: streams -->"
RLPD_HEADER = struct.Struct("<4sIIIIIIi3i")
ELEPHANT = STREAMS / "inputs" / "elephant"


class Tools:
    folder = ROOT / "build" / "release" / "bin"  # --bin


def run(tool, *arguments, **options):
    return subprocess.run([Tools.folder / tool, *map(str, arguments)], capture_output=True,
                          timeout=120, check=False, **options)


def need_player():
    if not PLAYER.exists() or not WASM.exists():
        raise unittest.SkipTest("the player is not built: scripts/player")


def need_node():
    if not shutil.which("node"):
        raise unittest.SkipTest("no node here: scripts/setup --player")


class Decoded:
    """What rlpcdec makes of a stream: frames, CRCs and the rule that is broken, or None."""

    def __init__(self, stream, folder):
        out = folder / "native.rlpd"
        out.unlink(missing_ok=True)
        done = run("rlpcdec", "decode", stream, out)
        verdict = re.search(r"^rlpc-verdict (.*)$", done.stderr.decode(), re.MULTILINE)
        self.code = done.returncode
        self.rule = json.loads(verdict[1]).get("rule", "") if verdict else None
        data = out.read_bytes() if out.exists() else b""
        self.triangles, positions, self.crcs = b"", b"", []
        if data:
            _, _, vertices, triangles, *_ = RLPD_HEADER.unpack_from(data)
            end = RLPD_HEADER.size + 12 * triangles
            self.triangles, positions = data[RLPD_HEADER.size:end], data[end:]
            size = 12 * vertices
            self.crcs = [zlib.crc32(positions[at:at + size])
                         for at in range(0, len(positions), size)]
        self.positions = hashlib.sha256(positions).hexdigest()


class InFolder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    @classmethod
    def encode(cls, name, *arguments):
        stream = cls.folder / name
        done = run("rlpcenc", "-q", f"{ELEPHANT}.obj", "--points", f"{ELEPHANT}.pc2", "--preset",
                   "fast", "-o", stream, *arguments)
        if done.returncode != 0:
            raise AssertionError(done.stderr.decode())
        return stream


class Writing(InFolder):
    """rlpcdec --html, with any page for the player."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.stream = cls.encode("clip.rlpc")
        cls.player = cls.folder / "player.html"
        cls.player.write_text(f"<p>before</p>{PLACE}<p>after</p>")

    def page(self, stream, *arguments):
        out = self.folder / "page.html"
        out.unlink(missing_ok=True)
        done = run("rlpcdec", stream, "--html", out, "--player", self.player, *arguments)
        return done, out

    @staticmethod
    def embedded(page, kind):
        parts = re.findall(rf'<script type="text/plain" class="{kind}">(.*?)</script>', page)
        return b"".join(base64.b64decode(part, validate=True) for part in parts), len(parts)

    def test_the_page_holds_the_stream(self):
        done, out = self.page(self.stream)
        self.assertEqual(done.returncode, 0, done.stderr)
        page = out.read_text()
        self.assertTrue(page.startswith("<p>before</p>") and page.endswith("<p>after</p>"))
        self.assertEqual(self.embedded(page, "stream"), (self.stream.read_bytes(), 1))
        self.assertEqual(self.embedded(page, "reference"), (b"", 0))
        self.assertIn('{"name":"clip.rlpc"}', page)

    def test_a_stream_of_any_length_is_held(self):
        accepted = (STREAMS / "v1.0" / "accept" / "HSH" / "HSH-0001a.rlpc").read_bytes()
        for size in (len(accepted), len(accepted) + 1, len(accepted) + 2, 3 * 2**20 + 1):
            with self.subTest(size=size):
                stream = self.folder / "long.rlpc"
                stream.write_bytes(accepted.ljust(size, b"\7"))  # what is behind its end is kept
                done, out = self.page(stream)
                self.assertEqual(done.returncode, 0, done.stderr)
                held, parts = self.embedded(out.read_text(), "stream")
                self.assertEqual(held, stream.read_bytes())
                self.assertEqual(parts, 1 + (size > 3 * 2**20))

    def test_standard_input(self):
        out = self.folder / "piped.html"
        done = run("rlpcdec", "-", "--html", out, "--player", self.player,
                   input=self.stream.read_bytes())
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.embedded(out.read_text(), "stream")[0], self.stream.read_bytes())
        self.assertIn('{"name":"animation"}', out.read_text())

    def test_a_name_cannot_end_the_element(self):
        stream = self.folder / "a<script>b<!--.rlpc"
        shutil.copy(self.stream, stream)
        done, out = self.page(stream)
        self.assertEqual(done.returncode, 0, done.stderr)
        description = re.search(r'id="stream-description">(.*?)</script>', out.read_text())[1]
        self.assertNotIn("<", description)
        self.assertEqual(json.loads(description)["name"], stream.name)

    def test_a_reference_of_the_same_mesh(self):
        fine = self.encode("fine.rlpc", "--kg", "0.01")
        done, out = self.page(self.stream, "--reference", fine)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.embedded(out.read_text(), "reference")[0], fine.read_bytes())
        other = STREAMS / "v1.0" / "accept" / "CON" / "CON-0001a.rlpc"
        done, out = self.page(self.stream, "--reference", other)
        self.assertEqual(done.returncode, 64)
        self.assertIn(b"not a stream of the same frames", done.stderr)
        self.assertFalse(out.exists())
        kept = self.encode("kept.rlpc", "--keep-order")
        done, out = self.page(self.stream, "--reference", kept)
        self.assertEqual(done.returncode, 64)
        self.assertIn(b"in the same order; encode both", done.stderr)

    def test_without_a_player(self):
        tool = self.folder / "elsewhere" / "rlpcdec"
        tool.parent.mkdir()
        shutil.copy(Tools.folder / "rlpcdec", tool)
        out = self.folder / "none.html"
        done = subprocess.run([tool, self.stream, "--html", out], capture_output=True, check=False)
        self.assertEqual(done.returncode, 4)
        self.assertIn(b"scripts/player", done.stderr)
        self.assertFalse(out.exists())

    def test_it_is_found_where_it_is_installed(self):
        prefix = self.folder / "prefix"
        for part in ("bin", "share/rlpc"):
            (prefix / part).mkdir(parents=True)
        shutil.copy(Tools.folder / "rlpcdec", prefix / "bin")
        shutil.copy(self.player, prefix / "share" / "rlpc")
        out = self.folder / "installed.html"
        done = subprocess.run([prefix / "bin" / "rlpcdec", self.stream, "--html", out],
                              capture_output=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(out.exists())

    def test_what_is_not_a_player(self):
        for player, text in [(self.stream, b"not the page"), ("/nowhere", b"cannot read")]:
            done = run("rlpcdec", self.stream, "--html", self.folder / "x.html", "--player", player)
            self.assertEqual(done.returncode, 4)
            self.assertIn(text, done.stderr)

    def test_a_stream_too_long_for_a_page(self):
        stream = self.folder / "sparse.rlpc"
        shutil.copy(self.stream, stream)
        os.truncate(stream, 2**29 + 1)
        done, out = self.page(stream)
        self.assertEqual(done.returncode, 4)
        self.assertIn(b"up to 512 MiB", done.stderr)
        self.assertFalse(out.exists())

    def test_options_that_a_page_has_no_use_for(self):
        for option in (["--frames", "0-3"], ["--max-layers", "2"], ["--json"], ["--verify"]):
            done, out = self.page(self.stream, *option)
            self.assertEqual(done.returncode, 64, option)
            self.assertFalse(out.exists())

    def test_what_is_not_a_stream(self):
        done, out = self.page(self.player)
        self.assertEqual(done.returncode, 1)
        self.assertFalse(out.exists())


class Node(InFolder):
    """The WebAssembly decoder decodes what rlpcdec decodes, and refuses what it refuses."""

    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        super().setUpClass()

    def compare(self, streams):
        done = subprocess.run(["node", HERE / "decode_streams.mjs", WASM, *streams],
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
        self.assertEqual(native.code, error["code"] if error else 0)
        self.assertEqual(native.rule, error["rule"] if error else None)
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

    def test_streams_of_the_encoder(self):
        streams = [self.encode(f"{profile}-{order}.rlpc", "--profile", profile, "--gof", "20",
                               *(["--keep-order"] if order == "kept" else []))
                   for profile in ("main", "baseline") for order in ("own", "kept")]
        for result in self.compare(streams):
            self.assertEqual(result["frames"], 60)
            self.assertEqual(result["compared"], 60)  # with the hashes of the stream


class Playing(unittest.TestCase):
    """What the page does without a browser."""

    def run_in_node(self, name):
        need_node()
        done = subprocess.run(["node", "--test", HERE / name], capture_output=True, timeout=60,
                              check=False)
        self.assertEqual(done.returncode, 0, done.stdout.decode())

    def test_playback(self):
        self.run_in_node("playback_test.mjs")

    def test_facts(self):
        self.run_in_node("facts_test.mjs")


class Browser(InFolder):
    """Pages in Chromium; each has the frames that rlpcdec decodes."""

    @classmethod
    def setUpClass(cls):
        need_player()
        path = chromium.program()
        if not path:
            raise unittest.SkipTest("no Chromium here: scripts/setup --player")
        super().setUpClass()
        browser = chromium.Chromium(path)
        cls.browser = browser.__enter__()
        cls.addClassCleanup(browser.__exit__)
        cls.stream = cls.encode("clip.rlpc", "--gof", "20")

    def open(self, stream, fragment="", *arguments):
        page = self.folder / f"{stream.stem}.html"
        done = run("rlpcdec", stream, "--html", page, "--player", PLAYER, *arguments)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.browser.open("about:blank")
        self.browser.open(f"{page.as_uri()}#{fragment}")
        self.browser.wait_for("document.body?.dataset.state === 'ready'")

    def wait_for_frame(self, frame):
        self.browser.wait_for(f"player.shownFrame === {frame}")

    def wait_for_check(self):
        """And until the page says so, which it does with the next picture."""
        self.browser.wait_for("player.states.isComplete")
        self.browser.evaluate("new Promise((next) => requestAnimationFrame(() => "
                              "requestAnimationFrame(() => next(true))))")

    def states(self):
        return self.browser.evaluate("[...player.states.states]")

    def text(self, element):
        return self.browser.evaluate(f"document.getElementById('{element}').innerText")

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
        # The middle of the view has the light colour of the mesh; without it, the dark floor.
        middle = """(() => {
          player.scene.setWireframe('MODE');
          player.scene.draw();
          const gl = player.scene.renderer.getContext();
          const pixel = new Uint8Array(4);
          gl.readPixels(gl.drawingBufferWidth / 2, gl.drawingBufferHeight / 2, 1, 1, gl.RGBA,
                        gl.UNSIGNED_BYTE, pixel);
          return [...pixel];
        })()"""
        self.assertGreater(min(self.browser.evaluate(middle.replace("MODE", "off"))), 80)
        self.assertLess(max(self.browser.evaluate(middle.replace("MODE", "alone"))[:3]), 80)

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
        self.browser.wait_for("player.scene.lines?.visible")
        # Closed and of genus 0 in each part, it has 3/2 edges for each triangle.
        self.assertEqual(self.browser.evaluate("2 * player.scene.lines.geometry.index.count / 2"),
                         self.browser.evaluate("3 * player.header.num_triangles"))
        self.browser.press("n")
        self.browser.wait_for("player.scene.material.flatShading")

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
        self.open(stream, "frame=0")
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
        self.open(self.damaged(), "frame=30")
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
        self.assertEqual(self.browser.evaluate("player.scene.deviationScale.value"), 0)
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
        self.open(self.stream, "frame=0", "--reference", self.stream)
        self.wait_for_frame(0)
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
          player.checkAll();
          player.checker.worker.dispatchEvent(new ErrorEvent('error', {message: 'no room'}));
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

    def native_deviation(self, stream, reference, frame):
        """Largest and root mean square distance."""
        frames = []
        for source in (stream, reference):
            out = self.folder / "frame.f32"
            run("rlpcdec", "decode", source, out)
            values = struct.unpack(f"<{out.stat().st_size // 4}f", out.read_bytes())
            size = len(values) // 60
            frames.append(values[size * frame:size * (frame + 1)])
        squares = [(a - b) ** 2 for a, b in zip(*frames)]
        distances = [sum(squares[i:i + 3]) for i in range(0, len(squares), 3)]
        return max(distances) ** 0.5, (sum(distances) / len(distances)) ** 0.5

    def test_a_stream_that_is_dropped_takes_the_place_of_another(self):
        held = "(({ memory, programs }) => [memory.geometries, memory.textures, programs.length])" \
               "(player.scene.renderer.info)"
        self.open(self.stream, "frame=3&wire=over")
        self.wait_for_frame(3)
        self.browser.wait_for("player.scene.lines?.visible && player.scene.isDrawn")
        before = self.browser.evaluate(held)
        self.browser.evaluate("globalThis.addresses = 0;"
                              "URL.createObjectURL = () => String(++addresses)")
        for _ in range(2):
            self.browser.evaluate("player.shownFrame = undefined; player.scene.lines = null;"
                                  "player.open('dropped.rlpc', player.stream)")
            self.browser.wait_for("player.shownFrame === 3 && player.scene.lines?.visible"
                                  " && player.scene.isDrawn")
        self.assertEqual(self.browser.evaluate(held), before)
        self.assertEqual(self.browser.evaluate("addresses"), 0)

    def test_without_a_stream(self):
        self.browser.open(PLAYER.as_uri())
        self.browser.wait_for("document.body?.dataset.state === 'empty'")
        self.assertIn("Drop", self.text("message"))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, default=Tools.folder)
    options, rest = parser.parse_known_args()
    Tools.folder = options.bin.resolve()
    program = unittest.main(argv=[sys.argv[0], *rest], exit=False)
    result = program.result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.skipped:
        for _, reason in result.skipped:
            print(f"skipped: {reason}")
        sys.exit(77)


if __name__ == "__main__":
    main()
