#!/usr/bin/env python3
"""Compares normals of decoded frames with those of the input, which a reader of .glb files
computes that shares nothing with encoder and decoder: in scenes whose parts appear, vanish, fold,
mirror and bend, and in small ones that went wrong.

    tools_normals_test.py --bin BUILD/bin [unittest arguments]
"""

import random

from gltf_scene import Scene, cross, degrees, minus
from normal_oracle import Decoded, Oracle
from normal_scenes import FRAMES, MOTIONS, SHAPES, number_of, write_scene
from tools_testing import ToolsTest, main


def areas(count, positions, corners):
    """Twice the area of the triangles of each vertex."""
    vertex_areas = [0.0] * count
    for i in range(0, len(corners), 3):
        a, b, c = (positions[v] for v in corners[i:i + 3])
        area = sum(x * x for x in cross(minus(b, a), minus(c, a))) ** 0.5
        for v in corners[i:i + 3]:
            vertex_areas[v] += area
    return vertex_areas


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


# The promises, in degrees.
LOST = 0.5     # RMS, by which errors may exceed the smallest ones, to save bytes
ROUNDED = 0.6  # largest error of stored vectors
BY_BONES = 2.5  # RMS from the stream: 2 that targets may leave, and half a degree between keys
COMPARED = range(0, FRAMES, 2)


class Comparison:
    """Angles between normals of the input and decoded ones, of vertices that can be seen, in the
    frames that the encoder compares."""

    def __init__(self, test, name):
        scene = Scene(test.path(name))
        # Just after keys of steps, which are floats and may be later than the frame.
        self.frames = [by_number(scene, scene.frame(f / 30 + 1e-6)) for f in COMPARED]
        self.decoded = Decoded(number_of)
        for f in COMPARED:
            self.decoded.add(test.path(f"{f:04d}.obj"))
        glb = Scene(test.path("a.glb"))
        self.by_bones = [{n: normal for n, (normal, _) in by_number(glb, glb.frame(f / 30)).items()}
                         for f in COMPARED]
        largest = {}
        for frame in self.frames:
            for n, (_, size) in frame.items():
                largest[n] = max(largest.get(n, 0.0), size)
        self.numbers = [n for n, size in largest.items() if size > 0]
        for frame in self.frames:  # barely visible sectors do not count
            for n in self.numbers:
                normal, size = frame[n]
                if size < 0.01 * largest[n] or not any(normal):
                    frame[n] = (normal, 0.0)
                else:
                    frame[n] = (normal, size / largest[n])
        self.numbers = [n for n in self.numbers if any(frame[n][1] for frame in self.frames)]
        self.oracle = Oracle(self.frames, self.decoded)

    def rms(self, errors):
        """errors: {number: degrees}, of the numbers that count."""
        weights = {n: sum(frame[n][1] for frame in self.frames) for n in self.numbers}
        return (sum(weights[n] * errors[n] ** 2 for n in self.numbers)
                / sum(weights.values())) ** 0.5

    def smallest(self):
        return self.rms(self.oracle.errors(self.numbers))

    def stream_deviation(self):
        return self.rms({n: self.oracle.mean(n, [degrees(frame[n][0], decoded[n]) for frame, decoded
                                                 in zip(self.frames, self.decoded.normals)])
                         for n in self.numbers})

    def bone_deviation(self):
        """Differences from the normals of the stream."""
        return self.rms({n: self.oracle.mean(n, [degrees(bones[n], decoded[n]) for bones, decoded
                                                 in zip(self.by_bones, self.decoded.normals)])
                         for n in self.numbers})


class NormalsTest(ToolsTest):
    def encode_scene(self, name, *options):
        self.ok("rlpcenc", self.path(name), "-o", self.path("a.rlpc"), "--preset", "fast", *options)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.glb"), "--quiet")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("%04d.obj"), "--quiet")

    def check(self, name):
        comparison = Comparison(self, name)
        smallest = comparison.smallest()
        self.assertLessEqual(comparison.stream_deviation(),
                             (smallest ** 2 + LOST ** 2) ** 0.5 + ROUNDED)
        self.assertLessEqual(comparison.bone_deviation(), BY_BONES)


class Parts(NormalsTest):
    def test_every_shape_with_every_motion(self):
        for i, motion in enumerate(MOTIONS):
            with self.subTest(motion=motion):
                write_scene(self.path("in.glb"), random.Random(500 + i),
                            [("box", "turns")] + [(shape, motion) for shape in SHAPES])
                self.encode_scene("in.glb")
                self.check("in.glb")

    def test_the_fold_of_a_tube_whose_normals_follow_from_the_first_frame(self):
        """A stored vector that is the predicted one would follow the surface, off by 47 degrees."""
        write_scene(self.path("in.glb"), random.Random(502), [("box", "turns"), ("tube", "folds")])
        self.encode_scene("in.glb")
        self.check("in.glb")


class RandomScenes(NormalsTest):
    def test_random_scenes(self):
        for seed in range(3):
            with self.subTest(seed=seed):
                chance = random.Random(seed)
                parts = [(chance.choice(list(SHAPES)), chance.choice(list(MOTIONS)))
                         for _ in range(chance.randrange(2, 5))]
                write_scene(self.path("in.glb"), chance, parts)
                self.encode_scene("in.glb")
                self.check("in.glb")


if __name__ == "__main__":
    main()
