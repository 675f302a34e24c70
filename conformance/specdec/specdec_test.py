#!/usr/bin/env python3
"""The specification as a decoder: its language, its examples, its bounds, its commands.

    specdec_test.py [unittest arguments, such as Language]
"""

import contextlib
import io
import json
import os
import pathlib
import random
import re
import sys
import unittest
import unittest.mock
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import spec_program
import specdec
from specdec_testing import PROGRAM, ROOT, FolderTest, run_stream


class Language(FolderTest):
    """Blocks outside of the subset of clause 4.3, and the complaint that each must draw."""

    def load(self, *blocks):
        text = "# 1 Test\n" + "".join(f"\n```rlpc\n{block}\n```\n" for block in blocks)
        (self.folder / "a.md").write_text(text, encoding="utf-8")
        return spec_program.Program(self.folder)

    def refuses(self, block, complaint):
        with self.assertRaises(spec_program.SpecError) as raised:
            self.load(block)
        self.assertIn(complaint, str(raised.exception))

    def test_what_the_clause_lists_is_accepted(self):
        program = self.load(
            "Table = [1, 2, 4]\nAll = Sum(Table)",
            "def Sum(list):\n    total = 0\n    for x in list:\n        total = total + x\n"
            "    return total\n",
            "def Run():\n    n = 0\n    Found = [0] * 3\n    while n < 3 and not n == 5:\n"
            "        Found[n] = (Table[n] << 2) // 3 % 5\n        n = n + 1\n"
            "        if n > 7:\n            break\n        elif n > 8:\n            continue\n"
            "        else:\n            Found.append(-n)\n    return Found\n")
        variables = program.compile({})
        self.assertEqual(variables["All"], 7)
        self.assertEqual(variables["Run"](), [1, 2, 0, -1, -2, -3])

    def test_other_statements_are_refused(self):
        self.refuses("import os", "functions and assignments only")
        self.refuses("def F():\n    import os", "Import is not in the pseudo-code language")
        self.refuses("def F():\n    x = 1\n    x += 1", "AugAssign")
        self.refuses("def F():\n    global A", "Global")
        self.refuses("def F():\n    pass", "Pass")
        self.refuses("class C:\n    x = 1", "functions and assignments only")
        self.refuses("def F():\n    try:\n        F()\n    finally:\n        F()", "Try")
        self.refuses("def F():\n    a = b = 1", "one target")
        self.refuses("def F():\n    a, b = 1, 2", "the target is a name")
        self.refuses("def F():\n    1 + 1", "not a statement")
        self.refuses("def F():\n    def G():\n        F()\n    G()", "within a function")
        self.refuses("F()", "functions and assignments only")

    def test_other_expressions_are_refused(self):
        for expression, complaint in {
                "1.5": "not an integer", "1 / 2": "Div", "2 ** 3": "Pow", "'x'": "not an integer",
                "True": "not an integer", "[i for i in range(3)]": "ListComp",
                "lambda: 1": "Lambda",
                "(1, 2)": "Tuple", "{1: 2}": "Dict", "1 if 2 else 3": "IfExp",
                "1 < 2 < 3": "two sides",
                "1 in [1]": "In is not", "[1, 2][0:1]": "Slice", "[1].copy()": "append",
                "range(stop=3)": "no names", "[[1]] * 3": "one integer", "~1": "Invert"}.items():
            with self.subTest(expression=expression):
                self.refuses(f"def F():\n    return {expression}", complaint)

    def test_names_must_be_known(self):
        self.refuses("def F():\n    return Unknown", "Unknown is not defined")
        self.refuses("def F():\n    return print(1)", "print is not defined")
        self.refuses("def F():\n    x = 1\ndef G():\n    return x", "x is not defined")
        self.refuses("def F(a):\n    return a\ndef G():\n    return F()", "takes 1 argument")
        self.refuses("def F(Big):\n    return 1", "lower-case word")
        self.refuses("def F():\n    return 1\ndef F():\n    return 2", "a second time")
        self.refuses("def F():\n    return 1\nF = 3", "something else")
        self.refuses("def F():\n    require(1 == 1, 2)", "rule id")

    def test_complaints_name_the_line(self):
        self.refuses("\ndef F():\n    x = )", "a.md:6")
        self.refuses("\ndef F():\n    return 1.5", "a.md:6")

    def test_names_show_lifetimes_of_variables(self):
        program = self.load("def F():\n    Kept = 1\n    also_kept = 2\n    lost = 3\n")
        variables = program.compile({})
        variables["F"]()
        self.assertEqual((variables["Kept"], variables["also_kept"]), (1, 2))
        self.assertNotIn("lost", variables)


