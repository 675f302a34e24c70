#!/usr/bin/env python3
"""rlpcgen: recipes, damage, random streams, and the way back to recipes.

    rlpcgen_test.py --bin BUILD/bin [unittest arguments, such as Recipes]
"""

import argparse
import hashlib
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "judge"))
import decompile
import expectation
import mesh_gates
import random_high
import range_writer
import recipe as recipes
import recipe_source
import specdec
import stress
import suite
import suite_streams

HERE = pathlib.Path(__file__).resolve().parent
SPEC = HERE.parents[1] / "spec"
PROGRAM = specdec.program_of(SPEC)
BUILDER = recipe_source.StreamBuilder(PROGRAM)
BIN = None

TETRAHEDRON = """title: A tetrahedron
unit SEQUENCE_HEADER
  num_vertices_minus1 = 3
  num_triangles = 4
unit CONNECTIVITY
  mesh = tetrahedron
unit GOF
  lcf_flag = 1
  seed_vertex = 0 1 2
  seed_residual = 10 0 0 5 7 0 1 2 3
  num_components = 1
  component 0
    spatial_residual = 3 -4 5
    temporal_residual = 9
unit GOF_HASH
unit END_OF_SEQUENCE
"""


def build(text):
    return BUILDER.build(recipes.parse("test", text, None))[0]


def expected(data):
    return expectation.expectation_of(data, PROGRAM)


