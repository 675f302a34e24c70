#!/usr/bin/env python3
"""Inter GOFs, by the tools.

    tools_frames_test.py --bin BUILD/bin [unittest arguments, such as Frames]
"""

from tools_testing import INPUTS, NAMES, ToolsTest, main


class Frames(ToolsTest):
    def test_the_bundled_animations_meet_their_target(self):
        for name in NAMES:
            for how in ((), ("--frame-weights", "geometry"), ("--frame-weights", "plain"),
                        ("--frame-pattern", "previous"),
                        ("--frame-pattern", "first"),
                        ("--frame-pattern", "dyadic:8"), ("--frame-pattern", "2<0,1<0+2@1")):
                stream = self.path("a.rlpc")
                report = self.encode(stream, "--kg", 0.5, "--profile", "high", "--gof-kind",
                                     "inter", *how, name=name)
                self.assertTrue(report["target_met"], (name, how))
                self.ok("rlpcdec", stream, "--verify")
                self.ok("rlpcdec", stream, "--verify", "--threads", 3)
                gofs = self.ok("rlpcinfo", stream, "--json").json()["gofs"]
                self.assertTrue(all("num_frame_units" in gof for gof in gofs), (name, how))
                for gof in gofs:
                    self.assertEqual(len(gof["slices"]), gof["num_frame_units"])
                    self.assertLess(gof["num_frame_units"], gof["num_frames"])
                    self.assertEqual(sum(unit["num_frames"] for unit in gof["slices"]),
                                     gof["num_frames"])

    def test_a_first_frame_in_an_order_of_its_own_is_smaller(self):
        stream, sizes = self.path("a.rlpc"), {}
        for how in (["--kg", 0.1], ["--lossless", 12], ["--kg", 0.1, "--low-delay"]):
            for rest in ("prediction", "order", "auto"):
                self.encode(stream, "--profile", "high", "--gof-kind", "inter", "--gof", 20,
                            "--rest", rest, *how)
                self.ok("rlpcdec", stream, "--verify")
                info = self.ok("rlpcinfo", stream, "--json").json()
                sizes[rest] = sum(gof["slices"][0]["bytes"] for gof in info["gofs"])
            self.assertLess(sizes["order"], 0.97 * sizes["prediction"], how)
            self.assertLessEqual(sizes["auto"], sizes["order"], how)

    def test_frames_share_units(self):
        stream = self.path("a.rlpc")
        for number, units in ((1, 20), (6, 5), (100, 2)):  # the first frame has its own
            self.encode(stream, "--kg", 0.5, "--profile", "high", "--gof-kind", "inter", "--gof",
                        20, "--frames-per-unit", number)
            self.ok("rlpcdec", stream, "--verify")
            gofs = self.ok("rlpcinfo", stream, "--json").json()["gofs"]
            self.assertEqual([gof["num_frame_units"] for gof in gofs], [units] * 3)

    def test_vertices_that_follow_motions_are_counted(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--kg", 0.5, "--profile", "high", "--gof-kind", "inter", "--gof", 20,
                    "--frame-weights", "plain", "--partition", "kway", "--patches", 6,
                    name="robot_arm")
        self.ok("rlpcdec", stream, "--verify")
        info = self.ok("rlpcinfo", stream, "--json").json()
        moved = 0
        for gof in info["gofs"]:
            self.assertEqual(gof["num_patches"], 6)
            first, *later = gof["vertices_of_frame"]
            self.assertEqual(first["from_neighbours"], info["num_vertices"])
            self.assertEqual(len(later), gof["num_frames"] - 1)
            for modes in later:
                self.assertIn(sum(modes.values()), (0, info["num_vertices"]))
                moved += sum(modes.values()) - modes["from_neighbours"]
        self.assertGreater(moved, 0)
        self.assertRegex(self.ok("rlpcinfo", stream, "--gofs").out.decode(),
                         r"\d+ frames with motions of patches; vertices that follow them, on ")

    def test_patches_without_knowing_the_motion(self):
        stream = self.path("a.rlpc")
        for partition in ("kway", "motion"):
            report = self.encode(stream, "--max-error", 0.004, "--profile", "high", "--low-delay",
                                 "--partition", partition, "--patches", 6, name="robot_arm")
            self.assertLess(report["metrics"]["max_error"], 0.004)
            self.ok("rlpcdec", stream, "--verify")
            gofs = self.ok("rlpcinfo", stream, "--json").json()["gofs"]
            for gof in gofs:
                self.assertEqual(gof["num_patches"], 6)
            self.assertTrue(any(sum(modes.values()) > modes["from_neighbours"]
                                for gof in gofs for modes in gof["vertices_of_frame"]))

    def test_patches_that_there_cannot_be(self):
        mesh, stream = INPUTS / "elephant.obj", self.path("a.rlpc")
        for options, words in (
                (("--profile", "high", "--partition", "seeds"), "patches are not made from seeds"),
                (("--profile", "main", "--partition", "kway"),
                 "--partition needs --profile baseline"),
                (("--profile", "main", "--patches", 3), "need --profile high and --gof-kind inter"),
                (("--profile", "high", "--patches", 2000), "2000 not in range")):
            self.fails(64, words, "rlpcenc", mesh, "-o", stream, *options)
            self.assertFalse(stream.exists())

    def test_learned_weights_take_fewer_bytes(self):
        sizes = {}
        for weights in ("learned", "geometry", "plain"):
            stream = self.path(weights + ".rlpc")
            self.encode(stream, "--kg", 0.1, "--profile", "high", "--gof-kind", "inter",
                        "--frame-weights", weights)
            sizes[weights] = stream.stat().st_size
        self.assertLess(sizes["learned"], 0.6 * sizes["geometry"])
        self.assertLess(sizes["geometry"], sizes["plain"])

    def test_bytes_do_not_depend_on_threads(self):
        streams = []
        for threads in (1, 3):
            stream = self.path(f"{threads}.rlpc")
            self.encode(stream, "--kg", 0.5, "--profile", "high", "--gof-kind", "inter",
                        "--threads", threads, preset="medium")
            streams.append(stream.read_bytes())
        self.assertEqual(*streams)

    def test_the_choices_in_words(self):
        said = self.ok("rlpcenc", INPUTS / "elephant.obj", "--points", INPUTS / "elephant.pc2",
                       "-o", self.path("a.rlpc"), "-v", "--kg", 0.5, "--gof", 20, "--profile",
                       "high", "--gof-kind", "inter")
        self.assertIn("3 inter GOFs, ", said.out.decode())
        self.assertRegex(said.out.decode(), "[1-3] inter GOFs? with pattern [a-z]")

    def test_the_pattern_is_chosen(self):
        options = ("--kg", 0.3, "--profile", "high", "--gof-kind", "inter")
        sizes = {}
        for pattern in ("auto", "previous", "first", "dyadic:16"):
            stream = self.path(pattern + ".rlpc")
            report = self.encode(stream, *options, "--frame-pattern", pattern, preset="medium")
            sizes[pattern] = stream.stat().st_size
            self.assertEqual(sum(count["gofs"] for count in report["frame_patterns"]), 1)
            if pattern != "auto":
                self.assertEqual(report["frame_patterns"][0]["frame_pattern"], pattern)
        self.assertLess(sizes["auto"], 0.96 * sizes["previous"])
        self.assertLess(sizes["auto"], 1.02 * min(sizes.values()))
        self.encode(self.path("d.rlpc"), *options, preset="medium")
        self.assertEqual(self.path("d.rlpc").read_bytes(), self.path("auto.rlpc").read_bytes())

    def test_the_pattern_has_the_temporal_layers(self):
        stream = self.path("a.rlpc")
        for layers in (2, 5, 7):
            report = self.encode(stream, "--kg", 0.5, "--profile", "high", "--gof-kind", "inter",
                                 "--temporal-layers", layers)
            self.assertEqual(len(report["temporal_cuts"]), layers - 1)
            gof = self.ok("rlpcinfo", stream, "--json").json()["gofs"][0]
            self.assertEqual(gof["num_temporal_layers"], layers)
        mesh = INPUTS / "elephant.obj"
        for options, words in ((("--temporal-layers", 8), "there are 1 to 7 temporal layers"),
                               (("--temporal-layers", 2, "--frame-pattern", "previous"),
                                "this pattern has 1 to 1 temporal layers")):
            self.fails(64, words, "rlpcenc", mesh, "-o", stream, "--profile", "high",
                       "--gof-kind", "inter", *options)

    def test_rlpcinfo_lists_frame_units(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--kg", 0.5, "--gof", 20, "--profile", "high", "--gof-kind", "inter")
        data, at, sizes = stream.read_bytes(), 10, []
        while at < len(data):
            size = 9 + int.from_bytes(data[at + 1:at + 5], "big")
            if data[at] in (4, 8):
                sizes.append(size)
            at += size
        info = self.ok("rlpcinfo", stream, "--json").json()
        self.assertEqual([n["bytes"] for g in info["gofs"] for n in (g, *g["slices"])], sizes)
        self.assertEqual(sum(info["bits"].values()), 8 * info["bytes"])
        self.assertGreater(info["bits"]["frames"], 0.5 * 8 * info["bytes"])
        said = self.ok("rlpcinfo", stream, "--gofs").out.decode()
        for words in ("inter GOFs: 3, with ", "2 frame units each", "frame units in bytes"):
            self.assertIn(words, said)
        page = self.path("a.html")
        self.ok("rlpcinfo", stream, "--html", page)
        self.assertIn("Units of frames 2", page.read_text())

    def test_lossless_on_a_grid_and_again_on_its_own(self):
        mesh, points = INPUTS / "elephant.obj", INPUTS / "elephant.pc2"
        options = ("--profile", "high", "--keep-order")
        stream, decoded, again = self.path("a.rlpc"), self.path("a.pc2"), self.path("b.rlpc")
        said = self.ok("rlpcenc", mesh, "--points", points, "-o", stream, "--lossless", 13,
                       *options).out.decode()
        self.assertIn("lossless: all coordinates of all frames, after rounding to a grid", said)
        info = self.ok("rlpcinfo", stream, "--json").json()
        self.assertIn(info["position_bits"], (12, 13))
        step = 2.0 ** info["grid_log2_step"]
        self.ok("rlpccmp", mesh, "--points-a", points, mesh, "--points-b",
                self.decoded(stream, decoded), "--max-error", 0.51 * 3 ** 0.5 * step)
        said = self.ok("rlpcenc", mesh, "--points", decoded, "-o", again, "--lossless",
                       *options).out.decode()
        self.assertIn("lossless: all coordinates of all frames, which lie on a grid of 2^", said)
        self.assertIn("KG error 0 %", said)
        twice = self.decoded(again, self.path("b.pc2"))
        self.assertEqual(decoded.read_bytes(), twice.read_bytes())

    def decoded(self, stream, points):
        self.ok("rlpcdec", stream, "-o", points)
        return points

    def test_lossless_without_a_grid(self):
        mesh, points = INPUTS / "elephant.obj", INPUTS / "elephant.pc2"
        out = self.path("a.rlpc")
        self.fails(1, "have no common grid of 24 bits or fewer. Use --lossless BITS", "rlpcenc",
                   mesh, "--points", points, "-o", out, "--profile", "high", "--lossless")
        self.assertFalse(out.exists())
        for options, words in ((("--lossless", 25), "found `25`"),
                               (("--lossless", 1), "from 2 to 24"),
                               (("--lossless", 14, "--kg", 1), "excludes"),
                               (("--lossless", 14), "needs --profile high"),
                               (("--lossless", 14, "--profile", "high", "--gof-kind", "skinned"),
                                "only inter GOFs are lossless"),
                               (("--lossless", 14, "--profile", "high", "--components", 3),
                                "no effect")):
            self.fails(64, words, "rlpcenc", mesh, *options, "-o", out)

    def test_settings_that_contradict(self):
        for options, words in (
                (("--gof-kind", "inter"), "need --profile high"),
                (("--profile", "baseline", "--gof-kind", "skinned"), "need --profile main or high"),
                (("--profile", "high", "--gof-kind", "inter", "--bones", 3), "no effect"),
                (("--profile", "high", "--gof-kind", "skinned", "--frame-weights", "geometry"),
                 "need --profile high and --gof-kind inter"),
                (("--frame-weights", "plain"), "need --profile high and --gof-kind inter")):
            self.fails(64, words, "rlpcenc", INPUTS / "elephant.obj", *options, "-o",
                       self.path("a.rlpc"))


if __name__ == "__main__":
    main()
