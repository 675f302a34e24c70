#!/usr/bin/env python3
"""The specification as a decoder: its language, its examples, and itself against rlpcdec.

    specdec_test.py --bin BUILD/bin [unittest arguments, such as Streams]
"""

import argparse
import contextlib
import io
import json
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import spec_program  # noqa: E402
import specdec  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = None
PROGRAM = spec_program.Program(ROOT / "spec")


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)


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
        self.refuses("def F():\n    1 + 1", "no statement")
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
        self.refuses("def F():\n    return Unknown", "Unknown is known nowhere")
        self.refuses("def F():\n    return print(1)", "print is known nowhere")
        self.refuses("def F():\n    x = 1\ndef G():\n    return x", "x is known nowhere")
        self.refuses("def F(a):\n    return a\ndef G():\n    return F()", "takes 1 argument")
        self.refuses("def F(Big):\n    return 1", "lower-case word")
        self.refuses("def F():\n    return 1\ndef F():\n    return 2", "a second time")
        self.refuses("def F():\n    return 1\nF = 3", "something else")
        self.refuses("def F():\n    require(1 == 1, 2)", "rule id")

    def test_complaints_name_the_line(self):
        self.refuses("\ndef F():\n    x = )", "a.md:6")
        self.refuses("\ndef F():\n    return 1.5", "a.md:6")

    def test_names_tell_how_long_a_variable_lives(self):
        program = self.load("def F():\n    Kept = 1\n    also_kept = 2\n    lost = 3\n")
        variables = program.compile({})
        variables["F"]()
        self.assertEqual((variables["Kept"], variables["also_kept"]), (1, 2))
        self.assertNotIn("lost", variables)


def run_stream(data, program=PROGRAM, trace=None, widths=False):
    """(exit code, rule or None, number of frames, output) of specdec."""
    output = io.BytesIO()
    decoder = specdec.Decoder(program, data, output.write, trace, widths)
    code, rule = specdec.DONE, None
    try:
        decoder.call("stream")
    except specdec.Verdict as verdict:
        code, rule = verdict.code, verdict.rule
    return code, rule, decoder.place()[1], output.getvalue()


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
        self.assertEqual(answer["spec"], ["1.0", "1.1"])
        self.assertEqual(answer["profiles"], ["baseline", "main"])
        self.assertEqual(answer["levels"], [1, 2, 3, 4])


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
            v["BoneAxes"] = [[axes]]
            moved = v["MovedPoint"](0, 0, [self.extreme(1 << 28) for _ in range(3)])
            self.assertLess(max(map(abs, moved)), 1 << 32)

    def test_geometry_weights(self):
        v, r = self.v, self.random
        for _ in range(1500):
            n, m = r.randint(2, 7), r.choice((0, 1, 5, 24))
            spread = 1 << r.randint(0, 28)
            v["SpatialFactors"] = [[self.extreme(spread) for _ in range(n + m + 1)]
                                   for _ in range(3)]
            v.update(Ring=[list(range(1, n + 1))], OuterRing=[list(range(n + 1, n + m + 1))],
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

    def test_missing_input_is_no_verdict(self):
        code, _, errors = self.specdec("decode", self.folder / "none", self.folder / "a.rlpd")
        self.assertEqual(code, 4)
        self.assertNotIn("rlpc-verdict", errors)


def cut_animation(folder, name, frames):
    """The first frames of a bundled animation: (mesh, point cache)."""
    inputs = ROOT / "streams" / "inputs"
    mesh = shutil.copy(inputs / f"{name}.obj", folder)
    data = (inputs / f"{name}.pc2").read_bytes()
    points = struct.unpack_from("<i", data, 16)[0]
    cache = folder / f"{name}.pc2"
    cache.write_bytes(data[:28] + struct.pack("<i", frames) + data[32:32 + 12 * points * frames])
    return mesh, cache


def soup_animation(folder):
    """Triangles that no surface would have, some of them degenerate, and loose vertices."""
    r = random.Random(7)
    points = [[r.random() for _ in range(3)] for _ in range(40)]
    triangles = [[r.randrange(38) for _ in range(3)] for _ in range(70)]
    mesh, cache = folder / "soup.obj", folder / "soup.pc2"
    mesh.write_text("".join("v %f %f %f\n" % tuple(p) for p in points)
                    + "".join("f %d %d %d\n" % tuple(v + 1 for v in t) for t in triangles))
    frames = [[c + 0.1 * f * p[(k + 1) % 3] for p in points for k, c in enumerate(p)]
              for f in range(7)]
    header = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(points), 0.0, 1.0, len(frames))
    cache.write_bytes(header + b"".join(struct.pack(f"<{len(f)}f", *f) for f in frames))
    return mesh, cache


