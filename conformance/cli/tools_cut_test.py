#!/usr/bin/env python3
"""Cuts of streams with slices: rlpcinfo --extract, and rlpcdec with the same limits.

    tools_cut_test.py --bin BUILD/bin [unittest arguments, such as Cutting]
"""

import random
import subprocess
import sys

from tools_testing import ROOT, ToolsTest, limited, main, run, searched

for folder in ("judge", "specdec", "rlpcgen"):
    sys.path.insert(0, str(ROOT / "conformance" / folder))
import random_high
from specdec_testing import PROGRAM

STREAM_HEADER_BYTES, UNIT_BYTES = 10, 9  # header and CRC
GOF, GOF_INDEX, GOF_HASH, ATTRIBUTES, END = 4, 129, 130, 136, 5
SLICES = 6, 8  # slice and frame units


def units_of(stream):
    """(type, bytes) of each unit."""
    units, at = [], STREAM_HEADER_BYTES
    while at < len(stream):
        end = at + UNIT_BYTES + int.from_bytes(stream[at + 1:at + 5], "big")
        units.append((stream[at], stream[at:end]))
        at = end
    return units


def expected_groups(slices, components, first=1, total=0):
    """The component groups from `first` on that a cut keeps, and the trajectories up to them."""
    groups = set()
    for s in slices:
        if s["component_group_idx"] < first:
            continue
        total += s["num_trajectories"]
        if total > components:
            break
        groups.add(s["component_group_idx"])
    return groups, total


def expected_slices(gof, components, layers, rigs, temporal):
    """The slices of a GOF or shared rig (rlpcinfo --json) that a cut keeps, counted without
    the tools."""
    if "slices" not in gof:
        return []
    sizes = gof["layer_group_size"]
    if "rig" in gof:
        rig = rigs[gof["rig"]]
        groups, total = expected_groups(rig["slices"], components)
        if len(groups) == rig["num_component_groups"]:
            groups |= expected_groups(gof["slices"], components, len(groups) + 1, total)[0]
    else:
        groups, _ = expected_groups(gof["slices"], components)
    num = max([1] + [n for n in range(1, len(sizes) + 1) if sum(sizes[:n]) <= layers])
    return [s for s in gof["slices"]
            if s["component_group_idx"] in groups | {0} and s["layer_group_idx"] < num
            and s["temporal_layer_idx"] < temporal]


class CutTest(ToolsTest):
    builders = {}

    def random_stream(self, seed, profile="main"):
        if profile not in CutTest.builders:
            CutTest.builders[profile] = random_high.builder_of(profile)(PROGRAM)
        path = self.path("in.rlpc")
        path.write_bytes(CutTest.builders[profile].build(seed)[0])
        return path

    def skinned_gofs(self, path):
        gofs = self.ok("rlpcinfo", path, "--json").json()["gofs"]
        return [gof for gof in gofs if "num_bones" in gof]

    def rich_stream(self, profile="main", temporal_layers=1):
        """The first random stream with GOFs of several component groups and layer groups."""
        for seed in range(2000):
            path = self.random_stream(seed, profile)
            for gof in self.skinned_gofs(path):
                if (len(gof["cut_to_components"]) > 2 and len(gof["cut_to_layers"]) > 1
                        and len(gof["cut_to_temporal_layers"]) >= temporal_layers):
                    return path
        raise AssertionError("no such stream")

    def extract(self, path, cut, *options):
        return self.ok("rlpcinfo", path, "--extract", cut, "-o", self.path("cut.rlpc"), *options)


