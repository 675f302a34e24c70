"""The paths of vertices in two point caches: which belong together when one codec has reordered,
merged or split vertices."""

import array
import itertools
import math
import struct
import sys

import measure
import soup

SAMPLES = 13
HEAD = struct.Struct("<12siiffi")


class PointCache:
    """Frames of a .pc2 file, read as they are needed."""

    def __init__(self, path):
        self._file = open(path, "rb")
        head = self._file.read(HEAD.size)
        if len(head) < HEAD.size or not head.startswith(b"POINTCACHE2"):
            raise measure.Failure(f"{path}: not a point cache (.pc2)")
        _, _, self.num_vertices, _, _, self.num_frames = HEAD.unpack(head)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()

    def frame(self, number):
        self._file.seek(HEAD.size + 12 * self.num_vertices * number)
        values = array.array("f")
        values.fromfile(self._file, 3 * self.num_vertices)
        if sys.byteorder == "big":
            values.byteswap()
        return values


def joined_frames(source_clips, other_clips):
    """Per frame of the source, the frame of the other at the same time of the same clip. Where a
    clip of the other ends earlier, its last frame stays, as in viewers."""
    if len(source_clips) != len(other_clips):
        raise measure.Failure(f"{len(source_clips)} clips became {len(other_clips)}")
    return [b.first_frame + min(frame, b.num_frames - 1)
            for a, b in zip(source_clips, other_clips) for frame in range(a.num_frames)]


def nearest(source, other, frames):
    """Per vertex of the source, the vertex of the other whose path is nearest in some frames."""
    chosen = [round(i * (source.num_frames - 1) / (SAMPLES - 1)) for i in range(SAMPLES)]
    a = [source.frame(f) for f in dict.fromkeys(chosen)]
    b = [other.frame(frames[f]) for f in dict.fromkeys(chosen)]
    axes = [a[0][c::3] for c in range(3)]
    size = math.dist([min(x) for x in axes], [max(x) for x in axes])
    grid = soup.Grid(size / 200)
    for v in range(other.num_vertices):
        grid.add(b[0][3 * v:3 * v + 3], v)

    def squares(v, w):
        return sum(math.dist(p[3 * v:3 * v + 3], q[3 * w:3 * w + 3]) ** 2 for p, q in zip(a, b))

    found = []
    for v in range(source.num_vertices):
        near = next((c for rings in (1, 2, 5, 20)
                     if (c := grid.near(a[0][3 * v:3 * v + 3], rings))), None)
        if near is None:
            raise measure.Failure("a vertex of the source is nowhere in the decoded file")
        found.append(min(near, key=lambda w: squares(v, w)))
    return found


def write_matched(source, other, frames, found, target):
    """`target`: a .pc2 file with a vertex of the other for each of the source."""
    with open(target, "wb") as file:
        file.write(HEAD.pack(b"POINTCACHE2\0", 1, source.num_vertices, 0.0, 1.0,
                             source.num_frames))
        for frame in frames:
            p = other.frame(frame)
            values = array.array("f", itertools.chain.from_iterable(
                p[3 * w:3 * w + 3] for w in found))
            if sys.byteorder == "big":
                values.byteswap()
            values.tofile(file)
