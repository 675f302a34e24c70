#!/usr/bin/env python3
"""The player and its streams on a web server, in Chromium.

  player_server_test.py --bin FOLDER [Server.test_NAME]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import pathlib
import shutil
import sys

from in_browser import InBrowser
from player_testing import PLAYER, Decoded, main

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "package" / "testing"))
from stream_server import StreamServer


class Server(InBrowser):
    """The page and its streams on a web server."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.stream = cls.encode("big.rlpc", "--gof", "20", "--kg", "0.003", "--layer-groups", "4")
        shutil.copy(PLAYER, cls.folder)
        server = StreamServer(cls.folder)
        cls.server = server.__enter__()
        cls.addClassCleanup(server.__exit__)

    def open(self, query):
        self.server.requests.clear()
        self.browser.open("about:blank")
        self.browser.open(f"{self.server.address}/player.html?{query}")
        self.browser.wait_for("document.body?.dataset.state")

    def test_a_stream_from_the_server(self):
        for self.server.ranges in (True, False):
            self.open("src=big.rlpc#frame=33")
            self.browser.wait_for("player.shownFrame === 33 && player.states.isComplete")
            self.assertEqual(self.text("name"), "big.rlpc")
            self.assertEqual(self.browser.evaluate("[...player.states.crcs]"),
                             Decoded(self.stream, self.folder).crcs)
            self.assertFalse(self.browser.evaluate("progress.checkVisibility()"))
            size = self.stream.stat().st_size
            self.assertLess(self.server.sent(), 1.01 * size)  # no byte comes twice

    def test_a_coarse_mesh_is_seen_first(self):
        self.server.ranges = True
        self.server.bytes_per_second = 5_000
        self.addCleanup(setattr, self.server, "bytes_per_second", 0)
        self.open("src=big.rlpc#frame=45")
        self.browser.wait_for("globalThis.player?.coarseVertices > 0 && player.viewer.frame")
        shown, visible, coarse = self.browser.evaluate(
            "[player.shownFrame ?? null, progress.checkVisibility(), player.coarseVertices]")
        self.assertIsNone(shown)
        self.assertTrue(visible)
        self.wait_for_frame(45)
        self.assertLess(coarse, 0.7 * 538)
        self.assertEqual(self.browser.evaluate("player.viewer.numVertices"), 538)

    def test_textures_from_the_server(self):
        self.encode_box("box")
        for self.server.ranges in (True, False):
            self.open("src=box.rlpc#frame=2")
            self.wait_for_frame(2)
            self.assertEqual(self.browser.evaluate(
                "[player.viewer.materials.list.length, player.viewer.look.uvs.length]"), [2, 1])

    def test_a_reference_from_the_server(self):
        self.encode("fine.rlpc", "--gof", "20", "--kg", "0.01")
        self.open("src=big.rlpc#frame=5&reference=fine.rlpc")
        self.wait_for_frame(5)
        self.assertRegex(self.text("deviation"), r"largest [\d.e-]+, RMS [\d.e-]+")

    def test_a_stream_that_is_not_there(self):
        self.open("src=nothing.rlpc")
        self.browser.wait_for("document.body.dataset.state === 'failed'")
        self.assertIn("404", self.text("message"))


if __name__ == "__main__":
    main()
