"""A small reader of .glb files for tests: positions and normals of a scene at any time, as viewers
compute them. It shares nothing with the encoder and the decoder.

Covers what rlpcdec writes and the tests generate: nodes, one skin for each mesh, morph targets
(dense or sparse), linear and stepped animations, normalised integers.
"""

import json
import math
import struct

FORMATS = {5120: ("b", 127), 5121: ("B", 255), 5122: ("h", 32767), 5123: ("H", 65535),
           5125: ("I", 1), 5126: ("f", 1)}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def multiply(a, b):
    """The product of two affine maps, as rows of 4."""
    return [[sum(a[i][k] * b[k][j] for k in range(3)) + (a[i][3] if j == 3 else 0.0)
             for j in range(4)] for i in range(3)]


def placed(map_, p):
    return [row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3] for row in map_]


def turned(map_, n):
    return [row[0] * n[0] + row[1] * n[1] + row[2] * n[2] for row in map_]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def minus(a, b):
    return [a[0] - b[0], a[1] - b[1], a[2] - b[2]]


def unit(n):
    length = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    return [x / length for x in n] if length > 0 else [0.0, 0.0, 0.0]


def degrees(a, b):
    return math.degrees(math.atan2(math.hypot(*cross(a, b)),
                                   a[0] * b[0] + a[1] * b[1] + a[2] * b[2]))


def normal_map(map_):
    """The inverse transpose up to a positive factor: what viewers turn normals by."""
    rows = [cross(map_[1], map_[2]), cross(map_[2], map_[0]), cross(map_[0], map_[1])]
    sign = math.copysign(1.0, sum(map_[0][k] * rows[0][k] for k in range(3)))
    return [[sign * x for x in row] for row in rows]


def local_map(translation, rotation, scale):
    x, y, z, w = rotation
    turn = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    return [[turn[i][j] * scale[j] for j in range(3)] + [translation[i]] for i in range(3)]


def slerp(a, b, t):
    cosine = sum(x * y for x, y in zip(a, b))
    if cosine < 0:
        b, cosine = [-x for x in b], -cosine
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-6:
        q = [x + t * (y - x) for x, y in zip(a, b)]
    else:
        q = [(math.sin((1 - t) * angle) * x + math.sin(t * angle) * y) / math.sin(angle)
             for x, y in zip(a, b)]
    length = math.sqrt(sum(x * x for x in q))
    return [x / length for x in q]


class Primitive:
    """vertices in the order of the file; corners: indices of vertices, three per triangle."""

    def __init__(self, node, attributes, corners, targets):
        self.node, self.attributes, self.corners, self.targets = node, attributes, corners, targets


