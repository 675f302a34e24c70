#!/usr/bin/env python3
"""The judge, judged: fake decoders with one fault each must each get their own verdict.

    judge_test.py --bin BUILD/bin [unittest arguments, such as FakeDecoders]
"""

import json
import pathlib
import shlex
import signal
import subprocess
import sys
import time

from judge_testing import JUDGE, JudgeTest, ROOT, Tools, add_stream, main, write_index

ACCEPT = ("GOF-0001a", "GOF-0002a", "LVL-0001a")
WITH_FRAMES, WITH_HEADER, WITHOUT_OUTPUT = "HSH-0001x1", "GOF-0001x1", "CON-0001x1"
REJECT = (WITH_FRAMES, WITH_HEADER, WITHOUT_OUTPUT)
UNSUPPORTED, EITHER = "STR-0001x1", "MET-0001a"
ALL = (*ACCEPT, *REJECT, UNSUPPORTED, EITHER)
GOOD = {"R-int": "PASS", "R-full": "NOT DECLARED", "R-strict": "PASS", "R-diagnostic": "PASS"}
NO_INT = dict.fromkeys(GOOD, "FAIL")
NO_STRICT = {**GOOD, "R-strict": "FAIL", "R-diagnostic": "FAIL"}
NO_RULES = {**GOOD, "R-diagnostic": "FAIL"}


def each(ids, outcome, reason):
    return dict.fromkeys(ids, (outcome, reason))


def fake(fault):
    """The command of a fake decoder."""
    return shlex.join([sys.executable, "-SB", str(JUDGE / "fake_decoders" / "fake"), fault])


