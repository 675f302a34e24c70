"""Faults for the encoder: building the tests with one, and finding a test that notices it."""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess

import mutants

LIST = mutants.LIST.with_name("encoder_mutants.txt")
FOLDERS = ("common", "decoder", "encoder", "conformance", "scripts")
FILES = ("CMakeLists.txt", "CMakePresets.json")
_TIMEOUT = 120  # seconds for a test binary; a mutant that hangs is noticed
_MEMORY_KIB = 8 << 20
# Tests must notice faults, not assertions or the compiler; -O1 is built sooner than -O3.
_OPTIONS = ("-DRLPC_UNITY=OFF", "-DRLPC_SHARED=OFF", "-DCMAKE_CXX_FLAGS=-w",
            "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG",
            "-DCMAKE_GTEST_DISCOVER_TESTS_DISCOVERY_MODE=PRE_TEST")


def binary_of(test):
    """The binary of BINARY or BINARY:FILTER."""
    return test.partition(":")[0]


def binaries(root):
    """{test binary: the folder of its sources}; CMake makes one for each folder with tests."""
    folders = {path.parent for name in FOLDERS for path in (root / name).glob("**/*_test.cpp")}
    return {"_".join(folder.relative_to(root).parts) + "_test": folder for folder in folders}


def _suites(folder):
    """The names of test suites in the sources of a folder."""
    texts = (path.read_text(encoding="utf-8") for path in folder.glob("*_test.cpp"))
    return {suite for text in texts
            for suite in re.findall(r"^TEST(?:_[FP])?\(\s*(\w+)", text, re.MULTILINE)}


def check(root, chosen):
    """Complaints about mutants that do not match the sources, or name no test."""
    complaints = mutants.check(root, chosen)
    known = binaries(root)
    for mutant in chosen:
        place = f"{mutant.list}:{mutant.line}: {mutant.name}: "
        if not mutant.tests:
            complaints.append(place + 'no line "* TEST..." before it')
    for test in dict.fromkeys(test for mutant in chosen for test in mutant.tests):
        name, _, filters = test.partition(":")
        if name not in known:
            complaints.append(f"{LIST.name}: there is no test binary {name}")
            continue
        suites = _suites(known[name])
        for pattern in filter(None, filters.split(":")):
            suite = pattern.lstrip("*/").partition(".")[0]
            if suite not in suites:
                complaints.append(f"{LIST.name}: {name} has no test suite {suite}")
    return complaints


class Workshop:
    """A copy of the sources, whose tests are built again for each mutant."""

    def __init__(self, root, folder, tests, jobs):
        folder = pathlib.Path(folder)
        self._source = folder / "source"
        self._build = folder / "build"
        self._tests = list(tests)
        self._environment = os.environ | {"TMPDIR": str(folder / "tmp")}
        options = list(_OPTIONS)
        if shutil.which("ccache"):
            options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
            # The copies share what they compile, and so do later runs.
            self._environment |= {
                "CCACHE_BASEDIR": str(folder), "CCACHE_NOHASHDIR": "1",
                "CCACHE_SLOPPINESS": "pch_defines,time_macros,include_file_mtime,"
                                     "include_file_ctime"}
        # Tests that crash leave files behind.
        shutil.rmtree(folder / "tmp", ignore_errors=True)
        (folder / "tmp").mkdir(parents=True)
        self._copy(root)
        self._run("cmake", "--preset", "release", "-S", self._source, "-B", self._build, *options)
        names = list(dict.fromkeys(map(binary_of, self._tests)))
        self._run("cmake", "--build", self._build, "-j", jobs, "--target", *names)
        self._right = {name: self._digest(name) for name in names}

    def _copy(self, root):
        """Brings the copy up to date: only files that differ get another time."""
        wanted = {name: root / name for name in FILES}
        for folder in FOLDERS:
            for path in (root / folder).glob("**/*"):
                if path.is_file() and "__pycache__" not in path.parts:
                    wanted[str(path.relative_to(root))] = path
        for name, path in wanted.items():
            copy = self._source / name
            if copy.is_file() and copy.read_bytes() == path.read_bytes():
                continue
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)
            shutil.copymode(path, copy)
        for folder in FOLDERS:
            for copy in list((self._source / folder).glob("**/*")):
                if copy.is_file() and str(copy.relative_to(self._source)) not in wanted:
                    copy.unlink()
        streams = self._source / "streams"  # some tests read them
        if not streams.is_symlink():
            streams.symlink_to(root / "streams")

    def _run(self, *words):
        words = list(map(str, words))
        done = subprocess.run(words, capture_output=True, text=True, env=self._environment)
        if done.returncode != 0:
            raise mutants.MutantError(f"{' '.join(words)}:\n{done.stdout[-3000:]}"
                                      f"{done.stderr[-1000:]}")

    def _digest(self, name):
        return hashlib.sha256((self._build / "bin" / name).read_bytes()).hexdigest()

    def judge_right(self):
        """A test that fails without a fault, or None."""
        return next(filter(None, map(self._first_failure, self._tests)), None)

    def try_out(self, mutant):
        """(how it ended, test): noticed, survived, same program, does not compile."""
        differs = False
        with mutants.planted(mutant, self._source):
            for test in mutant.tests:
                name = binary_of(test)
                try:
                    self._run("cmake", "--build", self._build, "-j", 1, "--target", name)
                except mutants.MutantError:
                    return "does not compile", ""
                if self._digest(name) == self._right[name]:
                    continue
                differs = True
                failure = self._first_failure(test)
                if failure:
                    return "noticed", failure
        return ("survived" if differs else "same program"), ""

    def _first_failure(self, test):
        """The first test that fails, crashes, or does not end; None if all pass."""
        name, _, filters = test.partition(":")
        words = [str(self._build / "bin" / name), "--gtest_fail_fast",
                 f"--gtest_filter={filters or '*'}"]
        try:
            done = subprocess.run(
                ["bash", "-c", f'ulimit -c 0 -v {_MEMORY_KIB}; exec "$0" "$@"', *words],
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                timeout=_TIMEOUT, env=self._environment, cwd=self._build)
            output, code = done.stdout, done.returncode
        except subprocess.TimeoutExpired as expired:
            output, code = expired.stdout or b"", None
        return first_failure(name, output.decode("utf-8", "replace"), code)


def first_failure(name, output, code):
    """The name of the first test that failed, from what a binary of GoogleTest printed; or None.

    code: how it ended; None if it ran too long.
    """
    started = re.findall(r"^\[ RUN      \] (\S+)", output, re.MULTILINE)
    if code == 0:
        return None if started else f"{name} (has no such test)"
    failed = re.findall(r"^\[  FAILED  \] ([^\s,]+\.[^\s,]+)", output, re.MULTILINE)
    if failed:
        return failed[0]
    how = "runs too long" if code is None else "crashes"
    return f"{started[-1]} ({how})" if started else f"{name} ({how})"
