#!/usr/bin/env python3
"""scripts/constants: what it takes for a tuned constant, what it builds, and its arithmetic."""

import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import tuned
import worth

TEXT = """#include <cstdint>
namespace rlpc {
constexpr double kTry = 0.72;  // tuned (off: 1e9): a trial
inline constexpr std::uint32_t kMany = 1'000;  // tuned: vertices
constexpr double kUnit = 16.0;  // fixed: format
constexpr double kPlain = 2.5;
constexpr std::array<int, 2> kList{1, 2};  // tuned: numbers
struct A {
  // The solver. Its rounds:
  // tuned (off: 1): rounds, as many
  // as pay
  static constexpr int kTimes = 3;
};
double f() {
  constexpr double kLocal = 0.5;  // tuned: inside
  return kLocal;
}
}  // namespace rlpc
"""


class Declarations(unittest.TestCase):
    def setUp(self):
        self.found = {c.name: c
                      for c in tuned.declarations("encoder/codec/spans/some_file.h", TEXT)}

    def test_each_says_what_it_is(self):
        tags = {name: c.tag for name, c in self.found.items()}
        self.assertEqual(tags, {"kTry": "tuned", "kMany": "tuned", "kUnit": "fixed", "kPlain": "",
                                "kList": "tuned", "kTimes": "tuned", "kLocal": "tuned"})
        self.assertEqual(self.found["kTry"].id, "some_file.kTry")
        self.assertEqual(self.found["kTry"].reason, "a trial")
        self.assertEqual(self.found["kTimes"].reason, "rounds, as many as pay")

    def test_variants_keep_the_type(self):
        self.assertEqual(tuned.variants(self.found["kTry"]),
                         {"off": "1e9", "half": "0.36", "double": "1.44"})
        self.assertEqual(tuned.variants(self.found["kMany"]), {"half": "500", "double": "2000"})
        self.assertEqual(tuned.variants(self.found["kTimes"]),
                         {"off": "1", "half": "1", "double": "6"})
        self.assertEqual(tuned.variants(self.found["kList"]), {})

    def test_the_copy_reads_tuned_numbers_alone(self):
        text = tuned.instrumented("encoder/codec/spans/some_file.h", TEXT)
        self.assertIn('const double kTry = static_cast<double>('
                      'tuned_override("some_file.kTry", 0.72));', text)
        self.assertIn("inline const std::uint32_t kMany", text)
        self.assertIn("  static inline const int kTimes", text)
        self.assertIn("  static const double kLocal", text)
        for line in TEXT.splitlines():
            if "kUnit" in line or "kPlain" in line or "kList" in line:
                self.assertIn(line, text)
        self.assertEqual(tuned.instrumented("a.h", "int x;\n"), "int x;\n")


class Arithmetic(unittest.TestCase):
    BASE = worth.Result(1000, 0.099, 2.0)

    def test_bytes_are_compared_at_the_same_error(self):
        slope = worth.slope(self.BASE, worth.Result(500, 0.198, 2.0))
        self.assertAlmostEqual(slope, -1.0)
        # 1 % more bytes for 1 % less error is no change.
        other = worth.Result(1010, 0.099 / 1.01, 1.0)
        size, time = worth.change([other], [self.BASE], [slope], [0.1])
        self.assertAlmostEqual(size, 0.0)
        self.assertAlmostEqual(time, -0.5)

    def test_changes_are_geometric_means(self):
        results = [worth.Result(2000, 0.099, 2.0), worth.Result(500, 0.099, 2.0)]
        size, _ = worth.change(results, [self.BASE] * 2, [-1.0] * 2, [0.1] * 2)
        self.assertAlmostEqual(size, 0.0)


class FakeEncoder:
    """Bytes and errors by what is overridden."""

    def __init__(self):
        self.asked = []

    def run(self, case, override=""):
        self.asked.append(override)
        size = 1100 if override.endswith("some_file.kTry=1e9") else 1000
        return worth.Result(round(size * 0.1 / case.target), 0.99 * case.target, 1.0)

    def run_all(self, tasks):
        return [self.run(*task) for task in tasks]


