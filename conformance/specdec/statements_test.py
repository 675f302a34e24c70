#!/usr/bin/env python3
"""Tests that statements of the specification about its pseudo-code are true.

    statements_test.py [unittest arguments, such as Statements]
"""

import ast
import contextlib
import copy
import io
import itertools
import pathlib
import random
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import spec_program
import specdec
from specdec_testing import (CRC_BYTES, PROGRAM, ROOT, UNIT_HEADER_BYTES,
                             coarse_mesh, stream_of, units_of)

END_OF_SEQUENCE, SLICE, GOF_INDEX, GOF_HASH = 5, 6, 129, 130
MAIN = ROOT / "streams" / "v1.1" / "accept"
HIGH = ROOT / "streams" / "v1.2" / "accept"


class Poison:
    """Takes part in no arithmetic and no comparison."""

    __hash__ = None

    def _refuse(self, *_):
        raise AssertionError("a stale variable was read")

    __eq__ = __lt__ = __gt__ = __bool__ = __len__ = __iter__ = __getitem__ = __index__ = _refuse
    __add__ = __radd__ = __sub__ = __rsub__ = __mul__ = __rmul__ = __floordiv__ = _refuse
    __mod__ = __lshift__ = __rlshift__ = __rshift__ = __and__ = __or__ = __le__ = __ge__ = _refuse


def prose(name):
    return " ".join((ROOT / "spec" / name).read_text(encoding="utf-8").split())


def state_of(variables):
    """A copy of the variables, without functions and what is given from outside."""
    return {name: copy.deepcopy(value) for name, value in variables.items()
            if spec_program.is_global(name) and isinstance(value, (int, list))
            and name != "StreamBytes"}


