"""Shared by the tests of the judge: a small suite, and running the commands."""

import argparse
import contextlib
import hashlib
import importlib.machinery
import io
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.dont_write_bytecode = True
import expectation
import suite
from specdec_testing import PROGRAM, cut_animation, stream_of, units_of

JUDGE = pathlib.Path(__file__).resolve().parent
ROOT = JUDGE.parents[1]
INPUTS = ROOT / "streams" / "inputs"
RUN = importlib.machinery.SourceFileLoader("judge_run", str(JUDGE / "run")).load_module()


class Tools:
    folder = ROOT / "build" / "release" / "bin"  # --bin


def encode(folder, name, frames, *settings):
    mesh, cache = cut_animation(folder, name, frames)
    stream = folder / "stream.rlpc"
    subprocess.run([Tools.folder / "rlpcenc", mesh, "--points", cache, "-o", stream, "-q",
                    "--profile", "baseline", "--preset", "fast", *settings], check=True)
    return stream.read_bytes()


def changed(data, kind, nth, change):
    """The stream with the payload of its nth unit of a type replaced by change(payload)."""
    all_units = units_of(data)
    at = [u for u, (code, _) in enumerate(all_units) if code == kind][nth]
    all_units[at] = kind, change(all_units[at][1])
    return stream_of(data, all_units)


def sidecar(identity, data, expect=None, level=1, **more):
    """A complete sidecar for a stream; give expect only if it is not what specdec finds."""
    decoded = expectation.expectation_of(data, PROGRAM)
    result = {"id": identity, "title": f"Test stream {identity}", "spec": "1.0",
              "profile": "baseline", "level": level, "tier": "smoke", "rules": [], "features": [],
              "twin": None, "sha256": hashlib.sha256(data).hexdigest(), "recipe": None,
              "seed": None, "released": None, "superseded_by": None, "licence": "CC0-1.0"}
    result.update(decoded)
    result["rules"] = [decoded["rule"]] if "rule" in decoded else []
    if expect:
        result["expect"] = expect
    result.update(more)
    return result


def add_stream(folder, identity, data, **settings):
    about = sidecar(identity, data, **settings)
    place = folder / suite.FOLDER_OF[about["expect"]] / identity.split("-")[0]
    place.mkdir(parents=True, exist_ok=True)
    (place / f"{identity}.rlpc").write_bytes(data)
    (place / f"{identity}.json").write_text(json.dumps(about))
    return place / f"{identity}.rlpc"


def write_index(folder):
    (folder / suite.INDEX).write_text(json.dumps(suite.index_of(folder, "test-1", "1.0")))


def flip(payload):
    return payload[:-1] + bytes([payload[-1] ^ 1])


def make_suite(folder):
    """Streams of every expectation, of two levels, and with every kind of partial output."""
    with tempfile.TemporaryDirectory() as name:
        work = pathlib.Path(name)
        clip = encode(work, "curtain", 5, "--kg", "2", "--gof", "2", "--hash", "frame")
        arm = encode(work, "robot_arm", 3, "--kg", "2", "--keep-order")
        note = work / "note.json"
        note.write_text('{"title": "elephant"}')
        noted = encode(work, "elephant", 2, "--kg", "2", "--metadata", note)
    add_stream(folder, "GOF-0001a", clip)
    add_stream(folder, "GOF-0002a", arm)
    add_stream(folder, "LVL-0001a", changed(clip, 1, 0, lambda p: b"\0\2" + p[2:]), level=2)
    add_stream(folder, "HSH-0001x1", changed(clip, 0x82, 1, flip))  # frames before
    add_stream(folder, "GOF-0001x1", changed(clip, 4, 0, lambda p: b"\xff" + p[1:]))  # none
    add_stream(folder, "CON-0001x1", changed(clip, 2, 0, lambda p: p[:-4]))  # no output at all
    add_stream(folder, "STR-0001x1", clip[:9] + b"\7" + clip[10:])
    add_stream(folder, "MET-0001a", changed(noted, 0x83, 0, _no_json), expect="either",
               rules=["R-MET-03"])
    write_index(folder)
    return folder


def _no_json(_):
    text = b"no JSON"
    return struct.pack(">I", len(text)) + zlib.compress(text)


class JudgeTest(unittest.TestCase):
    """A folder, and the small suite, made once."""

    suite = None
    kept = None
    _home = None

    @classmethod
    def setUpClass(cls):
        if JudgeTest.suite is None:
            JudgeTest._home = tempfile.TemporaryDirectory(prefix="rlpc-judge-test-")
            unittest.addModuleCleanup(JudgeTest._home.cleanup)
            JudgeTest.suite = make_suite(pathlib.Path(JudgeTest._home.name) / "suite")
            JudgeTest.kept = pathlib.Path(JudgeTest._home.name) / "kept"  # for fake decoders
            JudgeTest.kept.mkdir()

    def setUp(self):
        os.environ["RLPC_FAKE_ANSWERS"] = str(self.kept)
        (self.kept / "stale").unlink(missing_ok=True)
        folder = tempfile.TemporaryDirectory(prefix="rlpc-judge-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def command(self, name, *args, **options):
        """(exit code, standard output, standard error) of a command of the judge."""
        done = subprocess.run([sys.executable, "-B", JUDGE / name, *map(str, args)],
                              capture_output=True, text=True, check=False, **options)
        return done.returncode, done.stdout, done.stderr

    def judge(self, decoder, *args, suite_folder=None):
        """(exit code, report, standard error) of `run`."""
        path = self.folder / "report.json"
        path.unlink(missing_ok=True)
        if "--max-mem" not in args:
            args = (*args, "--max-mem", "0")  # decoders with sanitizers need it
        code, _, errors = self.run_here("--decoder", decoder, "--suite",
                                        suite_folder or self.suite, "--json", path, "--jobs", "1",
                                        *args)
        return code, json.loads(path.read_text()) if path.exists() else None, errors

    @staticmethod
    def run_here(*args):
        """`run` within this process, which is faster."""
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            try:
                code = RUN.main([str(a) for a in args])
            except SystemExit as stop:
                code = stop.code
        return code, output.getvalue(), errors.getvalue()


def main():
    """--bin BUILD/bin, then the arguments of unittest, such as the name of a class."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("--bin", type=pathlib.Path, default=Tools.folder)
    options, rest = parser.parse_known_args()
    Tools.folder = options.bin.resolve()
    unittest.main(module="__main__", argv=[sys.argv[0], *rest])
