#!/usr/bin/env python3
"""Help pages: one screen with what most people need, and one page with every option."""

import re

from tools_testing import ROOT, ToolsTest, main

LINES, COLUMNS = 40, 80
SOURCES = {"rlpcenc": ("encoder/programs/rlpcenc/encode_command_line.cpp",
                       "encoder/programs/rlpcenc/method_options.cpp"),
           "rlpcdec": ("decoder/programs/rlpcdec/decode_command_line.cpp",),
           "rlpcinfo": ("decoder/programs/rlpcinfo/rlpcinfo.cpp",),
           "rlpcval": ("conformance/rlpcval/rlpcval.cpp",),
           "rlpccmp": ("conformance/rlpccmp/rlpccmp.cpp",)}
# Text that CLI11 adds for types, validators, defaults and other options.
NOISE = re.compile(r"TEXT|FLOAT|INT\b|REQUIRED|Excludes|Needs|:FILE|:SIZE|:\{|\[\d|[A-Z]=|\bEnv:")
# Option names at the beginning of a string literal, including options that a function adds.
DECLARED = re.compile(r'"(?:-\w,)?(--[a-z][a-z-]+)(?:,(--[a-z][a-z-]+))?"')


class Help(ToolsTest):
    def page(self, tool, option):
        return self.ok(tool, option).out.decode()

    def test_help_fits_one_screen(self):
        for tool in SOURCES:
            lines = self.page(tool, "--help").splitlines()
            self.assertLessEqual(len(lines), LINES, tool)
            for line in lines:
                self.assertLessEqual(len(line), COLUMNS, (tool, line))
            self.assertEqual(self.page(tool, "-h").splitlines(), lines)
            self.assertIn("Examples", lines, tool)
            self.assertTrue(lines[-1].endswith(f"{tool} --help-all"), tool)

    def test_nothing_of_the_parser_is_shown(self):
        self.assertRegex("--metadata TEXT:FILE Excludes: --json", NOISE)
        for tool in SOURCES:
            for option in ("--help", "--help-all"):
                page = self.page(tool, option)
                self.assertIsNone(NOISE.search(page), (tool, NOISE.findall(page)))

    def test_help_all_has_every_option_once(self):
        for tool, paths in SOURCES.items():
            source = "".join((ROOT / path).read_text(encoding="utf-8") for path in paths)
            declared = {name for match in DECLARED.findall(source) for name in match if name}
            self.assertGreater(len(declared), 4, tool)
            page = self.page(tool, "--help-all")
            entries = re.findall(r"^  (-.*?)(?:  |$)", page, re.MULTILINE)
            listed = [name for entry in entries for name in re.findall(r"--[\w-]+", entry)]
            self.assertEqual(sorted(declared | {"--help", "--help-all", "--version"}),
                             sorted(listed), tool)
            self.assertIn("Exit code: 0", page)
            for line in page.splitlines():
                self.assertLessEqual(len(line), COLUMNS, (tool, line))

    def test_every_option_is_described_and_its_value_named(self):
        for tool in SOURCES:
            page = self.page(tool, "--help-all")
            entries = re.findall(r"^  (-\S.*(?:\n {26}.*)*)", page, re.MULTILINE)
            for entry in entries:
                self.assertRegex(entry, r"(?:  |\n {26})[A-Za-z1-9].{6,}", (tool, entry))
        for option, value in (("--metadata", "FILE"), ("--max-memory", "SIZE"),
                              ("--kg", "PERCENT")):
            self.assertRegex(self.page("rlpcenc", "--help-all"), rf"  {option} {value}  ")

    def test_the_formats_of_the_input(self):
        for tool in ("rlpcenc", "rlpccmp"):
            page = self.page(tool, "--help-all")
            for kind, extension in (("Meshes", ".obj"), ("Point caches", ".pc2"),
                                    ("Animations", ".glb")):
                lists = re.findall(rf"^{kind}: +(\..+ or \.\w+)$", page, re.MULTILINE)
                self.assertEqual(len(lists), 1, (tool, kind))
                self.assertIn(extension, lists[0])

    def test_the_profile_of_an_option(self):
        groups = self.page("rlpcenc", "--help-all").split("\n\n")
        for heading, options in (("All profiles", ("--profile", "--components", "--partition")),
                                 ("Main and High profiles only", ("--bones", "--layer-groups")),
                                 ("Baseline profile only", ("--clusters", "--seeds"))):
            group = [text for text in groups if text.startswith(heading)]
            self.assertEqual(len(group), 1, heading)
            for option in options:
                self.assertIn(option, group[0])

    def test_the_interface_of_the_judge(self):
        page = self.ok("rlpcdec", "decode", "--help").out.decode()
        self.assertIn("--max-mem BYTES", page)
        self.assertIsNone(NOISE.search(page))

    def test_the_other_codecs(self):
        verbs = ("list", "encode", "decode", "order", "convert")
        for words in ((), *((verb,) for verb in verbs)):
            for option in ("--help", "--help-all"):
                page = self.ok("peer_codec", *words, option).out.decode()
                self.assertIsNone(NOISE.search(page), (words, NOISE.findall(page)))
                for line in page.splitlines():
                    self.assertLessEqual(len(line), COLUMNS, (words, line))
                for verb in verbs:
                    self.assertRegex(page, rf"(?m)^  {verb} +[A-Z]")
        self.assertIn(b"lorenzo", self.ok("peer_codec", "list").out)
        self.fails(64, "unknown verb encod", "peer_codec", "encod", "lorenzo", "a.obj")
        self.fails(64, "CODEC", "peer_codec", "encode", "none", "a.obj", "a.pc2", "-o", "x")
        self.fails(64, "VERB is required", "peer_codec")

    def test_what_was_meant(self):
        for tool, words, said in (
                ("rlpcenc", ["cow.obj", "cow.pc2", "-o", "x.rlpc"],
                 "did you mean --points cow.pc2?"),
                ("rlpccmp", ["a", "b", "a.mdd"], "did you mean --points-a a.mdd?"),
                ("rlpccmp", ["cow.obj", "cow.pc2", "fox.rlpc"],
                 "unexpected argument cow.pc2; did you mean --points-a cow.pc2?"),
                ("rlpcdec", ["a.rlpc", "--verfy"],
                 "unknown option --verfy; did you mean --verify?"),
                ("rlpcinfo", ["a.rlpc", "b.rlpc"], "unexpected argument b.rlpc")):
            self.fails(64, said, tool, *words)


if __name__ == "__main__":
    main()
