#!/usr/bin/env python3
"""Time in clips, in node: RLPCMesh compared with three.js, which plays the .glb of rlpcdec and the
source, and with the library in C.

  loops_test.py --bin FOLDER [Loops|Clocks]...

Exit code: 0 passed, 1 failed, 77 if all was skipped.
"""

import fractions
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "player"))
from player_testing import (MODULES, PACKAGE, STREAMS, InFolder, main, need_node,
                            need_player, run)

TULIP = STREAMS / "inputs" / "tulip.glb"  # Sway is a loop; Visit ends elsewhere, and begins late


class InNode(InFolder):
    @classmethod
    def setUpClass(cls):
        need_player()
        need_node()
        if not (MODULES / "three").is_dir():
            raise unittest.SkipTest("three.js is not there: scripts/player")
        super().setUpClass()
        # Where the package finds three.js, as installed ones do.
        cls.package = cls.folder / "package"
        shutil.copytree(PACKAGE, cls.package)
        (cls.folder / "node_modules").symlink_to(MODULES)

    def in_node(self, script, *arguments):
        """What a script of testing/ writes."""
        done = subprocess.run(
            ["node", HERE / "testing" / script, MODULES, self.package, *arguments],
            capture_output=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stderr.decode())
        return json.loads(done.stdout)


class Loops(InNode):
    def test_they_take_the_same_time_everywhere(self):
        stream, decoded = self.folder / "a.rlpc", self.folder / "a.glb"
        done = run("rlpcenc", TULIP, "--animation", "all", "--preset", "fast", "--kg", 1, "-o",
                   stream)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(run("rlpcdec", stream, "-o", decoded).returncode, 0)
        told = self.in_node("loops.mjs", stream, TULIP, decoded)
        self.assertEqual([clip["name"] for clip in told], ["Sway", "Visit"])
        for clip, seconds in zip(told, (2, 1.75)):
            for duration in clip["durations"]:
                self.assertAlmostEqual(duration, seconds, places=5)
            for apart in clip["apart"]:
                self.assertLess(apart, 1e-4, clip)


SEQUENCE = 60  # frames of the elephant
CLIPS = ((0, 1), (7, 2), (12, 3), (20, 17), (15, 45))  # first frame and number
SPEEDS = (1, 0.5, 2, -1, -0.3)


def place_in(frames, played, repeats):
    """Where a clip is after so many intervals: exact, from 0 to frames - 1."""
    last = frames - 1
    if played <= 0 or last == 0:
        return fractions.Fraction(0)
    return played % last if repeats else min(played, fractions.Fraction(last))


class Clocks(InNode):
    """The same frames, with the same weights, at the same times."""

    def cases(self, dice, rate):
        """Times at frames, midway between them, at ends, before and long after them, and any."""
        for clip in range(-1, len(CLIPS)):
            last = (SEQUENCE if clip < 0 else CLIPS[clip][1]) - 1
            for kind in ("frame", "middle", "end", "before", "far", "any", "any", "any"):
                intervals = {"frame": dice.randint(0, last), "middle": dice.randint(0, last) + 0.5,
                             "end": last, "before": -dice.random() - 0.01,
                             "far": dice.uniform(50, 1e6),
                             "any": dice.uniform(0, 1.5 * last)}[kind]
                yield {"clip": clip, "seconds": float(intervals / rate),
                       "repeats": dice.random() < 0.5, "speed": dice.choice(SPEEDS), "kind": kind}

    def ways(self, case, duration):
        """Those that take this time: seeks end at the end, and do not turn; playing takes long."""
        ways = []
        if case["seconds"] < duration or not case["repeats"]:
            ways.append("seek")
        if case["kind"] not in ("before", "far"):
            ways.append("play")
        if case["kind"] != "before":
            ways.append("mixer")
        return ways if duration > 0 else ["seek"]

    def in_c(self, stream, cases):
        lines = "".join(f"{case['clip']} {case['seconds'].hex()} {int(case['repeats'])}\n"
                        for case in cases)
        done = run("clip_time_probe", stream, input=lines.encode())
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [line.split() for line in done.stdout.decode().splitlines()]
        return [{"frame": int(frame), "place": float(place), "xyz": list(map(float, xyz))}
                for frame, place, *xyz in rows]

    def backwards(self, case, frames, rate):
        """The time at which a clip that is played forth is where this one is, played back."""
        played = place_in(frames, fractions.Fraction(case["seconds"]) * rate, case["repeats"])
        return {**case, "repeats": False, "seconds": float((frames - 1 - played) / rate)}

    def compare(self, ours, native, within):
        first, frames, case = within
        apart = abs(ours["place"] - native["place"]) if ours.get("place") is not None else 0
        if case["repeats"] and apart > frames - 1 - 1e-5:
            return  # the end is the start of the next turn: other coordinates unless it is a loop
        self.assertLess(apart, 2e-6 + 1e-12 * abs(case["seconds"]), case)
        is_middle = abs(native["place"] % 1 - 0.5) < 1e-4  # where playing adds up rounding errors
        if not is_middle or case["kind"] == "middle" and ours.get("is_exact"):
            self.assertEqual(ours["frame"], native["frame"], case)
        self.assertTrue(first <= ours["frame"] < first + frames, case)
        for a, b in zip(ours.get("xyz", []), native["xyz"]):
            self.assertLess(abs(a - b), 1e-5, case)

    def test_the_library_in_c_and_javascript(self):
        for seed, rate in enumerate(("30", "24000/1001", "997/31")):
            dice = random.Random(seed)
            exact = fractions.Fraction(rate)
            stream = self.encode(f"clock{seed}.rlpc", "--fps", rate, *(
                f"--clip=c{i}:{first}-{first + frames - 1}"
                for i, (first, frames) in enumerate(CLIPS)))
            cases = [case for _ in range(3) for case in self.cases(dice, exact)]
            for case in cases:
                frames = SEQUENCE if case["clip"] < 0 else CLIPS[case["clip"]][1]
                case["ways"] = self.ways(case, float((frames - 1) / exact))
            told = self.folder / "cases.json"
            told.write_text(json.dumps(cases))
            ours = self.in_node("clocks.mjs", stream, told)
            native = self.in_c(stream, cases)
            turned = self.in_c(stream, [
                self.backwards(case, SEQUENCE if case["clip"] < 0 else CLIPS[case["clip"]][1],
                               exact)
                for case in cases])
            self.assertEqual({len(ours), len(native), len(turned)}, {len(cases)})
            for case, one, there, back in zip(cases, ours, native, turned):
                self.check_case(case, one, (there, back), exact)

    def check_case(self, case, ways, native, rate):
        there, back = native
        first, frames = (0, SEQUENCE) if case["clip"] < 0 else CLIPS[case["clip"]]
        wanted = first + place_in(frames, fractions.Fraction(case["seconds"]) * rate,
                                  case["repeats"])
        off = abs(float(wanted - fractions.Fraction(there["place"])))
        if case["repeats"]:
            off = min(off, abs(frames - 1 - off))
        self.assertLess(off, 2e-6 + 1e-12 * abs(case["seconds"]), case)
        self.assertEqual(there["frame"],
                         min(math.floor(there["place"] + 0.5 + 1e-6), first + frames - 1))
        for way, result in ways.items():
            turns = way == "play" and case["speed"] < 0
            with self.subTest(way=way, case=case):
                self.compare({**result, "is_exact": way in ("rule", "seek")},
                             back if turns else there, (first, frames, case))


if __name__ == "__main__":
    main()