class Scene:
    def __init__(self, path):
        data = path.read_bytes()
        size, = struct.unpack_from("<I", data, 12)
        self.json = json.loads(data[20:20 + size])
        self.chunk = data[28 + size:]
        self.nodes = self.json["nodes"]
        self.primitives = []
        self._arrays = {}
        for n, node in enumerate(self.nodes):
            if "mesh" in node:
                for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                    self._add(n, primitive)

    def _numbers(self, view, offset, component, width, count):
        view = self.json["bufferViews"][view]
        letter, _ = FORMATS[component]
        size = struct.calcsize(letter) * width
        first = view.get("byteOffset", 0) + offset
        stride = view.get("byteStride", size)
        return [struct.unpack_from(f"<{width}{letter}", self.chunk, first + i * stride)
                for i in range(count)]

    def array(self, number):
        """The elements of an accessor, as tuples of numbers."""
        if number in self._arrays:
            return self._arrays[number]
        a = self.json["accessors"][number]
        component, width, count = a["componentType"], WIDTHS[a["type"]], a["count"]
        rows = [(0,) * width] * count
        if "bufferView" in a:
            rows = self._numbers(a["bufferView"], a.get("byteOffset", 0), component, width, count)
        if "sparse" in a:
            sparse, rows = a["sparse"], list(rows)
            places = self._numbers(sparse["indices"]["bufferView"],
                                   sparse["indices"].get("byteOffset", 0),
                                   sparse["indices"]["componentType"], 1, sparse["count"])
            values = self._numbers(sparse["values"]["bufferView"],
                                   sparse["values"].get("byteOffset", 0), component, width,
                                   sparse["count"])
            for (place,), value in zip(places, values):
                rows[place] = value
        if a.get("normalized"):
            max_integer = FORMATS[component][1]
            rows = [tuple(max(x / max_integer, -1.0) for x in row) for row in rows]
        self._arrays[number] = rows
        return rows

    def _add(self, node, primitive):
        attributes = {name: self.array(a) for name, a in primitive["attributes"].items()}
        count = len(attributes["POSITION"])
        corners = [i for (i,) in self.array(primitive["indices"])] if "indices" in primitive \
            else list(range(count))
        targets = [{name: self.array(a) for name, a in target.items()}
                   for target in primitive.get("targets", [])]
        self.primitives.append(Primitive(node, attributes, corners, targets))

    def _value(self, sampler, time, is_rotation, width):
        times = [t for (t,) in self.array(sampler["input"])]
        values = self.array(sampler["output"])
        values = [[x for row in values[i * width:(i + 1) * width] for x in row]
                  for i in range(len(times))]
        if time <= times[0]:
            return values[0]
        if time >= times[-1]:
            return values[-1]
        i = max(k for k, t in enumerate(times) if t <= time)
        if sampler.get("interpolation", "LINEAR") == "STEP":
            return values[i]
        t = (time - times[i]) / (times[i + 1] - times[i])
        if is_rotation:
            return slerp(values[i], values[i + 1], t)
        return [a + t * (b - a) for a, b in zip(values[i], values[i + 1])]

    def _pose(self, time, animation):
        """The map of each node to the scene, and the weights of each."""
        local = [{"translation": node.get("translation", [0, 0, 0]),
                  "rotation": node.get("rotation", [0, 0, 0, 1]),
                  "scale": node.get("scale", [1, 1, 1])} for node in self.nodes]
        weights = {}
        for n, node in enumerate(self.nodes):
            if "mesh" in node:
                mesh = self.json["meshes"][node["mesh"]]
                count = len(mesh["primitives"][0].get("targets", []))
                weights[n] = node.get("weights", mesh.get("weights", [0] * count))
        if "animations" in self.json:
            chosen = self.json["animations"][animation]
            for channel in chosen["channels"]:
                n, path = channel["target"]["node"], channel["target"]["path"]
                width = max(len(weights.get(n, [])), 1) if path == "weights" else 1
                value = self._value(chosen["samplers"][channel["sampler"]], time,
                                    path == "rotation", width)
                if path == "weights":
                    weights[n] = value
                else:
                    local[n][path] = value
        maps = [None] * len(self.nodes)

        def visit(n, parent):
            own = local_map(**local[n])
            maps[n] = multiply(parent, own) if parent else own
            for child in self.nodes[n].get("children", []):
                visit(child, maps[n])

        for root in self.json["scenes"][self.json.get("scene", 0)]["nodes"]:
            visit(root, None)
        return maps, weights

    def _joints(self, skin, maps):
        skin = self.json["skins"][skin]
        binds = self.array(skin["inverseBindMatrices"]) if "inverseBindMatrices" in skin else None
        joints = []
        for j, node in enumerate(skin["joints"]):
            if not binds:
                joints.append(maps[node])
                continue
            bind = [[binds[j][4 * column + row] for column in range(4)] for row in range(3)]
            joints.append(multiply(maps[node], bind))
        return joints

    def frame(self, time, animation=0):
        """(positions, normals) of each primitive; a normal of length 0: none."""
        maps, weights = self._pose(time, animation)
        frames = []
        for primitive in self.primitives:
            shape = {name: self._morphed(primitive, name, weights[primitive.node])
                     for name in ("POSITION", "NORMAL") if name in primitive.attributes}
            normals = shape.get("NORMAL", [[0, 0, 0]] * len(shape["POSITION"]))
            skin = self.nodes[primitive.node].get("skin")
            if skin is None:
                place, turn = maps[primitive.node], normal_map(maps[primitive.node])
                frames.append(([placed(place, p) for p in shape["POSITION"]],
                               [unit(turned(turn, n)) for n in normals]))
                continue
            joints = self._joints(skin, maps)
            positions, moved = [], []
            for v, p in enumerate(shape["POSITION"]):
                vertex_matrix = [[0.0] * 4 for _ in range(3)]
                for joint, weight in zip(primitive.attributes["JOINTS_0"][v],
                                         primitive.attributes["WEIGHTS_0"][v]):
                    if weight:
                        for i in range(3):
                            for j in range(4):
                                vertex_matrix[i][j] += weight * joints[joint][i][j]
                positions.append(placed(vertex_matrix, p))
                moved.append(unit(turned(vertex_matrix, normals[v])))
            frames.append((positions, moved))
        return frames

    @staticmethod
    def _morphed(primitive, name, weights):
        values = [list(row) for row in primitive.attributes[name]]
        for target, weight in zip(primitive.targets, weights):
            if weight and name in target:
                for value, (x, y, z) in zip(values, target[name]):
                    value[0] += weight * x
                    value[1] += weight * y
                    value[2] += weight * z
        return values
