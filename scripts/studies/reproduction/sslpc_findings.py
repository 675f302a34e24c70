"""Tests the claims of the SSLPC paper on the runs of a reproduction (sslpc.Reproduction)."""

import arithmetic
import claims
import sslpc_published as published
from bench import FLAT

NEAR = 0.06  # share of the published growth, which for its chicken is 32.4 to 41.0 %
REAL_TIME = 30  # frames a second


def layer_growth(layers, count):
    """The growth of `count` finest layers is about that of the paper."""
    found = [g for g in published.growth(layers)[-count:] if g is not None]
    more = ", ".join(f"{100 * g:.1f} %" for g in found)
    return claims.counted(f"each layer adds about {100 * published.GROWTH:.0f} % of vertices, here "
                          f"within {100 * NEAR:.0f} points, the finest {count}",
                          sum(abs(g - published.GROWTH) <= NEAR for g in found), len(found), more)


def against_published(layers, theirs):
    """Our layers and those that the paper has for the same mesh."""
    pairs = zip(layers[1 - len(theirs):], theirs[1:])
    return ("Vertices of the finest layers, ours and published: "
            + ", ".join(f"{ours} and {known}" for ours, known in pairs)
            + f"; ours go on to a base of {layers[0]} in {len(layers)} layers, that of the paper "
              f"has {theirs[0]}.")


def large_errors(name, min_gain, runs, flat, large):
    """The gain over a flat coder, in per cent, at errors above `large`."""
    found = [(kg, 1 / ratio) for kg, ratio in claims.ratios(flat, runs) if kg >= large]
    more = ", ".join(f"KG {kg:.2g} %: {claims.percent(ratio)}" for kg, ratio in found)
    return claims.counted(f"at KG errors above {large:g} %, {name} takes over {min_gain} % "
                          f"fewer bits than a flat predictive coder, here {FLAT}",
                          sum(ratio < 1 - min_gain / 100 for _, ratio in found), len(found), more)


def grows(claim, better, worse):
    """The gain at the largest error is above that at the smallest."""
    found = sorted(claims.ratios(better, worse))
    if len(found) < 2:
        return claims.counted(claim, 0, 0)
    (low, fine), (high, coarse) = found[0], found[-1]
    return claims.counted(claim, int(coarse < fine), 1, f"KG {low:.2g} %: {claims.percent(fine)}, "
                          f"KG {high:.2g} %: {claims.percent(coarse)} bits")


def real_time(sequence, runs):
    """Frames a second of encoder, which searches for the error, and decoder."""
    speeds = [(sequence.num_frames / r.encode_seconds, sequence.num_frames / r.decode_seconds)
              for r in runs]
    good = sum(min(pair) >= REAL_TIME for pair in speeds)
    encode, decode = (min(column) for column in zip(*speeds))
    more = f"encoder at least {encode:.0f}, search for the error included, decoder {decode:.0f}"
    return claims.counted(f"SSLPC runs in real time, {REAL_TIME} frames a second", good,
                          len(speeds), more)


def headers(made):
    """Parts of the overhead of spatial layers."""
    one, many = (made.bench.info(made.settings("SSLPC", made.lossless, more))
                 for more in ((), ["--layer-groups", made.num_layers]))
    name = "unit headers and CRCs"
    extra = 8 * (many["bytes"] - one["bytes"])
    header_bits = many["bits"][name] - one["bits"][name]
    share = extra / 8 / one["bytes"]
    return (f"{made.num_layers} spatial layers take {100 * share:.1f} % more bits at KG error "
            f"{made.lossless} %, {100 * header_bits / extra:.0f} % of them in {name}.")


def _ours(curves):
    """Main, High and learned weights against STSLPC."""
    rates = [(name, arithmetic.bd_rate(claims.curve(curves[name]), claims.curve(curves["STSLPC"])))
             for name in ("STSLPC, learned", "Main", "High")]
    return [f"{name} takes {rate:+.0f} % bits against STSLPC, at equal error."
            for name, rate in rates if rate is not None]


def claims_of_paper(made, layers):
    """Sentences. layers: vertices of each."""
    curves, scalable = made.curves, made.scalable
    items = [layer_growth(layers, made.num_layers - 1)]
    if made.is_known:
        items.append(against_published(layers, made.known.layers))
    items += [
        claims.every_error("STSLPC takes fewer bits than SSLPC at every error", curves["STSLPC"],
                           curves["SSLPC"]),
        grows("the gain of STSLPC over SSLPC grows with the error", curves["STSLPC"],
              curves["SSLPC"]),
        large_errors("SSLPC", 10, curves["SSLPC"], curves[FLAT], made.known.large),
        large_errors("STSLPC", 16, curves["STSLPC"], curves[FLAT], made.known.large),
    ]
    items += [claims.every_error(f"scalability has no overhead, 1 % at most: {name}",
                                 scalable[name], scalable[name.split(",")[0]], claims.NEGLIGIBLE)
              for name in made.variants]
    items.append(claims.every_error(
        "scalability in time has no overhead: STSLPC, 2 temporal layers, against SSLPC",
        scalable["STSLPC, 2 temporal layers"], scalable["SSLPC"]))
    items.append(headers(made))
    points = [(kg, bpvf) for bpvf, kg in published.cpca(made.model)]
    if points:
        items += [claims.at_published_errors(f"{name} takes fewer bits than CPCA as published",
                                             curves[name], points) for name in ("SSLPC", "STSLPC")]
    return [*items, real_time(made.sequence, curves["SSLPC"]), *_ours(curves)]
