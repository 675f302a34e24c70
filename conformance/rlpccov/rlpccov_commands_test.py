#!/usr/bin/env python3
"""rlpccov as people run it, on a small specification.

    rlpccov_commands_test.py [unittest arguments]
"""

import json
import pathlib
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
TOOLS = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(TOOLS), str(TOOLS.parent / "specdec")]

import coverage_report
import rlpccov_test


class Commands(rlpccov_test.FolderTest):
    """The command line, its files and its messages."""

    SPEC = ("6 Syntax", 'def stream():\n    Next = 0\n    q_value = u(8)\n'
                        '    require(q_value < 250, "R-QQQ-01")\n    Big = q_value > 99')

    def setUp(self):
        super().setUp()
        self.goals(self.SPEC)
        self.streams = self.folder / "streams"
        self.streams.mkdir()
        for name, byte in (("low", 0), ("top", 249), ("mid", 100), ("bad", 250)):
            (self.streams / f"{name}.rlpc").write_bytes(bytes([byte]))
        (self.folder / "goals.json").write_text("{}")
        (self.folder / "waivers.json").write_text("[]")

    def run_tool(self, *args):
        done = subprocess.run(
            [sys.executable, TOOLS / "rlpccov", *args, "--spec", self.folder,
             "--goals", self.folder / "goals.json", "--waivers", self.folder / "waivers.json",
             "--jobs", "1"], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout, done.stderr

    def sidecar(self, name, **content):
        path = self.streams / f"{name}.json"
        path.write_text(json.dumps({"id": name, "rules": ["R-QQQ-01"], **content}))
        return path

    def test_missing_and_check(self):
        code, output, _ = self.run_tool(self.streams, "--missing")
        self.assertEqual(code, 0)
        self.assertNotIn("q_value", output.replace("q_value > 99/false-edge", ""))
        self.assertIn("6/stream/condition/q_value > 99/false-edge", output)
        self.assertIn("(a.md:", self.run_tool(self.streams, "--missing", "--places")[1])
        self.assertEqual(self.run_tool(self.streams, "--check")[0], 1)
        (self.folder / "waivers.json").write_text('[{"goal": "*", "reason": "all"}]')
        code, output, _ = self.run_tool(self.streams, "--check")
        self.assertEqual(code, 1)
        self.assertIn("is reached", output)

    def test_check_passes_when_all_is_reached_or_waived(self):
        (self.streams / "edge.rlpc").write_bytes(b"\x63")
        (self.streams / "none.rlpc").write_bytes(b"")
        code, output, _ = self.run_tool(self.streams, "--check")
        self.assertEqual(code, 1)
        goals = [line.removeprefix("missing ") for line in output.splitlines()]
        self.assertEqual([g for g in goals if not g.startswith("9/")], [])
        (self.folder / "waivers.json").write_text(json.dumps(
            [{"goal": g, "reason": "not in this test"} for g in goals]))
        self.assertEqual(self.run_tool(self.streams, "--check"), (0, "", ""))

    def test_measurements_merge_to_the_same(self):
        direct = self.run_tool(self.streams)[1]
        for name in ("low", "top"):
            self.run_tool(self.streams / f"{name}.rlpc", "--json", self.folder / f"{name}.json")
        self.sidecar("bad")
        self.sidecar("mid")
        for name in ("bad", "mid"):
            code, _, errors = self.run_tool(self.streams / f"{name}.rlpc", "--update")
            self.assertEqual((code, errors), (0, ""))
        merged = self.run_tool("--merge", self.folder / "low.json", self.folder / "top.json",
                               self.streams / "MEASURED.json")[1]
        self.assertEqual(direct, merged)

    def test_minimum_keeps_all_goals_with_fewer_streams(self):
        (self.streams / "twice.rlpc").write_bytes(bytes([100]))
        self.run_tool(self.streams, "--json", self.folder / "all.json")
        code, output, _ = self.run_tool("--merge", self.folder / "all.json", "--minimise")
        self.assertEqual(code, 0)
        names = [line.split()[0] for line in output.splitlines()]
        self.assertEqual(sorted(names), ["bad", "low", "mid", "top"])
        self.run_tool(self.streams, "--report", self.folder)
        smallest = self.folder / "smallest_set.txt"
        self.assertEqual(smallest.read_text(), output)
        set_goals = self.run_tool(self.streams, "--set", smallest)[1]
        self.assertTrue(set_goals.startswith("4 streams reach "), set_goals)
        self.assertEqual(set_goals.split("reach")[1],
                         self.run_tool(self.streams)[1].split("reach")[1])

    def test_a_set_with_a_stream_that_is_gone_is_an_error(self):
        (self.folder / "set.txt").write_text("low  3\ngone  1\n")
        code, _, errors = self.run_tool(self.streams, "--set", self.folder / "set.txt")
        self.assertEqual(code, 4)
        self.assertIn("gone: no such stream", errors)

    def test_sidecars_are_compared(self):
        path = self.sidecar("low", expect="accept")
        self.assertIn("differs from what is measured now",
                      self.run_tool(self.streams, "--check")[1])
        self.run_tool(self.streams / "low.rlpc", "--update")
        self.assertNotIn("low", self.run_tool(self.streams, "--check")[1])
        content = json.loads((self.streams / "MEASURED.json").read_text())
        self.assertEqual(content["streams"]["low"]["elements"], {"q_value": [0, 0]})
        content = json.loads(path.read_text())
        path.write_text(json.dumps({**content, "rule": "R-QQQ-01", "rules": ["R-BIT-01"]}))
        self.assertIn("but the specification gives None", self.run_tool(self.streams, "--check")[1])
        (self.streams / "none.rlpc").write_bytes(b"")
        self.sidecar("none", rule="R-BIT-01")
        self.run_tool(self.streams / "none.rlpc", "--update")
        self.assertIn("none.json: names R-QQQ-01, which decoding the stream never checks",
                      self.run_tool(self.streams, "--check")[1])

    def test_measurements_are_kept_by_suite_as_of_the_release(self):
        area = self.streams / "accept" / "LOW"
        area.mkdir(parents=True)
        (self.streams / "low.rlpc").rename(area / "low.rlpc")
        self.sidecar("low").rename(area / "low.json")
        (self.streams / "SUITE.json").write_text("{}")
        self.run_tool(area / "low.rlpc", "--update")
        measured = (self.streams / "MEASURED.json").read_text()
        self.assertEqual(list(json.loads(measured)["streams"]), ["low"])
        self.goals(("6 Syntax", "def stream():\n    Next = 0\n    q_value = u(8)"))
        changed = "low: differs from what is measured now"
        self.assertIn(changed, self.run_tool(self.streams, "--check")[1])
        (area / "low.json").write_text('{"id": "low", "released": "2026-11-21"}')
        self.assertNotIn(changed, self.run_tool(self.streams, "--check")[1])
        self.run_tool(area / "low.rlpc", "--update")
        self.assertEqual((self.streams / "MEASURED.json").read_text(), measured)
        for name, listed in (("top", ["low", "top"]), ("mid", ["low", "mid"])):
            self.sidecar(name)
            self.run_tool(self.streams / f"{name}.rlpc", "--update")
            kept = json.loads((self.streams / "MEASURED.json").read_text())["streams"]
            self.assertEqual(list(kept), listed)
            (self.streams / f"{name}.rlpc").unlink()

    def test_pages(self):
        self.sidecar("low", expect="accept")
        code, _, _ = self.run_tool(self.streams, "--report", self.folder / "pages")
        self.assertEqual(code, 0)
        pages = {p.name: p.read_text() for p in (self.folder / "pages").iterdir()}
        self.assertEqual(set(pages), {"README.md", "rules.md", "widths.md", "smallest_set.txt",
                                      *(p.file for p in coverage_report.PAGES)})
        self.assertIn("| R-QQQ-01 | 6 | invalid | low | bad |", pages["rules.md"])
        for n in range(9):
            (self.streams / f"bad{n}.rlpc").write_bytes(b"\xfa")
        self.run_tool(self.streams, "--report", self.folder / "pages")
        self.assertIn("bad, bad0, bad1, bad2, bad3, bad4 and 4 more",
                      (self.folder / "pages" / "rules.md").read_text())
        self.assertIn("| `q_value` | 4 | 0 | 250 | 0, 100, 249, 250 |", pages["elements.md"])
        self.assertIn("`6/stream/condition/q_value > 99/false-edge`", pages["branches.md"])

    def test_messages_say_what_to_do(self):
        self.assertEqual(self.run_tool()[0], 64)
        self.assertEqual(self.run_tool("--merge", self.folder / "none.json")[0], 4)
        code, _, errors = self.run_tool(self.streams / "low.rlpc", "--update")
        self.assertEqual(code, 4)
        self.assertIn("low.json: no such sidecar", errors)
        self.run_tool(self.streams, "--json", self.folder / "all.json")
        self.goals(("6 Syntax", "def stream():\n    Next = 0\n    r_value = u(8)"))
        code, _, errors = self.run_tool("--merge", self.folder / "all.json")
        self.assertEqual(code, 4)
        self.assertIn("measure it again", errors)
        self.goals(("6 Syntax", "def stream():\n    List = []\n    Value = List[3]"))
        code, _, errors = self.run_tool(self.streams / "low.rlpc")
        self.assertEqual(code, 70)
        self.assertIn("the specification's program fails", errors)


if __name__ == "__main__":
    unittest.main()
