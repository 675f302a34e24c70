#!/usr/bin/env python3
"""Plots of speed against rate, as SVG, from the JSON report of the benchmarks.

  bench_plots.py PLOT_SVG BENCH.json FOLDER

draws FOLDER/decode.svg and FOLDER/encode.svg, if their benchmarks ran, and prints their paths.
"""

import json
import pathlib
import re
import statistics
import sys

import plots

NAME = re.compile(r"(Decode|EncodeTarget)/kg:[\d.]+(?:/(fast|medium))?/(.+)/real_time")
COLOURS = ("#0f6fb4", "#c8501e", "#2d8a4e", "#7f4fa8", "#8a6d00", "#b03070")
TITLES = {"Decode": "Decoding, one thread", "EncodeTarget": "Encoding to a KG error, one thread"}
FILES = {"Decode": "decode", "EncodeTarget": "encode"}


def curves(results):
    """{kind: {(animation, preset): [(bpvf, million vertex-frames per second)]}}, kind as in TITLES;
    medians if benchmarks were repeated."""
    runs = {}
    for run in results["benchmarks"]:
        match = NAME.fullmatch(run["run_name"])
        if match and run["run_type"] == "iteration" and not run.get("error_occurred"):
            runs.setdefault(run["run_name"], (match, []))[1].append(run)
    found = {}
    for match, repeated in runs.values():
        kind, preset, animation = match.groups()
        speed = statistics.median(run["vertex_frames/s"] for run in repeated) / 1e6
        points = found.setdefault(kind, {}).setdefault((animation, preset), [])
        points.append((repeated[0]["bpvf"], speed))
    return found


def plot(kind, lines):
    animations = list(dict.fromkeys(animation for animation, _ in lines))
    series = []
    for (animation, preset), points in lines.items():
        fast = preset == "fast"
        series.append(plots.Series(animation + (f", {preset}" if preset else ""),
                                   sorted(points),
                                   COLOURS[animations.index(animation) % len(COLOURS)],
                                   "dashed" if fast else "solid", "square" if fast else "circle"))
    return plots.Plot(TITLES[kind], series, "bits per vertex and frame (whole file)",
                      "million vertices times frames per second")


def main():
    tool, results, folder = map(pathlib.Path, sys.argv[1:])
    for kind, lines in curves(json.loads(results.read_text(encoding="utf-8"))).items():
        path = folder / FILES[kind]
        for ending in plot(kind, lines).save(tool, path):
            print(f"{path}.{ending}")


if __name__ == "__main__":
    main()
