#!/usr/bin/env python3
"""Tests the counts of rlpccov, on small programs and on streams; and its waivers.

    rlpccov_test.py --bin BUILD/bin [unittest arguments, such as Counting]
"""

import argparse
import json
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOLS = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(TOOLS), str(TOOLS.parent / "specdec")]

import coverage_measure
import coverage_program
import coverage_report
import coverage_signs
import coverage_waivers
import spec_program
import specdec
from specdec_testing import (
    cut_animation, encode, run_stream, soup_animation)

BIN = None

READING = """
# 9 Parsing
```rlpc
def u(n):
    value = 0
    for i in range(n):
        require(Next < 8 * len(StreamBytes), "R-BIT-01")
        value = 2 * value + ((StreamBytes[Next // 8] >> (7 - Next % 8)) & 1)
        Next = Next + 1
    return value

def NewModel():
    return [32768, 32768, 0]

def NewModels(n):
    models = []
    for i in range(n):
        models.append(NewModel())
    return models

def ae(model):
    bin = u(1)
    model[2] = model[2] + 1
    return bin
```
"""


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def goals(self, *clauses, settings=None, reading=READING):
        """Goals of a specification of clauses, each (heading, text of a block)."""
        text = "".join(f"\n# {heading}\n\n```rlpc\n{block}\n```\n" for heading, block in clauses)
        (self.folder / "a.md").write_text(text + reading, encoding="utf-8")
        target = coverage_program.Instrumented(self.folder, settings or {})
        return coverage_measure.Goals(target)

    def reached(self, goals, data, function):
        """Returns the part after FUNCTION/ in the ids of the goals that a stream reaches."""
        found = goals.reached(coverage_measure.measure(goals, data))
        return {g[len(function) + 1:] for g in found if g.startswith(function + "/")}


