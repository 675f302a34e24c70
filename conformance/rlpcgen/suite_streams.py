"""The streams of a version: built from their recipes, checked against them, and frozen."""

import functools
import hashlib
import json
import multiprocessing
import pathlib
import re
import subprocess
import sys

_CONFORMANCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(_CONFORMANCE / "judge"))
import expectation
import recipe as recipes
import recipe_source
import specdec  # found through recipe_source
import suite

LICENCE = "CC0-1.0"
SUMS = "SHA256SUMS"
SIDECAR_SUMS = "SHA256SUMS.sidecars"
STRESS = "STRESS.json"  # digests of the stress tier
_ID = re.compile(r"[A-Z]{2,3}-\d{4}([a-w]|x\d+[b-w]?)$")
_SETTINGS = {"profile_idc": 0, "level_idc": 1}


def specification_of(folder):
    """The version of the specification: 1.1 for streams/v1.1 and its supplement streams/v1.1s1."""
    return pathlib.Path(folder).name[1:].partition("s")[0]


class StreamsError(Exception):
    """A recipe and its stream do not agree."""


def recipe_paths(folder, only=None, left_out=None):
    """The recipes of a version whose id matches the pattern `only`, and not `left_out`."""
    paths = sorted(pathlib.Path(folder).glob("recipes/*/*.recipe"))
    return [p for p in paths if (only is None or p.match(only + ".recipe"))
            and (left_out is None or not p.match(left_out + ".recipe"))]


def _header_value(recipe, name):
    """A syntax element of the first sequence header, as the recipe has it."""
    for unit in recipe.units:
        if unit.name == "SEQUENCE_HEADER":
            for entry in reversed(unit.entries):
                if entry.name == name:
                    return int(entry.text, 0)
            break
    return _SETTINGS[name]


def _profile(recipe):
    """The profile: Baseline unless the version is the one that introduced profile_idc."""
    minor = [e.text for e in recipe.stream if e.name == "version_minor"][-1:]
    found = _header_value(recipe, "profile_idc")
    return {1: "main", 2: "high"}.get(found, "baseline") if minor == [str(found)] else "baseline"


def _expect(recipe, found, place):
    """Required result of a decoder, from the recipe's announcement and the specification."""
    announced = recipe.meta.get("expect")
    rules = recipe.meta["rules"]
    if announced == "either":
        if found["expect"] != "accept" or not rules:
            raise StreamsError(f"{place}: `expect: either` is for streams that decode, but "
                               "violate a rule that decoding need not check")
        if _is_rule(found.get("attributes")) and rules != [found["attributes"]]:
            raise StreamsError(f"{place}: `rules: {', '.join(rules)}`, but the attributes break "
                               f"{found['attributes']} first")
        return announced
    if found["expect"] == "accept" and _is_rule(found.get("attributes")):
        raise StreamsError(f"{place}: attributes break {found['attributes']}; if that is intended, "
                           "write `expect: either`, as decoders may skip them")
    if found["expect"] == "accept":
        if announced not in (None, "accept") or "x" in recipe.path.stem:
            raise StreamsError(f"{place}: should be refused, but decodes")
        return "accept"
    if "x" not in recipe.path.stem:
        raise StreamsError(f"{place}: breaks {found['rule']} at bit {found['bit']}; if that is "
                           "intended, its id must end with x and a number")
    if rules != [found["rule"]]:
        raise StreamsError(f"{place}: `rules: {', '.join(rules)}`, but the first rule that it "
                           f"breaks is {found['rule']}, at bit {found['bit']}")
    return found["expect"]


def _is_rule(attributes):
    return attributes is not None and attributes.startswith("R-")


def sidecar_of(recipe, data, folder, program):
    """The sidecar of a stream."""
    place = recipe.path
    if not _ID.match(recipe.path.stem):
        raise StreamsError(f"{place}: an id is an area, a number and a revision, GOF-0004a; one "
                           "that is refused has x and a number instead, GOF-0004x1")
    if "title" not in recipe.meta or recipe.meta.get("tier") not in suite.TIERS:
        raise StreamsError(f"{place}: a recipe has a title and a tier: {', '.join(suite.TIERS)}")
    found = expectation.expectation_of(data, program)
    attributes = expectation.attributes_of(data, program)
    if attributes is not None:
        found["attributes"] = attributes
    expect = _expect(recipe, found, place)
    found.pop("expect")
    level = int(recipe.meta.get("level", _header_value(recipe, "level_idc")))
    highest = specdec.levels_of(program)[-1]
    return {"id": recipe.path.stem, "title": recipe.meta["title"], "spec": specification_of(folder),
            "profile": _profile(recipe),
            "level": max(1, min(highest, level)), "expect": expect, "tier": recipe.meta["tier"],
            "rules": recipe.meta["rules"], "features": recipe.meta["features"],
            "twin": recipe.meta.get("twin"), "sha256": hashlib.sha256(data).hexdigest(),
            "recipe": recipe.path.relative_to(folder).as_posix(),
            "seed": int(recipe.meta["seed"]) if "seed" in recipe.meta else None,
            "released": None, "superseded_by": recipe.meta.get("superseded_by"),
            "licence": LICENCE, **found}


