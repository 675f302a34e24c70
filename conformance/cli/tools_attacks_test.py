#!/usr/bin/env python3
"""Small inputs that would take much memory, time or stack: JSON in streams and in mesh files,
materials and their images.

    tools_attacks_test.py --bin BUILD/bin [unittest arguments, such as AssetTrees]
"""

import copy
import json
import os
import random
import resource
import struct
import zlib

from tools_limits_test import MIB, MeasuredTest
from tools_testing import ToolsTest, main

MB = 1000 * 1000
METADATA, ASSET = 0x83, 0x89
CONNECTIVITY = 0x02
PNG = b"\x89PNG\r\n\x1a\n" + bytes(20)


def unit(kind, payload):
    """A unit of a stream, with its CRC (6.2)."""
    body = struct.pack(">BI", kind, len(payload)) + payload
    return body + struct.pack(">I", zlib.crc32(body))


def metadata_unit(text):
    return unit(METADATA, struct.pack(">I", len(text)) + zlib.compress(text, 9))


def glb(text, binary=b""):
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if binary:
        binary += bytes(-len(binary) % 4)
        chunks += struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def asset_unit(text, binary=b""):
    file = glb(text, binary)
    return unit(ASSET, b"\0" + struct.pack(">I", len(file)) + zlib.compress(file, 9))


def with_unit(stream, added):
    """The stream with a unit after its connectivity."""
    at = 10
    while stream[at] != CONNECTIVITY:
        at += 9 + struct.unpack_from(">I", stream, at + 1)[0]
    at += 9 + struct.unpack_from(">I", stream, at + 1)[0]
    return stream[:at] + added + stream[at:]


def within(seconds):
    """Call it before a tool starts: the tool is killed when it has computed for so long."""
    return {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))}