class FakeDecoders(JudgeTest):
    """Every fault draws its outcome on the streams that it spoils, and PASS on all others."""

    def draws(self, fault, spoiled, grades, code, *args):
        """`spoiled`: stream to (outcome, reason); with --only among args just those are run."""
        with self.subTest(fault=fault):
            got, report, errors = self.judge(fake(fault), "--reference", fake("none"), *args)
            self.assertIsNotNone(report, errors)
            rows = {row["id"]: row for row in report["rows"]}
            if "--only" not in args:
                self.assertEqual(set(rows), set(ALL))
            for identity, row in rows.items():
                self.assertEqual((row["outcome"], row["reason"]),
                                 spoiled.get(identity, ("PASS", "")), (identity, row["text"]))
            self.assertEqual({g["grade"]: g["status"] for g in report["grades"]}, grades)
            self.assertEqual(got, code, errors)
            return rows

    def test_no_fault(self):
        self.draws("none", {}, GOOD, 0)
        self.draws("talks_on_standard_output", {}, GOOD, 0)
        self.draws("rejects_what_either_may", {}, GOOD, 0)
        self.draws("right_floats", {}, {**GOOD, "R-full": "PASS"}, 0)

    def test_several_suites_are_judged_as_one(self):
        second = self.folder / "second"
        data = (self.suite / "accept/GOF/GOF-0002a.rlpc").read_bytes()
        add_stream(second, "GOF-0099a", data)
        write_index(second)
        path = self.folder / "report.json"
        for words in (["--suite", self.suite, second], ["--suite", self.suite, "--suite", second]):
            code, _, errors = self.run_here("--decoder", fake("none"), *words, "--json", path,
                                            "--jobs", "1", "--max-mem", "0")
            self.assertEqual(code, 0, errors)
            report = json.loads(path.read_text())
            rows = {row["id"]: row for row in report["rows"]}
            self.assertEqual(set(rows), {*ALL, "GOF-0099a"})
            self.assertEqual({row["outcome"] for row in rows.values()}, {"PASS"})
            self.assertEqual(report["facts"]["streams"], f"{len(rows)} of {len(rows)} (tier core)")
            self.assertEqual(report["facts"]["suite"].count("specification 1.0"), 2)
            for identity, folder in (("GOF-0099a", second), ("GOF-0002a", self.suite)):
                self.assertIn(f"--suite {folder} --tier", rows[identity]["details"]["repeat"])
        code, _, errors = self.run_here("--decoder", fake("none"), "--suite", self.suite,
                                        self.suite)
        self.assertEqual(code, 4)
        self.assertIn("name each suite once", errors)

    def test_crash_is_no_rejection(self):
        crash = ("CRASH", "signal")
        rows = self.draws("crashes_on_bad_streams", each(REJECT, *crash), NO_STRICT, 1)
        self.assertIn("SIGSEGV", rows[WITH_FRAMES]["text"])
        self.draws("throws_on_bad_streams", each(REJECT, "FAIL-verdict", "no-verdict"), NO_STRICT,
                   1)
        self.draws("dies_after_good_output", {ACCEPT[0]: crash},
                   NO_INT, 1,
                   "--only", ACCEPT[0])
        self.draws("ends_with_code_5", each(ALL, "CRASH", "exit-code"),
                   NO_INT, 1)

    def test_hang_is_ended_with_its_children(self):
        start = time.monotonic()
        self.draws("hangs", {ACCEPT[0]: ("CRASH", "timeout")},
                   NO_INT, 1, "--only", ACCEPT[0], "--timeout", "3")
        child = int((self.kept / "child").read_text())
        while alive(child):
            time.sleep(0.05)
        self.assertLess(time.monotonic() - start, 300)  # when both would end by themselves

    def test_interrupt_leaves_the_rest_not_run(self):
        path = self.folder / "report.json"
        process = subprocess.Popen(
            [sys.executable, "-B", JUDGE / "run", "--decoder", fake("hangs"), "--suite", self.suite,
             "--jobs", "1", "--json", path], stdout=subprocess.DEVNULL)
        child = self.kept / "child"
        child.unlink(missing_ok=True)
        while not child.exists():
            self.assertIsNone(process.poll())
            time.sleep(0.05)
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(), 1)
        report = json.loads(path.read_text())
        self.assertEqual(report["outcomes"], {"NOT-RUN": 8})
        self.assertEqual({(g["grade"], g["status"], g["not_run"]) for g in report["grades"]},
                         {("R-int", "NOT RUN", 3), ("R-full", "NOT RUN", 3),
                          ("R-strict", "NOT RUN", 8), ("R-diagnostic", "NOT RUN", 8)})

    def test_memory_is_limited(self):
        self.draws("eats_memory", {ACCEPT[0]: ("FAIL-resource", "limit")},
                   NO_INT, 1, "--only", ACCEPT[0], "--max-mem",
                   str(1 << 28))
        self.draws("says_limit", each(ALL, "FAIL-resource", "limit"),
                   NO_INT, 1)

    def test_wrong_output(self):
        for fault, reason in (("last_frame_is_missing", "frame-count"),
                              ("one_frame_too_many", "frame-count"),
                              ("last_frame_is_cut", "frame-count"),
                              ("another_number_of_frames_in_the_header", "header"),
                              ("a_triangle_is_turned", "triangle"),
                              ("stops_within_the_header", "header")):
            either = {EITHER: ("FAIL-output", reason)}
            self.draws(fault, each(ACCEPT, "FAIL-output", reason) | either, NO_INT, 1)

    def test_first_divergence_is_named(self):
        rows = self.draws("one_vertex_off_by_one",
                          each((*ACCEPT, EITHER), "FAIL-output", "vertex"),
                          NO_INT, 1)
        found = rows[ACCEPT[0]]["details"]["divergence"]
        self.assertEqual((found["frame"], found["vertex"]), (4, 200))
        self.assertEqual([g - e for g, e in zip(found["got"], found["expected"])], [0, 1, 0])
        self.assertEqual(found["also"], "1 of 400 vertices of this frame differ")

    def test_stale_and_missing_output(self):
        rows = self.draws("writes_nothing", each((*ACCEPT, EITHER), "FAIL-output", "no-output")
                          | each((WITH_FRAMES, WITH_HEADER), "FAIL-frames", "no-output"),
                          NO_INT, 1)
        self.assertIn("OUT does not exist", rows[ACCEPT[0]]["text"])
        code, report, _ = self.judge(fake("always_the_first_output"), "--reference",
                                     fake("none"))
        outcomes = {row["id"]: row["outcome"] for row in report["rows"]}
        self.assertEqual((code, outcomes[ACCEPT[1]], outcomes[WITH_FRAMES]),
                         (1, "FAIL-output", "FAIL-frames"))

    def test_frames_before_an_error(self):
        for fault, ids, reason in (
                ("drops_frames_before_an_error", (WITH_FRAMES, WITH_HEADER), "no-output"),
                ("a_frame_more_before_an_error", (WITH_FRAMES,), "frame-count"),
                ("one_wrong_frame_before_an_error", (WITH_FRAMES,), "vertex"),
                ("writes_before_the_first_gof", (WITHOUT_OUTPUT, UNSUPPORTED), "output")):
            self.draws(fault, each(ids, "FAIL-frames", reason), NO_STRICT, 1)

    def test_wrong_verdicts(self):
        self.draws("accepts_all", each((*REJECT, UNSUPPORTED), "FAIL-overaccept", "accepted"),
                   NO_STRICT, 1)
        self.draws("rejects_all", each((*ACCEPT, UNSUPPORTED), "FAIL-overreject", "rejected")
                   | each((WITH_FRAMES, WITH_HEADER), "FAIL-frames", "no-output")
                   | {WITHOUT_OUTPUT: ("PASS", "rule"), EITHER: ("PASS", "rule")},
                   NO_INT, 1)
        self.draws("rejects_what_is_unsupported",
                   {UNSUPPORTED: ("FAIL-overreject", "rejected")}, NO_STRICT, 1)
        for fault in ("no_verdict", "verdict_is_not_last", "verdict_is_no_json",
                      "verdict_has_another_name"):
            rows = self.draws(fault, each((*REJECT, UNSUPPORTED), "FAIL-verdict", "no-verdict"),
                              NO_STRICT, 1)
            self.assertEqual("there is no JSON" in rows[UNSUPPORTED]["text"],
                             fault == "verdict_is_no_json")

    def test_rules_are_graded_apart(self):
        refused = (*REJECT, UNSUPPORTED)
        self.draws("another_rule", each(refused, "PASS", "rule"), NO_RULES, 0)
        self.draws("another_rule", each(refused, "PASS", "rule"), NO_RULES, 1, "--grade",
                   "R-diagnostic")
        self.draws("another_frame", each(refused, "PASS", "frame"), NO_RULES, 0)
        rows = self.draws("no_rule", {}, NO_RULES, 0)
        self.assertEqual({rows[i]["cells"]["diagnostic"] for i in refused}, {"no rule"})

    def test_unsupported_never_counts_as_passed(self):
        declared = {"LVL-0001a": ("UNSUPPORTED", "not-declared")}
        self.draws("declares_level_1", declared, GOOD, 0)
        _, report, _ = self.judge(fake("declares_level_1"))
        grade = report["grades"][0]
        self.assertEqual((grade["passed"], grade["unsupported"], grade["of"]), (2, 1, 3))
        self.draws("unsupported_to_all", each((*ACCEPT, *REJECT, EITHER), "FAIL-unsupported",
                                              "declared"),
                   NO_INT, 1)
        nothing = each((*ACCEPT, *REJECT, EITHER), "UNSUPPORTED", "not-declared")
        rows = self.draws("declares_nothing", nothing, dict.fromkeys(GOOD, "NOT DECLARED"), 1)
        self.assertEqual((rows[UNSUPPORTED]["cells"]["strict"],
                          rows[UNSUPPORTED]["cells"]["diagnostic"]), ("pass", "unsupported"))

    def test_floats(self):
        rows = self.draws("floats_one_ulp_off", each(ACCEPT, "FAIL-float", "float"),
                          {**GOOD, "R-full": "FAIL"}, 1)
        self.assertEqual(rows[ACCEPT[0]]["cells"]["int"], "pass")
        self.assertEqual(rows[ACCEPT[0]]["details"]["divergence"]["vertex"], 0)
        self.draws("integers_for_floats", each(ACCEPT, "FAIL-float", "float"),
                   {**GOOD, "R-full": "FAIL"}, 1)

    def test_contract_is_checked_first(self):
        for fault, word in (("answers_no_json", "--rlpc-conformance: printed no JSON\n"),
                            ("answers_nothing", "--rlpc-conformance: printed nothing\n"),
                            ("speaks_another_contract", "contract")):
            code, report, errors = self.judge(fake(fault))
            self.assertEqual((code, report), (1, None))
            self.assertIn(word, errors)
            self.assertIn("It must print one JSON object", errors)


