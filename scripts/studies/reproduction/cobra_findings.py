"""Tests the claims of the COBRA paper on what a reproduction measured (cobra.Reproduction)."""

import statistics

import arithmetic
import claims
import cobra_published as published

ORDERS = (1, 2, 3, 4)
SIMILAR = 2  # times the median, or half of it: "roughly the same magnitude"


def least_squares(pairs):
    """(slope, offset)"""
    mean_x, mean_y = (statistics.fmean(column) for column in zip(*pairs))
    square = sum((x - mean_x) ** 2 for x, _ in pairs)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in pairs) / square if square else 0.0
    return slope, mean_y - slope * mean_x


def rises(rule):
    """Relative rise of the KG error if the step of each vector is tripled."""
    return [max(kg / rule["kg"] - 1, 0.0) for kg in rule["tripled_kg"]]


def uniform_steps(rule):
    """Figure 6."""
    found = rises(rule)
    later = found[published.NO_EFFECT - 1:]
    return [
        claims.counted("with uniform steps, tripling one has less effect the higher its vector",
                       sum(b <= a + claims.SAME for a, b in zip(found, found[1:])),
                       len(found) - 1, f"the first: error {claims.percent(1 + found[0])}"),
        claims.counted(f"with uniform steps, tripling that of vector {published.NO_EFFECT} or "
                       "above has virtually no effect, below 1 %",
                       sum(rise < claims.NEGLIGIBLE - 1 for rise in later), len(later))]


def cobra_steps(rule):
    """Figure 7."""
    found = rises(rule)
    middle = statistics.median(found)
    return claims.counted("with COBRA's steps, tripling any has an effect of roughly the same "
                          "magnitude, half to twice the median",
                          sum(middle / SIMILAR <= rise <= middle * SIMILAR for rise in found),
                          len(found), f"error {claims.percent(1 + min(found))} to "
                                      f"{claims.percent(1 + max(found))}")


def eigenvalue_steps(rule):
    """Figure 8."""
    found = rises(rule)
    largest = found.index(max(found))
    half = len(found) // 2
    return [
        claims.counted("with the steps of Heu et al., tripling the first has almost no effect, "
                       "below 1 %", int(found[0] < claims.NEGLIGIBLE - 1), 1,
                       f"error {claims.percent(1 + found[0], 1)}"),
        claims.counted("with the steps of Heu et al., less important vectors cause most of the "
                       "error", int(largest >= half), 1, f"vector {largest + 1} of {len(found)}: "
                       f"error {claims.percent(1 + found[largest])}")]


def fewer_bits(rules):
    """COBRA's steps against the others, at the same errors of the basis."""
    mine = {round(r["kg"], 4): r["entropy"] for r in rules["cobra"]["rates"]}
    items = []
    for name, words in (("uniform", "uniform ones"), ("eigenvalue", "those of Heu et al.")):
        ratios = [mine[round(r["kg"], 4)] / r["entropy"] for r in rules[name]["rates"]
                  if round(r["kg"], 4) in mine and r["entropy"] > 0]
        more = (f"{claims.percent(min(ratios))} to {claims.percent(max(ratios))} bits of the basis"
                if ratios else "")
        items.append(claims.counted(f"COBRA's steps take fewer bits than {words}, at equal error",
                                    sum(r < 1 for r in ratios), len(ratios), more))
    return items


def _best(of, kinds):
    return min((f"{kind}{order}" for kind in kinds for order in ORDERS), key=lambda p: of[p][0])


