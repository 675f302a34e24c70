"""Seeds of the fuzz targets: small streams, and the payloads that are in them."""

import base64
import hashlib
import itertools
import json
import random
import struct
import subprocess
import sys

MAX_SEED_BYTES = 1 << 16
STREAM_HEADER_BYTES = 10
UNIT_HEADER = struct.Struct(">BI")
CRC_BYTES = 4
SEQUENCE_HEADER, CONNECTIVITY, VERTEX_ORDER, GOF, SLICE, RIG = 1, 2, 3, 4, 6, 7
GOF_INDEX, GOF_HASH, METADATA, ATTRIBUTES, CLIP_TABLE = 129, 130, 131, 136, 138
# In the order of decoder/fuzz/payload_fuzz.cpp.
SMALL_PAYLOADS = [VERTEX_ORDER, GOF_HASH, GOF_INDEX, METADATA, CLIP_TABLE]

# Settings that give different streams of a small animation.
BASELINE = ["--profile", "baseline"]
SETTINGS = [
    ["--kg", "1", "--keep-order", "--hash", "frame", "--clip", "Run:0-0", "--clip", "B:0"],
    [*BASELINE, "--kg", "1", "--metadata", "METADATA", "--keep-order"],
    [*BASELINE, "--kg", "0.3", "--gof", "4", "--hash", "frame"],
    [*BASELINE, "--max-error", "0.01", "--frame", "world", "--gof", "3", "--hash", "none"],
    [*BASELINE, "--gof", "all", "--clusters", "3", "--components", "2", "--qu", "8", "--qc", "8",
     "--qdelta", "8", "--frame", "lcf", "--no-rdo"],
]
# The encoder uses only a part of the Main and High profiles, so random streams of each are added.
RANDOM_SKINNED_STREAMS = 60
OBJ_SEEDS = [
    b"# frame_rate 30000/1001\nv 0 0 0\nv 1 0 .5e-3\nv 0 +1 -2.25\nv 1 1 1e-50\nf 1 2 3 4\n",
    b"\xef\xbb\xbfo a\r\nv 0 0 0 1.0\r\nvt 0 0\r\nvn 0 0 1\r\nv 1 0 0\r\nv 0 1 0\r\n"
    b"f 1/1/1 2//1 3/1\r\nf -1 -2 -3\r\n",
    b"v 1 2 \\\n 3 # three\n\nv 0.1 3.4028235e38 -1.17549435e-38\rg x\nf 1 2 1\n",
    b"v 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0\nvt 0 1\nvt 0.5\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2 3//1\n"
    b"g b c\nusemtl n\nf -1/-1/-1 2/1 3 1\n",
]
PLY_SEEDS = [
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    b"property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    b"property float s\nproperty float t\nproperty uchar red\nproperty uchar green\n"
    b"property uchar blue\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
    b"0 0 0 0 0 1 0 1 1 2 3\n1 0 0 0 0 1 0 1 1 2 3\n0 1 0 0 0 1 0 1 1 2 3\n3 0 1 2\n",
    b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
    b"property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\n"
    b"property list uchar float texcoord\nproperty float red\nproperty float green\n"
    b"property float blue\nproperty short texnumber\nend_header\n"
    + struct.pack("<9fB3iB9fh", *range(9), 3, 0, 1, 2, 6, *[0.5] * 9, 1),
]


class Failure(Exception):
    """The text is for the user."""


def tube(rings, extra):
    """A tube of `rings` rings of 5 vertices as points and triangles; `extra` adds a degenerate
    triangle, a vertex of no triangle and a triangle that shares an edge with two others."""
    points = [(r * 0.3, (i % 3) * 0.4 - 0.3, (i * 2 % 5) * 0.2) for r in range(rings)
              for i in range(5)]
    triangles = []
    for a in range(5 * (rings - 1)):
        b = a - a % 5 + (a + 1) % 5
        triangles += [(a, b, a + 5), (b, b + 5, a + 5)]
    if extra:
        points += [(9.0, 9.0, 9.0), (0.5, 2.0, 0.5)]
        triangles += [(0, 0, 1), (0, 1, len(points) - 1)]
    return points, triangles


def moved(points, frame):
    bend = (frame * 7 % 11) * 0.05
    return [(x + 0.1 * frame, y + bend * x, z - bend * x * y) for x, y, z in points]


