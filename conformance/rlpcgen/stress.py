"""The stress tier: streams of which only the digests are kept.

STRESS.json of a version has a digest for each hundred random legal streams, by seed, and for each
recipe of recipes-stress/: more of the same kind as the core tier, or slow, or large. A digest
covers the bytes of the streams and all that they decode to. write_suite() writes the streams
themselves into a folder, as a suite.
"""

import hashlib
import json
import multiprocessing
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "judge"))
import expectation
import random_high
import recipe as recipes
import suite
import suite_streams

INDEX = suite_streams.STRESS
BATCH = 100
PROFILES = {"v1.0": "baseline", "v1.1": "main", "v1.2": "high"}  # random streams of a version
_EXIT_CODES = {"accept": (0,), "reject": (1,), "unsupported": (2,), "either": (0, 1)}
_VALIDATOR_CODES = {**_EXIT_CODES, "unsupported": (1, 2), "either": (1,)}
_worker = None
_out = None  # folder of write_suite, in its worker processes


class _Worker:
    """Makes streams, decodes them with both decoders, and validates them."""

    def __init__(self, folder, spec, bin_folder=None):
        self._folder = pathlib.Path(folder)
        self._version = suite_streams.Version(folder, spec)
        self._program = self._version.program
        self._profile = PROFILES[self._folder.name]
        self._random = random_high.builder_of(self._profile)(self._program)
        self._bin = bin_folder and pathlib.Path(bin_folder).resolve()

    def make(self, item):
        """(id, bytes, sidecar) of a stream."""
        kind, name = item
        if kind == "recipe":
            place, data, sidecar = self._version.make(self._folder / name)
            return place.stem, data, sidecar
        data, writer = self._random.build(int(name))
        found = expectation.expectation_of(data, self._program)
        attributes = expectation.attributes_of(data, self._program)
        if attributes is not None:
            found["attributes"] = attributes
        return f"RND-{int(name):04}a", data, {
            "id": f"RND-{int(name):04}a", "title": f"Random stream of seed {name}",
            "spec": self._folder.name[1:], "profile": self._profile,
            "level": writer.ns["level_idc"],
            "tier": "stress", "rules": [], "features": [], "twin": None,
            "sha256": hashlib.sha256(data).hexdigest(), "recipe": None, "seed": int(name),
            "released": None, "superseded_by": None,
            "licence": suite_streams.LICENCE, **found}

    def examine(self, item):
        """(name, bytes of the stream, SHA-256 of stream and decoded file, complaint or None)."""
        try:
            _, data, sidecar = self.make(item)
        except (recipes.RecipeError, suite_streams.StreamsError) as error:
            return item[1], 0, "", str(error)
        decoded, complaint = self._decode(data, sidecar)
        digest = hashlib.sha256(data).hexdigest() + str(decoded)
        return item[1], len(data), digest, complaint

    def _decode(self, data, found):
        with tempfile.TemporaryDirectory(prefix="rlpc-stress-") as folder:
            stream, output = pathlib.Path(folder, "in.rlpc"), pathlib.Path(folder, "out.rlpd")
            stream.write_bytes(data)
            done = subprocess.run([self._bin / "rlpcdec", "decode", stream, output],
                                  capture_output=True, text=True)
            decoded = (hashlib.sha256(output.read_bytes()).hexdigest() if output.is_file()
                       else None)
            if done.returncode not in _EXIT_CODES[found["expect"]]:
                return decoded, (f"rlpcdec: {done.returncode} {done.stderr[-300:]}; "
                                 f"specdec: {found['expect']} {found.get('rule', '')}")
            if decoded != found["sha256_int"]:
                return decoded, "rlpcdec and specdec decode to different integers"
            if "attributes" in found:
                attributes, complaint = self._decode_attributes(stream, found["attributes"])
                decoded = f"{decoded} {attributes}"
                if complaint is not None:
                    return decoded, complaint
            checked = subprocess.run([self._bin / "rlpcval", "--quiet", stream],
                                     capture_output=True, text=True)
            if checked.returncode not in _VALIDATOR_CODES[found["expect"]]:
                return decoded, f"rlpcval: {checked.stdout[-300:]}{checked.stderr[-300:]}"
        return decoded, None

    def _decode_attributes(self, stream, expected):
        """(SHA-256 of OUT.rlpa, rule or "none"; complaint or None)"""
        output = stream.with_name("out.rlpa")
        done = subprocess.run([self._bin / "rlpcdec", "decode", stream, output],
                              capture_output=True, text=True)
        if output.is_file():
            found = hashlib.sha256(output.read_bytes()).hexdigest()
        elif done.returncode == 0:
            found = "none"
        else:
            found = re.search(r"R-[A-Z]{3}-[0-9]{2}|$", done.stderr.splitlines()[-1]).group()
        return found, (None if found == expected
                       else f"rlpcdec: attributes {found}; specdec: {expected}")


def _start(*arguments):
    global _worker
    _worker = _Worker(*arguments)


def _examine(item):
    return _worker.examine(item)


def items(folder, seeds):
    """The items to examine: seeds of random streams, then recipes."""
    paths = sorted(pathlib.Path(folder).glob("recipes-stress/*/*.recipe"))
    return ([("seed", str(seed)) for seed in range(seeds)]
            + [("recipe", p.relative_to(folder).as_posix()) for p in paths])


def _write(item):
    stream, data, sidecar = _worker.make(item)
    place = _out / suite.FOLDER_OF[sidecar["expect"]] / stream.split("-")[0] / f"{stream}.rlpc"
    suite_streams.write_stream(place, data, sidecar)
    return stream


def write_suite(folder, spec, out, seeds, jobs):
    """The streams of core and stress tier as a suite of its own; yields the ids of the latter."""
    global _out
    folder, _out = pathlib.Path(folder), pathlib.Path(out)
    for kind in sorted(set(suite.FOLDER_OF.values())):
        if (folder / kind).is_dir():  # a version need not have streams of every kind
            shutil.copytree(folder / kind, _out / kind, dirs_exist_ok=True)
    suite_streams.builder_of(spec)
    with multiprocessing.get_context("fork").Pool(jobs, _start, (folder, spec)) as pool:
        yield from pool.imap(_write, items(folder, seeds), chunksize=4)
    index = suite.index_of(_out, f"rlpc-{folder.name}-stress", folder.name[1:])
    suite.write_file(_out / suite.INDEX, json.dumps(index, indent=1) + "\n")


def examine(folder, spec, bin_folder, seeds, jobs):
    """Yields (name, bytes, digest, complaint) of each item."""
    suite_streams.builder_of(spec)
    with multiprocessing.Pool(jobs, _start, (folder, spec, bin_folder)) as pool:
        yield from pool.imap(_examine, items(folder, seeds), chunksize=4)


def digests(results):
    """The content of STRESS.json, from the results of whole batches of seeds and of recipes."""
    kept, batch = {}, None
    for name, _, digest, _ in results:
        if not name.isdigit():
            kept[name] = hashlib.sha256(digest.encode()).hexdigest()
            continue
        first = int(name) // BATCH * BATCH
        if int(name) % BATCH == 0:
            batch = hashlib.sha256()
        batch.update(digest.encode())
        if int(name) % BATCH == BATCH - 1:
            kept[f"seeds {first}-{first + BATCH - 1}"] = batch.hexdigest()
    return kept


def read(folder):
    path = pathlib.Path(folder) / INDEX
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def write(folder, kept):
    suite.write_file(pathlib.Path(folder) / INDEX, json.dumps(kept, indent=1) + "\n")
