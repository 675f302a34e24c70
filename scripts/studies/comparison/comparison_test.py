#!/usr/bin/env python3
"""Arithmetic, searches and reports of scripts/compare, without any codec."""

import csv
import dataclasses
import math
import pathlib
import shutil
import struct
import sys
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / name)
                for name in ("comparison", "figures")]
import arithmetic
import codec_table
import inputs
import measure
import report

SEQUENCE = measure.Sequence("a & b", None, None, 100, 10)


def point(codec, kg, size, gof="all"):
    return measure.Point(SEQUENCE.name, codec, gof, "--x", size, 8 * size / SEQUENCE.size, kg, 0.5,
                         2.0, 0.5, 10.0, 5.0)


class Rates(unittest.TestCase):
    def test_front_leaves_out_what_is_beaten(self):
        self.assertEqual(arithmetic.front([(1, 50), (0.1, 100), (0.5, 120), (2, 50), (0, 900)]),
                         [(0.1, 100), (1, 50)])

    def test_linear_in_logarithms_between_points(self):
        points = [(0.1, 400), (1.0, 100), (10.0, 10)]
        self.assertAlmostEqual(arithmetic.size_at(points, math.sqrt(0.1)), 200)
        self.assertAlmostEqual(arithmetic.size_at(points, math.sqrt(10)), math.sqrt(1000))
        self.assertEqual(arithmetic.size_at(points, 1.0), 100)

    def test_beyond_the_points(self):
        points = [(0.1, 400), (1.0, 100), (1.2, 101)]
        self.assertIsNone(arithmetic.size_at(points, 0.09))
        self.assertEqual(arithmetic.size_at(points, 1.1), 100)
        self.assertIsNone(arithmetic.size_at([], 1))

    def test_geometric_mean(self):
        self.assertAlmostEqual(arithmetic.geometric_mean([1, 4, 16]), 4)
        self.assertIsNone(arithmetic.geometric_mean([1, None]))
        self.assertIsNone(arithmetic.geometric_mean([]))

    def test_power_fit(self):
        factor, power = arithmetic.power_fit([(x, 3 * x ** 1.25) for x in (1, 10, 200)])
        self.assertAlmostEqual(factor, 3)
        self.assertAlmostEqual(power, 1.25)


class Cubic(unittest.TestCase):
    # Slopes of (0, 0), (1, 1), (2, 4) by hand: differences 1 and 3; inside 6 / (3/1 + 3/3) = 1.5;
    # left (3 * 1 - 3) / 2 = 0, right (3 * 3 - 1) / 2 = 4.
    CURVE = arithmetic.Pchip([(0, 0), (1, 1), (2, 4)])

    def test_slopes(self):
        self.assertEqual([self.CURVE.value_and_slope(x)[1] for x in (0, 1, 2)], [0, 1.5, 4])

    def test_integral(self):
        # h (y0 + y1) / 2 + h^2 (s0 - s1) / 12 of each piece
        self.assertAlmostEqual(self.CURVE.integral(0, 1), 1 / 2 - 1.5 / 12)
        self.assertAlmostEqual(self.CURVE.integral(0, 2), 0.375 + 5 / 2 - 2.5 / 12)
        parts = self.CURVE.integral(0, 0.3) + self.CURVE.integral(0.3, 1.7)
        self.assertAlmostEqual(parts + self.CURVE.integral(1.7, 2), self.CURVE.integral(0, 2))

    def test_no_overshoot(self):
        curve = arithmetic.Pchip([(0, 0), (1, 0), (2, 1), (3, 1)])
        values = [curve.value_and_slope(i / 50)[0] for i in range(151)]
        self.assertEqual(values, sorted(values))
        self.assertEqual((values[0], values[-1]), (0, 1))


