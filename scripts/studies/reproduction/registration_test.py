#!/usr/bin/env python3
"""scripts/reproduce registration: its numbers and sentences, and with --bin a small run."""

import unittest

from reproduction_testing import Reproduced, main, runs
import registration_findings as findings
import registration_frames as frames
import registration_published as published


class Published(unittest.TestCase):
    def test_gains_are_those_of_the_paper(self):
        for model, gains in ((published.COW, {"Lloyd": 4.2, "spectral": 3.5}),
                             (published.DANCE, {"Lloyd": 1.2, "spectral": 10.6})):
            table = published.TABLE_5[model]
            for name, gain in gains.items():
                self.assertAlmostEqual(100 * (table[name].ratio / table["k-way"].ratio - 1), gain,
                                       delta=0.06)

    def test_types_do_not_exceed_the_vertices(self):
        for model, table in published.TABLE_5.items():
            for row in table.values():
                self.assertLess(row.type1 + row.type2, model.num_vertices)

    def test_published_tables(self):
        for rows in published.TABLE_2.values():
            for row in rows.values():
                self.assertLessEqual(row.type1 + row.type2, 3029)
        # Numbers of its text: 3.8 % of table 3, 9.7, 15 and 7.8 % of table 4.
        self.assertAlmostEqual(46.7 / 45.3, 1.031, 3)
        gains = [rows["spectral"][1] / rows["k-way"][1] for rows in published.TABLE_4.values()]
        for gain, stated in zip(gains, (9.7, 15, 7.8)):
            self.assertAlmostEqual(100 * gain - 100, stated, delta=0.3)
        self.assertEqual(sum(kg is not None for _, kg in published.TABLE_3.values()), 6)

    def test_clusters(self):
        self.assertEqual(published.clusters_of(published.COW, 2904),
                         {"k-way": 32, "Lloyd": 30, "spectral": 14})
        self.assertEqual(published.clusters_of(None, 1000),
                         {"k-way": 10, "Lloyd": 8, "spectral": 5})
        self.assertEqual(published.clusters_of(None, 3), {"k-way": 2, "Lloyd": 2, "spectral": 2})


class Frames(unittest.TestCase):
    """Two GOFs of three and two frames of ten vertices; the last frame repeats another."""
    NONE = {"from_neighbours": 0, "motion_with_residuals": 0, "motion_without_residuals": 0}
    FIRST = {**NONE, "from_neighbours": 10}

    def setUp(self):
        def units(*sizes):
            return [{"frame_idx": i, "bytes": size} for i, size in enumerate(sizes)]
        moved = [{"from_neighbours": 1, "motion_with_residuals": 3, "motion_without_residuals": 6},
                 {"from_neighbours": 3, "motion_with_residuals": 7, "motion_without_residuals": 0}]
        gofs = [{"first_frame": 0, "num_patches": 3, "vertices_of_frame": [self.FIRST, *moved],
                 "slices": [*units(40, 10, 8), {"frame_idx": 2, "bytes": 4}]},
                {"first_frame": 3, "num_patches": 2, "vertices_of_frame": [self.FIRST, self.NONE],
                 "slices": units(60, 2)}]
        rows = [{"frame": str(f), "ramanathan_psnr_db": db}
                for f, db in enumerate(("40", "41.5", "inf"))]
        self.detail = frames.Detail({"num_vertices": 10, "gofs": gofs}, rows, "")

    def test_types_are_of_frames_with_motions(self):
        self.assertEqual(self.detail.types(0), [(1, 6), (2, 0)])
        self.assertEqual(self.detail.types(2), [(1, 1), (2, 3)])
        self.assertEqual(self.detail.means, [3, 5, 2])
        self.assertAlmostEqual(self.detail.moved, 0.8)
        self.assertEqual(self.detail.num_patches, 3)

    def test_ratios_count_all_units_of_a_frame(self):
        self.assertEqual(self.detail.ratios(), [(0, 3), (1, 12), (2, 10), (3, 2), (4, 60)])

    def test_exact_frames_have_no_psnr(self):
        self.assertEqual(self.detail.psnr(), [(0, 40), (1, 41.5)])

    def test_rows_of_all_frames(self):
        head, rows = frames.csv_rows({"x": self.detail})
        self.assertEqual(head, ["frame", "x_type_1", "x_type_2", "x_type_3", "x_ratio",
                                "x_ramanathan_psnr_db"])
        self.assertEqual(rows[1], [1, 6, 3, 1, 12, 41.5])
        self.assertEqual(rows[4], [4, "", "", "", 60, ""])

    def test_frames_are_divided_by_their_motion(self):
        motion, ratios = [0.0, 1.0, 5.0, 2.0, 9.0], [(0, 99), (1, 10), (2, 20), (3, 14), (4, 30)]
        self.assertEqual(frames.by_motion(motion, ratios), (12, 25))
        self.assertEqual(frames.by_motion([0, 1, 1], [(0, 9), (1, 2), (2, 4)]), (None, 3))


