"""Runs codecs on sequences and caches the results, so that nothing is run twice."""

import dataclasses
import hashlib
import json
import os
import pathlib
import shlex
import struct
import subprocess
import tempfile
import time

MIB = 1 << 20


class Failure(Exception):
    """A codec failed; the text says how."""


@dataclasses.dataclass(frozen=True)
class Sequence:
    name: str
    mesh: pathlib.Path
    points: pathlib.Path
    num_vertices: int
    num_frames: int

    @property
    def size(self):  # vertices times frames
        return self.num_vertices * self.num_frames


@dataclasses.dataclass(frozen=True)
class Point:
    """One file of one codec, decoded and compared. Seconds and memory are of the codec's tools."""
    sequence: str
    codec: str
    gof: str  # "": the codec has none
    settings: str
    bytes: int
    bpvf: float
    kg_error_percent: float
    max_error: float
    encode_seconds: float
    decode_seconds: float
    encode_peak_mib: float
    decode_peak_mib: float


def open_sequence(mesh, points):
    with open(points, "rb") as file:
        head = file.read(32)
    if len(head) < 32 or head[:11] != b"POINTCACHE2":
        raise Failure(f"{points}: not a point cache (.pc2)")
    num_vertices, _, _, num_frames = struct.unpack("<iffi", head[16:])
    return Sequence(mesh.stem, mesh, points, num_vertices, num_frames)


def file_digest(path):
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        while piece := file.read(MIB):
            digest.update(piece)
    return digest.hexdigest()


def run_step(words, good=(0,)):
    """(seconds, peak memory in MiB) of one process and its children."""
    with tempfile.TemporaryFile() as said:
        start = time.monotonic()
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                   stderr=said)
        try:
            _, status, usage = os.wait4(process.pid, 0)
        except BaseException:
            process.kill()
            process.wait()
            raise
        seconds = time.monotonic() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in good:
            said.seek(0)
            text = said.read().decode(errors="replace").strip()
            name = pathlib.Path(words[0]).name
            raise Failure(f"{name}: {text or f'exit code {process.returncode}'}")
    return seconds, usage.ru_maxrss / 1024


def filled_in(toolbox, step, places):
    """The words of a step of the table: paths may have blanks, settings are several words."""
    words = []
    for word in step.split():
        filled = word.format(**places)
        words += shlex.split(filled) if word == "{setting}" else [filled]
    return [toolbox.path(words[0]), *words[1:]]


def run_steps(toolbox, codec, steps, places):
    seconds, peak = 0.0, 0.0
    for step in steps:
        if codec.is_shell:
            quoted = {name: shlex.quote(str(value)) for name, value in places.items()}
            quoted["step"] = places["setting"]  # may be several words
            more, memory = run_step(["sh", "-c", step.format(**quoted)])
        else:
            # rlpcenc, 2: written, but the target was out of reach.
            good = (0, 2) if step.split()[0] == "rlpcenc" else (0,)
            more, memory = run_step(filled_in(toolbox, step, places), good)
        seconds, peak = seconds + more, max(peak, memory)
    return seconds, peak


