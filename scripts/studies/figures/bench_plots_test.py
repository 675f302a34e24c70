#!/usr/bin/env python3
"""Plots of scripts/bench, from a report in the form of the benchmark library; drawing of plots.

  bench_plots_test.py --bin FOLDER
"""

import argparse
import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree

import bench_plots
import plots

BIN = pathlib.Path(__file__).resolve().parents[3] / "build" / "release" / "bin"
TOOL = BIN / "plot_svg"


def run(name, bpvf, speed, **others):
    return {"run_name": name, "run_type": "iteration", "bpvf": bpvf, "vertex_frames/s": speed,
            **others}


RESULTS = {"benchmarks": [
    {"run_name": "Sums/temporal_bits:14/loops:0", "run_type": "iteration"},
    run("Decode/kg:0.1/a & b/real_time", 3.0, 8e6),
    run("Decode/kg:1.0/a & b/real_time", 0.5, 30e6),
    run("Decode/kg:1.0/a & b/real_time", 0.5, 10e6),
    run("Decode/kg:1.0/a & b/real_time", 0.5, 20e6),
    run("Decode/kg:1.0/a & b/real_time", 0.5, 1e6, run_type="aggregate"),
    run("Decode/kg:1.0/failed/real_time", 0.5, 1e6, error_occurred=True),
    run("DecodeAndHash/kg:0.3/a & b/real_time", 1.0, 1e6),
    run("EncodeTarget/kg:0.1/fast/a & b/real_time", 3.1, 2e6),
    run("EncodeTarget/kg:0.1/medium/a & b/real_time", 3.0, 0.5e6)]}


class BenchPlots(unittest.TestCase):
    def test_curves_are_medians_of_what_ran(self):
        self.assertEqual(bench_plots.curves(RESULTS), {
            "Decode": {("a & b", None): [(3.0, 8.0), (0.5, 20.0)]},
            "EncodeTarget": {("a & b", "fast"): [(3.1, 2.0)], ("a & b", "medium"): [(3.0, 0.5)]}})

    def test_writes_a_picture_of_each_kind(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "bench.json").write_text(json.dumps(RESULTS), encoding="utf-8")
            printed = subprocess.run([sys.executable, "-B", bench_plots.__file__, TOOL,
                                      folder / "bench.json", folder],
                                     check=True, capture_output=True, text=True).stdout
            paths = [folder / "decode.svg", folder / "encode.svg"]
            self.assertEqual([line for line in printed.split("\n") if line.endswith(".svg")],
                             [*map(str, paths)])
            for path, words in zip(paths, (["a & b"], ["a & b, fast", "a & b, medium"])):
                texts = [e.text for e in xml.etree.ElementTree.parse(path).iter() if e.text]
                for word in words:
                    self.assertIn(word, texts)

    def test_nothing_measured_nothing_written(self):
        self.assertEqual(bench_plots.curves({"benchmarks": RESULTS["benchmarks"][:1]}), {})


class Plots(unittest.TestCase):
    PLOT = plots.Plot("a & b", [plots.Series("c", [(1, 1), (2, 2)], "black")], "x", "y")

    def test_png_and_pdf_where_there_is_a_tool(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            with unittest.mock.patch.object(plots.shutil, "which", return_value=None):
                self.assertEqual(self.PLOT.save(TOOL, folder / "v1.2"), ["svg"])
            self.assertEqual([path.name for path in folder.iterdir()], ["v1.2.svg"])
            tool = folder / "tool"  # copies its last argument to that of -o
            tool.write_text('#!/bin/sh\nfor last; do :; done\n'
                            'while [ "$1" != -o ]; do shift; done\ncp "$last" "$2"\n')
            tool.chmod(0o755)
            with unittest.mock.patch.object(plots.shutil, "which", return_value=str(tool)):
                self.assertEqual(self.PLOT.save(TOOL, folder / "v1.3"), ["svg", "png", "pdf"])
            svg = self.PLOT.svg(TOOL)
            for ending in ("svg", "png", "pdf"):
                self.assertEqual((folder / f"v1.3.{ending}").read_text(), svg)

    def test_it_is_well_formed_and_in_words_of_any_language(self):
        title = "<é & ﷽>"
        plot = dataclasses.replace(self.PLOT, title=title)
        svg = xml.etree.ElementTree.fromstring(plot.svg(TOOL))
        texts = [e.text for e in svg.iter("{http://www.w3.org/2000/svg}text")]
        for word in (title, "c", "x", "y"):
            self.assertIn(word, texts)

    def test_what_cannot_be_drawn_is_named(self):
        for points, words in (([(1, 0)], "c: not above 0"), ([], "no points"),
                              ([(1, None)], "number"), ([(1,)], "out of range")):
            plot = dataclasses.replace(self.PLOT, series=[plots.Series("c", points, "black")])
            with self.subTest(points=points), self.assertRaisesRegex(plots.Failure, words):
                plot.svg(TOOL)
        bad = dataclasses.replace(self.PLOT, series=[plots.Series("c", [(1, 1)], "black", "wavy")])
        with self.assertRaisesRegex(plots.Failure, "wavy"):
            bad.svg(TOOL)
        with self.assertRaisesRegex(plots.Failure, "/nowhere/plot_svg: No such file"):
            self.PLOT.svg("/nowhere/plot_svg")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, default=BIN)
    options, rest = parser.parse_known_args()
    TOOL = options.bin.resolve() / "plot_svg"
    unittest.main(argv=[sys.argv[0], *rest])
