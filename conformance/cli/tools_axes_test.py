#!/usr/bin/env python3
"""Axes and units of the input: --axes, where mesh and points differ, and what the stream notes."""

import re

from tools_testing import (ROOT, ToolsTest, main, read_obj, triangle_set, write_mdd, write_obj,
                           write_pc2)


class Axes(ToolsTest):
    def test_axes_of_mesh_and_points(self):
        triangles, (frame, *_) = self.clip(2)
        y_up = [c for v in range(0, len(frame), 3)
                for c in (frame[v], frame[v + 2], -frame[v + 1])]
        write_obj(self.path("turned.obj"), y_up, triangles)
        write_mdd(self.path("clip.mdd"), [frame, frame])
        write_pc2(self.path("turned.pc2"), [y_up, y_up])
        for mesh, points, differ in (("clip.obj", "clip.mdd", False),
                                     ("clip.obj", "clip.pc2", False),
                                     ("turned.obj", "clip.mdd", True),
                                     ("turned.obj", "clip.pc2", True),
                                     ("clip.obj", "turned.pc2", True),
                                     ("turned.obj", "turned.pc2", False)):
            said = self.ok("rlpcenc", self.path(mesh), "--points", self.path(points), "--dry-run",
                           "--kg", 1, "--preset", "fast").err
            self.assertEqual("has other axes than this mesh" in said, differ, (mesh, points, said))
            if differ:
                self.check_advice(said, self.path(mesh), "--points", self.path(points))

    def check_advice(self, said, mesh, *points):
        """--axes as advised gives the stream the axes of the mesh, which is its first frame."""
        axes = re.search("; --axes (\\S+) turns it to the axes of the mesh\n", said).group(1)
        stream = self.path("turned.rlpc")
        said = self.ok("rlpcenc", mesh, *points, "--axes", axes, "--keep-order", "--kg", 0.05,
                       "-o", stream).err
        self.assertEqual("", said)
        self.ok("rlpccmp", mesh, *points, "--axes", axes, stream, "--max-kg", 0.1)
        self.ok("rlpcdec", stream, "-o", self.path("first.ply"), "--frames", 0)
        self.ok("rlpccmp", mesh, self.path("first.ply"), "--max-kg", 0.2)

    def test_mirrored_points(self):
        triangles, (frame, second) = self.clip(2)
        mirrored = [[c for v in range(0, len(f), 3) for c in (f[v], f[v + 2], f[v + 1])]
                    for f in (frame, second)]
        write_pc2(self.path("mirrored.pc2"), mirrored)
        clip = [self.path("clip.obj"), "--points", self.path("mirrored.pc2")]
        said = self.ok("rlpcenc", *clip, "-o", self.path("a.rlpc"), "--preset", "fast").err
        self.assertIn("other axes than this mesh, and is mirrored; --axes x,z,y", said)
        self.check_advice(said, *clip)
        self.ok("rlpcdec", self.path("turned.rlpc"), "-o", self.path("turned.obj"), "--frames", 0)
        _, found = read_obj(self.path("turned.obj"))
        self.assertEqual(triangle_set(found), triangle_set(triangles))

    def test_frames_from_a_pipe(self):
        self.clip(2)
        stream, mesh = self.path("live.rlpc"), self.path("clip.obj")
        self.ok("rlpcenc", mesh, "--points", "-", "--axes", "x,z,-y", "--profile", "high",
                "--low-delay", "--keep-order", "-o", stream,
                input=self.path("clip.pc2").read_bytes())
        self.ok("rlpcdec", stream, "-o", self.path("live.pc2"))
        self.ok("rlpccmp", mesh, "--points", self.path("clip.pc2"), "--axes", "x,z,-y",
                self.path("live.pc2"), "--max-kg", 0.2)
        self.fails(2, "leave out --axes", "rlpccmp", stream, stream, "--axes", "x,z,-y")

    def test_bad_axes(self):
        self.clip(2)
        clip = [self.path("clip.obj"), "--points", self.path("clip.pc2"), "--dry-run"]
        self.fails(64, ["--axes", "such as x,z,-y"], "rlpcenc", *clip, "--axes", "x,z,z")
        self.fails(64, ["--axes", "such as x,z,-y"], "rlpccmp", clip[0], clip[0], "--axes", "up")

    def test_units_are_noted_in_the_metadata(self):
        self.clip(2)
        self.path("mine.json").write_text('{"take": 7, "upAxis": "?"}')
        self.path("list.json").write_text("[1]")
        clip = [self.path("clip.obj"), "--points", self.path("clip.pc2"), "--preset", "fast", "-o",
                self.path("a.rlpc")]
        for options, expected in (([], None),
                                  (["--up-axis", "z"], {"upAxis": "Z"}),
                                  (["--metres-per-unit", 0.01], {"metersPerUnit": 0.01}),
                                  (["--metadata", self.path("mine.json"), "--up-axis", "y"],
                                   {"take": 7, "upAxis": "Y"})):
            self.ok("rlpcenc", *clip, *options)
            told = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
            self.assertEqual(told.get("metadata"), expected)
        # glTF says it.
        glb = ROOT / "streams/inputs/tulip.glb"
        for options, expected in (([], {"upAxis": "Y", "metersPerUnit": 1}),
                                  (["--axes", "x,z,-y"], None),
                                  (["--metadata", self.path("list.json")], [1]),
                                  (["--metadata", self.path("mine.json")],
                                   {"take": 7, "upAxis": "?", "metersPerUnit": 1})):
            self.ok("rlpcenc", glb, "--preset", "fast", "-o", self.path("a.rlpc"), *options)
            told = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
            self.assertEqual(told.get("metadata"), expected)
        self.fails(1, ["list.json", "a JSON object"], "rlpcenc", *clip, "--metadata",
                   self.path("list.json"), "--up-axis", "y")
        self.fails(64, "--up-axis", "rlpcenc", *clip, "--up-axis", "w")
        self.fails(64, "--metres-per-unit", "rlpcenc", *clip, "--metres-per-unit", 0)


if __name__ == "__main__":
    main()
