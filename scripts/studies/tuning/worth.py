"""Worth of tuned constants: encodings with each of them at other values."""

import concurrent.futures
import dataclasses
import hashlib
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile
import threading

import tuned

COLUMNS = ("off", "half", "double")
# Ends a search for a target with its first encoding.
FIRST_TRIAL = f"{tuned.TRIALS}=1"


class Failure(Exception):
    """The scratch copy does not build, or an encoding failed."""


@dataclasses.dataclass(frozen=True)
class Case:
    mesh: pathlib.Path
    options: tuple

    @property
    def name(self):
        return " ".join([self.mesh.stem, *self.options])

    @property
    def target(self):
        """The error that is asked for, in per cent."""
        return float(self.options[self.options.index("--kg") + 1])

    def with_target(self, kg):
        at = self.options.index("--kg") + 1
        return dataclasses.replace(
            self, options=(*self.options[:at], repr(kg), *self.options[at + 1:]))


@dataclasses.dataclass(frozen=True)
class Result:
    bytes: int
    error: float    # KG, per cent
    seconds: float  # processor time


def copy_sources(root, scratch):
    """The sources of the tree, with tuned constants that can be changed from outside."""
    names = subprocess.run(["git", "-C", root, "ls-files", "-z", "--cached", "--others",
                            "--exclude-standard", ":!streams", ":!spec"], check=True,
                           capture_output=True, text=True).stdout.split("\0")
    wanted = {name: (root / name).read_bytes() for name in names
              if name and (root / name).is_file()}
    for name, content in wanted.items():
        if name.startswith("encoder/") and name.endswith((".h", ".cpp")):
            wanted[name] = tuned.instrumented(name, content.decode()).encode()
    wanted[tuned.OVERRIDE_HEADER] = tuned.OVERRIDE.encode()
    for path in [p for p in scratch.rglob("*") if p.is_file()]:
        if path.relative_to(scratch).as_posix() not in wanted:
            path.unlink()
    for name, content in wanted.items():
        path = scratch / name
        if path.is_file() and path.read_bytes() == content:
            continue  # what stays is not built again
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def build(root, out):
    """The encoder of the scratch copy."""
    scratch, binary = out / "tree", out / "build"
    scratch.mkdir(parents=True, exist_ok=True)
    copy_sources(root, scratch)
    for command in (["-S", scratch, "-B", binary, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                     "-DBUILD_TESTING=OFF"],
                    ["--build", binary, "--target", "rlpcenc"]):
        done = subprocess.run(["cmake", *command], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Failure(f"the scratch copy cannot be built:\n{done.stdout}{done.stderr}")
    return binary / "bin" / "rlpcenc"


class Encoder:
    """Runs encodings, as many at a time as there are processors, and keeps their results in a
    file."""

    def __init__(self, program, cache):
        self.program = program
        self.cache = cache
        self.lock = threading.Lock()
        self.key = hashlib.sha256(program.read_bytes()).hexdigest()[:16]
        self.known = json.loads(cache.read_text()) if cache.is_file() else {}

    def run(self, case, override=""):
        key = " ".join([self.key, override, case.name])
        if key not in self.known:
            result = dataclasses.astuple(self._encode(case, override))
            with self.lock:
                self.known[key] = result
                self.cache.write_text(json.dumps(self.known, indent=0) + "\n")
        return Result(*self.known[key])

    def run_all(self, tasks):
        """Results of all (case, override), in their order."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(lambda task: self.run(*task), tasks))

    def _encode(self, case, override):
        environment = {**os.environ, "RLPC_TUNED": override}
        with tempfile.TemporaryDirectory(prefix="rlpc-constants-") as folder:
            command = [self.program, case.mesh, "--points", case.mesh.with_suffix(".pc2"), "--json",
                       "-o", pathlib.Path(folder, "a.rlpc"), "--threads", "1", *case.options]
            log = pathlib.Path(folder, "log")
            with log.open("w") as stderr:
                process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE,
                                           stderr=stderr, text=True)
            with process.stdout as pipe:
                output = pipe.read()
            # The time of this process alone: others run at the same time.
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            complaint = log.read_text().strip()
        if not output:  # a target that is missed is no failure
            raise Failure(f"{override}: {case.name}: {complaint}")
        report = json.loads(output)
        return Result(report["bytes"], report["metrics"]["kg_error_percent"], usage.ru_utime)


def slope(result, other):
    """d log bytes / d log error between two encodings."""
    return math.log(other.bytes / result.bytes) / math.log(other.error / result.error)


def change(results, base, slopes, targets):
    """Geometric mean, over cases, of bytes at the same error relative to the base; of seconds."""
    count = len(results)

    def bytes_at_target(result, i):
        return math.log(result.bytes) + slopes[i] * math.log(targets[i] / result.error)
    size = sum(bytes_at_target(r, i) - bytes_at_target(b, i)
               for i, (r, b) in enumerate(zip(results, base))) / count
    time = math.log(sum(r.seconds for r in results) / sum(b.seconds for b in base))
    return math.expm1(size), math.expm1(time)


def measure(encoder, cases, constants, common, say):
    """{id: {column: (bytes, seconds) as parts of the base}}; None for the same bytes. common: what
    is overridden in all encodings."""
    count = len(cases)
    both = encoder.run_all([(case, common) for case in cases]
                           + [(case.with_target(1.06 * case.target), common) for case in cases])
    base = both[:count]
    slopes = [slope(b, o) for b, o in zip(base, both[count:])]
    targets = [case.target for case in cases]
    table = {}
    for constant in constants:
        row = table[constant.id] = {}
        columns = {column: ";".join(filter(None, (common, f"{constant.id}={value}")))
                   for column, value in tuned.variants(constant).items()}
        found = encoder.run_all([(case, override) for override in columns.values()
                                 for case in cases])
        for i, column in enumerate(columns):
            results = found[i * count:(i + 1) * count]
            same = all(r.bytes == b.bytes and r.error == b.error for r, b in zip(results, base))
            byte_change, time_change = change(results, base, slopes, targets)
            row[column] = (None if same else byte_change, time_change)
        say(constant, row)
    return table


def _cell(entry):
    if entry is None:
        return ""
    byte_change, time_change = entry
    size = "=" if byte_change is None else f"{100 * byte_change:+.2f}"
    return f"{size} / {100 * time_change:+.0f}"


_HEAD = ("| constant | value | off | half | double | with | what it decides |",
         "|---|---|---|---|---|---|---|")


def _row(constant, cells):
    value = " ".join(constant.value.split())
    return f"| `{constant.id}` | {value} |{cells} {constant.reason} |"


def markdown(constants, tables):
    """The rows of all constants.

    tables: {id: {"with": what they were measured with, column: cell}}."""
    lines = [*_HEAD]
    for c in constants:
        row = tables.get(c.id, {})
        cells = " | ".join(_cell(row.get(column)) for column in COLUMNS)
        label = row["with"] if len(row) > 1 else ""  # else nothing was measured
        lines.append(_row(c, f" {cells} | {label} |"))
    return "\n".join(lines) + "\n"


BEGIN, END = "<!-- begin: constants -->", "<!-- end: constants -->"


def with_table(text, table):
    """The text of a page with the table between its marks."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    if not rest or END not in text:
        raise Failure(f"the page has no marks {BEGIN} and {END}")
    return f"{before}{BEGIN}\n{table}{END}{after}"


def rows(text):
    """The ids that the table of a page has."""
    return re.findall(r"^\| `([\w.]+)` \|", text, re.MULTILINE)


def with_constants(text, constants):
    """The text of a page with constants, values and reasons as declared; what was measured stays.
    """
    measured = dict(re.findall(r"^\| `([\w.]+)` \| (?:[^|]*) \|((?:[^|]*\|){4})", text,
                               re.MULTILINE))
    lines = [_row(c, measured.get(c.id, "  |  |  |  |")) for c in constants]
    return with_table(text, "\n".join([*_HEAD, *lines]) + "\n")