class StreamAttack(MeasuredTest):
    def setUp(self):
        super().setUp()
        self.path("t.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.ok("rlpcenc", self.path("t.obj"), "-o", self.path("t.rlpc"), "--preset", "fast", "-q")
        self.stream = self.path("t.rlpc").read_bytes()
        self.attack = self.path("attack.rlpc")

    def put(self, added):
        self.attack.write_bytes(with_unit(self.stream, added))
        return self.attack

    def decoders(self):
        """(tool, arguments) of what reads assets and metadata."""
        out = self.path("out")
        return (("rlpcdec", "-o", f"{out}.glb"), ("rlpcdec", "-o", f"{out}.obj", "--json"),
                ("rlpcdec", "-o", f"{out}.rlpd"), ("rlpcdec", "--verify"),
                ("rlpcinfo", "--json"), ("rlpcinfo",), ("rlpcinfo", "--html", f"{out}.html"),
                ("rlpcinfo", "--extract", "components=0", "-o", f"{out}.rlpc"),
                ("rlpcval",), ("rlpcval", "--json"))


class AssetTrees(StreamAttack):
    """The JSON of an asset is counted as the tree that it becomes."""

    def asset(self, items):
        return self.put(asset_unit(b'{"asset":{"version":"2.0"},"materials":[' + items + b"0]}"))

    def test_that_are_larger_than_allowed(self):
        for count, limit in ((1000000, 10 * MB), (10000000, 100 * MB)):
            size = self.asset(b"[]," * count).stat().st_size
            self.assertLess(size, 40000)
            for output in ("out.glb", "out.obj"):
                self.takes(limit, 3, ("asset_size", "frames are written without materials"),
                           "rlpcdec", self.attack, "-o", self.path(output), "--max-memory", limit)
                self.assertIn(output, self.files())

    def test_of_many_materials(self):
        """It took time by the square of their number: minutes."""
        self.asset(b"{}," * 500000)
        for output in ("out.glb", "out.obj"):
            self.ok("rlpcdec", self.attack, "-o", self.path(output), **within(60))

    def test_of_many_members(self):
        """Names of members are compared with each other."""
        members = b",".join(b'"%d":0' % i for i in range(400000))
        self.put(asset_unit(b'{"asset":{"version":"2.0"},"materials":[{' + members + b"}]}"))
        self.ok("rlpcdec", self.attack, "-o", self.path("out.obj"), **within(60))
        done = self.ok("rlpcdec", self.attack, "-o", self.path("out.glb"), "--json", **within(60))
        self.assertIn("too many members in one object", done.json()["remarks"][0])

    def test_that_are_nested_deeply(self):
        self.asset(b"[" * 20000 + b"]" * 20000 + b",")
        done = self.ok("rlpcdec", self.attack, "-o", self.path("out.glb"), "--json")
        self.assertIn("nested more than 100 levels", done.json()["remarks"][0])

    def test_remarks_name_files_that_are_not_utf8(self):
        self.asset(b"[" * 200 + b"]" * 200 + b",")
        name = os.fsdecode(b"o\xff\x1b.glb")
        done = self.ok("rlpcdec", self.attack, "-o", self.path(name), "--json")
        self.assertEqual(len(done.json()["remarks"]), 1)


class Metadata(StreamAttack):
    """Metadata in whatever form takes no more than the limit, and is shown all the same."""

    FULL = MIB - 100

    def texts(self):
        numbers = b",".join(b'"%d":0' % i for i in range(70000))
        yield b"[" * (self.FULL // 2) + b"]" * (self.FULL // 2)
        yield b'{"a":' * (self.FULL // 6) + b"0" + b"}" * (self.FULL // 6)
        yield b"[" + b"[]," * (self.FULL // 3) + b"0]"
        yield b"[" * 99 + b"0," * (self.FULL // 2 - 99) + b"0" + b"]" * 99
        yield b"{" + numbers + b"}"
        yield b'"' + b"\\u0000" * (self.FULL // 6) + b'"'
        yield b'"' + b"a" * self.FULL + b'"'

    def test_under_a_limit(self):
        limit = 30 * MB
        for number, text in enumerate(self.texts()):
            json.loads(text) if number > 1 else None
            self.put(metadata_unit(text))
            for tool, *arguments in self.decoders():
                with self.subTest(number=number, tool=tool, arguments=arguments):
                    self.takes(limit, 0, "", tool, self.attack, *arguments, "--max-memory", limit)

    def test_counts_towards_the_limit(self):
        self.put(metadata_unit(b'"' + b"a" * self.FULL + b'"'))
        for tool, *arguments in (("rlpcinfo",), ("rlpcdec", "--verify"), ("rlpcval",)):
            self.takes(MIB, 3, "metadata_size", tool, self.attack, *arguments,
                       "--max-memory", MIB // 2)


class Nested(ToolsTest):
    """Every reader of JSON has the same limit of depth."""

    def setUp(self):
        super().setUp()
        corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
        self.path("b.bin").write_bytes(corners)
        self.document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": "b.bin"}],
            "materials": [{}], "textures": [{}]}

    PLACES = (("extras",), ("asset", "extras"), ("materials", 0, "extras"),
              ("textures", 0, "extras"), ("nodes", 0, "extras"), ("materials", 0, "extensions"),
              ("meshes", 0, "primitives", 0, "extras"))

    def write(self, place, value):
        document = at = copy.deepcopy(self.document)
        for key in place[:-1]:
            at = at[key]
        at[place[-1]] = "THERE"
        self.path("m.gltf").write_text(json.dumps(document).replace('"THERE"', value))
        return self.path("m.gltf")

    def test_in_meshes(self):
        for place in self.PLACES:
            for begin, end in (("[", "]"), ('{"a":', "}")):
                for depth in (150, 20000, 200000):
                    mesh = self.write(place, begin * depth + "0" + end * depth)
                    words = ("nested more than 100 levels", "m.gltf", "line 1, column")
                    self.fails(1, words, "rlpcenc", mesh, "-o", self.path("x.rlpc"))
                    self.fails(2, words, "rlpccmp", mesh, mesh)
                self.ok("rlpcenc", self.write(place, begin * 80 + "0" + end * 80), "-q", "-o",
                        self.path("x.rlpc"))

    def test_in_metadata(self):
        mesh = self.write(("extras",), "0")
        for depth in (150, 20000):
            self.path("m.json").write_text("[" * depth + "]" * depth)
            self.fails(1, ("m.json", "nested more than 100 levels"), "rlpcenc", mesh, "-o",
                       self.path("x.rlpc"), "--metadata", self.path("m.json"))


class EncoderMaterials(MeasuredTest):
    """Materials and images of mesh files: counted, read once, and only images."""

    def put_mesh(self, images, views, binary, name="m.glb"):
        corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
        binary = corners + binary
        document = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                           "min": [0, 0, 0], "max": [1, 1, 0]}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}] + views,
            "buffers": [{"byteLength": len(binary)}],
            "images": images, "textures": [{"source": i} for i in range(len(images))],
            "materials": [{"normalTexture": {"index": 0}}]}
        self.path(name).write_bytes(glb(json.dumps(document).encode(), binary))
        return self.path(name)

    def carried(self, mesh):
        """The asset of the stream that is made of it, as JSON."""
        self.ok("rlpcenc", mesh, "-o", self.path("x.rlpc"), "-q")
        self.ok("rlpcdec", self.path("x.rlpc"), "-o", self.path("y.glb"), "-q")
        data = self.path("y.glb").read_bytes()
        return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])

    def test_images_of_one_view(self):
        picture = PNG + os.urandom(4 * MB)
        view = {"buffer": 0, "byteOffset": 36, "byteLength": len(picture)}
        mesh = self.put_mesh([{"bufferView": 1}] * 500, [view], picture)
        self.takes(100 * MB, 0, "", "rlpcenc", mesh, "-o", self.path("x.rlpc"), "--max-memory",
                   100 * MB)
        self.assertLess(self.path("x.rlpc").stat().st_size, len(picture) + MB)
        self.path("a.png").write_bytes(picture)
        mesh = self.put_mesh([{"uri": "a.png"}] * 500, [], b"")
        self.takes(100 * MB, 0, "", "rlpcenc", mesh, "-o", self.path("x.rlpc"), "--max-memory",
                   100 * MB)
        self.assertLess(self.path("x.rlpc").stat().st_size, len(picture) + MB)

    def test_images_beyond_the_limit(self):
        self.path("a.png").write_bytes(PNG + bytes(60 * MB))
        mesh = self.put_mesh([{"uri": "a.png"}], [], b"")
        self.takes(50 * MB, 1, "images", "rlpcenc", mesh, "-o", self.path("x.rlpc"),
                   "--max-memory", 50 * MB)

    def test_only_images_are_carried(self):
        secret = "password = swordfish"
        for name, data, is_image in (
                ("a.txt", secret.encode(), False), ("a.png", secret.encode(), False),
                ("b.png", PNG, True), ("c.bin", b"\xff\xd8\xff\xe0" + bytes(9), True),
                ("d", b"RIFF\0\0\0\0WEBPVP8 ", True), ("e", b"\xabKTX 20\xbb\r\n\x1a\n", True),
                ("f", b"RIFF\0\0\0\0WAVEfmt ", False), ("g", b"\x89PN", False), ("h", b"", False)):
            self.path(name).write_bytes(data)
            for image, binary in (({"uri": name}, b""), ({"bufferView": 1}, data)):
                if not data and binary is data:
                    continue
                views = [{"buffer": 0, "byteOffset": 36, "byteLength": len(data)}] if binary else []
                mesh = self.put_mesh([image], views, binary)
                done = self.ok("rlpcenc", mesh, "-o", self.path("x.rlpc"))
                self.assertEqual("is not carried" not in done.err, is_image, (name, done.err))
                self.assertEqual("images" in self.carried(mesh), is_image, name)
                self.assertNotIn(secret.encode(), self.path("y.glb").read_bytes())

    def obj(self, lines, mtl=None):
        self.path("m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib m.mtl\n" + lines)
        if mtl is not None:
            self.path("m.mtl").write_text(mtl)
        return self.path("m.obj")

    def test_many_materials(self):
        mesh = self.obj("".join(f"usemtl {i}\nf 1 2 3\n" for i in range(300000)), "newmtl a\n")
        self.takes(200 * MB, 1, "materials and parts", "rlpcenc", mesh, "-o", self.path("x.rlpc"),
                   "--max-memory", 200 * MB)

    def test_many_materials_that_no_triangle_has(self):
        mesh = self.obj("usemtl a\nf 1 2 3\n",
                        "".join(f"newmtl {i}\nKd 1 0 0\n" for i in range(1000000)))
        self.takes(200 * MB, 0, "", "rlpcenc", mesh, "-o", self.path("x.rlpc"), "--max-memory",
                   200 * MB)

    def test_many_textures(self):
        """It took time by the square of their number: minutes."""
        mesh = self.obj("usemtl a\nf 1 2 3\n", "newmtl a\nKd 1 0 0\n" + "".join(
            f"map_Ks {i}.png\n" for i in range(80000)))
        done = self.ok("rlpcenc", mesh, "-o", self.path("x.rlpc"), **within(60))
        self.assertIn("dropped: 80000 textures (0.png, 1.png", done.err)
        self.assertLess(len(done.err), 5000)


