"""Tables 2, 3 and 4 of the registration paper, and two that its text describes: rates by the size
of clusters, and by the motion of frames."""

import statistics

import claims
import registration_frames
import registration_published as published
import report
from models import CHICKEN
from rlpca_paths import Positions

SIZES = (50, 75, 100, 125, 160, 200)  # vertices per cluster
QUICK_SIZES = (50, 100, 125, 200)
AROUND = (0.9, 1.1)  # factors of the KG error at the PSNR of the paper, to interpolate
SWEPT = ("k-way", "Lloyd")


def _cells(values):
    return [report.NOTHING if x is None else f"{x:.4g}" for x in values]


def _mean_in(points, first, last):
    found = [value for frame, value in points if first <= frame <= last]
    return statistics.fmean(found) if found else None


def ranges_table(made):
    """Table 2. Ours only if the sequence is the chicken, whose frames these are."""
    rows = []
    for (first, last), clusterings in published.TABLE_2.items():
        for name, row in clusterings.items():
            ours = [None] * 4
            if made.model is CHICKEN:
                detail = made.details[name]
                ours = [_mean_in(points, first, last) for points in (
                    detail.types(0), detail.types(1), detail.ratios(), detail.psnr())]
            rows.append([f"{first}-{last}", name,
                         *_cells((row.type1, row.type2, row.ratio, row.psnr)), *_cells(ours)])
    head = ["frames", "clustering"]
    for where in (", published", ""):
        head += [f"{what}{where}" for what in ("type 1", "type 2", "CR", "PSNR, dB")]
    return report.Table("Table 2: frames of the chicken", head, rows)


def algorithms_table(made):
    """Table 3. Ours at each d_a, if the sequence is the chicken."""
    names = ("k-way", "Lloyd", "spectral", "Main", "High")
    rows = []
    for name, (ratio, kg) in published.TABLE_3.items():
        ours = [None] * len(names)
        if made.model is CHICKEN and kg is not None:
            rates = [claims.rate_at(made.curves[n], kg) for n in names]
            ours = [published.RAW / rate if rate else None for rate in rates]
        rows.append([name, *_cells((ratio, kg)), *_cells(ours)])
    return report.Table("Table 3: compression ratios of the chicken",
                        ["method", "CR, published", "d_a, %",
                         *(f"CR of {name} at this d_a" for name in names)], rows)


def thresholds_table(made):
    """Table 4. There are no thresholds here: ours are at the PSNR of each row."""
    rows = []
    for tau, clusterings in published.TABLE_4.items():
        for name, row in clusterings.items():
            rows.append([tau, name, *_cells(row), *_cells([made.ratio(name, row[2])])])
    return report.Table("Table 4: the face, by threshold, and rates at its PSNR",
                        ["tau", "clustering", "type 1, published", "CR, published",
                         "PSNR, published, dB", f"CR at this PSNR, {made.sequence.name}"], rows)


def sweep(made):
    """{clustering: [(vertices per cluster, clusters, compression ratio at the paper's PSNR)]}"""
    found = {}
    for name in SWEPT:
        kg = made.near[name][0].kg
        for size in QUICK_SIZES if made.quick else SIZES:
            count = max(2, round(made.sequence.num_vertices / size))
            settings = [*made.partition(name, count)]
            runs = [made.bench.run(f"{name}, {count}", [*settings, *made.bench.target(kg * x)])
                    for x in AROUND]
            found.setdefault(name, []).append((size, count, made.ratio_of(runs)))
    return found


def sweep_table(found):
    rows = [[str(size), str(count), *_cells([ratio]), *_cells([found["Lloyd"][i][2]])]
            for i, (size, count, ratio) in enumerate(found["k-way"])]
    return report.Table("Compression ratio by the size of clusters",
                        ["vertices per cluster", "clusters", *SWEPT], rows)


def motion_of(made):
    """{clustering: compression ratio of frames with little motion, and with much}"""
    motion = registration_frames.mean_motion(Positions(made.sequence))
    return {name: registration_frames.by_motion(motion, made.details[name].ratios())
            for name in made.CLUSTERINGS}


def motion_table(found):
    return report.Table("Compression ratio by motion: frames below and above its median",
                        ["clustering", "little motion", "much motion"],
                        [[name, *_cells(pair)] for name, pair in found.items()])
