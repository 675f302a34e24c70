"""Whether a claim of a paper holds for measured runs, in words."""

import arithmetic

SAME = 1e-3  # relative difference of errors
NEGLIGIBLE = 1.01  # a ratio up to this one
MISSED = 1.05  # the encoder ends up to 4 % below its target: ends of two curves differ so much


def verdict(good, cases):
    if cases == 0:
        return "Not tested"
    if good == cases:
        return "Holds"
    return "Holds mostly" if 2 * good > cases else "Does not hold"


def counted(claim, good, cases, more=""):
    """A claim about `cases` comparisons, `good` of which agree."""
    found = f"{good} of {cases}" if cases else "no comparison is possible"
    return f"{verdict(good, cases)}: {claim} ({found}{'; ' + more if more else ''})."


def percent(ratio, digits=0):
    return f"{100 * (ratio - 1):+.{digits}f} %"


def curve(runs):
    return [(r.kg, r.bpvf) for r in runs]


def equal_rate(claim, pairs):
    """Rates of two methods over the errors that both reach. pairs: name, better, worse."""
    rates = [(name, arithmetic.bd_rate(curve(better), curve(worse)))
             for name, better, worse in pairs]
    rates = [(name, rate) for name, rate in rates if rate is not None]
    more = ", ".join(f"{name}: {rate:+.0f} % bits at equal error" for name, rate in rates)
    return counted(claim, sum(rate < 0 for _, rate in rates), len(rates), more)


def rate_at(runs, kg):
    """Bits at an error. None: the runs do not reach it."""
    lowest, highest = min(r.kg for r in runs), max(r.kg for r in runs)
    if not lowest / MISSED <= kg <= highest * MISSED:
        return None
    return arithmetic.size_at(curve(runs), min(max(kg, lowest), highest))


def ratios(runs, reference):
    """(KG, bits against the reference) at the errors of the reference that the runs reach."""
    found = [(r.kg, rate_at(runs, r.kg), r.bpvf) for r in reference]
    return [(kg, rate / bpvf) for kg, rate, bpvf in found if rate is not None]


def every_error(claim, runs, reference, limit=1.0):
    """The runs take less than `limit` times the bits of the reference, at each error."""
    found = ratios(runs, reference)
    if not found:
        return counted(claim, 0, 0)
    lowest, highest = (percent(f(r for _, r in found), 1) for f in (min, max))
    return counted(claim, sum(r < limit for _, r in found), len(found),
                   f"{lowest} to {highest} bits at equal error")


def at_published_errors(claim, runs, points):
    """points: (kg, bpvf) of the paper; those beyond the runs do not count."""
    found = [(kg, rate_at(runs, kg), bpvf) for kg, bpvf in points]
    found = [(kg, rate / bpvf) for kg, rate, bpvf in found if rate is not None]
    more = ", ".join(f"KG {kg:g} %: {percent(ratio)} bits" for kg, ratio in found)
    return counted(claim, sum(ratio < 1 for _, ratio in found), len(found), more)
