#!/usr/bin/env python3
"""Texture coordinates, normals, colours and materials in OBJ and PLY files, through the tools.

    tools_attributes_test.py --bin BUILD/bin [unittest arguments, such as ObjAttributes]
"""

import json
import math
import shutil
import struct
import subprocess
import sys

from tools_testing import ROOT, ToolsTest, main, write_pc2

sys.path.insert(0, str(ROOT / "conformance" / "specdec"))
from specdec_testing import stream_of, units_of

AROUND, ALONG = 16, 9  # a closed tube whose texture has a seam
ATTRIBUTES, ASSET = 0x88, 0x89  # types of units
HALF_STEP = 1 / 8192   # texture coordinates
ENCODE = ["--kg", 0.1, "--keep-order", "--quiet"]


def angle(k, frame):
    """Position of a vertex; the tube turns by 17 degrees per frame."""
    return 2 * math.pi * k / AROUND + 0.3 * frame


def tube(frame):
    """Positions of a frame: (x, y, z) each; the caps have a vertex in the middle."""
    points = []
    for i in range(ALONG):
        bend = 0.02 * frame * i
        for k in range(AROUND):
            a = angle(k, frame)
            points.append((math.cos(a) + bend, math.sin(a), 0.5 * i))
    return points + [(0, 0, 0), (0.02 * frame * (ALONG - 1), 0, 0.5 * (ALONG - 1))]


def faces():
    """Quads and the triangles of the caps: lists of (vertex, (u, v), normal)."""
    result = []
    for i in range(ALONG - 1):
        for k in range(AROUND):
            result.append([((i + b) * AROUND + (k + a) % AROUND,
                            ((k + a) / AROUND, (i + b) / (ALONG - 1)), (k + a) % AROUND)
                           for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))])
    for k in range(AROUND):
        first, last = k, (ALONG - 1) * AROUND + k
        after, before = (k + 1) % AROUND, (ALONG - 1) * AROUND + (k + 1) % AROUND
        middle = ALONG * AROUND
        spots = [(0.5 + 0.5 * math.cos(2 * math.pi * j / AROUND),
                  0.5 + 0.5 * math.sin(2 * math.pi * j / AROUND)) for j in (k, k + 1)]
        result.append([(after, spots[1], AROUND), (first, spots[0], AROUND),
                       (middle, (0.5, 0.5), AROUND)])
        result.append([(last, spots[0], AROUND + 1), (before, spots[1], AROUND + 1),
                       (middle + 1, (0.5, 0.5), AROUND + 1)])
    return result


def obj_text(frame=0, uv=True, normals=True, between=lambda f: ""):
    """between(f): lines before face f."""
    lines, coordinates = ["v %.9g %.9g %.9g" % p for p in tube(frame)], {}
    for k in range(AROUND):
        a = angle(k, frame)
        lines.append("vn %.4f %.4f 0" % (math.cos(a), math.sin(a)))
    lines += ["vn 0 0 -1", "vn 0 0 1"]
    body = []
    for f, face in enumerate(faces()):
        words = []
        for vertex, value, normal in face:
            number = coordinates.setdefault(value, len(coordinates) + 1)
            words.append(f"{vertex + 1}" + (f"/{number if uv else ''}" if uv or normals else "")
                         + (f"/{normal + 1}" if normals else ""))
        body.append(between(f) + "f " + " ".join(words))
    return "\n".join(lines + ["vt %.9g %.9g" % value for value in coordinates] + body) + "\n"


class Mesh:
    """An OBJ file: positions, and of each triangle its corners, (vertex, uv, normal) each."""

    def __init__(self, path):
        self.xyz, uv, normals, self.triangles, self.materials, self.groups = [], [], [], [], [], []
        self.libraries, material, group = [], None, None
        for line in path.read_text().splitlines():
            key, *words = line.split()
            if key in ("v", "vt", "vn"):
                {"v": self.xyz, "vt": uv, "vn": normals}[key].append(tuple(map(float, words)))
            elif key == "mtllib":
                self.libraries += words
            elif key == "usemtl":
                material = words[0]
            elif key == "g":
                group = " ".join(words)
            elif key == "f":
                corners = [(w + "//").split("/")[:3] for w in words]
                corners = [(int(v) - 1, uv[int(t) - 1] if t else None,
                            normals[int(n) - 1] if n else None)
                           for v, t, n in corners]
                for k in range(1, len(corners) - 1):
                    self.triangles.append((corners[0], corners[k], corners[k + 1]))
                    self.materials.append(material)
                    self.groups.append(group)

    def corners(self):
        """{(triangle as a set of vertices, vertex): (uv, normal)}"""
        return {(frozenset(v for v, _, _ in t), v): (uv, n)
                for t in self.triangles for v, uv, n in t}