def alive(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().split()[2] != "Z"
    except OSError:
        return False


class RealDecoders(JudgeTest):
    """rlpcdec and specdec, with specdec for the expected values."""

    def test_rlpcdec_has_every_grade(self):
        code, report, errors = self.judge(str(Tools.folder / "rlpcdec"), "--grade", "R-diagnostic")
        self.assertEqual(code, 0, (errors, report))
        self.assertEqual({g["status"] for g in report["grades"]}, {"PASS"})
        self.assertEqual([g["of"] for g in report["grades"]], [3, 3, 8, 8])

    def test_specdec_has_every_grade_but_floats(self):
        decoder = shlex.join([sys.executable, str(ROOT / "conformance/specdec/specdec.py")])
        code, report, _ = self.judge(decoder)
        self.assertEqual((code, {g["grade"]: g["status"] for g in report["grades"]}), (0, GOOD))

    def test_expected_values_come_from_specdec(self):
        _, report, _ = self.judge(fake("one_vertex_off_by_one"), "--only", "GOF-0002a")
        found = report["rows"][0]["details"]["divergence"]
        self.assertEqual((found["kind"], found["frame"], found["vertex"]), ("vertex", 2, 202))

    def test_wrong_reference_is_not_believed(self):
        _, report, _ = self.judge(fake("one_vertex_off_by_one"), "--reference",
                                  fake("one_frame_too_many"), "--only", "GOF-0002a")
        row = report["rows"][0]
        self.assertEqual((row["outcome"], row["reason"]), ("FAIL-output", "hash"))
        self.assertIn("differs from the sidecar", row["text"])
        self.assertIn("frames before 2", row["text"])


if __name__ == "__main__":
    main()