def encode(folder, animation, *settings, profile="baseline"):
    mesh, cache = animation
    stream = folder / "stream.rlpc"
    subprocess.run([BIN / "rlpcenc", mesh, "--points", cache, "-o", stream, "-q", "--profile",
                    profile, *settings], check=True, timeout=60)
    return stream.read_bytes()


class Clips(FolderTest):
    def rlpcdec(self, data):
        """(exit code, rule or None, number of frames before the error or None, output)."""
        stream, output = self.folder / "in.rlpc", self.folder / "out.rlpd"
        stream.write_bytes(data)
        output.unlink(missing_ok=True)
        done = subprocess.run([BIN / "rlpcdec", "decode", stream, output], capture_output=True,
                              text=True, timeout=60, check=False)
        verdict = {}
        if done.returncode != 0:
            word, _, text = done.stderr.splitlines()[-1].partition(" ")
            self.assertEqual(word, "rlpc-verdict")
            verdict = json.loads(text)
        return (done.returncode, verdict.get("rule"), verdict.get("frame"),
                output.read_bytes() if output.exists() else b"")


class StreamTest(Clips):
    """What rlpcenc writes decodes to the same bytes, and reads as the same syntax elements."""

    def agree(self, data):
        code, _, _, expected = self.rlpcdec(data)
        self.assertEqual(code, 0)
        elements = []
        decoded = run_stream(data, trace=lambda *element: elements.append(element))
        self.assertEqual(decoded[:2], (0, None))
        self.assertTrue(decoded[3] == expected, "other bytes than from rlpcdec")
        trace = subprocess.run([BIN / "rlpcinfo", self.folder / "in.rlpc", "--trace"], check=True,
                               capture_output=True, text=True, timeout=60).stdout
        listed = re.findall(r"^ *\d+    (\w+) = (-?\d+)$", trace, re.MULTILINE)
        self.assertEqual([(name, str(value)) for _, name, value in elements], listed)

    def numbers_matter(self, data, numbers):
        """Another number in the text of the specification gives another result."""
        expected = run_stream(data)
        for file, number, other in numbers:
            with self.subTest(number=number):
                copy = self.folder / "spec"
                shutil.copytree(ROOT / "spec", copy, dirs_exist_ok=True)
                text = (copy / file).read_text(encoding="utf-8")
                self.assertEqual(text.count(number), 1)
                (copy / file).write_text(text.replace(number, other), encoding="utf-8")
                try:
                    changed = run_stream(data, spec_program.Program(copy))
                except IndexError:
                    changed = None
                self.assertFalse(changed == expected, "the same result")


class Streams(StreamTest):
    def test_many_gofs_with_index_hashes_order_and_metadata(self):
        note = self.folder / "note.json"
        note.write_text('{"title": "elephant"}')
        self.agree(encode(self.folder, cut_animation(self.folder, "elephant", 33), "--kg", "0.5",
                          "--gof", "2", "--hash", "frame", "--keep-order", "--metadata", note))

    def test_local_frames_and_fine_components(self):
        self.agree(encode(self.folder, cut_animation(self.folder, "robot_arm", 12), "--gof", "all",
                          "--clusters", "4", "--components", "6", "--qu", "20", "--qc", "20",
                          "--qdelta", "24", "--no-rdo", "--frame", "lcf"))

    def test_world_coordinates_at_low_rate(self):
        self.agree(encode(self.folder, cut_animation(self.folder, "curtain", 9), "--bpvf", "2",
                          "--frame", "world", "--hash", "none", "--preset", "fast"))

    def test_triangle_soup(self):
        self.agree(encode(self.folder, soup_animation(self.folder), "--kg", "1", "--clusters", "3"))

    def test_every_intermediate_fits_64_bits(self):
        data = encode(self.folder, cut_animation(self.folder, "robot_arm", 3), "--gof", "all",
                      "--clusters", "2", "--components", "2", "--qu", "20", "--qc", "20",
                      "--qdelta", "24", "--no-rdo", "--frame", "lcf")
        self.assertEqual(run_stream(data, widths=True)[:2], (0, None))

    def test_numbers_of_the_text_matter(self):
        data = encode(self.folder, cut_animation(self.folder, "robot_arm", 4), "--gof", "all",
                      "--clusters", "2", "--components", "3", "--qu", "11", "--qc", "11",
                      "--no-rdo", "--frame", "lcf", "--hash", "none")
        self.numbers_matter(data, (
            ("09-parsing.md", "RateTable(7)", "RateTable(6)"),
            ("08-decoding.md", "[32768, 35734, ", "[32769, 35735, "),
            ("07-semantics.md", "TrackOfVertex = [-1]", "TrackOfVertex = [0]"),
            ("annex-a-rlpd.md", "values = [1, ", "values = [2, ")))