class AttributesTest(ToolsTest):
    def sequence(self, frames=6, folder="in", **options):
        self.path(folder).mkdir()
        for f in range(frames):
            (self.path(folder) / f"tube_{f}.obj").write_text(obj_text(f, **options))
        return self.path(folder)

    def encode_to(self, name, *source):
        stream = self.path(name)
        self.ok("rlpcenc", *source, "-o", stream, *ENCODE)
        return stream

    def expect_same_uv(self, found, wanted):
        found, wanted = found.corners(), wanted.corners()
        self.assertEqual(found.keys(), wanted.keys())
        for corner, (uv, _) in wanted.items():
            for a, b in zip(found[corner][0], uv):
                self.assertLessEqual(abs(a - b), HALF_STEP + 1e-6)


class ObjAttributes(AttributesTest):
    def test_texture_coordinates_and_normals_come_back(self):
        source = self.sequence()
        stream = self.encode_to("tube.rlpc", source)
        self.ok("rlpcdec", stream, "-o", self.path("out"))
        for f in range(6):
            wanted = Mesh(source / f"tube_{f}.obj")
            found = Mesh(self.path("out") / f"frame_000{f}.obj")
            self.assertEqual(len(found.xyz), len(wanted.xyz))  # no vertex is split: no cracks
            self.expect_same_uv(found, wanted)
            corners = wanted.corners()
            for corner, (_, normal) in found.corners().items():
                cosine = sum(a * b for a, b in zip(normal, corners[corner][1]))
                # The tube is bent, which its normals do not follow: all frames share that error.
                self.assertGreater(cosine, math.cos(math.radians(11)), (f, corner))
        self.ok("rlpcdec", stream, "-o", self.path("again"))
        for f in range(6):
            name = f"frame_000{f}.obj"
            self.assertEqual((self.path("again") / name).read_bytes(),
                             (self.path("out") / name).read_bytes())

    def test_seams_stay(self):
        self.path("a.obj").write_text(obj_text())
        stream = self.encode_to("a.rlpc", self.path("a.obj"))
        self.ok("rlpcdec", stream, "-o", self.path("b.obj"))

        def seams(mesh):
            values = {}
            for (_, vertex), (uv, normal) in mesh.corners().items():
                values.setdefault(vertex, set()).add((uv, normal))
            return {v: (len({uv for uv, _ in of}), len({n for _, n in of}))
                    for v, of in values.items()}
        wanted, found = seams(Mesh(self.path("a.obj"))), seams(Mesh(self.path("b.obj")))
        self.assertEqual({v: uv for v, (uv, _) in found.items()},
                         {v: uv for v, (uv, _) in wanted.items()})
        self.assertEqual(max(uv for uv, _ in found.values()), 3)  # at the caps
        # Every generation has the same values.
        second = self.encode_to("b.rlpc", self.path("b.obj"))
        self.ok("rlpcdec", second, "-o", self.path("c.obj"))
        self.assertEqual({c: uv for c, (uv, _) in Mesh(self.path("c.obj")).corners().items()},
                         {c: uv for c, (uv, _) in Mesh(self.path("b.obj")).corners().items()})

    def test_streams_are_the_same_whatever_the_threads(self):
        source = self.sequence()
        streams = [self.encode_to(f"{n}.rlpc", source, "--threads", n).read_bytes() for n in (1, 2)]
        self.assertEqual(*streams)

    def test_meshes_without_attributes_give_the_same_streams(self):
        plain = obj_text(uv=False, normals=False)
        self.path("a.obj").write_text(plain)
        self.path("b.obj").write_text("mtllib none.mtl\no tube\nusemtl skin\n" + plain)
        streams = [self.encode_to(f"{n}.rlpc", self.path(f"{n}.obj")).read_bytes() for n in "ab"]
        self.assertEqual(*streams)

    def test_materials_and_parts(self):
        marks = {0: "o side\nusemtl green\n", 64: "g upper\n", 128: "o caps\ng\nusemtl red skin\n"}
        text = obj_text(between=lambda f: marks.get(f, ""))
        self.path("in").mkdir()
        (self.path("in") / "a.mtl").write_text("newmtl green\nmap_Kd maps/leaf.png\n"
                                               "map_Ks gloss.png\nnewmtl red skin\nKd 1 0 0\n")
        (self.path("in") / "maps").mkdir()
        leaf = b"\x89PNG of a leaf"
        (self.path("in") / "maps/leaf.png").write_bytes(leaf)
        (self.path("in") / "a.obj").write_text("mtllib a.mtl\n" + text)
        result = self.ok("rlpcenc", self.path("in/a.obj"), "-o", self.path("a.rlpc"),
                         "--keep-order")
        self.assertIn("dropped: 1 texture (gloss.png); only those of map_Kd, map_Ke and norm are "
                      "kept", result.err)
        self.fails(64, "a.mtl: is also an input", "rlpcenc", self.path("in/a.obj"), "-o",
                   self.path("in/a.mtl"))
        for output, mesh, library in (("b.obj", "b.obj", "b.mtl"), ("c.pc2", "c.obj", "c.mtl"),
                                      ("out/walk_%d.obj", "out/walk_0.obj", "walk.mtl")):
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path(output))
            found = Mesh(self.path(mesh))
            self.assertEqual(found.libraries, [library])
            lines = (self.path(mesh).parent / library).read_text()
            image = library.replace(".mtl", "_0.png")
            self.assertIn(f"newmtl green\nKd 1 1 1\nPm 0\nmap_Kd {image}\n", lines)
            self.assertIn("newmtl red_skin\nKd 1 0 0\n", lines)
            self.assertEqual((self.path(mesh).parent / image).read_bytes(), leaf)
            wanted = Mesh(self.path("in/a.obj"))
            materials = {frozenset(v for v, _, _ in t): m
                         for t, m in zip(wanted.triangles, wanted.materials)}
            groups = set()
            for t, material, group in zip(found.triangles, found.materials, found.groups):
                name = materials[frozenset(v for v, _, _ in t)]
                self.assertEqual(material, {"green": "green", "red": "red_skin"}[name])
                groups.add((name, group))
            self.assertEqual(len(groups), 3)
            self.expect_same_uv(found, wanted)
        # Again an input, with its image.
        self.ok("rlpcenc", self.path("b.obj"), "-o", self.path("e.rlpc"), "--keep-order")
        self.ok("rlpcdec", self.path("e.rlpc"), "-o", self.path("e.obj"))
        self.assertEqual(self.path("e_0.png").read_bytes(), leaf)
        # A file that rlpcdec has not written stays.
        self.path("d.mtl").write_text("newmtl mine\n")
        for output in ("d.obj", "d.pc2", "d%d.obj"):
            self.fails(4, "d.mtl: already exists, and is not known to be written by rlpcdec",
                       "rlpcdec", self.path("a.rlpc"), "-o", self.path(output))
            self.assertEqual(self.path("d.mtl").read_text(), "newmtl mine\n")

    def test_material_files_elsewhere_are_not_read(self):
        self.path("in").mkdir()
        self.path("secret.mtl").write_text("map_Kd secret.png\n")
        for name in ("../secret.mtl", self.path("secret.mtl"), "-", "missing.mtl"):
            (self.path("in") / "a.obj").write_text(f"mtllib {name}\nusemtl m\n" + obj_text())
            result = self.ok("rlpcenc", self.path("in/a.obj"), "-o", self.path("a.rlpc"))
            self.assertNotIn("secret.png", result.err)
            self.assertEqual([code for code, _ in units_of(self.path("a.rlpc").read_bytes())
                              if code == ASSET], [])

    def test_other_texture_coordinates_in_a_later_file_are_noted(self):
        source = self.sequence()
        later = source / "tube_3.obj"
        later.write_text(later.read_text().replace("\nvt 0 0\n", "\nvt 0.25 0\n"))
        first = source / "tube_0.obj"
        note = f"{later}: uv0 differs from that of {first}, which is kept for all frames"
        result = self.ok("rlpcenc", source, "-o", self.path("a.rlpc"), "--keep-order")
        self.assertEqual(result.err.count(note), 1, result.err)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("out"))
        self.expect_same_uv(Mesh(self.path("out/frame_0003.obj")), Mesh(source / "tube_0.obj"))

    def test_normals_of_frames_need_no_note(self):
        source = self.sequence()
        for f in range(6):
            path = source / f"tube_{f}.obj"
            path.write_text(path.read_text().replace("vn 1.0000 0.0000 0", f"vn 1 0 {0.01 * f}"))
        result = self.ok("rlpcenc", source, "-o", self.path("a.rlpc"))
        self.assertNotIn("differs", result.err)
        first = source / "tube_0.obj"
        first.write_text(obj_text(uv=False, normals=False))
        result = self.ok("rlpcenc", source, "-o", self.path("a.rlpc"))
        self.assertIn(f"tube_1.obj: uv0 is dropped, as {first} has none", result.err)

    def test_point_caches_take_those_of_the_mesh(self):
        self.path("a.obj").write_text(obj_text())
        write_pc2(self.path("a.pc2"), [[x for p in tube(f) for x in p] for f in range(6)])
        data = self.path("a.pc2").read_bytes()
        live = ["--points", "-", "--profile", "high", "--low-delay", "--keep-order", "--quiet"]
        self.ok("rlpcenc", self.path("a.obj"), *live, "-o", self.path("live.rlpc"), input=data)
        stored = self.encode_to("a.rlpc", self.path("a.obj"), "--points", self.path("a.pc2"))
        for stream in (stored, self.path("live.rlpc")):
            self.ok("rlpcdec", stream, "-o", self.path("b.mdd"))
            self.expect_same_uv(Mesh(self.path("b.obj")), Mesh(self.path("a.obj")))

    def test_attributes_can_be_left_out(self):
        self.path("a.obj").write_text(obj_text())
        self.path("plain.obj").write_text(obj_text(uv=False, normals=False))
        self.ok("rlpcdec", self.encode_to("a.rlpc", self.path("a.obj")), "--no-attributes", "-o",
                self.path("b.obj"))
        self.ok("rlpcdec", self.encode_to("p.rlpc", self.path("plain.obj")), "-o",
                self.path("c.obj"))
        self.assertEqual(self.path("b.obj").read_bytes(), self.path("c.obj").read_bytes())

    def test_indices_out_of_range_are_named(self):
        for line, words in (("f 1/999 2 3", "texture coordinate index 999 is out of range 1 to"),
                            ("f 1//1 2//0 3", "normal index 0; counting starts at 1"),
                            ("f 1/-999/1 2/1/1 3/1/1", "texture coordinate index -999, but only")):
            text = obj_text() + line + "\n"
            self.path("a.obj").write_text(text)
            place = f"a.obj:{text.count(chr(10))}: "
            self.fails(1, place + words, "rlpcenc", self.path("a.obj"), "-o", self.path("a.rlpc"))

    def test_damaged_attributes_leave_the_frames(self):
        stream = self.encode_to("a.rlpc", self.sequence())
        self.ok("rlpcdec", stream, "--no-attributes", "-o", self.path("plain"))
        data = stream.read_bytes()
        units = [(code, payload[:-9] if code == ATTRIBUTES else payload)
                 for code, payload in units_of(data)]
        stream.write_bytes(stream_of(data, units))
        self.fails(1, ["a.rlpc: ", "frames are written without attributes"], "rlpcdec", stream,
                   "-o", self.path("out"), "--quiet")
        for f in range(6):
            name = f"frame_000{f}.obj"
            self.assertEqual((self.path("out") / name).read_bytes(),
                             (self.path("plain") / name).read_bytes())

    def test_a_damaged_unit_can_be_left_out(self):
        self.path("a.obj").write_text(obj_text())
        stream = self.encode_to("a.rlpc", self.path("a.obj"))
        self.ok("rlpcdec", stream, "--no-attributes", "-o", self.path("plain.obj"))
        data = bytearray(stream.read_bytes())
        payload = next(payload for code, payload in units_of(data) if code == ATTRIBUTES)
        data[data.index(payload) + 9] ^= 1
        damaged = self.path("damaged.rlpc")
        damaged.write_bytes(data)
        self.fails(1, "R-UNT-03", "rlpcdec", damaged, "-o", self.path("b.obj"))
        self.assertFalse(self.path("b.obj").exists())
        self.fails(1, "the unit is skipped, no frame needs it", "rlpcdec", damaged, "--conceal",
                   "--quiet", "-o", self.path("b.obj"))
        self.assertEqual(self.path("b.obj").read_bytes(), self.path("plain.obj").read_bytes())

    def test_cuts_keep_those_that_do_not_need_the_first_frame(self):
        source, cut = self.sequence(), self.path("cut.rlpc")
        for options, stay in (((), False), (("--component-groups", 2), True)):
            stream = self.encode_to("a.rlpc", source, *options)
            said = self.ok("rlpcinfo", stream, "--extract", "components=0", "-o", cut).out.decode()
            self.assertEqual("attributes are dropped: " in said, not stay)
            report = self.ok("rlpcinfo", stream, "--extract", "components=0", "-o", cut,
                             "--json").json()
            self.assertEqual(report["attributes_dropped"], not stay)
            self.ok("rlpcval", cut)
            self.ok("rlpcdec", cut, "-o", self.path("out/%04d.obj"))
            found = Mesh(self.path("out/0000.obj"))
            if stay:
                self.expect_same_uv(found, Mesh(source / "tube_0.obj"))
            else:
                self.assertEqual({uv for uv, _ in found.corners().values()}, {None})
            shutil.rmtree(self.path("out"))
            # Nothing is cut.
            self.ok("rlpcinfo", stream, "--extract", "components=9999", "-o", cut)
            self.ok("rlpcdec", cut, "-o", self.path("out/%04d.obj"))
            self.expect_same_uv(Mesh(self.path("out/0000.obj")), Mesh(source / "tube_0.obj"))
            shutil.rmtree(self.path("out"))

    def test_rlpcinfo_lists_them(self):
        self.path("a.obj").write_text(obj_text())
        stream = self.encode_to("a.rlpc", self.path("a.obj"))
        table = self.ok("rlpcinfo", stream).out.decode()
        self.assertRegex(table, r"\n    uv0: corners, 2 x \d+ bits, integers, \d+ values\n")
        self.assertRegex(table, r"\n    normal: corners, smoothing\n")
        report = json.loads(self.ok("rlpcinfo", stream, "--json").out)
        self.assertEqual([(a["name"], a["domain"], a["kind"]) for a in report["attributes"]],
                         [("normal", "corners", "smoothing"), ("uv0", "corners", "integers")])
        size = sum(len(payload)
                   for code, payload in units_of(stream.read_bytes()) if code == ATTRIBUTES)
        self.assertEqual(report["bits"]["attributes"], 8 * size)
        self.assertEqual(sum(report["bits"].values()), 8 * len(stream.read_bytes()))
        # One of which only the frames can be decoded.
        data = stream.read_bytes()
        units = [(code, payload[:-9] if code == ATTRIBUTES else payload)
                 for code, payload in units_of(data)]
        stream.write_bytes(stream_of(data, units))
        self.assertIn("cannot be decoded: ", self.ok("rlpcinfo", stream).out.decode())


