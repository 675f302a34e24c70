"""Conformance suites: SUITE.json, streams and their sidecars."""

import dataclasses
import fnmatch
import hashlib
import json
import os
import pathlib

import schema

CONTRACT = 1
TIERS = ("smoke", "core", "stress")  # each includes the previous ones
FOLDER_OF = {"accept": "accept", "reject": "reject", "unsupported": "reject", "either": "either"}
INDEX = "SUITE.json"
_IN_INDEX = ("id", "expect", "tier", "profile", "level", "sha256")
_DECODED = ("frames", "sha256_int", "sha256_f32", "frame_sha256")
_ENDED_EARLY = ("rule", "bit", "frames_before", "sha256_int")


class SuiteError(Exception):
    """An unusable suite; the text names the file and the reason."""


@dataclasses.dataclass
class Stream:
    """A stream of a suite: its file, its sidecar as a dictionary, and the folder of the suite."""

    path: pathlib.Path
    sidecar: dict
    suite: pathlib.Path = None

    def __getattr__(self, name):
        if name.startswith("__") or name == "sidecar":
            raise AttributeError(name)
        return self.sidecar.get(name)


@dataclasses.dataclass
class Suite:
    folder: pathlib.Path
    name: str
    spec: str
    streams: list


def _read_json(path, name):
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
        schema.check(value, schema.load(name), path.name)
    except OSError as error:
        raise SuiteError(f"{path}: {error.strerror}") from error
    except (ValueError, schema.SchemaError) as error:
        raise SuiteError(f"{path}: {error}") from error
    return value


def check_sidecar(sidecar, place):
    """Checks beyond the schema; complaints begin with `place`."""
    expect = sidecar["expect"]
    needed = _DECODED if expect in ("accept", "either") else _ENDED_EARLY
    for name in needed:
        if name not in sidecar:
            raise SuiteError(f"{place}: a stream to {expect} needs \"{name}\"")
    if needed is _DECODED:
        if sidecar["sha256_int"] is None:
            raise SuiteError(f"{place}: \"sha256_int\" is null, but the stream decodes")
        if len(sidecar["frame_sha256"]) != sidecar["frames"]:
            raise SuiteError(f"{place}: {sidecar['frames']} frames, but "
                             f"{len(sidecar['frame_sha256'])} hashes in \"frame_sha256\"")
    elif sidecar["sha256_int"] is None and sidecar["frames_before"]:
        raise SuiteError(f"{place}: \"frames_before\" is not 0, but \"sha256_int\" is null")


def load_stream(path):
    """The stream and its sidecar, which must match."""
    path = pathlib.Path(path)
    sidecar = _read_json(path.with_suffix(".json"), "sidecar")
    check_sidecar(sidecar, path.with_suffix(".json"))
    try:
        digest = hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise SuiteError(f"{path}: {error.strerror}") from error
    if digest != sidecar["sha256"]:
        raise SuiteError(f"{path}: SHA-256 is not the one of the sidecar: the file was changed; "
                         "get the suite again")
    return Stream(path, sidecar)


def load_suite(folder):
    """The suite in a folder, every file checked."""
    folder = pathlib.Path(folder)
    if not (folder / INDEX).is_file():
        raise SuiteError(f"{folder}: no {INDEX} there; give the folder of a suite, such as "
                         "streams/v1.0")
    index = _read_json(folder / INDEX, "suite")
    streams, ids = [], set()
    for entry in index["streams"]:
        stream = load_stream(folder / entry["path"])
        for name in _IN_INDEX:
            if stream.sidecar[name] != entry[name]:
                raise SuiteError(f"{folder / INDEX}: \"{name}\" of {entry['id']} is "
                                 f"{entry[name]!r}, but {stream.sidecar[name]!r} in its sidecar")
        if entry["path"].split("/")[0] != FOLDER_OF[entry["expect"]]:
            raise SuiteError(f"{folder / INDEX}: {entry['id']} is one to {entry['expect']}, but "
                             f"lies in {entry['path']}")
        if entry["id"] in ids:
            raise SuiteError(f"{folder / INDEX}: {entry['id']} is there twice")
        ids.add(entry["id"])
        stream.suite = folder
        streams.append(stream)
    return Suite(folder, index["suite"], index["spec"], streams)


def load_suites(folders):
    """The suites in these folders; no stream may be in two of them."""
    loaded, places = [], {}
    for folder in folders:
        loaded.append(load_suite(folder))
        for stream in loaded[-1].streams:
            if stream.id in places:
                raise SuiteError(f"{stream.id} is in {places[stream.id]} and in {folder}; name "
                                 "each suite once")
            places[stream.id] = folder
    return loaded


def index_of(folder, name, spec):
    """SUITE.json for all sidecars in a folder, as a dictionary."""
    folder = pathlib.Path(folder)
    entries = []
    for path in sorted(folder.glob("*/*/*.json")):
        if path.parts[-3] in FOLDER_OF.values():
            stream = load_stream(path.with_suffix(".rlpc"))
            entry = {key: stream.sidecar[key] for key in _IN_INDEX}
            entry["path"] = path.with_suffix(".rlpc").relative_to(folder).as_posix()
            entries.append(entry)
    entries.sort(key=lambda entry: entry["id"])
    return {"suite": name, "spec": spec, "contract": CONTRACT, "streams": entries}


def select(streams, tier="stress", profile=None, only=None):
    """The streams of a tier and those below it, without superseded ones."""
    tiers = TIERS[:TIERS.index(tier) + 1]
    return [s for s in streams
            if s.superseded_by is None and s.tier in tiers
            and (profile is None or s.profile == profile)
            and (only is None or fnmatch.fnmatchcase(s.id, only))]


def write_file(path, data):
    """Writes bytes or text to a temporary file, then renames it."""
    path = pathlib.Path(path)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        temporary.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8"))
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
