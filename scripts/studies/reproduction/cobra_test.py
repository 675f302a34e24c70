#!/usr/bin/env python3
"""scripts/reproduce cobra: its sentences, and with --bin its measurements and a small run."""

import json
import subprocess
import unittest

from reproduction_testing import INPUTS, Reproduced, Tools, main, runs
import cobra_findings as findings


def rule(*tripled, kg=0.1, rates=()):
    return {"kg": kg, "tripled_kg": list(tripled),
            "rates": [{"kg": error, "entropy": bits} for error, bits in rates]}


class Steps(unittest.TestCase):
    def test_uniform(self):
        falls, late = findings.uniform_steps(rule(0.3, 0.2, *[0.15] * 7, 0.1, 0.1))
        self.assertEqual(falls, "Holds: with uniform steps, tripling one has less effect the "
                                "higher its vector (10 of 10; the first: error +200 %).")
        self.assertTrue(late.startswith("Holds") and "(2 of 2)" in late, late)
        falls, late = findings.uniform_steps(rule(*[0.1] * 10, 0.2))
        self.assertTrue(falls.startswith("Holds mostly"), falls)
        self.assertTrue(late.startswith("Does not hold"), late)

    def test_cobra(self):
        self.assertIn("Holds: ", findings.cobra_steps(rule(0.11, 0.112, 0.108)))
        self.assertIn("(2 of 3; error +1 % to +10 %)",
                      findings.cobra_steps(rule(0.11, 0.101, 0.108)))

    def test_eigenvalues(self):
        found = findings.eigenvalue_steps(rule(0.1, 0.1, 0.11, 0.15))
        self.assertTrue(all(text.startswith("Holds") for text in found), found)
        self.assertIn("vector 4 of 4: error +50 %", found[1])
        found = findings.eigenvalue_steps(rule(0.15, 0.11, 0.1, 0.1))
        self.assertTrue(all(text.startswith("Does not hold") for text in found), found)

    def test_fewer_bits(self):
        rates = [(1.0, 2.0), (0.1, 5.0)]
        double = [(kg, 2 * bits) for kg, bits in rates]
        found = findings.fewer_bits({"cobra": rule(rates=rates), "uniform": rule(rates=double),
                                     "eigenvalue": rule(rates=[(1.0, 1.0)])})
        self.assertIn("Holds: COBRA's steps take fewer bits than uniform ones, at equal error "
                      "(2 of 2; -50 % to -50 %", found[0])
        self.assertIn("Does not hold", found[1])


class Predictors(unittest.TestCase):
    def entropies(self, cobra, lpc):
        of = {"direct": (8.0, 9.0)}
        for order in findings.ORDERS:
            of[f"Cob{order}"] = (cobra[order - 1], 2.0)
            of[f"LPC{order}"] = (lpc[order - 1], 1.0 / order)
        return {10: of}

    def test_claims(self):
        for cobra, lpc, verdicts in (((4, 3, 2, 3), (5, 5, 5, 5), ["Holds"] * 5),
                                     ((2, 5, 5, 5), (3, 1, 1, 1),
                                      ["Does not hold"] * 3 + ["Holds"] * 2)):
            found = findings.predictors(self.entropies(cobra, lpc))
            self.assertEqual([text.split(":")[0] for text in found[:5]], verdicts)
        self.assertEqual(found[-1], "Prediction saves 88 to 88 % of the bits of the basis.")

    def test_least_squares(self):
        slope, offset = findings.least_squares([(0, 1), (1, 3), (2, 5)])
        self.assertAlmostEqual(slope, 2)
        self.assertAlmostEqual(offset, 1)


