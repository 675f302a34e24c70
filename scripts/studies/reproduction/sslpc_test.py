#!/usr/bin/env python3
"""scripts/reproduce sslpc: its numbers and sentences, and with --bin a small run."""

import unittest

from reproduction_testing import Reproduced, main, runs
import models
import sslpc_findings as findings
import sslpc_published as published
import temporal_cuts


class Published(unittest.TestCase):
    def test_layers_are_those_of_the_paper(self):
        for mesh in (published.CHICKEN, published.COW):
            self.assertEqual(sum(mesh.layers), mesh.model.num_vertices)
        self.assertEqual([round(100 * g, 1) for g in published.COW.growth[1:]],
                         [37.9, 35.5, 38.2, 36.2, 39.3])
        self.assertEqual([round(100 * g, 1) for g in published.CHICKEN.growth[1:]],
                         [32.4, 39.4, 37.6, 37.0, 39.9, 38.7, 41.0])

    def test_errors_are_those_of_each_sequence(self):
        self.assertAlmostEqual(published.COW.large, 0.6)
        self.assertEqual((published.CHICKEN.lossless, published.CHICKEN.large), (0.02, 0.08))
        self.assertIs(published.decomposition_of(models.CHICKEN), published.CHICKEN)
        self.assertIs(published.decomposition_of(None), published.COW)

    def test_points_of_cpca_are_of_the_same_sequence(self):
        self.assertEqual(published.cpca(models.CHICKEN), ((4.7, 0.076), (2.8, 0.139)))
        self.assertEqual(published.cpca(models.COW), ((7.4, 0.16), (3.8, 0.5), (2.0, 1.47)))
        for other in (None, models.DOLPHIN, models.FACE):
            self.assertEqual(published.cpca(other), ())


class Findings(unittest.TestCase):
    COARSE, FINE = (1, 1.0, 1.0), (1, 4.0, 0.1)

    def test_growth(self):
        self.assertEqual(findings.layer_growth([100, 38, 52, 190], 3),
                         "Holds mostly: each layer adds about 38 % of vertices, here within 6 "
                         "points, the finest 3 (2 of 3; 38.0 %, 37.7 %, 100.0 %).")

    def test_layers_of_the_cow(self):
        self.assertEqual(findings.against_published([5, 9, 1, 2, 3, 4, 6], published.COW.layers),
                         "Vertices of the finest layers, ours and published: 1 and 225, 2 and 290, "
                         "3 and 423, 4 and 554, 6 and 819; ours go on to a base of 5 in 7 layers, "
                         "that of the paper has 593.")

    def test_large_errors(self):
        flat = runs(self.COARSE, self.FINE)
        for rate, words in ((0.8, "Holds"), (0.85, "Does not hold")):
            found = findings.large_errors("X", 16, runs((1, rate, 1.0), (1, 1.0, 0.1)), flat,
                                          0.6)
            self.assertIn(f"{words}: at KG errors above 0.6 %, X takes over 16 % fewer bits", found)
            self.assertIn(f"1 of 1; KG 1 %: {100 * rate - 100:.0f} %" if words == "Holds" else
                          "0 of 1", found)

    def test_growing_gain(self):
        worse = runs(self.COARSE, self.FINE)
        for coarse, fine, words in ((0.5, 3.6, "Holds: x (1 of 1; KG 0.1 %: -10 %, KG 1 %: -50 %"),
                                    (0.9, 2.0, "Does not hold: x (0 of 1")):
            better = runs((1, coarse, 1.0), (1, fine, 0.1))
            self.assertIn(words, findings.grows("x", better, worse))


class TemporalLayers(unittest.TestCase):
    def test_depths_are_those_of_the_specification(self):
        self.assertEqual(temporal_cuts.depths(12, 8), [0, 3, 2, 3, 1, 3, 2, 3, 0, 1, 2, 0])

    def test_frames_that_are_left(self):
        few, half, every = temporal_cuts.frames_of(17, 3)
        self.assertEqual(few, [0, 4, 8, 12, 16])
        self.assertEqual(half, list(range(0, 17, 2)))
        self.assertEqual(every, list(range(17)))


class SmallRun(Reproduced):
    def test_an_animation_of_the_user(self):
        mesh, points, frames = self.short_arm(17)
        self.reproduce("sslpc", "--quick", mesh, points)
        curves = self.rows("curves.csv")
        methods = {row["method"] for row in curves}
        self.assertLessEqual({"SSLPC", "STSLPC", "SSLPC, learned", "STSLPC, learned",
                              "Lorenzo + xz", "Main", "High"}, methods)
        self.assertEqual(len([m for m in methods if "layers" in m]), 4)
        self.assertTrue(all(float(row["bpvf"]) > 0 for row in curves))
        layers = self.rows("layers.csv")
        ours = [int(row["ours, my arm"]) for row in layers if row["ours, my arm"]]
        self.assertEqual(ours[-1], len(frames[0]) // 3)
        self.assertEqual(ours[-1], sum(ours[:-1]))
        cuts = self.rows("cuts.csv")
        self.assertEqual(int(cuts[-1]["vertices"]), ours[-1])
        self.assertEqual(cuts[-1]["of all frame bytes"], "100.0 %")
        temporal = self.rows("temporal.csv")
        self.assertEqual([row["layers"] for row in temporal], ["all 3", "1", "2"])
        self.assertEqual([row["frames"] for row in temporal], ["17", "5", "9"])
        self.assertTrue(all(0.5 < float(row["ratio"]) < 2 for row in temporal))
        self.expect_pages(["curves"])


if __name__ == "__main__":
    main(__doc__)
