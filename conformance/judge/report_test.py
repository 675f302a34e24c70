#!/usr/bin/env python3
"""Reports of the judge: their forms, and the export to fluster.

    report_test.py --bin BUILD/bin [unittest arguments, such as Reports]
"""

import json
import os
import pathlib
import runpy
import shlex
import subprocess
import sys
import types
import xml.etree.ElementTree as ElementTree

from judge_testing import JUDGE, JudgeTest, Tools, main
import report
import schema

FAULTY = shlex.join([sys.executable, "-SB", str(JUDGE / "fake_decoders" / "fake"),
                     "one_vertex_off_by_one"])


class Reports(JudgeTest):
    """All forms say the same."""

    faulty_reports = None

    def reports(self, *args):
        """(report, {form: text}) on FAULTY."""
        names = {form: self.folder / f"report.{form}" for form in ("markdown", "junit", "html")}
        options = [word for form, path in names.items() for word in (f"--{form}", path)]
        _, result, errors = self.judge(FAULTY, *options, *args)
        self.assertIsNotNone(result, errors)
        return result, {form: path.read_text() for form, path in names.items()}

    def reports_on_all(self):
        """Those on all streams, which are made once."""
        if Reports.faulty_reports is None:
            Reports.faulty_reports = self.reports()
        result, texts = Reports.faulty_reports
        return result, dict(texts)

    def test_json_has_the_form_of_the_schema(self):
        result, _ = self.reports_on_all()
        schema.check(result, schema.load("report"))
        for row in result["rows"]:
            schema.check(row["details"]["verdict"] or {}, schema.load("verdict"))

    def test_denominators_are_everywhere(self):
        result, texts = self.reports_on_all()
        self.assertEqual(result["outcomes"], {"PASS": 4, "FAIL": 4})
        texts["terminal"] = report.text(result)
        for form in ("terminal", "markdown", "html"):
            with self.subTest(form=form):
                self.assertIn("0 of 3 streams passed, 3 failed", texts[form])
                self.assertIn("4 of 8 streams passed, 4 failed", texts[form])
        for form in ("terminal", "markdown"):
            self.assertIn("8 in all: 4 FAIL, 4 PASS", texts[form])

    def test_first_divergence_is_everywhere(self):
        result, texts = self.reports("--only", "GOF-0001a")
        found = result["rows"][0]["details"]["divergence"]
        words = "frame 4, vertex 200: expected %d %d %d" % tuple(found["expected"])
        texts["terminal"] = report.text(result)
        for form, text in texts.items():
            self.assertIn(words, text, form)
        self.assertIn("--only GOF-0001a", texts["terminal"])

    def test_junit_counts(self):
        _, texts = self.reports_on_all()
        root = ElementTree.fromstring(texts["junit"])
        self.assertEqual([root.get(k) for k in ("tests", "failures", "errors", "skipped")],
                         ["8", "4", "0", "0"])
        self.assertEqual(len(root.findall("testcase")), 8)
        self.assertEqual(len(root.findall("testcase/failure")), 4)

    def test_page_needs_no_network_and_escapes(self):
        result = report.report_of("decoder", "<&>", {"command": "</script><b>"}, [], [], [], False)
        page = report.html(result)
        self.assertIn("&lt;/script&gt;&lt;b&gt;", page)
        _, texts = self.reports_on_all()
        for forbidden in ("http:", "https:", "src=", "<link", "@import", "url("):
            self.assertNotIn(forbidden, texts["html"])

    def test_reports_are_written_whole_or_not(self):
        target = self.folder / "there.html"
        target.write_text("before")
        code, _, errors = self.run_here("--decoder", Tools.folder / "rlpcdec", "--suite",
                                        self.suite, "--max-mem", "0", "--html",
                                        self.folder / "none" / "x.html")
        self.assertEqual(code, 4)
        self.assertIn("none", errors)
        self.assertEqual(target.read_text(), "before")

    def test_usage(self):
        for args, code in ((["--suite", "x"], 64), (["--decoder", "no-such-program"], 64),
                           (["--decoder", "true", "--tier", "all"], 64),
                           (["--decoder", "true", "--jobs", "0"], 64),
                           (["--decoder", "true", "--suite", self.folder], 4)):
            got, _, errors = self.run_here(*(["--suite", self.suite] + args))
            self.assertEqual(got, code, args)
            self.assertNotIn("Traceback", errors)


class Fluster(JudgeTest):
    """The export, with a stand-in for the parts of fluster that a decoder of it uses."""

    FIELDS = {"name", "source", "source_checksum", "input_file", "output_format", "result"}

    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"
        code, text, errors = self.command("export_fluster", self.out, "--suite", self.suite,
                                          "--reference", Tools.folder / "rlpcdec")
        self.assertEqual(code, 0, errors)
        self.assertIn("3 streams that decode and 4 to refuse; 1 omitted", text)

    def suites(self):
        for path in sorted((self.out / "test_suites" / "rlpc").glob("*.json")):
            yield json.loads(path.read_text())

    def test_form(self):
        suites = list(self.suites())
        self.assertEqual([(s["name"], len(s["test_vectors"])) for s in suites],
                         [("RLPC-test-1-reject", 4), ("RLPC-test-1", 3)])
        for content in suites:
            self.assertEqual(set(content), {"name", "codec", "description", "test_vectors"})
            for vector in content["test_vectors"]:
                self.assertEqual(set(vector), self.FIELDS)
                path = (self.out / "resources" / content["name"] / vector["name"]
                        / vector["input_file"])
                self.assertEqual(checksum(path), vector["source_checksum"])
                self.assertEqual(checksum(pathlib.Path(vector["source"].split("//", 1)[1])),
                                 vector["source_checksum"])
                self.assertRegex(vector["result"], "^([0-9a-f]{32}|rejected|unsupported)$")

    def test_decoder_gives_the_results(self):
        decoder = load_plugin(self.out / "decoders" / "rlpc.py")
        os.environ["RLPC_DECODER"] = str(Tools.folder / "rlpcdec")
        self.assertTrue(decoder.check(False))
        for content in self.suites():
            for vector in content["test_vectors"]:
                path = (self.out / "resources" / content["name"] / vector["name"]
                        / vector["input_file"])
                result = decoder.decode(str(path), str(self.folder / "x.out"), None, 30, False,
                                        False)
                self.assertEqual(result, vector["result"], vector["name"])
        os.environ["RLPC_DECODER"] = "false-decoder"
        self.assertFalse(decoder.check(False))

    def test_wrong_reference_is_noticed(self):
        code, _, errors = self.command("export_fluster", self.folder / "other", "--suite",
                                       self.suite, "--reference", FAULTY)
        self.assertEqual(code, 4)
        self.assertIn("differs from the sidecar", errors)


def checksum(path):
    return subprocess.run(["md5sum", path], capture_output=True, text=True,
                          check=True).stdout.split()[0]


def load_plugin(path):
    """Returns what the file registers as a decoder."""
    registered = []
    modules = {"fluster": types.ModuleType("fluster")}
    for name, content in (("codec", {"Codec": types.SimpleNamespace(NONE="None"),
                                     "OutputFormat": object}),
                          ("decoder", {"Decoder": object,
                                       "register_decoder": registered.append}),
                          ("utils", {"file_checksum": checksum})):
        modules[f"fluster.{name}"] = types.ModuleType(name)
        vars(modules[f"fluster.{name}"]).update(content)
    sys.modules.update(modules)
    try:
        runpy.run_path(str(path))
    finally:
        for name in modules:
            del sys.modules[name]
    return registered[0]()


if __name__ == "__main__":
    main()
