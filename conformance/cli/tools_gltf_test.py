#!/usr/bin/env python3
"""glTF as input of the tools, as people run them.

    tools_gltf_test.py --bin BUILD/bin [unittest arguments, such as GltfInput]
"""

import base64
import json
import struct
import sys
from random import Random

from tools_testing import INPUTS, ROOT, ToolsTest, main, read_pc2

sys.path.insert(0, str(ROOT / "conformance" / "tools"))
import make_gltf

TULIP = INPUTS / "tulip.glb"
# Vertices in the order of the scene, before welding.
CUP, STEM, SOIL, BEE = 4 * 13, 13 * 9, 8, 24
FRAMES = {"Sway": 61, "Visit": 43}  # at 30 and 24 frames per second, the rates of their keys
SECONDS = {"Sway": 2, "Visit": 1.75}
EXACT = ["--no-weld", "--keep-order", "--max-error", 0.0005, "--preset", "fast", "--quiet"]


def parts(glb):
    """(document, bytes of its buffer)"""
    size, = struct.unpack_from("<I", glb, 12)
    return json.loads(glb[20:20 + size]), glb[20 + size + 8:]


class GltfInput(ToolsTest):
    def frames(self, *options):
        """Decoded positions, in the order of the scene."""
        self.ok("rlpcenc", TULIP, "-o", self.path("a.rlpc"), *EXACT, *options)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        return read_pc2(self.path("a.pc2"))

    def assert_near(self, found, wanted):
        for a, b in zip(found, wanted, strict=True):
            self.assertAlmostEqual(a, b, delta=0.001)

    def test_the_bundled_file_is_what_its_program_writes(self):
        self.assertEqual(TULIP.read_bytes(), make_gltf.tulip())

    def test_every_container_gives_the_same_stream(self):
        document, data = parts(TULIP.read_bytes())
        uris = {"data.gltf": "data:application/octet-stream;base64,"
                + base64.b64encode(data).decode(), "file.gltf": "tulip%20data.bin"}
        self.path("tulip data.bin").write_bytes(data)
        for name, uri in uris.items():
            document["buffers"][0]["uri"] = uri
            self.path(name).write_text(json.dumps(document, indent=1))
        self.path("other.name").write_bytes(TULIP.read_bytes())
        streams = []
        for path in (TULIP, *map(self.path, (*uris, "other.name"))):
            self.ok("rlpcenc", path, "-o", self.path("a.rlpc"), "--kg", 1, "--preset", "fast",
                    "--quiet")
            streams.append(self.path("a.rlpc").read_bytes())
        self.assertEqual(streams, streams[:1] * 4)

    def test_animations_are_chosen(self):
        cases = {(): 61, ("--animation", "Sway"): 61, ("--animation", "Visit"): 43,
                 ("--animation", "1"): 43, ("--animation", "all"): 92,
                 ("--animation", "Visit", "--animation", "Sway"): 92,
                 ("--animation", "Visit", "--fps", "10"): 19, ("--fps", "25"): 51,
                 ("--fps", "30000/1001"): 61}
        for options, count in cases.items():
            report = self.ok("rlpcenc", TULIP, "-o", self.path("a.rlpc"), "--kg", 1, "--preset",
                             "fast", "--json", *options).json()
            self.assertEqual(report["num_frames"], count, options)
            self.assertEqual(report["num_vertices"], 172)

    def test_names_of_animations_become_clips(self):
        document, data = parts(TULIP.read_bytes())
        document["animations"] = document["animations"][:1]
        document["buffers"][0]["uri"] = "tulip.bin"
        self.path("tulip.bin").write_bytes(data)
        self.path("sway.gltf").write_text(json.dumps(document))
        del document["animations"][0]["name"]
        self.path("nameless.gltf").write_text(json.dumps(document))
        sway, visit = (dict(name=name, first_frame=0, num_frames=n, duration=SECONDS[name])
                       for name, n in FRAMES.items())
        sway24 = {**sway, "num_frames": 49}  # includes Visit
        cases = [(TULIP, [], [sway]), (TULIP, ["--animation", "Visit"], [visit]),
                 (TULIP, ["--animation", 1], [visit]),
                 (TULIP, ["--animation", "all"], [sway24, {**visit, "first_frame": 49}]),
                 (TULIP, ["--animation", "Visit", "--animation", "Sway"],
                  [visit, {**sway24, "first_frame": 43}]),
                 (TULIP, ["--clip", "Bees:3-9"],
                  [{"name": "Bees", "first_frame": 3, "num_frames": 7, "duration": 0.2}]),
                 (self.path("sway.gltf"), ["--animation", "all"], [sway]),
                 (self.path("nameless.gltf"), ["--animation", "all"], [])]
        for source, options, clips in cases:
            said = self.ok("rlpcenc", source, "-o", self.path("a.rlpc"), "--kg", 1, "--preset",
                           "fast", *options).err
            self.assertNotIn("name of", said)
            info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
            self.assertEqual(info.get("clips", []), clips, (source, options))

    def test_what_is_merged_and_dropped_is_reported(self):
        result = self.ok("rlpcenc", TULIP, "-o", self.path("a.rlpc"), "--kg", 1)
        for words in ("dropped 2 point or line primitives", "dropped 8 degenerate triangles",
                      "merged 53 duplicate vertices (172 left); --no-weld keeps them apart",
                      "dropped: skeleton (not its motion), morph targets (not their motion)\n"):
            self.assertIn(f"{TULIP}: {words}", result.err)
        result = self.ok("rlpcenc", TULIP, "-o", self.path("a.rlpc"), "--kg", 1, "--no-weld",
                         "--json")
        self.assertEqual(result.json()["num_vertices"], CUP + STEM + SOIL + 2 * BEE)
        self.assertNotIn("merged", result.err)
        quiet = self.ok("rlpcenc", TULIP, "-o", self.path("a.rlpc"), "--kg", 1, "--quiet").err
        self.assertIn("dropped: skeleton (not its motion), morph targets", quiet)
        self.assertNotIn("merged", quiet)

    def test_vertices_are_where_the_document_puts_them(self):
        frames = self.frames("--animation", "Visit")
        self.assertEqual(len(frames), FRAMES["Visit"])
        soil = 3 * (CUP + STEM)
        corners = [c for x, z in make_gltf.OCTAGON for c in (0.3 * x, 0.05, -0.3 * z)]
        bee = soil + 3 * SOIL
        # The first key of Visit is at 0.25 s; these are the times of its splines.
        path = {0: (-1.5, 2, 0), 6: (-1.5, 2, 0), 18: (-0.4, 2.2, 0.3), 30: (0.4, 2.2, 0.3),
                42: (1.5, 2.5, 0)}
        scale = {0: 0.05, 17: 0.05, 18: 0.08, 29: 0.08, 30: 0.05, 41: 0.05, 42: 0.1}
        for f, xyz in enumerate(frames):
            self.assert_near(xyz[soil:bee], corners)
            visitor = xyz[bee:bee + 3 * BEE]
            if f in path:
                self.assert_near([sum(visitor[c::3]) / BEE for c in range(3)], path[f])
            if f in scale:
                onlooker = xyz[bee + 3 * BEE:]
                self.assertAlmostEqual(max(onlooker[0::3]) - 0.7, scale[f], delta=0.001)

    def test_skin_and_targets_move(self):
        frames = self.frames("--animation", "Sway")
        stem = slice(3 * CUP, 3 * (CUP + STEM))
        ring = slice(stem.stop - 3 * 9, stem.stop)
        self.assert_near(frames[0][stem], frames[30][stem])  # upright again at 1 s
        self.assertGreater(max(abs(a - b) for a, b in zip(frames[0][ring], frames[15][ring])), 0.1)
        self.assert_near(frames[0][stem.start:stem.start + 27], frames[15][stem.start:][:27])
        rim = slice(3 * 3 * 13, 3 * CUP)  # the cup is open at 1 s, and not at 0 s
        widths = [max(frames[f][rim][0::3]) - min(frames[f][rim][0::3]) for f in (0, 30)]
        self.assertAlmostEqual(widths[0], 0.5, delta=0.002)
        self.assertGreater(widths[1], 0.9)

    def test_all_joins_animations_in_sequence(self):
        whole = self.frames("--animation", "all")
        each = (self.frames("--animation", "Sway", "--fps", 24)
                + self.frames("--animation", "Visit"))
        self.assertEqual(len(whole), len(each))
        for a, b in zip(whole, each):
            self.assert_near(a, b)

    def test_rlpccmp_reads_it_as_rlpcenc_does(self):
        for options in ([], ["--animation", "Visit"],
                        ["--animation", "Visit", "--animation", 0],
                        ["--animation", "all", "--fps", 12], ["--no-weld"]):
            self.ok("rlpcenc", TULIP, "-o", self.path("a.rlpc"), "--order-map", self.path("map"),
                    "--kg", 0.5, "--preset", "fast", "--quiet", *options)
            self.ok("rlpccmp", TULIP, self.path("a.rlpc"), "--order-map", self.path("map"),
                    "--max-kg", 0.5, *options)
        exact = self.ok("rlpccmp", TULIP, TULIP, "--animation-a", "Visit", "--animation-b", 1,
                        "--no-weld-a", "--no-weld-b", "--json").json()
        self.assertEqual((exact["num_vertices"], exact["metrics"]["max_error"]), (225, 0))
        self.fails(2, "43 frames", "rlpccmp", TULIP, TULIP, "--animation", "Visit")
        self.fails(64, "--fps", "rlpccmp", TULIP, TULIP, "--fps", "x")


