#!/usr/bin/env python3
"""Suites and schemas: faults of a suite are reported with their place.

    suite_test.py --bin BUILD/bin [unittest arguments, such as Suites]
"""

import hashlib
import json
import math
import pathlib
import shutil
import struct
import subprocess
import unittest

from judge_testing import JudgeTest, PROGRAM, Tools, add_stream, main, sidecar, write_index
import expectation
import rlpd
import schema
import suite


class Schemas(unittest.TestCase):
    """The checker of conformance/judge/schema.py."""

    def complaints(self, value, rules):
        return list(schema.complaints(value, rules, "it"))

    def test_every_keyword_complains(self):
        for value, rules, word in (
                ("a", {"type": "integer"}, "expected: integer"),
                (True, {"type": "integer"}, "expected: integer"),
                (1.5, {"type": ["integer", "null"]}, "integer or null"),
                ("b", {"enum": ["a", 1]}, 'one of: "a", 1'),
                (True, {"enum": [1]}, "one of: 1"),
                ("xy", {"pattern": "^x$"}, "the form ^x$"),
                (-1, {"minimum": 0}, "at least 0"),
                ({}, {"required": ["a"]}, 'no "a"'),
                ({"b": 1}, {"additionalProperties": False}, '"b", which is not known'),
                ({"a": {"b": []}}, {"properties": {"a": {"properties": {"b": {"type": "object"}}}}},
                 "it.a.b is []"),
                ([1, "x"], {"items": {"type": "integer"}}, "it[1] is")):
            with self.subTest(rules=rules):
                found = self.complaints(value, rules)
                self.assertEqual(len(found), 1, found)
                self.assertIn(word, found[0])

    def test_what_matches_causes_no_complaint(self):
        rules = {"type": "object", "required": ["a"], "additionalProperties": False,
                 "properties": {"a": {"type": ["array", "null"], "items": {"minimum": 2}},
                                "b": {"enum": ["x"], "pattern": "x"}}}
        self.assertEqual(self.complaints({"a": [2, 3.5], "b": "x"}, rules), [])
        self.assertEqual(self.complaints({"a": None}, rules), [])

    def test_unknown_keywords_are_refused(self):
        with self.assertRaises(ValueError):
            self.complaints(1, {"maximum": 3})

    def test_all_schemas_use_known_keywords(self):
        def check(rules):
            list(schema.complaints(None, {**rules, "type": "null"}, "it"))
            for inner in rules.get("properties", {}).values():
                check(inner)
            if "items" in rules:
                check(rules["items"])
        for path in schema.FOLDER.glob("*.schema.json"):
            if path.stem.split(".")[0] in ("suite", "sidecar", "verdict", "report", "contract"):
                check(json.loads(path.read_text()))


class Suites(JudgeTest):
    """Loading and selecting."""

    def setUp(self):
        super().setUp()
        self.copy = self.folder / "suite"
        shutil.copytree(self.suite, self.copy)

    def edit(self, path, **changes):
        value = json.loads((self.copy / path).read_text())
        for name, change in changes.items():
            if change is None:
                del value[name]
            else:
                value[name] = change
        (self.copy / path).write_text(json.dumps(value))

    def refused(self, *words):
        with self.assertRaises(suite.SuiteError) as raised:
            suite.load_suite(self.copy)
        for word in words:
            self.assertIn(word, str(raised.exception))
        code, _, errors = self.run_here("--decoder", "true", "--suite", self.copy)
        self.assertEqual(code, 4, errors)

    def test_good_suite(self):
        loaded = suite.load_suite(self.copy)
        self.assertEqual((loaded.name, loaded.spec, len(loaded.streams)), ("test-1", "1.0", 8))

    def test_damaged_stream_is_noticed(self):
        path = self.copy / "accept/GOF/GOF-0001a.rlpc"
        path.write_bytes(path.read_bytes() + b"\0")
        self.refused("GOF-0001a.rlpc", "the file was changed")

    def test_missing_files_are_named(self):
        (self.copy / "accept/GOF/GOF-0001a.rlpc").unlink()
        self.refused("GOF-0001a.rlpc", "No such file")
        (self.copy / "accept/GOF/GOF-0001a.json").unlink()
        self.refused("GOF-0001a.json", "No such file")
        (self.copy / "SUITE.json").unlink()
        self.refused("no SUITE.json there", "streams/v1.0")

    def test_wrong_sidecars_are_named(self):
        path = "accept/GOF/GOF-0001a.json"
        for changes, word in (({"title": None}, 'no "title"'), ({"frames": None}, 'needs "frames"'),
                              ({"frames": 4}, "5 hashes"), ({"frames": "5"}, "expected: integer"),
                              ({"tier": "fast"}, 'one of: "smoke"'), ({"note": 1}, "not known"),
                              ({"tier": "stress"}, "'stress' in its sidecar")):
            with self.subTest(changes=changes):
                shutil.copy(self.suite / path, self.copy / path)
                self.edit(path, **changes)
                self.refused(word)

    def test_broken_json_is_named(self):
        (self.copy / "SUITE.json").write_text("{")
        self.refused("SUITE.json")

    def test_index_agrees_with_sidecars_and_places(self):
        index = json.loads((self.copy / "SUITE.json").read_text())
        index["streams"][1]["expect"] = "reject"
        self.edit("SUITE.json", streams=index["streams"])
        self.refused("'reject', but")
        self.edit("SUITE.json", streams=[])
        self.assertEqual(suite.load_suite(self.copy).streams, [])

    def test_tiers_include_those_below_and_superseded_streams_are_left_out(self):
        data = (self.copy / "accept/GOF/GOF-0001a.rlpc").read_bytes()
        add_stream(self.copy, "GOF-0007a", data, tier="core")
        add_stream(self.copy, "GOF-0008a", data, tier="stress")
        add_stream(self.copy, "GOF-0009a", data, superseded_by="GOF-0009b")
        write_index(self.copy)
        streams = suite.load_suite(self.copy).streams
        counts = [len(suite.select(streams, tier)) for tier in suite.TIERS]
        self.assertEqual(counts, [8, 9, 10])
        ids = [s.id for s in suite.select(streams, "stress", only="GOF-*a")]
        self.assertEqual(ids, ["GOF-0001a", "GOF-0002a", "GOF-0007a", "GOF-0008a"])
        self.assertEqual(suite.select(streams, profile="main"), [])
        code, _, errors = self.run_here("--decoder", "true", "--suite", self.copy, "--only", "X")
        self.assertEqual(code, 64)
        self.assertIn("no stream of this tier", errors)