class Laboratory:
    """Measures points. `cache`: folder of results by what they depend on."""

    def __init__(self, toolbox, cache, say=lambda text: None):
        self.toolbox, self.cache, self.say = toolbox, cache, say
        self._digests = {}
        cache.mkdir(parents=True, exist_ok=True)

    def _digest(self, path):
        path = pathlib.Path(path)
        key = (path, path.stat().st_mtime_ns)
        if key not in self._digests:
            self._digests[key] = file_digest(path)
        return self._digests[key]

    def _key(self, sequence, codec, gof, setting):
        tools = {tool: self._digest(self.toolbox.path(tool)) for tool in codec.tools}
        tools.update((name, self._digest(name)) for name in codec.files())
        what = [self._digest(sequence.mesh), self._digest(sequence.points), tools, codec.prepare,
                codec.encode, codec.decode, gof, setting]
        return hashlib.sha256(json.dumps(what).encode()).hexdigest()

    def measure(self, sequence, codec, gof, setting):
        setting = f"{codec.options} {setting}".strip()
        kept = self.cache / (self._key(sequence, codec, gof, setting) + ".json")
        try:
            found = json.loads(kept.read_text(encoding="utf-8"))
        except FileNotFoundError:
            found = self._run(sequence, codec, gof, setting)
            part = kept.with_suffix(f".{os.getpid()}")
            part.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
            part.rename(kept)
        point = Point(sequence.name, codec.name, gof, setting, **found)
        self.say(f"{sequence.name}, {codec.name} {setting}: {point.bpvf:.4f} bpvf, "
                 f"KG {point.kg_error_percent:.4f} %, {point.encode_seconds:.2f} s")
        return point

    def _run(self, sequence, codec, gof, setting):
        with tempfile.TemporaryDirectory(prefix="rlpc-compare-") as name:
            folder = pathlib.Path(name)
            places = {"mesh": sequence.mesh, "points": sequence.points, "gof": gof,
                      "setting": setting, "raw": folder / "coded",
                      "out": folder / ("decoded" if codec.is_shell else "decoded.pc2"),
                      "file": folder / "coded.packed", "order": folder / "order"}
            run_steps(self.toolbox, codec, codec.prepare, places)
            encode_seconds, encode_peak = run_steps(self.toolbox, codec, codec.encode, places)
            if not places["file"].is_file():
                raise Failure("the encoder wrote no {file}")
            size = places["file"].stat().st_size
            places["raw"].unlink(missing_ok=True)  # the decoder has nothing but the file
            decode_seconds, decode_peak = run_steps(self.toolbox, codec, codec.decode, places)
            metrics = self._compare(sequence, codec, places)
        return {"bytes": size, "bpvf": 8 * size / sequence.size,
                "kg_error_percent": metrics["kg_error_percent"],
                "max_error": metrics["max_error"],
                "encode_seconds": encode_seconds, "decode_seconds": decode_seconds,
                "encode_peak_mib": encode_peak, "decode_peak_mib": decode_peak}

    def _compare(self, sequence, codec, places):
        command = [self.toolbox.path("rlpccmp"), sequence.mesh, "--points-a", sequence.points,
                   *decoded_words(sequence, places["out"]), "--json", "--quiet"]
        if not codec.restores_order and places["order"].is_file():
            command += ["--order-map", places["order"]]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Failure(f"rlpccmp: {done.stderr.strip()}")
        return json.loads(done.stdout)["metrics"]


def decoded_words(sequence, out):
    """The decoded animation as arguments of rlpccmp: `out`, with or without an extension. A point
    cache without a mesh of its name has the triangles of the input."""
    files = sorted(out.parent.glob(out.name + "*"))
    caches = [path for path in files if path.suffix in (".pc2", ".mdd")]
    if not files or len(caches or files) > 1:
        raise Failure("the decoder wrote " + (", ".join(path.name for path in files) or "no {out}"))
    decoded = (caches or files)[0]
    if caches and not any(decoded.with_suffix(s).is_file() for s in (".obj", ".ply", ".off")):
        return [sequence.mesh, "--points-b", decoded]
    return [decoded]


def climb(ladder, measure, errors):
    """Points of a ladder (coarse to fine) on both sides of every error, found by bisection."""
    points = {}

    def kg(i):
        if i not in points:
            points[i] = measure(ladder[i])
        return points[i].kg_error_percent

    for error in errors:
        low, high = 0, len(ladder) - 1  # the first step whose error is at most `error`, or the last
        while low < high:
            middle = (low + high) // 2
            if kg(middle) <= error:
                high = middle
            else:
                low = middle + 1
        kg(low)
        if low > 0:
            kg(low - 1)
    return list(points.values())


def sample(laboratory, sequence, codec, gof, errors):
    """All points of a codec on a sequence that the rates at these errors need."""
    def measure(setting):
        return laboratory.measure(sequence, codec, gof, setting)

    if codec.ladders:
        return [point for ladder in codec.ladders
                for point in climb(usable(ladder, sequence), measure, errors)]
    # One step coarser than asked: the encoder stays below its targets.
    targets = [*errors, 1.15 * max(errors)]
    return [measure(f"--kg {target:.6g}") for target in targets]


def usable(ladder, sequence):
    """The ladder without steps that have more components than frames."""
    def components(setting):
        words = setting.split()
        return int(words[words.index("--components") + 1]) if "--components" in words else 0

    return [setting for setting in ladder if components(setting) <= sequence.num_frames]
