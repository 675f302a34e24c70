#!/usr/bin/env python3
"""scripts/mutate: the page of mutants, in parts.

    mutate_test.py [unittest arguments]
"""

import importlib.machinery
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
MUTATE = importlib.machinery.SourceFileLoader(
    "mutate", str(ROOT / "scripts" / "mutate")).load_module()


class Page(unittest.TestCase):
    """Rows of some mutants take their place among those of the others."""

    def setUp(self):
        self._kept = MUTATE.PAGE, MUTATE.mutants.read
        self._folder = tempfile.TemporaryDirectory(prefix="rlpc-mutate-")
        MUTATE.PAGE = pathlib.Path(self._folder.name) / "mutants.md"
        names = ("first", "equal", "second", "new")
        self.mutants = [MUTATE.mutants.Mutant(name, f"what {name} is", "a.cpp", "a", "b",
                                              "the same" if name == "equal" else "", 1)
                        for name in names]
        MUTATE.mutants.read = lambda: self.mutants

    def tearDown(self):
        MUTATE.PAGE, MUTATE.mutants.read = self._kept
        self._folder.cleanup()

    def written(self, *endings):
        rows = [(m, *ending) for m, ending in zip(self.mutants, endings) if ending]
        rows = MUTATE.with_those_of_page(rows)
        MUTATE.PAGE.write_text(MUTATE.page(rows, MUTATE.summary(rows, [1, 2])), encoding="utf-8")
        return MUTATE.PAGE.read_text(encoding="utf-8")

    def test_rows_of_others_stay(self):
        self.written(("killed", "A-0001a"), ("survived", ""), ("survived", ""))
        text = self.written(None, None, ("diagnosed", "B-0001a"), ("killed", "C-0001a"))
        self.assertIn("3 of 3 mutants detected, 1 of them only by the rule that is reported; "
                      "1 equivalent; 2 streams.", text)
        self.assertTrue(text.endswith("| first | what first is | killed | A-0001a |\n"
                                      "| equal | what equal is | the same |  |\n"
                                      "| second | what second is | diagnosed | B-0001a |\n"
                                      "| new | what new is | killed | C-0001a |\n"), text)

    def test_a_mutant_that_was_never_tried_has_no_row(self):
        self.assertNotIn("| new |", self.written(("killed", "A-0001a")))


if __name__ == "__main__":
    unittest.main()
