#!/usr/bin/env python3
"""Normals of decoded frames beside those of the input, which a reader of .glb files computes that
shares nothing with encoder and decoder: in scenes whose parts appear, vanish, fold, mirror and
bend, and in small ones that went wrong.

    tools_normals_test.py --bin BUILD/bin [unittest arguments]
"""

import random

from gltf_scene import Scene, cross, degrees, minus
from normal_scenes import FRAMES, MOTIONS, SHAPES, number_of, write_scene
from tools_testing import ToolsTest, main


def areas(count, positions, corners):
    """Of each vertex, the areas of its triangles, twice."""
    of_vertex = [0.0] * count
    for i in range(0, len(corners), 3):
        a, b, c = (positions[v] for v in corners[i:i + 3])
        area = sum(x * x for x in cross(minus(b, a), minus(c, a))) ** 0.5
        for v in corners[i:i + 3]:
            of_vertex[v] += area
    return of_vertex


def by_number(scene, frame):
    """{number of a vertex: (normal, area)} of a frame of a scene."""
    found = {}
    for primitive, (positions, normals) in zip(scene.primitives, frame):
        sizes = areas(len(positions), positions, primitive.corners)
        for uv, normal, size in zip(primitive.attributes["TEXCOORD_0"], normals, sizes):
            number = number_of(uv)
            if size > found.get(number, ((), -1.0))[1]:
                found[number] = (normal, size)
    return found


def normals_of_obj(path):
    """{number of a vertex: normal} of an OBJ file."""
    uv, normals, found = [], [], {}
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["vt"]:
            uv.append([float(words[1]), 1 - float(words[2])])
        elif words[:1] == ["vn"]:
            normals.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            for word in words[1:]:
                _, t, n = word.split("/")
                found[number_of(uv[int(t) - 1])] = normals[int(n) - 1]
    return found


class Comparison:
    """Angles between normals of the input and decoded ones, of vertices that can be seen."""

    def __init__(self, path):
        self.scene = Scene(path)
        self.frames = {}
        self.largest = {}

    def want(self, frames):
        for f in frames:
            self.frames[f] = by_number(self.scene, self.scene.frame(f / 30))
            for number, (_, size) in self.frames[f].items():
                self.largest[number] = max(self.largest.get(number, 0.0), size)

    def angles(self, f, decoded):
        """Sorted. decoded: {number: normal}."""
        found = []
        for number, (normal, size) in self.frames[f].items():
            if size < 0.04 * self.largest[number] or not any(normal):
                continue
            found.append(degrees(normal, decoded[number]))
        return sorted(found)


class NormalsTest(ToolsTest):
    def encode_scene(self, name, *options):
        """What rlpcenc says."""
        answer = self.ok("rlpcenc", self.path(name), "-o", self.path("a.rlpc"), "--preset", "fast",
                         *options)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.glb"), "--quiet")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("%04d.obj"), "--quiet")
        return answer

    def compare(self, name, frames):
        """{frame: (angles of the .glb file, angles of OBJ files)}"""
        comparison = Comparison(self.path(name))
        comparison.want(range(0, FRAMES, 3))
        comparison.want(frames)
        decoded = Scene(self.path("a.glb"))
        return {f: (comparison.angles(f, {number: normal for number, (normal, _) in
                                          by_number(decoded, decoded.frame(f / 30)).items()}),
                    comparison.angles(f, normals_of_obj(self.path(f"{f:04d}.obj"))))
                for f in frames}

    def check(self, name, frames, has_folds):
        """Bounds, in degrees: on the mean, and on what most vertices are within."""
        mean, most, part = (15, 60, 0.9) if has_folds else (4, 20, 0.98)
        for f, kinds in self.compare(name, frames).items():
            for kind, angles in zip(("glb", "obj"), kinds):
                if not angles:
                    continue
                with self.subTest(frame=f, kind=kind):
                    self.assertLess(sum(angles) / len(angles), mean)
                    self.assertLess(angles[int(part * (len(angles) - 1))], most)


class Parts(NormalsTest):
    """Each shape with each motion, between others that turn."""

    def test_every_motion(self):
        for i, motion in enumerate(MOTIONS):
            for j, shape in enumerate(SHAPES):
                with self.subTest(motion=motion, shape=shape):
                    chance = random.Random(100 * i + j)
                    frames = write_scene(self.path("in.glb"), chance,
                                         [("box", "turns"), (shape, motion)])
                    self.encode_scene("in.glb")
                    self.check("in.glb", frames, motion == "folds")


class RandomScenes(NormalsTest):
    def test_random_scenes(self):
        for seed in range(6):
            with self.subTest(seed=seed):
                chance = random.Random(seed)
                parts = [(chance.choice(list(SHAPES)), chance.choice(list(MOTIONS)))
                         for _ in range(chance.randrange(2, 7))]
                frames = write_scene(self.path("in.glb"), chance, parts)
                self.encode_scene("in.glb")
                self.check("in.glb", frames + [chance.randrange(1, FRAMES - 1)],
                           "folds" in dict(map(reversed, parts)))


if __name__ == "__main__":
    main()
