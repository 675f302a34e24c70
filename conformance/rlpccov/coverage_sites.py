"""Places of the specification's pseudo-code at which coverage is counted, and how goals are named.

A *site* is a place of the program: a condition, a loop, a shift, a syntax element, a model, a
value. It has *outcomes*; an outcome that a suite of streams has to show at least once is a *goal*:

    CLAUSE/FUNCTION/KIND/TEXT/OUTCOME     9.3.3/ae/if/Code < bound/true

KIND        TEXT                          OUTCOME
if while    the condition                 true false; of < <= > >= also true-edge, false-edge: true
                                          or false, with sides as close as they can be
require     rule id, then the condition   the same; also for supported
condition   an operand of and / or, or    the same
            a comparison elsewhere
for         the iterable                  0 1 many: iterations at hand
loop        the condition of a while      0 1 many, or numbers: iterations made
shift       x >> n, x // n, x % n         negative; within clause 5 also negative-exact,
                                          negative-inexact, exact, inexact: sign and remainder of x
element     element = descriptor          values; negative zero positive; of codes whose number of
                                          bits varies: no-bits all-zeros all-ones
context     a model, such as M[3]         0 1: bins decoded with it. Where the number of models of a
                                          list depends on the stream: ranges of the last index
value       an expression                 least N, greatest N (coverage_goals.json)

TEXT ends with #2, #3 ... if it occurs again in the function. Each call of a function of clause 5
is counted separately: there, FUNCTION is  MakeLcf > Round2(y[c], 30).  Ids contain no line
numbers. Constant conditions and ranges are not goals, nor is code that only computes constants,
as no stream can run it.
"""

LOOP_CAP = 64
_NONE = 1 << 400  # larger than any value


class Site:
    """A place with outcomes. Names that it adds to the program end with its number."""

    def __init__(self, number, kind, text, place, outcomes):
        self.number = number
        self.kind = kind
        self.text = text
        self.place = place
        self.outcomes = list(outcomes)

    def name(self, letter):
        return f"Cover{letter}{self.number}"

    def given(self, namespace):
        """The variables that the program needs, before anything is seen."""
        raise NotImplementedError

    def seen(self, namespace):
        """Outcomes that the run of the program in namespace has shown."""
        raise NotImplementedError


class Condition(Site):
    """Flags T, F, and for ordered comparisons A (true, at the edge) and B (false, at the edge)."""

    def __init__(self, number, kind, text, place, ordered):
        super().__init__(number, kind, text, place,
                         ("true", "false") + (("true-edge", "false-edge") if ordered else ()))

    def given(self, namespace):
        return {self.name(letter): None for letter in "TFAB"[:len(self.outcomes)]}

    def seen(self, namespace):
        true, false, at, beyond = (namespace.get(self.name(c)) is not None for c in "TFAB")
        return {outcome for outcome, hit in (("true", true or at), ("false", false or beyond),
                                             ("true-edge", at), ("false-edge", beyond)) if hit}


class Loop(Site):
    """A histogram of iterations, H; of for loops the number of items, recorded by L( )."""

    def __init__(self, number, kind, text, place, counts=()):
        super().__init__(number, kind, text, place, ("0", "1", "many"))
        if counts:
            self.count(counts)

    def count(self, counts):
        self.outcomes = [str(n) for n in counts]

    def given(self, namespace):
        histogram = bytearray(LOOP_CAP + 1)

        def record(items):
            n = len(items)
            histogram[n if n < LOOP_CAP else LOOP_CAP] = 1
            return items

        return {self.name("H"): histogram, self.name("L"): record}

    def seen(self, namespace):
        histogram = namespace[self.name("H")]
        shown = {str(n) for n in range(LOOP_CAP) if histogram[n]}
        return shown | ({"many"} if any(histogram[2:]) else set())

    def ranges(self, namespace):
        """The numbers of iterations seen, such as 0-3,7,64+."""
        seen = [n for n, hit in enumerate(namespace[self.name("H")]) if hit]
        parts = []
        for n in seen:
            if parts and parts[-1][1] == n - 1:
                parts[-1][1] = n
            else:
                parts.append([n, n])
        texts = [str(a) if a == b else f"{a}-{b}" for a, b in parts]
        return ",".join(texts) + ("+" if seen and seen[-1] == LOOP_CAP else "")