class Whole(unittest.TestCase):
    def test_gain(self):
        direct = runs((1, 4.0, 1.0), (1, 8.0, 0.1))
        for share, verdict in ((0.7, "Holds"), (0.8, "Does not hold")):
            cobra = runs((1, 4 * share, 1.0), (1, 8 * share, 0.1))
            found = findings.whole({"direct": direct, "uniform": direct, "cobra": cobra,
                                    "Main": direct, "High": direct}, 0.5)
            self.assertTrue(found[0].startswith(f"{verdict}: "), found[0])
            self.assertIn(f"saves up to {100 - 100 * share:.0f} %", found[2])

    def test_gain_over_a_basis_that_is_nearly_everything_is_no_test(self):
        direct, cobra = runs((1, 4.0, 1.0), (1, 8.0, 0.1)), runs((1, 1.0, 1.0), (1, 2.0, 0.1))
        curves = {"direct": direct, "cobra": cobra}
        self.assertEqual(
            findings.total_saved(curves, 0.87),
            "Not comparable: COBRA takes about 25 % fewer bits of everything than a basis of 64 "
            "bits per value (that basis takes 87 % of everything here, in the paper 50 % at most; "
            "here -75 % to -75 % bits).")
        self.assertTrue(findings.total_saved(curves, 0.5).startswith("Holds: "))


class Measured(Reproduced):
    def study(self, *options):
        done = subprocess.run([Tools.folder / "cobra_basis", INPUTS / "elephant.obj", "--points",
                               INPUTS / "elephant.pc2", *map(str, options)],
                              capture_output=True, text=True, check=True)
        return json.loads(done.stdout)

    def error_of_first(self, study, step):
        """Algorithm 1 with the predictor of linear motion."""
        frames, square = study["num_frames"], 0.0
        for c in range(3):
            decoded = []
            for value in study["basis"][0][c * frames:(c + 1) * frames]:
                start = 2 * decoded[-1] - decoded[-2] if len(decoded) > 1 else 0.0
                decoded.append(start + round((value - start) / step) * step)
                square += (decoded[-1] - value) ** 2
        return 100 * (square * study["energy"][0] / study["total_energy"]) ** 0.5

    def test_errors_are_those_of_the_algorithm(self):
        study = self.study("--tripled", 1, "--kg", 0.4, "--vectors", 1)
        for rule in study["rules"]:
            self.assertEqual(rule["predictor"], "Cob2")
            step, = rule["steps"]
            self.assertAlmostEqual(rule["kg"], self.error_of_first(study, step), 6)
            self.assertAlmostEqual(rule["tripled_kg"][0],
                                   self.error_of_first(study, 3 * step), 6)
            self.assertAlmostEqual(rule["kg"], 0.4, 1)

    def test_bad_input(self):
        done = subprocess.run([Tools.folder / "cobra_basis", "nowhere.obj"], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("cobra_basis: nowhere.obj", done.stderr)

    def test_an_animation_of_the_user(self):
        mesh, points, _ = self.short_arm(20)
        self.reproduce("cobra", "--quick", mesh, points)
        curves = self.rows("curves.csv")
        self.assertEqual({row["method"] for row in curves},
                         {"Coddyac, basis 64 bits", "Coddyac, basis uniform, not predicted",
                          "Coddyac, basis COBRA", "Main", "High"})
        rates = {(row["method"], row["kg_error_percent"]): float(row["bpvf"]) for row in curves}
        for (method, kg), rate in rates.items():
            if method == "Coddyac, basis COBRA":
                self.assertLess(rate, rates.get(("Coddyac, basis 64 bits", kg), 1e9))
        parts = (self.out / "parts.svg").read_text(encoding="utf-8")
        for name in ("64 bits", "uniform, not predicted", "COBRA"):  # on the axis, in words
            self.assertIn(f">{name}</text>", parts)
        self.assertNotIn(">1.5</text>", parts)
        steps = self.rows("steps.csv")
        self.assertEqual(len({row["uniform_step"] for row in steps}), 1)
        self.assertGreater(len({row["cobra_step"] for row in steps}), 1)
        self.expect_pages(["curves", "steps", "step_rates", "predictors", "parts", "basis", "pairs",
                           "sums"])


if __name__ == "__main__":
    main(__doc__)
