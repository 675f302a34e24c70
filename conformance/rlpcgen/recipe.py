"""Parses recipes, readable texts from which streams are written; RECIPES.md has the format."""

import dataclasses
import pathlib
import re
import zlib

_META = re.compile(r"([a-z_]+):\s*(.*)$")
_UNIT = re.compile(r"(unit|change|insert)\s+(?:(\d+)\s+)?([A-Z_]+|0x[0-9A-Fa-f]{2})$")
_REPEAT = re.compile(r"repeat\s+(\d+)\s+of\s+(\d+)$")
_DROP = re.compile(r"drop\s+(\d+)$")
_COMPONENT = re.compile(r"component\s+(\d+|all)$")
_ENTRY = re.compile(r"([a-z][a-z0-9_]*)((?:\[\d+\])*)\s*=\s*(.*)$")
_RANDOM = re.compile(r"random\((-?\d+),(-?\d+)\)$")
_RARE = re.compile(r"rare\((\d+),(\d+)\)$")
_TIMES = re.compile(r"(\d+)\*(.+)$")
LISTS = ("rules", "features")
META = ("title", "tier", "seed", "twin", "level", "expect", "note", "superseded_by") + LISTS


class RecipeError(Exception):
    """A recipe that cannot be parsed; the text has file and line."""


@dataclasses.dataclass
class Entry:
    name: str
    indices: tuple
    text: str
    place: str


@dataclasses.dataclass
class Unit:
    name: str
    entries: list = dataclasses.field(default_factory=list)
    components: dict = dataclasses.field(default_factory=dict)  # number -> entries
    repetition: int = 0

    def copy(self):
        return Unit(self.name, list(self.entries),
                    {n: list(entries) for n, entries in self.components.items()}, self.repetition)


@dataclasses.dataclass
class Recipe:
    path: pathlib.Path
    meta: dict
    stream: list  # entries that concern the whole stream
    units: list


class Numbers:
    """A random series that is the same everywhere and for ever (SplitMix64)."""

    def __init__(self, seed):
        self._state = seed & ((1 << 64) - 1)

    def next64(self):
        mask = (1 << 64) - 1
        self._state = (self._state + 0x9E3779B97F4A7C15) & mask
        z = self._state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        return z ^ (z >> 31)

    def between(self, low, high):
        return low + self.next64() % (high - low + 1)

    def chance(self, percent):
        return self.between(0, 99) < percent

    def pick(self, items):
        return items[self.between(0, len(items) - 1)]


class Values:
    """The values of an entry, one after the other."""

    def __init__(self, entry, seed):
        self.entry = entry
        self._numbers = Numbers(seed ^ zlib.crc32(f"{entry.name}{entry.indices}".encode()))
        self._items = re.sub(r"\s*([(,])\s*", r"\1", entry.text).split()
        self._repeats = bool(self._items) and self._items[-1] == "..."
        if self._repeats:
            self._items.pop()
        if not self._items:
            raise RecipeError(f"{entry.place}: {entry.name} has no value")
        self._at = 0
        self._left = None  # repetitions left of the current item

    def done(self):
        return self._at >= len(self._items) and not self._repeats

    def unused(self):
        return self._at < len(self._items)

    def _item(self):
        at = min(self._at, len(self._items) - 1)
        match = _TIMES.match(self._items[at])
        return (int(match.group(1)), match.group(2)) if match else (1, self._items[at])

    def next_text(self):
        count, text = self._item()
        self._left = (count if self._left is None else self._left) - 1
        if self._left <= 0:
            self._at += 1
            self._left = None
        match, rare = _RANDOM.match(text), _RARE.match(text)
        if rare:
            return str(self._rare(*map(int, rare.groups())))
        return str(self._numbers.between(*map(int, match.groups()))) if match else text

    def _rare(self, percent, limit):
        """0, or in some cases a number of any magnitude up to a limit."""
        if not self._numbers.chance(percent):
            return 0
        max_magnitude = (1 << self._numbers.between(1, limit.bit_length())) - 1
        magnitude = min(limit, self._numbers.between(1, max_magnitude))
        return -magnitude if self._numbers.chance(50) else magnitude

    def next(self):
        text = self.next_text()
        try:
            return int(text, 0)
        except ValueError as error:
            raise RecipeError(f"{self.entry.place}: {text!r} is not a number") from error


