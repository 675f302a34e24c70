#!/usr/bin/env python3
"""Faults planted in a copy of the real tree, one at a time, and the complaint that each must cause.

A guard that matches nothing in the real tree would miss its fault.
"""

import contextlib
import pathlib
import shutil
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import check_clauses
import check_constants
import check_float
import check_headers_first
import check_json
import check_layers
import check_rules
import check_web
import cpp_source
import rooms

ROOT = cpp_source.repository_root()
COPIED = (*cpp_source.LAYERS, "spec")
COPIED_FILES = ("scripts/cmake/install.cmake", "scripts/checks/consumer/examples.c",
                "scripts/checks/consumer/examples.cpp")


_COPY = tempfile.TemporaryDirectory()


def setUpModule():
    root = pathlib.Path(_COPY.name)
    for name in COPIED:
        shutil.copytree(ROOT / name, root / name)
    for name in COPIED_FILES:
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, root / name)
    (root / "streams").symlink_to(ROOT / "streams")


def tearDownModule():
    _COPY.cleanup()


class RealTree(unittest.TestCase):
    root = pathlib.Path(_COPY.name)

    @contextlib.contextmanager
    def planted(self, name, change):
        """The tree with one file changed: `change` takes its text (None: it is new)."""
        path = self.root / name
        before = path.read_text(encoding="utf-8") if path.exists() else None
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(change(before), encoding="utf-8")
        try:
            yield
        finally:
            if before is None:
                path.unlink()
            else:
                path.write_text(before, encoding="utf-8")

    def complaint(self, check, name, change, *expected):
        with self.planted(name, change):
            found = check(self.root)[0]
        self.assertEqual(len(found), 1, found)
        for words in expected:
            self.assertIn(words, found[0])

    def include(self, name, line, *expected):
        """Adds an include to an existing file."""
        self.assertTrue((self.root / name).is_file(), name)
        places = () if "in a circle" in expected[0] else (name,)
        self.complaint(check_layers.check, name, lambda text: text + line + "\n", *places,
                       *expected)

    @contextlib.contextmanager
    def without(self, folder):
        """The tree without a folder."""
        away = self.root / ("away-" + folder.replace("/", "-"))
        (self.root / folder).rename(away)
        try:
            yield
        finally:
            away.rename(self.root / folder)