class Recipes(unittest.TestCase):
    """Tests that streams have the values of their recipes."""

    def breaks(self, rule, text):
        found = expected(build(text))
        self.assertEqual(found.get("rule"), rule, found)

    def changed(self, old, new):
        self.assertIn(old, TETRAHEDRON)
        return TETRAHEDRON.replace(old, new)

    def refuses(self, complaint, text):
        with self.assertRaises(recipes.RecipeError) as raised:
            build(text)
        self.assertIn(complaint, str(raised.exception))

    def test_a_stream_decodes_to_what_the_recipe_says(self):
        found = expected(build(TETRAHEDRON))
        self.assertEqual((found["expect"], found["frames"]), ("accept", 1))

    def test_values_repeat_and_are_counted(self):
        series = build(self.changed("10 0 0 5 7 0 1 2 3", "3*4 6 ..."))
        self.assertEqual(series, build(self.changed("10 0 0 5 7 0 1 2 3", "4 4 4 6*6")))
        self.assertNotEqual(series, build(self.changed("10 0 0 5 7 0 1 2 3", "4 4 4 6")))

    def test_an_index_comes_before_the_rest(self):
        self.assertEqual(build(self.changed("10 0 0 5 7 0 1 2 3", "1 ...\n"
                                            "  seed_residual[1] = 8 ...")),
                         build(self.changed("10 0 0 5 7 0 1 2 3", "1 1 1 8 8 8 1 1 1")))

    def test_random_values_depend_on_the_seed_alone(self):
        text = self.changed("10 0 0 5 7 0 1 2 3", "random(-50, 50) ...")
        self.assertEqual(build(text), build(text))
        self.assertNotEqual(build(text), build("seed: 7\n" + text))

    def test_units_repeat_with_other_random_numbers(self):
        hashed = self.changed("10 0 0 5 7 0 1 2 3", "random(-50, 50) ...").replace(
            "unit GOF\n", "unit GOF\n  num_gof_frames_minus1 = 0\n")
        twice = hashed.replace("unit GOF_HASH", "unit GOF_HASH\nrepeat 2 of 2")
        frames = expected(build(twice.replace("num_triangles = 4",
                                              "num_triangles = 4\n  num_frames_minus1 = 1")))
        self.assertEqual((frames["expect"], frames["frames"]), ("accept", 2))
        self.assertEqual(len(set(frames["frame_sha256"])), 2)
        self.assertEqual(frames["frame_sha256"][0], expected(build(hashed))["frame_sha256"][0])
        self.refuses("follows M units", "repeat 2 of 1\n" + TETRAHEDRON)
        self.refuses("follows M units", TETRAHEDRON + "repeat 2 of 6\n")

    def test_any_element_can_be_illegal(self):
        self.breaks("R-HDR-06", self.changed("num_triangles = 4",
                                             "num_triangles = 4\n  position_bits = 25"))
        self.breaks("R-GOF-07", self.changed("seed_vertex = 0 1 2", "seed_vertex = 0 1 1"))
        self.breaks("R-GOF-10", self.changed("component 0", "component 0\n    scale_idx = 128"))
        self.breaks("R-GOF-03", self.changed("lcf_flag = 1", "lcf_flag = 1\n  fraction_bits = 25"))
        self.breaks("R-BIT-04", self.changed("num_triangles = 4", "num_triangles = 8589934591"))

    def test_damage(self):
        gof = "unit GOF\n"
        self.breaks("R-UNT-03", self.changed(gof, gof + "  unit_crc = wrong\n"))
        self.breaks("R-UNT-02", self.changed(gof, gof + "  unit_size = 5000\n"))
        self.breaks("R-RNG-01", self.changed(gof, gof + "  payload_cut = 4\n"))
        self.breaks("R-RNG-01", self.changed(gof, gof + "  payload_append = 00\n"))
        self.breaks("R-RNG-02", self.changed("  mesh = tetrahedron", "  payload = A8FFFFFFFF00"))
        self.breaks("R-BIT-02", self.changed(gof, gof + "  alignment = 1\n"))
        replaced = "  mesh = tetrahedron\n  payload_replaced = A8FFFFFFFF00"
        self.breaks("R-RNG-02", self.changed("  mesh = tetrahedron", replaced))
        self.breaks("R-UNT-02", TETRAHEDRON + "stream\n  cut = 1\n")
        self.breaks("R-BIT-01", TETRAHEDRON + "stream\n  keep = 9\n")
        self.breaks("R-END-02", TETRAHEDRON + "stream\n  append = 00\n")
        self.breaks("R-STR-01", TETRAHEDRON + "stream\n  flip = 3\n")
        self.breaks("R-STR-03", TETRAHEDRON + "stream\n  version_minor = 1\n")

    def test_a_payload_can_stop_where_it_breaks_a_requirement(self):
        many = self.changed("num_components = 1", "num_components = 513")
        stopped = many.replace("num_components = 513", "num_components = 513\n  stop = broken")
        self.breaks("R-GOF-09", stopped)
        self.assertLess(len(build(stopped)), len(build(many)))

    def test_both_ends_of_a_section_decode_alike(self):
        low = build(TETRAHEDRON)
        high = build(self.changed("unit GOF\n", "unit GOF\n  section_end = highest\n"))
        self.assertNotEqual(low, high)
        self.assertEqual(expected(low)["sha256_int"], expected(high)["sha256_int"])

    def test_complaints_name_the_place(self):
        self.refuses("test:3: num_vertices is not a syntax element",
                     self.changed("num_vertices_minus1", "num_vertices"))
        self.refuses("test:8: lcf_flag has values that the unit does not use",
                     self.changed("lcf_flag = 1", "lcf_flag = 1 0"))
        self.refuses("'x' is not a number", self.changed("lcf_flag = 1", "lcf_flag = x"))
        self.refuses("GOFS is not a unit", self.changed("unit GOF\n", "unit GOFS\n"))
        self.refuses("does not fit u(3)",
                     self.changed("lcf_flag = 1", "lcf_flag = 1\n  seed_predictor = 9"))
        self.refuses("not possible on this gate",
                     self.changed("mesh = tetrahedron", "gates = T P C"))
        self.refuses("no operation is left", self.changed("mesh = tetrahedron", "gates = T A"))
        self.refuses("not understood", "what is this\n")

    def test_a_twin_differs_in_what_it_says(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name, "recipes", "GOF")
            folder.mkdir(parents=True)
            (folder / "GOF-0001a.recipe").write_text(TETRAHEDRON)
            twin = folder / "GOF-0001x1.recipe"
            twin.write_text("title: Twin\ntwin: GOF-0001a\nchange 2 GOF\n  seed_vertex = 0 1 0\n"
                            "insert 3 METADATA\n  json = {}\n")
            recipe = recipes.load(twin)
            self.assertEqual([u.name for u in recipe.units],
                             ["SEQUENCE_HEADER", "CONNECTIVITY", "GOF", "METADATA", "GOF_HASH",
                              "END_OF_SEQUENCE"])
            self.assertEqual(expected(BUILDER.build(recipe)[0])["rule"], "R-GOF-07")
            twin.write_text("title: Twin\ntwin: GOF-0001a\nchange 1 GOF\n")
            with self.assertRaises(recipes.RecipeError):
                recipes.load(twin)
            twin.write_text("title: Twin\ntwin: GOF-0002a\n")
            with self.assertRaises(recipes.RecipeError):
                recipes.load(twin)