def obj_text(points, triangles):
    lines = ["v %.6g %.6g %.6g" % p for p in points]
    lines += ["f %d %d %d" % (a + 1, b + 1, c + 1) for a, b, c in triangles]
    return ("\n".join(lines) + "\n").encode()


def mesh_files(form, points, triangles):
    """OFF, or PLY in its three encodings."""
    rows = ["%.6g %.6g %.6g" % p for p in points] + ["3 %d %d %d" % t for t in triangles]
    text = ("\n".join(rows) + "\n").encode()
    if form == "off":
        yield b"COFF\n%d %d 0\n" % (len(points), len(triangles)) + text
        return
    header = (b"ply\nformat %%s 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
              b"property float z\nelement face %d\nproperty list uchar int vertex_indices\n"
              b"end_header\n" % (len(points), len(triangles)))
    yield header % b"ascii" + text
    for order, name in ("<", b"binary_little_endian"), (">", b"binary_big_endian"):
        yield header % name + b"".join(struct.pack(order + "3f", *p) for p in points) + b"".join(
            struct.pack(order + "B3i", 3, *t) for t in triangles)


def mdd_bytes(points, frames):
    head = struct.pack(">ii", frames, len(points))
    head += b"".join(struct.pack(">f", f / 30) for f in range(frames))
    return head + b"".join(struct.pack(">3f", *p) for f in range(frames)
                           for p in moved(points, f))


def pc2_bytes(points, frames):
    head = b"POINTCACHE2\0" + struct.pack("<iiffi", 1, len(points), 0, 1, frames)
    return head + b"".join(struct.pack("<3f", *p) for f in range(frames)
                           for p in moved(points, f))


def rlpd_bytes(points, triangles, frames):
    """Annex A."""
    head = b"RLPD" + struct.pack("<6Ii3i", 1, len(points), len(triangles), frames, 30, 1,
                                 -8, 5, -6, 7)
    head += b"".join(struct.pack("<3I", *t) for t in triangles)
    return head + b"".join(struct.pack("<3i", *(int(256 * x) for x in p))
                           for f in range(frames) for p in moved(points, f))


def small_animations():
    """(points, triangles, frames)"""
    yield (*tube(4, False), 8)
    yield (*tube(3, True), 5)
    yield (*tube(12, True), 12)
    yield [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], 1


def encoded_streams(root, work, encoder):
    """Small animations encoded with several settings, and three frames of the bundled ones."""
    work.mkdir(parents=True, exist_ok=True)
    (work / "metadata.json").write_text('{"title": "seed", "tags": [1, 2, 3]}')
    inputs = [(obj_text(p, t), pc2_bytes(p, f)) for p, t, f in small_animations()]
    for cache in sorted((root / "streams" / "inputs").glob("*.pc2")):
        head, frames = bytearray(cache.read_bytes()[:32]), 3
        points, = struct.unpack_from("<i", head, 16)
        struct.pack_into("<i", head, 28, frames)
        frame_data = cache.read_bytes()[32:32 + 12 * points * frames]
        inputs.append((cache.with_suffix(".obj").read_bytes(), bytes(head) + frame_data))
    for mesh, cache in inputs:
        (work / "seed.obj").write_bytes(mesh)
        (work / "seed.pc2").write_bytes(cache)
        for setting in SETTINGS:
            setting = [str(work / "metadata.json") if word == "METADATA" else word
                       for word in setting]
            done = subprocess.run(
                [encoder, work / "seed.obj", "--points", work / "seed.pc2",
                 "-o", work / "seed.rlpc", "-q", *setting], stderr=subprocess.PIPE, text=True)
            if done.returncode not in (0, 2):
                raise Failure(f"a seed cannot be encoded ({' '.join(setting)}): {done.stderr}")
            yield (work / "seed.rlpc").read_bytes()


def random_skinned_streams(root):
    """Random legal streams of the Main and High profiles, as rlpcgen makes them."""
    for folder in ("judge", "specdec", "rlpcgen"):
        sys.path.insert(0, str(root / "conformance" / folder))
    import random_high
    import spec_program
    program = spec_program.Program(root / "spec")
    for profile in ("main", "high"):
        builder = random_high.builder_of(profile)(program)
        for seed in range(RANDOM_SKINNED_STREAMS):
            stream, _ = builder.build(seed)
            if len(stream) <= MAX_SEED_BYTES:
                yield stream


def released_streams(root):
    for path in sorted((root / "streams").glob("v*/*/**/*.rlpc")):
        if path.stat().st_size <= MAX_SEED_BYTES:
            yield path.read_bytes()