class Layers(RealTree):
    def test_the_tree_is_clean(self):
        self.assertEqual(check_layers.check(self.root)[0], [])

    def test_sides_never_include_each_other(self):
        self.include("decoder/rlpc_decoder.cpp", '#include "encoder/rlpc_encoder.h"',
                     "must not include")
        self.include("encoder/codec/sequence/choices/gof_cuts.cpp",
                     '#include "decoder/rlpc_decoder.h"',
                     "must not include")
        self.include("common/codec/mesh/topology.cpp", '#include "decoder/codec/slice_cut.h"',
                     "must not include")
        self.include("decoder/codec/gofs/hash_check.cpp",
                     '#include "conformance/testing/count_memory.h"', "must not include")

    def test_parsing_includes_nothing_that_reconstructs(self):
        for header in ("common/codec/kinds/skinned/recon/skinned_recon.h",
                       "common/codec/kernels/kernels.h", "common/codec/kinds/cluster/recon/lcf.h",
                       "decoder/codec/recon/gof_recon.h",
                       "common/codec/mesh_prediction/geometry_weights.h",
                       "common/codec/mesh/vertex_layers.h", "decoder/codec/units/unit_reader.h",
                       "decoder/codec/kinds/skinned/skinned_decoder.h"):
            with self.subTest(header=header):
                self.include("decoder/codec/kinds/skinned/parse/parse_skinned_gof.cpp",
                             f'#include "{header}"', header)

    def test_parsing_calls_nothing_that_reconstructs(self):
        for name in ("decoder/codec/parse/parse_gof_header.cpp",
                     "decoder/codec/kinds/inter/parse/parse_inter_gof.cpp",
                     "decoder/codec/units/access_unit_parser.cpp"):
            for call in ("make_layers(n, triangles);", "decoder.make_recon(gof, context);",
                         "complete_influences(mesh, gof);", "make_lcf(a, b, c);"):
                with self.subTest(name=name, call=call):
                    self.complaint(check_layers.check, name,
                                   lambda text, call=call: text + f"void f() {{ {call} }}\n",
                                   name, "must not call")

    def test_files_of_meshes_know_nothing_of_coding(self):
        self.include("encoder/meshes/obj/obj_reader.cpp",
                     '#include "encoder/codec/spans/span_coder.h"',
                     "must not include")
        self.include("decoder/meshes/mesh_sink.cpp", '#include "decoder/rlpc_decoder.h"',
                     "must not include")

    def test_only_one_folder_of_common_works_with_files(self):
        header = '#include "common/files/output_file.h"'
        for name in ("common/codec/mesh/topology.cpp",
                     "common/codec/kinds/skinned/recon/skinned_recon.h",
                     "decoder/codec/parse/parse_gof_header.cpp",
                     "decoder/codec/gofs/hash_check.cpp", "decoder/codec/units/stream_reader.cpp"):
            with self.subTest(name=name):
                self.include(name, header, "must not include")
        self.include("common/files/output_file.h", '#include "decoder/codec/slice_cut.h"',
                     "must not include")
        for name in ("decoder/codec/units/access_unit_parser.cpp",
                     "decoder/codec/gofs/hash_check.cpp", "decoder/codec/units/stream_reader.cpp"):
            with self.subTest(name=name):
                self.complaint(check_layers.check, name, lambda text: text + (
                    "void f() { float_position(grid, 0, 1); }\n"), name, "must not call")

    def test_other_libraries_stay_where_they_are(self):
        self.include("decoder/codec/gofs/prefetch.cpp", "#include <Eigen/Dense>",
                     "decoder/ must not use <Eigen/Dense>")
        self.include("common/codec/mesh/cut_border.cpp", "#include <fstream>", "no input or output")
        self.include("common/codec/mesh/cut_border.cpp", "#include <unistd.h>",
                     "only the standard library")
        self.include("common/codec/syntax/write_units.cpp", "#include <encoder/rlpc_encoder.h>",
                     "is ours")

    def test_there_is_no_way_round(self):
        self.include("decoder/rlpc_decoder.cpp", '#include "../encoder/rlpc_encoder.h"',
                     "not spelled from the top")
        self.include("decoder/rlpc_decoder.cpp", "#include HEADER", "cannot be followed")
        self.include("decoder/rlpc_decoder.cpp", '#include "decoder/no_such.h"', "does not exist")

    def test_links_follow_the_rule(self):
        self.complaint(check_layers.check, "decoder/CMakeLists.txt",
                       lambda text: text + "target_link_libraries(rlpcdec PRIVATE rlpc_encoder)\n",
                       "decoder/CMakeLists.txt", "must not link rlpc_encoder")
        self.complaint(check_layers.check, "common/CMakeLists.txt",
                       lambda text: text + "target_link_libraries(rlpc_common Eigen3::Eigen)\n",
                       "must not use Eigen")

    def test_public_headers_reach_only_the_standard_library(self):
        self.complaint(check_layers.check, "decoder/codec/slice_cut.h",
                       lambda text: text + "#include <CLI/CLI.hpp>\n",
                       "decoder/codec/slice_cut.h", "reaches <CLI/CLI.hpp>")
        self.complaint(check_layers.check, "decoder/describe_error.h",
                       lambda text: text + "#include <nlohmann/json.hpp>\n",
                       "decoder/describe_error.h", "reaches <nlohmann/json.hpp>")

    def test_no_folders_include_each_other(self):
        before = rooms.ROOMS
        rooms.ROOMS = {**before,
                       "common/codec/bits": before["common/codec/bits"] | {"common/codec/mesh"}}
        try:
            self.include("common/codec/bits/bit_reader.cpp", '#include "common/codec/mesh/mesh.h"',
                         "in a circle: common/codec/mesh -> common/codec/bits -> common/codec/mesh")
        finally:
            rooms.ROOMS = before

    def test_common_and_decoder_neither_throw_nor_catch(self):
        for name, line in (("common/codec/mesh/topology.cpp", "void f() { throw 1; }"),
                           ("decoder/codec/units/unit_reader.cpp", "void f() try {} ALL"),
                           ("decoder/codec/gofs/prefetch.cpp", "catch (...) {}")):
            with self.subTest(name=name):
                self.complaint(check_layers.check, name, lambda t, line=line: line + "\n" + t,
                               f"{name}:1", "must neither throw nor catch")
        for name, line in (("common/codec/mesh/topology.cpp", "// throw"),
                           ("common/codec/mesh/topology_test.cpp", "void f() { throw 1; }"),
                           ("decoder/c_api/rlpc_c_decoder.cpp", "void f() { throw 1; }"),
                           ("encoder/c_api/rlpc_c_encoder.cpp", "void f() { throw 1; }")):
            with self.subTest(name=name), self.planted(name, lambda t, line=line: line + "\n" + t):
                self.assertEqual(check_layers.check(self.root)[0], [])

    def test_folders_are_rooms_and_rooms_are_folders(self):
        self.complaint(check_layers.check, "decoder/attic/a.h", lambda _: "#pragma once\n",
                       "decoder/attic/ has sources, but is not a room")
        with self.without("decoder/codec/extract"):
            found = check_layers.check(self.root)[0]
        self.assertIn("scripts/checks/rooms.py: decoder/codec/extract/ has no sources", found)

    def test_a_rule_about_calls_that_names_none_is_reported(self):
        before = rooms.NOT_CALLED
        rooms.NOT_CALLED = {"decoder/codec/parse": ("common/no_such_folder",)}
        try:
            found = check_layers.check(self.root)[0]
        finally:
            rooms.NOT_CALLED = before
        self.assertEqual(len(found), 1, found)
        self.assertIn("names no function", found[0])

    def test_python_of_specification_and_judge_is_plain(self):
        self.complaint(check_layers.check, "conformance/specdec/specdec.py",
                       lambda text: "import numpy as np\n" + text,
                       "conformance/specdec/specdec.py:1", "must not import numpy")
        self.complaint(check_layers.check, "conformance/judge/grading.py",
                       lambda text: "from rlpcgen import recipe\n" + text,
                       "conformance/judge/grading.py:1", "must not import rlpcgen")


