"""Triangles as three.js draws them, source and decoded: which belong together, and how far apart
they are."""

import array
import collections
import dataclasses
import itertools
import json
import math
import pathlib

import gltf_file
import measure

HERE = pathlib.Path(__file__).resolve().parent
UV_STEP = 1 / 4096
# Vertices nearer than this, in diagonals of the first frame, coincide: rounding of sums.
COINCIDENT = 1e-9
# RMS distances of triangles that differ by less, in diagonals, do not tell them apart.
EQUAL = 1e-4
MAX_CANDIDATES = 8


@dataclasses.dataclass
class Soup:
    positions: list  # per sample: x, y, z of each corner
    normals: list  # per sample: x, y, z of each corner; empty: none
    uv: list  # per set: u, v of each corner
    vertices: list  # index at each corner
    clips: list  # names

    @property
    def num_corners(self):
        return len(self.vertices)

    def corner(self, sample, corner):
        return self.positions[sample][3 * corner:3 * corner + 3]


def _doubles(path, per_part):
    data = array.array("d")
    data.frombytes(path.read_bytes())
    return [data[i:i + per_part] for i in range(0, len(data), per_part)] if per_part else []


def sample(packages, glb, samples, folder):
    """`samples`: (clip, frame)."""
    stem = folder / f"{glb.stem}-drawn"
    times = [[clip, frame / gltf_file.FPS] for clip, frame in samples]
    said = json.loads(packages.node(HERE / "sample.mjs", packages.three, glb, stem,
                                    json.dumps(times)))
    parts = {name: stem.with_name(f"{stem.name}.{name}") for name in ("positions", "normals", "uv")}
    corners = said["corners"]
    soup = Soup(_doubles(parts["positions"], 3 * corners),
                _doubles(parts["normals"], 3 * corners) if said["hasNormals"] else [],
                _doubles(parts["uv"], 2 * corners)[:said["numSets"]],
                said["vertices"], said["clips"])
    for path in parts.values():
        path.unlink()
    return soup


def diagonal(soup):
    axes = [soup.positions[0][c::3] for c in range(3)]
    return math.dist([min(a) for a in axes], [max(a) for a in axes])


class Grid:
    """Points of space by cell."""

    def __init__(self, cell):
        self.cell = cell
        self.cells = collections.defaultdict(list)

    def key(self, point):
        return tuple(math.floor(x / self.cell) for x in point)

    def add(self, point, value):
        self.cells[self.key(point)].append(value)

    def near(self, point, rings=1):
        """All within `rings` cells, and some beyond."""
        a, b, c = self.key(point)
        steps = range(-rings, rings + 1)
        return [value for i, j, k in itertools.product(steps, steps, steps)
                for value in self.cells.get((a + i, b + j, c + k), ())]


def _centre(soup, triangle):
    p = soup.positions[0][9 * triangle:9 * triangle + 9]
    return [(p[c] + p[c + 3] + p[c + 6]) / 3 for c in range(3)]


def _turned(triangle, turn):
    """Its corners, beginning with another."""
    return [3 * triangle + (turn + i) % 3 for i in range(3)]


def _squares(a, corners_a, b, corners_b, samples):
    total = 0.0
    for s in samples:
        p, q = a.positions[s], b.positions[s]
        for i, j in zip(corners_a, corners_b):
            total += ((p[3 * i] - q[3 * j]) ** 2 + (p[3 * i + 1] - q[3 * j + 1]) ** 2
                      + (p[3 * i + 2] - q[3 * j + 2]) ** 2)
    return total


def _surface_distance(a, corners_a, b, corners_b):
    """Errors of texture coordinates, beyond those of quantising, and of normals in the first
    sample."""
    pairs = list(zip(corners_a, corners_b))
    uv = max((_largest_difference(p, q, pairs, 2) for p, q in zip(a.uv, b.uv)), default=0.0)
    normals = (_largest_difference(a.normals[0], b.normals[0], pairs, 3)
               if a.normals and b.normals else 0.0)
    return max(uv - 4 * UV_STEP, 0.0), normals


def _largest_difference(p, q, pairs, width):
    """Largest difference of values that both have; the others are NaN."""
    differences = (abs(p[width * i + c] - q[width * j + c]) for i, j in pairs for c in range(width))
    return max((x for x in differences if not math.isnan(x)), default=0.0)


def is_degenerate(soup, triangle):
    """Two of its corners coincide in every sample; encoders drop it."""
    corners = [3 * triangle + i for i in range(3)]
    return any(all(soup.corner(s, i) == soup.corner(s, j) for s in range(len(soup.positions)))
               for i, j in itertools.combinations(corners, 2))