class Counting(FolderTest):
    """Every kind of site, exactly."""

    def test_conditions_and_their_edges(self):
        goals = self.goals(("6 Syntax", "def stream():\n    Next = 0\n    x_value = u(8)\n"
                                        "    if x_value < 5:\n        Seen = 1\n"
                                        "    elif x_value == 9 or x_value >= 20:\n"
                                        "        Seen = 2"))
        conditions = {"if/x_value < 5/": ("true", "false", "true-edge", "false-edge"),
                      "if/x_value == 9 or x_value >= 20/": ("true", "false"),
                      "condition/x_value == 9/": ("true", "false"),
                      "condition/x_value >= 20/": ("true", "false", "true-edge", "false-edge"),
                      "element/x_value = u(8)/": ("0", "255")}
        self.assertEqual(sorted(goals.ids["6/stream"]),
                         sorted(f"6/stream/{c}{o}" for c, all in conditions.items() for o in all))
        first, second = "if/x_value < 5/", "condition/x_value >= 20/"
        neither = {"if/x_value == 9 or x_value >= 20/false", "condition/x_value == 9/false"}
        for byte, expected in {
                0: {first + "true", "element/x_value = u(8)/0"},
                4: {first + "true", first + "true-edge"},
                5: neither | {first + "false", first + "false-edge", second + "false"},
                9: {first + "false", "if/x_value == 9 or x_value >= 20/true",
                    "condition/x_value == 9/true"},
                19: neither | {first + "false", second + "false", second + "false-edge"},
                20: {first + "false", "if/x_value == 9 or x_value >= 20/true",
                     "condition/x_value == 9/false", second + "true",
                     second + "true-edge"}}.items():
            with self.subTest(byte=byte):
                self.assertEqual(self.reached(goals, bytes([byte]), "6/stream"), expected)

    def test_all_ordered_comparisons_have_the_right_edges(self):
        for operator, at, beyond in (("<", 4, 5), ("<=", 5, 6), (">", 6, 5), (">=", 5, 4)):
            goals = self.goals(("6 Syntax", f"def stream():\n    Next = 0\n    y_value = u(8)\n"
                                            f"    Far = y_value {operator} 5"))
            site = f"condition/y_value {operator} 5/"
            for byte in range(12):
                true = eval(f"{byte} {operator} 5")
                expected = {site + ("true" if true else "false")}
                expected |= {site + "true-edge"} if byte == at else set()
                expected |= {site + "false-edge"} if byte == beyond else set()
                got = {g for g in self.reached(goals, bytes([byte]), "6/stream")
                       if g.startswith("condition")}
                self.assertEqual(got, expected, (operator, byte))

    def test_loops(self):
        goals = self.goals(("6 Syntax", "def stream():\n    Next = 0\n    n_items = u(8)\n"
                                        "    for i in range(n_items):\n        Seen = i\n"
                                        "    for i in range(3):\n        Seen = i\n"
                                        "    turn = 0\n"
                                        "    while turn < 3 and not turn == n_items:\n"
                                        "        turn = turn + 1\n"
                                        "    while turn < n_items:\n        turn = turn + 1"))
        loops = {g for g in goals.ids["6/stream"] if "/loop/" in g or "/for/" in g}
        self.assertEqual(len(loops), 3 + 4 + 3)
        self.assertFalse([g for g in loops if "range(3)" in g], "a constant range")
        for byte, items, first, second in ((0, "0", "0", "0"), (1, "1", "1", "0"),
                                           (2, "many", "2", "0"), (4, "many", "3", "1"),
                                           (5, "many", "3", "many"), (99, "many", "3", "many")):
            got = self.reached(goals, bytes([byte]), "6/stream")
            self.assertEqual({g for g in got if g.startswith(("for/", "loop/"))},
                             {f"for/range(n_items)/{items}", f"loop/turn < n_items/{second}",
                              f"loop/turn < 3 and (not turn == n_items)/{first}"})
        measured = coverage_measure.measure(goals, bytes([99]))
        self.assertEqual(measured["loops"]["6/stream/turn < n_items"], "64+")

    def test_a_requirement_counts_when_it_fails(self):
        goals = self.goals(("6 Syntax", "def stream():\n    Next = 0\n    z_value = u(4)\n"
                                        '    require(z_value >= 2 and z_value <= 5, "R-ZZZ-01")\n'
                                        '    supported(z_value < 5, "R-ZZZ-02")'))
        self.assertEqual([g for g in goals.ids["6/stream"] if "/element/" in g],
                         [f"6/stream/element/z_value = u(4)/{n}" for n in (2, 3, 4)])
        measured = coverage_measure.measure(goals, b"\x60")
        self.assertEqual(measured["verdict"], {"code": 1, "rule": "R-ZZZ-01", "frames": 0})
        self.assertEqual(self.reached(goals, b"\x60", "6/stream"),
                         {"require/R-ZZZ-01 z_value >= 2 and z_value <= 5/false",
                          "condition/z_value >= 2/true", "condition/z_value <= 5/false",
                          "condition/z_value <= 5/false-edge"})
        measured = coverage_measure.measure(goals, b"\x50")
        self.assertEqual(measured["verdict"]["rule"], "R-ZZZ-02")
        self.assertEqual(measured["elements"], {"z_value": [5, 5]})

    def test_integer_functions_are_counted_at_each_call(self):
        goals = self.goals(
            ("5 Integers", "def Half(x, n):\n    if n == 0:\n        return x\n    return x >> n"),
            ("6 Syntax", "def stream():\n    Next = 0\n    n_bits = u(8)\n"
                         "    First = Half(n_bits - 9, 1)\n    Second = Half(7, n_bits)"))
        first, second = "6/stream > Half(n_bits - 9, 1)", "6/stream > Half(7, n_bits)"
        shifts = ["negative-exact", "negative-inexact", "exact", "inexact"]
        self.assertEqual(goals.ids[first], [f"{first}/shift/x >> 1/{o}" for o in shifts])
        self.assertEqual(len(goals.ids[second]), 2 + 4)
        for byte, outcome in ((8, shifts[1]), (7, shifts[0]), (11, shifts[2]), (12, shifts[3])):
            self.assertEqual(self.reached(goals, bytes([byte]), first),
                             {f"shift/x >> 1/{outcome}"})
        self.assertEqual(self.reached(goals, b"\0", second), {"if/n == 0/true"})

    def test_a_rounding_shows_all_its_outcomes_in_one_stream(self):
        goals = self.goals(
            ("5 Integers", "def Half(x):\n    return x // 2"),
            ("6 Syntax", "def stream():\n    Next = 0\n    for i in range(6):\n"
                         "        w_value = u(8)\n        Last = Half(w_value - 9)"))
        site = "shift/x // 2/"
        self.assertEqual(self.reached(goals, bytes([9, 10, 8, 8, 12, 12]),
                                      "6/stream > Half(w_value - 9)"),
                         {site + "exact", site + "inexact", site + "negative-inexact"})

    def test_the_place_of_an_error_counts(self):
        goals = self.goals(("6 Syntax", 'def stream():\n    Next = 0\n    BitPosition = 4\n'
                                        '    require(u(8) == 0, "R-AAA-01")'),
                           ("9.1 Place", "def Position():\n    return Far(BitPosition)\n\n"
                                         "def Far(x):\n    if x > 4:\n        return 1\n"
                                         "    return 0"))
        self.assertEqual(self.reached(goals, b"\1", "9.1/Far"), {"if/x > 4/false",
                                                                 "if/x > 4/false-edge"})

    def test_models(self):
        goals = self.goals(("6 Syntax", "def stream():\n    Next = 0\n    AnyModels = Pair()\n"
                                        "    m_size = u(2)\n"
                                        "    TreeModels = NewModels(1 << m_size)\n"
                                        "    a_flag = ae(AnyModels[1][0])\n"
                                        "    b_flag = ae(TreeModels[m_size])\n\n"
                                        "def Pair():\n    lows = NewModels(2)\n"
                                        "    tops = NewModels(1)\n    return [lows, tops]"),
                           settings={"largest": {"m_size": 3}})
        names = ["AnyModels.lows[0]", "AnyModels.lows[1]", "AnyModels.tops[0]", "TreeModels[0]",
                 "TreeModels[1]", "TreeModels[2-3]", "TreeModels[4-7]"]
        self.assertEqual([g for g in goals.ids["6/stream"] if "/context/" in g],
                         [f"6/stream/context/{n}/{b}" for n in names for b in (0, 1)])
        got = {g for g in self.reached(goals, b"\xd0", "6/stream") if g.startswith("context")}
        self.assertEqual(got, {"context/AnyModels.tops[0]/0", "context/TreeModels[2-3]/1"})

    def test_models_that_are_made_again(self):
        goals = self.goals(("6 Syntax", "def stream():\n    Next = 0\n    for i in range(3):\n"
                                        "        OnlyModel = NewModel()\n"
                                        "        c_flag = ae(OnlyModel)"))
        for byte, bins in ((0x00, {"0"}), (0xe0, {"1"}), (0x80, {"0", "1"}), (0x20, {"0", "1"})):
            got = self.reached(goals, bytes([byte]), "6/stream")
            self.assertEqual({g[-1] for g in got if g.startswith("context/OnlyModel/")}, bins)

    def test_constants_do_not_count_and_settings_do(self):
        settings = {"values": {"6/stream/k_value + 1": {"least": 1, "greatest": 256, "reason": ""}},
                    "loops": {"6/Count/n < x": {"counts": [0, 4], "reason": ""}}}
        goals = self.goals(("6 Syntax", "Table = Count(4)\n\ndef stream():\n    Next = 0\n"
                                        "    k_value = u(8)\n    Sum = k_value + 1\n"
                                        "    Last = Count(k_value)\n\ndef Count(x):\n    n = 0\n"
                                        "    while n < x:\n        n = n + 1\n    return n"),
                           settings=settings)
        self.assertIn("6/stream/value/k_value + 1/least 1", goals.ids["6/stream"])
        self.assertEqual(self.reached(goals, b"\x02", "6/Count") & {
            f"loop/n < x/{n}" for n in range(5)}, {"loop/n < x/2"})
        self.assertIn("value/k_value + 1/greatest 256", self.reached(goals, b"\xff", "6/stream"))
        self.assertEqual(coverage_measure.measure(goals, b"\xff")["widths"]["6/stream"], "0a")
        with self.assertRaisesRegex(spec_program.SpecError, "matches nothing"):
            self.goals(("6 Syntax", "def stream():\n    Next = 0"),
                       settings={"values": {"6/stream/none": {"least": 1}}})

    def test_functions_that_run_for_each_element_of_a_list(self):
        settings = {"for_each": {"Visit": {"list": "Found", "reason": ""}}}
        goals = self.goals(("6 Syntax", "def stream():\n    Next = 0\n    Found = []\n"
                                        "    for i in range(2):\n        h_value = u(8)\n"
                                        "        Found.append(h_value)\n\ndef Visit(x):\n"
                                        "    require(x < 9, \"R-AAA-01\")\n    Seen = x"),
                           settings=settings)
        visited = "require/R-AAA-01 x < 9/"
        for data, expected in ((b"\x01\x02", {visited + "true"}),
                               (b"\x01\x20", {visited + "true", visited + "false"}),
                               (b"\x20\x21", {visited + "false"}), (b"\x01", set())):
            self.assertEqual(self.reached(goals, data, "6/Visit"), expected)

    def test_merging_takes_the_extremes(self):
        goals = self.goals(("6 Syntax", "def stream():\n    Next = 0\n    g_value = u(8)\n"
                                        "    Sum = g_value - 9"))
        for bytes_ in ((0, 255, 100), (255, 0), (100, 255, 0)):
            total = coverage_measure.merge([coverage_measure.measure(goals, bytes([b]))
                                            for b in bytes_])
            self.assertEqual(total["elements"], {"g_value": [0, 255]})
            self.assertEqual(total["values"], {"g_value": sorted(bytes_)})
            self.assertEqual(total["counts"], {"g_value": len(bytes_)})
            self.assertEqual(total["widths"]["6/stream"], "09")  # -9 to 246
            self.assertEqual(total["loops"], {})

    def test_signs_follow_assignments(self):
        self.goals(("6 Syntax", "def stream():\n    Next = 0\n    Low = 3\n    Diff = Low - 5\n"
                                "    List = [1]\n    List.append(Diff)\n    Sum = Twice(List[0])\n"
                                "    Small = Diff & 7\n\ndef Twice(x):\n    return 2 * x"))
        signs = coverage_signs.Signs(spec_program.Program(self.folder))
        for name, negative in (("Low", False), ("Diff", True), ("List", True), ("Sum", True),
                               ("Small", False), ("Next", False)):
            self.assertEqual(("", name) in signs.negative, negative, name)

    def test_ids_hold_no_line_numbers(self):
        block = ("6 Syntax", "def stream():\n    Next = 0\n    p_value = u(1)\n"
                             "    Far = p_value == 1 and p_value == 1")
        before = self.goals(block).all()
        self.assertIn("6/stream/condition/p_value == 1#2/true", before)
        self.assertEqual(self.goals(("1 Scope", "One = 1\n\n\n"), block).all(), before)


