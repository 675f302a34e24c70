"""Random scenes of parts that appear, vanish, fold, mirror and bend, as .glb files, with a number
for each vertex in its texture coordinates, by which it is found again in decoded files."""

import json
import math
import struct

FRAMES = 31  # at 30 per second, of one second
GRID = 64    # numbers of vertices in a row of the texture


def uv_of(number):
    return [number % GRID / GRID, number // GRID / GRID]


def number_of(uv):
    return round(uv[0] * GRID) + GRID * round(uv[1] * GRID)


class Builder:
    """Collects the JSON and the binary chunk of a .glb file."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}],
                     "nodes": [], "meshes": [], "skins": [], "accessors": [], "bufferViews": [],
                     "animations": [{"channels": [], "samplers": []}]}
        self.chunk = b""

    def add(self, kind, component, rows, **others):
        letter = {5123: "H", 5125: "I", 5126: "f"}[component]
        flat = [x for row in rows for x in (row if isinstance(row, (list, tuple)) else [row])]
        data = struct.pack(f"<{len(flat)}{letter}", *flat)
        data += b"\0" * (-len(data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.chunk),
                                         "byteLength": len(data)})
        self.chunk += data
        accessor = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": component,
                    "count": len(rows), "type": kind, **others}
        if kind == "VEC3":
            accessor |= {"min": [min(r[c] for r in rows) for c in range(3)],
                         "max": [max(r[c] for r in rows) for c in range(3)]}
        if kind == "SCALAR" and component == 5126:
            accessor |= {"min": [min(rows)], "max": [max(rows)]}
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def channel(self, node, path, times, values, interpolation="LINEAR"):
        kind = {"translation": "VEC3", "scale": "VEC3", "rotation": "VEC4", "weights": "SCALAR"}
        animation = self.json["animations"][0]
        animation["samplers"].append({"input": self.add("SCALAR", 5126, times),
                                      "output": self.add(kind[path], 5126, values),
                                      "interpolation": interpolation})
        animation["channels"].append({"sampler": len(animation["samplers"]) - 1,
                                      "target": {"node": node, "path": path}})

    def write(self, path):
        document = {key: value for key, value in self.json.items() if value != []}
        document["buffers"] = [{"byteLength": len(self.chunk)}]
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        path.write_bytes(struct.pack("<III", 0x46546C67, 2, 28 + len(text) + len(self.chunk))
                         + struct.pack("<II", len(text), 0x4E4F534A) + text
                         + struct.pack("<II", len(self.chunk), 0x004E4942) + self.chunk)


def sheet(columns, rows, place):
    """A grid of vertices at place(s, t), and its triangles."""
    xyz = [place(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b, c, d = a + 1, a + columns + 2, a + columns + 1
            triangles += [[a, b, c], [a, c, d]]
    return xyz, triangles


def ball(_):
    def place(s, t):
        u, v = 2 * math.pi * s, math.pi * (0.02 + 0.96 * t)
        return [math.cos(u) * math.sin(v), -math.cos(v), -math.sin(u) * math.sin(v)]
    xyz, triangles = sheet(16, 10, place)
    return xyz, [list(p) for p in xyz], triangles


def box(random):
    size = [random.uniform(0.3, 1.0) for _ in range(3)]
    xyz, normals, triangles = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            def place(s, t, axis=axis, sign=sign):
                p = [0.0] * 3
                p[axis] = sign * size[axis]
                p[(axis + 1) % 3] = sign * (2 * s - 1) * size[(axis + 1) % 3]
                p[(axis + 2) % 3] = (2 * t - 1) * size[(axis + 2) % 3]
                return p
            side, faces = sheet(3, 3, place)
            normal = [0.0] * 3
            normal[axis] = float(sign)
            triangles += [[v + len(xyz) for v in t] for t in faces]
            xyz += side
            normals += [normal] * len(side)
    return xyz, normals, triangles


def tube(_):
    """Along y, with hard ends."""
    def side(s, t):
        return [0.4 * math.cos(-2 * math.pi * s), 4 * t - 2, 0.4 * math.sin(-2 * math.pi * s)]
    xyz, triangles = sheet(12, 12, side)
    normals = [[p[0] / 0.4, 0.0, p[2] / 0.4] for p in xyz]
    for y, sign in ((-2.0, -1), (2.0, 1)):
        first = len(xyz)
        xyz += [[0.4 * math.cos(-sign * 2 * math.pi * i / 12), y,
                 0.4 * math.sin(-sign * 2 * math.pi * i / 12)] for i in range(12)]
        xyz.append([0.0, y, 0.0])
        normals += [[0.0, float(sign), 0.0]] * 13
        triangles += [[first + 12, first + i, first + (i + 1) % 12] for i in range(12)]
    return xyz, normals, triangles


def shell(_):
    """A thin leaf of two layers, with the normals of a ball around it: not those of its faces."""
    def place(s, t):
        return [2 * s - 1, 0.2 * math.sin(3 * s), 1 - 2 * t]
    xyz, triangles = sheet(8, 8, place)
    count = len(xyz)
    normals = []
    for sign in (1, -1):
        for p in xyz:
            n = [p[0], 0.6 * sign, p[2]]
            length = math.sqrt(sum(x * x for x in n))
            normals.append([x / length for x in n])
    under = [[p[0], p[1] - 0.03, p[2]] for p in xyz]
    return xyz + under, normals, triangles + [[c + count, b + count, a + count]
                                              for a, b, c in triangles]


SHAPES = {"ball": ball, "box": box, "tube": tube, "shell": shell}
TIMES = [i / 10 for i in range(11)]


def rotation(axis, angle):
    length = math.sqrt(sum(x * x for x in axis))
    return [math.sin(angle / 2) * x / length for x in axis] + [math.cos(angle / 2)]


def turn(builder, node, random, max_angle=2.5):
    axis = [random.gauss(0, 1) for _ in range(3)]
    start = random.uniform(0, 6)
    angle = random.uniform(0.5, max_angle)
    builder.channel(node, "rotation", TIMES, [rotation(axis, start + angle * t) for t in TIMES])


def scaled(builder, node, scales, interpolation="LINEAR"):
    builder.channel(node, "scale", TIMES, scales, interpolation)


def appears(builder, node, random, part):
    """Grows from nothing, or nearly nothing, or a flat or a thin thing."""
    first = random.choice([[0, 0, 0], [1e-5] * 3, [1e-3] * 3, [1, 0, 1], [0, 1, 0]])
    step = random.randrange(1, 8)
    kind = random.choice(["LINEAR", "STEP"])
    scaled(builder, node, [first if i < step else [1, 1, 1] for i in range(11)], kind)
    if random.random() < 0.7:
        turn(builder, node, random)


def vanishes(builder, node, random, part):
    last = random.choice([[0, 0, 0], [1e-3] * 3])
    scaled(builder, node, [[1, 1, 1] if i < 5 else last for i in range(11)], "STEP")
    turn(builder, node, random)


def flips_past(builder, node, random, part):
    """Seen in a few frames only."""
    shown = random.randrange(1, 10)
    scaled(builder, node, [[1, 1, 1] if i == shown else [0, 0, 0] for i in range(11)], "STEP")
    return 3 * shown + 1


def mirrored(builder, node, random, part):
    scaled(builder, node, [[-1, 1, 1]] * 11 if random.random() < 0.5 else
           [[0, 0, 0]] * 3 + [[-1, 1, 1]] * 8)
    turn(builder, node, random)


def turns(builder, node, random, part):
    turn(builder, node, random, 6)


def folds(builder, node, random, part):
    """The part beyond x = 0 folds over: a half turn about the z axis, as a morph target. On the
    way, and along the fold, the surface has other normals than the input."""
    mesh = builder.json["meshes"][builder.json["nodes"][node]["mesh"]]
    xyz, normals = part[0], part[1]
    moves = [[-2 * p[0], -2 * p[1] + 0.1 * (p[0] > 0), 0.0] if p[0] > 0 else [0.0] * 3
             for p in xyz]
    bends = [[-2 * n[0], -2 * n[1], 0.0] if p[0] > 0 else [0.0] * 3
             for p, n in zip(xyz, normals)]
    mesh["primitives"][0]["targets"] = [{"POSITION": builder.add("VEC3", 5126, moves),
                                         "NORMAL": builder.add("VEC3", 5126, bends)}]
    weights = [min(max(3 * t - 1, 0.0), 1.0) for t in TIMES]
    builder.channel(node, "weights", TIMES, weights)


def bends(builder, node, random, part):
    """A skin of two or three joints along the longest axis."""
    count = random.choice([2, 3])
    xyz = part[0]
    nodes = builder.json["nodes"]
    extents = [max(p[c] for p in xyz) - min(p[c] for p in xyz) for c in range(3)]
    axis = extents.index(max(extents))
    lowest, length = min(p[axis] for p in xyz), extents[axis] / count
    joints, weights = [], []
    for p in xyz:
        place = (p[axis] - lowest) / length - 0.5
        below = min(max(math.floor(place), 0), count - 1)
        above = min(below + 1, count - 1)
        part_above = min(max(place - below, 0.0), 1.0)
        part_above = min(max(3 * part_above - 1, 0.0), 1.0)
        joints.append([below, above, 0, 0])
        weights.append([1 - part_above, part_above, 0.0, 0.0])
    primitive = builder.json["meshes"][nodes[node]["mesh"]]["primitives"][0]
    primitive["attributes"] |= {"JOINTS_0": builder.add("VEC4", 5123, joints),
                                "WEIGHTS_0": builder.add("VEC4", 5126, weights)}
    first = len(nodes)
    binds = []
    place = nodes[node].pop("translation")
    for j in range(count):
        height = lowest + j * length
        nodes.append({"translation": [place[c] + (height if c == axis else 0) for c in range(3)]
                      if j == 0 else [length if c == axis else 0 for c in range(3)]})
        if j:
            nodes[-2]["children"] = [first + j]
            turn_axis = [0.0 if c == axis else random.gauss(0, 1) for c in range(3)]
            max_angle = random.uniform(0.3, 1.2)
            builder.channel(first + j, "rotation", TIMES,
                            [rotation(turn_axis, max_angle * math.sin(3 * t + j)) for t in TIMES])
        binds.append([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0,
                      *(-height if c == axis else 0 for c in range(3)), 1])
    builder.json["scenes"][0]["nodes"].append(first)
    builder.json["skins"].append({"joints": list(range(first, first + count)),
                                  "inverseBindMatrices": builder.add("MAT4", 5126, binds)})
    nodes[node]["skin"] = len(builder.json["skins"]) - 1
    turn(builder, first, random, 1)


MOTIONS = {"appears": appears, "vanishes": vanishes, "flips past": flips_past,
           "mirrored": mirrored, "turns": turns, "folds": folds, "bends": bends}


def write_scene(path, random, parts):
    """parts: pairs of a shape and a motion, by name. Returns frames in which to look at it."""
    builder = Builder()
    number = 0
    frames = {0, FRAMES // 2, FRAMES - 1}
    for k, (shape, motion) in enumerate(parts):
        part = SHAPES[shape](random)
        xyz, normals, triangles = part
        attributes = {"POSITION": builder.add("VEC3", 5126, xyz),
                      "NORMAL": builder.add("VEC3", 5126, normals),
                      "TEXCOORD_0": builder.add("VEC2", 5126, [uv_of(number + i)
                                                               for i in range(len(xyz))])}
        number += len(xyz)
        assert number <= GRID * GRID
        indices = builder.add("SCALAR", 5123, [v for t in triangles for v in t])
        builder.json["meshes"].append({"primitives": [{"attributes": attributes,
                                                       "indices": indices}]})
        node = len(builder.json["nodes"])
        builder.json["nodes"].append({"mesh": len(builder.json["meshes"]) - 1,
                                      "translation": [3.0 * k, 0.0, 0.0]})
        builder.json["scenes"][0]["nodes"].append(node)
        frame = MOTIONS[motion](builder, node, random, part)
        frames |= {frame} if frame else set()
    builder.write(path)
    return sorted(frames)
