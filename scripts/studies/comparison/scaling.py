"""Time and memory against the size of the input, on animations made for it."""

import csv
import io
import pathlib
import subprocess
import tempfile

import arithmetic
import codec_table
import measure
import report
import plots

# Vertices, frames.
SIZES = ((1_000, 50), (1_000, 500), (1_000, 5_000), (10_000, 50), (10_000, 500), (10_000, 5_000),
         (100_000, 50), (100_000, 500), (1_000_000, 50))
SETTING = "--kg 0.1"
COLUMNS = (("encode_seconds", "encode, s"), ("decode_seconds", "decode, s"),
           ("encode_peak_mib", "encode, MiB"), ("decode_peak_mib", "decode, MiB"))


def make_sequence(toolbox, folder, num_vertices, num_frames):
    name = f"tentacle-{num_vertices}-{num_frames}"
    path = folder / name
    subprocess.run([toolbox.path("make_tentacle"), str(num_vertices), str(num_frames), path],
                   check=True)
    return measure.open_sequence(path.with_suffix(".obj"), path.with_suffix(".pc2"))


def run(laboratory, codecs, gof, limit):
    """(sequence, point) of every size up to `limit` vertices times frames. The files of an
    animation exist only while needed."""
    found = []
    for num_vertices, num_frames in sorted(SIZES, key=lambda size: size[0] * size[1]):
        if num_vertices * num_frames > limit:
            continue
        with tempfile.TemporaryDirectory(prefix="rlpc-scaling-") as folder:
            sequence = make_sequence(laboratory.toolbox, pathlib.Path(folder), num_vertices,
                                     num_frames)
            found += [(sequence, laboratory.measure(sequence, codec, gof, SETTING))
                      for codec in codecs]
    return found


def sizes_table(found):
    rows = []
    for sequence, point in found:
        rows.append([point.codec, f"{sequence.num_vertices}", f"{sequence.num_frames}",
                     *(report.number(getattr(point, name)) for name, _ in COLUMNS),
                     report.number(point.bpvf), report.number(point.kg_error_percent)])
    return report.Table("Every size", ["codec", "vertices", "frames",
                                       *(title for _, title in COLUMNS), "bpvf", "KG, %"], rows)


def fits_table(found, codecs):
    rows = []
    for codec in codecs:
        for what in ("encode", "decode"):
            times = [(s.size, getattr(p, f"{what}_seconds")) for s, p in found
                     if p.codec == codec.name]
            if len({size for size, _ in times}) < 2:
                continue
            factor, power = arithmetic.power_fit(times)
            size, seconds = max(times)
            rows.append([f"{codec.title}, {what}", f"{factor:.3g} * n^{power:.2f} s",
                         f"{size / seconds / 1e6:.3g}"])
    return report.Table("Fit of time to n = vertices times frames",
                        ["", "time", "at the largest, million a second"], rows)


def plot(found, codecs):
    """Points, and the fits as lines."""
    series = []
    for codec in codecs:
        for what, line, marker in (("encode", "solid", "circle"), ("decode", "dashed", "square")):
            points = sorted((s.size, getattr(p, f"{what}_seconds")) for s, p in found
                            if p.codec == codec.name)
            series.append(plots.Series(f"{codec.title}, {what}", points, codec.colour, "none",
                                       marker))
            ends = sorted({points[0][0], points[-1][0]})
            if len(ends) == 2:
                factor, power = arithmetic.power_fit(points)
                series.append(plots.Series(f"about n^{power:.2f}",
                                           [(n, factor * n ** power) for n in ends],
                                           codec.colour, line, "none"))
    return plots.Plot(f"Time against size, {SETTING}", series, "n = vertices times frames",
                      "seconds")


def points_csv(found):
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(["codec", "vertices", "frames", *(name for name, _ in COLUMNS), "bytes", "bpvf",
                   "kg_error_percent"])
    for s, p in found:
        rows.writerow([p.codec, s.num_vertices, s.num_frames,
                       *(f"{getattr(p, name):.6g}" for name, _ in COLUMNS), p.bytes,
                       f"{p.bpvf:.9g}", f"{p.kg_error_percent:.9g}"])
    return text.getvalue()


def default_codecs():
    return [c for c in codec_table.CODECS if c.name in ("main", "main-fast")]