def match(source, other):
    """(found: per corner of the source, the corner of the other that draws it, -1 for corners of
    degenerate triangles; alternatives: per triangle, all corners that may draw its own, where
    triangles lie upon each other).

    Each triangle goes to the one whose corners move most alike; among those that move equally
    well, to that with the nearest texture coordinates and normals."""
    size = diagonal(source)
    grid = Grid(size / 100)
    for triangle in range(other.num_corners // 3):
        grid.add(_centre(other, triangle), triangle)
    everything = range(len(source.positions))
    found, alternatives = array.array("q", [-1]) * source.num_corners, {}
    for triangle in range(source.num_corners // 3):
        if is_degenerate(source, triangle):
            continue
        own = [3 * triangle + i for i in range(3)]
        centre = _centre(source, triangle)
        near = next((c for rings in (1, 2, 5) if (c := grid.near(centre, rings))), None)
        if near is None:
            raise measure.Failure("a triangle of the source is nowhere in the decoded file")
        first = sorted((_squares(source, own, other, _turned(t, turn), [0]), t, turn)
                       for t in near for turn in range(3))
        ranked = [(_squares(source, own, other, _turned(t, turn), everything), t, turn)
                  for _, t, turn in first[:MAX_CANDIDATES]]
        farthest = 1.1 * math.sqrt(min(ranked)[0]) + EQUAL * size * math.sqrt(3 * len(everything))
        equal = [_turned(t, turn) for squares, t, turn in ranked if math.sqrt(squares) <= farthest]
        chosen = min(equal, key=lambda turned: _surface_distance(source, own, other, turned))
        found[3 * triangle:3 * triangle + 3] = array.array("q", chosen)
        if len(equal) > 1:
            alternatives[triangle] = equal
    return found, alternatives


def kg_error_percent(source, other, found):
    """Error of the corners drawn in the samples, relative to the corners without their mean."""
    error = energy = 0.0
    used = [i for i, j in enumerate(found) if j >= 0]
    for p, q in zip(source.positions, other.positions):
        for c in range(3):
            own = [p[3 * i + c] for i in used]
            mean = math.fsum(own) / len(own)
            energy += math.fsum((x - mean) ** 2 for x in own)
            error += math.fsum((x - q[3 * found[i] + c]) ** 2 for x, i in zip(own, used))
    return 100 * math.sqrt(error / energy) if energy else None


def uv_error_steps(source, other, found):
    """The largest error of a texture coordinate that both have, in steps of 1/4096; None: there
    are none."""
    if not source.uv or not other.uv:
        return None
    pairs = [(i, j) for i, j in enumerate(found) if j >= 0]
    return max(_largest_difference(p, q, pairs, 2) for p, q in zip(source.uv, other.uv)) / UV_STEP


def normal_errors_degrees(source, other, found, sample_number):
    """(mean, 99th percentile, largest) angle between normals of corners; None: one of the files
    has none, or none of a length where the other has one."""
    if not source.normals or not other.normals:
        return None
    p, q = source.normals[sample_number], other.normals[sample_number]
    angles = []
    for i, j in enumerate(found):
        if j < 0:
            continue
        a, b = p[3 * i:3 * i + 3], q[3 * j:3 * j + 3]
        lengths = math.hypot(*a) * math.hypot(*b)
        if lengths > 0:
            cross = math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                               a[0] * b[1] - a[1] * b[0])
            angles.append(math.degrees(math.atan2(cross, sum(x * y for x, y in zip(a, b)))))
    if not angles:
        return None
    angles.sort()
    return math.fsum(angles) / len(angles), angles[99 * len(angles) // 100], angles[-1]


def _groups(soup):
    """Vertices that coincide in the first sample, at least two each, as corners of theirs."""
    corners_of = collections.defaultdict(list)
    for corner, vertex in enumerate(soup.vertices):
        corners_of[vertex].append(corner)
    limit = COINCIDENT * diagonal(soup)
    grid = Grid(10 * limit)
    groups = []
    for corners in corners_of.values():
        point = soup.corner(0, corners[0])
        group = next((g for g in grid.near(point)
                      if math.dist(point, soup.corner(0, g[0][0])) <= limit), None)
        if group is None:
            group = []
            groups.append(group)
            grid.add(point, group)
        group.append(corners)
    return [group for group in groups if len(group) > 1]


def _gap(soup, corners, samples):
    """The largest distance from the first corner in any sample."""
    return max(math.dist(soup.corner(s, corners[0]), soup.corner(s, c))
               for s in samples for c in corners)


@dataclasses.dataclass
class Cracks:
    groups: int  # groups of source vertices that coincide in the first frame
    together: int  # number of these closed in all samples of the source
    closed: int  # number of these closed in all samples of the other
    largest_gap_percent: float  # among those, per cent of the diagonal


def _meet(other, group, found, alternatives):
    """Whether corners that may draw those of the group have one path."""
    common = None
    for corner in itertools.chain.from_iterable(group):
        if found[corner] < 0:
            continue
        choices = alternatives.get(corner // 3)
        places = {corners[corner % 3] for corners in choices} if choices else {found[corner]}
        seen = {tuple(tuple(other.corner(s, place)) for s in range(len(other.positions)))
                for place in places}
        common = seen if common is None else common & seen
    return common is None or bool(common)


def cracks(source, other, found, alternatives):
    limit = COINCIDENT * diagonal(source)
    samples = range(len(source.positions))
    groups = _groups(source)
    together = [g for g in groups
                if _gap(source, [corners[0] for corners in g], samples) <= limit]
    gaps = []
    for group in together:
        drawn = [found[c] for corners in group for c in corners if found[c] >= 0]
        gap = _gap(other, drawn, samples) if drawn else 0.0
        gaps.append(0.0 if _meet(other, group, found, alternatives) else gap)
    return Cracks(len(groups), len(together), sum(gap <= limit for gap in gaps),
                  100 * max(gaps, default=0.0) / diagonal(source))