class BdRate(unittest.TestCase):
    REFERENCE = [(0.05, 900), (0.1, 500), (0.3, 200), (1.0, 80)]

    def test_a_constant_factor_is_itself(self):
        for factor in (0.5, 1, 3):
            other = [(kg, factor * size) for kg, size in self.REFERENCE]
            self.assertAlmostEqual(arithmetic.bd_rate(other, self.REFERENCE), 100 * (factor - 1))

    def test_mean_of_a_factor_that_grows(self):
        # Twice the bytes at one end, eight times at the other, straight in logarithms: four times.
        self.assertAlmostEqual(arithmetic.bd_rate([(0.1, 800), (1, 20)], [(0.1, 100), (1, 10)]),
                               300)

    def test_only_errors_that_both_reach(self):
        other = [(kg, 2 * size) for kg, size in self.REFERENCE[1:3]]
        self.assertAlmostEqual(arithmetic.bd_rate(other, self.REFERENCE[1:3]), 100)
        self.assertIsNone(arithmetic.bd_rate([(2, 50), (3, 40)], self.REFERENCE))
        self.assertIsNone(arithmetic.bd_rate([(0.1, 50)], self.REFERENCE))


class Search(unittest.TestCase):
    @staticmethod
    def ladder(errors, asked):
        measured = []

        def measure_step(setting):
            measured.append(setting)
            return dataclasses.replace(point("x", 1, 1), kg_error_percent=setting)

        found = measure.climb(errors, measure_step, asked)
        return sorted(p.kg_error_percent for p in found), measured

    def test_both_sides_of_every_error_once(self):
        steps = [2.0 ** -i for i in range(16)]
        found, measured = self.ladder(steps, (0.05, 0.3))
        for value in (2 ** -5, 2 ** -4, 0.25, 0.5):
            self.assertIn(value, found)
        self.assertEqual(len(measured), len(set(measured)))
        self.assertLess(len(measured), 10)

    def test_ends(self):
        self.assertIn(2, self.ladder([8, 4, 2], [1])[0])
        self.assertIn(8, self.ladder([8, 4, 2], [9])[0])

    def test_no_more_components_than_frames(self):
        rlpca = next(codec for codec in codec_table.CODECS if codec.name == "rlpca")
        ladder = rlpca.ladders[0]
        kept = measure.usable(ladder, dataclasses.replace(SEQUENCE, num_frames=12))
        self.assertTrue(kept and kept[-1].endswith("--components 12"))


class Inputs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def make(self, *names):
        for name in names:
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_text("")

    def found(self, *names):
        return [(i.name, i.path.relative_to(self.folder).as_posix(), i.points and i.points.name)
                for i in inputs.find([self.folder / name for name in names])]

    def test_formats_are_those_of_the_readers(self):
        self.assertLessEqual({".obj", ".ply", ".off"}, set(inputs.MESHES))
        self.assertLessEqual({".pc2", ".mdd"}, set(inputs.CACHES))
        self.assertLessEqual({*inputs.GLTF, ".rlpd"}, set(inputs.WHOLE))

    def test_meshes_with_their_caches(self):
        self.make("a.obj", "a.pc2", "b.ply", "b.mdd", "alone.obj", "x.glb", "y.pc2")
        pairs = [("a", "a.obj", "a.pc2"), ("b", "b.ply", "b.mdd")]
        self.assertEqual(self.found("."), pairs)
        self.assertEqual(self.found("a.obj", "b.ply"), pairs)
        self.assertEqual(self.found("a.obj", "y.pc2", "alone.obj", "a.pc2"),
                         [("a", "a.obj", "y.pc2"), ("alone", "alone.obj", "a.pc2")])

    def test_whole_animations(self):
        self.make("d/walk.glb", "d/run.gltf", "d/clip.rlpd", "d/mesh.obj", "d/notes.txt")
        whole = [("clip", "d/clip.rlpd", None), ("run", "d/run.gltf", None),
                 ("walk", "d/walk.glb", None)]
        self.assertEqual(self.found("d"), whole)
        self.assertEqual(self.found("d/clip.rlpd", "d/run.gltf", "d/walk.glb"), whole)

    def test_a_file_for_each_frame(self):
        self.make("walk/f_001.obj", "walk/f_002.obj")
        self.assertEqual(self.found("walk"), [("walk", "walk", None)])
        self.assertEqual(self.found("walk/f_%03d.obj"), [("f", "walk/f_%03d.obj", None)])
        self.assertEqual(self.found("walk/*.obj"), [("walk", "walk/*.obj", None)])

    def test_point_caches_state_their_size(self):
        self.make("a.obj")
        (self.folder / "a.pc2").write_bytes(
            struct.pack("<12siiffi", b"POINTCACHE2\0", 1, 7, 0.0, 1.0, 9))
        (a,) = inputs.open_all(inputs.find([self.folder]), None, None)
        self.assertEqual((a.name, a.num_vertices, a.num_frames), ("a", 7, 9))

    def test_complaints(self):
        self.make("alone.obj", "a.obj", "a.pc2", "b/a.obj", "b/a.pc2", "texts/a.txt")
        for words, names in ((("alone.obj",), "is one frame"), (("c.obj",), "no such file"),
                             (("alone.obj", "c.pc2"), "c.pc2: no such file"),
                             (("a.obj", "b/a.obj"), "two inputs are called a"),
                             (("a.pc2",), "name its mesh before it"),
                             (("texts",), "holds no mesh")):
            with self.assertRaisesRegex(measure.Failure, names):
                self.found(*words)
        with self.assertRaisesRegex(measure.Failure, "--animation: no input is a glTF file"):
            inputs.open_all(inputs.find([self.folder / "a.obj"]), None, None,
                            ("--animation", "Run"))


