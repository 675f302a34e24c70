#!/usr/bin/env python3
"""The judge of encoders, judged: encoders with one fault each.

    encode_test.py --bin BUILD/bin [unittest arguments, such as Encoders]
"""

import json
import os
import pathlib
import shlex
import sys

from judge_testing import INPUTS, JudgeTest, Tools, main
import encoder_checks
import schema

# The contract's form, with a fault: FAULT encode MESH POINTS OUT --max-error X.
FAULTY = '''
import os, pathlib, signal, struct, subprocess, sys
fault, verb, mesh, points, out, option, error = sys.argv[1:]
assert (verb, option) == ("encode", "--max-error")
mesh, points, options = pathlib.Path(mesh), pathlib.Path(points), ["--keep-order"]
if fault == "other_order":
    options = []
if fault == "error_too_large":
    error = str(float(error) * 8)
if fault == "frame_too_few":
    data = points.read_bytes()
    frames, size = struct.unpack_from("<i", data, 28)[0], 12 * struct.unpack_from("<i", data, 16)[0]
    points = pathlib.Path("cut.pc2")
    points.write_bytes(data[:28] + struct.pack("<i", max(1, frames - 1)) + data[32:-size])
if fault == "turned_triangles":
    lines = mesh.read_text().splitlines()
    lines = [" ".join(["f"] + l.split()[:0:-1]) if l[:2] == "f " else l for l in lines]
    mesh = pathlib.Path("turned.obj")
    mesh.write_text("\\n".join(lines) + "\\n")
if fault == "crash":
    os.kill(os.getpid(), signal.SIGSEGV)
subprocess.run([os.environ["RLPCENC"], mesh, "--points", points, "-o", out, "--max-error", error,
                "--preset", "fast", "-q", *options], check=True)
if fault == "no_output":
    os.unlink(out)
if fault == "garbage":
    pathlib.Path(out).write_bytes(pathlib.Path(out).read_bytes()[:-1] + b"?")
sys.exit(3 if fault == "exit_code" else 0)
'''


class Encoders(JudgeTest):
    """Each fault is detected, and all other checks still pass."""

    @classmethod
    def setUpClass(cls):
        """No suite is needed."""

    def setUp(self):
        self.kept = pathlib.Path("/nonexistent")
        super().setUp()
        os.environ["RLPCENC"] = str(Tools.folder / "rlpcenc")
        (self.folder / "faulty.py").write_text(FAULTY)

    def judge_encoder(self, encoder, *args):
        if "--validator" not in args:
            args = (*args, "--validator", "none")
        path = self.folder / "report.json"
        path.unlink(missing_ok=True)
        code, text, errors = self.command("encode", "--encoder", encoder, "--reference",
                                          Tools.folder / "rlpcdec", "--frames", "3", "--json", path,
                                          *args)
        return code, json.loads(path.read_text()) if path.exists() else None, text + errors

    def faulty(self, fault):
        return shlex.join([sys.executable, str(self.folder / "faulty.py"), fault])

    def draws(self, fault, outcome, *args):
        with self.subTest(fault=fault):
            code, report, text = self.judge_encoder(self.faulty(fault), "--only", "curtain-*",
                                                    *args)
            self.assertIsNotNone(report, text)
            schema.check(report, schema.load("report"))
            outcomes = {row["outcome"] for row in report["rows"]}
            self.assertEqual((code, outcomes), (0 if outcome == "PASS" else 1, {outcome}), text)
            return report

    def test_good_encoder(self):
        report = self.draws("none", "PASS", "--validator", "true")
        self.assertEqual({g["status"] for g in report["grades"]}, {"PASS"})
        self.assertEqual([g["of"] for g in report["grades"]], [3] * 5)

    def test_not_validated_is_not_valid(self):
        report = self.draws("none", "PASS")
        self.assertEqual({g["grade"]: g["status"] for g in report["grades"]}["valid"], "NOT RUN")

    def test_the_verdict_of_the_validator_counts(self):
        self.draws("none", "FAIL-valid", "--validator", "false")

    def test_validator_is_found_beside_the_encoder(self):
        encode = shlex.join([sys.executable, str(self.folder / "faulty.py"), "none"])
        for name, script in (("myenc", f'{encode} "$@"'), ("rlpcval", "exit 9")):
            path = self.folder / name
            path.write_text(f"#!/bin/sh\n{script}\n")
            path.chmod(0o755)
            code, text, errors = self.command("encode", "--encoder", self.folder / "myenc",
                                              "--only", "curtain-still", "--reference",
                                              Tools.folder / "rlpcdec")
            self.assertIn("no rlpcval next to" if name == "myenc" else "validator: exit code 9",
                          text + errors)
            self.assertEqual(code, 64 if name == "myenc" else 1)

    def test_faults(self):
        self.draws("crash", "CRASH")
        self.draws("exit_code", "FAIL-encodes")
        self.draws("no_output", "FAIL-encodes")
        self.draws("garbage", "FAIL-decodes")
        self.draws("turned_triangles", "FAIL-mesh")
        self.draws("other_order", "FAIL-mesh")
        self.draws("frame_too_few", "FAIL-mesh", "--only", "curtain-fine")
        report = self.draws("error_too_large", "FAIL-error", "--only", "curtain-fine")
        self.assertIn("asked for at most", report["rows"][0]["text"])

    def test_templates_with_an_order_file(self):
        template = (f"{Tools.folder}/rlpcenc {{mesh}} --points {{points}} -o {{out}} --max-error "
                    "{error} -q --preset fast")
        code, _, text = self.judge_encoder(template + " --order-map {order}", "--only", "robot*")
        self.assertEqual(code, 0, text)
        code, report, text = self.judge_encoder(template + " --metadata {order}", "--only",
                                                "robot_arm-still")
        self.assertEqual(code, 1, text)
        code, _, text = self.judge_encoder("true {mesh} {out}")
        self.assertEqual(code, 64)
        self.assertIn("{points}, {error}", text)

    def test_specdec_is_the_default_and_cases_are_kept(self):
        path = self.folder / "kept"
        code, text, errors = self.command("encode", "--encoder", self.faulty("none"), "--frames",
                                          "2", "--only", "curtain-coarse", "--keep", path,
                                          "--validator", "none")
        self.assertEqual(code, 0, text + errors)
        self.assertTrue((path / "curtain-coarse" / "out.rlpc").is_file())
        code, _, errors = self.command("encode", "--encoder", self.faulty("none"), "--only",
                                       "curtain-coarse", "--keep", path, "--validator", "none")
        self.assertEqual(code, 4)
        self.assertIn("not empty", errors)

    def test_cases_come_from_the_inputs(self):
        cases = encoder_checks.cases_of(INPUTS, 5)
        self.assertEqual(len(cases), 9)
        self.assertEqual({c.animation.num_frames for c in cases}, {1, 5})
        code, _, errors = self.command("encode", "--encoder", "true", "--inputs", self.folder)
        self.assertEqual(code, 64)
        (self.folder / "a.obj").write_text("f 1 2 x\n")
        (self.folder / "a.pc2").write_bytes(b"POINTCACHE2\0" + bytes(20))
        code, _, errors = self.command("encode", "--encoder", "true", "--inputs", self.folder)
        self.assertEqual(code, 4)
        self.assertIn("a.obj:1", errors)


if __name__ == "__main__":
    main()
