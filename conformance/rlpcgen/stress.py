"""The stress tier: streams of which only the digests are kept.

STRESS.json of a version has a digest for each hundred random legal streams, by seed, and for each
recipe of recipes-stress/, which may be slow or give large streams. A digest covers the bytes of the
streams and all that they decode to.
"""

import hashlib
import json
import multiprocessing
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "judge"))
import random_streams
import recipe as recipes
import recipe_source
import spec_program
import suite  # noqa: E402

INDEX = "STRESS.json"
BATCH = 100
_EXIT_CODES = {"accept": 0, "reject": 1, "unsupported": 2}
_worker = None


class _Worker:
    """Makes streams, has both decoders decode them, and the validator look at them."""

    def __init__(self, folder, spec, bin_folder):
        self._folder = pathlib.Path(folder)
        self._program = spec_program.Program(spec)
        self._random = random_streams.RandomBuilder(self._program)
        self._recipes = recipe_source.StreamBuilder(self._program)
        self._bin = pathlib.Path(bin_folder).resolve()

    def examine(self, item):
        """(name, bytes of the stream, SHA-256 of stream and decoded file, complaint or None)."""
        kind, name = item
        if kind == "seed":
            data = self._random.build(int(name))[0]
        else:
            data = self._recipes.build(recipes.load(self._folder / name))[0]
        found = suite.expectation_of(data, self._program)
        decoded, complaint = self._decode(data, found)
        digest = hashlib.sha256(data).hexdigest() + str(decoded)
        return name, len(data), digest, complaint

    def _decode(self, data, found):
        with tempfile.TemporaryDirectory(prefix="rlpc-stress-") as folder:
            stream, output = pathlib.Path(folder, "in.rlpc"), pathlib.Path(folder, "out.rlpd")
            stream.write_bytes(data)
            done = subprocess.run([self._bin / "rlpcdec", "decode", stream, output],
                                  capture_output=True, text=True)
            decoded = (hashlib.sha256(output.read_bytes()).hexdigest() if output.is_file()
                       else None)
            expected = _EXIT_CODES[found["expect"]]
            if done.returncode != expected:
                return decoded, (f"rlpcdec: {done.returncode} {done.stderr[-300:]}; "
                                 f"specdec: {found['expect']} {found.get('rule', '')}")
            if decoded != found["sha256_int"]:
                return decoded, "rlpcdec and specdec decode to different integers"
            checked = subprocess.run([self._bin / "rlpcval", "--quiet", stream],
                                     capture_output=True, text=True)
            if checked.returncode != expected:
                return decoded, f"rlpcval: {checked.stdout[-300:]}{checked.stderr[-300:]}"
        return decoded, None


def _start(*arguments):
    global _worker
    _worker = _Worker(*arguments)


def _examine(item):
    return _worker.examine(item)


def items(folder, seeds):
    """What there is to examine: seeds of random streams, then recipes."""
    paths = sorted(pathlib.Path(folder).glob("recipes-stress/*/*.recipe"))
    return ([("seed", str(seed)) for seed in range(seeds)]
            + [("recipe", p.relative_to(folder).as_posix()) for p in paths])


def examine(folder, spec, bin_folder, seeds, jobs):
    """Yields (name, bytes, digest, complaint) of each item."""
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