class RandomAttacks(StreamAttack):
    """JSON of assets and metadata, at random: nested, wide, long, repeated, or broken."""

    SEED = 4804

    def word(self):
        r = self.random
        return json.dumps(r.choice(("", "a", "name", "\0", "ä", "\"", "x" * r.randrange(2000),
                                    str(r.random()))))

    def scalar(self):
        r = self.random
        return r.choice(("0", "[]", "{}", "true", "1e30", "-1", "1" * r.randrange(1, 400),
                         self.word()))

    def value(self, size):
        r = self.random
        kind = r.randrange(6)
        if size < 10 or kind == 0:
            return self.scalar()
        if kind == 1:
            depth = r.randrange(min(size, 200))
            return "[" * depth + self.scalar() + "]" * depth
        if kind == 2:
            item = self.scalar()
            return "[" + ",".join([item] * (size // (len(item) + 1) + 1)) + "]"
        if kind == 3:
            return "{" + ",".join(f'"{i}":0' for i in range(size // 10)) + "}"
        if kind == 4:
            return "[" + ",".join(self.value(size // 4) for _ in range(4)) + "]"
        return "{" + ",".join(f"{self.word()}:{self.value(size // 4)}" for _ in range(4)) + "}"

    def asset(self, size):
        """Lists of an asset, each of anything; numbers that name each other."""
        r = self.random
        lists = ("materials", "textures", "samplers", "images", "bufferViews", "nodes",
                 "extensionsUsed")
        numbers = '{"index":%d,"source":%d,"bufferView":%d,"byteLength":%d,"name":"n"}' % tuple(
            r.randrange(5) for _ in range(4))
        members = [f'"{name}":[{self.value(size)},{numbers},{numbers}]' for name in lists
                   if r.random() < 0.6]
        return '{"asset":{"version":"2.0"},' + ",".join(members + ['"extras":0']) + "}"

    def test_stay_within_limits(self):
        for number in range(40):
            self.random = r = random.Random(self.SEED + number)
            size = r.choice((100, 10000, 1000000, 10000000))
            if number % 2 == 0:
                text = self.asset(size).encode()
                arguments = r.choice(self.decoders()[:4])
            else:
                text = self.value(min(size, MIB)).encode()[:MIB]
                arguments = r.choice(self.decoders())
            if r.random() < 0.1:
                text = text[:-1]
            self.put(asset_unit(text) if number % 2 == 0 else metadata_unit(text))
            limit = r.choice((2, 10, 50, 200)) * MB
            with self.subTest(seed=self.SEED + number, arguments=arguments, limit=limit):
                tool, *rest = arguments
                result, memory = self.measured(tool, self.attack, *rest, "--max-memory", limit)
                self.assertIn(result.code, (0, 1, 3), result.err)
                usual = self.measured(tool, "--version")[1]
                self.assertLess(memory, usual + limit + self.SLACK)


if __name__ == "__main__":
    main()
