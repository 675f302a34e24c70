#!/usr/bin/env python3
"""Coarse meshes: rlpcdec --coarse, and the list of rlpcinfo --coarse.

    tools_coarse_test.py --bin BUILD/bin [unittest arguments, such as Coarse]
"""

import io
import re
import struct

from tools_cut_test import CutTest
from tools_testing import ROOT, main, read_rlpd, run, searched

import specdec  # tools_cut_test knows the folder
from specdec_testing import PROGRAM, coarse_mesh

STREAMS = ("v1.0/accept/CON/CON-0001a", "v1.0/accept/VOR/VOR-0001a", "v1.0/accept/MIX/MIX-0101a",
           "v1.1/accept/LAY/LAY-0001a", "v1.1/accept/SLI/SLI-0001a", "v1.1/accept/MIX/MIX-0201a",
           "v1.2/accept/ADW/ADW-0011a", "v1.2/accept/MDL/MDL-0004a", "v1.2/accept/RST/RST-0011a")


def positions_of(frame):
    """Three numbers for each vertex of a frame in bytes."""
    return list(struct.iter_unpack("<3i", frame))


class Coarse(CutTest):
    STREAMS = searched(3, 8)  # random ones of a profile

    def expected(self, path):
        """(number of layers, the coarse mesh of so many layers in output order) by the
        specification."""
        decoder = specdec.Decoder(PROGRAM, path.read_bytes(), io.BytesIO().write)
        decoder.call("stream")
        v = decoder.variables
        order = v["VertexOrder"] if v["HasVertexOrder"] else list(range(v["NumVertices"]))

        def mesh(layers):
            vertices, triangles = coarse_mesh(v, layers)
            vertices = sorted(order[u] for u in vertices)
            place = {u: i for i, u in enumerate(vertices)}
            return vertices, [tuple(place[order[u]] for u in t) for t in triangles]

        v["MakeLayers"]()
        return v["NumLayers"], mesh

    def check(self, path):
        """All coarse meshes of a stream; returns how many of them needed fewer slices."""
        self.ok("rlpcdec", path, "-o", self.path("whole.rlpd"))
        header, _, whole = read_rlpd(self.path("whole.rlpd"))
        count, mesh = self.expected(path)
        listed = self.ok("rlpcinfo", path, "--coarse", "--json").json()["coarse_meshes"]
        self.assertEqual([entry["layers"] for entry in listed], list(range(1, count + 1)))
        cuts = 0
        for layers in range(1, count + 2):
            report = self.ok("rlpcdec", path, "-o", self.path("coarse.rlpd"), "--coarse", layers,
                             "--json").json()
            vertices, triangles = mesh(layers)
            found = read_rlpd(self.path("coarse.rlpd"))
            self.assertEqual(found[0], header, path)
            self.assertEqual(found[1], triangles, path)
            self.assertEqual([positions_of(frame) for frame in found[2]],
                             [[positions_of(frame)[u] for u in vertices] for frame in whole], path)
            size = {"vertices": len(vertices), "triangles": len(triangles)}
            self.assertEqual((report["num_vertices"], report["num_triangles"]),
                             tuple(size.values()))
            self.assertEqual(report["coarse"]["layers"], min(layers, count))
            self.assertEqual(report["coarse"]["of_layers"], count)
            if layers <= count:
                self.assertEqual(listed[layers - 1], {"layers": layers, **size})
            else:
                self.assertFalse(report["cut"])
            cuts += report["cut"]
        return cuts

    def test_bundled_streams(self):
        cuts = [self.check(ROOT / "streams" / f"{name}.rlpc") for name in STREAMS]
        self.assertGreater(sum(map(bool, cuts)), 3)

    def layered_streams(self, profile):
        """Random streams that have several layer groups."""
        seeds, found = iter(range(1000)), 0
        while found < self.STREAMS:
            path = self.random_stream(next(seeds), profile)
            if any(len(gof["cut_to_layers"]) > 1 for gof in self.skinned_gofs(path)):
                found += 1
                yield path

    def test_random_streams(self):
        for profile in ("main", "high"):
            cuts = [self.check(path) for path in self.layered_streams(profile)]
            self.assertGreater(sum(map(bool, cuts)), self.STREAMS // 2)

    def test_some_frames(self):
        self.encode(self.path("a.rlpc"), "--keep-order", "--gof", 10, "--layer-groups", 3)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("all.rlpd"), "--coarse", 3)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("some.rlpd"), "--coarse", 3,
                "--frames", "14-22")
        self.assertEqual(read_rlpd(self.path("some.rlpd"))[2],
                         read_rlpd(self.path("all.rlpd"))[2][14:23])

    def test_the_report_in_words(self):
        self.encode(self.path("a.rlpc"), "--layer-groups", 3)
        listed = self.ok("rlpcinfo", self.path("a.rlpc"), "--coarse", "--json").json()
        sizes = listed["coarse_meshes"]
        table = self.ok("rlpcinfo", self.path("a.rlpc"), "--coarse").out.decode()
        for entry in sizes:
            self.assertRegex(table, rf"\n +{entry['layers']} +{entry['vertices']} "
                                    rf"+{entry['triangles']}\n")
        for layers, words in ((1, "lack slices were not verified"), (99, "hashes agree")):
            said = self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"), "--coarse",
                           layers).err
            size = sizes[min(layers, len(sizes)) - 1]
            self.assertIn(f" of {size['vertices']} vertices and {size['triangles']} triangles "
                          f"decoded ({size['layers']} of {len(sizes)} vertex layers)", said)
            self.assertIn(words, said)

    def test_wrong_usage(self):
        self.encode(self.path("a.rlpc"))
        before = self.files()
        for number in (0, -1, "x", "1-3", "4294967295", "4294967296"):
            self.fails(64, "--coarse", "rlpcdec", self.path("a.rlpc"), "-o", self.path("a.obj"),
                       "--coarse", number)
        self.fails(64, "--verify excludes --coarse", "rlpcdec", self.path("a.rlpc"), "--verify",
                   "--coarse", 2)
        self.fails(64, "excludes", "rlpcdec", self.path("a.rlpc"), "--html", self.path("a.html"),
                   "--coarse", 2)
        for options in (["--trace"], ["--extract", "layers=1", "-o", self.path("b.rlpc")]):
            self.fails(64, "excludes", "rlpcinfo", self.path("a.rlpc"), "--coarse", *options)
        self.assertEqual(self.files(), before)

    def test_pictures(self):
        self.encode(self.path("a.rlpc"), "--keep-order")
        sizes = self.ok("rlpcinfo", self.path("a.rlpc"), "--coarse", "--json", "--html",
                        self.path("a.html")).json()["coarse_meshes"]
        page = self.path("a.html").read_text()
        shown = [sizes[int(n) - 1] for n in re.findall(r"<figcaption>(\d+) layers?: ", page)]
        self.assertEqual(len(shown), 4)
        self.assertEqual(shown[-1], sizes[-1])
        self.assertEqual(page.count('<path class="m'), sum(s["triangles"] for s in shown))
        self.ok("rlpcinfo", self.path("a.rlpc"), "--html", self.path("a.html"))
        self.assertNotIn("Coarse", self.path("a.html").read_text())

    def test_memory(self):
        """A limit that is enough for the whole mesh, but not for making a coarse one."""
        self.encode(self.path("a.rlpc"))
        fits = next(size for size in range(100_000, 10_000_000, 20_000) if self.decodes(size) == 0)
        self.assertEqual(self.decodes(fits, "--coarse", 3), 3)
        self.assertEqual(self.decodes(fits + 10_000_000, "--coarse", 3), 0)

    def decodes(self, size, *options):
        """Exit code of rlpcdec under a limit."""
        command = ["rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"), "--threads", 1,
                   "--max-memory", size, *options]
        return run(*command).code


if __name__ == "__main__":
    main()