class Json(RealTree):
    def test_the_tree_is_clean(self):
        self.assertEqual(check_json.check(self.root)[0], [])

    def test_calls_of_the_library_are_found(self):
        for name, line in (
                ("encoder/meshes/texels.cpp", "auto a = nlohmann::json::parse(text);"),
                ("encoder/meshes/texels.cpp", "auto a = Json::parse(text, nullptr, false);"),
                ("encoder/programs/rlpcenc/encode_options.cpp",
                 "bool a = nlohmann::ordered_json::accept(t);"),
                ("decoder/meshes/stream_asset.cpp", "auto a = GltfJson::parse(text);"),
                ("decoder/meshes/stream_asset.cpp", "bool a = GltfJson::sax_parse(text, &sax);"),
                ("decoder/programs/rlpcdec/rlpcdec.cpp", "auto a = remarks.dump(2);"),
                ("decoder/programs/rlpcinfo/rlpcinfo_report.cpp",
                 "std::cout << std::setw(2) << json << 1;"),
                ("conformance/rlpcval/rlpcval.cpp", "std::cin >> json;"),
                ("conformance/rlpccmp/rlpccmp.cpp",
                 "using Tree = nlohmann::json; Tree::parse(t);")):
            with self.subTest(name=name, line=line):
                self.assertTrue((self.root / name).is_file(), name)
                self.complaint(check_json.check, name, lambda text, line=line: line + "\n" + text,
                               f"{name}:1", "only common/json")


