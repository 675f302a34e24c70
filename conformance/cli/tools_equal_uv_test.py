#!/usr/bin/env python3
"""Sets of texture coordinates that are equal to an earlier one: coded once, and there again in
.glb files, with materials that find the same values.

    tools_equal_uv_test.py --bin BUILD/bin [unittest arguments]
"""

import struct
import zlib
from random import Random

from gltf_scene import Scene
from normal_scenes import Builder, sheet
from tools_testing import ToolsTest, main

STEP = 1 / 4096  # decoded texture coordinates, by default


def picture():
    """A PNG file of one pixel."""
    def chunk(name, data):
        return (struct.pack(">I", len(data)) + name + data
                + struct.pack(">I", zlib.crc32(name + data)))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(b"\0\xff\0\0")) + chunk(b"IEND", b""))


class EqualSets(ToolsTest):
    def write(self, kinds, uses):
        """Two sheets, each with sets of the kinds; a texture with each of the sets `uses`. Returns
        the values of the sets by kind, of both sheets."""
        builder = Builder()
        json = builder.json
        values = {}
        for k in range(2):
            xyz, triangles = sheet(4, 4, lambda s, t: [s + 2 * k, t, 0.3 * s * t])
            attributes = {"POSITION": builder.add("VEC3", 5126, xyz)}
            for number, kind in enumerate(kinds):
                chance = Random(kind if kind < 9 or k else 0)  # 9: as 0, but not in both sheets
                uv = [[chance.random(), chance.random()] for _ in xyz]
                values.setdefault(number, []).extend(uv)
                attributes[f"TEXCOORD_{number}"] = builder.add("VEC2", 5126, uv)
            json["meshes"].append({"primitives": [{
                "attributes": attributes, "material": 0,
                "indices": builder.add("SCALAR", 5123, [v for t in triangles for v in t])}]})
            json["nodes"].append({"mesh": k})
            json["scenes"][0]["nodes"].append(k)
        builder.channel(0, "translation", [0, 1], [[0, 0, 0], [1, 0, 0]])
        data = picture()
        json["bufferViews"].append({"buffer": 0, "byteOffset": len(builder.chunk),
                                    "byteLength": len(data)})
        builder.chunk += data + b"\0" * (-len(data) % 4)
        json["images"] = [{"bufferView": len(json["bufferViews"]) - 1, "mimeType": "image/png"}]
        json["textures"] = [{"source": 0}]
        names = ("emissiveTexture", "occlusionTexture", "normalTexture")
        json["materials"] = [{name: {"index": 0, "texCoord": n} for name, n in zip(names, uses)}]
        builder.write(self.path("in.glb"))
        return values

    def check(self, kinds, uses):
        """Returns how many sets the stream has, and rlpcenc's notes."""
        values = self.write(kinds, uses)
        said = self.ok("rlpcenc", self.path("in.glb"), "-o", self.path("a.rlpc"), "--json",
                       "--preset", "fast")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.glb"), "--quiet")
        scene = Scene(self.path("a.glb"))
        found = {number: [] for number in values}
        for primitive in scene.primitives:
            used = sorted(set(primitive.corners))
            for number in values:
                uv = primitive.attributes[f"TEXCOORD_{number}"]
                found[number] += [uv[v] for v in used]
        for number, wanted in values.items():
            self.assertEqual(len(found[number]), len(wanted))
            for a, b in zip(sorted(found[number]), sorted(map(tuple, wanted))):
                self.assertAlmostEqual(a[0], b[0], delta=STEP)
        # Values at the same vertex, so that sets are not exchanged.
        for a, number in enumerate(kinds):
            for b in range(a):
                is_equal = values[a] == values[b]
                self.assertEqual(found[a] == found[b], is_equal, (a, b))
        material, = scene.json["materials"]
        for name, n in zip(("emissiveTexture", "occlusionTexture", "normalTexture"), uses):
            self.assertEqual(values[material[name].get("texCoord", 0)], values[n], name)
        names = [one["name"] for one in said.json()["attributes"]]
        return sum(name.startswith("uv") for name in names), said.err

    def test_two_that_are_equal(self):
        count, told = self.check([1, 1, 2], [1, 2])
        self.assertEqual(count, 2)
        self.assertIn("TEXCOORD_1 is equal to TEXCOORD_0: coded once", told)

    def test_the_last_ones(self):
        count, told = self.check([1, 2, 2, 1], [3, 2, 1])
        self.assertEqual(count, 2)
        self.assertIn("TEXCOORD_2 is equal to TEXCOORD_1, TEXCOORD_3 is equal to TEXCOORD_0", told)

    def test_equal_in_one_part_only(self):
        count, told = self.check([0, 9], [1, 0])
        self.assertEqual(count, 2)
        self.assertNotIn("coded once", told)

    def test_random_sets(self):
        for seed in range(5):
            with self.subTest(seed=seed):
                chance = Random(seed)
                kinds = [chance.randrange(1, 4) for _ in range(chance.randrange(2, 6))]
                uses = [chance.randrange(len(kinds)) for _ in range(3)]
                self.assertEqual(self.check(kinds, uses)[0], len(set(kinds)))


if __name__ == "__main__":
    main()