class PlyAttributes(AttributesTest):
    def test_vertices_are_split_without_gaps(self):
        self.path("a.obj").write_text(obj_text())
        stream = self.encode_to("a.rlpc", self.path("a.obj"))
        self.ok("rlpcdec", stream, "-o", self.path("a.ply"), "--ascii")
        head, body = self.path("a.ply").read_text().split("end_header\n")
        names = [line.split()[2] for line in head.splitlines() if line.startswith("property float")]
        self.assertEqual(names, ["x", "y", "z", "nx", "ny", "nz", "s", "t"])
        rows = [line.split() for line in body.splitlines()]
        count = int(head.split("element vertex ")[1].split()[0])
        vertices = [tuple(map(float, row)) for row in rows[:count]]
        self.assertEqual(len({v[:3] for v in vertices}), len(tube(0)))
        self.assertEqual(len(set(vertices)), count)
        wanted = {}
        mesh = Mesh(self.path("a.obj"))
        for triangle in mesh.triangles:
            for vertex, uv, _ in triangle:
                wanted.setdefault(vertex, set()).add(uv)
        self.assertGreaterEqual(count, sum(map(len, wanted.values())))
        for row in rows[count:]:
            self.assertEqual(row[0], "3")
        self.assertEqual(len(rows) - count, len(mesh.triangles))

    def test_colours_come_back_exactly(self):
        colours = [(x, 255 - x, (7 * x) % 256, 128) for x in range(256)]
        head = ("ply\nformat binary_little_endian 1.0\nelement vertex 256\nproperty float x\n"
                "property float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
                "property uchar blue\nproperty uchar alpha\nelement face 254\n"
                "property list uchar int vertex_indices\nend_header\n")
        data = head.encode()
        for i, colour in enumerate(colours):
            data += struct.pack("<3f4B", i // 2, i % 2, 0, *colour)
        for i in range(254):
            data += struct.pack("<B3i", 3, i, i + 1 + i % 2, i + 2 - i % 2)
        self.path("a.ply").write_bytes(data)
        stream = self.encode_to("a.rlpc", self.path("a.ply"))
        self.ok("rlpcdec", stream, "-o", self.path("b.ply"), "--ascii")
        rows = self.path("b.ply").read_text().split("end_header\n")[1].splitlines()
        self.assertEqual([tuple(map(int, row.split()[3:])) for row in rows[:256]], colours)

    def test_a_ply_sequence_gives_the_texture_coordinates_again(self):
        stream = self.encode_to("a.rlpc", self.sequence())
        self.ok("rlpcdec", stream, "-o", self.path("ply/f%d.ply"))
        again = self.encode_to("b.rlpc", self.path("ply"))
        self.ok("rlpcdec", again, "-o", self.path("ply2/f%d.ply"))
        for f in range(6):
            one, two = (self.path(f"{folder}/f{f}.ply").read_bytes() for folder in ("ply", "ply2"))
            self.assertEqual(len(one), len(two))


BLENDER = """
import bpy, sys
exporting, path = sys.argv[-2] == "export", sys.argv[-1]
bpy.ops.wm.read_factory_settings(use_empty=True)
if exporting:
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    bpy.ops.wm.obj_export(filepath=path, export_materials=False)
elif path.endswith(".ply"):
    bpy.ops.import_mesh.ply(filepath=path)
else:
    bpy.ops.wm.obj_import(filepath=path)
mesh, place = bpy.context.selected_objects[0].data, bpy.context.selected_objects[0].matrix_world
layer = mesh.uv_layers[0].data
for polygon in mesh.polygons:
    for loop in polygon.loop_indices:
        x = place @ mesh.vertices[mesh.loops[loop].vertex_index].co
        if path.endswith(".ply"):
            x = x[0], -x[2], x[1]  # the importer takes y as it is, up in the file
        print("LOOP", *("%.6f" % c for c in (*x, *layer[loop].uv)))
"""


class BlenderAttributes(AttributesTest):
    def loops(self, verb, path):
        """{position: set of uv} of all loops."""
        done = subprocess.run(["blender", "-b", "--python-exit-code", "1", "--python-expr", BLENDER,
                               "--", verb, str(path)], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        loops = [tuple(map(float, line.split()[1:])) for line in done.stdout.splitlines()
                 if line.startswith("LOOP")]
        self.assertTrue(loops)
        return loops

    def test_texture_coordinates_of_every_loop(self):
        if not shutil.which("blender"):
            self.skipTest("needs blender")
        wanted = self.loops("export", self.path("a.obj"))
        self.ok("rlpcenc", self.path("a.obj"), "-o", self.path("a.rlpc"), "--max-error", 1e-5,
                "--quiet")
        for name in ("b.obj", "b.ply"):
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path(name))
            # Quads have become triangles: compare the distinct loops.
            found = self.loops("import", self.path(name))
            for loop in wanted:
                nearest = min(found, key=lambda other: sum(abs(a - b) for a, b in zip(loop, other)))
                for a, b in zip(loop[3:], nearest[3:]):
                    self.assertLessEqual(abs(a - b), HALF_STEP + 1e-5, (name, loop, nearest))
            self.assertEqual(len(self.distinct(found)), len(self.distinct(wanted)), name)

    @staticmethod
    def distinct(loops):
        return {tuple(round(c, 3) for c in loop) for loop in loops}


if __name__ == "__main__":
    main()
