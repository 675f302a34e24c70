"""Figure 2 of the RLPCA paper: paths of vertices in world coordinates, and in the local coordinate
frame of the seed triangle in which each moves least."""

import array
import dataclasses
import math

HEAD = 32  # bytes of a point cache before the frames


@dataclasses.dataclass
class Path:
    vertex: int
    world: list  # [frame], (x, y, z)
    local: list


def _minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _unit(a):
    length = math.sqrt(_dot(a, a))
    return tuple(x / length for x in a) if length > 0 else (0.0, 0.0, 0.0)


def local_coordinates(point, seed):
    """In the frame of a triangle: origin in the middle of p1 and p2, x along them, z normal."""
    p1, p2, p3 = seed
    x = _unit(_minus(p2, p1))
    z = _unit(_cross(x, _minus(p3, p1)))
    away = _minus(point, tuple((a + b) / 2 for a, b in zip(p1, p2)))
    return tuple(_dot(axis, away) for axis in (x, _cross(z, x), z))


def total_motion(path):
    return sum(math.dist(a, b) for a, b in zip(path, path[1:]))


def spread(path):
    """RMS distance from the mean position."""
    mean = tuple(sum(c) / len(path) for c in zip(*path))
    return math.sqrt(sum(math.dist(p, mean) ** 2 for p in path) / len(path))


class Positions:
    """Frames of a point cache."""

    def __init__(self, sequence):
        self.num_vertices, self.num_frames = sequence.num_vertices, sequence.num_frames
        self._values = array.array("f")
        with open(sequence.points, "rb") as file:
            file.seek(HEAD)
            self._values.fromfile(file, 3 * sequence.size)

    def path(self, vertex):
        starts = range(3 * vertex, len(self._values), 3 * self.num_vertices)
        return [tuple(self._values[s:s + 3]) for s in starts]

    def frame(self, f):
        first = 3 * f * self.num_vertices
        flat = self._values[first:first + 3 * self.num_vertices]
        return list(zip(flat[0::3], flat[1::3], flat[2::3]))


def distant_vertices(points, count, but=()):
    """Each the farthest from those before it; the first, from the centre."""
    centre = tuple(sum(c) / len(points) for c in zip(*points))
    distance = [math.dist(p, centre) for p in points]
    chosen = []
    while len(chosen) < min(count, len(points) - len(but)):
        for v in but:
            distance[v] = -1.0
        v = max(range(len(points)), key=distance.__getitem__)
        if not chosen:
            distance = [math.inf] * len(points)
        chosen.append(v)
        distance = [min(d, math.dist(p, points[v])) for d, p in zip(distance, points)]
    return chosen


def paths(positions, seeds, count=6):
    """Paths of distant vertices. `seeds`: three vertices each."""
    seed_paths = [list(zip(*(positions.path(v) for v in seed))) for seed in seeds]
    found = []
    used = {v for seed in seeds for v in seed}
    for vertex in distant_vertices(positions.frame(0), count, used):
        world = positions.path(vertex)
        local = min(([local_coordinates(p, s) for p, s in zip(world, seed)]
                     for seed in seed_paths), key=total_motion)
        found.append(Path(vertex, world, local))
    return found


def projected(all_paths):
    """The paths on the two widest axes, in 0 to 1 of the wider, as in the figure."""
    points = [p for path in all_paths for p in path]
    lows = [min(c) for c in zip(*points)]
    widths = [max(c) - low for c, low in zip(zip(*points), lows)]
    i, j = sorted(sorted(range(3), key=lambda c: -widths[c])[:2])
    width = max(widths) or 1.0
    return [[((p[i] - lows[i]) / width, (p[j] - lows[j]) / width) for p in path]
            for path in all_paths]
