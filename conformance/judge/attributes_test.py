#!/usr/bin/env python3
"""The judge, judged: fake decoders that declare attributes, with one fault each.

    attributes_test.py --bin BUILD/bin [unittest arguments]
"""

import json
import pathlib
import shlex
import shutil
import sys
import unittest

from judge_testing import JUDGE, ROOT, JudgeTest, Tools, main
import suite

STREAMS = ROOT / "streams" / "v1.2"
GOOD, BAD, NONE = "ATT-0016a", "ATT-0021x1", "ATT-0001x15"  # their attributes: right, broken, none
WITHOUT = "CLP-0004a"


def fake(fault):
    return shlex.join([sys.executable, "-SB", str(JUDGE / "fake_decoders" / "fake"), fault])


class Attributes(JudgeTest):
    """Outcome of each stream, and grades, for each fault."""

    def setUp(self):
        super().setUp()
        self.streams = self.folder / "suite"
        for name in (GOOD, BAD, NONE, WITHOUT):
            source = next(STREAMS.glob(f"*/*/{name}.rlpc"))
            place = self.streams / source.relative_to(STREAMS)
            place.parent.mkdir(parents=True, exist_ok=True)
            for path in (source, source.with_suffix(".json")):
                shutil.copyfile(path, place.with_suffix(path.suffix))
        index = suite.index_of(self.streams, "attributes-1", "1.2")
        (self.streams / suite.INDEX).write_text(json.dumps(index))

    def run_on(self, decoder, *args):
        """(exit code, {stream: row}, {grade: status})"""
        code, report, errors = self.judge(decoder, "--reference", fake("none"), *args,
                                          suite_folder=self.streams)
        self.assertIsNotNone(report, errors)
        return (code, {row["id"]: row for row in report["rows"]},
                {g["grade"]: g["status"] for g in report["grades"]})

    def draws(self, fault, spoiled, attributes="FAIL", code=1, diagnostic="PASS"):
        """spoiled: {stream: text that the report has}"""
        with self.subTest(fault=fault):
            got, rows, grades = self.run_on(fake(fault))
            for name, row in rows.items():
                outcome = "FAIL-attributes" if name in spoiled else "PASS"
                self.assertEqual(row["outcome"], outcome, (name, row["text"]))
                self.assertIn(spoiled.get(name, ""), row["text"])
            self.assertEqual(rows[WITHOUT]["cells"]["attributes"], "")
            self.assertEqual((grades["R-int"], grades["R-strict"], grades["R-attributes"]),
                             ("PASS", "PASS", attributes))
            self.assertEqual((got, grades["R-diagnostic"]), (code, diagnostic))
            return rows

    def test_no_fault(self):
        rows = self.draws("right_attributes", {}, "PASS", 0)
        self.assertEqual({rows[name]["cells"]["attributes"] for name in (GOOD, BAD, NONE)},
                         {"pass"})

    def test_faults(self):
        self.draws("one_value_is_wrong", {GOOD: "wrong hash"})
        self.draws("attributes_are_missing", {GOOD: "OUT.rlpa does not exist"})
        self.draws("attributes_where_there_are_none", {NONE: "has no attributes"})
        self.draws("accepts_bad_attributes", {BAD: "break R-ATT-08"})
        self.draws("attributes_despite_a_refusal", {BAD: "OUT.rlpa is written"})
        self.draws("no_verdict_for_attributes", {BAD: "does not begin with \"rlpc-verdict"})
        self.draws("crashes_on_attributes", {GOOD: "exit code 70", BAD: "exit code 70",
                                             NONE: "exit code 70"})

    def test_rules_are_graded_apart(self):
        rows = self.draws("another_rule_for_attributes", {}, "PASS", 0, "FAIL")
        self.assertEqual(rows[BAD]["cells"]["diagnostic"], "fail")
        self.assertIn("reports R-UNT-01, expected R-ATT-08", rows[BAD]["text"])
        rows = self.draws("no_rule_for_attributes", {}, "PASS", 0, "FAIL")
        self.assertEqual(rows[BAD]["cells"]["diagnostic"], "no rule")

    def test_decoders_need_not_decode_attributes(self):
        code, rows, grades = self.run_on(fake("decodes_high"))
        self.assertEqual((code, grades["R-attributes"]), (0, "NOT DECLARED"))
        self.assertEqual(rows[GOOD]["cells"]["attributes"], "not declared")

    def test_a_suite_without_attributes_has_no_such_grade(self):
        _, report, _ = self.judge(fake("none"), "--only", "GOF-0001a")
        self.assertNotIn("R-attributes", {g["grade"] for g in report["grades"]})

    def test_real_decoders(self):
        specdec = shlex.join([sys.executable, str(ROOT / "conformance/specdec/specdec.py")])
        for decoder in (str(Tools.folder / "rlpcdec"), specdec):
            code, rows, grades = self.run_on(decoder, "--grade", "R-attributes")
            self.assertEqual((code, grades["R-diagnostic"]), (0, "PASS"), rows)


class Sidecars(unittest.TestCase):
    def test_streams_with_an_attribute_unit_say_what_becomes_of_it(self):
        found = 0
        for path in sorted(pathlib.Path(STREAMS).glob("*/ATT/*.json")):
            about = json.loads(path.read_text())
            found += 1
            self.assertRegex(about["attributes"], "^([0-9a-f]{64}|R-[A-Z]{3}-[0-9]{2}|none)$")
            if about["attributes"].startswith("R-"):
                self.assertIn(about["expect"], ("either", "reject"))
                self.assertEqual(about["rules"], [about["attributes"]])
        self.assertGreater(found, 50)


if __name__ == "__main__":
    main()
