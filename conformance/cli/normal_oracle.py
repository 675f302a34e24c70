"""The smallest errors of normals that a stream can have, which a test computes from decoded
positions and the normals of the input (F.8.5): a normal either follows from the surface of each
frame, or is a unit vector of the first frame that turns with the surface around its vertex."""

import math

from gltf_scene import cross, degrees, minus, unit

SERVES = 0.3  # degrees: surfaces that are right within these are taken as they are
POWERS = 7
UNCERTAIN = 1e-12  # no rotation is the nearest (F.8.5)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def plus(a, b, weight=1.0):
    return [a[i] + weight * b[i] for i in range(3)]


class Decoded:
    """Frames as OBJ files: positions of the stream, corners with numbers, normals."""

    def __init__(self, number_of):
        self.number_of = number_of
        self.positions, self.normals, self.corners = [], [], []

    def add(self, path):
        xyz, uv, normals, corners, found = [], [], [], [], {}
        for line in path.read_text().splitlines():
            words = line.split()
            if words[:1] == ["v"]:
                xyz.append([float(x) for x in words[1:4]])
            elif words[:1] == ["vt"]:
                uv.append([float(words[1]), 1 - float(words[2])])
            elif words[:1] == ["vn"]:
                normals.append([float(x) for x in words[1:4]])
            elif words[:1] == ["f"]:
                for word in words[1:]:
                    v, t, n = word.split("/")
                    number = self.number_of(uv[int(t) - 1])
                    found[number] = normals[int(n) - 1]
                    corners.append((int(v) - 1, number))
        self.positions.append(xyz)
        self.normals.append(found)
        self.corners = corners


def product_of_gaps(m, q):
    """Between the eigenvalue of q and the three others: the sum of the principal minors of the
    matrix less that eigenvalue."""
    largest = sum(q[i] * m[i][j] * q[j] for i in range(4) for j in range(4))
    rest = [[(largest if i == j else 0.0) - m[i][j] for j in range(4)] for i in range(4)]
    total = 0.0
    for left_out in range(4):
        rows = [[rest[i][j] for j in range(4) if j != left_out] for i in range(4) if i != left_out]
        total += dot(rows[0], cross(rows[1], rows[2]))
    return total


def square(m):
    """Of a symmetric matrix with four rows."""
    return [[a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] for b in m] for a in m]


def turn_between(before, after):
    """The rotation nearest to what turns some vectors into others, as rows (Horn 1987); None: none
    is nearest."""
    s = [[sum(a[i] * b[j] for a, b in zip(before, after)) for j in range(3)] for i in range(3)]
    bound = math.sqrt(sum(dot(a, a) for a in before) * sum(dot(b, b) for b in after))
    if not bound > 0:
        return None
    x, y, z = s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]
    xy, yz, zx = s[0][1] + s[1][0], s[1][2] + s[2][1], s[2][0] + s[0][2]
    m = [[s[0][0] + s[1][1] + s[2][2], x, y, z], [x, s[0][0] - s[1][1] - s[2][2], xy, zx],
         [y, xy, s[1][1] - s[0][0] - s[2][2], yz], [z, zx, yz, s[2][2] - s[0][0] - s[1][1]]]
    horn = [[x / bound for x in row] for row in m]
    m = [[horn[i][j] + (i == j) for j in range(4)] for i in range(4)]  # no root below 0
    for _ in range(POWERS):
        m = square(m)
        size = max(m[0][0], m[1][1], m[2][2], m[3][3])
        m = [[x / size for x in row] for row in m]
    best = max(range(4), key=lambda i: m[i][i])
    length = math.sqrt(sum(x * x for x in m[best]))
    q = [x / length for x in m[best]]
    if not abs(product_of_gaps(horn, q)) > UNCERTAIN:
        return None
    w, x, y, z = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


