#!/usr/bin/env python3
"""Small trees with a fault each, and the complaint that it must cause."""

import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import check_clauses
import check_headers_first
import check_labels
import check_names
import check_pages
import check_rules
import check_stability
import check_types
import cpp_source


class TreeTest(unittest.TestCase):
    """Writes {path: text} into a fresh directory and runs one check over it."""

    def complaints(self, check, tree):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in tree.items():
                path = root / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return check(root)[0]

    def assert_clean(self, check, tree):
        self.assertEqual(self.complaints(check, tree), [])

    def assert_one(self, check, tree, *expected):
        found = self.complaints(check, tree)
        self.assertEqual(len(found), 1, found)
        for words in expected:
            self.assertIn(words, found[0])


class Source(unittest.TestCase):
    TEXT = 'int a = 1\'000;  // "x" is\n/* b */ const char* s = "// no";\n'

    def test_code_and_comments_are_separated(self):
        code = cpp_source.code_only(self.TEXT)
        comments = cpp_source.comments_only(self.TEXT)
        self.assertIn("1'000", code)
        self.assertNotIn("no", code)
        self.assertIn('// "x" is', comments)
        self.assertNotIn("no", comments)
        self.assertEqual(len(code), len(self.TEXT))
        self.assertEqual(len(comments), len(self.TEXT))


class Pages(TreeTest):
    THERE = {"spec/a.md": "", "scripts/make_it": ""}
    MARKS = "<!-- begin: rates (scripts/make_it) -->\n| a |\n<!-- end: rates -->\n"

    def run_on(self, text, *expected, marks=MARKS):
        (self.assert_one if expected else self.assert_clean)(
            check_pages.check, {**self.THERE, "README.md": text + marks}, *expected)

    def test_what_is_there(self):
        self.run_on("`scripts/make_it --all`, spec/a.md. [a](spec/a.md#b) build/spec/c, "
                    "scripts/make*, streams/vX.Y, [far](https://a.b)\n")

    def test_what_is_not(self):
        self.run_on("\nsee `spec/b.md`\n", "README.md:2", "spec/b.md")
        self.run_on("scripts/break*\n", "scripts/break*")
        self.run_on("[a](a.md)\n", "there is no a.md")

    def test_sources_without_their_folder(self):
        page = {"CONTRIBUTING.md": "`make_it`, `a.md`, `gofs/b.h`\n"}
        marks = {"README.md": self.MARKS}
        self.assert_one(check_pages.check, {**self.THERE, **marks, **page}, "there is no b.h")
        self.assert_clean(check_pages.check,
                          {**self.THERE, **marks, **page, "common/b.h": ""})

    def test_files_that_scripts_name(self):
        named = "".join(f'A = {"ROOT"} / "{folder}" / "b.md"\n' for folder in ("spec", "build"))
        page = {**self.THERE, "README.md": self.MARKS, "scripts/make_it": named}
        self.assert_one(check_pages.check, page, "scripts/make_it:1", "there is no spec/b.md")
        self.assert_clean(check_pages.check, {**page, "spec/b.md": ""})

    def test_written_tables_have_marks(self):
        for marks in ("", 2 * self.MARKS, self.MARKS.replace("end", "begin")):
            with self.subTest(marks=marks):
                self.run_on("", "README.md", "rates", marks=marks)


SPEC = """# 6 Syntax
## 6.3 Header
### 6.3.1 Sequence header syntax
```rlpc
def sequence_header():
    lcf_flag = u(1)  # not a {R-HDR-09}
    if lcf_flag:
        step[ i ] = ue()
```
Table 6-1 gives the names. It is a requirement of bitstream conformance ... {R-HDR-01}
**Table 6-2 — Names**
# 9 Parsing process
```rlpc
bin = ae(ctx)
```
# Annex B (normative) Levels
"""
PARSER = '// 6.3.1 sequence_header( )\nh.a = r.flag("lcf_flag");\nh.b = r.ue("step", {0, 1});\n'


class HeadersFirst(TreeTest):
    def run_on(self, source, *expected):
        tree = {"common/a.h": "", "common/a.cpp": source, "common/b.h": ""}
        (self.assert_one if expected else self.assert_clean)(check_headers_first.check, tree,
                                                             *expected)

    def test_the_first_include_counts(self):
        self.run_on('// #include "common/b.h"\n#include "common/a.h"\n#include <vector>\n')
        self.run_on('#include <vector>\n#include "common/a.h"\n', "common/a.cpp", "common/a.h")
        self.run_on('#include "common/b.h"\n#include "common/a.h"\n', "not included first")
        self.run_on("int x;\n", "not included first")

    def test_a_tree_without_any_is_not_the_project(self):
        self.assert_one(check_headers_first.check, {"common/a.h": ""}, "no header")


