#!/usr/bin/env python3
"""Tests the tools on streams whose GOFs use shared rigs.

    tools_rigs_test.py --bin BUILD/bin [unittest arguments, such as Rigs]
"""

import struct

from tools_testing import NAMES, ToolsTest, main


class Rigs(ToolsTest):
    def test_gofs_of_the_bundled_animations_share_a_rig(self):
        for name in NAMES:
            sizes = {}
            for profile in ("main", "high"):
                stream = self.path(f"{name}-{profile}.rlpc")
                report = self.encode(stream, "--kg", 0.5, "--gof", 20, "--profile", profile,
                                     name=name)
                self.assertTrue(report["target_met"], name)
                self.assertGreater(report["num_gofs"], 2)
                self.ok("rlpcdec", stream, "--verify")
                sizes[profile] = stream.stat().st_size
            info = self.ok("rlpcinfo", self.path(f"{name}-high.rlpc"), "--json").json()
            self.assertEqual(len(info["rigs"]), 1, name)
            self.assertEqual([gof["rig"] for gof in info["gofs"]], [0] * info["num_gofs"])
            self.assertEqual(info["rigs"][0]["num_gofs"], info["num_gofs"])
            self.assertLess(sizes["high"], 0.8 * sizes["main"], name)

    def test_the_profile_decides_how_long_gofs_are(self):
        mesh, points = self.path("long.obj"), self.path("long.pc2")
        mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        frames = [[0, 0, f % 7, 1, 0, f % 5, 0, 1, f % 3] for f in range(300)]
        points.write_bytes(b"POINTCACHE2\0" + struct.pack("<iiffi", 1, 3, 0, 1, len(frames))
                           + b"".join(struct.pack("<9f", *frame) for frame in frames))
        for profile, num_gofs in (("main", 3), ("high", 2)):
            stream = self.path(profile + ".rlpc")
            self.ok("rlpcenc", mesh, "--points", points, "--preset", "fast", "--kg", 0.1,
                    "--profile", profile, "-o", stream)
            info = self.ok("rlpcinfo", stream, "--json").json()
            self.assertEqual(info["num_gofs"], num_gofs, profile)

    def test_rlpcinfo_lists_rigs_with_their_slices(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--kg", 0.5, "--gof", 20, "--profile", "high")
        data, at, sizes, rig_sizes, is_rig = stream.read_bytes(), 10, [], [], False
        while at < len(data):
            size = 9 + int.from_bytes(data[at + 1:at + 5], "big")
            if data[at] in (4, 7):
                is_rig = data[at] == 7
            if data[at] in (4, 6, 7):
                (rig_sizes if is_rig else sizes).append(size)
            at += size
        info = self.ok("rlpcinfo", stream, "--json").json()
        self.assertEqual([n["bytes"] for g in info["gofs"] for n in (g, *g["slices"])], sizes)
        self.assertEqual([n["bytes"] for m in info["rigs"] for n in (m, *m["slices"])],
                         rig_sizes)
        self.assertEqual(sum(info["bits"].values()), 8 * info["bytes"])
        said = self.ok("rlpcinfo", stream, "--gofs").out.decode()
        for words in ("shared rigs: 1, with ", "skinned GOFs with shared rigs: 3, with ",
                      "shared rig 0, used by 3 GOFs: ",
                      "frames 20 to 39: tracks of shared rig 0 in "):
            self.assertIn(words, said)
        page = self.path("a.html")
        self.ok("rlpcinfo", stream, "--html", page)
        for words in ("Slices of shared rig 0", "without shared rigs", "rig to here"):
            self.assertIn(words, page.read_text())

    def test_a_cut_in_words(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--kg", 0.5, "--gof", 20, "--profile", "high",
                    "--component-groups", 6, "--layer-groups", 3)
        said = self.ok("rlpcinfo", stream, "--extract", "components=4", "-o",
                       self.path("cut.rlpc")).out.decode()
        for words in ("shared rig 0: ", "frames 0 to 19, tracks of shared rig 0: "):
            self.assertIn(words, said)
        self.ok("rlpcdec", self.path("cut.rlpc"), "--verify")


if __name__ == "__main__":
    main()