class Findings(unittest.TestCase):
    def test_each_clustering_counts(self):
        for gain, words in ((1.042, "Holds"), (1.02, "Does not hold")):
            lloyd, spectral = findings.clustering_alone([("Lloyd", gain), ("spectral", 0.9)])
            self.assertTrue(lloyd.startswith(f"{words}: Lloyd clustering alone brings about 4 %"),
                            lloyd)
            self.assertIn(f"{100 * gain - 100:+.1f} %", lloyd)
            self.assertTrue(spectral.startswith("Does not hold: spectral clustering alone"),
                            spectral)
        self.assertTrue(findings.clustering_alone([("Lloyd", None)])[0].startswith("Not tested"))

    def test_sizes_of_clusters(self):
        swept = {"k-way": [(50, 8, 30.0), (100, 4, 40.0), (125, 3, 40.3), (200, 2, 20.0)],
                 "Lloyd": [(50, 8, 30.0), (100, 4, 40.0), (125, 3, 39.0), (200, 2, None)]}
        kway, lloyd = findings.best_sizes(swept)
        self.assertEqual(kway,
                         "Holds: clusters of 100 vertices are optimal for k-way, within 1 % of "
                         "the best size (1 of 1; best with 125; with 100: -0.7 %).")
        self.assertTrue(lloyd.startswith("Does not hold: clusters of 125 vertices"), lloyd)
        self.assertIn("Not tested", findings.best_sizes({"Lloyd": [(125, 3, None)]})[0])

    def test_motion(self):
        found = {"k-way": (50.0, 30.0), "Lloyd": (50.5, 33.0), "spectral": (60.0, 31.0)}
        fast, calm = findings.at_motion(found)
        self.assertTrue(fast.startswith("Holds: where motion is large") and "(2 of 2; over k-way: "
                        "+10.0 %, over spectral: +6.5 %)" in fast, fast)
        self.assertTrue(calm.startswith("Holds") and "+1.0 %" in calm, calm)
        found["Lloyd"] = (54.0, 30.5)
        fast, calm = findings.at_motion(found)
        self.assertTrue(fast.startswith("Does not hold") and "1 of 2" in fast, fast)
        self.assertTrue(calm.startswith("Does not hold"), calm)
        self.assertTrue(all(text.startswith("Not tested") for text in findings.at_motion(
            dict.fromkeys(found, (None, None)))))

    def test_shares_of_the_paper_itself(self):
        self.assertEqual(findings.published_gains(published.COW),
                         "In table 5 itself, for the cow: gains over k-way, Lloyd: +4.2 %, "
                         "spectral: +3.5 %; vertices of types 1 and 2, k-way: 60 %, Lloyd: 67 %, "
                         "spectral: 66 %; 3 of 3 not over 70 %.")
        self.assertIsNone(findings.published_gains(None))

    def test_pairs_in_the_same_order(self):
        self.assertEqual(findings.go_together("x", [("a", 1, 2.0), ("b", 2, 3.0), ("c", 3, 2.5)]),
                         "Holds mostly: x (2 of 3; a: 1 and 2.0, b: 2 and 3.0, c: 3 and 2.5).")
        self.assertIn("Not tested: x", findings.go_together("x", [("a", 1, None), ("b", 2, 3.0)]))

    def test_rows_of_table_6(self):
        table = {"A": ((2.0, 1.0), (9.0, 9.0)), "B": ((1.0, 2.0),)}
        ours = runs((1, 1.0, 1.0), (1, 1.5, 0.5), (1, 2.0, 2.0))
        self.assertEqual(findings.below_published("X", ours, table),
                         "Does not hold: X takes fewer bits than published, in the rows of table "
                         "6, at equal error (1 of 2; A, 1 %: -50 % bits, B, 2 %: +0 % bits).")


class SmallRun(Reproduced):
    def test_an_animation_of_the_user(self):
        mesh, points, numbers = self.short_arm(13)
        num_vertices = len(numbers[0]) // 3
        self.reproduce("registration", "--quick", mesh, points)
        table = {row["clustering"]: row for row in self.rows("table.csv")}
        self.assertLessEqual({"k-way", "Lloyd", "spectral", "motion", "no patches", "learned",
                              "learned, motion", "Main", "High"}, set(table))
        for name in ("k-way", "Lloyd", "spectral", "motion"):
            types = [float(table[name][f"type {i}"]) for i in (1, 2, 3)]
            self.assertAlmostEqual(sum(types), num_vertices, delta=0.2)
            self.assertAlmostEqual(float(table[name]["PSNR, dB"]), published.PSNR, delta=1)
            self.assertLess(float(table[name]["KG, %"]), float(table[name]["KG of frames, %"]))
        self.assertEqual(table["no patches"]["type 1"], "-")
        found = self.rows("frames.csv")
        self.assertEqual([int(row["frame"]) for row in found], list(range(len(numbers))))
        for row in found[1:]:
            self.assertEqual(sum(int(row[f"k-way_type_{i}"]) for i in (1, 2, 3)), num_vertices)
        clusters = {row["clustering"]: int(row["clusters"]) for row in self.rows("clusters.csv")}
        self.assertEqual(clusters["k-way"], 4)
        self.assertEqual(clusters["spectral"], 2)
        self.assertEqual([row["vertices per cluster"] for row in self.rows("sizes.csv")],
                         ["50", "100", "125", "200"])
        self.assertTrue(any(row["k-way"] != "-" for row in self.rows("sizes.csv")))
        for row in self.rows("motion.csv"):
            self.assertGreater(float(row["little motion"]), 0)
            self.assertGreater(float(row["much motion"]), 0)
        self.assertEqual([len(self.rows(f"{name}.csv")) for name in (
            "ranges", "algorithms", "thresholds")], [9, 10, 9])
        self.assertEqual({row["CR"] for row in self.rows("ranges.csv")}, {"-"})  # no chicken
        self.expect_pages(["curves", "frames", "types", "quality", "partitions"])


if __name__ == "__main__":
    main(__doc__)