class Meshes(unittest.TestCase):
    """Gates that follow a list of triangles give these triangles."""

    def gives(self, triangles, extra=""):
        vertices = 1 + max(v for t in triangles for v in t)
        text = (f"unit SEQUENCE_HEADER\n num_vertices_minus1 = {vertices - 1}\n"
                f" num_triangles = {len(triangles)}\nunit CONNECTIVITY\n{extra} triangles = "
                + ", ".join(" ".join(map(str, t)) for t in triangles) + "\n")
        _, writer = BUILDER.build(recipes.parse("test", text, None))
        decoded = [tuple(t) for t in writer.ns["Triangles"]]
        self.assertEqual(len(decoded), len(triangles))
        self.assertEqual(_shape(decoded), _shape(triangles))

    def test_meshes(self):
        for triangles in (mesh_gates.grid(4, 3), mesh_gates.grid(4, 4, 1, 1),
                          mesh_gates.grid(5, 2, 1, 0), mesh_gates.fan(7), mesh_gates.fan(6, 1),
                          mesh_gates.tetrahedron(), mesh_gates.octahedron(),
                          mesh_gates.separate(3, 5)):
            self.gives(triangles)

    def test_fans_that_meet_in_a_vertex(self):
        self.gives([(0, 1, 2), (0, 3, 4)], " vertex_reuse_flag = 1\n")


def _shape(triangles):
    """Properties that do not depend on numbering: numbers of triangles of edges and vertices."""
    count = {}
    for t in triangles:
        for k in range(3):
            count[("v", t[k])] = count.get(("v", t[k]), 0) + 1
            edge = ("e", *sorted((t[k], t[(k + 1) % 3])))
            count[edge] = count.get(edge, 0) + 1
    return sorted((key[0], n) for key, n in count.items())


class RandomTest(unittest.TestCase):
    """Random streams of a profile are legal, and the same for the same seed."""

    def decode_to_the_same(self, profile):
        builder = random_high.builder_of(profile)(PROGRAM)
        with tempfile.TemporaryDirectory() as name:
            stream, output = pathlib.Path(name, "in.rlpc"), pathlib.Path(name, "out.rlpd")
            for seed in self.SEEDS:
                stream.write_bytes(builder.build(seed)[0])
                done = subprocess.run([BIN / "rlpcdec", "decode", stream, output],
                                      capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, f"seed {seed}: {done.stderr}")
                self.assertEqual(hashlib.sha256(output.read_bytes()).hexdigest(),
                                 expected(stream.read_bytes())["sha256_int"], f"seed {seed}")
                self.attributes_are_the_same(stream, seed)

    def attributes_are_the_same(self, stream, seed):
        attributes = expectation.attributes_of(stream.read_bytes(), PROGRAM)
        if attributes is None:
            return
        output = stream.with_name("out.rlpa")
        done = subprocess.run([BIN / "rlpcdec", "decode", stream, output], capture_output=True,
                              text=True)
        self.assertEqual(done.returncode, 0, f"seed {seed}: {done.stderr}")
        self.assertEqual(hashlib.sha256(output.read_bytes()).hexdigest(), attributes,
                         f"seed {seed}")

    def digest(self, profile):
        # STRESS.json has digests by seed, so seeds give the same streams for ever.
        builder = random_high.builder_of(profile)(PROGRAM)
        digest = hashlib.sha256(b"".join(builder.build(seed)[0] for seed in range(20)))
        return digest.hexdigest()[:16]


class Random(RandomTest):
    SEEDS = range(10_000, 10_040)

    def test_both_decoders_decode_them_to_the_same(self):
        self.decode_to_the_same("baseline")

    def test_the_generator_has_not_changed(self):
        self.assertEqual(self.digest("baseline"), "72adb70a7cd93a44")

    def test_carries_run_through_many_bytes(self):
        writer = range_writer.RangeWriter()
        writer.bytes += bytes([7, 255, 255, 255])
        writer.low = 0xFFFFFFFF
        writer.narrow(1, 0)
        self.assertEqual(bytes(writer.bytes), bytes([8, 0, 0, 0]))
        self.assertEqual((writer.low, writer.carries), (0, [4]))


class RandomMain(RandomTest):
    SEEDS = range(10_000, 10_020)

    def test_both_decoders_decode_them_to_the_same(self):
        self.decode_to_the_same("main")

    def test_the_generator_has_not_changed(self):
        self.assertEqual(self.digest("main"), "41e433765803a06c")


class RandomHigh(RandomTest):
    SEEDS = range(10_000, 10_020)

    def test_both_decoders_decode_them_to_the_same(self):
        self.decode_to_the_same("high")

    def test_the_generator_has_not_changed(self):
        self.assertEqual(self.digest("high"), "97293d62a6309782")


