#!/usr/bin/env python3
"""The tools as people run them: every way in and out, and figures that agree.

    tools_test.py --bin BUILD/bin [unittest arguments, such as RoundTrip]

Only the bundled animations are used. Every output goes to a temporary folder.
"""

import math
import shutil

from tools_testing import (INPUTS, NAMES, ROOT, ToolsTest, main, read_obj, read_rlpd,
                           triangle_set, write_obj)


class RoundTrip(ToolsTest):
    SPANS = {"0-59": (0, 59), "20-29": (20, 29), "6-7": (6, 7), "59": (59, 59), "41-": (41, 59)}

    def test_every_input_form_gives_the_same_stream(self):
        triangles, frames = self.clip(12)
        self.path("walk").mkdir()
        for f, xyz in enumerate(frames):
            write_obj(self.path("walk") / f"frame{f}.obj", xyz, triangles)  # frame10 after frame2
        forms = {
            "cache": [self.path("clip.obj"), "--points", self.path("clip.pc2")],
            "folder": [self.path("walk")],
            "printf": [self.path("walk/frame%d.obj")],
            "glob": [self.path("walk/frame*.obj")],
        }
        streams = {}
        for form, arguments in forms.items():
            self.ok("rlpcenc", *arguments, "-o", self.path(f"{form}.rlpc"), "--kg", 0.5, "--quiet",
                    "--preset", "fast")
            streams[form] = self.path(f"{form}.rlpc").read_bytes()
        for form, stream in streams.items():
            self.assertEqual(stream, streams["cache"], form)

    def test_padded_numbers_may_start_anywhere(self):
        triangles, frames = self.clip(4)
        for f, xyz in enumerate(frames):
            write_obj(self.path(f"walk_{f + 98:04d}.obj"), xyz, triangles)
        for pattern in ("walk_%04d.obj", "walk_*.obj", "walk_[0-9]*.obj"):
            self.ok("rlpcenc", self.path(pattern), "-o", self.path("walk.rlpc"), "--kg", 0.5,
                    "--preset", "fast", "--keep-order")
            compared = self.ok("rlpccmp", self.path("clip.obj"), self.path("walk.rlpc"),
                               "--json").json()
            self.assertEqual(compared["num_frames"], 4)
            self.assertLessEqual(compared["metrics"]["kg_error_percent"], 0.5)

    def test_rlpd_as_input(self):
        self.encode(self.path("a.rlpc"), "--kg", 1, "--keep-order")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"))
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        self.ok("rlpcenc", self.path("a.rlpd"), "-o", self.path("from_rlpd.rlpc"), "--kg", 1,
                "--preset", "fast")
        self.ok("rlpcenc", self.path("a.obj"), "--points", self.path("a.pc2"), "-o",
                self.path("from_pc2.rlpc"), "--kg", 1, "--preset", "fast")
        self.assertEqual(self.path("from_rlpd.rlpc").read_bytes(),
                         self.path("from_pc2.rlpc").read_bytes())

    def test_every_output_form_holds_the_same_positions(self):
        self.encode(self.path("a.rlpc"), "--kg", 0.5, "--gof", 8)
        outputs = ("a.rlpd", "a.pc2", "folder", "out/frame_%04d.obj", "short/f%d.obj")
        for output in outputs:
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path(output))
        self.assertEqual(len(list(self.path("folder").iterdir())), 60)
        self.assertEqual(len(list(self.path("out").iterdir())), 60)
        self.assertTrue(self.path("out/frame_0059.obj").is_file())
        self.assertTrue(self.path("short/f9.obj").is_file())
        for output in outputs:
            exact = self.ok("rlpccmp", self.path("a.rlpc"), self.path(output), "--json",
                            "--max-error", 0).json()
            self.assertEqual(exact["metrics"]["max_error"], 0, output)
            self.assertEqual(exact["num_frames"], 60)

    def test_one_frame_is_one_obj(self):
        self.clip(1)
        self.ok("rlpcenc", self.path("clip.obj"), "-o", self.path("a.rlpc"), "--keep-order")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.obj"))
        self.ok("rlpccmp", self.path("a.rlpc"), self.path("a.obj"), "--max-error", 0)
        self.encode(self.path("many.rlpc"), "--kg", 1)
        self.fails(64, "a.obj", "rlpcdec", self.path("many.rlpc"), "-o", self.path("a.obj"))

    def test_keep_order_restores_the_vertex_order(self):
        for name in NAMES:
            self.encode(self.path("a.rlpc"), "--kg", 0.5, "--keep-order", name=name)
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
            original, triangles = read_obj(INPUTS / f"{name}.obj")
            decoded, decoded_triangles = read_obj(self.path("a.obj"))
            self.assertEqual(triangle_set(decoded_triangles), triangle_set(triangles))
            largest = self.ok("rlpccmp", INPUTS / f"{name}.obj", self.path("a.rlpc"),
                              "--json").json()["metrics"]["max_error"]
            for v in range(len(original) // 3):
                distance = math.dist(original[3 * v:3 * v + 3], decoded[3 * v:3 * v + 3])
                self.assertLessEqual(distance, largest * 1.000001)

    def test_order_map_names_the_input_vertex(self):
        report = self.encode(self.path("a.rlpc"), "--kg", 0.5, "--order-map", self.path("a.order"))
        order = [int(line) for line in self.path("a.order").read_text().split()]
        self.assertEqual(sorted(order), list(range(report["num_vertices"])))
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        original, triangles = read_obj(INPUTS / "elephant.obj")
        decoded, decoded_triangles = read_obj(self.path("a.obj"))
        self.assertEqual(triangle_set([tuple(order[v] for v in t) for t in decoded_triangles]),
                         triangle_set(triangles))
        for i, v in enumerate(order):
            distance = math.dist(original[3 * v:3 * v + 3], decoded[3 * i:3 * i + 3])
            self.assertLessEqual(distance, report["metrics"]["max_error"] * 1.000001)

    def test_frames_by_seeking_are_those_of_the_whole(self):
        for gof in (3, 7, "all"):  # an index, no index, nothing to seek
            stream = self.path("a.rlpc")
            self.encode(stream, "--kg", 0.5, "--gof", gof)
            self.ok("rlpcdec", stream, "-o", self.path("all.rlpd"))
            _, _, whole = read_rlpd(self.path("all.rlpd"))
            for text, (first, last) in self.SPANS.items():
                self.ok("rlpcdec", stream, "-o", self.path("some.rlpd"), "--frames", text)
                _, _, some = read_rlpd(self.path("some.rlpd"))
                self.assertEqual(some, whole[first:last + 1], f"--gof {gof} --frames {text}")
        self.ok("rlpcdec", stream, "-o", self.path("out/f%03d.obj"), "--frames", "40-42")
        self.assertEqual(sorted(p.name for p in self.path("out").iterdir()),
                         ["f040.obj", "f041.obj", "f042.obj"])
        for text in ("60", "5-60", "7-6", "a", "-3", "1-2-3", "1-2x"):
            self.fails(64, "--frames", "rlpcdec", stream, "-o", self.path("x.rlpd"),
                       f"--frames={text}")
        self.assertFalse(self.path("x.rlpd").exists())

    def test_frame_rate_goes_through(self):
        for text, rate in (("24000/1001", [24000, 1001]), ("29.97", [2997, 100]), ("25", [25, 1])):
            report = self.encode(self.path("a.rlpc"), "--kg", 1, "--fps", text)
            self.assertEqual(report["frame_rate"], rate)
            info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
            self.assertEqual(info["frame_rate"], rate)
            for output, again in (("a.rlpd", ["a.rlpd"]), ("out", ["out"]),
                                  ("a.pc2", ["a.obj", "--points", self.path("a.pc2")])):
                shutil.rmtree(self.path("out"), ignore_errors=True)
                self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path(output), "--frames", "0-5")
                report = self.ok("rlpcenc", self.path(again[0]), *again[1:], "-o",
                                 self.path("b.rlpc"), "--kg", 1, "--preset", "fast",
                                 "--json").json()
                self.assertEqual(report["frame_rate"], rate, output)

    def test_hashes_cost_bits_and_change_nothing(self):
        bits, decoded = {}, {}
        for mode in ("none", "gof", "frame"):
            report = self.encode(self.path("a.rlpc"), "--kg", 0.5, "--gof", 20, "--hash", mode)
            bits[mode] = report["bits"]
            parts = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()["bits"]
            self.assertEqual(parts["connectivity"], report["bits"]["connectivity"] - 8 * 9)
            self.assertEqual(parts["vertex order"], 0)
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"))
            decoded[mode] = self.path("a.rlpd").read_bytes()
        self.assertEqual(bits["none"]["hashes"], 0)
        self.assertLess(bits["gof"]["hashes"], bits["frame"]["hashes"])
        self.assertEqual(bits["none"]["gofs"], bits["frame"]["gofs"])
        self.assertEqual(decoded["none"], decoded["gof"])
        self.assertEqual(decoded["none"], decoded["frame"])

    def test_rlpcdec_reports_what_was_compared_with_hashes(self):
        def verified(*options):
            report = self.ok("rlpcdec", self.path("a.rlpc"), "--verify", "--json", *options).json()
            text = self.ok("rlpcdec", self.path("a.rlpc"), "--verify", *options).err
            return report["frames_compared"], report["hashes_verified"], text

        expected = {  # all frames; frames 5 to 24, which are parts of two GOFs of 20 frames
            "none": ((0, False, "without hashes"), (0, False, "not verified")),
            "gof": ((60, True, "hashes agree"), (0, False, "not verified")),
            "frame": ((60, True, "hashes agree"), (20, True, "hashes agree")),
        }
        for mode, (result_of_all, result_of_some) in expected.items():
            self.encode(self.path("a.rlpc"), "--kg", 0.5, "--gof", 20, "--hash", mode)
            for options, (compared, agree, words) in (((), result_of_all),
                                                      (("--frames", "5-24"), result_of_some)):
                found = verified(*options)
                self.assertEqual(found[:2], (compared, agree), mode)
                self.assertIn(words, found[2], mode)
        self.encode(self.path("a.rlpc"), "--kg", 0.5, "--gof", 20)
        self.assertIn("hashes of 20 of them agree", verified("--frames", "15-44")[2])
        self.fails(64, "--no-hashes", "rlpcdec", self.path("a.rlpc"), "--verify", "--no-hashes")

    def test_gofs_are_as_long_as_asked(self):
        for gof, count in ((1, 60), (7, 9), (60, 1), (1000, 1), ("all", 1)):
            report = self.encode(self.path("a.rlpc"), "--kg", 5, "--gof", gof)
            self.assertEqual(report["num_gofs"], count)
            self.assertEqual(self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()["num_gofs"],
                             count)

    def test_pipes(self):
        self.encode(self.path("a.rlpc"), "--kg", 1)
        piped = self.ok("rlpcenc", INPUTS / "elephant.obj", "--points", INPUTS / "elephant.pc2",
                        "-o", "-", "--kg", 1, "--preset", "fast")
        self.assertEqual(piped.out, self.path("a.rlpc").read_bytes())
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"))
        self.ok("rlpcdec", "-", "-o", self.path("b.rlpd"), input=piped.out)
        self.assertEqual(self.path("a.rlpd").read_bytes(), self.path("b.rlpd").read_bytes())

    def test_metadata_is_carried(self):
        self.path("m.json").write_text('{"title": "Walk", "take": 3}')
        report = self.encode(self.path("a.rlpc"), "--kg", 1, "--metadata", self.path("m.json"))
        self.assertGreater(report["bits"]["metadata"], 0)
        info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
        self.assertEqual(info["metadata"], {"title": "Walk", "take": 3})

    def test_nothing_is_left_beside_the_output(self):
        self.encode(self.path("a.rlpc"), "--kg", 1, "--order-map", self.path("a.order"))
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.pc2"))
        self.assertEqual(self.files(), ["a.obj", "a.order", "a.pc2", "a.rlpc"])