class MainStreams(StreamTest):
    """The same for the Main profile."""

    def encode(self, name, frames, *settings):
        return encode(self.folder, cut_animation(self.folder, name, frames), *settings,
                      profile="main")

    def test_many_gofs_with_index_hashes_and_order(self):
        self.agree(self.encode("elephant", 9, "--kg", "0.5", "--gof", "3", "--hash", "frame",
                               "--keep-order"))

    def test_bones(self):
        data = self.encode("robot_arm", 12, "--kg", "0.3", "--gof", "all")
        self.agree(data)
        self.assertEqual(run_stream(data, widths=True)[:2], (0, None))

    def test_triangle_soup(self):
        self.agree(encode(self.folder, soup_animation(self.folder), "--kg", "1", profile="main"))

    def test_slices_can_be_left_out(self):
        data = self.encode("curtain", 6, "--kg", "0.5", "--hash", "none", "--bones", "1")
        whole = list(units(data))
        slices = [i for i, (kind, _) in enumerate(whole) if kind == SLICE]
        self.assertGreater(len(slices), 1)
        outputs = set()
        for first in slices:
            cut = stream_of(data, [u for i, u in enumerate(whole) if i not in slices or i < first])
            code, rule, frames, output = run_stream(cut)
            self.assertEqual((code, frames), (0, 6), rule)
            self.assertTrue(output == self.rlpcdec(cut)[3], "other bytes than from rlpcdec")
            outputs.add(output)
        self.assertEqual(len(outputs), len(slices))

    def test_numbers_of_the_text_matter(self):
        data = self.encode("curtain", 9, "--kg", "0.5", "--hash", "none")
        self.numbers_matter(data, (
            ("08-decoding.md", "left = 16384", "left = 19384"),
            ("08-decoding.md", "range(1, 7)", "range(1, 6)"),
            ("08-decoding.md", "[0, 1, 2, 0, 0, 1]", "[0, 1, 2, 0, 0, 2]"),
            ("09-parsing.md", "GroupEnd = [3]", "GroupEnd = [2]"),
            ("09-parsing.md", "[8, 13, 20, 32]", "[8, 13, 20, 33]"),
            ("09-parsing.md", "96 * ComponentMean[l]", "95 * ComponentMean[l]")))


SLICE = 6


def units(data):
    """(type byte, payload) of every unit."""
    place = 10
    while place < len(data):
        size = struct.unpack_from(">I", data, place + 1)[0]
        yield data[place], data[place + 5:place + 5 + size]
        place += 9 + size


def stream_of(data, all_units):
    result = data[:10]
    for kind, payload in all_units:
        unit = struct.pack(">BI", kind, len(payload)) + payload
        result += unit + struct.pack(">I", zlib.crc32(unit))
    return result


class DamagedStreams(Clips):
    """Damaged streams draw the same verdict, and the same frames before it, from both decoders."""

    def agree(self, cases):
        for number, data in enumerate(cases):
            with self.subTest(number=number):
                code, rule, frames, output = run_stream(data)
                got = self.rlpcdec(data)
                self.assertEqual((code, rule, frames if code else None), got[:3])
                self.assertTrue(output == got[3], "other bytes than from rlpcdec")
                if output:
                    vertices, triangles = struct.unpack_from("<II", output, 8)
                    self.assertEqual(len(output), 44 + 12 * triangles + 12 * vertices * frames)

    def stream(self):
        return encode(self.folder, soup_animation(self.folder), "--kg", "2", "--gof", "3",
                      "--clusters", "3", "--keep-order", "--hash", "frame", "--frame", "lcf")

    def test_cut_off(self):
        data = self.stream()
        self.agree(data[:n] for n in list(range(0, 30, 4)) + list(range(30, len(data), 101)))

    def test_changed_payloads_with_good_crcs(self):
        data = self.stream()
        r = random.Random(3)
        cases = []
        for _ in range(80):
            all_units = list(units(data))
            i = r.randrange(len(all_units))
            payload = bytearray(all_units[i][1])
            payload[r.randrange(min(len(payload), r.choice((8, 1000))))] = r.randrange(256)
            all_units[i] = (all_units[i][0], bytes(payload))
            cases.append(stream_of(data, all_units))
        self.agree(cases)

    def test_misplaced_units(self):
        data = self.stream()
        cases = []
        for i in range(1, len(list(units(data)))):
            for kind in (0x01, 0x05, 0x06, 0x84):
                all_units = list(units(data))
                cases.append(stream_of(data, all_units[:i] + [(kind, b"?")] + all_units[i:]))
            del all_units[i]
            cases.append(stream_of(data, all_units))
        self.agree(cases)


class DamagedMainStreams(DamagedStreams):
    """The same for the Main profile."""

    def stream(self):
        return encode(self.folder, soup_animation(self.folder), "--kg", "2", "--gof", "4",
                      "--keep-order", "--hash", "frame", profile="main")


class DamagedMixedStreams(DamagedStreams):
    """The same for a stream with GOFs of clusters and of bones."""

    def stream(self):
        return (ROOT / "streams/v1.1/accept/MIX/MIX-0201a.rlpc").read_bytes()


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