class Types(TreeTest):
    def test_one_header_defines_a_type(self):
        good = {"decoder/a.h": "struct A {\n  int x;\n};\nclass B;\nenum class C : int { kD };\n",
                "encoder/b.h": "class A;\n// class A {};\nclass B : public A {\n};\n",
                "encoder/b.cpp": "class A::Impl {\n};\n"}
        self.assert_clean(check_types.check, good)
        for again in ("struct B {\n};\n", "class C final : public B {};\n",
                      "enum class A : int {};\n"):
            self.assert_one(check_types.check, {**good, "common/b.h": again}, "is defined in",
                            "too")

    def test_a_tree_without_any_is_not_the_project(self):
        self.assert_one(check_types.check, {"common/a.h": "int a();\n"}, "no header")


class Names(TreeTest):
    def test_names_that_are_the_rest_of_a_sentence(self):
        for name in ("of_frame", "most", "least_", "most_bytes", "kMostBytes", "kLeast", "kOfGof"):
            self.assert_one(check_names.check, {"decoder/a.cpp": f"// It.\nint {name} = 1;\n"},
                            f"decoder/a.cpp:2: {name} is")
        self.assert_one(check_names.check, {"decoder/web/a.js": "const mostBytes = 1;\n"},
                        "decoder/web/a.js:1: mostBytes")
        for name in ("of_frame", "most", "LEAST_GAIN"):
            self.assert_one(check_names.check, {"scripts/a.py": f"\n{name} = 1\n"},
                            f"scripts/a.py:2: {name}")
        self.assert_one(check_names.check, {"conformance/rlpcval/a.cpp": "int least;\n"},
                        "conformance/rlpcval/a.cpp:1: least")

    def test_words_of_texts_and_names_that_are_kept(self):
        self.assert_clean(check_names.check, {
            "encoder/a.cpp": '// At most, the least of all.\nint x = format.least_level;\n'
                             'const char* s = "at most";\nint kOff = almost_of(offset);\n',
            "conformance/rlpccov/a.cpp": "int least;\n",
            "scripts/a.py": '"""At most."""\nx = "most"  # most\n'})

    def test_a_tree_without_sources_is_not_the_project(self):
        self.assert_one(check_names.check, {}, "sees nothing")


class Labels(unittest.TestCase):
    KNOWN = {"unit", "cli"}

    def test_one_kind_each(self):
        good = {"a": {"unit"}, "b": {"cli", "slow"}}
        self.assertEqual(check_labels.complaints_of(good, self.KNOWN), [])
        for labels, words in (({"slow"}, "not none"), ({"unit", "cli"}, "not cli, unit"),
                              ({"unit", "other"}, "other: not in")):
            found = check_labels.complaints_of({**good, "c": labels}, self.KNOWN)
            self.assertEqual(len(found), 1, found)
            self.assertIn(words, found[0])
        self.assertEqual(check_labels.complaints_of({"a": {"unit"}}, self.KNOWN),
                         ["scripts/cmake/tests.cmake: no test is labelled cli"])

    def test_presets_name_tests_that_are_there(self):
        def found(name):
            preset = {"name": "p", "filter": {"include": {"name": name}}}
            presets = {"testPresets": [{"name": "q"}, preset]}
            return list(check_labels.unknown_names(presets, {"a_test.X.Y", "b.C"}))

        self.assertEqual(found("^(a_test|b.C)"), [])
        self.assertEqual(found("^(a_test|b.D)"),
                         ["CMakePresets.json: p: no test's name begins with b.D"])
        self.assertIn("expected", found("a_test")[0])

    def test_the_list_is_that_of_the_project(self):
        self.assertLessEqual({"unit", "cli", "suite", "browser"},
                             check_labels.kinds(cpp_source.repository_root()))