def units(stream):
    """(type, payload) of each unit, as far as they follow each other."""
    at = STREAM_HEADER_BYTES
    while at + UNIT_HEADER.size + CRC_BYTES <= len(stream):
        code, size = UNIT_HEADER.unpack_from(stream, at)
        first = at + UNIT_HEADER.size
        if first + size + CRC_BYTES > len(stream):
            return
        yield code, stream[first:first + size]
        at = first + size + CRC_BYTES


class Bits:
    """Clause 9.2, as much as the seeds need."""

    def __init__(self, data):
        self.text = "".join(f"{byte:08b}" for byte in data)
        self.at = 0

    def ue(self):
        """More than any syntax element can have, if the code is not complete."""
        first = self.text.find("1", self.at)
        end = 2 * first - self.at + 1
        if first < 0 or end > len(self.text):
            return 1 << 40
        self.at = end
        return int(self.text[first:end], 2) - 1


def parts(stream):
    """The units of a stream, and the counts of its sequence header."""
    found = list(units(stream))
    if not found or found[0][0] != SEQUENCE_HEADER or len(found[0][1]) < 3:
        return None
    bits = Bits(found[0][1][2:40])
    counts = {"vertices": bits.ue() + 1, "triangles": bits.ue(), "frames": bits.ue() + 1}
    return (found, counts) if max(counts.values()) <= 65535 else None


def connectivity_seeds(found, counts):
    for code, payload in found:
        if code == CONNECTIVITY:
            yield struct.pack("<HH", counts["vertices"] - 1, counts["triangles"]) + payload


def cluster_gof_seeds(found, _):
    first = {}
    for code, payload in found:
        first.setdefault(code, payload)
        if code == GOF and CONNECTIVITY in first and not is_main(first[SEQUENCE_HEADER]):
            header, connectivity = first[SEQUENCE_HEADER], first[CONNECTIVITY]
            frame = Bits(payload[:16]).ue()
            if max(frame, len(header), len(connectivity)) < 65536:
                yield (struct.pack("<IHH", frame, len(header), len(connectivity))
                       + header + connectivity + payload)


def is_main(header):
    return header[0] == 1


def skinned_gof_seeds(found, counts):
    """GOFs with the slices that follow them; with all shared rigs before them."""
    yield from high_gof_seeds(found, counts)
    before = {}
    for place, (code, payload) in enumerate(found):
        before.setdefault(code, payload)
        if code != GOF or CONNECTIVITY not in before or not is_main(before[SEQUENCE_HEADER]):
            continue
        slices = itertools.takewhile(lambda unit: unit[0] == SLICE, found[place + 1:])
        pieces = [before[SEQUENCE_HEADER], before[CONNECTIVITY], payload, *(s for _, s in slices)]
        if max(map(len, pieces)) < 65536:
            yield struct.pack("<I", Bits(payload[:16]).ue()) + b"".join(
                struct.pack("<H", len(piece)) + piece for piece in pieces)


def high_gof_seeds(found, _):
    if found[0][1][0] != 2:
        return
    before, rigs, gof_units = {}, [], []
    frame = None
    for code, payload in [*found, (None, b"")]:
        before.setdefault(code, payload)
        if code == SLICE:
            (gof_units if gof_units else rigs).append((code, payload))
            continue
        if gof_units and CONNECTIVITY in before:
            pieces = [before[SEQUENCE_HEADER], before[CONNECTIVITY]]
            pieces += [bytes([c]) + p for c, p in rigs + gof_units]
            if max(map(len, pieces)) < 65536:
                yield struct.pack("<I", frame | 1 << 31) + b"".join(
                    struct.pack("<H", len(piece)) + piece for piece in pieces)
        gof_units = []
        if code == RIG:
            rigs.append((code, payload))
        elif code == GOF:
            gof_units, frame = [(code, payload)], min(Bits(payload[:16]).ue(), (1 << 31) - 1)


def payload_seeds(found, counts):
    gof_frames = 1
    for code, payload in found:
        if code == GOF:
            bits = Bits(payload[:16])
            bits.ue()
            gof_frames = bits.ue() + 1
        elif code in SMALL_PAYLOADS:
            count = {VERTEX_ORDER: counts["vertices"], GOF_HASH: gof_frames,
                     GOF_INDEX: counts["frames"], CLIP_TABLE: counts["frames"]}.get(code, 1)
            yield struct.pack("<BH", SMALL_PAYLOADS.index(code), (count - 1) & 65535) + payload