class Shift(Site):
    """A rounding operator; S( ) records what it is applied to until all outcomes are known."""

    OPERATORS = {">>": lambda x, n: x >> n, "//": lambda x, n: x // n, "%": lambda x, n: x % n}

    def __init__(self, number, text, place, operator, detailed):
        super().__init__(number, "shift", text, place, ("negative-exact", "negative-inexact",
                                                        "exact", "inexact") if detailed
                         else ("negative",))
        self.operator = operator

    def given(self, namespace):
        plain = self.OPERATORS[self.operator]
        name, goals, shown = self.name("S"), set(self.outcomes), set()

        def record(x, n):
            rest = x & ((1 << n) - 1) if self.operator == ">>" else x % n
            if x < 0:
                shown.add("negative")
                shown.add("negative-inexact" if rest else "negative-exact")
            else:
                shown.add("inexact" if rest else "exact")
            if goals <= shown:
                namespace[name] = plain
            return plain(x, n)

        return {name: record, self.name("H"): shown}

    def seen(self, namespace):
        return namespace[self.name("H")] & set(self.outcomes)


class Element(Site):
    """A syntax element where it is read. E(value) records it, N(n) its number of bits before."""

    def __init__(self, number, element, text, place, outcomes, bits):
        super().__init__(number, "element", text, place, outcomes)
        self.element = element
        self.bits = bits  # the number of bits is an argument that varies

    def given(self, namespace):
        state = {"least": _NONE, "greatest": -_NONE, "count": 0, "values": set(), "bits": 0,
                 "shown": set()}
        known = set()

        def classify(value):
            known.add(value)
            state["least"] = min(state["least"], value)
            state["greatest"] = max(state["greatest"], value)
            if len(state["values"]) <= 16:
                state["values"].add(value)
            state["shown"].add(str(value))
            state["shown"].add("negative" if value < 0 else "positive" if value else "zero")

        def record(value):
            state["count"] += 1
            if value not in known:
                classify(value)
            if self.bits:
                n = state["bits"]
                state["shown"].add("no-bits" if n == 0 else "all-zeros" if value == 0
                                   else "all-ones" if value == (1 << n) - 1 else "positive")
            return value

        def note_bits(n):
            state["bits"] = n
            return n

        return {self.name("E"): record, self.name("N"): note_bits, self.name("H"): state}

    def seen(self, namespace):
        return namespace[self.name("H")]["shown"] & set(self.outcomes)

    def statistics(self, namespace):
        return namespace[self.name("H")]


class Context(Site):
    """A model, or several, of a list of models that the program assigns to a variable."""

    def __init__(self, number, text, place, members):
        super().__init__(number, "context", text, place, ("0", "1"))
        self.members = members

    def given(self, namespace):
        return {}

    def seen(self, namespace):
        bins = namespace["CoverBins"]
        return {str(b) for b in (0, 1) if any(m in bins[b] for m in self.members)}


class Value(Site):
    """Smallest and largest result of an expression: C and D, set by W( )."""

    def __init__(self, number, text, place):
        super().__init__(number, "value", text, place, ())
        self.bounds = {}

    def want(self, least, greatest):
        if least is not None:
            self.bounds[f"least {least}"] = least
        if greatest is not None:
            self.bounds[f"greatest {greatest}"] = greatest
        self.outcomes = list(self.bounds)

    def given(self, namespace):
        low, high = self.name("C"), self.name("D")

        def record(value):
            if value < namespace.get(low, _NONE):
                namespace[low] = value
            if value > namespace.get(high, -_NONE):
                namespace[high] = value
            return value

        return {low: _NONE, high: -_NONE, self.name("W"): record}

    def extremes(self, namespace):
        """(least, greatest), or None if the expression was never computed."""
        if namespace[self.name("C")] == _NONE:
            return None
        return namespace[self.name("C")], namespace[self.name("D")]

    def seen(self, namespace):
        least, greatest = self.extremes(namespace) or (None, None)
        return {text for text, bound in self.bounds.items()
                if bound == (least if text.startswith("least") else greatest)}
