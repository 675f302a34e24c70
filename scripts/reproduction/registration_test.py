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
        rows = [{"frame": str(f), "psnr_db": db} for f, db in enumerate(("40", "41.5", "inf"))]
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
                                "x_psnr_db"])
        self.assertEqual(rows[1], [1, 6, 3, 1, 12, 41.5])
        self.assertEqual(rows[4], [4, "", "", "", 60, ""])


class Findings(unittest.TestCase):
    def test_the_better_clustering_counts(self):
        for best, words in ((1.042, "Holds"), (1.02, "Does not hold")):
            found = findings.clustering_alone([("Lloyd", best), ("spectral", 0.9)])
            self.assertTrue(found.startswith(f"{words}: clustering alone brings about 4 %"), found)
            self.assertIn(f"Lloyd: {100 * best - 100:+.1f} %, spectral: -10.0 %", found)
        self.assertTrue(findings.clustering_alone([("Lloyd", None)]).startswith("Not tested"))

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
        self.assertEqual(table["no patches"]["type 1"], "-")
        found = self.rows("frames.csv")
        self.assertEqual([int(row["frame"]) for row in found], list(range(len(numbers))))
        for row in found[1:]:
            self.assertEqual(sum(int(row[f"k-way_type_{i}"]) for i in (1, 2, 3)), num_vertices)
        clusters = {row["clustering"]: int(row["clusters"]) for row in self.rows("clusters.csv")}
        self.assertEqual(clusters["k-way"], 4)
        self.assertEqual(clusters["spectral"], 2)
        self.expect_pages(["curves", "frames", "types", "quality", "partitions"])


if __name__ == "__main__":
    main(__doc__)