def predictors(entropies):
    """Table 1. entropies: {NB: {predictor: (entropy, missed squares)}}"""
    tables = entropies.values()
    best = {n: _best(of, ("LPC", "Cob")) for n, of in entropies.items()}
    names = ", ".join(f"NB = {n}: {name}" for n, name in best.items())
    falls = [of[f"LPC{o}"][1] >= of[f"LPC{o + 1}"][1] * (1 - claims.SAME) for of in tables
             for o in ORDERS[:-1]]
    above = [of[f"Cob{o}"][1] >= of[f"LPC{o}"][1] for of in tables for o in ORDERS]
    same = [of[f"Cob{o}"][0] < of[f"LPC{o}"][0] for of in tables for o in ORDERS]
    ends = [1 - of[best[n]][0] / of["direct"][0] for n, of in entropies.items()]
    return [
        claims.counted("the best of COBRA's predictors beats LPC of any order",
                       sum(name.startswith("Cob") for name in best.values()), len(best), names),
        claims.counted("each of COBRA's predictors beats LPC of its order", sum(same), len(same)),
        claims.counted("the best of COBRA's predictors is that of linear or accelerated motion, "
                       "order 2 or 3",
                       sum(_best(of, ("Cob",))[3] in "23" for of in tables), len(best)),
        claims.counted("squared residuals of LPC fall with its order", sum(falls), len(falls)),
        claims.counted("squared residuals of COBRA's predictors are above those of LPC of their "
                       "order", sum(above), len(above)),
        f"Prediction saves {100 * min(ends):.0f} to {100 * max(ends):.0f} % of the bits of the "
        "basis.",
    ]


def parts(streams, near):
    """Figure 12. near: the stream at its error."""
    saved = [1 - s.basis / s.other_basis["direct"] for s in streams]
    total = near.rate("direct")
    return [
        claims.counted(f"COBRA takes {100 * published.BASIS_SAVED:.0f} % fewer bits for the basis "
                       f"than {published.DIRECT_BITS} bits per value",
                       sum(x >= published.BASIS_SAVED for x in saved), len(saved),
                       f"{100 * min(saved):.1f} to {100 * max(saved):.1f} %"),
        claims.counted("connectivity takes a negligible part, below 1 %",
                       int(near.connectivity < (claims.NEGLIGIBLE - 1) * near.run.bpvf), 1,
                       f"{100 * near.connectivity / near.run.bpvf:.1f} %"),
        f"Coded directly, the basis takes {100 * near.other_basis['direct'] / total:.0f} % at KG "
        f"error {near.run.kg:.2g} %, NB = {near.vectors}; in the paper, up to "
        f"{100 * published.MAX_BASIS:.0f} %. With COBRA, it takes "
        f"{100 * near.basis / near.run.bpvf:.0f} %."]


def total_saved(curves, share):
    """The gain over a basis of 64 bits per value, which takes `share` of everything. The claim is
    of animations in which it takes half at most; of more, more can be saved."""
    claim = (f"COBRA takes about {100 * published.TOTAL_SAVED:.0f} % fewer bits of everything than "
             f"a basis of {published.DIRECT_BITS} bits per value")
    if share <= published.MAX_BASIS:
        return claims.every_error(f"{claim}, or still fewer", curves["cobra"], curves["direct"],
                                  1 - published.TOTAL_SAVED)
    found = [ratio for _, ratio in claims.ratios(curves["cobra"], curves["direct"])]
    more = (f"; here {claims.percent(min(found))} to {claims.percent(max(found))} bits"
            if found else "")
    return (f"Not comparable: {claim} (that basis takes {100 * share:.0f} % of everything here, in "
            f"the paper {100 * published.MAX_BASIS:.0f} % at most{more}).")


def whole(curves, share):
    """COBRA's gain over everything, and ours over it. share: of a basis of 64 bits per value."""
    items = [total_saved(curves, share)]
    items.append(claims.every_error("COBRA takes fewer bits of everything than a uniformly "
                                    "quantised basis", curves["cobra"], curves["uniform"]))
    gains = [1 - ratio for _, ratio in claims.ratios(curves["cobra"], curves["direct"])]
    if gains:
        items.append(f"COBRA saves up to {100 * max(gains):.0f} % of everything; in the paper, up "
                     f"to more than {100 * published.MAX_SAVED:.0f} %.")
    for name in ("Main", "High"):
        rate = arithmetic.bd_rate(claims.curve(curves[name]), claims.curve(curves["cobra"]))
        if rate is not None:
            items.append(f"{name} takes {rate:+.0f} % bits against Coddyac + COBRA, at equal "
                         "error.")
    return items


def claims_of_paper(made, near):
    """Sentences."""
    rules = {rule["name"]: rule for rule in made.study["rules"]}
    return [*uniform_steps(rules["uniform"]), cobra_steps(rules["cobra"]),
            *eigenvalue_steps(rules["eigenvalue"]), *fewer_bits(rules),
            *predictors(made.entropies()), *parts(made.streams, near),
            *whole(made.curves, near.other_basis["direct"] / near.rate("direct"))]
