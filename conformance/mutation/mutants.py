"""Faults: reading a list of them, seeding one, and finding a stream that notices it in the decoder.

encoder_tests.py finds tests that notice faults of the encoder.
"""

import contextlib
import dataclasses
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys

_CONFORMANCE = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(_CONFORMANCE / "judge"))
import contract
import grading

LIST = pathlib.Path(__file__).resolve().with_name("mutants.txt")
FOLDERS = ("common", "decoder", "scripts/cmake")
# Faults are seeded into plain loops, not into their SIMD twins.
_TWINS = "#define RLPC_HAVE_AVX2_KERNELS"
_TIMEOUT = 8  # seconds for a stream; a mutant that hangs is noticed
_MAX_HANGS = 3
_MEMORY = 4 << 30


class MutantError(Exception):
    """The list does not match the sources, or the sources do not build."""


@dataclasses.dataclass
class Mutant:
    name: str
    what: str
    file: str
    old: str
    new: str
    equivalent: str  # why nothing can notice it; empty: some stream or test must
    line: int
    list: str = LIST.name
    tests: tuple = ()  # those that may notice it, in this order, if it is one of the encoder


def read(path=LIST):
    """All mutants of the list."""
    mutants = []
    tests = ()
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        mark, text = line[:2], line[2:]
        if mark == "= ":
            name, _, what = text.partition(" ")
            mutants.append(Mutant(name, what.strip(), "", "", "", "", number, path.name, tests))
        elif mark == "* ":
            tests = tuple(text.split())
        elif mark in ("- ", "+ ", "~ ", "-", "+"):
            field = {"-": "old", "+": "new", "~": "equivalent"}[mark[0]]
            before = getattr(mutants[-1], field)
            setattr(mutants[-1], field, before + ("\n" if before else "") + text)
        elif line and not line.startswith("#"):
            mutants[-1].file = line.strip()
    names = [m.name for m in mutants]
    for mutant in mutants:
        if not mutant.file or not mutant.old or names.count(mutant.name) > 1:
            raise MutantError(f"{path}:{mutant.line}: {mutant.name}: a mutant needs a unique "
                              "name, a file and a text to replace")
    return mutants


def _pattern(text):
    """A pattern for the text that accepts any white space where the text has some."""
    return re.compile(r"\s+".join(re.escape(word) for word in text.split()))


def seeded(mutant, source):
    """The source with the fault in it."""
    found = list(_pattern(mutant.old).finditer(source))
    if len(found) != 1:
        raise MutantError(f"{mutant.list}:{mutant.line}: {mutant.name}: its text occurs "
                          f"{len(found)} times in {mutant.file}; bring the list up to date")
    return source[:found[0].start()] + mutant.new + source[found[0].end():]


@contextlib.contextmanager
def planted(mutant, folder):
    """Puts the fault into the sources in a folder, and takes it out again."""
    path = folder / mutant.file
    original = path.read_text(encoding="utf-8")
    try:
        path.write_text(seeded(mutant, original), encoding="utf-8")
        yield
    finally:
        path.write_text(original, encoding="utf-8")


def check(root, mutants):
    """Complaints about mutants that do not match the sources."""
    complaints = []
    for mutant in mutants:
        try:
            seeded(mutant, (root / mutant.file).read_text(encoding="utf-8"))
        except (MutantError, OSError) as error:
            complaints.append(str(error))
    return complaints


class _NoReference:
    """Replaces the reference decoder, as the place of the first difference is not needed."""

    def output(self, stream):
        return None, ""


