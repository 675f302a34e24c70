#!/usr/bin/env python3
"""Claims that the reproductions of all papers test."""

import unittest

from reproduction_testing import main, runs
import claims


class Claims(unittest.TestCase):
    WORSE = ((2, 1.0, 2.0), (4, 2.0, 1.0), (8, 4.0, 0.5))

    def setUp(self):
        self.worse = runs(*self.WORSE)
        self.half = runs(*((n, bpvf / 2, kg) for n, bpvf, kg in self.WORSE))

    def test_verdicts(self):
        self.assertEqual([claims.verdict(good, 4) for good in (4, 3, 2, 0)],
                         ["Holds", "Holds mostly", "Does not hold", "Does not hold"])
        self.assertEqual(claims.verdict(0, 0), "Not tested")

    def test_equal_rate(self):
        self.assertEqual(claims.equal_rate("x", [("N", self.half, self.worse)]),
                         "Holds: x (1 of 1; N: -50 % bits at equal error).")
        self.assertEqual(claims.equal_rate("x", [("N", self.worse, self.half),
                                                 ("M", self.half, self.worse)]),
                         "Does not hold: x (1 of 2; N: +100 % bits at equal error, "
                         "M: -50 % bits at equal error).")
        apart = runs((2, 1.0, 20.0), (4, 2.0, 10.0))
        self.assertIn("Not tested", claims.equal_rate("x", [("N", apart, self.worse)]))

    def test_every_error(self):
        self.assertEqual(claims.every_error("x", self.half, self.worse),
                         "Holds: x (3 of 3; -50.0 % to -50.0 % bits at equal error).")
        self.assertEqual(claims.every_error("x", self.worse, self.half),
                         "Does not hold: x (0 of 3; +100.0 % to +100.0 % bits at equal error).")
        slightly = runs(*((n, 1.005 * bpvf, kg) for n, bpvf, kg in self.WORSE))
        self.assertIn("Does not hold", claims.every_error("x", slightly, self.worse))
        self.assertIn("Holds", claims.every_error("x", slightly, self.worse, claims.NEGLIGIBLE))
        apart = runs((2, 1.0, 20.0), (4, 2.0, 10.0))
        self.assertIn("Not tested", claims.every_error("x", apart, self.worse))

    def test_ends_of_curves(self):
        self.assertAlmostEqual(claims.rate_at(self.worse, 2 ** 0.5), 2 ** 0.5)
        self.assertEqual([claims.rate_at(self.worse, kg) for kg in (2.05, 0.49, 2.2, 0.45)],
                         [1.0, 4.0, None, None])

    def test_at_published_errors(self):
        self.assertEqual(claims.at_published_errors("x", self.worse,
                                                    [(1.0, 4.0), (2.0, 0.5), (0.1, 1.0)]),
                         "Does not hold: x (1 of 2; KG 1 %: -50 % bits, KG 2 %: +100 % bits).")


if __name__ == "__main__":
    main(__doc__)