class Expectations(JudgeTest):
    """Tests the contents of sidecars."""

    def test_expectations_are_those_of_rlpcdec(self):
        for path in sorted(self.suite.glob("*/*/*.rlpc")):
            with self.subTest(path=path.name):
                expected = expectation.expectation_of(path.read_bytes(), PROGRAM)
                for form, key in (("rlpd", "sha256_int"), ("f32", "sha256_f32")):
                    out = self.folder / f"{path.stem}.{form}"
                    done = subprocess.run([Tools.folder / "rlpcdec", "decode", path, out],
                                          capture_output=True, text=True, check=False)
                    code = {"accept": 0, "reject": 1, "unsupported": 2}[expected["expect"]]
                    self.assertEqual(done.returncode, code)
                    if key in expected:
                        digest = rlpd.file_sha256(out) if out.exists() else None
                        self.assertEqual(digest, expected[key])
                if code:
                    verdict = json.loads(done.stderr.splitlines()[-1].split(" ", 1)[1])
                    self.assertEqual((verdict["rule"], verdict["frame"]),
                                     (expected["rule"], expected["frames_before"]))

    def test_frame_hashes_are_those_of_the_bytes(self):
        data = b"RLPD" + struct.pack("<10i", 1, 2, 1, 3, 30, 1, 0, 0, 0, 0) + bytes(12)
        frames = [struct.pack("<6i", *range(f, f + 6)) for f in range(3)]
        digest = rlpd.Digest(with_f32=True)
        for byte in data + b"".join(frames):  # one by one
            digest.feed(bytes([byte]))
        self.assertIsNone(digest.complaint())
        self.assertEqual(digest.frame_sha256, [hashlib.sha256(f).hexdigest() for f in frames])
        self.assertEqual(digest.sha256(), hashlib.sha256(data + b"".join(frames)).hexdigest())
        digest.feed(b"?")
        self.assertIn("within frame 3", digest.complaint())

    def test_floats_round_once_and_overflow_to_infinity(self):
        largest = (1 << 24) - 1  # times 2^104: the largest binary32
        inf = math.inf
        for step, value, expected in (
                (0, (1 << 25) + 1, 33554432.0), (0, (1 << 25) + 3, 33554436.0),
                (104, largest, largest * 2.0 ** 104), (104, 1 << 24, inf),
                (103, 2 * largest + 1, inf), (103, -2 * largest - 1, -inf),
                (102, 4 * largest + 1, largest * 2.0 ** 104),
                (-150, 1, 0.0), (-150, 3, 2.0 ** -148), (-149, 1, 2.0 ** -149)):
            with self.subTest(step=step, value=value):
                data = rlpd.f32_bytes([5, 0, -7], step, [value - 5, value, value + 7])
                self.assertEqual(struct.unpack("<3f", data), (expected,) * 3)

    def test_nonsense_of_a_decoder_takes_no_memory(self):
        digest = rlpd.Digest()
        digest.feed(b"RLPD" + struct.pack("<10I", 1, 0xFFFFFFFF, 0, 1, 1, 1, 0, 0, 0, 0))
        for _ in range(64):
            digest.feed(bytes(1 << 20))
        self.assertLess(len(digest._rest), 16)
        self.assertIsNotNone(digest.complaint())

    def test_sidecars_have_the_form_of_the_schema(self):
        data = (self.suite / "reject/HSH/HSH-0001x1.rlpc").read_bytes()
        about = sidecar("HSH-0001x1", data)
        schema.check(about, schema.load("sidecar"))
        suite.check_sidecar(about, pathlib.Path("x"))
        self.assertEqual((about["rule"], about["frames_before"]), ("R-HSH-02", 2))


if __name__ == "__main__":
    main()