class AttributeUnits(unittest.TestCase):
    """Tests attributes in recipes, given and left open (Annex F)."""

    TEXT = TETRAHEDRON.replace("unit GOF", """unit ATTRIBUTES
  attribute_name = uv0 ä
  num_attribute_sets_minus1 = 2
  num_components_minus1 = 1
  prediction_idc = 2
  value_residual = rare(50, 9) ...
unit GOF""")

    def decoded(self, text):
        """(the rule that attributes break or None, variables of the specification)"""
        decoder = specdec.Decoder(PROGRAM, build(text), lambda frames: None,
                                  write_attributes=lambda data: None)
        try:
            decoder.call(specdec.WITH_ATTRIBUTES)
        except specdec.Verdict as verdict:
            return verdict.rule, decoder.variables
        return None, decoder.variables

    def test_names_are_given_or_numbers(self):
        rule, v = self.decoded(self.TEXT)
        self.assertIsNone(rule)
        self.assertEqual([bytes(name).decode() for name in v["SetName"]], ["uv0", "ä", "2"])

    def test_the_hash_of_the_first_frame_is_right_unless_it_is_given(self):
        self.assertIsNone(self.decoded(self.TEXT)[0])
        wrong = self.TEXT.replace("prediction_idc", "first_frame_crc = 7\n  prediction_idc")
        self.assertEqual(self.decoded(wrong)[0], "R-ATT-08")

    def test_a_wrong_crc_of_the_unit_stays_wrong(self):
        text = self.TEXT.replace("prediction_idc", "unit_crc = wrong\n  prediction_idc")
        self.assertEqual(expected(build(text))["rule"], "R-UNT-03")

    def test_rare_numbers(self):
        entry = recipes.Entry("value_residual", (), "400*rare(10, 60)", "")
        values = recipes.Values(entry, 1)
        numbers = [values.next() for _ in range(400)]
        self.assertTrue(values.done())
        self.assertGreater(numbers.count(0), 300)
        self.assertGreater(max(map(abs, numbers)), 10)
        self.assertLessEqual(max(map(abs, numbers)), 60)


class Sidecars(unittest.TestCase):
    """Tests the expectations of released streams."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rlpcgen-test-")
        self.addCleanup(folder.cleanup)
        self.version = pathlib.Path(folder.name) / "v1.0"
        self.sidecar = self.version / "accept" / "GOF" / "GOF-0001a.json"
        self.sidecar.parent.mkdir(parents=True)
        self.sidecar.with_suffix(".rlpc").write_bytes(b"")
        self.sidecar.write_text('{"id": "GOF-0001a", "sha256_int": "ab"}\n')
        for words in (["init", "-q"], ["add", "."], ["-c", "user.name=a", "-c", "user.email=a@b",
                                                     "commit", "-qm", "a"]):
            subprocess.run(["git", "-C", folder.name, *words], check=True)

    def changed(self, text):
        self.sidecar.write_text(text)
        return suite_streams.changed_members(self.version)

    def test_members_may_be_added_but_not_changed(self):
        before = suite_streams.sidecar_sums(self.version)
        self.assertTrue(before.endswith("  accept/GOF/GOF-0001a.json\n"), before)
        added = '{"id": "GOF-0001a", "sha256_int": "ab", "superseded_by": "GOF-0001b"}'
        self.assertEqual(self.changed(added), [])
        self.assertNotEqual(suite_streams.sidecar_sums(self.version), before)
        for text in ('{"id": "GOF-0001a", "sha256_int": "ac"}', '{"id": "GOF-0001a"}'):
            (complaint,) = self.changed(text)
            self.assertIn("\"sha256_int\" was 'ab'", complaint)


class StressTier(unittest.TestCase):
    """Streams of which only digests are kept."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rlpcgen-test-")
        self.addCleanup(folder.cleanup)
        self.version = pathlib.Path(folder.name) / "v1.0"
        self.add("recipes/GOF/GOF-0001a", TETRAHEDRON, "core")
        self.add("recipes-stress/GOF/GOF-0001x1", "title: Damaged\nrules: R-UNT-03\n"
                 "twin: GOF-0001a\nchange 2 GOF\n  unit_crc = wrong\n", "stress")
        place, *made = suite_streams.Version(self.version, SPEC).make(
            self.version / "recipes/GOF/GOF-0001a.recipe")
        suite_streams.write_stream(place, *made)

    def add(self, name, text, tier):
        path = self.version / (name + ".recipe")
        path.parent.mkdir(parents=True)
        path.write_text(text.replace("\n", f"\ntier: {tier}\n", 1))

    def examine(self, seeds):
        return list(stress.examine(self.version, SPEC, BIN, seeds, 2))

    def test_both_decoders_and_the_validator_agree(self):
        results = self.examine(3)
        self.assertEqual([r[0] for r in results],
                         ["0", "1", "2", "recipes-stress/GOF/GOF-0001x1.recipe"])
        self.assertEqual([r[3] for r in results], [None] * 4)

    def test_an_expectation_that_does_not_hold(self):
        path = self.version / "recipes-stress/GOF/GOF-0001x1.recipe"
        path.write_text(path.read_text().replace("R-UNT-03", "R-UNT-04"))
        self.assertIn("the first rule that it breaks is R-UNT-03", self.examine(0)[0][3])

    def test_digests_are_of_whole_batches(self):
        results = [(str(seed), 0, f"digest {seed}", None) for seed in range(250)]
        self.assertEqual(list(stress.digests(results)), ["seeds 0-99", "seeds 100-199"])
        results[150] = ("150", 0, "another", None)
        before, after = map(stress.digests, (results[:100] + results[100:200], results))
        self.assertEqual(before, after)

    def test_it_can_be_written_as_a_suite(self):
        out = self.version.parent / "out"
        self.assertEqual(len(list(stress.write_suite(self.version, SPEC, out, 2, 2))), 3)
        loaded = suite.load_suite(out)
        self.assertEqual([s.id for s in loaded.streams],
                         ["GOF-0001a", "GOF-0001x1", "RND-0000a", "RND-0001a"])
        self.assertEqual([s.tier for s in loaded.streams], ["core"] + 3 * ["stress"])