class OwnCodecs(unittest.TestCase):
    ENCODE, DECODE = "enc {mesh} {step} {file}", "dec {file} {out}.pc2"

    def ladder(self, steps):
        return codec_table.own_codec("x", self.ENCODE, self.DECODE, steps, 0).ladders

    def test_steps(self):
        self.assertEqual(self.ladder("4..7"), (("4", "5", "6", "7"),))
        self.assertEqual(self.ladder("1..-1"), (("1", "0", "-1"),))
        self.assertEqual(self.ladder("0.1,-q 5"), (("0.1", "-q 5"),))

    def test_complaints(self):
        for words, complaint in ((("a b", self.ENCODE, self.DECODE, "1"), "only"),
                                 (("main", self.ENCODE, self.DECODE, "1"), "built-in"),
                                 (("x", "enc {mesh} {step}", self.DECODE, "1"),
                                  "{file} is missing"),
                                 (("x", "enc {step} {file}", self.DECODE, "1"),
                                  "{mesh} or {points}"),
                                 (("x", self.ENCODE, "dec {file}", "1"), "{out} is missing"),
                                 (("x", self.ENCODE, "dec {mesh} {file} {out}", "1"),
                                  "unknown {mesh}"),
                                 (("x", "enc {mesh} {file}", self.DECODE, "1,2"),
                                  "{step} is missing"),
                                 (("x", self.ENCODE, self.DECODE, ","), "no steps"),
                                 (("x", "awk '{' {file}", self.DECODE, "1"), "double the braces")):
            with self.subTest(words=words), self.assertRaises(codec_table.BadCodec) as raised:
                codec_table.own_codec(*words, 0)
            self.assertIn(complaint, str(raised.exception))

    def test_own_codecs_have_colours_of_their_own(self):
        """Far apart in CIE L*a*b*, where 2.3 is just noticeable."""
        def lab(colour):
            channels = [int(colour[i:i + 2], 16) / 255 for i in (1, 3, 5)]
            r, g, b = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
                       for c in channels)
            x, y, z = (t ** (1 / 3) if t > 0.008856 else 7.787 * t + 16 / 116 for t in (
                (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
                0.2126 * r + 0.7152 * g + 0.0722 * b,
                (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089))
            return 116 * y - 16, 500 * (x - y), 200 * (y - z)

        own = codec_table.OWN_COLOURS
        known = [codec.colour for codec in codec_table.CODECS]
        for i, colour in enumerate(own):
            for other in (*known, *own[:i]):
                self.assertGreater(math.dist(lab(colour), lab(other)), 25, (colour, other))

    def test_results_depend_on_the_files_that_are_named(self):
        codec = codec_table.own_codec("x", f"sh {__file__} {{mesh}} {{file}}", self.DECODE, "1", 0)
        self.assertIn(str(pathlib.Path(__file__).resolve()), codec.files())
        self.assertIn(str(pathlib.Path(shutil.which("sh")).resolve()), codec.files())

    def test_what_is_decoded_is_found(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            out, mesh = folder / "decoded", pathlib.Path("in.obj")
            sequence = dataclasses.replace(SEQUENCE, mesh=mesh)
            with self.assertRaisesRegex(measure.Failure, "no {out}"):
                measure.decoded_words(sequence, out)
            cache = folder / "decoded.mdd"
            cache.write_text("")
            self.assertEqual(measure.decoded_words(sequence, out), [mesh, "--points-b", cache])
            (folder / "decoded.ply").write_text("")
            self.assertEqual(measure.decoded_words(sequence, out), [cache])
            cache.unlink()
            (folder / "decoded.ply").rename(folder / "decoded.glb")
            self.assertEqual(measure.decoded_words(sequence, out), [folder / "decoded.glb"])
            out.mkdir()
            with self.assertRaisesRegex(measure.Failure, "wrote decoded, decoded.glb"):
                measure.decoded_words(sequence, out)


class Missing(unittest.TestCase):
    """Codecs that cannot be run name what would help."""
    LORENZO, DRACO = (next(c for c in codec_table.CODECS if c.name == name)
                      for name in ("lorenzo-xz", "draco"))

    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="a build ")
        self.addCleanup(temporary.cleanup)
        self.build = pathlib.Path(temporary.name)
        (self.build / "bin").mkdir()

    def reason(self, codec):
        return codec_table.Toolbox(self.build / "bin").missing(codec)

    def test_programs_of_ours(self):
        self.assertEqual(self.reason(self.DRACO),
                         f"peer_codec is not in {self.build / 'bin'}; leave out --bin to have it "
                         "built")
        (self.build / "CMakeCache.txt").touch()
        self.assertIn(f"`cmake '{self.build}' && cmake --build '{self.build}' --target peer_codec`",
                      self.reason(self.DRACO))

    def test_libraries(self):
        (self.build / "CMakeCache.txt").touch()
        tool = self.build / "bin" / "peer_codec"
        tool.write_text("#!/bin/sh\necho lorenzo\n")
        tool.chmod(0o755)
        self.assertIsNone(self.reason(self.LORENZO))
        for words in ("without the library", "scripts/setup --compare, then run `cmake"):
            self.assertIn(words, self.reason(self.DRACO))

    def test_programs_of_others(self):
        with unittest.mock.patch.object(codec_table.shutil, "which", return_value=None):
            self.assertEqual(self.reason(dataclasses.replace(self.LORENZO, prepare=(),
                                                             encode=("xz",), decode=())),
                             "xz is not installed; run scripts/setup --compare")


class Reports(unittest.TestCase):
    CODECS = [c for c in codec_table.CODECS if c.name in ("main", "baseline", "draco")]
    POINTS = [point("main", 0.1, 500), point("main", 1.1, 50), point("baseline", 0.1, 1000),
              point("baseline", 1.1, 100), point("draco", 0.2, 2000, "")]

    def setUp(self):
        self.curves = report.curves_of(self.CODECS, ("all",))

    def test_rates(self):
        table = report.rates_table([SEQUENCE], self.curves, self.POINTS, 0.1)
        self.assertEqual(table.rows, [["a & b", "4.00", "8.00", "-"]])
        ratios = report.ratios_table([SEQUENCE], self.curves, self.POINTS, [0.1, 0.5])
        self.assertEqual(ratios.rows,
                         [["Baseline", "2.00", "2.00"], ["draco per frame", "-", "18.8"]])
        bd = report.bd_table([SEQUENCE], self.curves, self.POINTS)
        self.assertEqual(bd.rows[0], ["Baseline", "+100.0 %", "+100.0 %"])
        extra = report.extra_table([SEQUENCE], self.curves, self.POINTS, [0.1, 0.5])
        self.assertEqual(extra.rows[0], ["Baseline", "+100.0 / +100.0", "+100.0 / +100.0"])

    def test_tools_are_compared_with_main_without_clusters(self):
        curves = report.curves_of(codec_table.MAIN_ABLATIONS[:3], ("all",))
        names = [curve.codec.name for curve in curves]
        points = [point(name, kg, size)
                  for name, sizes in zip(names, ((500, 50), (600, 60), (900, 90)))
                  for kg, size in zip((0.1, 1.1), sizes)]
        tables = report.ablation_tables([SEQUENCE], curves, points, [0.1])
        self.assertEqual([t.title.split(" at ")[0] for t in tables[::2]],
                         ["Per cent more bytes than Main",
                          "Per cent more bytes than Main, no clusters"])
        self.assertEqual([[row[1] for row in t.rows] for t in tables[::2]], [["+20.0"], ["+50.0"]])
        self.assertEqual([len(t.rows) for t in tables], [1, 1, 1, 1])

    def test_tables_of_the_readme(self):
        rates = report.readme_rates([SEQUENCE], self.curves, self.POINTS, [0.1, 1.1])
        self.assertEqual(rates.rows,
                         [["Main", "4.00 / 0.400"], ["Baseline", "8.00 / 0.800 (+100 %)"],
                          ["draco per frame", "- / 16.0 (-)"]])
        table = report.readme_bd_rates([SEQUENCE, SEQUENCE], self.curves, self.POINTS, 0.1)
        row = ["a & b: 100 vertices, 10 frames", "4.00", "+100 %", "-"]
        self.assertEqual(table.rows, [row, row, ["geometric mean", *row[1:]]])
        self.assertTrue(all(len(line) == len(table.head) for line in table.rows))

    def test_a_column_for_each_gof(self):
        curves = report.curves_of(self.CODECS, ("all", "64"))
        self.assertEqual([c.title for c in curves], [
            "Main, GOF all", "Main, GOF 64", "Baseline, GOF all", "Baseline, GOF 64",
            "draco per frame"])

    def test_numbers(self):
        for value, text in ((0.5, "0.500"), (12.3456, "12.3"), (1234.5, "1230"), (2, "2.00"),
                            (0.01, "0.0100"), (0, "0"), (None, "-"), (99.99, "100")):
            self.assertEqual(report.number(value), text)

    def test_csv_reads_back(self):
        rows = list(csv.DictReader(report.points_csv(self.POINTS).splitlines()))
        self.assertEqual(len(rows), len(self.POINTS))
        self.assertEqual((rows[0]["sequence"], rows[0]["bytes"], float(rows[1]["bpvf"])),
                         ("a & b", "500", 0.4))

    def test_plot_and_page_are_well_formed(self):
        plot = report.curve_plot(SEQUENCE, self.curves, self.POINTS, (0.1, 1.0))
        self.assertEqual(plot.title, "a & b: 100 vertices, 10 frames")
        self.assertEqual([series.name for series in plot.series],
                         ["Main", "Baseline", "draco per frame"])
        self.assertEqual(plot.series[1].points, [(0.8, 1.1), (8.0, 0.1)])
        table = report.rates_table([SEQUENCE], self.curves, self.POINTS, 0.1)
        page = report.page("T < 1", ["n & m"], [table], ["<svg/>"])
        xml.etree.ElementTree.fromstring(page.split("\n", 1)[1])
        self.assertLess(page.index("<svg"), page.index("<table"))
        text = report.markdown("T", ["n"], [table], ["a & b"])
        self.assertLess(text.index("![a & b](<a & b.svg>)"), text.index("| sequence |"))
        self.assertIn("- n", text)

    def test_nothing_to_draw(self):
        self.assertIsNone(report.curve_plot(SEQUENCE, self.curves, [], (0.1, 1.0)))

    def test_marked_text_is_replaced_and_nothing_else(self):
        begin, end = report.marks("rates")
        text = f"{report.marks('x')}\na\n{begin}\nold\n{end}\nb\n"
        new = report.replace_marked(text, "rates", "| new |\n")
        self.assertEqual(new, text.replace("old\n", "| new |\n"))
        self.assertEqual(report.replace_marked(new, "rates", "| new |\n"), new)
        with self.assertRaises(measure.Failure):
            report.replace_marked("a\n", "rates", "x")


class Tables(unittest.TestCase):
    def test_names_are_distinguished(self):
        for table in (codec_table.CODECS, *codec_table.ABLATIONS.values()):
            self.assertEqual(len({c.name for c in table}), len(table))
        known = {c.name for c in codec_table.CODECS}
        self.assertLessEqual({*codec_table.DEFAULT, *codec_table.README_OTHERS}, known)


if __name__ == "__main__":
    unittest.main()
