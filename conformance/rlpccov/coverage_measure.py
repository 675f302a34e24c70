"""Measures what one stream exercises: runs it, and packs the result for its sidecar.

A measurement is a dictionary for JSON:
    specification   digest of all goal ids; measurements of another specification do not compare
    verdict         of decoding in order: code, rule, frames
    goals           for each function that was entered, a number in hexadecimal: bit n stands for
                    goal n of the function, in the order of its sites and their outcomes
    elements        for each syntax element its least and its greatest value
    values          for each syntax element of at most 16 different values all of them
    counts          how often each syntax element was read
    loops           for each while loop the numbers of iterations, 64+ for 64 and more
    widths          for each function two hexadecimal digits for each expression: bits of the
                    widest result, sign included; 00: never computed
"""

import hashlib

import specdec
from coverage_sites import Element, Loop, Value


class Goals:
    """All goals of a specification, by function."""

    def __init__(self, target):
        self.target = target
        self.functions = {f.key: f for f in target.functions}
        if len(self.functions) != len(target.functions):
            raise AssertionError("two functions of the same key")
        self.ids = {f.key: [f"{f.key}/{s.kind}/{s.text}/{o}" for s in f.sites for o in s.outcomes]
                    for f in target.functions}
        self.places = {f"{f.key}/{s.kind}/{s.text}/{o}": s.place
                       for f in target.functions for s in f.sites for o in s.outcomes}
        if len(self.places) != sum(map(len, self.ids.values())):
            raise AssertionError("two goals of the same id")
        listing = "\n".join(i for ids in self.ids.values() for i in ids)
        self.digest = hashlib.sha256(listing.encode()).hexdigest()[:12]

    def all(self):
        return [i for ids in self.ids.values() for i in ids]

    def reached(self, measurement):
        """The ids of the goals that a measurement has reached."""
        found = set()
        for key, digits in measurement["goals"].items():
            mask = int(digits, 16)
            found |= {name for n, name in enumerate(self.ids[key]) if mask >> n & 1}
        return found


def measure(goals, data):
    """The measurement of a stream; raises what the specification's program itself raises."""
    target = goals.target
    decoder = specdec.Decoder(target, data, lambda output: None,
                              write_attributes=lambda output: None)
    verdict = {"code": specdec.DONE, "rule": None}
    try:
        decoder.call(target.entries[0])
        _run_others(decoder, target, specdec.has_attribute_unit(data))
    except specdec.Verdict as error:
        verdict = {"code": error.code, "rule": error.rule}
        decoder.place()
    verdict["frames"] = decoder.variables.get("NumOutputFrames", 0)
    return {"specification": goals.digest, "verdict": verdict, **_seen(goals, decoder.variables)}


def _run_others(decoder, target, has_attributes):
    """Calls made after decoding in order; lists count only if nothing has broken a rule."""
    good = [_keeps_rules(decoder, name) for name in target.entries[1:]
            if has_attributes or name != specdec.WITH_ATTRIBUTES]
    if all(good):
        for name, items in target.for_each.items():
            for item in decoder.variables.get(items, []):
                _keeps_rules(decoder, name, item)


def _keeps_rules(decoder, name, *arguments):
    try:
        decoder.variables[name](*arguments)
    except specdec.Verdict:
        return False
    return True


def _seen(goals, namespace):
    namespace["CoverCollect"]()
    result = {"goals": {}, "elements": {}, "values": {}, "counts": {}, "loops": {}, "widths": {}}
    for key, function in goals.functions.items():
        mask = shift = 0
        for site in function.sites:
            seen = site.seen(namespace)
            for outcome in site.outcomes:
                mask |= (outcome in seen) << shift
                shift += 1
            if isinstance(site, Element):
                _add_element(result, site.element, site.statistics(namespace))
            elif isinstance(site, Loop) and site.kind == "loop" and site.ranges(namespace):
                result["loops"][f"{key}/{site.text}"] = site.ranges(namespace)
        if mask:
            result["goals"][key] = f"{mask:x}"
        widths = [_width(s.extremes(namespace)) for s in function.sites if isinstance(s, Value)]
        if any(widths):
            result["widths"][key] = "".join(f"{w:02x}" for w in widths)
    result["values"] = {n: sorted(v) for n, v in result["values"].items() if len(v) <= 16}
    return result


def _add_element(result, name, statistics):
    if not statistics["count"]:
        return
    least, greatest = result["elements"].get(name, (statistics["least"], statistics["greatest"]))
    result["elements"][name] = [min(least, statistics["least"]),
                                max(greatest, statistics["greatest"])]
    result["values"].setdefault(name, set()).update(statistics["values"])
    result["counts"][name] = result["counts"].get(name, 0) + statistics["count"]


def _width(extremes):
    """Bits of a signed number that holds both, 0 for None."""
    if extremes is None:
        return 0
    return min(255, max((x if x >= 0 else ~x).bit_length() for x in extremes) + 1)


def merge(measurements):
    """One measurement for all."""
    total = {"goals": {}, "elements": {}, "values": {}, "counts": {}, "loops": {}, "widths": {}}
    for one in measurements:
        for key, digits in one["goals"].items():
            total["goals"][key] = f"{int(total['goals'].get(key, '0'), 16) | int(digits, 16):x}"
        for name, (least, greatest) in one["elements"].items():
            known = total["elements"].get(name, (least, greatest))
            total["elements"][name] = [min(least, known[0]), max(greatest, known[1])]
            if name not in one["values"]:
                total["values"][name] = None
            elif total["values"].get(name, ()) is not None:
                total["values"][name] = total["values"].get(name, set()) | set(
                    one["values"][name])
            total["counts"][name] = total["counts"].get(name, 0) + one["counts"][name]
        for name, ranges in one["loops"].items():
            total["loops"].setdefault(name, set()).update(ranges.split(","))
        for key, digits in one["widths"].items():
            known = bytes.fromhex(total["widths"].get(key, "00" * (len(digits) // 2)))
            total["widths"][key] = bytes(map(max, known, bytes.fromhex(digits))).hex()
    total["values"] = {n: sorted(v) for n, v in total["values"].items() if v and len(v) <= 16}
    total["loops"] = {n: _united(parts) for n, parts in total["loops"].items()}
    return total


def _united(parts):
    """Ranges such as 1-3 and 2-5 as one text."""
    numbers = set()
    for part in parts:
        first, _, last = part.rstrip("+").partition("-")
        numbers |= set(range(int(first), int(last or first) + 1))
    texts, run = [], []
    for n in sorted(numbers) + [None]:
        if run and n != run[-1] + 1:
            texts.append(str(run[0]) if len(run) == 1 else f"{run[0]}-{run[-1]}")
            run = []
        run.append(n)
    return ",".join(texts) + ("+" if 64 in numbers else "")


def minimum(goals, measurements):
    """A small set of streams that together reach what all reach, chosen greedily."""
    reached = {name: goals.reached(m) for name, m in measurements.items()}
    wanted = set().union(*reached.values())
    chosen = []
    while wanted:
        best = max(sorted(reached), key=lambda name: len(reached[name] & wanted))
        chosen.append((best, len(reached[best] & wanted)))
        wanted -= reached[best]
    return chosen