class Oracle:
    """frames: of a scene, {number: (normal, area)}; decoded: the same frames."""

    def __init__(self, frames, decoded):
        self.frames, self.decoded = frames, decoded
        self.around = {}  # vertex: corners
        self.vertex_of = {}
        for c, (v, number) in enumerate(decoded.corners):
            self.around.setdefault(v, []).append(c)
            self.vertex_of[number] = v
        self.turns = {}
        self.triangles = {}

    def triangle(self, frame, c):
        """Vectors of the two edges at a corner, and their product."""
        if (frame, c) not in self.triangles:
            first = c - c % 3
            v, p, q = (self.decoded.corners[first + (c + k) % 3][0] for k in range(3))
            xyz = self.decoded.positions[frame]
            a, b = minus(xyz[p], xyz[v]), minus(xyz[q], xyz[v])
            self.triangles[frame, c] = a, b, cross(a, b)
        return self.triangles[frame, c]

    def is_same(self, a, b):
        """Whether two numbers have one normal."""
        return all(a not in frame or b not in frame
                   or max(map(abs, minus(frame[a][0], frame[b][0]))) < 0.001
                   for frame in self.frames)

    def by_surface(self, number, weight):
        """In each frame, the normal that the surface gives."""
        v = self.vertex_of[number]
        own = [c for c in self.around[v] if self.is_same(number, self.decoded.corners[c][1])]
        normals = []
        for f in range(len(self.frames)):
            total = [0.0] * 3
            for c in own:
                a, b, n = self.triangle(f, c)
                size = math.sqrt(dot(n, n))
                if size > 0:
                    scale = {"area": 1.0, "equal": 1 / size,
                             "angle": math.atan2(size, dot(a, b)) / size}[weight]
                    total = plus(total, n, scale)
            normals.append(unit(total))
        return normals

    def surroundings(self, frame, v):
        vectors, area = [], [0.0] * 3
        for c in self.around[v]:
            a, b, n = self.triangle(frame, c)
            vectors += [a, b]
            area = plus(area, n)
        root = dot(area, area) ** 0.25
        return vectors, [x / root for x in area] if root > 0 else None

    def turn(self, frame, v):
        if (frame, v) not in self.turns:
            (before, old), (after, new) = self.surroundings(0, v), self.surroundings(frame, v)
            if old and new:
                before, after = before + [old], after + [new]
            self.turns[frame, v] = turn_between(before, after)
        return self.turns[frame, v]

    def mean(self, number, angles):
        """angles: of each frame."""
        sizes = [frame.get(number, (None, 0.0))[1] for frame in self.frames]
        return sum(a * s for a, s in zip(angles, sizes)) / sum(sizes)

    def by_vector(self, number):
        """The mean error of the best unit vector; None: there is no surface in the first frame."""
        v = self.vertex_of[number]
        if self.turn(0, v) is None:
            return None
        at_first = []  # normals turned back
        for f, frame in enumerate(self.frames):
            turn, normal = self.turn(f, v), frame[number][0]
            at_first.append(normal if turn is None else
                            [sum(turn[i][j] * normal[i] for i in range(3)) for j in range(3)])
        total = [0.0] * 3
        for n, frame in zip(at_first, self.frames):
            total = plus(total, n, frame[number][1])
        seen = [n for n, frame in zip(at_first, self.frames) if frame[number][1] > 0]
        return min(self.mean(number, [degrees(n, other) for other in at_first])
                   for n in [unit(total), *seen] if any(n))

    def errors(self, numbers):
        """{number: degrees}: the smallest mean error of each."""
        best = None
        for weight in ("area", "equal", "angle"):
            found = {n: self.mean(n, [degrees(a, frame[n][0]) for a, frame in
                                      zip(self.by_surface(n, weight), self.frames)])
                     for n in numbers}
            if best is None or sum(found.values()) < sum(best.values()):
                best = found
        for n, error in best.items():
            if error > SERVES:
                vector = self.by_vector(n)
                best[n] = error if vector is None else min(error, vector)
        return best
