"""Small animations with a texture, as GLBs: a box from -1 to 1 that leans over or turns, and a
tube."""

import json
import math
import struct
import zlib

# Normal, to the right, up: of the faces; the last has another material.
FACES = (((0, 0, 1), (1, 0, 0), (0, 1, 0)), ((0, 0, -1), (-1, 0, 0), (0, 1, 0)),
         ((1, 0, 0), (0, 0, -1), (0, 1, 0)), ((-1, 0, 0), (0, 0, 1), (0, 1, 0)),
         ((0, -1, 0), (1, 0, 0), (0, 0, 1)), ((0, 1, 0), (1, 0, 0), (0, 0, -1)))
RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)
ROWS = ((RED, GREEN), (BLUE, WHITE))  # of the texture on each face, from the top
COLOURS_AROUND = (RED, GREEN, BLUE, WHITE)
MAGENTA = [1, 0, 1, 1]  # of the face without a texture
FRAMES = 5
TURN = 0.3  # radians around z, from one frame to the next, of what turns
CLAMP, REPEAT = 33071, 10497


def png(rows):
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    pixels = b"".join(b"\0" + b"".join(map(bytes, row)) for row in rows)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header)
            + chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))


class Buffer:
    def __init__(self):
        self.bytes, self.views, self.accessors = b"", [], []

    def view(self, data):
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data.ljust((len(data) + 3) // 4 * 4, b"\0")
        return len(self.views) - 1

    def floats(self, values, kind):
        flat = [x for value in values for x in value]
        accessor = {"bufferView": self.view(struct.pack(f"<{len(flat)}f", *flat)),
                    "componentType": 5126, "count": len(values), "type": kind,
                    "min": [min(axis) for axis in zip(*values)],
                    "max": [max(axis) for axis in zip(*values)]}
        return self.add(accessor)

    def indices(self, values):
        return self.add({"bufferView": self.view(struct.pack(f"<{len(values)}H", *values)),
                         "componentType": 5123, "count": len(values), "type": "SCALAR"})

    def add(self, accessor):
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def box(colour=None, rows=ROWS, material=None, turns=False, uv_sets=1):
    """The bytes of the GLB. colour: of all vertices, instead of the texture. rows: of the texture.
    material: members of that of all faces but the last, instead of the base colour. turns: it does
    not lean, but turns. uv_sets: equal sets of texture coordinates."""
    buffer = Buffer()
    position, normal, uv, indices = [], [], [], []
    for towards, right, up in FACES:
        first = len(position)
        for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
            x, y = 2 * u - 1, 1 - 2 * v
            position.append([n + x * r + y * t for n, r, t in zip(towards, right, up)])
            normal.append(towards)
            uv.append([u, v])
        indices += [first + i for i in (0, 3, 2, 0, 2, 1)]
    attributes = {"POSITION": buffer.floats(position, "VEC3"),
                  "NORMAL": buffer.floats(normal, "VEC3")}
    if colour:
        attributes["COLOR_0"] = buffer.floats([colour] * len(position), "VEC3")
    else:
        for number in range(uv_sets):
            attributes[f"TEXCOORD_{number}"] = buffer.floats(uv, "VEC2")
    return leaning(buffer, position, attributes, (indices[:30], indices[30:]),
                   {"rows": None if colour else rows, "material": material, "turns": turns})


def tube(rings, around):
    """A tube whose texture, the same colour along it, goes around once, with a seam; its upper half
    is magenta."""
    buffer = Buffer()
    places = [(r, c) for r in range(rings + 1) for c in range(around + 1)]
    angles = [2 * math.pi * (c % around) / around for _, c in places]
    position = [[math.cos(a), 2 * r / rings - 1, -math.sin(a)]
                for (r, _), a in zip(places, angles)]
    attributes = {
        "POSITION": buffer.floats(position, "VEC3"),
        "NORMAL": buffer.floats([[math.cos(a), 0, -math.sin(a)] for a in angles], "VEC3"),
        "TEXCOORD_0": buffer.floats([[c / around, r / rings] for r, c in places], "VEC2")}
    halves = ([], [])
    for r, c in places:
        if r < rings and c < around:
            a, b = r * (around + 1) + c, (r + 1) * (around + 1) + c
            halves[2 * r // rings].extend((a, a + 1, b, b, a + 1, b + 1))
    return leaning(buffer, position, attributes, halves,
                   {"rows": (COLOURS_AROUND,), "wrap": REPEAT})


def leaning(buffer, position, attributes, parts, look):
    """A GLB with two parts, lists of indices, of one mesh. look: rows of the texture (None: there
    is none), wrap beyond it, material: members of that of the first part, turns: whether it turns
    instead of leaning."""
    rows, material, wrap = look["rows"], look.get("material"), look.get("wrap", CLAMP)
    target = {"POSITION": buffer.floats([[0.5 * y, 0, 0] for _, y, _ in position], "VEC3")}
    primitives = [{"attributes": attributes, "targets": [target], "material": number,
                   "indices": buffer.indices(part)} for number, part in enumerate(parts)]
    times = buffer.floats([[f / 30] for f in range(FRAMES)], "SCALAR")
    if look.get("turns"):
        path, kind = "rotation", "VEC4"
        values = [[0, 0, math.sin(f * TURN / 2), math.cos(f * TURN / 2)] for f in range(FRAMES)]
    else:
        path, kind = "weights", "SCALAR"
        values = [[f / FRAMES] for f in range(FRAMES)]
    output = buffer.floats(values, kind)
    image = buffer.view(png(rows or ROWS))
    plain = {"metallicFactor": 0, "roughnessFactor": 1}
    texture = {"baseColorTexture": {"index": 0}} if rows else {}
    root = {
        "asset": {"version": "2.0"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives, "weights": [0]}],
        "materials": [material or {"pbrMetallicRoughness": {**plain, **texture}},
                      {"pbrMetallicRoughness": {**plain, "baseColorFactor": MAGENTA}}],
        "animations": [{"samplers": [{"input": times, "output": output}], "channels": [
            {"sampler": 0, "target": {"node": 0, "path": path}}]}],
        "accessors": buffer.accessors, "bufferViews": buffer.views,
    }
    if rows:
        nearest = {"magFilter": 9728, "minFilter": 9728, "wrapS": wrap, "wrapT": wrap}
        root |= {"textures": [{"source": 0, "sampler": 0}], "samplers": [nearest],
                 "images": [{"bufferView": image, "mimeType": "image/png"}]}
    root["buffers"] = [{"byteLength": len(buffer.bytes)}]
    text = json.dumps(root).encode()
    text = text.ljust((len(text) + 3) // 4 * 4)
    size = 12 + 8 + len(text) + 8 + len(buffer.bytes)
    return (struct.pack("<4sIIII", b"glTF", 2, size, len(text), 0x4E4F534A) + text
            + struct.pack("<II", len(buffer.bytes), 0x004E4942) + buffer.bytes)
