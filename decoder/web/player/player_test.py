#!/usr/bin/env python3
"""The player: pages that rlpcdec writes, and the JavaScript of the page.

  player_test.py --bin FOLDER [Writing|Playing]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import base64
import json
import os
import re
import shutil
import subprocess
import unittest

from player_testing import HERE, STREAMS, InFolder, Tools, main, need_node, run

PLACE = "<!-- rlpcdec: streams -->"


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
                self.assertEqual(done.returncode, 0 if size == len(accepted) else 1, done.stderr)
                self.assertEqual(b"R-END-02" in done.stderr, size > len(accepted))
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
        self.assertIn(b"in its frames, vertices or triangles", done.stderr)
        self.assertFalse(out.exists())
        kept = self.encode("kept.rlpc", "--keep-order")
        done, out = self.page(self.stream, "--reference", kept)
        self.assertEqual(done.returncode, 64)
        self.assertIn(b"or in their order; encode both", done.stderr)

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


class Playing(unittest.TestCase):
    """What the page does without a browser."""

    def run_in_node(self, name):
        need_node()
        done = subprocess.run(["node", "--test", HERE / name], capture_output=True, timeout=60,
                              check=False)
        self.assertEqual(done.returncode, 0, done.stdout.decode())

    def test_distances(self):
        self.run_in_node("distances_test.mjs")

    def test_materials_of_an_asset(self):
        self.run_in_node("asset_materials_test.mjs")

    def test_camera(self):
        self.run_in_node(HERE.parent / "viewer" / "camera_test.mjs")

    def test_facts(self):
        self.run_in_node("facts_test.mjs")


if __name__ == "__main__":
    main()
