"""Single frames of streams with patches: types of vertices as in the registration paper,
compression ratios, PSNR; and how long clustering takes."""

import math
import statistics
import struct

import plots
import registration_published as published
from rlpca_paths import HEAD

TYPES = ("motion_without_residuals", "motion_with_residuals", "from_neighbours")
NUM_FRAMES = 28  # place of the number of frames in the head of a point cache


class Detail:
    """A stream. info: of rlpcinfo --json; rows: of rlpccmp --csv; picture: of its patches."""

    def __init__(self, info, rows, picture):
        self.info, self.rows, self.picture = info, rows, picture
        self.num_patches = max(gof["num_patches"] for gof in info["gofs"])

    def _frames(self):
        """(frame, vertices of each type) of those with motions: neither the first of a GOF nor
        a repetition."""
        for gof in self.info["gofs"]:
            for i, modes in enumerate(gof.get("vertices_of_frame", ())):
                counts = [modes[name] for name in TYPES]
                if i > 0 and sum(counts) > 0:
                    yield gof["first_frame"] + i, counts

    def types(self, which):
        """(frame, vertices) of type which + 1."""
        return [(frame, counts[which]) for frame, counts in self._frames()]

    @property
    def has_motions(self):
        return any(self._frames())

    @property
    def means(self):
        """Vertices of each type, average of frames."""
        columns = list(zip(*(counts for _, counts in self._frames())))
        return [statistics.fmean(column) for column in columns] if columns else [0.0] * len(TYPES)

    @property
    def moved(self):
        """The share of types 1 and 2."""
        return sum(self.means[:2]) / self.info["num_vertices"]

    def ratios(self):
        """(frame, compression ratio), of the bytes of its units."""
        sizes = {}
        for gof in self.info["gofs"]:
            for unit in gof["slices"]:
                frame = gof["first_frame"] + unit["frame_idx"]
                sizes[frame] = sizes.get(frame, 0) + unit["bytes"]
        raw = published.RAW / 8 * self.info["num_vertices"]
        return [(frame, raw / size) for frame, size in sorted(sizes.items())]

    def psnr(self):
        """(frame, dB), Ramanathan's, of frames that are not exact."""
        found = [(int(row["frame"]), float(row["ramanathan_psnr_db"])) for row in self.rows]
        return [(frame, psnr) for frame, psnr in found if math.isfinite(psnr)]


def mean_motion(positions):
    """[frame]: mean distance of vertices from the frame before; 0 in the first.
    positions: rlpca_paths.Positions."""
    found, before = [0.0], positions.frame(0)
    for f in range(1, positions.num_frames):
        now = positions.frame(f)
        found.append(statistics.fmean(map(math.dist, now, before)))
        before = now
    return found


def by_motion(motion, ratios):
    """Mean compression ratio of the frames with less than the median motion, and of the others; the
    first frame does not count. ratios: (frame, ratio)."""
    frames = dict(ratios)
    middle = statistics.median(motion[f] for f in frames if f > 0)
    calm = [ratio for f, ratio in frames.items() if f > 0 and motion[f] < middle]
    fast = [ratio for f, ratio in frames.items() if f > 0 and motion[f] >= middle]
    return tuple(statistics.fmean(part) if part else None for part in (calm, fast))


def csv_rows(details):
    """Head and rows of a CSV of all frames. details: by clustering."""
    head, columns, frames = ["frame"], [], set()
    for name, detail in details.items():
        detail_types = {**{f"type_{i + 1}": dict(detail.types(i)) for i in range(len(TYPES))},
                        "ratio": dict(detail.ratios()), "ramanathan_psnr_db": dict(detail.psnr())}
        head += [f"{name}_{what}" for what in detail_types]
        columns += detail_types.values()
        frames.update(detail_types["ratio"])
    return head, [[frame, *(column.get(frame, "") for column in columns)]
                  for frame in sorted(frames)]


def series(name, points, colour):
    return plots.Series(name, points, colour, marker="none")


def first_frames(points, count, path):
    """Writes the first frames of a point cache; it has `count` at least."""
    with open(points, "rb") as file:
        head = bytearray(file.read(HEAD))
        (num_vertices,) = struct.unpack_from("<i", head, 16)
        frames = file.read(12 * num_vertices * count)
    struct.pack_into("<i", head, NUM_FRAMES, count)
    path.write_bytes(head + frames)


def clustering_seconds(bench, settings, times):
    """Seconds that the first two frames take with each of the settings, by name: the least of so
    many encodings."""
    points, stream = (bench.folder / name for name in ("two.tmp.pc2", "two.tmp.rlpc"))
    try:
        first_frames(bench.sequence.points, min(2, bench.sequence.num_frames), points)
        return {name: min(bench.call("rlpcenc", bench.sequence.mesh, "--points", points, "-o",
                                     stream, "--gof", "all", *options)[1] for _ in range(times))
                for name, options in settings.items()}
    finally:
        points.unlink(missing_ok=True)
        stream.unlink(missing_ok=True)