class Clauses(TreeTest):
    def run_on(self, code, *expected, spec=SPEC, parser=PARSER):
        tree = {"spec/06-syntax.md": spec, "common/a.h": code,
                "decoder/codec/parse/parse_a.cpp": parser,
                "decoder/codec/kinds/b/parse/parse_b.cpp": "",
                "decoder/codec/units/unit_reader.cpp": ""}
        (self.assert_one if expected else self.assert_clean)(check_clauses.check, tree, *expected)

    def test_empty_spec_is_an_error(self):
        self.assert_one(check_clauses.check, {}, "spec/ is empty")

    def test_missing_parsers_are_an_error(self):
        found = self.complaints(check_clauses.check, {"spec/06-syntax.md": SPEC})
        self.assertIn("decoder/codec/parse/ has no sources", found)
        self.assertIn("decoder/codec/kinds/*/parse/ has no sources", found)

    def test_correct_citations_pass(self):
        self.run_on("// 6.3.1 Sequence header syntax: why\n// 6.3.1 sequence_header( )\n"
                    "// 6.3.1, step 3\n// 6.3 to 6.3.1, writing side\n// 1.5 times it\n"
                    "// (clause 6.3.1). Clauses 6.3 and 6.3.1; clause 9, Annex B\n"
                    '// Table 6-2: names; version 1.0\nint x = 7.7;  // 0.5 of it\n'
                    'fail("R-HDR-01"); f("clause 77");\n')

    def test_missing_clause(self):
        self.run_on("\n// 6.3.2 Sequence header syntax\n", "common/a.h:2", "no clause 6.3.2")
        self.run_on("int x;  // see clause 8.4\n", "no clause 8.4")
        self.run_on("// clauses 6.3 and 8.5\n", "no clause 8.5")
        self.run_on("// see clause\n// 8.6 there\n", "no clause 8.6")
        self.run_on("// 6.3 to 6.4, writing side\n", "no clause 6.4")
        self.run_on("// Annex C\n", "no Annex C")

    def test_wrong_title(self):
        self.run_on("// 6.3.1 Frame header\n", 'is "Sequence header syntax", not "Frame header"')
        self.run_on("// 6.3.1 frame_header( )\n", 'not "frame_header( )"')

    def test_missing_table(self):
        self.run_on("// Table 6-1 is only mentioned\n", "no Table 6-1")

    def test_missing_rule(self):
        self.run_on('fail("R-HDR-02");\n', "no rule R-HDR-02")
        self.run_on('fail("R-HDR-09");\n', "no rule R-HDR-09")

    def test_rule_defined_twice(self):
        self.run_on("", "06-syntax.md:17", "already defined", spec=SPEC + "{R-HDR-01}\n")

    def test_required_rule_without_definition(self):
        self.run_on("", "06-syntax.md:18: rule R-HDR-07 is defined nowhere",
                    spec=SPEC + '```rlpc\nrequire(x, "R-HDR-07")\n```\n')

    def test_clause_twice(self):
        self.run_on("", "clause 6.3 is already", spec=SPEC + "## 6.3 Again\n")

    def test_element_without_parser(self):
        self.run_on("", "06-syntax.md:6", "lcf_flag is read by no",
                    parser='r.ue("step", {0, 1});  // "lcf_flag"\n')

    def test_element_with_two_parsers(self):
        found = self.complaints(check_clauses.check, {
            "spec/06-syntax.md": SPEC, "decoder/codec/parse/parse_a.cpp": PARSER,
            "decoder/codec/units/unit_reader.cpp": "",
            "decoder/codec/kinds/b/parse/parse_b.h": 'r.flag("lcf_flag");\n',
            "decoder/codec/parse/parse_b_test.cpp": 'expect("lcf_flag");\n'})
        self.assertEqual(len(found), 1, found)
        self.assertIn("2 parsers", found[0])

    def test_parser_without_element(self):
        self.run_on("", "parse_a.cpp:4: other is in no syntax table",
                    parser=PARSER + 'r.u(4, "other", {0, 1});\n')


