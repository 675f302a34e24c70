#!/usr/bin/env python3
"""rlpcval as people and scripts run it.

    rlpcval_test.py --bin BUILD/bin [unittest arguments, such as Validation]
"""

import json
import pathlib
import random
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from tools_testing import ROOT, ToolsTest, main, run, write_obj, write_pc2

for folder in ("judge", "specdec"):
    sys.path.insert(0, str(ROOT / "conformance" / folder))
import schema
import specdec
from specdec_testing import PROGRAM


class Validation(ToolsTest):
    """Exit codes, the report for people and that for machines."""

    def setUp(self):
        super().setUp()
        self.encode(self.path("a.rlpc"), "--kg", 1, "--gof", 20, "--profile", "baseline")
        self.good = self.path("a.rlpc").read_bytes()

    def stream(self, name, data):
        self.path(name).write_bytes(data)
        return self.path(name)

    def broken(self, name="bad.rlpc"):
        data = bytearray(self.good)
        data[len(data) // 2] ^= 8
        return self.stream(name, bytes(data))

    def json(self, *args):
        result = run("rlpcval", "--json", *args)
        report = result.json()
        schema.check(report, schema.load("findings"))
        return result.code, report["streams"]

    def test_good_stream(self):
        result = self.ok("rlpcval", self.path("a.rlpc"))
        self.assertIn(b"conforming; 0 errors", result.out)
        self.assertEqual(self.ok("rlpcval", self.path("a.rlpc"), "--quiet").out, b"")
        self.assertEqual(self.ok("rlpcval", "-", input=self.good).out[:1], b"-")
        code, (stream,) = self.json(self.path("a.rlpc"))
        self.assertEqual((code, stream["verdict"], stream["findings"]), (0, "conforming", []))
        self.assertEqual((stream["frames"], stream["hashed_frames"]), (60, 60))

    def test_errors_say_what_where_why_and_what_to_do(self):
        result = run("rlpcval", self.broken())
        self.assertEqual(result.code, 1)
        for words in ("error R-UNT-03", "unit_crc", "(GOF) at byte", "clause 7.2", "Likely cause:",
                      "What to do:", "stops here", "Not everything was checked"):
            self.assertIn(words, result.out.decode())
        self.assertEqual(run("rlpcval", self.broken(), "--quiet").out, b"")

    def test_json_names_the_place(self):
        code, (stream,) = self.json(self.broken())
        self.assertEqual((code, stream["verdict"]), (1, "not conforming"))
        first = stream["findings"][0]
        self.assertEqual((first["id"], first["unit"]["type"]), ("R-UNT-03", "GOF"))
        self.assertEqual(first["byte"], first["bit"] // 8)
        self.assertEqual([f["stops_decoder"] for f in stream["findings"]].count(True), 1)
        verdict = run("rlpcdec", self.broken(), "--verify")
        self.assertIn(f"bit {first['bit']}:", verdict.err)

    def test_slices(self):
        self.encode(self.path("m.rlpc"), "--kg", 1, "--gof", 20, "--profile", "main")
        good = self.path("m.rlpc").read_bytes()
        code, (stream,) = self.json(self.path("m.rlpc"))
        self.assertEqual((code, stream["verdict"]), (0, "conforming"))
        self.assertEqual((stream["frames"], stream["hashed_frames"]), (60, 60))
        at, seen = 10, 0
        while seen < 2:  # the second slice
            seen += good[at] == 6
            at += 9 + int.from_bytes(good[at + 1:at + 5], "big")
        wrong = good[:at - 9] + bytes([good[at - 9] ^ 1]) + good[at - 8:]
        code, (stream,) = self.json(self.stream("wrong.rlpc", wrong))
        first = stream["findings"][0]
        self.assertEqual((code, first["id"], first["unit"]["type"]), (1, "R-UNT-03", "slice"))
        self.assertEqual(stream["hashed_frames"], 40)

    def test_warnings_fail_only_if_wanted(self):
        self.encode(self.path("w.rlpc"), "--kg", 1, "--hash", "none")
        result = self.ok("rlpcval", self.path("w.rlpc"))
        self.assertIn(b"warning W-HSH-01", result.out)
        self.assertEqual(run("rlpcval", self.path("w.rlpc"), "--strict-warnings").code, 1)
        self.ok("rlpcval", self.path("a.rlpc"), "--strict-warnings")

    def test_unsupported_streams(self):
        later = self.stream("later.rlpc", self.good[:9] + b"\x05" + self.good[10:])
        result = run("rlpcval", later)
        self.assertEqual(result.code, 2)
        self.assertIn(b"unsupported R-STR-03", result.out)

    def test_limits(self):
        result = run("rlpcval", self.path("a.rlpc"), "--max-memory", "1KiB")
        self.assertEqual(result.code, 3)
        self.assertIn(b"raise --max-memory", result.out)
        code, (stream,) = self.json(self.path("a.rlpc"), "--max-memory", "1KiB")
        self.assertEqual((code, stream["stopped"]["reason"]), (3, "limit"))

    def test_files_that_cannot_be_read(self):
        self.fails(4, "none.rlpc", "rlpcval", self.path("none.rlpc"))
        self.fails(4, str(self.folder), "rlpcval", self.folder)
        code, (stream,) = self.json(self.path("none.rlpc"))
        self.assertEqual((code, stream["stopped"]["reason"]), (4, "unreadable"))
        empty = run("rlpcval", self.stream("empty.rlpc", b""))
        self.assertEqual(empty.code, 1)
        self.assertIn(b"error R-BIT-01", empty.out)

    def test_several_streams(self):
        bad, none = self.broken(), self.path("none.rlpc")
        later = self.stream("later.rlpc", self.good[:9] + b"\x05" + self.good[10:])
        good = self.path("a.rlpc")
        for streams, code in (((good, good), 0), ((good, later), 2), ((later, none, good), 4),
                              ((none, bad, later), 1)):
            self.assertEqual(run("rlpcval", "-q", *streams).code, code)
        code, entries = self.json(good, bad, later)
        self.assertEqual([e["verdict"] for e in entries],
                         ["conforming", "not conforming", "unsupported"])

    def test_usage(self):
        self.fails(64, "expected a stream", "rlpcval")
        self.fails(64, "", "rlpcval", self.path("a.rlpc"), "--unknown")
        self.fails(64, "R-XYZ-01", "rlpcval", "--explain", "R-XYZ-01")
        for words in (b"Examples", b"Exit code", b"--strict-warnings"):
            self.assertIn(words, self.ok("rlpcval", "--help-all").out)


def repaired(data):
    """The stream with CRCs that fit, as far as the sizes of its units make sense."""
    data, at = bytearray(data), 10
    while at + 9 <= len(data):
        end = at + 5 + int.from_bytes(data[at + 1:at + 5], "big")
        if end + 4 > len(data):
            break
        data[end:end + 4] = zlib.crc32(data[at:end]).to_bytes(4, "big")
        at = end + 4
    return bytes(data)


class Specification(ToolsTest):
    """On damaged streams, the rule at which the specification stops is the first of rlpcval."""

    COUNT = 75  # per profile
    SEED = 7

    def encode_small(self, profile):
        triangles = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (0, 0, 1)]
        numbers = random.Random(self.SEED)
        frames = [[numbers.uniform(0, 3) for _ in range(15)] for _ in range(4)]
        write_obj(self.path("m.obj"), frames[0], triangles)
        write_pc2(self.path("m.pc2"), frames)
        self.path("m.json").write_text("[1]")
        self.ok("rlpcenc", self.path("m.obj"), "--points", self.path("m.pc2"), "-o",
                self.path("m.rlpc"), "--kg", 5, "--gof", 2, "--keep-order", "--hash", "frame",
                "--metadata", self.path("m.json"), "--profile", profile)

    def damaged(self):
        """Streams with one to three wrong bytes, most of them with CRCs that fit."""
        good = self.path("m.rlpc").read_bytes()
        numbers = random.Random(self.SEED)
        for number in range(self.COUNT):
            data = bytearray(good)
            for _ in range(numbers.randint(1, 3)):
                data[numbers.randrange(len(data))] ^= 1 << numbers.randrange(8)
            if number % 10 == 0:
                del data[numbers.randrange(len(data)):]
            yield repaired(data) if number % 4 else bytes(data)

    def test_first_rule(self):
        verdicts, paths = [], []
        streams = []
        for profile in ("baseline", "main"):
            self.encode_small(profile)
            streams += self.damaged()
        for number, data in enumerate(streams):
            decoder = specdec.Decoder(PROGRAM, data, lambda output: None)
            try:
                decoder.call("stream")
                verdicts.append(None)
            except specdec.Verdict as verdict:
                verdicts.append(verdict.args[0])
            paths.append(self.path(f"{number}.rlpc"))
            paths[-1].write_bytes(data)
        streams = run("rlpcval", "--json", *paths).json()["streams"]
        self.assertGreater(len(set(verdicts)), 15)
        for number, (stream, rule) in enumerate(zip(streams, verdicts, strict=True)):
            first = [f["id"] for f in stream["findings"] if f["stops_decoder"]]
            self.assertEqual(first, [rule] if rule else [], f"seed {self.SEED}, stream {number}")


class Suite(ToolsTest):
    """On every published stream, what its sidecar says; and every rule is reported on some."""

    def reports(self):
        """(sidecar, entry of rlpcval --json) of each stream."""
        sidecars = sorted((ROOT / "streams").glob("v*/*/*/*.json"))
        paths = [path.with_suffix(".rlpc") for path in sidecars]
        self.assertTrue(paths, "streams/ has no streams")
        # Limits of the highest levels are above the default of --max-memory.
        found = run("rlpcval", "--json", "--max-memory", "64GiB", *paths).json()
        schema.check(found, schema.load("findings"))
        for path, entry in zip(sidecars, found["streams"], strict=True):
            yield json.loads(path.read_text(encoding="utf-8")), entry

    def test_sidecars(self):
        verdicts = {"accept": "conforming", "reject": "not conforming", "either": "not conforming",
                    "unsupported": "unsupported"}
        seen = set()
        for sidecar, entry in self.reports():
            failures = [f for f in entry["findings"] if f["severity"] != "warning"]
            seen |= {f["id"] for f in failures}
            with self.subTest(stream=sidecar["id"]):
                if sidecar["expect"] == "unsupported" and entry["errors"] > 0:
                    # A decoder does not come to the wrong CRC of a unit that it does not know.
                    self.assertEqual({f["id"] for f in failures[1:]}, {"R-UNT-03"})
                else:
                    self.assertEqual(entry["verdict"], verdicts[sidecar["expect"]])
                first = [(f["id"], f["bit"]) for f in failures if f["stops_decoder"]]
                if sidecar["expect"] in ("reject", "unsupported"):
                    self.assertEqual(first, [(sidecar["rule"], sidecar["bit"])])
                else:
                    self.assertEqual(first, [])
                if sidecar["expect"] == "either":
                    self.assertTrue({f["id"] for f in failures} & set(sidecar["rules"]))
                places = [(f["id"], f["element"], f["bit"], str(f["unit"])) for f in failures]
                self.assertEqual(len(places), len(set(places)), "a finding is reported twice")
        rules = json.loads((ROOT / "spec" / "rules.json").read_text(encoding="utf-8"))
        self.assertEqual({rule["rule"] for rule in rules} - seen, set())


class Explanations(ToolsTest):
    def test_every_rule_can_be_explained(self):
        rules = json.loads(pathlib.Path(ROOT / "spec" / "rules.json").read_text(encoding="utf-8"))
        for rule in rules:
            said = self.ok("rlpcval", "--explain", rule["rule"]).out.decode()
            self.assertIn(f"{rule['rule']} (clause {rule['clause']})", said)


if __name__ == "__main__":
    main()