class Cutting(CutTest):
    SEEDS = searched(16, 40)
    SPECDEC_SEEDS = searched(5, 12)  # seeds whose cut streams specdec decodes as well

    def check(self, seed, components, layers, profile="main", temporal=8):
        """Cuts a random stream; returns whether slices were dropped."""
        path, cut = self.random_stream(seed, profile), self.path("cut.rlpc")
        report = self.extract(path, f"components={components},layers={layers},temporal={temporal}",
                              "--json").json()
        info = self.ok("rlpcinfo", path, "--json").json()
        rigs = info.get("rigs", [])
        entries = rigs + info["gofs"]
        stay = [expected_slices(gof, components, layers, rigs, temporal) for gof in entries]
        for gof, slices, entry in zip(report["rigs"] + report["gofs"], stay, entries,
                                      strict=True):
            self.assertEqual(gof["after"]["num_slices"], len(slices))
            self.assertEqual(gof["before"]["num_slices"], len(entry.get("slices", [])))
            self.assertEqual(gof["after"]["num_trajectories"],
                             sum(s["num_trajectories"] for s in slices))
            self.assertEqual(gof["after"]["bytes"],
                             entry["bytes"] + sum(s["bytes"] for s in slices))
        before, after = units_of(path.read_bytes()), units_of(cut.read_bytes())
        self.assertEqual(sum(code in SLICES for code, _ in after), sum(map(len, stay)))
        dropped = [ATTRIBUTES] if report["attributes_dropped"] else []
        self.assertEqual([code for code, _ in after if code not in SLICES],
                         [code for code, _ in before if code not in (*SLICES, *dropped)])
        if dropped:
            self.assertIn(ATTRIBUTES, [code for code, _ in before])
            self.assertTrue(report["cut"])
        left = iter(before)
        for unit in after:  # all others keep their order and their bytes
            if unit[0] not in (GOF_INDEX, GOF_HASH, END):
                self.assertIn(unit, left)
        self.assertEqual(report["after"]["bytes"], cut.stat().st_size)
        self.assertEqual(report["cut"], len(before) != len(after))
        if not report["cut"]:
            self.assertEqual(cut.read_bytes(), path.read_bytes())
        verdict = self.ok("rlpcval", "--json", cut).json()["streams"][0]["verdict"]
        self.assertEqual(verdict, "conforming", f"seed {seed}")
        self.ok("rlpcdec", cut, "-o", self.path("cut.rlpd"))
        done = self.ok("rlpcdec", path, "-o", self.path("whole.rlpd"), "--max-components",
                       components, "--max-layers", layers, "--max-temporal-layers", temporal,
                       "--json").json()
        loses = [len(slices) < len(entry.get("slices", [])) for slices, entry in zip(stay, entries)]
        is_cut = any(cut or ("rig" in gof and loses[gof["rig"]])  # not unused rigs
                     for cut, gof in zip(loses[len(rigs):], info["gofs"], strict=True))
        self.assertEqual(done["cut"], is_cut)
        kinds = [code for code, _ in before]
        hashed = kinds.count(GOF) == kinds.count(GOF_HASH)
        if SLICES[1] not in kinds:  # frame units can have hashes of their own
            self.assertEqual(done["hashes_verified"], hashed and not is_cut)
        self.assertEqual(self.path("cut.rlpd").read_bytes(), self.path("whole.rlpd").read_bytes(),
                         f"seed {seed}")
        return report["cut"]

    def test_random_streams_of_the_main_profile(self):
        self.check_all("main")

    def test_random_streams_of_the_high_profile(self):
        self.check_all("high")

    def check_all(self, profile):
        cuts = 0
        for seed in range(self.SEEDS):
            numbers = random.Random(seed)
            cut = self.check(seed, numbers.choice([0, 0, 1, 2, 3, 5, 1000]),
                             numbers.choice([1, 2, 9]), profile, numbers.choice([1, 2, 3, 8]))
            cuts += cut
            if cut and seed < self.SPECDEC_SEEDS:
                subprocess.run([sys.executable, ROOT / "conformance/specdec/specdec.py", "decode",
                                self.path("cut.rlpc"), self.path("spec.rlpd")], check=True)
                self.assertEqual(self.path("cut.rlpd").read_bytes(),
                                 self.path("spec.rlpd").read_bytes(), f"seed {seed}")
        self.assertGreater(cuts, self.SEEDS // 4)

    def test_frames_by_seeking(self):
        path = self.rich_stream()
        frames = self.ok("rlpcinfo", path, "--json").json()["num_frames"]
        for options in (["--max-components", 0], ["--max-layers", 1], ["--max-components", 1]):
            self.ok("rlpcdec", path, "-o", self.path("all.rlpd"), *options)
            whole = self.path("all.rlpd").read_bytes()
            for f in range(frames):
                self.ok("rlpcdec", path, "-o", self.path("one.rlpd"), "--frames", f, *options)
                one = self.path("one.rlpd").read_bytes()
                size = (len(whole) - len(one)) // max(1, frames - 1)
                start = len(whole) - (frames - f) * size
                self.assertEqual(one[len(one) - size:], whole[start:start + size])

    def test_what_rlpcinfo_says_beforehand_is_what_comes_out(self):
        self.check_what_is_said(self.rich_stream())

    def test_what_rlpcinfo_says_of_temporal_layers_is_what_comes_out(self):
        path = self.rich_stream("high", 3)
        self.check_what_is_said(path)
        said = self.ok("rlpcinfo", path, "--gofs").out.decode()
        for gof in self.skinned_gofs(path):
            sizes = [cut["bytes"] for cut in gof["cut_to_temporal_layers"]]
            for layer in range(1, len(sizes)):
                added = sizes[layer] - sizes[layer - 1]
                self.assertRegex(said, rf"temporal layer {layer} +{added} .* {sizes[layer]}\n")
        self.assertRegex(self.extract(path, "temporal=2").out.decode(),
                         r"2 of [3-8] temporal layers")

    def check_what_is_said(self, path):
        info = self.ok("rlpcinfo", path, "--json").json()
        # The largest number of layers that some GOF must keep.
        lowest = max(min((c["layers"] for c in gof["cut_to_layers"] if c["layers"] > 0), default=0)
                     for gof in info["gofs"] if "cut_to_layers" in gof)
        for name, key in (("components", "cut_to_components"), ("layers", "cut_to_layers"),
                          ("temporal", "cut_to_temporal_layers")):
            for g, gof in enumerate(info["gofs"]):
                for choice in gof.get(key, []):
                    size = choice["temporal_layers" if name == "temporal" else name]
                    if name == "layers" and size == 0:
                        continue  # no slices are kept
                    report = self.extract(path, f"{name}={size}", "--json").json()
                    self.assertEqual(report["gofs"][g]["after"]["bytes"], choice["bytes"])
                    self.assertEqual(report["request_met"], name != "layers" or size >= lowest)
        said = self.ok("rlpcinfo", path, "--gofs").out.decode()
        self.assertIn("GOF to here", said)
        for gof in self.skinned_gofs(path):
            self.assertIn(f" {gof['cut_to_components'][-1]['bytes']}\n", said)

    def test_the_report_in_words(self):
        path = self.rich_stream()
        said = self.extract(path, "components=0,layers=1").out.decode()
        report = self.extract(path, "components=0,layers=1", "--json").json()
        for words in (f"{report['before']['bytes']} bytes", f"{report['after']['bytes']} bytes",
                      f"{report['after']['bpvf']:.4f} bpvf", " 0 of ", "slices"):
            self.assertIn(words, said)
        self.assertNotIn("nothing was dropped", said)
        self.assertIn("nothing was dropped", self.extract(path, "components=9999").out.decode())
        self.assertIn("hashes of GOFs that lack slices were not verified",
                      self.ok("rlpcdec", path, "-o", self.path("a.rlpd"),
                              "--max-components", 0).err)
        self.assertIn("without hashes",
                      self.ok("rlpcdec", path, "-o", self.path("a.rlpd"),
                              "--max-components", 9999).err)

    def test_as_many_groups_as_are_asked_for(self):
        """At most one group per layer, and one per trajectory."""
        for asked in ((4, 2), (2, 5), (255, 1), (1, 255)):
            self.encode(self.path("a.rlpc"), "--gof", 30, "--layer-groups", asked[0],
                        "--component-groups", asked[1])
            gofs = self.skinned_gofs(self.path("a.rlpc"))
            self.assertEqual(len(gofs), 2)
            for gof in gofs:
                self.assertEqual(len(gof["layer_group_size"]),
                                 min(asked[0], sum(gof["layer_group_size"])))
                sizes = [s["num_trajectories"] for s in gof["slices"]
                         if s["layer_group_idx"] == 0]
                self.assertEqual(len(sizes) - 1, min(asked[1], sum(sizes)))  # except group 0
            self.ok("rlpcdec", self.path("a.rlpc"), "--verify")

    def test_layer_cuts(self):
        for more in ((), ("--profile", "high", "--gof-kind", "inter")):
            self.encode(self.path("a.rlpc"), "--gof", 30, "--layer-cuts", "10,30", *more)
            info = self.ok("rlpcinfo", self.path("a.rlpc"), "--gofs", "--json").json()
            for gof in info["gofs"]:
                self.assertEqual(len(gof["layer_group_size"]), 3)
        for cuts, words in (("30,10", "each is greater than the one before"),
                            ("0,3", "--layer-cuts"), ("3,3", "each is greater"),
                            ("x", "--layer-cuts")):
            self.fails(64, words, "rlpcenc", self.path("a.obj"), "-o", self.path("b.rlpc"),
                       "--layer-cuts", cuts)

    def test_what_is_cut_cannot_be_verified(self):
        path = self.rich_stream()
        for cut in ("--max-components", "--max-layers", "--max-temporal-layers"):
            self.fails(64, "--verify excludes " + cut, "rlpcdec", path, "--verify", cut, 1)

    def test_cluster_gofs_stay_whole(self):
        """Cutting a stream of the suite gives another stream of the suite."""
        streams = ROOT / "streams/v1.1/accept/MIX"
        said = self.extract(streams / "MIX-0201a.rlpc", "components=2,layers=1").out.decode()
        self.assertEqual(self.path("cut.rlpc").read_bytes(),
                         (streams / "MIX-0202a.rlpc").read_bytes())
        for words in ("frames 0 to 3: cluster GOF, 271 bytes, kept whole", "frames 4 to 8: 2 of 3"):
            self.assertIn(words, said)
        self.assertIn("nothing was dropped", self.extract(
            streams / "MIX-0203a.rlpc", "components=0,layers=1").out.decode())

    def test_layers_that_cannot_be_left_out(self):
        for seed in range(100):
            path = self.random_stream(seed)
            gofs = self.skinned_gofs(path)
            if any(gof["slices"] and gof["layer_group_size"][0] > 1 for gof in gofs):
                break
        self.assertFalse(self.extract(path, "layers=1", "--json").json()["request_met"])
        self.assertIn("the first layer group is always kept",
                      self.extract(path, "layers=1").out.decode())


class CuttingErrors(CutTest):
    def test_usage(self):
        path, out = self.random_stream(0), self.path("cut.rlpc")
        for cut in ("", "components", "components=", "components=-1", "components=x", "layers=0",
                    "components=1,components=2", "layers=1,layers=1", "components=1,", ",layers=1",
                    "components=1 layers=2", "components=4294967295", "components=99999999999",
                    "layers=1.5", "slices=2", "components=+1", "Components=1", "temporal=0",
                    "temporal=1,temporal=1", "temporal="):
            self.fails(64, "components=K", "rlpcinfo", path, "-o", out, "--extract", cut)
        self.fails(64, "", "rlpcinfo", path, "--extract", "layers=1")
        self.fails(64, "", "rlpcinfo", path, "-o", out)
        for option in ("--gofs", "--trace"):
            self.fails(64, "", "rlpcinfo", path, "--extract", "layers=1", "-o", out, option)
        for options in (["--max-layers", 0], ["--max-layers", "x"], ["--max-components", -1],
                        ["--max-components", "1,2"], ["--max-layers", 4294967296],
                        ["--max-temporal-layers", 0]):
            self.fails(64, "", "rlpcdec", path, "--verify", *options)
        self.assertEqual(self.files(), ["in.rlpc"])

    def test_the_output_is_the_input(self):
        path = self.rich_stream()
        before = path.read_bytes()
        self.path("link.rlpc").symlink_to(path)
        for output in (path, self.path("link.rlpc"), f"{self.folder}/./in.rlpc"):
            self.fails(64, "is also an input", "rlpcinfo", path, "--extract", "layers=1", "-o",
                       output)
        self.assertEqual(path.read_bytes(), before)
        self.assertEqual(self.files(), ["in.rlpc", "link.rlpc"])

    def test_places_that_cannot_be_written(self):
        path = self.rich_stream()
        self.path("folder").mkdir()
        for output in (self.path("none/a.rlpc"), self.path("folder"), "/dev/full"):
            self.fails(4, str(output), "rlpcinfo", path, "--extract", "layers=1", "-o", output)
        self.path("a.rlpc").write_bytes(b"what was there")
        for output in ("a.rlpc", "b.rlpc"):
            result = run("rlpcinfo", path, "--extract", "layers=1", "-o", self.path(output),
                         **limited(100))
            self.assertEqual(result.code, 4, result.err)
            self.assertIn(output, result.err)
        self.assertEqual(self.path("a.rlpc").read_bytes(), b"what was there")
        self.assertEqual(self.files(), ["a.rlpc", "folder", "in.rlpc"])

    def test_streams_that_cannot_be_cut(self):
        out = self.path("cut.rlpc")
        self.encode(self.path("a.rlpc"), "--kg", 1, "--profile", "baseline")
        self.fails(2, ["a.rlpc", "Baseline profile"], "rlpcinfo", self.path("a.rlpc"), "--extract",
                   "layers=1", "-o", out)
        self.fails(2, ["a.rlpc", "Baseline profile"], "rlpcdec", self.path("a.rlpc"), "-o",
                   self.path("a.rlpd"), "--max-components", 3)
        self.fails(4, "none.rlpc", "rlpcinfo", self.path("none.rlpc"), "--extract", "layers=1",
                   "-o", out)
        stream = bytearray(self.rich_stream().read_bytes())
        stream[len(stream) // 2] ^= 4
        self.path("in.rlpc").write_bytes(stream)
        self.fails(1, ["in.rlpc", "R-"], "rlpcinfo", self.path("in.rlpc"), "--extract", "layers=1",
                   "-o", out)
        self.assertEqual(self.files(), ["a.rlpc", "in.rlpc"])


if __name__ == "__main__":
    main()