class Float(RealTree):
    def test_the_tree_is_clean(self):
        self.assertEqual(check_float.check(self.root)[0], [])

    def plant(self, name, line):
        self.assertTrue((self.root / name).is_file(), name)
        self.complaint(check_float.check, name, lambda text: line + "\n" + text, f"{name}:1",
                       "floating point")

    def test_every_folder_of_integers_is_checked(self):
        for name in ("common/codec/mesh_prediction/value_prediction.cpp",
                     "common/codec/kinds/skinned/recon/skinned_recon.h",
                     "common/codec/bits/int_math.h", "decoder/codec/parse/section_reader.h",
                     "decoder/codec/gofs/hash_check.cpp", "decoder/codec/units/stream_reader.cpp",
                     "decoder/codec/kinds/inter/parse/parse_inter_gof.cpp",
                     "decoder/codec/extract/sub_stream_extractor.cpp"):
            with self.subTest(name=name):
                self.plant(name, "double x;")

    def test_types_functions_and_literals_are_found(self):
        for line in ("float f();", "int r = std::sqrt(x);", "auto x = 0.5;", "auto x = 2.f;",
                     "auto x = 1e9;", "#include <cmath>"):
            with self.subTest(line=line):
                self.plant("common/codec/mesh/topology.h", line)

    def test_comments_literals_tests_and_writers_are_free(self):
        for name, line in (("common/codec/mesh/topology.h", "// a double, 0.5"),
                           ("common/codec/mesh/topology.cpp", 'const char* s = "float 1.5";'),
                           ("common/codec/mesh/topology_test.cpp", "double x;"),
                           ("common/files/output_file.cpp", "double x;"),
                           ("decoder/meshes/mesh_sink.cpp", "float y;")):
            with self.subTest(name=name), self.planted(name, lambda t, line=line: line + "\n" + t):
                self.assertEqual(check_float.check(self.root)[0], [])

    def test_an_empty_folder_is_reported(self):
        with self.without("decoder/codec"):
            found = check_float.check(self.root)[0]
        self.assertEqual(found, ["decoder/codec/ has no sources"])


class Web(RealTree):
    def test_the_tree_is_clean(self):
        self.assertEqual(check_web.check(self.root)[0], [])

    def test_algorithms_of_ranges_are_found(self):
        for name in ("common/codec/mesh/topology.cpp", "decoder/codec/units/stream_reader.cpp",
                     "decoder/codec/kinds/inter/parse/parse_inter_gof.cpp",
                     "decoder/web/wasm/script_source.h"):
            for line in ("auto f = std::ranges::fill;", "#include <ranges>"):
                with self.subTest(name=name, line=line):
                    self.complaint(check_web.check, name,
                                   lambda text, line=line: line + "\n" + text, f"{name}:1",
                                   "not in the library of Emscripten")

    def test_programs_and_tests_are_free(self):
        line = "auto f = std::ranges::fill;\n"
        for name in ("common/codec/mesh/topology_test.cpp", "decoder/meshes/mesh_sink.cpp"):
            with self.subTest(name=name), self.planted(name, lambda text: line + text):
                self.assertEqual(check_web.check(self.root)[0], [])


class HeadersFirst(RealTree):
    def test_the_tree_is_clean(self):
        self.assertEqual(check_headers_first.check(self.root)[0], [])

    def test_another_include_before_it(self):
        self.complaint(check_headers_first.check, "encoder/codec/write/write_stream.cpp",
                       lambda text: "#include <vector>\n" + text,
                       "encoder/codec/write/write_stream.cpp",
                       '"encoder/codec/write/write_stream.h"')


