#!/usr/bin/env python3
"""Joints whose scale is animated: rlpcenc codes them as stretches of bones, and rlpcdec writes
them as scales again. A reader of .glb files that shares nothing with either computes what frames
must be.

    tools_stretch_test.py --bin BUILD/bin [unittest arguments]
"""

import math
import random
import struct

import normal_scenes
from gltf_scene import Scene
from tools_testing import ToolsTest, main, read_rlpd

FRAMES = 31  # at 30 per second, of one second
JOINTS = 4
LENGTH = 1.5  # of a joint
UNSCALED = [1.0, 1.0, 1.0]


def numbers(path):
    """The positions of a stream, [frame][vertex]."""
    rest, _, frames = read_rlpd(path)
    unit, origin = math.ldexp(1.0, rest[2]), rest[3:6]
    decoded = []
    for data in frames:
        values = struct.unpack(f"<{len(data) // 4}i", data)
        decoded.append([[(values[i + c] + origin[c]) * unit for c in range(3)]
                        for i in range(0, len(values), 3)])
    return decoded


def scales(seeded):
    """The scale of a joint at each of the 11 keys."""
    amount = seeded.choice([0.1, 0.3, 0.6, 1.0])  # of 1.0: to nothing, and to twice the size
    kind = seeded.choice(["uniform", "volume", "free"])
    phase = seeded.uniform(0, 6)
    keys = []
    for i in range(11):
        s = 1 + amount * math.sin(0.6 * i + phase)
        other = {"uniform": s, "volume": 1 / math.sqrt(max(s, 0.3)), "free": 1.0}[kind]
        keys.append([other, s, other])
    return keys


def write_chain(path, seed, is_scaled):
    """A strip along a chain of joints that turn; some are scaled, and those below with them."""
    seeded = random.Random(seed)
    builder = normal_scenes.Builder()
    xyz, triangles = normal_scenes.sheet(
        6, 28, lambda s, t: [s - 0.5, JOINTS * LENGTH * t, 0.3 * math.sin(5 * s + 3 * t)])
    weights, joints = [], []
    for _, y, _ in xyz:
        joints.append([min(int(y / LENGTH), JOINTS - 1), 0, 0, 0])
        weights.append([1.0, 0.0, 0.0, 0.0])
    binds = []
    for j in range(JOINTS):
        binds.append([1.0, 0, 0, 0, 0, 1.0, 0, 0, 0, 0, 1.0, 0, 0, -LENGTH * j, 0, 1.0])
        node = {"translation": [0.0, LENGTH if j else 0.0, 0.0]}
        builder.json["nodes"].append(node | ({"children": [j + 1]} if j + 1 < JOINTS else {}))
        normal_scenes.turn(builder, j, seeded, 1.5)
        keys = scales(seeded)
        if seeded.random() < 0.6:
            normal_scenes.scaled(builder, j, keys if is_scaled else [UNSCALED] * 11)
    builder.json["meshes"] = [{"primitives": [{
        "attributes": {"POSITION": builder.add("VEC3", 5126, xyz),
                       "JOINTS_0": builder.add("VEC4", 5123, joints),
                       "WEIGHTS_0": builder.add("VEC4", 5126, weights)},
        "indices": builder.add("SCALAR", 5125, [i for t in triangles for i in t])}]}]
    builder.json["skins"] = [{"joints": list(range(JOINTS)),
                              "inverseBindMatrices": builder.add("MAT4", 5126, binds)}]
    builder.json["nodes"].append({"mesh": 0, "skin": 0})
    builder.json["scenes"][0]["nodes"] = [0, JOINTS]
    builder.write(path)


def true_frames(path):
    scene = Scene(path)
    return [scene.frame(f / 30)[0][0] for f in range(FRAMES)]


def kg_error(wanted, found):
    """In per cent, with the mean of each frame."""
    error = spread = 0.0
    for frame, other in zip(wanted, found, strict=True):
        mean = [sum(p[c] for p in frame) / len(frame) for c in range(3)]
        for p, q in zip(frame, other, strict=True):
            error += math.dist(p, q) ** 2
            spread += math.dist(p, mean) ** 2
    return 100 * math.sqrt(error / spread)


class Stretch(ToolsTest):
    def encode_scene(self, path, *options, name="a.rlpc"):
        answer = self.ok("rlpcenc", path, "--keep-order", "--no-attributes", "--profile", "high",
                         "--kg", 0.05, "-o", self.path(name), "--json", "--quiet", *options)
        return answer.json()["bytes"]

    def stretches(self, name="a.rlpc"):
        """The number of bones that stretch by themselves."""
        trace = self.ok("rlpcinfo", self.path(name), "--trace").out.decode()
        values = [line.rsplit(" ", 1)[1] for line in trace.splitlines() if "stretch_idc" in line]
        return sum(value != "0" for value in values)

    def test_random_chains(self):
        used = coded = without = 0
        for seed in range(12):
            with self.subTest(seed=seed):
                write_chain(self.path("a.glb"), seed, True)
                wanted = true_frames(self.path("a.glb"))
                coded += self.encode_scene(self.path("a.glb"))
                used += self.stretches() > 0
                self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"))
                decoded = numbers(self.path("a.rlpd"))
                self.assertLessEqual(kg_error(wanted, decoded), 0.05 * 1.0001)
                remarks = self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("b.glb"),
                                  "--as", "skin", "--json").json()["remarks"]
                stated = float(remarks[0].rsplit(" ", 1)[1])
                scene = Scene(self.path("b.glb"))
                apart = max(math.dist(p, q) for f in range(FRAMES)
                            for p, q in zip(scene.frame(f / 30)[0][0], decoded[f], strict=True))
                self.assertLessEqual(apart, 1.001 * stated + 1e-5)
                self.assertEqual(self.stretches() > 0, any(
                    c["target"]["path"] == "scale"
                    for a in scene.json["animations"] for c in a["channels"]))
                without += self.encode_scene(self.path("a.glb"), "--no-input-rig", name="c.rlpc")
        self.assertGreaterEqual(used, 9)
        self.assertLess(coded, 0.8 * without)

    def test_joints_that_keep_their_size_have_none(self):
        write_chain(self.path("a.glb"), 3, False)
        self.encode_scene(self.path("a.glb"))
        self.assertEqual(self.stretches(), 0)

    def test_main_has_none(self):
        write_chain(self.path("a.glb"), 3, True)
        self.ok("rlpcenc", self.path("a.glb"), "--profile", "main", "--kg", 0.1, "--no-attributes",
                "-o", self.path("a.rlpc"), "--quiet")
        self.assertEqual(self.stretches(), 0)


if __name__ == "__main__":
    main()