def animated(clips):
    """A .glb with one triangle; clips: (name, interpolation, times, values), which move it along
    x."""
    data, accessors = bytearray(), []

    def add(kind, numbers):
        accessors.append({"bufferView": len(accessors), "componentType": 5126, "type": kind,
                          "count": len(numbers) // {"SCALAR": 1, "VEC3": 3}[kind]})
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(numbers)})
        data.extend(struct.pack(f"<{len(numbers)}f", *numbers))
        return len(accessors) - 1

    views = []
    document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}], "animations": [], "accessors": accessors,
                "bufferViews": views, "meshes": [{"primitives": [{"attributes": {
                    "POSITION": add("VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0])}}]}]}
    for name, interpolation, times, values in clips:
        spline = interpolation == "CUBICSPLINE"
        out = [c for x in values for y in ([0, x, 0] if spline else [x]) for c in (y, 0, 0)]
        document["animations"].append({
            "name": name,
            "samplers": [{"input": add("SCALAR", times), "output": add("VEC3", out),
                          "interpolation": interpolation}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]})
    document["buffers"] = [{"byteLength": len(data)}]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
            + text + struct.pack("<II", len(data), 0x004E4942) + data)


def durations(glb):
    """The last key of each animation, by name."""
    document, data = parts(glb)
    found = {}
    for animation in document["animations"]:
        used = {channel["sampler"] for channel in animation["channels"]}
        ends = []
        for sampler in used:
            accessor = document["accessors"][animation["samplers"][sampler]["input"]]
            view = document["bufferViews"][accessor["bufferView"]]
            at = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
            ends.append(struct.unpack_from("<f", data, at + 4 * accessor["count"] - 4)[0])
        found[animation.get("name")] = max(ends)
    return found


def at_rate(rate, *frames):
    return [frame / rate for frame in frames]


class GltfTime(ToolsTest):
    """Clips last as long as in the source, from time 0 to the last pose."""

    def through(self, source, *options):
        """Returns the messages of rlpcenc, the report of rlpcinfo, and the .glb of rlpcdec."""
        self.path("in.glb").write_bytes(source)
        said = self.ok("rlpcenc", self.path("in.glb"), "--animation", "all", "--preset", "fast",
                       "--max-error", 0.001, "-o", self.path("a.rlpc"), *options).err
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("out.glb"), "--quiet")
        info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
        return said, info, self.path("out.glb").read_bytes()

    def check(self, clips, slack, *options):
        said, info, out = self.through(animated(clips), *options)
        rate = info["frame_rate"][0] / info["frame_rate"][1]
        written = durations(out)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"), "--quiet")
        frames = read_pc2(self.path("a.pc2"))
        for clip, (name, _, times, values) in zip(info["clips"], clips, strict=True):
            end = struct.unpack("<f", struct.pack("<f", times[-1]))[0]
            self.assertAlmostEqual(clip["duration"], written[name], delta=1e-6 * (1 + end))
            self.assertAlmostEqual(clip["duration"], (clip["num_frames"] - 1) / rate)
            self.assertGreater(written[name], end - 1e-3 / rate - 1e-6 * end)
            self.assertLess(written[name], end + slack / rate + 1e-6 * end + 1e-9)
            first = clip["first_frame"]
            last = first + clip["num_frames"] - 1
            self.assertAlmostEqual(min(frames[first][0::3]), values[0], delta=0.01)
            self.assertAlmostEqual(min(frames[last][0::3]), values[-1], delta=0.01)
        return said, rate

    def test_rates_are_found(self):
        for rate in (24, 25, 30, 60, 50, 120, 30000 / 1001, 24000 / 1001):
            times = at_rate(rate, *range(20))
            said, found = self.check([("a", "LINEAR", times, [k % 7 for k in range(20)])], 0.002)
            self.assertAlmostEqual(found, rate)
            self.assertNotIn("frames per second", said)

    def test_a_late_key_and_a_loop(self):
        self.check([("late", "LINEAR", [1, 1.5, 2], [0, 3, 5])], 0.002)
        self.check([("turn", "LINEAR", [0, 0.25, 0.5, 0.75, 1], [0, 2, 3, 2, 0])], 0.002)
        self.check([("pose", "STEP", [0], [4]), ("late pose", "LINEAR", [1.5], [2])], 0.002)

    def test_other_rates_are_told(self):
        said, _ = self.check([("odd", "LINEAR", [0, 0.1234, 0.77], [0, 3, 5])], 0.002)
        self.assertIn("lie on no common frame rate", said)
        self.assertIn("--fps", said)
        clips = [(f"at {rate}", "LINEAR", at_rate(rate, *range(n)), list(range(n)))
                 for rate, n in ((24, 12), (25, 20), (60, 31))]
        said, rate = self.check(clips, 1)
        self.assertIn("sampled at 60 frames per second, where those of 1 of 3 lie", said)
        self.assertIn("600 has frames at all keys", said)
        self.assertEqual(rate, 60)
        self.check(clips, 0.002, "--fps", 600)

    def test_random_clips(self):
        random = Random(48)
        for _ in range(12):
            clips = []
            alone = random.random() < 0.5
            for k in range(1 if alone else random.randint(2, 4)):
                rate = random.choice((24, 25, 30, 60))
                count = random.randint(1, 12)
                start = random.choice((0, 0, random.randint(1, 30) / rate, random.random()))
                times = [start + f / rate for f in sorted(random.sample(range(40), count))]
                if random.random() < 0.3:
                    times.append(times[-1] + random.uniform(0.002, 0.5))
                clips.append((f"clip {k}", random.choice(("LINEAR", "STEP", "CUBICSPLINE")), times,
                              [random.randint(-5, 5) for _ in times]))
            self.check(clips, 0.002 if alone else 1)

    def test_models_of_others(self):
        folder = ROOT.parent / "shared" / "data" / "gltf"
        names = [folder / f"{name}.glb"
                 for name in ("fox", "robot", "q-trex", "interpolation-test")]
        if not all(name.exists() for name in names):
            self.skipTest("needs the models in ../shared/data/gltf")
        for name in names:
            source = name.read_bytes()
            _, info, out = self.through(source, "--no-attributes")
            wanted, found = durations(source), durations(out)
            interval = info["frame_rate"][1] / info["frame_rate"][0]
            for clip, seconds in wanted.items():
                # The keys of one clip of the fox lie between frames of the others.
                slack = interval if (name.stem, clip) == ("fox", "Run") else 1e-5
                self.assertAlmostEqual(found[clip], seconds, delta=slack, msg=f"{name} {clip}")


class GltfErrors(ToolsTest):
    def test_a_point_cache_is_not_for_gltf(self):
        cache = INPUTS / "elephant.pc2"
        words = [f"{TULIP}: a glTF file brings its own animation and takes no --points; leave it "
                 "out, or replace this file by the mesh (", f") of {cache}"]
        output = ["-o", self.path("a.rlpc")]
        self.fails(1, words, "rlpcenc", TULIP, "--points", cache, *output)
        self.fails(1, words, "rlpcenc", TULIP, "--points", cache, "--animation", "all", *output)
        self.path("tulip").write_bytes(TULIP.read_bytes())  # known by its contents
        self.fails(1, "takes no --points", "rlpcenc", self.path("tulip"), "--points", cache,
                   *output)
        self.fails(1, "takes no --points", "rlpcenc", TULIP, "--points", "-", "--low-delay",
                   "--profile", "high", *output)
        self.fails(2, words, "rlpccmp", TULIP, TULIP, "--points-b", cache)

    def refused(self, words, data, *options):
        self.path("bad.glb").write_bytes(data)
        self.fails(1, ["bad.glb", *words], "rlpcenc", self.path("bad.glb"), "-o",
                   self.path("a.rlpc"), *options)
        self.fails(2, ["bad.glb", *words], "rlpccmp", self.path("bad.glb"), self.path("bad.glb"),
                   *options)
        self.assertEqual(self.files(), ["bad.glb"])

    def test_what_is_wrong_is_named(self):
        def put(*path):
            *places, last, value = path

            def change(document):
                for place in places:
                    document = document[place]
                document[last] = value
            return change

        cases = [
            (put("extensionsRequired", 0, "KHR_draco_mesh_compression"),
             ["extensionsRequired[0]", "KHR_draco_mesh_compression", "without compression"]),
            (put("accessors", 3, "count", 833333334), ["accessors[3].count", "833333334"]),
            (put("bufferViews", 0, "byteLength", 10 << 30), ["bufferViews[0].byteLength"]),
            (put("buffers", 0, "byteLength", 10 << 30), ["buffers[0].byteLength", "10737418240"]),
            (put("nodes", 4, "children", [0]), ["nodes[", "its own ancestor"]),
            (put("nodes", 5, "children", [4]), ["nodes[5].children", "child of nodes[3]"]),
            (put("skins", 0, "joints", [0, 1]), ["accessors[1], element", "joints below 2"]),
            (put("nodes", 5, "mesh", 7), ["nodes[5].mesh", "7"]),
            (put("scenes", 0, "nodes", []), ["scenes", "triangles"]),
        ]
        for change, words in cases:
            document, data = parts(TULIP.read_bytes())
            change(document)
            self.refused(words, make_gltf.packed(document, data))

    def test_every_cut_file_is_refused(self):
        whole = TULIP.read_bytes()
        for size in (0, 3, 11, 19, 500, len(whole) // 2, len(whole) - 1):
            self.refused([], whole[:size])

    def test_missing_buffers(self):
        document, _ = parts(TULIP.read_bytes())
        for uri, words in (("none.bin", "no such file"), ("../a.bin", "in the folder"),
                           ("/etc/hostname", "in the folder")):
            document["buffers"][0]["uri"] = uri
            self.refused([words], json.dumps(document).encode())
        document["buffers"][0]["uri"] = "-"  # not standard input
        self.path("bad.gltf").write_text(json.dumps(document))
        self.fails(1, "./-: no such file", "rlpcenc", "bad.gltf", "-o", "a.rlpc", cwd=self.folder,
                   input=parts(TULIP.read_bytes())[1])

    def test_options_of_gltf_only(self):
        self.refused(['"Dance"', '"Sway", "Visit"'], TULIP.read_bytes(), "--animation", "Dance")
        elephant = INPUTS / "elephant.obj"
        for source in ([elephant], [elephant, "--points", INPUTS / "elephant.pc2"], [INPUTS]):
            self.fails(1, "--animation is for .glb and .gltf files", "rlpcenc", *source,
                       "--animation", "Walk", "-o", self.path("a.rlpc"))

    def test_standard_input_is_named(self):
        whole = TULIP.read_bytes()
        for data, words in ((whole[:500], "length: found 11284"), (b"{", "not a glTF document"),
                            (b'{"asset":{"version":"1.0"}}', "asset.version")):
            self.fails(1, f"standard input: {words}", "rlpcenc", "-", "-o", self.path("a.rlpc"),
                       input=data)
        messages = self.ok("rlpcenc", "-", "-o", self.path("a.rlpc"), "--kg", 1, input=whole).err
        self.assertIn("standard input: merged 53 duplicate vertices", messages)


if __name__ == "__main__":
    main()