@functools.cache
def builder_of(spec):
    """(program, StreamBuilder); worker processes inherit what is made before them."""
    program = specdec.program_of(spec)
    return program, recipe_source.StreamBuilder(program)


class Version:
    """The folder of a version, such as streams/v1.0, or of a supplement, streams/v1.1s1."""

    def __init__(self, folder, spec):
        self.folder = pathlib.Path(folder).resolve()
        self.program, self._builder = builder_of(spec)

    def make(self, path):
        """(path of the stream, bytes, sidecar) of a recipe."""
        recipe = recipes.load(path)
        data, _ = self._builder.build(recipe)
        sidecar = sidecar_of(recipe, data, self.folder, self.program)
        area = path.parent.name
        place = self.folder / suite.FOLDER_OF[sidecar["expect"]] / area / f"{path.stem}.rlpc"
        return place, data, sidecar

    def released(self):
        return (self.folder / SUMS).is_file()


_version = None  # version of a worker process


def _start(folder, spec):
    global _version
    _version = Version(folder, spec)


def _make(path):
    try:
        return path, _version.make(path), None
    except (StreamsError, recipes.RecipeError) as error:
        return path, None, str(error)


def make_all(folder, spec, only, left_out, jobs):
    """For each recipe (path, (stream path, bytes, sidecar) or None, complaint or None)."""
    paths = recipe_paths(folder, only, left_out)
    builder_of(spec)
    with multiprocessing.Pool(jobs, _start, (folder, spec)) as pool:
        yield from pool.imap(_make, paths)


def sidecar_text(sidecar):
    return json.dumps(sidecar, indent=1, ensure_ascii=False) + "\n"


def write_stream(place, data, sidecar):
    """Writes both files; a date of release stays."""
    old = place.with_suffix(".json")
    if old.is_file():
        sidecar["released"] = json.loads(old.read_text(encoding="utf-8")).get("released")
    place.parent.mkdir(parents=True, exist_ok=True)
    suite.write_file(place, data)
    suite.write_file(old, sidecar_text(sidecar))


def difference(place, data, sidecar):
    """The difference from what the recipe gives, or None."""
    if not place.is_file() or not place.with_suffix(".json").is_file():
        return f"{place}: missing; build the streams"
    if place.read_bytes() != data:
        return f"{place}: not what its recipe gives"
    there = json.loads(place.with_suffix(".json").read_text(encoding="utf-8"))
    for name, value in sidecar.items():
        if name != "released" and there.get(name) != value:
            return (f"{place.with_suffix('.json')}: \"{name}\" is {there.get(name)!r}, but the "
                    f"recipe gives {value!r}")
    return None


def strays(folder, places):
    """Streams and sidecars without a recipe."""
    known = set(places) | {p.with_suffix(".json") for p in places}
    for kind in sorted(set(suite.FOLDER_OF.values())):
        for path in sorted((pathlib.Path(folder) / kind).glob("*/*")):
            if path not in known:
                yield path


def sums(folder):
    """The text of SHA256SUMS: what a release freezes. Sidecars, which may get more fields later,
    are in SHA256SUMS.sidecars."""
    folder = pathlib.Path(folder)
    paths = sorted(folder.glob("*/*/*.rlpc")) + sorted(folder.glob("recipes*/*/*.recipe"))
    paths += [folder / name for name in (suite.INDEX, STRESS) if (folder / name).is_file()]
    return _sums_of(folder, paths)


def sidecars(folder):
    return sorted(p for p in pathlib.Path(folder).glob("*/*/*.json")
                  if p.with_suffix(".rlpc").is_file())


def sidecar_sums(folder):
    """The text of SHA256SUMS.sidecars."""
    return _sums_of(pathlib.Path(folder), sidecars(folder))


def _committed(path):
    """The sidecar in the last commit; {}: it has none."""
    done = subprocess.run(["git", "-C", path.parent, "show", f"HEAD:./{path.name}"],
                          capture_output=True, check=False)
    return json.loads(done.stdout) if done.returncode == 0 else {}


def changed_members(folder):
    """Complaints: to released sidecars, members may be added; none may change."""
    found = []
    for path in sidecars(folder):
        now = json.loads(path.read_text(encoding="utf-8"))
        found += [f"{path}: \"{name}\" was {value!r} in the last commit"
                  for name, value in _committed(path).items() if now.get(name) != value]
    return found


def _sums_of(folder, paths):
    return "".join(f"{hashlib.sha256(p.read_bytes()).hexdigest()}  "
                   f"{p.relative_to(folder).as_posix()}\n" for p in paths)
