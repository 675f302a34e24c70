#!/usr/bin/env python3
"""scripts/mutate: the lists and the pages of mutants, in parts.

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
TESTS = MUTATE.encoder_tests


class Page(unittest.TestCase):
    """Rows of some mutants take their place among those of the others."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="rlpc-mutate-")
        names = ("first", "equal", "second", "new")
        self.mutants = [MUTATE.mutants.Mutant(name, f"what {name} is", "a.cpp", "a", "b",
                                              "the same" if name == "equal" else "", 1)
                        for name in names]
        self.side = MUTATE.dataclasses.replace(
            MUTATE.DECODER, page=pathlib.Path(self._folder.name) / "mutants.md")
        self.side.read = lambda: self.mutants

    def tearDown(self):
        self._folder.cleanup()

    def written(self, *endings, headline=lambda rows: MUTATE.summary(rows, [1, 2])):
        rows = [(m, *ending) for m, ending in zip(self.mutants, endings) if ending]
        rows = MUTATE.with_those_of_page(self.side, rows)
        self.side.page.write_text(MUTATE.page(self.side, rows, headline(rows)), encoding="utf-8")
        return self.side.page.read_text(encoding="utf-8")

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

    def test_of_the_encoder_names_tests(self):
        self.side.judge = "test"
        text = self.written(("noticed", "Ply.IsRead"), ("same program", ""), ("survived", ""),
                            ("noticed", "Ply.IsRead"), headline=MUTATE.encoder_summary)
        self.assertIn("2 of 3 mutants detected, by 1 tests; 1 equivalent.", text)
        self.assertIn("| mutant | fault | ending | test |", text)
        self.assertIn("| first | what first is | noticed | Ply.IsRead |", text)


class List(unittest.TestCase):
    """Lines before mutants of the encoder name the tests that may notice them."""

    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="rlpc-mutate-")
        self.root = pathlib.Path(self._folder.name)
        self.file("encoder/a/b.cpp", "return x < 1;\n")
        self.file("encoder/a/b_test.cpp", "TEST(B, IsLess) {}\n")

    def tearDown(self):
        self._folder.cleanup()

    def file(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def read(self, *lines):
        return MUTATE.mutants.read(self.file("list.txt", "\n".join(lines) + "\n"))

    def mutant(self, name="b-at-most", old="x < 1"):
        return (f"= {name}   is at most", "encoder/a/b.cpp", f"- {old}", "+ x <= 1")

    def complaints(self, *lines):
        return TESTS.check(self.root, self.read(*lines))

    def test_tests_are_those_of_the_last_line(self):
        one, two = self.read("* first_test", "* a_test b_test:B.*", *self.mutant(),
                             *self.mutant("again"))
        self.assertEqual(one.tests, ("a_test", "b_test:B.*"))
        self.assertEqual(two.tests, one.tests)
        self.assertEqual(self.read(*self.mutant())[0].tests, ())

    def test_what_matches_has_no_complaint(self):
        self.assertEqual(self.complaints("* encoder_a_test:B.*:*B.IsLess", *self.mutant()), [])

    def test_complaints_name_what_does_not_match(self):
        self.assertEqual(self.complaints("* encoder_b_test", *self.mutant()),
                         ["encoder_mutants.txt: there is no test binary encoder_b_test"])
        self.assertEqual(self.complaints("* encoder_a_test:C.*", *self.mutant()),
                         ["encoder_mutants.txt: encoder_a_test has no test suite C"])
        self.assertIn('no line "* TEST..." before it', self.complaints(*self.mutant())[0])
        self.assertIn("its text occurs 0 times in encoder/a/b.cpp",
                      self.complaints("* encoder_a_test", *self.mutant(old="x > 1"))[0])

    def test_a_fault_is_taken_out_again(self):
        mutant, = self.read(*self.mutant())
        path = self.root / "encoder/a/b.cpp"
        with MUTATE.mutants.planted(mutant, self.root):
            self.assertEqual(path.read_text(encoding="utf-8"), "return x <= 1;\n")
        self.assertEqual(path.read_text(encoding="utf-8"), "return x < 1;\n")


class FirstFailure(unittest.TestCase):
    """A fault is noticed by the first test that fails, crashes or does not end."""

    PASSED = "[ RUN      ] A.IsFine\n[       OK ] A.IsFine (0 ms)\n"

    def first(self, output, code):
        return TESTS.first_failure("a_test", output, code)

    def test_none_if_all_pass(self):
        self.assertIsNone(self.first(self.PASSED, 0))

    def test_one_that_fails(self):
        output = (self.PASSED + "[ RUN      ] E/A.IsOne/0\nwrong\n"
                  "[  FAILED  ] E/A.IsOne/0, where GetParam() = 4 (0 ms)\n[ RUN      ] A.IsTwo\n")
        self.assertEqual(self.first(output, 1), "E/A.IsOne/0")

    def test_one_that_crashes_or_hangs(self):
        output = self.PASSED + "[ RUN      ] A.IsOne\n"
        self.assertEqual(self.first(output, -11), "A.IsOne (crashes)")
        self.assertEqual(self.first(output, None), "A.IsOne (runs too long)")

    def test_the_binary_if_no_test_began(self):
        self.assertEqual(self.first("", -11), "a_test (crashes)")
        self.assertEqual(self.first("Running 0 tests\n", 0), "a_test (has no such test)")


if __name__ == "__main__":
    unittest.main()
