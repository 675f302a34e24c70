"""Coverage of a set of streams, and the pages of conformance/matrix that report it."""

import re

import coverage_measure
import spec_program
from coverage_sites import Value

_LISTED = 6  # streams named in a cell
_MISSING = 200  # missing goals listed on a page


class Result:
    """Goals reached, waived and missing."""

    def __init__(self, goals, streams, waivers):
        self.goals = goals
        self.streams = streams
        self.waivers = waivers
        self.by_stream = {name: goals.reached(m) for name, m in streams.items()}
        self.reached = set().union(*self.by_stream.values())
        unreached = [g for g in goals.all() if g not in self.reached]
        self.missing, self.waived = waivers.split(unreached)
        self.total = coverage_measure.merge(streams.values())

    def summary(self):
        total = len(self.goals.all())
        return (f"{len(self.streams)} streams reach {len(self.reached)} of {total} goals; "
                f"{len(self.waived)} waived, {len(self.missing)} missing")


class Page:
    """A page: the goals for which holds(function, site) is true, and a text about them."""

    def __init__(self, file, title, holds, text, extra=None):
        self.file = file
        self.title = title
        self.holds = holds
        self.text = text
        self.extra = extra or (lambda result: [])

    def ids(self, result):
        return [f"{f.key}/{s.kind}/{s.text}/{o}" for f in result.goals.target.functions
                for s in f.sites if self.holds(f, s) for o in s.outcomes]

    def figures(self, result):
        """(reached, waived, all) of the goals of this page."""
        ids = set(self.ids(result))
        return len(ids & result.reached), len(ids & set(result.waived)), len(ids)

    def markdown(self, result):
        ids = self.ids(result)
        reached, waived, total = self.figures(result)
        lines = [f"# {self.title}", "", f"**{reached} of {total - waived}** goals reached"
                 + (f"; {waived} more waived" if waived else "") + ".", "", self.text, ""]
        lines += _missing([i for i in ids if i in set(result.missing)])
        lines += self.extra(result)
        lines += _functions(result, ids)
        lines += _waived(result, [i for i in ids if i in set(result.waived)])
        return "\n".join(lines)


def _missing(ids):
    if not ids:
        return ["Nothing is missing.", ""]
    rest = len(ids) - _MISSING
    more = [f"* and {rest} more, listed by `rlpccov --missing`"] if rest > 0 else []
    return [f"## Missing: {len(ids)}", "", *(f"* {_code(i)}" for i in ids[:_MISSING]), *more, ""]


def _functions(result, ids):
    """A row for each function: goals reached, waived, missing."""
    counts = {}
    for goal in ids:
        key = next(k for k in _prefixes(goal) if k in result.goals.functions)
        row = counts.setdefault(key, [0, 0, 0])
        row[0 if goal in result.reached else 2] += 1
    for goal in set(ids) & set(result.waived):
        row = counts[next(k for k in _prefixes(goal) if k in result.goals.functions)]
        row[1] += 1
        row[2] -= 1
    rows = [(_code(key), *row) for key, row in counts.items()]
    return _table("Functions", ("function", "reached", "waived", "missing"), rows)


def _prefixes(goal):
    """Beginnings of an id that end before a slash, longest first: keys hold slashes as well."""
    places = [m.start() for m in re.finditer("/", goal)]
    return (goal[:place] for place in reversed(places))


def _waived(result, ids):
    groups = {}
    for goal in ids:
        groups.setdefault(result.waivers.reason(goal), []).append(goal)
    rows = [(reason, len(goals), _code(goals[0]) + (" ..." if goals[1:] else ""))
            for reason, goals in groups.items()]
    return _table("Waived", ("reason", "goals", "the first"), rows)


def _table(title, heads, rows):
    if not rows:
        return []
    line = "|" + "---|" * len(heads)
    return [f"## {title}", "", "| " + " | ".join(heads) + " |", line,
            *("| " + " | ".join(str(c).replace("|", "\\|") for c in row) + " |" for row in rows),
            ""]


def _code(text):
    return f"`{text}`"


def _names(names):
    names = sorted(names)
    rest = len(names) - _LISTED
    return ", ".join(names[:_LISTED]) + (f" and {rest} more" if rest > 0 else "")


def _elements(result):
    total = result.total
    rows = []
    for name, (least, greatest) in sorted(total["elements"].items()):
        values = total["values"].get(name)
        rows.append((_code(name), total["counts"][name], least, greatest,
                     ", ".join(map(str, values)) if values else "more than 16"))
    return _table("Values", ("syntax element", "read", "least", "greatest", "values"), rows)


def _loops(result):
    rows = [(_code(name), ranges) for name, ranges in result.total["loops"].items()]
    return _table("Iterations of while loops", ("loop", "iterations seen"), rows)


def _is_arithmetic(function, site):
    return site.kind != "context" and (" > " in function.path or site.kind == "shift")


def _is_coder(function, site):
    return (re.match(r"9\.[34](\.|$)", function.clause) is not None
            and site.kind not in ("element", "context"))


def _is_loop(function, site):
    return site.kind in ("loop", "for")


