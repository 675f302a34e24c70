"""Claims of the RLPCA paper, and whether measured runs confirm them, in words."""

import arithmetic
from claims import SAME, NEGLIGIBLE, counted, curve, percent


def equal_settings(claim, better, worse):
    """Errors of two methods at the same N and L; nearly equal ones do not count."""
    known = {(r.clusters, r.components): r.kg for r in worse}
    ratios = [r.kg / known[r.clusters, r.components] for r in better
              if r.kg > 0 and known.get((r.clusters, r.components), 0) > 0]
    different = [r for r in ratios if abs(r - 1) > SAME]
    more = f"error {percent(arithmetic.geometric_mean(ratios))} on average" if ratios else ""
    if len(different) < len(ratios):
        more += f"; {len(ratios) - len(different)} more are equal"
    return counted(claim, sum(r < 1 for r in different), len(different), more)


def frame_by_frame(claim, better, worse):
    """Errors of each frame; nearly equal ones do not count."""
    different = [(b, w) for b, w in zip(better, worse) if abs(b - w) > SAME * w]
    equal = len(better) - len(different)
    return counted(claim, sum(b < w for b, w in different), len(different),
                   f"{equal} more frames are equal" if equal else "frames")


def quantiser(claim, coarse, fine):
    """12 bits against more."""
    ratios = [c.kg / f.kg for c, f in zip(coarse, fine) if f.kg > 0]
    more = "; ".join(f"N = {c.clusters}, L = {c.components}: error {percent(c.kg / f.kg)}"
                     for c, f in zip(coarse, fine) if f.kg > 0)
    return counted(claim, sum(r <= NEGLIGIBLE for r in ratios), len(ratios), more)


def seeds(claim, rates):
    """rates: (bits, N, bpvf of seeds)."""
    more = ", ".join(f"{bits} bits, N = {n}: {bpvf:.3f} bpvf" for bits, n, bpvf in rates)
    return counted(claim, sum(0.01 <= bpvf <= 1 for _, _, bpvf in rates), len(rates), more)


def best_count(runs_of_count):
    """The N with the fewest bits, at the errors of all runs. runs_of_count: N, runs."""
    curves = {n: curve(runs) for n, runs in runs_of_count.items()}
    low = max(min(kg for kg, _ in c) for c in curves.values())
    high = min(max(kg for kg, _ in c) for c in curves.values())
    errors = sorted({kg for c in curves.values() for kg, _ in c if low <= kg <= high})
    wins = dict.fromkeys(curves, 0)
    for kg in errors:
        wins[min(curves, key=lambda n: arithmetic.size_at(curves[n], kg))] += 1
    found = ", ".join(f"N = {n} at {count}" for n, count in wins.items())
    return f"Of {len(errors)} errors that all numbers of clusters reach, fewest bits: {found}."


def published(rows):
    """rows: (published row, run at its N and L, run of Main, run of High)."""
    items = []
    for row, run, main, high in rows:
        items.append(
            f"N = {row.clusters}, L = {row.components}: {percent(run.bpvf / row.bpvf)} bits and "
            f"{percent(run.kg / row.kg)} error against the published RLPCA; "
            f"{percent(run.bpvf / row.cpca[0])} and {percent(run.kg / row.cpca[1])} against the "
            f"published CPCA. At our error, Main takes {percent(main.bpvf / run.bpvf)} and High "
            f"{percent(high.bpvf / run.bpvf)} bits.")
    return items