class Waiving(FolderTest):
    """Waivers and what is said about bad ones."""

    GOALS = ["1/F/if/a < b/true", "1/F/if/a < b/false", "1/F/context/M[3][12]/0"]

    def waivers(self, *patterns):
        path = self.folder / "waivers.json"
        path.write_text(json.dumps([{"goal": p, "reason": "because"} for p in patterns]))
        return coverage_waivers.Waivers(path)

    def test_patterns(self):
        for pattern, number in (("1/F/if/*", 2), ("*/M[<0-3>][*", 1), ("*/M[<4-9>][*", 0),
                                ("1/F/if/a < b/true", 1), ("F/if/*", 0), ("*/M[<0-3>][1]/0", 0)):
            missing, waived = self.waivers(pattern).split(self.GOALS)
            self.assertEqual((len(missing), len(waived)), (3 - number, number), pattern)

    def test_a_waiver_of_nothing_is_complained_about(self):
        self.assertEqual(self.waivers("1/F/*").complaints(self.GOALS, set()), [])
        self.assertIn("matches no goal", self.waivers("2/*").complaints(self.GOALS, set())[0])

    def test_a_waiver_of_what_is_reached_is_complained_about(self):
        complaints = self.waivers("1/F/if/*").complaints(self.GOALS, {self.GOALS[1]})
        self.assertEqual(len(complaints), 1)
        self.assertIn("1/F/if/a < b/false is reached", complaints[0])

    def test_a_waiver_has_a_reason(self):
        (self.folder / "waivers.json").write_text('[{"goal": "*", "reason": " "}]')
        with self.assertRaisesRegex(ValueError, "a goal and a reason"):
            coverage_waivers.Waivers(self.folder / "waivers.json")


