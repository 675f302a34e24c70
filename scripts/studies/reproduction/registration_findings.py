"""Tests the claims of the registration paper on the runs of a reproduction
(registration.Reproduction)."""

import itertools

import arithmetic
import claims
import registration_published as published

MIN_GAIN = published.GAIN - 0.01  # about 4 %
STATIC = ("k-way", "Lloyd", "spectral")
SIMILAR = 2  # per cent: of the dance, the paper has 1.2


def clustering_alone(gains):
    """A sentence on each of the paper's other clusterings. gains: name and ratio over k-way."""
    return [claims.counted(
        f"{name} clustering alone brings about {100 * published.GAIN:.0f} %, at least "
        f"{100 * MIN_GAIN:.0f} %, over k-way", int(gain is not None and gain >= 1 + MIN_GAIN),
        int(gain is not None), "" if gain is None else claims.percent(gain, 1))
        for name, gain in gains]


def best_sizes(swept):
    """swept: {clustering: (vertices per cluster, clusters, ratio)}"""
    items = []
    for name, rows in swept.items():
        size = published.VERTICES_PER_CLUSTER[name]
        ratios = {row[0]: row[2] for row in rows if row[2] is not None}
        best = max(ratios, key=ratios.get, default=None)
        more = "" if size not in ratios else (
            f"best with {best}; with {size}: {claims.percent(ratios[size] / ratios[best], 1)}")
        items.append(claims.counted(
            f"clusters of {size} vertices are optimal for {name}, within 1 % of the best size",
            int(size in ratios and ratios[size] * claims.NEGLIGIBLE >= ratios[best]),
            int(size in ratios), more))
    return items


def at_motion(found):
    """found: {clustering: ratio with little motion, with much}"""
    calm = {name: found[name][0] for name in STATIC if found[name][0]}
    fast = {name: found[name][1] for name in STATIC if found[name][1]}
    more = ", ".join(f"over {name}: {claims.percent(fast['Lloyd'] / fast[name], 1)}"
                     for name in fast if name != "Lloyd" and "Lloyd" in fast)
    items = [claims.counted(
        "where motion is large, in the half of frames with most of it, Lloyd's clusters compress "
        "best", sum(fast["Lloyd"] > fast[name] for name in fast if name != "Lloyd"),
        max(len(fast) - 1, 0), more)]
    known = {"Lloyd", "k-way"} <= set(calm)
    ratio = calm["Lloyd"] / calm["k-way"] if known else 1.0
    items.append(claims.counted(
        f"where motion is small, Lloyd's clusters and k-way are similar, within {SIMILAR} %",
        int(known and abs(ratio - 1) <= SIMILAR / 100), int(known), claims.percent(ratio, 1)))
    return items


def published_gains(model):
    """Gains of table 5, in the same words; None: the paper has none."""
    table = published.TABLE_5.get(model)
    if table is None:
        return None
    gains = ", ".join(f"{name}: {claims.percent(row.ratio / table['k-way'].ratio, 1)}"
                      for name, row in table.items() if name != "k-way")
    shares = {name: (row.type1 + row.type2) / model.num_vertices for name, row in table.items()}
    moved = ", ".join(f"{name}: {100 * share:.0f} %" for name, share in shares.items())
    found = (f"In table 5 itself, for the {model.name}: gains over k-way, {gains}; vertices of "
             f"types 1 and 2, {moved}")
    below = sum(share <= published.MOVED for share in shares.values())
    return found + (f"; {below} of {len(shares)} not over {100 * published.MOVED:.0f} %." if below
                    else ".")


def moved_vertices(moved):
    """moved: name and share of types 1 and 2."""
    more = ", ".join(f"{name}: {100 * share:.0f} %" for name, share in moved)
    share_text = f"{100 * published.MOVED:.0f} %"
    return claims.counted(f"vertices of types 1 and 2 are over {share_text} of all",
                          sum(share > published.MOVED for _, share in moved), len(moved), more)