class Constants(RealTree):
    SOURCE = "encoder/codec/kinds/skinned/search/bone_search.cpp"

    def plant(self, line, *expected, name=SOURCE):
        self.assertTrue((self.root / name).is_file(), name)
        self.complaint(check_constants.check, name, lambda text: text + line + "\n", name,
                       *expected)

    def test_the_tree_is_clean(self):
        self.assertEqual(check_constants.check(self.root)[0], [])

    def test_a_constant_says_whether_it_is_tuned(self):
        for line in ("constexpr double kMagic = 0.37;", "constexpr int kMagic = 7;",
                     "constexpr double kMagic = 0.37;  // found by trial",
                     "constexpr double kMagic = 0.37;  // tuned:",
                     "constexpr std::array<int, 2> kMagic{1, 2};",
                     "constexpr double kMagic =\n    0.37;"):
            with self.subTest(line=line):
                self.plant(line, "kMagic says neither")

    def test_the_table_has_values_and_reasons_as_declared(self):
        for old, new in (("kSearchInfluences = 2;", "kSearchInfluences = 3;"),
                         ("Bones that a vertex may follow", "Bones that any vertex may follow")):
            with self.subTest(new=new):
                self.complaint(check_constants.check, self.SOURCE,
                               lambda text, old=old, new=new: text.replace(old, new),
                               "run scripts/constants --write")

    def test_every_folder_of_the_search_is_checked(self):
        for name in ("encoder/codec/spans/component_cost.h",
                     "encoder/codec/sequence/target/target_search.cpp",
                     "encoder/codec/kinds/cluster/cluster_gof_search.cpp",
                     "encoder/codec/kinds/skinned/skinned_span_coder.cpp",
                     "encoder/codec/kinds/skinned/fit/bone_solver.cpp",
                     "encoder/codec/kinds/skinned/quantise/temporal_values.cpp"):
            with self.subTest(name=name):
                self.plant("constexpr double kMagic = 0.37;", "kMagic says neither", name=name)

    def test_numbers_have_names(self):
        for line in ("double f(double x) { return 0.37 * x; }", "double x = 1e-6;"):
            with self.subTest(line=line):
                self.plant(line, "is no named constant")

    def test_plain_formulas_and_fixed_constants_are_free(self):
        for line in ("double f(double x) { return 0.5 * x / 12.0; }",
                     "constexpr double kUnit = 0.37;  // fixed: format",
                     "// 0.37 is no number of the code"):
            with self.subTest(line=line), self.planted(self.SOURCE,
                                                       lambda t, line=line: t + line + "\n"):
                self.assertEqual(check_constants.check(self.root)[0], [])

    def test_the_page_has_a_row_for_each_and_no_other(self):
        self.complaint(check_constants.check, self.SOURCE,
                       lambda text: text + "constexpr double kMagic = 0.37;  // tuned: by magic\n",
                       check_constants.PAGE, "no row for bone_search.kMagic")
        self.complaint(check_constants.check, check_constants.PAGE,
                       lambda text: text + "| `bone_search.kGone` | 1 | | | | gone |\n",
                       "bone_search.kGone is no tuned constant")

    def test_an_encoder_without_tags_is_told(self):
        with contextlib.ExitStack() as missing:
            for folder in ("kinds/skinned", "kinds/cluster", "kinds/inter", "spans", "partition",
                           "rest", "sequence", "attributes"):
                missing.enter_context(self.without(f"encoder/codec/{folder}"))
            found = check_constants.check(self.root)[0]
        self.assertIn("no tuned constant is found: the check sees nothing", found)


class Specification(RealTree):
    def test_the_tree_is_clean(self):
        self.assertEqual(check_clauses.check(self.root)[0], [])
        self.assertEqual(check_rules.check(self.root)[0], [])

    def test_a_clause_that_does_not_exist(self):
        self.complaint(check_clauses.check, "decoder/codec/gofs/hash_check.cpp",
                       lambda text: text + "// 8.99.7 No such process\n",
                       "decoder/codec/gofs/hash_check.cpp", "8.99.7")

    def test_an_element_that_no_parser_reads(self):
        with self.planted("decoder/codec/parse/parse_gof_header.cpp",
                          lambda text: text.replace('"first_frame"', '"frame"')):
            found = check_clauses.check(self.root)[0]
        self.assertEqual(len(found), 2, found)
        self.assertIn("syntax element first_frame is read by no parser", found[0])
        self.assertIn("frame is in no syntax table", found[1])

    def test_rules_that_are_left_open_are_on_the_page(self):
        for old, rule in (("R-AST-02", "R-AST-02"), ("R-ATT-01 to R-ATT-09", "R-ATT-05")):
            with self.planted("spec/permissive.md", lambda text, old=old: text.replace(old, "")):
                found = check_rules.check(self.root)[0]
            self.assertTrue(any(f"{rule} is left open by" in text for text in found), found)

    def test_a_rule_without_stream(self):
        with self.planted("spec/07-semantics.md", lambda text: text + (
                "\nIt is a requirement of bitstream conformance that the sky is blue.\n"
                "{R-GOF-99}\n")):
            found = check_rules.check(self.root)[0]
        self.assertIn("streams/: no stream breaks R-GOF-99: write a recipe", found)
        self.assertTrue(any("R-GOF-99 has no check in rlpcval" in text for text in found), found)


if __name__ == "__main__":
    unittest.main()
