"""Streams with temporal layers: the cost of layers, and each stream that is cut from them compared
with one that is made of the same frames alone."""

import dataclasses
import json
import pathlib
import tempfile

import measure
import report
from bench import Bench

PERIOD = 16
LAYERS = 3
HEAD = 32  # bytes of a point cache before the frames
COUNT = 28  # offset of the number of frames


def depths(num_frames, period):
    """[frame]: its depth in a dyadic pattern (8.19.1 MakeFrameOrder)."""
    found = [0] * num_frames
    for first in range(0, num_frames - 1, period):
        spans = [(first, min(first + period, num_frames - 1), 1)]
        while spans:
            a, b, depth = spans.pop()
            if b - a > 1:
                middle = (a + b) // 2
                found[middle] = depth
                spans += [(a, middle, depth + 1), (middle, b, depth + 1)]
    return found


def frames_of(num_frames, layers):
    """[layers kept - 1]: the frames that are left."""
    max_depths = PERIOD.bit_length()  # depths
    layer = [max(0, depth - max_depths + layers) for depth in depths(num_frames, PERIOD)]
    return [[f for f in range(num_frames) if layer[f] < kept] for kept in range(1, layers + 1)]


def pattern(period):
    return ["--frame-pattern", f"dyadic:{period}" if period > 1 else "previous"]


def write_frames(points, frames, path):
    """Some frames of a point cache, as another."""
    data = points.read_bytes()
    count = int.from_bytes(data[COUNT:HEAD], "little")
    size = (len(data) - HEAD) // count
    with open(path, "wb") as file:
        file.write(data[:COUNT] + len(frames).to_bytes(4, "little"))
        for f in frames:
            file.write(data[HEAD + f * size:HEAD + (f + 1) * size])


@dataclasses.dataclass(frozen=True)
class Cut:
    layers: int  # kept
    num_frames: int
    bytes: int
    kg: float  # KG error of its frames, relative to one mean of them
    alone: int  # bytes of a stream of the same frames alone, with this error


class TemporalCuts:
    """settings: of a stream, without pattern and error."""

    def __init__(self, bench, settings):
        self.bench, self.settings = bench, settings

    def _size(self, bench, target, options):
        settings = [*self.settings, *target, *options]
        return bench.encode(settings, lambda stream, *_: stream.stat().st_size)

    def _cut(self, stream, order, layers, frames):
        """The stream with its lowest temporal layers, and a stream of those frames alone."""
        mesh, points = self.bench.sequence.mesh, self.bench.sequence.points
        with tempfile.TemporaryDirectory(dir=self.bench.folder) as name:
            folder = pathlib.Path(name)
            cut, decoded, kept, alone = (folder / file for file in (
                "cut.rlpc", "decoded.pc2", "kept.pc2", "alone.pc2"))
            self.bench.call("rlpcinfo", stream, "--extract", f"temporal={layers}", "-o", cut)
            self.bench.call("rlpcdec", cut, "-o", decoded)
            write_frames(points, frames, alone)
            write_frames(decoded, frames, kept)
            found, _ = self.bench.call(
                "rlpccmp", mesh, "--points-a", alone, decoded.with_suffix(".obj"), "--points-b",
                kept, "--order-map", order, "--json", "--quiet")
            metrics = json.loads(found)["metrics"]
            kg = metrics["kg_sequence_error_percent"]
            target = ["--kg", f"{metrics['kg_error_percent']:.6g}"]
            bench = Bench(self.bench.tools, measure.open_sequence(mesh, alone), folder)
            size = self._size(bench, target, pattern(PERIOD >> (LAYERS - layers)))
            return Cut(layers, len(frames), cut.stat().st_size, kg, size)

    def run(self, kg):
        """(bytes in one layer, bytes in LAYERS, [Cut])."""
        kept = frames_of(self.bench.sequence.num_frames, LAYERS)
        target = self.bench.target(kg)
        one = self._size(self.bench, target, pattern(PERIOD))
        layered = [*self.settings, *target, *pattern(PERIOD), "--temporal-layers", LAYERS]

        def use(stream, order, _):
            return stream.stat().st_size, [self._cut(stream, order, layers, kept[layers - 1])
                                           for layers in range(1, LAYERS)]
        size, cuts = self.bench.encode(layered, use)
        self.bench.say(f"temporal layers at {kg:g} %: {size / one:.3f} of one; cut, against the "
                       "same frames alone: "
                       + ", ".join(f"{cut.bytes / cut.alone:.3f}" for cut in cuts))
        return one, size, cuts


def table(cuts, targets):
    """cuts: TemporalCuts."""
    rows = []
    for kg in targets:
        one, size, found = cuts.run(kg)
        rows.append([f"{kg:g}", f"all {LAYERS}", str(cuts.bench.sequence.num_frames), str(size), "",
                     f"one layer: {one}", f"{size / one:.3f}"])
        rows += [[f"{kg:g}", str(cut.layers), str(cut.num_frames), str(cut.bytes), f"{cut.kg:.4f}",
                  f"these frames alone: {cut.alone}", f"{cut.bytes / cut.alone:.3f}"]
                 for cut in found]
    title = (f"Temporal layers: dyadic:{PERIOD} in {LAYERS} layers, and its cuts, compared with "
             "streams made for it (learned weights)")
    return report.Table(title, ["KG, %", "layers", "frames", "bytes", "KG of these frames, %",
                                "bytes of", "ratio"], rows)
