#!/usr/bin/env python3
"""Draws the picture of README.md: one frame of a bundled animation, original and decoded from a
stream of each named quality, with the sizes of the streams.

  scripts/studies/figures/draw_qualities.py [--bin FOLDER] [-o FILE]

  --bin FOLDER   folder of rlpcenc and rlpcdec (default: build/release/bin)
  -o FILE        output (default: scripts/studies/figures/qualities.svg)
"""

import argparse
import html
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
INPUT = ROOT / "streams" / "inputs" / "elephant.obj"
FRAME = 38
QUALITIES = ("fine", "good", "preview")
PANEL, HEIGHT, CAPTION = 245, 170, 44
YAW, PITCH = math.radians(-34), math.radians(14)
LIGHT = (-0.35, 0.6, 0.75)
CLAY = (232, 214, 188)


def read_obj(path):
    """Vertices, and triangles as indices from 0."""
    vertices, triangles = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append(tuple(map(float, words[1:4])))
        elif words[:1] == ["f"]:
            triangles.append(tuple(int(word.split("/")[0]) - 1 for word in words[1:4]))
    return vertices, triangles


def read_pc2_frame(path, frame):
    data = path.read_bytes()
    count = struct.unpack_from("<i", data, 16)[0]
    values = struct.unpack_from(f"<{3 * count}f", data, 32 + 12 * count * frame)
    return list(zip(*[iter(values)] * 3))


def turned(vertex):
    """View coordinates: x to the right, y up, z towards the viewer."""
    x, y, z = vertex
    x, z = x * math.cos(YAW) + z * math.sin(YAW), z * math.cos(YAW) - x * math.sin(YAW)
    return x, y * math.cos(PITCH) - z * math.sin(PITCH), y * math.sin(PITCH) + z * math.cos(PITCH)


def normal(a, b, c):
    u = [b[i] - a[i] for i in range(3)]
    v = [c[i] - a[i] for i in range(3)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.hypot(*n)
    return [x / length for x in n] if length else n


def draw_mesh(vertices, triangles, place):
    """SVG paths of the triangles that face the viewer, the farthest first."""
    seen = [turned(vertex) for vertex in vertices]
    strength = math.hypot(*LIGHT)
    faces = []
    for triangle in triangles:
        corners = [seen[v] for v in triangle]
        n = normal(*corners)
        if n[2] <= 0:
            continue
        light = max(0.0, sum(a * b for a, b in zip(n, LIGHT)) / strength)
        shade = 0.5 + 0.5 * light
        colour = "#" + "".join(f"{round(channel * shade):02x}" for channel in CLAY)
        path = "M" + "L".join("{:.1f} {:.1f}".format(*place(corner)) for corner in corners) + "z"
        faces.append((sum(corner[2] for corner in corners), f'<path d="{path}" fill="{colour}" '
                      f'stroke="{colour}"/>'))
    return [face for _, face in sorted(faces)]


def placing(vertices):
    """A function that maps points into a panel so that all vertices fit."""
    seen = [turned(vertex) for vertex in vertices]
    low = [min(v[i] for v in seen) for i in range(2)]
    high = [max(v[i] for v in seen) for i in range(2)]
    scale = min((PANEL - 14) / (high[0] - low[0]), (HEIGHT - 14) / (high[1] - low[1]))
    middle = [(low[i] + high[i]) / 2 for i in range(2)]
    return lambda v: (PANEL / 2 + scale * (v[0] - middle[0]),
                      HEIGHT / 2 - scale * (v[1] - middle[1]))


def encoded(tools, folder, quality):
    """(mesh of the frame, report) of a stream of this quality."""
    stream = folder / f"{quality}.rlpc"
    done = subprocess.run([tools / "rlpcenc", INPUT, "--points", INPUT.with_suffix(".pc2"), "-o",
                           stream, "--quality", quality, "--json", "-q"], check=True,
                          capture_output=True)
    subprocess.run([tools / "rlpcdec", stream, "-q", "-o", folder / f"{quality}_%d.obj", "--frames",
                    f"{FRAME}-{FRAME}"], check=True)
    return read_obj(folder / f"{quality}_{FRAME}.obj"), json.loads(done.stdout)


def panel(index, drawing, title, words):
    middle = PANEL // 2
    return [f'<g transform="translate({index * PANEL} 0)">', *drawing,
            f'<text x="{middle}" y="{HEIGHT + 16}" font-weight="bold">{html.escape(title)}</text>',
            f'<text x="{middle}" y="{HEIGHT + 34}">{html.escape(words)}</text>', "</g>"]


def picture(tools):
    _, triangles = read_obj(INPUT)
    original = read_pc2_frame(INPUT.with_suffix(".pc2"), FRAME)
    place = placing(original)
    with tempfile.TemporaryDirectory(prefix="rlpc-qualities-") as folder:
        results = [encoded(tools, pathlib.Path(folder), quality) for quality in QUALITIES]
    report = results[0][1]
    raw = 12 * report["num_vertices"] * report["num_frames"]
    panels = panel(0, draw_mesh(original, triangles, place), "original",
                   f"{raw / 1000:.0f} kB of floats, 96 bpvf")
    for index, (quality, ((vertices, faces), report)) in enumerate(zip(QUALITIES, results), 1):
        normals = report["metrics"]["vertex_normal_rms_degrees"]
        panels += panel(index, draw_mesh(vertices, faces, place), f"--quality {quality}",
                        f"{report['bytes'] / 1000:.1f} kB, {report['bpvf']:.2f} bpvf, "
                        f"normals {normals:.2g}\u00b0")
    width, height = PANEL * (1 + len(QUALITIES)), HEIGHT + CAPTION
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
        f'height="{height}" font-family="sans-serif" font-size="13" text-anchor="middle">',
        "<style>text{fill:#222}path{stroke-width:.7;stroke-linejoin:round}"
        "@media(prefers-color-scheme:dark){text{fill:#ddd}}</style>", *panels, "</svg>", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, default=ROOT / "build" / "release" / "bin")
    parser.add_argument("-o", dest="output", type=pathlib.Path,
                        default=pathlib.Path(__file__).with_name("qualities.svg"))
    arguments = parser.parse_args()
    try:
        arguments.output.write_text(picture(arguments.bin))
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"draw_qualities.py: {error}; build the tools first (scripts/quickstart)",
              file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