class Statements(unittest.TestCase):
    """Sentences of clauses 4 to 9."""

    def calls(self):
        return {name: {part.func.id for part in ast.walk(tree) if isinstance(part, ast.Call)
                       and isinstance(part.func, ast.Name)} & set(PROGRAM.functions)
                for name, (tree, _) in PROGRAM.functions.items()}

    def reached(self, calls, roots, without=()):
        found, ahead = set(), list(roots)
        while ahead:
            name = ahead.pop()
            if name not in found and name not in without:
                found.add(name)
                ahead += calls[name]
        return found

    def test_which_functions_call_themselves(self):
        calls = self.calls()
        found = {name for name in calls if name in self.reached(calls, calls[name])}
        stated = re.search(
            r"A function can call itself\. Only (\w+)\( \) \([\d.]+\) and (\w+)\( \)",
            prose("04-conventions.md"))
        self.assertEqual(found, set(stated.groups()))
        v = PROGRAM.compile({"StreamBytes": b""})
        for name, clean in {"AddParallelogram": {"Parallelograms": [[]] * 9},
                            "IsBarred": {"Valence": [20, 13, 20]}}.items():
            v.update(clean)
            depth, inner = [0, 0], v[name]

            def counted(*arguments):
                depth[0] += 1
                depth[1] = max(depth)
                result = inner(*arguments)
                depth[0] -= 1
                return result

            v[name] = counted
            v[name](*(0, 1, 5, 3)[:inner.__code__.co_argcount])
            self.assertEqual(depth[1], 2, name)

    def test_names_that_serve_several_kinds_of_gof(self):
        calls = self.calls()
        cluster = self.set_in(self.reached(calls, {"clusters_of_gof", "DecodeGof"},
                                           {"DecodeBones", "DecodeFrames"}))
        skinned = self.set_in(self.reached(calls, {"bones_of_gof", "slice_unit", "DecodeBones"}))
        inter = self.set_in(self.reached(calls, {"frames_of_gof", "frame_unit", "DecodeFrames"}))
        annex = (ROOT / "spec" / "annex-e-state.md").read_text(encoding="utf-8")
        tables, stated = annex.split("## E.3")
        shared = {name for life, names in re.findall(r"^\| ([^|]+) \|.*\| ([^|]+) \|$", tables,
                                                     re.MULTILINE)
                  if not re.match("the stream|a section|a GOF, from its last slice", life)
                  for name in names.split(", ")}
        for paragraph, several in zip(stated.split("\n\n")[1:],
                                      (cluster & skinned, skinned & inter)):
            names = paragraph.split(" are used in ")[0].replace(" and ", ", ")
            self.assertEqual(set(re.split(r",\s+", names)), several & shared)

    def set_in(self, functions):
        return {part.id for name in functions for part in ast.walk(PROGRAM.functions[name][0])
                if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store)
                and spec_program.is_global(part.id)}

    def test_gofs_without_slices(self):
        for path in sorted(MAIN.glob("BON/*.rlpc")) + sorted(MAIN.glob("LAY/*.rlpc")):
            data = path.read_bytes()
            kept = [(kind, payload) for kind, payload in units_of(data)
                    if kind not in (SLICE, GOF_INDEX, GOF_HASH, END_OF_SEQUENCE)]
            cut = stream_of(data, kept + [(END_OF_SEQUENCE, bytes(4))])
            decoder = specdec.Decoder(PROGRAM, cut, io.BytesIO().write)
            decoder.call("stream")
            v = decoder.variables
            count = v["NumVertices"]
            self.assertEqual(v["NumOutputFrames"], v["NumFrames"], path)
            self.assertEqual(v["BonesOfVertex"], [[0]] * count, path)
            self.assertEqual(v["WeightsOfVertex"], [[1 << v["weight_bits"]]] * count, path)
            self.assertEqual(v["SpatialFactors"], [[0] * count] * 3, path)
            self.assertEqual(v["NumTrajectories"], 0, path)

    def test_positions_given_as_numbers(self):
        path = next(MAIN.glob("BON/*.rlpc"))
        places = {}
        decoder = specdec.Decoder(PROGRAM, path.read_bytes(), io.BytesIO().write,
                                  lambda place, name, _: places.setdefault(name, place))
        decoder.call("stream")
        self.assertEqual(places["version_minor"], 72)
        self.assertEqual(places["index_distance"] + 32 + 8 * CRC_BYTES,
                         8 * path.stat().st_size)
        self.assertEqual(UNIT_HEADER_BYTES + 4 + CRC_BYTES, 13)

    def test_which_rule_a_version_breaks(self):
        data = next(MAIN.glob("BON/*.rlpc")).read_bytes()
        header = units_of(data)[0][1]
        for minor, profile, rule, read in ((3, 0, "R-STR-03", False), (3, 4, "R-STR-03", False),
                                           (2, 1, "R-STR-03", True), (2, 3, "R-HDR-01", True),
                                           (1, 0, "R-STR-03", True), (1, 2, "R-HDR-01", True),
                                           (0, 1, "R-HDR-01", True)):
            units = [(1, bytes([profile]) + header[1:])] + units_of(data)[1:]
            changed = stream_of(data[:9] + bytes([minor]), units)
            decoder = specdec.Decoder(PROGRAM, changed, None)
            with self.assertRaises(specdec.Verdict) as ended:
                decoder.call("stream")
            self.assertEqual(ended.exception.rule, rule, (minor, profile))
            self.assertEqual("profile_idc" in decoder.variables, read, (minor, profile))
            if rule == "R-STR-03":
                self.assertEqual(decoder.place()[0], 72)

    def bins_of(self, number, shift):
        """(whether it has a model, bin) of a residual, in the order of the list in 9.5.1."""
        upper, lower = abs(number) >> shift, abs(number) % (1 << shift)
        bins = [(True, 1)] * min(upper, 14) + [(True, 0)] * (upper < 14)
        if upper >= 14:
            n = (upper - 14 + 1).bit_length() - 1
            bins += [(False, 1)] * n + [(False, 0)] * (n < 27)
            bins += [(False, (upper - 14 + 1) >> k & 1) for k in reversed(range(n))]
        if shift > 0:
            bins.append((True, lower >> (shift - 1)))
            bins += [(False, lower >> k & 1) for k in reversed(range(shift - 1))]
        return bins + [(False, number < 0)] * (number != 0)

    def test_bins_of_a_residual(self):
        v = PROGRAM.compile({"StreamBytes": b""})
        r = random.Random(9)
        for _ in range(2000):
            expected = r.randrange(1 << r.randrange(1, 24))
            number = r.choice((1, -1)) * r.randrange(1 << r.randrange(29))
            bins = self.bins_of(number, v["ResidualContext"](expected)[1])

            def take(modelled):
                self.assertEqual(bins[0][0], modelled)
                return int(bins.pop(0)[1])

            v["ae"] = lambda _: take(True)
            v["bypass"] = lambda n: sum(take(False) << k for k in reversed(range(n)))
            self.assertEqual(v["ae_residual"](v["ResidualModels"](), expected), number)
            self.assertEqual(bins, [])


