#!/usr/bin/env python3
"""Pictures of rlpcinfo: each vertex in the colour of what the specification puts it in.

    tools_pictures_test.py --bin BUILD/bin [unittest arguments, such as Pictures]
"""

import collections
import io
import math
import re
import struct
import subprocess

from tools_cut_test import CutTest
from tools_testing import INPUTS, ROOT, Tools, limited, main, read_rlpd

import specdec  # tools_cut_test knows the folder
from specdec_testing import PROGRAM

# One of each kind of GOF, with and without a vertex order, triangles, slices.
STREAMS = ("v1.0/accept/CON/CON-0001a", "v1.0/accept/VOR/VOR-0001a", "v1.0/accept/MIX/MIX-0101a",
           "v1.1/accept/LAY/LAY-0001a", "v1.1/accept/SLI/SLI-0001a", "v1.1/accept/MIX/MIX-0201a",
           "v1.2/accept/ADW/ADW-0011a", "v1.2/accept/MDL/MDL-0004a", "v1.2/accept/RST/RST-0011a",
           "v1.2/accept/FRM/FRM-0001a")
PATH = re.compile(r'<path class="(\w+)"[^>]* d="([^"]*)"/>')
NUMBER = re.compile(r"-?\d+\.\d")


def groups_of(v):
    """{name of the picture: [group of each vertex]} and the seed triangles, for a decoder with
    these variables after the last GOF."""
    groups, seeds = {}, []
    if v["gof_kind"] == 0:
        groups["clusters"] = list(v["ClusterOfVertex"])
        for i in reversed(range(v["NumClusters"])):
            if v["lcf_flag"][i]:
                seeds.append(v["seed_vertex"][i])
                for u in v["seed_vertex"][i]:
                    groups["clusters"][u] = i
    elif v["gof_kind"] in (1, 2):
        groups["bones"] = [min(zip(weights, bones), key=lambda pair: (-pair[0], pair[1]))[1]
                           for weights, bones in zip(v["WeightsOfVertex"], v["BonesOfVertex"])]
    elif v["num_patches"] > 0:
        groups["patches"] = list(v["ClusterOfVertex"])
    v["MakeLayers"]()
    groups["layers"] = list(v["LayerOfVertex"])
    return groups, seeds


def projected(points, behind):
    """In the pixels of a view, to a tenth."""
    yaw, pitch = 0.5 + math.pi * behind, 0.3
    flat = [(x * math.cos(yaw) - z * math.sin(yaw),
             y * math.cos(pitch) - math.sin(pitch) * (x * math.sin(yaw) + z * math.cos(yaw)))
            for x, y, z in points]
    lows, highs = ([f(c) for c in zip(*flat)] for f in (min, max))
    unit = max((highs[0] - lows[0]) / 324, (highs[1] - lows[1]) / 284) or 1
    return [(float(f"{170 + (x - (lows[0] + highs[0]) / 2) / unit:.1f}"),
             float(f"{150 - (y - (lows[1] + highs[1]) / 2) / unit:.1f}")) for x, y in flat]