def attributes_seeds(found, _):
    """Seeds with a grid of 4 by 3, the mesh of several streams of the suite."""
    for code, payload in found:
        if code == ATTRIBUTES:
            yield bytes([3, 2, 0]) + payload


def sequence_header_seeds(found, _):
    yield found[0][1]


FROM_PARTS = {"skinned_gof_fuzz": skinned_gof_seeds, "connectivity_fuzz": connectivity_seeds,
              "cluster_gof_fuzz": cluster_gof_seeds, "payload_fuzz": payload_seeds,
              "attributes_fuzz": attributes_seeds, "sequence_header_fuzz": sequence_header_seeds}


def gltf_seeds(root):
    """The bundled documents, as they are and as JSON with a data URI, with several settings."""
    for path in sorted((root / "streams" / "inputs").glob("*.glb")):
        glb = path.read_bytes()
        size, = struct.unpack_from("<I", glb, 12)
        document = json.loads(glb[20:20 + size])
        data = base64.b64encode(glb[20 + size + 8:]).decode()
        document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + data
        for settings in (4, 7, 123):
            yield bytes([settings]) + glb
            yield bytes([settings]) + json.dumps(document, separators=(",", ":")).encode()


def encoder_seeds():
    """For conformance/fuzz/encoder_case.cpp: each profile, preset and target with several shapes
    and motions, with few and with many tools."""
    numbers = random.Random(1)
    for profile, preset, target in itertools.product(range(2), range(3), range(3)):
        for shape, motion in itertools.product(range(4), range(8)):
            whole = numbers.randrange(2)
            flags = whole | 2 * numbers.randrange(8) | 32 * (numbers.randrange(8) == 0)
            value = (27000, 36000, 24000)[target] + numbers.randrange(6000)
            vertices, triangles, frames = 12 + 7 * shape, 20, 10
            options = struct.pack("<4BH7B", flags, profile, preset, target, value,
                                  numbers.choice([0, 0, 5, 8, 255]), numbers.choice([0, 0, 1, 4]),
                                  numbers.randrange(3), 0, 255, 29, 1)
            tools = bytes(numbers.choice([0, 0, numbers.randrange(24)]) for _ in range(13))
            mesh = bytes([vertices, shape, numbers.randrange(4), triangles, shape,
                          numbers.choice([0, 0, 3, 250]), numbers.choice([0, 0, 140]), frames])
            yield options + tools + mesh + b"".join(
                bytes([motion if f else 0, 9 * f]) for f in range(frames))


def seeds_of(target, streams, root):
    """The seeds of a target; streams, if the target is not listed here."""
    if target == "obj_fuzz":
        return OBJ_SEEDS + [obj_text(p, t) for p, t, _ in small_animations()]
    if target in ("off_fuzz", "ply_fuzz"):
        seeds = PLY_SEEDS if target == "ply_fuzz" else []
        return seeds + [b for p, t, _ in small_animations() for b in mesh_files(target[:3], p, t)]
    if target == "mdd_fuzz":
        return [bytes([len(p) - 1]) + mdd_bytes(p, f) for p, _, f in small_animations()]
    if target == "pc2_fuzz":
        return [bytes([len(p) - 1]) + pc2_bytes(p, f) for p, _, f in small_animations()]
    if target == "encoder_fuzz":
        return encoder_seeds()
    if target == "gltf_fuzz":
        return gltf_seeds(root)
    if target == "rlpd_fuzz":
        return [rlpd_bytes(p, t, f) for p, t, f in small_animations()]
    if target == "validator_fuzz":
        return [b"\1" + stream for stream in streams]  # CRCs are repaired
    if target in FROM_PARTS:
        known = filter(None, map(parts, streams))
        return [seed for found, counts in known for seed in FROM_PARTS[target](found, counts)]
    return streams


def write_all(root, corpus, encoder, targets):
    """Seeds of all targets, in CORPUS/TARGET/seeds; and CORPUS/TARGET/found for what is new."""
    streams = [*released_streams(root), *random_skinned_streams(root),
               *encoded_streams(root, corpus / "work", encoder)]
    for target in targets:
        folder = corpus / target / "seeds"
        folder.mkdir(parents=True, exist_ok=True)
        (corpus / target / "found").mkdir(exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        for seed in seeds_of(target, streams, root):
            (folder / hashlib.sha1(seed).hexdigest()).write_bytes(seed)