class Streams(FolderTest):
    """The specification of this project, instrumented."""

    @classmethod
    def setUpClass(cls):
        settings = json.loads((TOOLS / "coverage_goals.json").read_text(encoding="utf-8"))
        cls.target = coverage_program.Instrumented(specdec.SPEC, settings)
        cls.waivers = coverage_waivers.Waivers(TOOLS.parent / "matrix" / "waivers.json")

    def test_decodes_as_without(self):
        data = encode(BIN, self.folder, soup_animation(self.folder), "--kg", "2", "--gof", "3",
                      "--clusters", "3", "--keep-order", "--hash", "frame", "--frame", "lcf")
        for stream in [data, data[:-1], data[:200], data + b"?",
                       *(data[:i] + bytes([data[i] ^ 4]) + data[i + 1:] for i in (3, 21, 60))]:
            self.assertEqual(run_stream(stream, self.target), run_stream(stream))

    def test_waivers_hold(self):
        goals = coverage_measure.Goals(self.target)
        reached = set()
        for animation, settings in (
                (cut_animation(self.folder, "robot_arm", 5), ["--frame", "lcf"]),
                (soup_animation(self.folder), ["--keep-order", "--gof", "2"])):
            data = encode(BIN, self.folder, animation, "--kg", "1", *settings)
            for stream in (data, data[:len(data) // 2]):
                reached |= goals.reached(coverage_measure.measure(goals, stream))
        self.assertGreater(len(reached), 1000)
        self.assertEqual(self.waivers.complaints(goals.all(), reached), [])

    def test_every_goal_is_on_one_page(self):
        goals = coverage_measure.Goals(self.target)
        result = coverage_report.Result(goals, {}, coverage_waivers.Waivers(None))
        shown = [goal for page in coverage_report.PAGES for goal in page.ids(result)]
        self.assertEqual(sorted(shown), sorted(goals.all()))

    def test_settings_have_reasons(self):
        settings = self.target.settings
        for kind in ("for_each", "elements", "loops", "values"):
            for name, entry in settings[kind].items():
                self.assertTrue(entry.get("reason"), name)


def main():
    global BIN
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    options, rest = parser.parse_known_args()
    BIN = options.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
