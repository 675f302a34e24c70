"""Lossless coding on a grid, compared with general-purpose compressors of the same numbers."""

import array
import csv
import io
import json
import lzma
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

import measure
import report

BITS = (12, 14, 16)
TITLES = {"rlpc": "RLPC", "xz": "time delta + xz -9e", "zfp": "zfp", "fpzip": "fpzip"}


DEFINITIONS = (
    "Coordinates are rounded to the grid of rlpcenc --lossless BITS: the finest whose step is a "
    "power of two and on which they have at most that many bits. Decoded, and coded again with "
    "--lossless, they do not change.",
    "bpvf: 8 * bytes / (vertices * frames); of RLPC with connectivity and headers, but without the "
    "order of vertices in the input (rlpcenc --keep-order); of the others, the numbers alone.",
    "xz compresses differences between frames, folded and divided into planes of bytes. zfp "
    "(reversible) and fpzip compress 32-bit floats, as frames or as paths of coordinates, "
    "whichever is smaller.")


def csv_text(table):
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows([table.head, *table.rows])
    return out.getvalue()


def floats_of_cache(path, sequence):
    """The floats of a PC2 file, frame by frame, x, y and z of each vertex."""
    with open(path, "rb") as file:
        file.seek(32)
        floats = array.array("f")
        floats.fromfile(file, 3 * sequence.size)
    if sys.byteorder == "big":
        floats.byteswap()
    return floats


def encode(toolbox, sequence, bits, folder):
    """(bytes of the stream, its report, positions in grid steps, coordinates), the last two in the
    order of the input. Fails unless the decoded animation is coded again without any error."""
    stream, points, again = folder / "a.rlpc", folder / "a.pc2", folder / "again.rlpc"
    options = ["--profile", "high", "--gof", "all", "--keep-order", "--json"]

    def run(tool, *words):
        done = subprocess.run([toolbox.path(tool), *map(str, words)], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            raise measure.Failure(f"{tool}: {done.stderr.strip()}")
        return done.stdout

    said = json.loads(run("rlpcenc", sequence.mesh, "--points", sequence.points, "-o", stream,
                          "--lossless", bits, *options))
    run("rlpcdec", stream, "-o", points, "--quiet")
    own = json.loads(run("rlpcenc", sequence.mesh, "--points", points, "-o", again, "--lossless",
                         *options))
    if own["metrics"]["max_error"] != 0:
        raise measure.Failure("coding the decoded animation again changes it")
    # The order of vertices is not what the others are asked for.
    size = stream.stat().st_size - said["bits"]["vertex_order"] // 8
    floats = floats_of_cache(points, sequence)
    step = math.ldexp(1.0, said["grid_log2_step"])
    return size, said, [round(x / step) for x in floats], floats


def time_deltas(positions, values):
    """Bytes of the differences between frames, as planes of bytes, the lowest first; those of a
    frame axis by axis; negative ones folded between positive ones."""
    before = [0] * values
    folded = array.array("I")
    for first in range(0, len(positions), values):
        frame = positions[first:first + values]
        deltas = [a - b for a, b in zip(frame, before)]
        for axis in range(3):
            folded.extend((d << 1) ^ (d >> 31) for d in deltas[axis::3])
        before = frame
    if sys.byteorder == "big":
        folded.byteswap()
    data = folded.tobytes()
    return b"".join(data[plane::4] for plane in range(4))


def xz_bytes(positions, sequence):
    return len(lzma.compress(time_deltas(positions, 3 * sequence.num_vertices),
                             preset=9 | lzma.PRESET_EXTREME))


def by_time(floats, sequence):
    """The coordinates with the frames of one coordinate side by side."""
    values = 3 * sequence.num_vertices
    turned = array.array("f")
    for axis in range(3):
        for i in range(axis, values, 3):
            turned.extend(floats[i::values])
    return turned


def array_bytes(tool, floats, sequence, folder):
    """The smaller file of two layouts: as frames, and as paths of coordinates."""
    vertices, frames = sequence.num_vertices, sequence.num_frames
    sizes = []
    for layout, shape in ((floats, (3, vertices, frames)),
                          (by_time(floats, sequence), (frames, vertices, 3))):
        raw, packed = folder / "a.raw", folder / "a.packed"
        raw.write_bytes(struct.pack(f"<{len(layout)}f", *layout))
        words = {"zfp": ["zfp", "-q", "-i", raw, "-z", packed, "-f", "-3", *shape, "-R"],
                 "fpzip": ["fpzip", "-q", "-i", raw, "-o", packed, "-t", "float", "-3", *shape]}
        measure.run_step([str(word) for word in words[tool]])
        sizes.append(packed.stat().st_size)
    return min(sizes)


def compressors():
    """Compressors that can be run, and what the others lack."""
    notes = [f"Skipped: {TITLES[tool]}: not installed (Debian: {package})."
             for tool, package in (("zfp", "zfp"), ("fpzip", "fpzip-utils"))
             if not shutil.which(tool)]
    return ["xz", *(tool for tool in ("zfp", "fpzip") if shutil.which(tool))], notes


def measure_one(toolbox, sequence, bits, tools):
    """{"rlpc" or tool: bytes}, and the grid in words."""
    with tempfile.TemporaryDirectory(prefix="rlpc-lossless-") as name:
        folder = pathlib.Path(name)
        size, said, positions, floats = encode(toolbox, sequence, bits, folder)
        found = {"rlpc": size, "xz": xz_bytes(positions, sequence)}
        for tool in tools:
            if tool != "xz":
                found[tool] = array_bytes(tool, floats, sequence, folder)
    return found, f"2^{said['grid_log2_step']}, {said['position_bits']} bits"


def table(toolbox, sequences, tools, say):
    rows, ratios = [], {bits: [] for bits in BITS}
    for sequence in sequences:
        for bits in BITS:
            found, grid = measure_one(toolbox, sequence, bits, tools)
            best = min(found[tool] for tool in tools)
            ratios[bits].append(found["rlpc"] / best)
            rows.append([sequence.name, f"{bits}", grid,
                         *(report.number(8 * found[name] / sequence.size)
                           for name in ("rlpc", *tools)),
                         report.number(found["rlpc"] / best)])
            say(" ".join(rows[-1]))
    for bits, row in ratios.items():
        mean = math.exp(sum(map(math.log, row)) / len(row))
        rows.append(["geometric mean", f"{bits}", *[""] * (2 + len(tools)), report.number(mean)])
    return report.Table("Lossless coding, bpvf",
                        ["animation", "BITS", "grid, units", "RLPC", *(TITLES[t] for t in tools),
                         "RLPC / best other"], rows)