class Figures(ToolsTest):
    def test_rlpccmp_prints_the_figures_of_rlpcenc(self):
        for name in NAMES:
            for options in (["--kg", 0.3], ["--bpvf", 2, "--gof", 20]):
                report = self.encode(self.path("a.rlpc"), *options, "--order-map",
                                     self.path("a.order"), name=name)
                self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("a.rlpd"))
                for decoded in (["a.rlpc"], ["a.rlpd", "--stream", self.path("a.rlpc")]):
                    compared = self.ok("rlpccmp", INPUTS / f"{name}.obj", "--points-a",
                                       INPUTS / f"{name}.pc2", self.path(decoded[0]),
                                       *decoded[1:], "--order-map", self.path("a.order"),
                                       "--json").json()
                    self.expect_same_metrics(report, compared)
                    for key in ("bytes", "bpvf", "num_vertices", "num_frames"):
                        self.assertEqual(compared[key], report[key],
                                         f"{name} {options} {decoded} {key}")

    def test_with_kept_order_no_map_is_needed(self):
        report = self.encode(self.path("a.rlpc"), "--kg", 0.5, "--keep-order")
        compared = self.ok("rlpccmp", INPUTS / "elephant.obj", self.path("a.rlpc"), "--json").json()
        self.expect_same_metrics(report, compared)
        self.assertGreater(report["metrics"]["vertex_normal_rms_degrees"], 0.1)
        self.assertIn("elephant.pc2", compared["a"])

    def test_bytes_and_bits_add_up(self):
        for options in ([], ["--keep-order", "--hash", "frame", "--gof", 3]):
            report = self.encode(self.path("a.rlpc"), "--kg", 1, *options)
            size = self.path("a.rlpc").stat().st_size
            self.assertEqual(report["bytes"], size)
            self.assertEqual(report["bpvf"],
                             8 * size / (report["num_vertices"] * report["num_frames"]))
            self.assertEqual(sum(report["bits"].values()), 8 * size)
            info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
            self.assertEqual(info["bytes"], size)
            self.assertEqual(info["bpvf"], report["bpvf"])
            self.assertEqual(sum(info["bits"].values()), 8 * size)

    def test_rlpcinfo_lists_gofs_and_slices(self):
        stream = self.path("a.rlpc")
        self.encode(stream, "--kg", 0.5, "--gof", 20, "--profile", "main")
        data, at, sizes = stream.read_bytes(), 10, []
        while at < len(data):
            size = 9 + int.from_bytes(data[at + 1:at + 5], "big")
            if data[at] in (4, 6):  # GOF, slice
                sizes.append(size)
            at += size
        info = self.ok("rlpcinfo", stream, "--json").json()
        self.assertEqual(info["profile_idc"], 1)
        self.assertEqual([(g["first_frame"], g["num_frames"]) for g in info["gofs"]],
                         [(0, 20), (20, 20), (40, 20)])
        self.assertEqual([n["bytes"] for g in info["gofs"] for n in (g, *g["slices"])], sizes)
        for part in ("bones", "rest positions", "spatial factors"):
            self.assertGreater(info["bits"][part], 0, part)
        said = self.ok("rlpcinfo", stream, "--gofs").out.decode()
        for words in ("Main profile", "skinned GOFs: 3, with ", "frames 20 to 39",
                      "influences, rest positions", f" {info['gofs'][0]['slices'][0]['bytes']} "):
            self.assertIn(words, said)
        self.assertNotIn("frames 20 to 39", self.ok("rlpcinfo", stream).out.decode())
        self.encode(stream, "--kg", 5, "--profile", "baseline")
        gofs = self.ok("rlpcinfo", stream, "--json").json()["gofs"]
        self.assertEqual([(g["first_frame"], g["num_frames"]) for g in gofs], [(0, 60)])
        said = self.ok("rlpcinfo", stream, "--gofs").out.decode()
        for words in ("Baseline profile", "cluster GOFs: 1, with ", "frames 0 to 59: "
                      f"{gofs[0]['num_clusters']} clusters and {gofs[0]['num_components']} comp"):
            self.assertIn(words, said)

    def test_rlpcinfo_reports_both_kinds_of_gofs(self):
        stream = ROOT / "streams/v1.1/accept/MIX/MIX-0201a.rlpc"
        info = self.ok("rlpcinfo", stream, "--json").json()
        self.assertEqual([g.get("num_clusters") for g in info["gofs"]], [3, None, 2])
        self.assertEqual([g.get("num_components") for g in info["gofs"]], [4, None, 3])
        self.assertEqual([g.get("num_bones") for g in info["gofs"]], [None, 2, None])
        self.assertEqual([len(g.get("slices", [])) for g in info["gofs"]], [0, 6, 0])
        for part in ("bones", "clusters", "seed tracks", "rest positions"):
            self.assertGreater(info["bits"][part], 0, part)
        self.assertEqual(sum(info["bits"].values()), 8 * stream.stat().st_size)
        said = self.ok("rlpcinfo", stream, "--gofs").out.decode()
        for words in ("cluster GOFs: 2, with 2 to 3 clusters and 3 to 4 components",
                      "skinned GOFs: 1, with 2 bones", "frames 4 to 8: 2 bones",
                      "frames 9 to 11: 2 clusters and 3 components"):
            self.assertIn(words, said)

    def test_cloth_of_high_rank_gets_clusters(self):
        stream, sizes = self.path("a.rlpc"), []
        for options, part in (((), "clusters"), (("--prediction", "layers"), "bones")):
            self.ok("rlpcenc", INPUTS / "curtain.obj", "--points", INPUTS / "curtain.pc2", "-o",
                    stream, "--kg", 0.05, *options)
            self.ok("rlpcdec", stream, "--verify")
            self.assertIn(f"num_{part}", self.ok("rlpcinfo", stream, "--json").json()["gofs"][0])
            sizes.append(stream.stat().st_size)
        self.assertLess(sizes[0], sizes[1])

    def test_the_csv_has_every_frame(self):
        report = self.encode(self.path("a.rlpc"), "--kg", 0.5, "--keep-order")
        self.ok("rlpccmp", INPUTS / "elephant.obj", self.path("a.rlpc"), "--csv",
                self.path("a.csv"))
        head, *rows = [line.split(",") for line in self.path("a.csv").read_text().splitlines()]
        self.assertEqual(head[0], "frame")
        self.assertEqual([int(row[0]) for row in rows], list(range(60)))
        metrics = report["metrics"]
        errors = [float(row[head.index("max_error")]) for row in rows]
        self.assertEqual(max(errors), metrics["max_error"])
        self.assertEqual(errors.index(max(errors)), metrics["max_error_frame"])
        rms = [float(row[head.index("rms_error")]) for row in rows]
        self.assertAlmostEqual(math.sqrt(sum(r * r for r in rms) / 60), metrics["rms_error"],
                               delta=1e-12)
        psnr = [float(row[head.index("ramanathan_psnr_db")]) for row in rows]
        self.assertAlmostEqual(sum(psnr) / 60, metrics["ramanathan_psnr_db"], delta=1e-9)
        surface = self.ok("rlpccmp", INPUTS / "elephant.obj", self.path("a.rlpc"),
                          "--json").json()["surface"]
        column = {name: [float(row[i]) for row in rows] for i, name in enumerate(head)}
        for name, steps, weight in (("sted", 59, surface["sted_c"]),
                                    ("ring_edge_difference", 58, 1)):
            spatial = sum(column[f"{name}_spatial"]) / 60
            temporal = sum(column[f"{name}_temporal"]) / steps
            self.assertGreater(min(spatial, temporal), 0)
            self.assertAlmostEqual(surface[name], math.hypot(spatial, weight * temporal),
                                   delta=1e-12)
        angles = column["max_normal_angle_degrees"]
        self.assertEqual(surface["max_normal_angle_degrees"], max(angles))
        self.assertEqual(surface["max_normal_angle_frame"], angles.index(max(angles)))

    def test_sted_and_normals_grow_with_the_error(self):
        found = []
        for kg in (0.1, 0.3, 1):
            self.encode(self.path("a.rlpc"), "--kg", kg, "--keep-order")
            surface = self.ok("rlpccmp", INPUTS / "elephant.obj", self.path("a.rlpc"),
                              "--json").json()["surface"]
            found.append([surface[name] for name in (
                "sted_spatial", "sted_temporal", "sted", "ring_edge_difference",
                "mean_normal_angle_degrees", "vertex_normal_rms_degrees",
                "normal_flicker_rms_degrees")])
        for finer, coarser in zip(found, found[1:]):
            for a, b in zip(finer, coarser):
                self.assertLess(a, b, found)
        same = self.ok("rlpccmp", self.path("a.rlpc"), self.path("a.rlpc"), "--json").json()
        self.assertEqual((same["surface"]["sted"], same["surface"]["max_normal_angle_degrees"]),
                         (0, 0))

    def test_gates_decide_the_exit_code(self):
        report = self.encode(self.path("a.rlpc"), "--kg", 0.5, "--keep-order")
        arguments = (INPUTS / "elephant.obj", self.path("a.rlpc"), "-q")
        kg, largest = report["metrics"]["kg_error_percent"], report["metrics"]["max_error"]
        self.ok("rlpccmp", *arguments, "--max-kg", repr(kg), "--max-error", repr(largest))
        self.fails(1, "KG error", "rlpccmp", *arguments, "--max-kg", repr(kg * 0.999))
        self.fails(1, "largest error", "rlpccmp", *arguments, "--max-error", repr(largest * 0.999))
        for word in ("nan", "-1", "much"):
            self.fails(64, ["--max-kg", word], "rlpccmp", *arguments, "--max-kg", word)

    def test_what_cannot_be_compared_is_an_error(self):
        self.encode(self.path("a.rlpc"), "--kg", 1, "--order-map", self.path("a.order"))
        elephant = (INPUTS / "elephant.obj", self.path("a.rlpc"))
        self.fails(2, ["--order-map", "--keep-order"], "rlpccmp", *elephant)
        self.fails(2, ["538 vertices", "400"], "rlpccmp", INPUTS / "elephant.obj",
                   INPUTS / "curtain.obj")
        self.clip(7)
        self.fails(2, ["7 frames", "60"], "rlpccmp", self.path("clip.pc2"), self.path("a.rlpc"))
        order = self.path("a.order").read_text().split()
        for lines, words in ((order[:-1], "537 lines"), (order[1:] + ["538"], "line 538"),
                             (order[1:] + order[1:2], "second time"), (["x"] + order[1:], "line 1"),
                             (sorted(order, key=int), "order"), ([], "0 lines")):
            self.path("bad.order").write_text("\n".join(lines) + ("\n" if lines else ""))
            self.fails(2, ["bad.order", words], "rlpccmp", *elephant, "--order-map",
                       self.path("bad.order"))
        self.fails(2, "none.order", "rlpccmp", *elephant, "--order-map", self.path("none.order"))
        self.fails(2, "none.obj", "rlpccmp", self.path("none.obj"), self.path("a.rlpc"))
        self.fails(2, "none.rlpc", "rlpccmp", INPUTS / "elephant.obj", self.path("none.rlpc"))
        self.fails(64, "", "rlpccmp", INPUTS / "elephant.obj")


if __name__ == "__main__":
    main()
