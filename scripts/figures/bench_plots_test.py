#!/usr/bin/env python3
"""Plots of scripts/bench, from a report as the benchmark library writes it."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree

import bench_plots
import svg_plot


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
            printed = subprocess.run([sys.executable, "-B", bench_plots.__file__,
                                      folder / "bench.json", folder],
                                     check=True, capture_output=True, text=True).stdout
            paths = [folder / "decode.svg", folder / "encode.svg"]
            self.assertEqual([line for line in printed.split("\n") if line.endswith(".svg")],
                             [*map(str, paths)])
            for path, words in zip(paths, (["a & b"], ["a & b, fast", "a & b, medium"])):
                texts = [e.text for e in xml.etree.ElementTree.parse(path).iter() if e.text]
                for word in words:
                    self.assertIn(word, texts)

    def test_png_and_pdf_where_there_is_a_tool(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            with unittest.mock.patch.object(svg_plot.shutil, "which", return_value=None):
                self.assertEqual(svg_plot.save(folder / "v1.2", "<svg/>"), ["svg"])
            self.assertEqual([path.name for path in folder.iterdir()], ["v1.2.svg"])
            tool = folder / "tool"  # copies its last argument to that of -o
            tool.write_text('#!/bin/sh\nfor last; do :; done\n'
                            'while [ "$1" != -o ]; do shift; done\ncp "$last" "$2"\n')
            tool.chmod(0o755)
            with unittest.mock.patch.object(svg_plot.shutil, "which", return_value=str(tool)):
                self.assertEqual(svg_plot.save(folder / "v1.3", "<svg/>"), ["svg", "png", "pdf"])
            for ending in ("svg", "png", "pdf"):
                self.assertEqual((folder / f"v1.3.{ending}").read_text(), "<svg/>")

    def test_long_names_have_room(self):
        def width(name):
            svg = svg_plot.plot("", [svg_plot.Series(name, [(1, 1), (2, 2)], "black")], "x", "y")
            return int(xml.etree.ElementTree.fromstring(svg).get("width"))
        self.assertEqual(width("a"), width("ab"))
        self.assertGreater(width(30 * "a"), width("a") + 40)

    def test_nothing_measured_nothing_written(self):
        self.assertEqual(bench_plots.curves({"benchmarks": RESULTS["benchmarks"][:1]}), {})


if __name__ == "__main__":
    unittest.main()