class Rules(TreeTest):
    TEXT = ("# 7 Semantics\n**x** is short. It is a requirement of bitstream\n"
            "conformance that x is 1. {R-ABC-01} A stream is unsupported unless y is 2. "
            "{R-ABC-02}\n")

    def tree(self, text, listed=None):
        sentences = [("R-ABC-01", "invalid",
                      "It is a requirement of bitstream conformance that x is 1."),
                     ("R-ABC-02", "unsupported", "A stream is unsupported unless y is 2.")]
        found = [{"rule": rule, "clause": "7", "effect": effect, "checked_by": "none",
                  "sentence": sentence} for rule, effect, sentence in sentences]
        return {"spec/07.md": text, "spec/rules.json": listed or check_rules.text_of(found)}

    def test_sentences_are_listed(self):
        self.assert_clean(check_rules.check, self.tree(self.TEXT))

    def test_list_that_is_not_up_to_date(self):
        self.assert_one(check_rules.check, self.tree(self.TEXT, "[]\n"), "not up to date")

    def test_process_that_checks_a_rule(self):
        def block(*ids):
            return "```rlpc\n" + "".join(f'require(x, "{i}")\n' for i in ids) + "```\n"

        tree = self.tree(self.TEXT)
        for clauses, expected in (((), ["none", "none"]),
                                  (("6.9", "R-ABC-01"), ["random access", "none"]),
                                  (("F.2", "R-ABC-01", "F.7", "R-ABC-01"),
                                   ["attributes", "none"]),
                                  (("6.9", "R-ABC-01", "R-ABC-02", "8.8", "R-ABC-02"),
                                   ["random access", "random access"]),
                                  (("6.5", "R-ABC-01", "8.8", "R-ABC-01", "R-ABC-02"),
                                   ["decoding", "random access"])):
            text = "".join(block(c) if c.startswith("R-") else f"## {c} Clause\n"
                           for c in clauses)
            with tempfile.TemporaryDirectory() as folder:
                root = pathlib.Path(folder)
                (root / "spec").mkdir()
                (root / "spec" / "06.md").write_text("# 6 Syntax\n" + text, encoding="utf-8")
                (root / "spec" / "07.md").write_text(tree["spec/07.md"], encoding="utf-8")
                found, complaints = check_rules.rules(root)
            self.assertEqual(complaints, [])
            self.assertEqual([rule["checked_by"] for rule in found], expected, clauses)

    def test_rule_without_check_in_the_validator(self):
        tools = "conformance/rlpcval/"
        tree = {**self.tree(self.TEXT), "decoder/codec/parse/parse_a.cpp": 'fail("R-ABC-01");\n',
                tools + "validator.cpp":
                '#include "decoder/codec/parse/parse_a.h"\n// "R-ABC-02"\n'}
        self.assert_one(check_rules.check, tree, "R-ABC-02 has no check in rlpcval")
        self.assert_clean(check_rules.check, {**tree, tools + "validator_b.cpp": '"R-ABC-02"\n'})

    def test_rule_without_a_stream_that_breaks_it(self):
        def sidecar(*ids, **more):
            return json.dumps({"rules": ids, **more})

        tree = {**self.tree(self.TEXT), "streams/v1.0/accept/A/A-0001a.json": sidecar("R-ABC-02"),
                "streams/v1.0/reject/A/A-0001x1.json": sidecar("R-ABC-01"),
                "spec/permissive.md": "R-ABC-01 to R-ABC-09 are left open.\n"}
        self.assert_one(check_rules.check, tree, "streams/: no stream breaks R-ABC-02")
        either = "streams/v1.0/either/A/A-0001x2.json"
        self.assert_clean(check_rules.check, {**tree, either: sidecar("R-ABC-02")})
        self.assert_one(check_rules.check,
                        {**tree, either: sidecar("R-ABC-02", superseded_by="A-0001x3")},
                        "no stream breaks R-ABC-02")
        self.assert_one(check_rules.check, {**tree, either: sidecar("R-ABC-02", "R-ABC-09")},
                        "names R-ABC-09, which spec/ does not define")
        self.assert_one(check_rules.check,
                        {**tree, either: sidecar("R-ABC-02"), "spec/permissive.md": "R-ABC-01\n"},
                        "spec/permissive.md: R-ABC-02 is left open by A-0001x2")

    def test_sentence_without_rule(self):
        self.assert_one(check_rules.check,
                        self.tree(self.TEXT + "A stream is unsupported unless z is 3.\n"),
                        "spec/07.md:2", "has no rule id")

    def test_rule_without_sentence(self):
        self.assert_one(check_rules.check, self.tree(self.TEXT + "\nx should be 1. {R-ABC-03}\n"),
                        "spec/07.md:5", "R-ABC-03")


