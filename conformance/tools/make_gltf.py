#!/usr/bin/env python3
"""make_gltf.py FOLDER: writes tulip.glb, the glTF animation of streams/inputs.

A tulip sways, opens and closes, and two bees visit it. The file is small, but uses much of glTF:
a skin, morph targets (one of them sparse), instances, a matrix, integer positions, strips, fans
and lines, and every interpolation. It is computed with the four operations and square roots
alone, so that the bytes are the same on every machine.
"""

import json
import math
import pathlib
import struct
import sys

BYTE, UBYTE, SHORT, USHORT, FLOAT = 5120, 5121, 5122, 5123, 5126
LETTERS = {BYTE: "b", UBYTE: "B", SHORT: "h", USHORT: "H", FLOAT: "f"}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
LINES, STRIP, FAN = 1, 5, 6
VERTICES, INDICES = 34962, 34963  # targets of a buffer view
DIAGONAL = 0.70710678

# Cosine and sine of the corners of an octagon and of a dodecagon.
OCTAGON = [(1, 0), (DIAGONAL, DIAGONAL), (0, 1), (-DIAGONAL, DIAGONAL),
           (-1, 0), (-DIAGONAL, -DIAGONAL), (0, -1), (DIAGONAL, -DIAGONAL)]
DODECAGON = [(1, 0), (0.8660254, 0.5), (0.5, 0.8660254), (0, 1), (-0.5, 0.8660254),
             (-0.8660254, 0.5), (-1, 0), (-0.8660254, -0.5), (-0.5, -0.8660254), (0, -1),
             (0.5, -0.8660254), (0.8660254, -0.5)]

RINGS, JOINTS, HEIGHT = 12, 4, 1.5
ROWS = 4


