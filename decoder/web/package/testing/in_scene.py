"""The packed package in Chromium: installed in an empty folder, in a scene of its own."""

import hashlib
import json
import pathlib
import shutil
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "player"))
import chromium
from player_testing import (MODULES, PLAYER, InFolder, float_frames, need_node,
                            need_player)
from stream_server import StreamServer


def npm(*arguments, cwd):
    subprocess.run(["npm", *map(str, arguments), "--offline", "--ignore-scripts", "--no-audit",
                    "--no-fund"], cwd=cwd, check=True, capture_output=True, timeout=120)


class InScene(InFolder):
    """A folder with the package and three.js from tarballs, and a web server for it."""

    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        path = chromium.program()
        if not path:
            raise unittest.SkipTest("no Chromium here: scripts/setup --player")
        super().setUpClass()
        tarball = next(PLAYER.parent.glob("rlpc-*.tgz"))
        npm("pack", "--pack-destination", cls.folder, cwd=MODULES / "three")
        npm("install", tarball, next(cls.folder.glob("three-*.tgz")), cwd=cls.folder)
        shutil.copy(HERE / "scene.html", cls.folder)
        cls.stream = cls.encode("walk.rlpc", "--gof", "3", "--kg", "0.003", "--clip", "Walk:4-15",
                                "--clip", "Wave \"again\":20-59")
        cls.frames = float_frames(cls.stream, cls.folder)
        cls.encode_box("box")
        cls.encode_box("colours", [0, 0.5, 0])
        server = StreamServer(cls.folder)
        cls.server = server.__enter__()
        cls.addClassCleanup(server.__exit__)
        browser = chromium.Chromium(path)
        cls.browser = browser.__enter__()
        cls.addClassCleanup(browser.__exit__)

    def setUp(self):
        for name, value in vars(StreamServer(self.folder)).items():
            setattr(self.server, name, value)
        self.browser.open(f"{self.server.address}/scene.html")
        self.browser.wait_for("globalThis.isReady")

    def run_script(self, body):
        """What an async function returns."""
        return json.loads(self.browser.evaluate(
            f"(async () => JSON.stringify(await (async () => {{ {body} }})() ?? null))()"))

    def error_of(self, body):
        return self.run_script(f"""
            try {{ {body} }} catch (error) {{
              const {{ name, message, kind, rule, element, bitOffset }} = error;
              return {{ isOurs: error instanceof RlpcError,
                       name, message, kind, rule, element, bitOffset }};
            }}""")

    def hash_of(self, frame):
        return hashlib.sha256(self.frames[frame]).hexdigest()