class Workshop:
    """A copy of the decoder's sources, built again for each mutant."""

    def __init__(self, root, folder, streams):
        self._source = pathlib.Path(folder) / "source"
        self._build = pathlib.Path(folder) / "build"
        self._streams = list(streams)
        shutil.rmtree(self._source, ignore_errors=True)
        for name in FOLDERS:
            shutil.copytree(root / name, self._source / name,
                            ignore=shutil.ignore_patterns("*_test.cpp", "*_fuzz.cpp"))
        (self._source / "CMakeLists.txt").write_text(_CMAKE, encoding="utf-8")
        twins = 0
        for path in self._source.glob("common/**/*.h"):
            # The streams must notice the fault, not the compiler.
            text = re.sub(r"^static_assert\(.*?\);.*$", "", path.read_text(encoding="utf-8"),
                          flags=re.MULTILINE)
            twins += text.count(_TWINS)
            path.write_text(text.replace(_TWINS, ""), encoding="utf-8")
        if twins != 1:
            raise MutantError(f"{_TWINS} is in {twins} headers: SIMD twins would run instead of "
                              "the changed loops")
        self._run("cmake", "-S", self._source, "-B", self._build, "-G", "Ninja")
        self._make()
        self._right = self._digest()

    def _run(self, *words):
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
        if done.returncode != 0:
            raise MutantError(f"{' '.join(map(str, words))}:\n{done.stdout[-3000:]}"
                              f"{done.stderr[-1000:]}")

    def _make(self):
        self._run("cmake", "--build", self._build, "-j", "1")

    def _digest(self):
        return hashlib.sha256((self._build / "rlpcdec").read_bytes()).hexdigest()

    def judge_right(self):
        """The id of a stream on which the decoder fails without a fault, or None."""
        stream, _ = self._first_failure() or (None, None)
        return stream

    def try_out(self, mutant):
        """(how it ended, stream): killed, diagnosed (only the rule differs), survived."""
        with self._built(mutant) as differs:
            if not differs:
                return "same program", ""
            stream, outcome = self._first_failure() or (None, None)
        if stream is None:
            return "survived", ""
        return ("diagnosed" if outcome == "PASS" else "killed"), stream

    def all_that_notice(self, mutant):
        """Ids of all streams that notice it: (killed, only diagnosed)."""
        with self._built(mutant) as differs:
            noticed = list(self._failures()) if differs else []
        return ([stream for stream, outcome in noticed if outcome != "PASS"],
                [stream for stream, outcome in noticed if outcome == "PASS"])

    @contextlib.contextmanager
    def _built(self, mutant):
        """Builds the decoder with the fault; yields whether this gives another program."""
        with planted(mutant, self._source):
            self._make()
            yield self._digest() != self._right

    def _first_failure(self):
        """(stream, outcome) of the first stream that does not pass in all columns, or None."""
        only_diagnosed = None
        for stream, outcome in self._failures():
            if outcome != "PASS":
                # It may well notice the next mutant, too.
                self._streams.sort(key=lambda other: other.id != stream)
                return stream, outcome
            only_diagnosed = only_diagnosed or (stream, outcome)
        return only_diagnosed

    def _failures(self):
        """(stream, outcome) of all streams that do not pass in all columns.

        Stops after the mutant has timed out on _MAX_HANGS streams.
        """
        decoder = contract.Decoder(str(self._build / "rlpcdec"),
                                   contract.Limits(_TIMEOUT, _MEMORY))
        try:
            decoder.describe()
        except contract.ContractError:
            yield "--rlpc-conformance", "CRASH"
            return
        decoder.answer["outputs"] = ["rlpd", "rlpa"]
        grader = grading.Grader(decoder, _NoReference())
        hangs = 0
        for stream in list(self._streams):
            judgement = grader.judge(stream)
            hangs += judgement.reason == "timeout"
            if (judgement.outcome != "PASS"
                    or judgement.cells["diagnostic"] not in (grading.PASS, grading.NONE)):
                yield stream.id, judgement.outcome
            if hangs == _MAX_HANGS:
                return


_CMAKE = """cmake_minimum_required(VERSION 3.25)
project(mutants CXX)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_FLAGS "-O0 -DNDEBUG -w -fwrapv -DRLPC_VERSION=\\\\\\"mutant\\\\\\"")
find_package(ZLIB REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(nlohmann_json REQUIRED)
file(GLOB_RECURSE sources common/*.cpp decoder/*.cpp)
list(FILTER sources EXCLUDE REGEX "c_api|/report/|/extract|/fuzz/|rlpcinfo|/one_thread.cpp")
list(FILTER sources EXCLUDE REGEX "/web/wasm/")
add_executable(rlpcdec ${sources})
target_include_directories(rlpcdec PRIVATE ${CMAKE_SOURCE_DIR})
target_precompile_headers(rlpcdec PRIVATE <CLI/CLI.hpp> <nlohmann/json.hpp>)
# Loading the precompiled header takes longer than most files take without it.
list(FILTER sources EXCLUDE REGEX "/(rlpcdec|command_line|[a-z]*_verbs?)\\\\.cpp")
set_source_files_properties(${sources} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
target_link_libraries(rlpcdec PRIVATE
  ZLIB::ZLIB CLI11::CLI11 Eigen3::Eigen nlohmann_json::nlohmann_json)
"""