class Decompiling(unittest.TestCase):
    """Tests conversion of a stream to a recipe, and back to the same bytes."""

    def back(self, data):
        text = decompile.Decompiler(PROGRAM).recipe(data, {"title": "Again"})
        self.assertEqual(build(text), data)
        return text

    def test_random_streams(self):
        builder = random_high.builder_of("baseline")(PROGRAM)
        for seed in range(20_000, 20_015):
            self.back(builder.build(seed)[0])

    def test_damaged_streams(self):
        data = build(TETRAHEDRON)
        for changed in (data[:-3], data + b"\x05", data[:40] + b"\xFF" + data[41:],
                        data[:9] + b"\x07" + data[10:]):
            self.back(changed)

    def test_random_streams_with_slices(self):
        for profile in ("main", "high"):
            builder = random_high.builder_of(profile)(PROGRAM)
            streams = [builder.build(seed)[0] for seed in range(20_000, 20_008)]
            # Every unit is tried with all before it, so that time grows with the square.
            small = [data for data in streams if len(data) < 1500]
            self.assertGreater(len(small), 4)
            for data in small:
                self.assertNotRegex(
                    self.back(data),
                    "unit (GOF|RIG|SLICE)\n(  section_end = highest\n)?  payload")

    def test_elements_not_bytes(self):
        text = self.back(build(TETRAHEDRON))
        self.assertNotIn("payload", text)
        self.assertIn("gates = T", text)
        self.assertIn("seed_residual = 10 2*0 5 7 0 1 2 3", text)


class Commands(unittest.TestCase):
    """rlpcgen as people run it."""

    def run_tool(self, *arguments):
        return subprocess.run([sys.executable, "-B", HERE / "rlpcgen", *map(str, arguments)],
                              capture_output=True, text=True)

    def test_it_writes_and_complains(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "a.recipe").write_text(TETRAHEDRON)
            done = self.run_tool(folder / "a.recipe", "-o", folder / "a.rlpc")
            self.assertEqual((done.returncode, (folder / "a.rlpc").read_bytes()),
                             (0, build(TETRAHEDRON)), done.stderr)
            self.assertEqual(self.run_tool("--random", "3-5", "-o", folder / "r").returncode, 0)
            self.assertEqual(len(list((folder / "r").iterdir())), 3)
            again = self.run_tool("--decompile", folder / "a.rlpc").stdout
            self.assertEqual(build(again), build(TETRAHEDRON))
            (folder / "b.recipe").write_text("unit NOTHING\n")
            self.assertEqual(self.run_tool(folder / "b.recipe", "-o", folder / "b").returncode, 1)
            self.assertFalse((folder / "b").exists())
            self.assertEqual(self.run_tool(folder / "c.recipe", "-o", folder / "b").returncode, 1)
            self.assertEqual(self.run_tool(folder / "a.recipe").returncode, 64)
            self.assertEqual(self.run_tool("--random", "x", "-o", folder).returncode, 64)
            self.assertEqual(self.run_tool("--decompile", folder / "none").returncode, 4)


def main():
    global BIN
    parser = argparse.ArgumentParser(add_help=False)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    options, rest = parser.parse_known_args()
    BIN = options.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
