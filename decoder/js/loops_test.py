#!/usr/bin/env python3
"""Time in clips: RLPCMesh and three.js with the .glb of rlpcdec, and with the source, in node.

  loops_test.py --bin FOLDER

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "player"))
from player_testing import (MODULES, PACKAGE, STREAMS, InFolder, main, need_node,  # noqa: E402
                            need_player, run)

TULIP = STREAMS / "inputs" / "tulip.glb"  # Sway is a loop; Visit ends elsewhere, and begins late


class Loops(InFolder):
    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        super().setUpClass()

    def test_they_take_the_same_time_everywhere(self):
        stream, decoded = self.folder / "a.rlpc", self.folder / "a.glb"
        done = run("rlpcenc", TULIP, "--animation", "all", "--preset", "fast", "--kg", 1, "-o", stream)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(run("rlpcdec", stream, "-o", decoded).returncode, 0)
        done = subprocess.run(["node", HERE / "testing" / "loops.mjs", MODULES, PACKAGE, stream, TULIP,
                               decoded], capture_output=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        told = json.loads(done.stdout)
        self.assertEqual([clip["name"] for clip in told], ["Sway", "Visit"])
        for clip, seconds in zip(told, (2, 1.75)):
            for duration in clip["durations"]:
                self.assertAlmostEqual(duration, seconds, places=5)
            for apart in clip["apart"]:
                self.assertLess(apart, 1e-4, clip)


if __name__ == "__main__":
    main()