class Stability(TreeTest):
    DIGEST = "2c26b46b68ffc68ff99b453c1d30413413422d706483bfa0f98a5e886266e7ae"  # SHA-256 of "foo"
    RELEASED = {"spec/versions.md": "| 1.0 | Baseline | released 2026-11-21 |\n",
                "streams/v1.0/SHA256SUMS": DIGEST + "  accept/A/A-0001a.rlpc\n",
                "streams/v1.0/SHA256SUMS.sidecars": DIGEST + "  accept/A/A-0001a.json\n",
                "streams/v1.0/accept/A/A-0001a.rlpc": "foo",
                "streams/v1.0/accept/A/A-0001a.json": "foo"}
    ENTRY = '{"version": "1.0.0", "erratum": %s, "digests": {}}'

    @staticmethod
    def released(root):
        return [list(check_stability.released(root))]

    @staticmethod
    def entries(root):
        return [list(check_stability.entries(root, before=[]))]

    def test_what_is_released_stays(self):
        self.assert_clean(self.released, self.RELEASED)
        changed = {**self.RELEASED, "streams/v1.0/accept/A/A-0001a.rlpc": "fop"}
        self.assert_one(self.released, changed, "A-0001a.rlpc", "changed since its release")
        missing = {k: v for k, v in self.RELEASED.items() if not k.endswith(".rlpc")}
        self.assert_one(self.released, missing, "released, but missing")

    def test_what_is_expected_of_released_streams_stays(self):
        sums, sidecar = "streams/v1.0/SHA256SUMS.sidecars", "streams/v1.0/accept/A/A-0001a.json"
        self.assert_one(self.released, {**self.RELEASED, sidecar: "fop"}, "A-0001a.json",
                        "what is expected of it never changes")
        missing = {k: v for k, v in self.RELEASED.items() if k != sidecar}
        self.assert_one(self.released, missing, "A-0001a.json", "released, but missing")
        self.assert_one(self.released, {**self.RELEASED, sums: ""}, "A-0001a.json", "not in")
        unfrozen = {k: v for k, v in self.RELEASED.items() if k != sums}
        self.assert_one(self.released, unfrozen, sums, "scripts/streams sidecars")

    def test_the_list_of_versions_is_true(self):
        said = {"spec/versions.md": self.RELEASED["spec/versions.md"]}
        self.assert_one(self.released, said, "1.0 is `released 2026-11-21`", "missing")
        unsaid = {**self.RELEASED, "spec/versions.md": "| 1.0 | Baseline | not released |\n"}
        self.assert_one(self.released, unsaid, "1.0 is `not released`")

    def test_supplements_are_released_by_themselves(self):
        said = self.RELEASED["spec/versions.md"]
        row = "| 1.0s1 | more streams | released 2026-11-22 |\n"
        tree = {**self.RELEASED, "spec/versions.md": said + row}
        self.assert_one(self.released, tree, "1.0s1 is `released 2026-11-22`", "missing")
        sums = "streams/v1.0s1/SHA256SUMS"
        empty = {sums: "", f"{sums}.sidecars": ""}
        self.assert_clean(self.released, {**tree, **empty})
        self.assert_one(self.released, {**self.RELEASED, **empty}, sums, "does not know")

    def test_another_state_of_the_encoder_has_a_reason(self):
        def tree(*errata, text="# Errata\n"):
            listed = "[" + ", ".join(self.ENTRY % e for e in errata) + "]"
            return {check_stability.DIGESTS: listed, "spec/errata.md": text,
                    "CHANGELOG.md": "## 1.0.0 - 2026-11-21\n"}

        self.assert_clean(self.entries, tree("null"))
        self.assert_one(self.entries, tree("null", "null"), "names no erratum")
        self.assert_one(self.entries, tree("null", '"E-001"'), "E-001 is not in")
        self.assert_clean(self.entries, tree("null", '"E-001"', text="### E-001 Rounding\n"))

    def test_only_the_entry_of_an_unreleased_version_is_replaced(self):
        before = [{"version": "1.0.0", "erratum": None, "digests": {"a": "1"}}]

        def entries(root):
            return [list(check_stability.entries(root, before))]

        tree = {check_stability.DIGESTS: "[" + self.ENTRY % "null" + "]",
                "spec/errata.md": "# Errata\n", "CHANGELOG.md": "## 1.0.0 - unreleased\n"}
        self.assert_clean(entries, tree)
        self.assert_one(entries, {**tree, "CHANGELOG.md": "## 1.0.0 - 2026-11-21\n"},
                        "entries of released versions were changed")


if __name__ == "__main__":
    unittest.main()
