#!/usr/bin/env python3
"""Arithmetic of scripts/compare_gltf, without node and without any codec."""

import array
import copy
import math
import pathlib
import struct
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "scripts" / "studies" / name)
                for name in ("gltf_comparison", "comparison", "figures")]
import gltf_file
import measure
import paths
import report
import soup
import static_meshes


def turned(points, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [x for x, y, z in zip(*[iter(points)] * 3) for x in (c * x - s * y, s * x + c * y, z)]


def fan(num, shift=0.0, uv_shift=0.0, degrees=0.0):
    """Triangles around the origin, of which each has vertices of its own; in two samples."""
    positions, uv = [], []
    for i in range(num):
        step = math.pi * 2 / max(num, 3)
        # Rounded: corners that belong together coincide.
        rim = [(round(math.cos(a * step), 9), round(math.sin(a * step), 9)) for a in (i, i + 1)]
        for x, y in ((0.0, 0.0), *rim):
            positions += [x + shift, y, 0.0]
            uv += [x / 2 + 0.5 + uv_shift, y / 2 + 0.5]
    frames = [positions, turned(positions, 30)]
    normals = [turned([0.6, 0.0, 0.8], degrees) * (3 * num)] * 2
    return soup.Soup(frames, normals, [uv], list(range(3 * num)), ["Turn"])


def shuffled(drawn, shift):
    """The triangles in another order, each beginning with another corner."""
    num = drawn.num_corners // 3
    order = [3 * ((t + shift) % num) + (k + 1) % 3 for t in range(num) for k in range(3)]

    def of(values, width):
        return [x for c in order for x in values[width * c:width * c + width]]
    return soup.Soup([of(p, 3) for p in drawn.positions], [of(n, 3) for n in drawn.normals],
                     [of(u, 2) for u in drawn.uv], list(range(drawn.num_corners)), drawn.clips)


class Drawn(unittest.TestCase):
    def test_triangles_are_found_in_any_order(self):
        source = fan(9)
        other = shuffled(source, 4)
        found, _ = soup.match(source, other)
        self.assertEqual(sorted(found), list(range(27)))
        for corner, place in enumerate(found):
            self.assertEqual(source.corner(0, corner), other.corner(0, place))
        self.assertEqual(soup.kg_error_percent(source, other, found), 0)

    def test_kg_error_is_relative_to_positions_without_their_mean(self):
        source, other = fan(9), shuffled(fan(9, shift=0.003), 2)
        found, _ = soup.match(source, other)
        energy = sum((x - y) ** 2 for p in source.positions for c in range(3)
                     for x, y in zip(p[c::3], [sum(p[c::3]) / 27] * 27))
        expected = 100 * math.sqrt(2 * 27 * 0.003 ** 2 / energy)
        self.assertAlmostEqual(soup.kg_error_percent(source, other, found), expected, 9)

    def test_errors_of_texture_coordinates_and_normals(self):
        source, other = fan(9), shuffled(fan(9, uv_shift=1 / 2048, degrees=10), 5)
        found, _ = soup.match(source, other)
        self.assertAlmostEqual(soup.uv_error_steps(source, other, found), 2, 9)
        # A vector at 37 degrees from the axis turns by less than its axis does.
        angle = math.degrees(math.acos(0.64 + 0.36 * math.cos(math.radians(10))))
        for found_angle in soup.normal_errors_degrees(source, other, found, 1):
            self.assertAlmostEqual(found_angle, angle, 6)
        without_extent = copy.deepcopy(other)
        without_extent.normals = [[0.0] * len(n) for n in other.normals]
        self.assertIsNone(soup.normal_errors_degrees(source, without_extent, found, 0))
        other.normals = []
        self.assertIsNone(soup.normal_errors_degrees(source, other, found, 0))

    def test_coincident_triangles_go_by_their_texture_coordinates(self):
        source = fan(1)
        twin = fan(1, uv_shift=0.25)
        both = soup.Soup([a + b for a, b in zip(source.positions, twin.positions)],
                         [a + b for a, b in zip(source.normals, twin.normals)],
                         [source.uv[0] + twin.uv[0]], list(range(6)), [])
        self.assertEqual(list(soup.match(both, both)[0]), list(range(6)))

    def test_triangles_without_area_are_left_out(self):
        source = fan(3)
        for p in source.positions:
            p[3:6] = p[0:3]
        self.assertEqual(list(soup.match(source, source)[0])[:3], [-1, -1, -1])


class Seams(unittest.TestCase):
    def test_all_are_closed(self):
        source = fan(9)
        found = soup.cracks(source, source, *soup.match(source, source))
        self.assertEqual((found.groups, found.together, found.closed), (10, 10, 10))
        self.assertEqual(found.largest_gap_percent, 0)

    def test_a_crack_in_one_frame_counts(self):
        source, other = fan(9), fan(9)
        other.positions[1][3] += 0.01  # a corner at the rim, which two triangles share
        found = soup.cracks(source, other, *soup.match(source, other))
        self.assertEqual((found.together, found.closed), (10, 9))
        self.assertAlmostEqual(found.largest_gap_percent, 1 / soup.diagonal(source), 6)

    def test_pieces_upon_each_other_are_no_cracks(self):
        source = fan(9)
        twice = soup.Soup([p * 2 for p in source.positions], [n * 2 for n in source.normals],
                          [source.uv[0] * 2], list(range(54)), [])
        found, alternatives = soup.match(source, twice)
        found[3:6] = array.array("q", [30, 31, 32])  # the other piece, which is a bit off
        for p in twice.positions:
            for i in range(81, 162):
                p[i] += 1e-5
        self.assertEqual(soup.cracks(source, twice, found, {}).closed, 7)
        self.assertEqual(soup.cracks(source, twice, found, alternatives).closed, 10)

    def test_what_the_source_opens_is_not_expected_to_be_closed(self):
        source = fan(9)
        source.positions[1][3] += 0.01
        found = soup.cracks(source, source, *soup.match(source, source))
        self.assertEqual((found.groups, found.together, found.closed), (10, 9, 9))


class Files(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="rlpc-gltf-test-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_clips_of_a_file(self):
        found = gltf_file.clips(ROOT / "streams" / "inputs" / "tulip.glb")
        self.assertEqual([clip.num_frames for clip in found], [61, 54])  # 2 s and 1.75 s
        self.assertEqual(found[1].first_frame, found[0].num_frames)
        samples = gltf_file.frame_samples(found, 5)
        self.assertEqual(samples[0], (0, 0))
        self.assertEqual(samples[-1], (1, found[1].num_frames - 1))

    def test_gltf_becomes_glb(self):
        document, binary = gltf_file.read(ROOT / "streams" / "inputs" / "tulip.glb")
        (self.folder / "a.bin").write_bytes(binary)
        document["buffers"] = [{"uri": "a.bin", "byteLength": len(binary)}]
        path = self.folder / "a.gltf"
        path.write_text(gltf_file.json.dumps(document), encoding="utf-8")
        self.assertEqual(gltf_file.source_bytes(path), path.stat().st_size + len(binary))
        again, bytes_again = gltf_file.read(gltf_file.as_glb(path, self.folder))
        self.assertEqual(again["meshes"], document["meshes"])
        self.assertEqual(bytes_again[:len(binary)], binary)

    def test_paths_find_their_counterparts(self):
        frames = [[float(v + 10 * f), 0.0, f * (-1.0) ** v] for f in range(4) for v in range(3)]
        joined = [sum(frames[3 * f:3 * f + 3], []) for f in range(4)]
        order = [2, 0, 1, 0]
        mixed = [sum((p[3 * v:3 * v + 3] for v in order), []) for p in joined]
        for name, data in (("a.pc2", joined), ("b.pc2", mixed)):
            (self.folder / name).write_bytes(
                struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(data[0]) // 3, 0, 1, len(data))
                + b"".join(array.array("f", frame).tobytes() for frame in data))
        with paths.PointCache(self.folder / "a.pc2") as a, \
                paths.PointCache(self.folder / "b.pc2") as b:
            found = paths.nearest(a, b, range(4))
            self.assertEqual([order[w] for w in found], [0, 1, 2])
            paths.write_matched(a, b, range(4), found, self.folder / "c.pc2")
        self.assertEqual((self.folder / "c.pc2").read_bytes()[32:],
                         (self.folder / "a.pc2").read_bytes()[32:])

    def test_frames_of_clips_that_grew_or_shrank(self):
        a = [gltf_file.Clip(3, 0), gltf_file.Clip(2, 3)]
        b = [gltf_file.Clip(4, 0), gltf_file.Clip(1, 4)]
        self.assertEqual(paths.joined_frames(a, b), [0, 1, 2, 4, 4])
        with self.assertRaises(measure.Failure):
            paths.joined_frames(a, b[:1])


class StaticMesh(unittest.TestCase):
    def setUp(self):
        self.mesh = static_meshes.mesh_of(fan(9))

    def test_equal_values_are_one(self):
        self.assertEqual((len(self.mesh.positions), len(self.mesh.uv), len(self.mesh.normals),
                          len(self.mesh.triangles)), (10, 10, 1, 9))

    def test_written_and_read(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.obj"
            path.write_text(self.mesh.words(), encoding="utf-8")
            again = static_meshes.read_obj(path)
        self.assertEqual(again.triangles, self.mesh.triangles)
        self.assertEqual(again.soup().uv, self.mesh.soup().uv)

    def test_shrunk_positions_differ_within_a_step(self):
        positions = [[float(x) for x in p] for p in static_meshes.shrunk(self.mesh)]
        self.assertEqual(len({tuple(p) for p in positions}), 10)
        self.assertLess(max(abs(x) for p in positions[1:] for x in p), 2 ** -20)

    def test_bits_of_texture_coordinates(self):
        self.assertEqual(static_meshes.uv_bits(self.mesh), 12)
        self.mesh.uv = [[f"{8 * float(x)}" for x in t] for t in self.mesh.uv]
        self.assertEqual(static_meshes.uv_bits(self.mesh), 9)


class Tables(unittest.TestCase):
    def test_text_is_aligned(self):
        table = report.Table("", ["name", "kB"], [["fox", "1.5"], ["q-trex", "33.2"]])
        self.assertEqual(table.text(), "name      kB\nfox      1.5\nq-trex  33.2\n")


if __name__ == "__main__":
    unittest.main()