class Document:
    def __init__(self):
        self.json = {"asset": {"version": "2.0", "generator": "make_gltf.py"},
                     "extensionsUsed": ["KHR_mesh_quantization"],
                     "extensionsRequired": ["KHR_mesh_quantization"]}
        self.bytes = b""

    def push(self, name, element):
        self.json.setdefault(name, []).append(element)
        return len(self.json[name]) - 1

    def view(self, component, values, **more):
        self.bytes += bytes(-len(self.bytes) % 4)
        data = struct.pack(f"<{len(values)}{LETTERS[component]}", *values)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **more}
        self.bytes += data
        return self.push("bufferViews", view)

    def accessor(self, kind, component, elements, normalized=False, target=None):
        """elements: tuples, or numbers of a SCALAR."""
        rows = [e if isinstance(e, tuple) else (e,) for e in elements]
        more = {"target": target} if target else {}
        if target == VERTICES:  # each begins at a multiple of 4 bytes
            size = struct.calcsize(LETTERS[component])
            gap = -size * WIDTHS[kind] % 4
            more["byteStride"] = size * WIDTHS[kind] + gap
            rows = [(*row, *[0] * (gap // size)) for row in rows]
        accessor = {"bufferView": self.view(component, [x for row in rows for x in row], **more),
                    "componentType": component, "count": len(rows), "type": kind}
        if normalized:
            accessor["normalized"] = True
        if kind in ("SCALAR", "VEC3"):
            single = [struct.unpack("<f", struct.pack("<f", x))[0] for row in rows
                      for x in row[:WIDTHS[kind]]]
            accessor["min"] = [min(single[i::WIDTHS[kind]]) for i in range(WIDTHS[kind])]
            accessor["max"] = [max(single[i::WIDTHS[kind]]) for i in range(WIDTHS[kind])]
        return self.push("accessors", accessor)

    def glb(self):
        self.bytes += bytes(-len(self.bytes) % 4)
        self.json["buffers"] = [{"byteLength": len(self.bytes)}]
        return packed(self.json, self.bytes)


def packed(document, data):
    """A .glb file; `data` has a multiple of 4 bytes."""
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = (struct.pack("<I4s", len(text), b"JSON") + text
              + struct.pack("<I4s", len(data), b"BIN\0") + data)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def grid(rows, columns):
    """Triangles between rows of `columns` + 1 vertices, the last in each as the first."""
    corners = []
    for row in range(rows - 1):
        for c in range(columns):
            a = row * (columns + 1) + c
            b = a + columns + 1
            corners += [a, b, a + 1, a + 1, b, b + 1]
    return corners


def strip(rows, columns):
    """The same as one strip, with degenerate triangles from row to row."""
    corners = []
    for row in range(rows - 1):
        line = [v for c in range(columns + 1)
                for v in (row * (columns + 1) + c, (row + 1) * (columns + 1) + c)]
        corners += [corners[-1], line[0]] + line if corners else line
    return corners


def stem(document):
    """A tube along y, with a seam; each ring follows the joints above and below it."""
    positions, joints, weights = [], [], []
    for ring in range(RINGS + 1):
        y = HEIGHT * ring / RINGS
        along = (JOINTS - 1) * ring / RINGS
        joint = min(int(along), JOINTS - 2)
        upper = int(255 * (along - joint))
        for x, z in OCTAGON + OCTAGON[:1]:
            positions.append((0.06 * x, y, -0.06 * z))
            pairs = [(joint, 255 - upper), (joint + 1, upper)]
            joints.append((*[j if w else 0 for j, w in pairs], 0, 0))
            weights.append((*[w for _, w in pairs], 0, 0))
    attributes = {"POSITION": document.accessor("VEC3", FLOAT, positions, target=VERTICES),
                  "JOINTS_0": document.accessor("VEC4", UBYTE, joints, target=VERTICES),
                  "WEIGHTS_0": document.accessor("VEC4", UBYTE, weights, True, target=VERTICES)}
    indices = document.accessor("SCALAR", USHORT, grid(RINGS + 1, 8), target=INDICES)
    return document.push("meshes", {"name": "stem", "primitives": [
        {"attributes": attributes, "indices": indices}]})


def flower(document):
    """A cup of petals in integers; one target opens it, the other bends one petal down."""
    radius = [0.1, 0.45, 0.6, 0.5]
    opened = [0.0, 0.1, 0.3, 0.49]
    positions, moves, bent, bends = [], [], [], []
    for row in range(ROWS):
        for c, (x, z) in enumerate(DODECAGON + DODECAGON[:1]):
            tip = 0.15 if row == ROWS - 1 and c % 2 == 0 else 0
            place = (radius[row] * x, row / ROWS + tip, -radius[row] * z)
            positions.append(tuple(int(32767 * p) for p in place))
            moves.append(tuple(int(32767 * m) for m in (opened[row] * x, -opened[row] / 2,
                                                        -opened[row] * z)))
            if row > 1 and c in (0, 1, 11, 12):
                bent.append(len(positions) - 1)
                bends += [3000 * row, -4000 * row, 0]
    shape = document.accessor("VEC3", SHORT, positions, True, target=VERTICES)
    target = document.accessor("VEC3", SHORT, moves, True, target=VERTICES)
    sparse = document.push("accessors", {
        "componentType": SHORT, "normalized": True, "count": len(positions), "type": "VEC3",
        "min": [0, min(bends[1::3]), 0], "max": [max(bends[0::3]), 0, 0],
        "sparse": {"count": len(bent),
                   "indices": {"bufferView": document.view(UBYTE, bent), "componentType": UBYTE},
                   "values": {"bufferView": document.view(SHORT, bends)}}})
    indices = document.accessor("SCALAR", USHORT, strip(ROWS, 12), target=INDICES)
    return document.push("meshes", {"name": "flower", "weights": [0, 0], "primitives": [
        {"attributes": {"POSITION": shape}, "indices": indices, "mode": STRIP,
         "targets": [{"POSITION": target}, {"POSITION": sparse}]}]})


def bee(document):
    """An octahedron without indices, and a line."""
    tips = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)]
    corners = []
    for x in (0, 3):
        for y in (1, 4):
            for z in (2, 5):
                turned = (x == 3) ^ (y == 4) ^ (z == 5)
                corners += [tips[x], tips[z], tips[y]] if turned else [tips[x], tips[y], tips[z]]
    body = document.accessor("VEC3", BYTE, corners, target=VERTICES)
    wings = document.accessor("VEC3", BYTE, [(-2, 1, 0), (2, 1, 0)], target=VERTICES)
    return document.push("meshes", {"name": "bee", "primitives": [
        {"attributes": {"POSITION": body}}, {"attributes": {"POSITION": wings}, "mode": LINES}]})


def soil(document):
    positions = document.accessor("VEC3", FLOAT, [(x, 0, -z) for x, z in OCTAGON], target=VERTICES)
    return document.push("meshes", {"name": "soil", "primitives": [
        {"attributes": {"POSITION": positions}, "mode": FAN}]})


def turn(x, z):
    """A rotation about the axis (x, 0, z), by twice the arc tangent of its length."""
    length = math.sqrt(1 + x * x + z * z)
    return (x / length, 0, z / length, 1 / length)


class Animation:
    def __init__(self, document, name, times):
        self.document = document
        self.json = {"name": name, "samplers": [], "channels": []}
        self.input = document.accessor("SCALAR", FLOAT, times)
        document.push("animations", self.json)

    def move(self, node, path, kind, elements, interpolation, component=FLOAT):
        output = self.document.accessor(kind, component, elements, component != FLOAT)
        self.json["samplers"].append(
            {"input": self.input, "output": output, "interpolation": interpolation})
        self.json["channels"].append({"sampler": len(self.json["samplers"]) - 1,
                                      "target": {"node": node, "path": path}})


def animate(document, joints, cup, bees):
    sway = Animation(document, "Sway", [0, 0.5, 1, 1.5, 2])
    for i, joint in enumerate(joints):
        bend = 0.04 * (i + 1)
        sway.move(joint, "rotation", "VEC4",
                  [turn(0, 0), turn(bend, bend / 2), turn(0, 0), turn(-bend, 0), turn(0, 0)],
                  "LINEAR")
    # For each time in-tangent, value and out-tangent, each for both targets.
    keys = [(0, 0), (0.6, 0), (1, 0.2), (0.5, 1), (0, 0)]
    sway.move(cup, "weights", "SCALAR",
              [x for a, b in keys for x in (0, 0, a, b, 0, 0)], "CUBICSPLINE")
    visit = Animation(document, "Visit", [0.25, 0.75, 1.25, 1.75])
    path = [(-1.5, 2, 0), (-0.4, 2.2, 0.3), (0.4, 2.2, 0.3), (1.5, 2.5, 0)]
    visit.move(bees[0], "translation", "VEC3",
               [x for p in path for x in ((1, 0, 0), p, (1, 0, 0))], "CUBICSPLINE")
    visit.move(bees[0], "rotation", "VEC4",
               [(0, 0, 0, 32767), (0, 23170, 0, 23170), (0, 32767, 0, 0), (0, 23170, 0, -23170)],
               "LINEAR", SHORT)
    visit.move(bees[1], "scale", "VEC3", [(s, s, s) for s in (0.05, 0.08, 0.05, 0.1)], "STEP")


def tulip():
    document = Document()
    meshes = {make.__name__: make(document) for make in (stem, flower, bee, soil)}
    step = HEIGHT / (JOINTS - 1)
    # Nodes 0 to 3 are the joints; visible nodes follow.
    for joint in range(JOINTS):
        node = {"name": f"joint {joint}", "translation": [0, step if joint else 0, 0],
                "children": [joint + 1]}
        document.push("nodes", node)
    cup = document.push("nodes", {"name": "cup", "mesh": meshes["flower"],
                                  "scale": [0.5, 0.5, 0.5]})
    inverse = document.accessor("MAT4", FLOAT, [
        (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -step * joint, 0, 1) for joint in range(JOINTS)])
    document.push("skins", {"joints": list(range(JOINTS)), "inverseBindMatrices": inverse})
    roots = [0, document.push("nodes", {"name": "stem", "mesh": meshes["stem"], "skin": 0}),
             document.push("nodes", {"name": "soil", "mesh": meshes["soil"],
                                     "matrix": [0.3, 0, 0, 0, 0, 0.3, 0, 0, 0, 0, 0.3, 0,
                                                0, 0.05, 0, 1]})]
    places = {"visitor": [-1.5, 2, 0], "onlooker": [0.7, 1.2, 0.2]}
    bees = [document.push("nodes", {"name": name, "mesh": meshes["bee"], "translation": place,
                                    "scale": [0.06, 0.06, 0.1]})
            for name, place in places.items()]
    document.json["scenes"] = [{"nodes": roots + bees}]
    document.json["scene"] = 0
    animate(document, range(1, JOINTS), cup, bees)
    return document.glb()


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__.splitlines()[0])
    (pathlib.Path(sys.argv[1]) / "tulip.glb").write_bytes(tulip())


if __name__ == "__main__":
    main()