class _Parser:
    def __init__(self, path, text, load):
        self.recipe = Recipe(path, {"rules": [], "features": []}, [], [])
        self._load = load
        self._entries = self.recipe.stream
        self._unit = None
        self._base = None  # units of the twin; None: left out
        self._inserted = {}
        for number, line in enumerate(text.splitlines(), 1):
            self._place = f"{path}:{number}"
            line = line.split("#", 1)[0].strip()
            if line:
                self._line(line)
        if self._base is not None:
            for n in range(len(self._base) + 1):
                self.recipe.units += self._inserted.get(n, [])
                if n < len(self._base) and self._base[n] is not None:
                    self.recipe.units.append(self._base[n])

    def fail(self, what):
        raise RecipeError(f"{self._place}: {what}")

    def _line(self, line):
        meta, unit, entry = _META.match(line), _UNIT.match(line), _ENTRY.match(line)
        if meta and self._unit is None and not self.recipe.units:
            self._meta(*meta.groups())
        elif unit:
            self._open_unit(*unit.groups())
        elif _DROP.match(line):
            self._base_unit(int(_DROP.match(line).group(1)))
            self._base[int(_DROP.match(line).group(1))] = None
        elif line == "stream":
            self._entries = self.recipe.stream
        elif _REPEAT.match(line):
            self._repeat(*map(int, _REPEAT.match(line).groups()))
        elif _COMPONENT.match(line):
            if self._unit is None:
                self.fail("`component` belongs inside a unit")
            number = _COMPONENT.match(line).group(1)
            key = number if number == "all" else int(number)
            self._entries = self._unit.components.setdefault(key, [])
        elif entry:
            indices = tuple(int(i) for i in re.findall(r"\d+", entry.group(2)))
            self._entries.append(Entry(entry.group(1), indices, entry.group(3), self._place))
        elif self._entries:
            self._entries[-1].text += " " + line
        else:
            self.fail(f"not understood: {line}")

    def _meta(self, key, text):
        if key not in META:
            self.fail(f"{key}: not a field of a recipe; fields are {', '.join(META)}")
        self.recipe.meta[key] = text.replace(",", " ").split() if key in LISTS else text
        if key == "twin":
            twin = self._load(text)
            self._base = [unit.copy() for unit in twin.units]
            self.recipe.stream += twin.stream
            if "seed" in twin.meta:
                self.recipe.meta.setdefault("seed", twin.meta["seed"])

    def _repeat(self, times, count):
        units = self.recipe.units
        if self._base is not None or not 0 < count <= len(units):
            self.fail("`repeat N of M` follows M units, in a recipe without a twin")
        for n in range(1, times):
            units += [dataclasses.replace(u.copy(), repetition=n) for u in units[-count:]]

    def _base_unit(self, number):
        if self._base is None or number >= len(self._base) or self._base[number] is None:
            self.fail(f"the twin has no unit {number}")
        return self._base[number]

    def _open_unit(self, verb, number, name):
        if (verb == "unit") != (self._base is None) or (verb == "unit") != (number is None):
            self.fail("`unit NAME`; or, in a recipe with a twin, `change N NAME`, "
                      "`insert N NAME`, `drop N`")
        if verb == "unit":
            self._unit = Unit(name)
            self.recipe.units.append(self._unit)
        elif verb == "change":
            self._unit = self._base_unit(int(number))
            if self._unit.name != name:
                self.fail(f"unit {number} of the twin is {self._unit.name}, not {name}")
        else:
            self._unit = Unit(name)
            self._inserted.setdefault(int(number), []).append(self._unit)
        self._entries = self._unit.entries


def parse(path, text, load):
    """A Recipe. load(id) gives the recipe of a twin."""
    return _Parser(path, text, load).recipe


def load(path):
    """The recipe of a file; a twin is looked for in all areas of all tiers, or next to it."""
    path = pathlib.Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise RecipeError(f"{path}: {error.strerror}") from error

    def twin(name):
        found = sorted(path.parents[2].glob(f"recipes*/*/{name}.recipe"))
        found = found or sorted(path.parent.glob(f"{name}.recipe"))
        if not found:
            raise RecipeError(f"{path}: there is no recipe of the twin {name}")
        return load(found[0])

    return parse(path, text, twin)
