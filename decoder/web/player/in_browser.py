"""What the tests of the player in Chromium have in common."""

import unittest

import chromium
from player_testing import InFolder, need_player


class InBrowser(InFolder):
    """With a page in Chromium."""

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

    def wait_for_frame(self, frame):
        self.browser.wait_for(f"globalThis.player?.shownFrame === {frame}")

    def text(self, element):
        return self.browser.evaluate(f"document.getElementById('{element}').innerText")