class Pictures(CutTest):
    def views(self, path):
        """[(class, points)] of each view of a file."""
        text = path.read_text()
        views = re.findall(r'<g class="view"[^>]*>\n(.*?)</g>', text, re.DOTALL)
        self.assertEqual(len(views), 2)
        return [[(name, list(zip(*[map(float, NUMBER.findall(d))] * 2)))
                 for name, d in PATH.findall(view)] for view in views]

    def check_view(self, paths, where, triangles, groups):
        """The pieces of triangles, or the dots, of a view."""
        found, expected = (collections.Counter() for _ in range(2))
        at = collections.defaultdict(set)  # the groups of the vertices that are seen there
        for group, place in zip(groups, where):
            at[place].add(group)
        for name, points in paths:
            group = int(name[1:])
            found[group] += 3 if len(points) == 3 else 1
            corners = points if len(points) == 3 else points[:1]
            for corner in corners:
                self.assertIn(group, at[corner])
        for t in triangles or [(u,) for u in range(len(groups))]:
            expected.update(groups[u] for u in t)
        self.assertEqual(found, expected)

    def check(self, path):
        """The last frame of a stream; the names of its pictures."""
        decoder = specdec.Decoder(PROGRAM, path.read_bytes(), io.BytesIO().write)
        decoder.call("stream")
        v = decoder.variables
        order = v["VertexOrder"] if v["HasVertexOrder"] else list(range(v["NumVertices"]))
        decoded = {place: u for u, place in enumerate(order)}
        all_groups, seeds = groups_of(v)
        self.ok("rlpcdec", path, "-o", self.path("a.rlpd"))
        _, triangles, frames = read_rlpd(self.path("a.rlpd"))
        triangles = [tuple(decoded[u] for u in t) for t in triangles if len(set(t)) == 3]
        output = list(struct.iter_unpack("<3i", frames[-1]))
        positions = [output[place] for place in order]
        folder = self.path(f"pictures{len(self.files())}")
        self.ok("rlpcinfo", path, "--pictures", folder, "--frame", len(frames) - 1)
        self.assertEqual(sorted(file.name for file in folder.iterdir()),
                         sorted(f"{name}.svg" for name in all_groups))
        for name, groups in all_groups.items():
            for behind, paths in enumerate(self.views(folder / f"{name}.svg")):
                where = projected(positions, behind)
                outlines = [points for kind, points in paths if kind == "seed"]
                expected = [[where[u] for u in seed] for seed in seeds if name == "clusters"] * 2
                self.assertEqual(sorted(outlines), sorted(expected))
                self.check_view([p for p in paths if p[0] != "seed"], where, triangles, groups)
        return set(all_groups)

    def test_bundled_streams(self):
        names = set()
        for name in STREAMS:
            with self.subTest(name):
                names |= self.check(ROOT / "streams" / f"{name}.rlpc")
        self.assertEqual(names, {"clusters", "bones", "layers"})

    def test_random_streams(self):
        names = set()
        for profile in ("main", "high"):
            for seed in range(12):
                with self.subTest(profile, seed=seed):
                    names |= self.check(self.random_stream(seed, profile))
        self.assertEqual(names, {"clusters", "bones", "patches", "layers"})

    def test_encoded_clusters(self):
        """Large enough that most triangles are within a cluster."""
        self.clip(4)
        for partition in ("seeds", "kway"):
            self.ok("rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"), "-o",
                    self.path("a.rlpc"), "--profile", "baseline", "--partition", partition,
                    "--clusters", 12, "-q")
            self.assertEqual(self.check(self.path("a.rlpc")), {"clusters", "layers"})

    def test_encoded_patches(self):
        self.clip(4)
        self.ok("rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"), "-o",
                self.path("a.rlpc"), "--profile", "high", "--gof-kind", "inter", "--partition",
                "kway", "--patches", 12, "-q")
        self.assertEqual(self.check(self.path("a.rlpc")), {"patches", "layers"})

    def colours(self, path):
        """[colours of the paths] by class."""
        found = collections.defaultdict(set)
        for name, colour in re.findall(r'class="g(\d+)" color="(#[0-9a-f]{6})"', path.read_text()):
            found[int(name)].add(colour)
        return found

    def test_colours(self):
        self.encode(self.path("a.rlpc"), "--profile", "baseline", "--clusters", 30)
        self.ok("rlpcinfo", self.path("a.rlpc"), "--pictures", self.path("p"))
        shown = self.colours(self.path("p/clusters.svg"))
        legend = re.findall(r'fill="(#\w{6})"/>\n<text[^>]*>(\d+): ',
                            self.path("p/clusters.svg").read_text())
        self.assertEqual(sorted(int(group) for _, group in legend), sorted(shown))
        self.assertGreater(len(shown), 20)
        self.assertEqual(len({colour for colour, _ in legend}), len(legend))
        for colour, group in legend:
            channels = [int(colour[i:i + 2], 16) for i in (1, 3, 5)]
            for shade in shown[int(group)]:  # no channel is lighter
                for i, channel in zip((1, 3, 5), channels):
                    self.assertLessEqual(int(shade[i:i + 2], 16), channel)

    def test_a_page_has_them(self):
        self.encode(self.path("a.rlpc"), "--gof", 20)
        first = self.ok("rlpcinfo", self.path("a.rlpc"), "--html", "-").out.decode()
        self.assertIn("Frame 0, in the inter GOF 0 to 19", first)
        later = self.ok("rlpcinfo", self.path("a.rlpc"), "--html", "-", "--frame", 45,
                        "--coarse").out.decode()
        self.assertIn("Frame 45, in the inter GOF 40 to 59", later)
        self.assertIn("frame 45.", later)
        self.ok("rlpcinfo", self.path("a.rlpc"), "--pictures", self.path("p"), "--frame", 45)
        for page, same in ((later, True), (first, False)):
            views = re.findall(r'<g class="view".*?</g>', page, re.DOTALL)
            self.assertEqual(len(views), 4)
            for name, views in (("bones", views[:2]), ("layers", views[2:])):
                self.assertEqual(views == re.findall(
                    r'<g class="view".*?</g>', self.path(f"p/{name}.svg").read_text(),
                    re.DOTALL), same)

    def test_the_first_frame_needs_no_index(self):
        """A wrong GOF index stops a seek alone, as in rlpcdec."""
        stream = ROOT / "streams/v1.0/either/IDX/IDX-0001x6.rlpc"
        self.ok("rlpcinfo", stream, "--pictures", self.path("p"), "--html", self.path("a.html"))
        for tool, options in (("rlpcinfo", ["--pictures", self.path("q"), "--frame", 5]),
                              ("rlpcdec", ["-o", self.path("a.rlpd"), "--frames", 5])):
            self.fails(1, "R-IDX-02", tool, stream, *options)
        self.assertEqual(self.files(), ["a.html", "p"])

    def test_large_meshes_are_shown_as_coarse_meshes(self):
        side = 120  # 28,322 triangles
        lines = [f"v {i} {j} {math.sin(i / 9) * math.cos(j / 7)}"
                 for i in range(side) for j in range(side)]
        for v in range(1, side * (side - 1)):
            if v % side:
                lines += [f"f {v} {v + 1} {v + side + 1}", f"f {v} {v + side + 1} {v + side}"]
        self.path("big.obj").write_text("\n".join(lines))
        self.ok("rlpcenc", self.path("big.obj"), "-o", self.path("a.rlpc"), "--profile",
                "baseline", "-q", "--preset", "fast")
        sizes = self.ok("rlpcinfo", self.path("a.rlpc"), "--coarse", "--json", "--pictures",
                        self.path("p"), "--html", self.path("a.html")).json()["coarse_meshes"]
        for path, limit in (("p/layers.svg", 10000), ("a.html", 2000)):
            text = self.path(path).read_text()
            self.assertLess(len(text), 300 * 2 * limit * (2 if path == "a.html" else 1))
            size = max((s for s in sizes if s["triangles"] <= limit), key=lambda s: s["layers"])
            self.assertIn(f"The coarse mesh of {size['layers']} layers, with "
                          f"{size['triangles']:,} triangles", text)
        for paths in self.views(self.path("p/layers.svg")):
            shown = sum(1 if len(points) == 3 else 1 / 3 for _, points in paths)
            size = max((s for s in sizes if s["triangles"] <= 10000), key=lambda s: s["layers"])
            self.assertAlmostEqual(shown, size["triangles"], delta=0.01)

    def test_folders(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--gof", 20)
        new = self.path("new")
        for place in (new, f"{new}/"):
            self.ok("rlpcinfo", stream, "--pictures", place)
            self.assertEqual(sorted(p.name for p in new.iterdir()), ["bones.svg", "layers.svg"])
        before = (new / "bones.svg").read_bytes()
        (new / "other.svg").write_text("stays")
        self.ok("rlpcinfo", stream, "--pictures", new, "--frame", 30)
        self.assertNotEqual((new / "bones.svg").read_bytes(), before)
        self.assertEqual((new / "other.svg").read_text(), "stays")
        self.assertEqual(len(list(new.iterdir())), 3)

    def test_nothing_is_left_of_what_fails(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--gof", 20)
        self.path("bad.rlpc").write_bytes(stream.read_bytes()[:-20])
        self.path("bones.svg").write_bytes(stream.read_bytes())
        before = self.files()
        self.fails(1, "bad.rlpc", "rlpcinfo", self.path("bad.rlpc"), "--pictures", self.path("p"))
        self.fails(4, "a.rlpc: is a file", "rlpcinfo", stream, "--pictures", stream)
        self.fails(4, "none/p", "rlpcinfo", stream, "--pictures", self.path("none/p"))
        self.fails(4, "", "rlpcinfo", stream, "--pictures", self.path("p"), **limited(4096))
        self.fails(64, "bones.svg: is also an input", "rlpcinfo", self.path("bones.svg"),
                   "--pictures", self.folder)
        self.fails(64, "--frame: expected 0 to 59, got 60", "rlpcinfo", stream, "--pictures",
                   self.path("p"), "--frame", 60)
        for frame in (-1, "x", "1-3"):
            self.fails(64, "--frame", "rlpcinfo", stream, "--pictures", self.path("p"), "--frame",
                       frame)
        self.fails(64, "--frame is for pictures", "rlpcinfo", stream, "--frame", 3)
        for options in (["--trace"], ["--extract", "layers=1", "-o", self.path("b.rlpc")]):
            self.fails(64, "excludes", "rlpcinfo", stream, "--pictures", self.path("p"), *options)
        self.assertEqual(self.files(), before)

    def test_partitions_side_by_side(self):
        script = ROOT / "scripts" / "studies" / "figures" / "draw_partitions.py"
        command = [script, "--bin", Tools.folder, "--name", "robot_arm", "-o",
                   self.path("new/figure.svg"), "--clusters"]
        subprocess.run([*command, "6"], check=True)
        text = self.path("new/figure.svg").read_text()
        views = re.findall(r'<g class="view".*?</g>', text, re.DOTALL)
        self.assertEqual(re.findall(r">--partition (\w+)<", text),
                         ["seeds", "kway", "lloyd", "spectral", "motion"])
        self.assertEqual(len(set(views)), 5)
        for view in views:
            shown = {int(group) for group in re.findall(r'class="g(\d+)"', view)}
            self.assertGreater(len(shown), 2)
            self.assertLess(max(shown), 6)
        for clusters, words in (("0", "--clusters"), ("x", "--clusters")):
            done = subprocess.run([*command, clusters], capture_output=True, check=False)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn(words, done.stderr.decode())

    def test_points(self):
        points = [line for line in (INPUTS / "elephant.obj").read_text().splitlines()
                  if line.startswith("v ")]
        self.path("points.obj").write_text("\n".join(points))
        self.ok("rlpcenc", self.path("points.obj"), "-o", self.path("a.rlpc"), "--profile",
                "baseline", "--clusters", 5, "-q")
        self.assertEqual(self.check(self.path("a.rlpc")), {"clusters", "layers"})


if __name__ == "__main__":
    main()