class CoarseMeshes(unittest.TestCase):
    """Tests the statements of 8.9.8."""

    def decoded(self, data):
        """The variables of a decoder that has decoded a stream, the (name, value) of its syntax
        elements, and its frames in decoded order."""
        elements, frames = [], []
        decoder = specdec.Decoder(PROGRAM, data, io.BytesIO().write,
                                  lambda _, name, value: elements.append((name, value)))
        v = decoder.variables
        output_frame = v["OutputFrame"]
        v["OutputFrame"] = lambda: (frames.append(list(v["Positions"])), output_frame())
        decoder.call("stream")
        return v, elements, frames

    def first_group(self, elements):
        """The fewest layers that a first layer group has before another."""
        sizes, at_first = [], False
        for name, value in elements:
            if name == "num_layer_groups_minus1":
                at_first = True
            elif name == "layer_group_layers_minus1" and at_first:
                sizes.append(value + 1)
                at_first = False
        return min(sizes, default=0)

    def without_higher_groups(self, data, elements):
        """The stream without the slices of all layer groups but the first; how many it loses."""
        groups, units = [], []
        for name, value in elements:
            if name == "component_group_idx":
                groups.append(0)
            elif name == "layer_group_idx":
                groups[-1] = value
        lost = sum(group > 0 for group in groups)
        for kind, payload in units_of(data):
            if kind in (GOF_INDEX, GOF_HASH) or (kind == SLICE and groups.pop(0) > 0):
                continue
            units.append((kind, bytes(4) if kind == END_OF_SEQUENCE else payload))
        return stream_of(data, units), lost

    def test_slices_of_higher_layer_groups_are_not_needed(self):
        lost, coarser = 0, 0
        for path in sorted([*MAIN.glob("LAY/*.rlpc"), *MAIN.glob("SLI/*.rlpc"),
                            *HIGH.glob("ADW/*.rlpc"), *HIGH.glob("MDL/*.rlpc"),
                            *HIGH.glob("RST/*.rlpc"), *HIGH.glob("TPL/*.rlpc")]):
            data = path.read_bytes()
            v, elements, frames = self.decoded(data)
            layers = self.first_group(elements)
            if layers == 0 or len(data) > 20000:
                continue
            cut, count = self.without_higher_groups(data, elements)
            lost += count > 0
            fewer = self.decoded(cut)[2]
            vertices, _ = coarse_mesh(v, layers)
            coarser += len(vertices) < v["NumVertices"]
            self.assertEqual(len(frames), len(fewer))
            for whole, part in zip(frames, fewer):
                for u in vertices:
                    self.assertEqual(whole[3 * u:3 * u + 3], part[3 * u:3 * u + 3], path)
        self.assertGreater(lost, 10)
        self.assertGreater(coarser, 10)

    def test_the_triangles(self):
        meshes = 0
        for path in sorted(MAIN.glob("LAY/*.rlpc")):
            v = self.decoded(path.read_bytes())[0]
            plain = [t for t in v["Triangles"] if v["AreDifferent"](t)]
            v["MakeLayers"]()
            count, layer = v["NumLayers"], v["LayerOfVertex"]
            self.assertLessEqual(len(v["RestTriangles"]), 6 * len(plain))
            self.assertEqual(coarse_mesh(v, count), (list(range(v["NumVertices"])), plain))
            for layers in range(1, count):
                vertices, triangles = coarse_mesh(v, layers)
                self.assertEqual(vertices, [u for u, k in enumerate(layer) if k < layers])
                self.assertLessEqual({u for t in triangles for u in t}, set(vertices))
                self.assertTrue(all(v["AreDifferent"](t) for t in triangles))
                meshes += 1
        self.assertGreater(meshes, 20)


class Access(unittest.TestCase):
    """Random access (8.8) to the GOFs of a stream."""

    def open(self, path):
        self.data = path.read_bytes()
        v = self.decoder()
        self.assertEqual(v["LocateGofs"](), 1)
        self.index = {name: v[name] for name in ("IndexOffset", "IndexFrame", "RigIndexOffset",
                                                 "RigIndexIdx")}
        self.gofs = range(len(v["IndexOffset"]))

    def decoder(self):
        """The variables of a decoder that has run leading_units( )."""
        self.output = io.BytesIO()
        v = specdec.Decoder(PROGRAM, self.data, self.output.write).variables
        gof_units = v["gof_units"]
        v["gof_units"] = lambda: v["require"](0, "the GOFs are left")
        with contextlib.suppress(specdec.Verdict):
            v["stream"]()
        v["gof_units"] = gof_units
        return v

    def random_access(self, v, gof):
        self.output.seek(0)
        self.output.truncate()
        v.update(self.index)
        v["DecodeRigs"](v["IndexOffset"][gof])
        v.update(BitPosition=8 * v["IndexOffset"][gof], NumParsedFrames=v["IndexFrame"][gof],
                 NumOutputFrames=0)
        v["unit_header"]()
        v["CheckUnitType"](v["UnitCode"] == v["GOF"])
        v["access_unit"]()
        return self.output.getvalue()