PAGES = [
    Page("elements.md", "Syntax elements and their extremes", lambda f, s: s.kind == "element",
         "Goals follow from descriptors and from the constants of requirements; the edges of "
         "other limits are among the branches.", _elements),
    Page("contexts.md", "Models", lambda f, s: s.kind == "context",
         "Each model has to decode a 0 and a 1."),
    Page("range_coder.md", "Range decoder and models", _is_coder,
         "Events of clauses 9.3 and 9.4: both edges of every comparison, bytes taken with a bin."),
    Page("arithmetic.md", "Rounding, clipping and normalising", lambda f, s:
         _is_arithmetic(f, s) and not _is_coder(f, s),
         "Functions of clause 5 at each of their calls, and shifts and divisions of numbers that "
         "can be negative. A tie of Round2 and DivRound is `exact`: nothing is left after half a "
         "unit was added."),
    Page("loops.md", "Loops and binarisation", lambda f, s:
         _is_loop(f, s) and not (_is_coder(f, s) or _is_arithmetic(f, s)),
         "Numbers of iterations; for a loop that counts up to a constant, every number.", _loops),
    Page("branches.md", "Branches", lambda f, s:
         not (s.kind in ("element", "context") or _is_loop(f, s) or _is_coder(f, s)
              or _is_arithmetic(f, s)),
         "Every condition both ways, and the nearest values on both sides of every limit "
         "(true-edge, false-edge)."),
]


def pages(result, sidecars):
    """(file name, text) of all pages."""
    rules_text, rules_headline = rules_page(result, sidecars)
    widths_text, widths_headline = widths_page(result)
    rows = [(f"[{p.title}]({p.file})", *_headline(p.figures(result))) for p in PAGES]
    index = ["# What the streams exercise", "",
             "Written by `rlpccov --report`; measured by running the pseudo-code of `spec/`.", "",
             f"{result.summary()}. {rules_headline} {widths_headline}", "",
             *_table("Pages", ("page", "reached", "of", "waived", "missing"), rows),
             "* [Rules and streams](rules.md)", "* [Widths](widths.md)",
             "* `waivers.json`: goals that cannot be reached, with reasons; `hard_goals.md`: goals "
             "that are hard to reach", ""]
    yield "README.md", "\n".join(index)
    for page in PAGES:
        yield page.file, page.markdown(result)
    yield "rules.md", rules_text
    yield "widths.md", widths_text


def _headline(figures):
    reached, waived, total = figures
    return reached, total - waived, waived, total - waived - reached


def rules_page(result, sidecars):
    """Rules by streams: (text, headline)."""
    broken = {}
    for name, measured in result.streams.items():
        sidecar = sidecars.get(name, {})
        for rule in {sidecar.get("rule"), measured["verdict"].get("rule")} - {None}:
            broken.setdefault(rule, set()).add(name)
    kept = {}
    for name, sidecar in sidecars.items():
        if sidecar.get("expect") == "accept":
            for rule in sidecar.get("rules", ()):
                kept.setdefault(rule, set()).add(name)
    rules = result.goals.target.rules()
    rows = [(rule, clause, effect, _names(kept.get(rule, ())), _names(broken.get(rule, ())))
            for rule, clause, effect in rules]
    both = [r for r, *_ in rules if kept.get(r) and broken.get(r)]
    headline = f"{len(both)} of {len(rules)} rules have an accept and a reject stream."
    without = [f"* {rule}: no {kind} stream" for rule, *_ in rules
               for kind, found in (("accept", kept), ("reject", broken)) if not found.get(rule)]
    lines = ["# Rules and streams", "", f"**{len(both)} of {len(rules)}** rules have both.", "",
             "Accept: streams that decode and whose sidecar names the rule. Reject: streams that "
             "break the rule, according to sidecar or measurement.", ""]
    lines += [f"## Missing: {len(without)}", "", *without, ""] if without else []
    lines += _table("Rules", ("rule", "clause", "effect", "accept", "reject"), rows)
    return "\n".join(lines), headline


def widths_page(result):
    """The widest result in each clause and the width that the clause states: (text, headline)."""
    widest = {}
    computed = total = 0
    for key, function in result.goals.functions.items():
        values = [s for s in function.sites if isinstance(s, Value)]
        widths = bytes.fromhex(result.total["widths"].get(key, "00" * len(values)))
        clause = result.goals.target.program.functions[function.origin][1]
        total += len(values)
        computed += sum(w > 0 for w in widths)
        for site, width in zip(values, widths):
            widest[clause] = max(widest.get(clause, (0, "", "")), (width, site.text, key))
    stated = dict(stated_widths(result.goals.target.folder))
    rows = [(clause, bits or "", _code(text) if bits else "never computed",
             _code(key) if bits else "", stated.get(clause, ""))
            for clause, (bits, text, key) in sorted(widest.items(), key=lambda i: _order(i[0]))]
    max_bits = max((bits for bits, *_ in widest.values()), default=0)
    headline = (f"{computed} of {total} arithmetic expressions are computed; the widest result "
                f"has {max_bits} bits.")
    lines = ["# Widths", "", f"**{max_bits} of 64** bits, sign included; **{computed} of {total}** "
             "arithmetic expressions computed.", ""]
    lines += _table("Widest result of each clause",
                    ("clause", "bits", "expression", "in", "stated"), rows)
    return "\n".join(lines), headline


def _order(clause):
    return [(0, int(part)) if part.isdigit() else (1, part) for part in clause.split(".")]


def stated_widths(folder):
    """(clause, text) of the paragraphs that state widths."""
    found = {}
    for path in sorted(folder.glob("*.md")):
        clause = ""
        for paragraph in path.read_text(encoding="utf-8").split("\n\n"):
            heading = spec_program._HEADING.match(paragraph)
            clause = heading.group(1) if heading else clause
            if "*Width*" in paragraph:
                text = " ".join(paragraph[paragraph.index("*Width*"):].split())
                text = text.removeprefix("*Width*:").strip()
                found[clause] = (found[clause] + " " if clause in found else "") + text
    return found.items()