class Text(FolderTest):
    """The specification agrees with itself."""

    def table(self, title):
        text = (ROOT / "spec" / "annex-c-trace.md").read_text(encoding="utf-8")
        text = text[text.index(f"## {title}"):]
        section = bytes.fromhex(re.search(r"The section is `([0-9A-F ]+)`", text).group(1))
        rows = re.findall(r"^\|(.*)\|$", text.split("\n## ")[0], re.MULTILINE)
        return section, [[cell.strip() for cell in row.split("|")] for row in rows[2:]]

    def start(self, section):
        v = specdec.Decoder(PROGRAM, section, None).variables
        v["StartReading"]()
        v["StartSection"]()
        return v

    def state(self, v):
        return [str(v["SectionPosition"]), f"{v['Range']:08X}", f"{v['Code']:08X}"]

    def test_bins_of_annex_c(self):
        section, rows = self.table("C.1 Bins\n")
        v = self.start(section)
        models = {"A": v["NewModel"](), "B": v["NewModel"]()}
        for row in rows[:-1]:
            name, argument = re.fullmatch(r"(\w+)\( (\w+) \)", row[3]).groups()
            state = " ".join(map(str, models[argument])) if name == "ae" else ""
            expected = self.state(v) + [row[3], state]
            result = v[name](models[argument] if name == "ae" else int(argument))
            self.assertEqual(row, expected + [str(result)])
        self.assertEqual(rows[-1][:3], self.state(v))
        v["EndSection"]()

    def test_residuals_of_annex_c(self):
        section, rows = self.table("C.2 Residuals\n")
        v = self.start(section)
        models = v["ResidualModels"]()
        for row in rows[:-1]:
            expected = self.state(v) + [row[3], "%d, %d" % tuple(v["ResidualContext"](int(row[3])))]
            self.assertEqual(row, expected + [str(v["ae_residual"](models, int(row[3])))])
        self.assertEqual(rows[-1][:3], self.state(v))
        v["EndSection"]()

    def test_examples_of_annex_c(self):
        text = (ROOT / "spec" / "annex-c-trace.md").read_text(encoding="utf-8")
        tables = re.findall(r"^(Table C-\d).*\n\n\| step \| value \|\n\|---\|---\|\n((?:\|.*\n)+)",
                            text, re.MULTILINE)
        self.assertEqual([name for name, _ in tables],
                         ["Table C-3", "Table C-4", "Table C-5", "Table C-6", "Table C-7",
                          "Table C-8"])
        for name, rows in tables:
            v = specdec.Decoder(PROGRAM, b"", None, widths=True).variables
            for step, value in re.findall(r"^\| (.*) \| (.*)\|$", rows, re.MULTILINE):
                result = None
                if re.match(r"\w+ = ", step):
                    exec(step, v)
                else:
                    result = eval(step, v)
                expected = eval(value) if value else None
                self.assertEqual(result, expected, f"{name}: {step}")

    def test_shift_that_annex_c_names(self):
        text = (ROOT / "spec" / "annex-c-trace.md").read_text(encoding="utf-8")
        largest, bits, shift = map(int, re.search(
            r"by\s+up\s+to\s+(\d+),\s+which\s+has\s+(\d+)\s+bits,\s+so\s+that\s+offsets\s+are\s+"
            r"shifted\s+left\s+by\s+(\d+)\s+bits", text).groups())
        offsets = eval(re.search(r"^\| Offsets \| (.*) \|$", text, re.MULTILINE).group(1))
        self.assertEqual(largest << shift, max(abs(c) for offset in offsets for c in offset))
        self.assertEqual([largest.bit_length(), bits + shift], [bits, 11])

    def test_triangulations_of_table_8_2(self):
        text = (ROOT / "spec" / "08-decoding.md").read_text(encoding="utf-8")
        table = text[text.index("begin: triangulations"):text.index("end: triangulations")]
        listed = [(int(n), int(k), [list(map(int, t.split())) for t in triangles.split(",")])
                  for n, k, triangles in re.findall(r"^\| (\d) \| (\d) \| (.*) \|$", table,
                                                    re.MULTILINE)]
        lists = PROGRAM.compile({"StreamBytes": b""})["Triangulations"]
        self.assertEqual(listed, [(n, t[-1][1], t) for n in (4, 5) for t in lists[n]])
        self.assertEqual(list(map(len, lists)), [0, 0, 1, 1, 2, 5, 14, 42])

    def test_integer_functions_do_what_their_notes_say(self):
        v = specdec.Decoder(PROGRAM, b"", None).variables
        self.assertEqual([v["Round2"](5, 1), v["Round2"](-5, 1), v["Round2"](-5, 0)], [3, -2, -5])
        self.assertEqual([v["DivRound"](5, 2), v["DivRound"](-5, 2), v["DivRound"](-7, 3)],
                         [3, -2, -2])
        self.assertEqual([v["ISqrt"](x) for x in (0, 15, 16, (1 << 62) - 1)],
                         [0, 3, 4, (1 << 31) - 1])
        self.assertEqual([v["CeilLog2"](x) for x in (1, 2, 3, 4, 5)], [0, 1, 2, 2, 3])
        one = 1 << 30
        self.assertEqual(v["Normalize3"]([0, -7, 0]), [0, -one, 0])
        for bits in (1, 24, 49, 55):
            vector = v["Normalize3"]([(1 << bits) - 1, 1 - (1 << bits), (1 << bits) // 3])
            self.assertLess(sum(c * c for c in vector), (one + 8) ** 2)
            self.assertGreater(sum(c * c for c in vector), (one - 8) ** 2)

    def test_crc_is_that_of_zlib(self):
        v = specdec.Decoder(PROGRAM, b"", None).variables
        data = b"xx123456789"
        self.assertEqual(v["Crc32"](data, 2, 11, 0), 0xCBF43926)
        self.assertEqual(v["Crc32"](data, 7, 11, v["Crc32"](data, 0, 7, 0)), zlib.crc32(data))

    def test_every_element_of_the_contract_is_there(self):
        answer = specdec.describe(ROOT / "spec")
        self.assertEqual(answer["spec"], ["1.0", "1.1", "1.2"])
        self.assertEqual(answer["profiles"], ["baseline", "main", "high"])
        self.assertEqual(answer["levels"][:4], [1, 2, 3, 4])


class MainWidths(unittest.TestCase):
    """The bounds that 8.11 and 8.12 state, with the greatest values that can occur."""

    @classmethod
    def setUpClass(cls):
        cls.v = specdec.Decoder(PROGRAM, b"", None, widths=True).variables
        cls.random = random.Random(11)

    def extreme(self, limit):
        """A number of at most this magnitude, as large or as small as can be, or any."""
        r = self.random
        return r.choice((limit, -limit, limit - 1, 0, 1, -1, r.randint(-limit, limit),
                         r.randint(-(limit >> 20), limit >> 20)))

    def test_steps(self):
        steps = [self.v["StepOf"](idx) for idx in range(240)]
        self.assertEqual(steps, sorted(steps))
        self.assertEqual((steps[0], steps[8], steps[80]), (1, 2, 1024))
        self.assertLess(steps[-1], 1 << 30)

    def test_rotations_and_moved_points(self):
        v, one = self.v, 1 << 30
        v["BonePivot"] = [[-(1 << 28)] * 3]
        v["BoneOrigin"] = [[[one - 1, -one, one - 1]]]
        for _ in range(3000):
            q = v["NormalizeQuaternion"]([self.extreme((1 << 56) - 1) for _ in range(4)])
            self.assertLess(sum(c * c for c in q), (one + 8) ** 2)
            self.assertGreater(sum(c * c for c in q), (one - 8) ** 2)
            turn = [one] + [self.extreme(one) for _ in range(3)]
            q = v["RotationAfter"](q, turn)
            self.assertLessEqual(max(map(abs, q)), one)
            axes = v["AxesOf"](q)
            self.assertLessEqual(max(abs(c) for axis in axes for c in axis), one + 32)
            for on_axis in zip(*axes):
                self.assertLess(sum(c * c for c in on_axis), (one + 64) ** 2)
            v["BoneAxes"] = [[axes]]
            moved = v["MovedPoint"](0, 0, [self.extreme(1 << 28) for _ in range(3)])
            self.assertLess(max(map(abs, moved)), 1 << 31)

    def test_geometry_weights(self):
        v, r = self.v, self.random
        for _ in range(1500):
            n, m = r.randint(2, 7), r.choice((0, 1, 5, 24))
            spread = 1 << r.randint(0, 28)
            v["SpatialFactors"] = [[self.extreme(spread) for _ in range(n + m + 1)]
                                   for _ in range(3)]
            v.update(Ring=[list(range(1, n + 1))], OuterNeighbours=[list(range(n + 1, n + m + 1))],
                     RingWeights=[], OuterWeights=[], outer_weight=r.randint(0, 15),
                     outer_scale=r.randint(0, 15), damping_log2=r.randint(0, 15))
            v["PlainWeights"](0)
            v["FindOffsets"](0)
            self.assertLessEqual(max(abs(c) for o in v["Offsets"] for c in o), 1 << 11)
            self.assertLess(max(map(abs, v["Gap"])), 1 << 14)
            v["AdjustWeights"](0)
            weights = v["RingWeights"][0] + v["OuterWeights"][0]
            self.assertEqual(sum(weights), 1 << 14)
            self.assertLess(sum(map(abs, weights)), 1 << 24)

    def test_streams_of_large_values(self):
        streams = ROOT / "streams" / "v1.1" / "accept"
        large = [p for p in sorted(streams.glob("*/*.json"))
                 if "widths" in json.loads(p.read_text(encoding="utf-8"))["features"]]
        self.assertGreater(len(large), 5)
        for path in large:
            data = path.with_suffix(".rlpc").read_bytes()
            self.assertEqual(run_stream(data, widths=True)[:2], (0, None), path)


class Commands(FolderTest):
    def specdec(self, *args):
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            try:
                code = specdec.main([str(a) for a in args])
            except SystemExit as stop:
                code = stop.code
        return code, output.getvalue(), errors.getvalue()

    def test_conformance_answer_is_json(self):
        code, output, _ = self.specdec("--rlpc-conformance")
        self.assertEqual(code, 0)
        self.assertEqual(json.loads(output)["name"], "specdec")

    def test_usage(self):
        self.assertEqual(self.specdec()[0], 64)
        self.assertEqual(self.specdec("decode", "a")[0], 64)
        self.assertEqual(self.specdec("encode", "a", "b")[0], 64)

    def test_verdict_is_the_last_line(self):
        stream = self.folder / "a.rlpc"
        for data, code, rule in ((b"", 1, "R-BIT-01"), (b"\x89RLPX", 1, "R-STR-01"),
                                 (b"\x89RLPC\r\n\x1a\x02\x00", 2, "R-STR-02"),
                                 (b"\x89RLPC\r\n\x1a\x01\x00", 1, "R-UNT-01")):
            with self.subTest(data=data):
                stream.write_bytes(data)
                done = self.specdec("decode", stream, self.folder / "a.rlpd")
                self.assertEqual(done[0], code)
                line = done[2].splitlines()[-1]
                self.assertTrue(line.startswith("rlpc-verdict "), line)
                self.assertEqual(json.loads(line[13:])["rule"], rule)
                self.assertFalse((self.folder / "a.rlpd").exists())

    @unittest.mock.patch.dict(os.environ)
    def test_a_cache_saves_the_translation_and_nothing_else(self):
        os.environ.pop("RLPC_SPECDEC_CACHE", None)
        stream = ROOT / "streams" / "v1.0" / "accept" / "GOF" / "GOF-0002a.rlpc"
        plain, cached = self.folder / "plain.rlpd", self.folder / "cached.rlpd"
        self.assertEqual(self.specdec("decode", stream, plain)[0], 0)
        cache = self.folder / "cache"
        with unittest.mock.patch.object(spec_program, "Program",
                                        wraps=spec_program.Program) as program:
            for _ in range(2):
                cached.unlink(missing_ok=True)
                self.assertEqual(self.specdec("--cache", cache, "decode", stream, cached)[0], 0)
                self.assertEqual(cached.read_bytes(), plain.read_bytes())
            self.assertEqual(program.call_count, 1)
            code, output, _ = self.specdec("--cache", cache, "decode", stream, cached, "--trace")
            self.assertEqual((code, program.call_count), (0, 2))  # another program
            self.assertIn("profile_idc = ", output)
            self.assertEqual(self.specdec("--cache", cache, "--rlpc-conformance"),
                             self.specdec("--rlpc-conformance"))
            calls = program.call_count
            os.environ["RLPC_SPECDEC_CACHE"] = str(cache)
            self.assertEqual(self.specdec("decode", stream, cached)[0], 0)
            self.assertEqual(program.call_count, calls)

    def test_a_cache_knows_other_texts(self):
        spec = self.folder / "spec"
        spec.mkdir()
        for rule in ("R-AAA-01", "R-AAA-02"):
            (spec / "a.md").write_text("# 1 T\n\n```rlpc\ndef stream():\n"
                                       f'    require(0, "{rule}")\n```\n', encoding="utf-8")
            code, _, errors = self.specdec("--spec", spec, "--cache", self.folder / "cache",
                                           "decode", __file__, self.folder / "out.rlpd")
            self.assertEqual(code, 1)
            self.assertIn(rule, errors)

    def test_missing_input_is_no_verdict(self):
        code, _, errors = self.specdec("decode", self.folder / "none", self.folder / "a.rlpd")
        self.assertEqual(code, 4)
        self.assertNotIn("rlpc-verdict", errors)


if __name__ == "__main__":
    unittest.main()