class RandomAccess(Access):
    """It gives the frames of decoding in order, or finds what is wrong with the index."""

    def test_frames_are_those_of_decoding_in_order(self):
        for path in (MAIN / "MIX" / "MIX-0202a.rlpc", HIGH / "MDL" / "MDL-0012a.rlpc"):
            self.open(path)
            whole = io.BytesIO()
            specdec.Decoder(PROGRAM, self.data, whole.write).call("stream")
            frames = [self.random_access(self.decoder(), g) for g in self.gofs]
            self.assertGreater(len(frames), 1)
            self.assertTrue(all(frames))
            self.assertTrue(whole.getvalue().endswith(b"".join(frames)), path)

    def test_which_shared_rigs_are_decoded(self):
        self.open(HIGH / "MDL" / "MDL-0012a.rlpc")
        v = self.decoder()
        v.update(self.index)
        offsets, found = self.index["RigIndexOffset"], []
        rig = v["rig"]
        v["rig"] = lambda: (found.append(v["UnitStart"]), rig())
        for gof in self.gofs:
            found.clear()
            end = self.index["IndexOffset"][gof]
            v["DecodeRigs"](end)
            latest = {self.index["RigIndexIdx"][m]: o for m, o in enumerate(offsets) if o < end}
            self.assertEqual(found, sorted(latest.values()))
            self.assertEqual([m for m, kept in enumerate(v["SharedRigs"]) if kept], sorted(latest))
        self.assertGreater(len(offsets), len(found))  # one is replaced

    def test_wrong_lists_of_shared_rigs(self):
        for number, rule in ((1, "R-MOD-01"), (2, "R-IDX-05"), (3, "R-IDX-06"), (4, "R-UNT-05"),
                             (5, "R-IDX-02")):
            path = HIGH.parent / "either" / "MDL" / f"MDL-0012x{number}.rlpc"
            with self.assertRaises(specdec.Verdict) as ended:
                self.open(path)
                for gof in self.gofs:
                    self.random_access(self.decoder(), gof)
            self.assertEqual(ended.exception.rule, rule, path)


class Aborted(Access):
    """Another GOF after an error in one (8.8)."""

    STREAM = MAIN / "MIX" / "MIX-0202a.rlpc"
    FUNCTIONS = ("EndSection", "CheckOverrun", "gof_hash", "UpdateTrackContext")

    def setUp(self):
        self.open(self.STREAM)
        self.expected = [self.random_access(self.decoder(), g) for g in self.gofs]
        self.assertGreater(len(self.expected), 1)

    def abort(self, v, gof, function):
        """Decodes a GOF, or the index, to the first call of this function; whether there is one."""
        whole, called = v[function], []

        def end(*_):
            called.append(True)
            raise specdec.Verdict(specdec.INVALID, "R-RNG-01")

        v[function] = end
        with contextlib.suppress(specdec.Verdict):
            self.random_access(v, gof) if gof is not None else v["LocateGofs"]()
        v[function] = whole
        return bool(called)

    def poison(self, v, before):
        for name, value in state_of(v).items():
            if name not in before or before[name] != value:
                v[name] = Poison()

    def test_what_has_to_be_fresh(self):
        stated = re.search(r"once ReadEnd has been set to 8 · len\( StreamBytes \), and "
                           r"(\w+), (\w+) and (\w+) to 0", prose("08-decoding.md"))
        fresh = {"ReadEnd": 8 * len(self.data), **dict.fromkeys(stated.groups(), 0)}
        for function, aborted in [(f, self.gofs) for f in self.FUNCTIONS] + [("gof_index", [None])]:
            aborts = 0
            for gof, wanted in itertools.product(aborted, self.gofs):
                v = self.decoder()
                before = state_of(v)
                aborts += self.abort(v, gof, function)
                self.poison(v, before)
                v.update(fresh)
                self.assert_stray_units_are_skipped(v)
                self.assertEqual(self.random_access(v, wanted), self.expected[wanted], function)
            self.assertGreater(aborts, 0, function)

    def assert_stray_units_are_skipped(self, v):
        for code in ("GOF_HASH", "GOF_INDEX"):
            v.update(UnitCode=v[code], BitPosition=96, ElementPosition=96)
            v["unit_payload"]()
            self.assertEqual((v["BitPosition"], v["Position"]()), (96, 96))

    def test_a_stale_variable_shows(self):
        v = self.decoder()
        before = state_of(v)
        self.assertTrue(self.abort(v, 0, "EndSection"))
        self.poison(v, before)
        with self.assertRaisesRegex(AssertionError, "stale"):
            self.random_access(v, 1)


class AbortedTracks(Aborted):
    """The same with shared rigs."""

    STREAM = HIGH / "MDL" / "MDL-0012a.rlpc"
    FUNCTIONS = (*Aborted.FUNCTIONS, "StartVertices", "LoadRig", "StartTracks")


if __name__ == "__main__":
    unittest.main()
