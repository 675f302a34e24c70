#!/usr/bin/env python3
"""Streams of the supplements show the mistakes that they are for, seeded into the specification.

    supplement_test.py [unittest arguments, such as SingleFaults]

scripts/mutate seeds the same mistakes into rlpcdec.
"""

import ast
import json
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "specdec"))
import spec_program
import specdec
import zlib_faults

SPEC = HERE.parents[1] / "spec"
PROGRAM = spec_program.Program(SPEC)
SIDECARS = [json.loads(path.read_text(encoding="utf-8")) | {"path": path.with_suffix(".rlpc")}
            for folder in ("v1.0s1", "v1.1s2")
            for path in sorted((SPEC.parent / "streams" / folder).glob("reject/*/*.json"))]

# Too much for the pseudo-code to decode: 2^17 vertices, 2^18 triangles, 2^22 values and more.
LARGE = ("R-LVL-01", "R-LVL-02", "R-LVL-05")
LARGE_STREAMS = ("LVL-0316x1", "LVL-0326x1", "LVL-0336x1", "LVL-0346x1", "LVL-0346x3")
# Results allowed for a decoder without the check if the pseudo-code cannot go on.
INSTEAD = {
    "R-GOF-08": "def AddToCluster(v, cluster):\n"
                "    if cluster == NumClusters:\n        cluster = cluster - 1\n"
                "    ClusterOfVertex[v] = cluster\n"
                "    PlaceOfVertex[v] = len(ClusterVertices[cluster])\n"
                "    ClusterVertices[cluster].append(v)\n",
    "R-GOF-11": "def ClipSigned(bits, x):\n    if bits == 0:\n        return 0\n"
                "    return Clip3(-(1 << (bits - 1)), (1 << (bits - 1)) - 1, x)\n",
}
INSTEAD["R-GOF-12"] = INSTEAD["R-GOF-11"]


def data_of(sidecar):
    return sidecar["path"].read_bytes()


class Decoder(specdec.Decoder):
    """The specification with a mistake: replaced functions {name: tree}; a rule not checked."""

    def __init__(self, data, other=None, rule=None):
        super().__init__(PROGRAM, data, lambda output: None)
        self._rule = rule
        code = PROGRAM.code() if not other else PROGRAM.code(transform=lambda functions: {
            name: (other.get(name, tree), clause) for name, (tree, clause) in functions.items()})
        self.variables = spec_program.run(code, {
            "StreamBytes": data, "require": self._unless, "supported": self._unless,
            "inflates_to": self._inflates_to, "output_bytes": lambda output: None,
            "output_attributes": lambda output: None})

    def _unless(self, condition, rule):
        if not condition and rule != self._rule:
            raise specdec.Verdict(specdec.INVALID, rule)

    def rule(self):
        """The rule that the stream breaks, or None."""
        try:
            self.call("stream")
        except specdec.Verdict as verdict:
            return verdict.rule
        return None


class SingleFaults(unittest.TestCase):
    """The stream is decoded to its end if one rule is not checked."""

    def test_nothing_else_is_wrong(self):
        tried = 0
        for sidecar in SIDECARS:
            rule = sidecar["rule"]
            if ("single-fault" not in sidecar["features"] or rule in LARGE
                    or sidecar["id"] in LARGE_STREAMS):
                continue
            instead = {n.name: n for n in ast.parse(INSTEAD.get(rule, "")).body}
            with self.subTest(sidecar["id"]):
                self.assertIsNone(Decoder(data_of(sidecar), instead, rule).rule())
            tried += 1
        self.assertGreaterEqual(tried, 30)


class _WithoutOverrun(ast.NodeTransformer):
    def visit_Expr(self, node):
        return ast.Pass() if ast.unparse(node) == "CheckOverrun()" else node


class Overruns(unittest.TestCase):
    """Another rule is broken first if CheckOverrun( ) is left out."""

    STREAMS = {"RC-0302x1": "connectivity_section", "RC-0302x2": "connectivity_section",
               "RC-0303x1": "cluster_headers", "RC-0303x2": "cluster_map",
               "RC-0303x3": "seed_tracks", "RC-0303x4": "components",
               "RC-0402x1": "bone_section", "RC-0402x2": "slice_section",
               "RC-0402x3": "group_components"}

    def test_another_rule_is_broken(self):
        sidecars = {s["id"]: s for s in SIDECARS}
        for stream, function in self.STREAMS.items():
            tree = ast.parse(ast.unparse(PROGRAM.functions[function][0])).body[0]
            tree = ast.fix_missing_locations(_WithoutOverrun().visit(tree))
            with self.subTest(stream):
                data = data_of(sidecars[stream])
                self.assertEqual(Decoder(data).rule(), "R-RNG-01")
                self.assertNotIn(Decoder(data, {function: tree}).rule(), (None, "R-RNG-01"))


class Inflating(unittest.TestCase):
    """Each damaged zlib stream has one fault, and inflates if that is not checked."""

    FAULTS = ("check sum", "header check", "method", "window size", "dictionary", "dictionary",
              "stored length", "distance too far", "block type", "absent distance code",
              "first repeat", "repeat past end", "length symbol", "distance symbol", "code lengths")

    def test_each_fault_has_a_stream(self):
        for number, fault in enumerate(self.FAULTS, 1):
            sidecar = next(s for s in SIDECARS if s["id"] == f"MET-0301x{number}")
            decoder = Decoder(data_of(sidecar))
            asked = []
            decoder.variables["inflates_to"] = lambda *place: asked.append(place) or 0
            self.assertEqual(decoder.rule(), "R-MET-02")
            first, end, size = asked[0]
            deflated = data_of(sidecar)[first:end]
            with self.subTest(sidecar["title"]):
                with self.assertRaisesRegex(zlib_faults.Fault, f"^{fault}$"):
                    zlib_faults.Inflater(deflated).inflate()
                without = {fault, "dictionary id"} if number == 6 else {fault}
                self.assertEqual(len(zlib_faults.Inflater(deflated, without).inflate()), size)


if __name__ == "__main__":
    unittest.main()