class Measure(unittest.TestCase):
    def test_each_variant_has_its_cell(self):
        constants = [c for c in tuned.declarations("encoder/codec/spans/some_file.h", TEXT)
                     if c.name == "kTry"]
        case = worth.Case(pathlib.Path("a.obj"), ("--kg", "0.1"))
        encoder = FakeEncoder()
        table = worth.measure(encoder, [case], constants, "all=1", lambda *_: None)
        self.assertEqual(encoder.asked[:3], ["all=1", "all=1", "all=1;some_file.kTry=1e9"])
        row = table["some_file.kTry"]
        self.assertAlmostEqual(row["off"][0], 0.1)
        self.assertIsNone(row["half"][0])
        page = worth.markdown(constants, {"some_file.kTry": {**row, "with": "two"}})
        self.assertIn("| `some_file.kTry` | 0.72 | +10.00 / +0 | = / +0 | = / +0 | two | a trial |",
                      page)
        self.assertEqual(worth.rows(page), ["some_file.kTry"])

    def test_measured_cells_stay_when_values_or_reasons_change(self):
        constants = [c for c in tuned.declarations("encoder/codec/spans/some_file.h", TEXT)
                     if c.name == "kTry"]
        old = (f"{worth.BEGIN}\n{chr(10).join(worth._HEAD)}\n"
               "| `gone.kOther` | 1 | = / +0 |  |  | one | gone |\n"
               f"| `some_file.kTry` | 0.5 | +1.00 / +2 |  | = / +0 | two | old |\n{worth.END}\n")
        new = worth.with_constants(old, constants)
        self.assertIn("| `some_file.kTry` | 0.72 | +1.00 / +2 |  | = / +0 | two | a trial |", new)
        self.assertEqual(worth.rows(new), ["some_file.kTry"])
        self.assertEqual(worth.with_constants(new, constants), new)
        unmeasured = worth.with_constants(f"{worth.BEGIN}\n{worth.END}\n", constants)
        self.assertIn("| `some_file.kTry` | 0.72 |  |  |  |  | a trial |", unmeasured)

    def test_the_table_goes_between_its_marks(self):
        page = f"before\n{worth.BEGIN}\nold\n{worth.END}\nafter\n"
        self.assertEqual(worth.with_table(page, "new\n"),
                         f"before\n{worth.BEGIN}\nnew\n{worth.END}\nafter\n")
        with self.assertRaises(worth.Failure):
            worth.with_table("no marks\n", "new\n")


class Copy(unittest.TestCase):
    def test_what_stays_is_not_written_again(self):
        with tempfile.TemporaryDirectory() as folder:
            scratch = pathlib.Path(folder)
            root = pathlib.Path(__file__).resolve().parents[3]
            worth.copy_sources(root, scratch)
            header = scratch / tuned.OVERRIDE_HEADER
            self.assertIn("RLPC_TUNED", header.read_text())
            copied = {p: p.stat().st_mtime_ns for p in scratch.rglob("*") if p.is_file()}
            self.assertIn(scratch / "CMakeLists.txt", copied)
            changed = [p.read_text() for p in copied if p.suffix in (".h", ".cpp")]
            self.assertEqual(sum(text.count("tuned_override(\"") for text in changed),
                             sum(c.is_number for c in tuned.tuned(root)) + 1)
            self.assertEqual(sum(f'tuned_override("{tuned.TRIALS}"' in text for text in changed), 1)
            (scratch / "gone.cpp").write_text("")
            worth.copy_sources(root, scratch)
            self.assertEqual(copied, {p: p.stat().st_mtime_ns for p in scratch.rglob("*")
                                      if p.is_file()})


if __name__ == "__main__":
    unittest.main()
