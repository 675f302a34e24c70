#!/usr/bin/env python3
"""Draws the clusters of a bundled animation for each method of partitioning, side by side, with the
sizes of the streams.

  scripts/studies/figures/draw_partitions.py [--bin FOLDER] [-o FILE] [--name NAME] [--clusters N]

  --bin FOLDER   folder of rlpcenc and rlpcinfo (default: build/release/bin)
  -o FILE        output (default: build/figures/partitions.svg)
  --name NAME    elephant, curtain or robot_arm (default: elephant)
  --clusters N   number of clusters (default: 12)
"""

import argparse
import html
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
INPUTS = ROOT / "streams" / "inputs"
PARTITIONS = ("seeds", "kway", "lloyd", "spectral", "motion")
KG_PERCENT = "0.5"
PANEL, HEIGHT, CAPTION = 340, 300, 48


class Failure(Exception):
    """The figure was not drawn; the text says why."""


def run(*command):
    try:
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout
    except OSError as error:
        raise Failure(f"{error}; build the tools first (scripts/quickstart)") from error
    except subprocess.CalledProcessError as error:
        raise Failure(error.stderr.strip()) from error


def front_view(svg):
    """The paths of the first view of a picture, as an element."""
    return re.search(r'<g class="view".*?</g>', svg, re.DOTALL).group(0)


def panel(index, view, lines):
    title, size = (html.escape(line) for line in lines)
    words = [f'<text x="{PANEL // 2}" y="{HEIGHT + 18}" font-weight="bold">{title}</text>',
             f'<text x="{PANEL // 2}" y="{HEIGHT + 40}">{size}</text>']
    return [f'<g transform="translate({index * PANEL} 0)">', view, *words, "</g>"]


def side_by_side(panels):
    """A picture of these panels. panels: (picture of rlpcinfo, title, caption)"""
    drawn = []
    for index, (svg, *lines) in enumerate(panels):
        drawn += panel(index, front_view(svg), lines)
    width, height = PANEL * len(panels), HEIGHT + CAPTION
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
        f'height="{height}" font-family="sans-serif" font-size="17" text-anchor="middle">',
        "<style>text{fill:#222}@media(prefers-color-scheme:dark){text{fill:#ddd}}</style>", *drawn,
        "</svg>", ""])


def picture(tools, name, clusters):
    panels = []
    with tempfile.TemporaryDirectory(prefix="rlpc-partitions-") as folder:
        folder = pathlib.Path(folder)
        for partition in PARTITIONS:
            stream = folder / f"{partition}.rlpc"
            report = json.loads(run(
                tools / "rlpcenc", INPUTS / f"{name}.obj", "--points", INPUTS / f"{name}.pc2", "-o",
                stream, "--profile", "baseline", "--partition", partition, "--clusters",
                str(clusters), "--gof", "all", "--kg", KG_PERCENT, "--json", "-q"))
            run(tools / "rlpcinfo", stream, "--pictures", folder / partition)
            svg = (folder / partition / "clusters.svg").read_text(encoding="utf-8")
            panels.append((svg, f"--partition {partition}",
                           f"{report['bytes'] / 1000:.1f} kB, {report['bpvf']:.2f} bpvf"))
    return side_by_side(panels)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    parser.add_argument("-o", dest="output", type=pathlib.Path,
                        default=ROOT / "build" / "figures" / "partitions.svg")
    parser.add_argument("--name", choices=("elephant", "curtain", "robot_arm"), default="elephant")
    parser.add_argument("--clusters", type=int, default=12)
    arguments = parser.parse_args()
    try:
        arguments.output.parent.mkdir(parents=True, exist_ok=True)
        arguments.output.write_text(picture(arguments.bin, arguments.name, arguments.clusters),
                                    encoding="utf-8")
    except (Failure, OSError) as error:
        print(f"draw_partitions.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