def go_together(claim, points):
    """points: name, cause, effect. Of each two, the greater cause has the greater effect."""
    pairs = [(a, b) for a, b in itertools.combinations(points, 2)
             if a[1] != b[1] and None not in (a[2], b[2])]
    more = ", ".join(f"{name}: {cause:.0f} and {effect:.1f}" for name, cause, effect in points
                     if effect is not None)
    return claims.counted(claim, sum((a[1] > b[1]) == (a[2] > b[2]) for a, b in pairs), len(pairs),
                          more)


def slowest(seconds):
    """The slowest of the clusterings of the paper."""
    found = {name: seconds[name] for name in STATIC}
    more = ", ".join(f"{name}: {s:.3f} s" for name, s in found.items())
    return claims.counted("spectral clustering takes longest",
                          int(max(found, key=found.get) == "spectral"), 1, more)


def below_published(name, runs, table):
    """Against all rows of table 6."""
    found = [(coder, kg, claims.rate_at(runs, kg), bpvf) for coder, points in table.items()
             for bpvf, kg in points]
    found = [(coder, kg, rate / bpvf) for coder, kg, rate, bpvf in found if rate is not None]
    more = ", ".join(f"{coder}, {kg:g} %: {claims.percent(ratio)} bits"
                     for coder, kg, ratio in found)
    return claims.counted(f"{name} takes fewer bits than published, in the rows of table 6, at "
                          "equal error", sum(ratio < 1 for *_, ratio in found), len(found), more)


def _rates(words, curves, pairs):
    """pairs: label, method and reference."""
    rates = [(label, arithmetic.bd_rate(claims.curve(curves[name]),
                                        claims.curve(curves[reference])))
             for label, name, reference in pairs]
    more = ", ".join(f"{label}: {rate:+.0f} %" for label, rate in rates if rate is not None)
    return [f"{words}, bits at equal error: {more}."] if more else []


def _ours(curves):
    """Gain of patches and learned weights, and of Main and High against the best of the
    paper's clusterings."""
    patches = [(name, name, "no patches") for name in (*STATIC, "motion")]
    items = _rates("Patches against none", curves,
                   [*patches, ("motion with learned weights", "learned, motion", "learned")])
    items += _rates("Spectral clusters, as many as by k-way", curves,
                    [("against k-way", "spectral (as many)", "k-way")])
    for name, words in (("learned", "Learned weights without patches"), ("Main", "Main"),
                        ("High", "High")):
        items += _rates(f"{words} against the method of the paper", curves,
                        [(clustering, name, clustering) for clustering in STATIC])
    return items


def claims_of_paper(made, seconds):
    """Sentences. seconds: of clustering, by name."""
    curves, details = made.curves, made.details
    ratios = {name: made.ratio(name) for name in made.CLUSTERINGS}
    items = clustering_alone([(name, made.gain(name)) for name in STATIC[1:]])
    items.append(moved_vertices([(name, details[name].moved) for name in STATIC
                                 if details[name].has_motions]))
    said = published_gains(made.model)
    if said:
        items.append(said)
    items += [
        go_together("more vertices of type 1 go with a higher compression ratio",
                    [(name, details[name].means[0], ratios[name]) for name in made.CLUSTERINGS]),
        go_together("more vertices of types 1 and 2 go with a higher compression ratio",
                    [(name, sum(details[name].means[:2]), ratios[name])
                     for name in made.CLUSTERINGS]),
        claims.every_error("geometry-based clusters (Lloyd) take fewer bits than topology-based "
                           "ones (k-way)", curves["Lloyd"], curves["k-way"]),
        claims.every_error("semantic clusters (spectral) take fewer bits than topology-based ones "
                           "(k-way)", curves["spectral"], curves["k-way"]),
        claims.equal_rate("clusters by motion take fewer bits than static ones, as the paper "
                          "expects", [(f"motion against {name}", curves["motion"], curves[name])
                                      for name in STATIC]),
        slowest(seconds)]
    if made.model in published.TABLE_6:
        items += [below_published(name, curves[name], published.TABLE_6[made.model])
                  for name in (*STATIC, "Main", "High")]
    return [*items, *_ours(curves)]
