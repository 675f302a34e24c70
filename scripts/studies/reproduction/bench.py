"""Encodes, decodes and compares; keeps each result."""

import csv
import dataclasses
import functools
import json
import lzma
import math
import subprocess
import time


FLAT = "Lorenzo + xz"  # name in scripts/compare
XZ = {"id": lzma.FILTER_LZMA2, "preset": 9 | lzma.PRESET_EXTREME, "lc": 4, "pb": 0}


class Failure(Exception):
    """A program failed; the text says how."""


@dataclasses.dataclass(frozen=True)
class Run:
    """kg: relative to one mean of all frames, as in the papers; frame_kg: to that of each frame, as
    rlpcenc has it. psnr: Ramanathan's, dB, mean of frames."""
    method: str
    clusters: int
    components: int
    bpvf: float
    kg: float
    encode_seconds: float
    decode_seconds: float
    psnr: float = math.nan
    frame_kg: float = math.nan


class Bench:
    """`sequence`: measure.Sequence. `folder`: for streams, which are removed. KG errors are
    relative to one mean of all frames, as in the papers; target() is for the encoder, which has the
    mean of each frame."""

    def __init__(self, tools, sequence, folder, say=print):
        self.tools, self.sequence, self.folder, self.say = tools, sequence, folder, say
        self._runs = {}

    def call(self, tool, *arguments):
        """(standard output, seconds)"""
        start = time.monotonic()
        command = [self.tools / tool, *map(str, arguments)]
        try:
            done = subprocess.run(command, capture_output=True, text=True, check=False)
        except OSError as error:
            raise Failure(f"{command[0]}: {error.strerror}; leave out --bin to have the tools "
                          "built") from error
        # rlpcenc, 2: written, but the target was out of reach.
        if done.returncode not in ((0, 2) if tool == "rlpcenc" else (0,)):
            raise Failure(f"{tool} failed: {done.stderr.strip()}")
        return done.stdout, time.monotonic() - start

    @functools.cached_property
    def norm(self):
        """A KG error with the mean of each frame over that with one mean: a constant of the
        sequence, 1 or above."""
        mesh, points = self.sequence.mesh, self.sequence.points
        out, _ = self.call("rlpccmp", mesh, "--points-a", points, mesh, "--points-b", points,
                           "--json", "--quiet")
        found = json.loads(out)["metrics"]
        return found["rms_sequence_spread"] / found["rms_spread"] if found["rms_spread"] else 1.0

    def target(self, kg):
        """Options of rlpcenc for a KG error as in the papers."""
        return ["--kg", f"{kg * self.norm:.6g}"]

    def encode(self, settings, use):
        """use(stream, order map, seconds) of a stream with these settings."""
        stream, order = self.folder / "stream.rlpc", self.folder / "stream.order"
        try:
            _, seconds = self.call("rlpcenc", self.sequence.mesh, "--points", self.sequence.points,
                                   "-o", stream, "--gof", "all", "--order-map", order, *settings)
            return use(stream, order, seconds)
        finally:
            stream.unlink(missing_ok=True)
            order.unlink(missing_ok=True)

    def measure(self, stream, order, *options):
        out, _ = self.call("rlpccmp", self.sequence.mesh, "--points-a", self.sequence.points,
                           stream, "--order-map", order, "--json", *options)
        return json.loads(out)

    def run(self, method, settings, clusters=0, components=0):
        """Clusters and components name the run; the settings must contain them."""
        key = (method, *map(str, settings))
        if key not in self._runs:
            def use(stream, order, encode_seconds):
                _, decode_seconds = self.call("rlpcdec", stream, "--verify")
                found = self.measure(stream, order)
                metrics = found["metrics"]
                psnr = metrics["ramanathan_psnr_db"]
                return Run(method, clusters, components, found["bpvf"],
                           metrics["kg_sequence_error_percent"], encode_seconds, decode_seconds,
                           math.inf if psnr is None else psnr, metrics["kg_error_percent"])
            run = self._runs[key] = self.encode(settings, use)
            what = ", ".join([f"N = {clusters:2d}"] * (clusters > 0)
                             + [f"L = {components:3d}"] * (components > 0)
                             + [f"--kg {settings[-1]}"] * (clusters == 0))
            self.say(f"{method:14}  {what:15}  {run.bpvf:7.3f} bpvf  KG {run.kg:.4f} %")
        return self._runs[key]

    def flat(self, bits):
        """The Lorenzo predictor in space and time, on a grid of so many bits: as FLAT encodes."""
        if ("flat", bits) not in self._runs:
            coded, order, out, mesh = (self.folder / f"flat.{kind}"
                                       for kind in ("coded", "order", "pc2", "obj"))
            files = (self.sequence.mesh, self.sequence.points)
            try:
                self.call("peer_codec", "order", "lorenzo", *files, "-o", order)
                _, encode_seconds = self.call("peer_codec", "encode", "lorenzo", *files, "--bits",
                                              bits, "-o", coded)
                _, decode_seconds = self.call("peer_codec", "decode", "lorenzo", coded,
                                              "--order-map", order, "-o", out)
                size = len(lzma.compress(coded.read_bytes(), filters=[XZ]))
                found, _ = self.call("rlpccmp", files[0], "--points-a", files[1], files[0],
                                     "--points-b", out, "--json", "--quiet")
                metrics = json.loads(found)["metrics"]
            finally:
                for path in (coded, order, out, mesh):
                    path.unlink(missing_ok=True)
            run = Run(FLAT, 0, 0, 8 * size / self.sequence.size,
                      metrics["kg_sequence_error_percent"], encode_seconds, decode_seconds,
                      frame_kg=metrics["kg_error_percent"])
            self._runs["flat", bits] = run
            self.say(f"{FLAT:14}  {f'{bits} bits':15}  {run.bpvf:7.3f} bpvf  KG {run.kg:.4f} %")
        return self._runs["flat", bits]

    def info(self, settings, *options):
        """Report of rlpcinfo on a stream with these settings."""
        return self.encode(settings, lambda stream, *_: json.loads(
            self.call("rlpcinfo", stream, "--json", *options)[0]))

    def frames(self, settings, use=lambda stream: None):
        """Metrics of each frame, as rows of rlpccmp; and use(stream)."""
        path = self.folder / "frames.tmp.csv"

        def measured(stream, order, _):
            self.measure(stream, order, "--csv", path)
            with open(path, newline="", encoding="utf-8") as file:
                return list(csv.DictReader(file)), use(stream)
        try:
            return self.encode(settings, measured)
        finally:
            path.unlink(missing_ok=True)

    def frame_errors(self, settings):
        """RMS error of each frame, in units."""
        key = ("frames", *map(str, settings))
        if key not in self._runs:
            self._runs[key] = [float(row["rms_error"]) for row in self.frames(settings)[0]]
        return self._runs[key]
