#!/usr/bin/env python3
"""The checks of Python and JavaScript sources find faults, and do not pass without sources or
tools; the Git hook accepts the subjects of commits that it should."""

import importlib.machinery
import importlib.util
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import check_javascript
import check_python
import check_tidy
import cpp_source
from test_checks import TreeTest

HOOK = cpp_source.repository_root() / "scripts" / "hooks" / "commit-msg"
_LOADER = importlib.machinery.SourceFileLoader("commit_msg", str(HOOK))
commit_msg = importlib.util.module_from_spec(
    importlib.util.spec_from_loader(_LOADER.name, _LOADER))
_LOADER.exec_module(commit_msg)


class Python(TreeTest):
    @unittest.skipUnless(shutil.which("flake8"), "flake8 is not installed")
    def test_modules_and_scripts_are_checked(self):
        unused = "import os\n"
        self.assert_clean(check_python.check, {"decoder/a.py": "A = 1\n", "decoder/b": unused})
        self.assert_one(check_python.check, {"decoder/a.py": unused}, "decoder/a.py:1:1", "F401")
        self.assert_one(check_python.check, {"scripts/a": "#!/usr/bin/env python3\n" + unused},
                        "scripts/a:2:1", "F401")

    def test_no_tool_and_no_source_are_complaints(self):
        with unittest.mock.patch.object(shutil, "which", return_value=None):
            self.assert_one(check_python.check, {"decoder/a.py": ""}, "not installed")
        with unittest.mock.patch.object(shutil, "which", return_value="flake8"):
            self.assert_one(check_python.check, {"a.py": ""}, "sees nothing")


class Tidy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write(".clang-tidy", "Checks: -*,misc-unused-parameters\nWarningsAsErrors: '*'\n")
        self.write("common/a.h", "#pragma once\nint f(int x);\n")
        self.write("common/a.cpp", '#include "common/a.h"\nint f(int x) { return x; }\n')
        self.write("common/b.cpp", "int g() { return 1; }\n")
        self.compiled("common/a.cpp", "common/b.cpp")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def compiled(self, *names):
        self.write("build/tidy/compile_commands.json", json.dumps([
            {"directory": str(self.root), "file": str(self.root / name),
             "command": f"clang++ -I{self.root} -c {self.root / name}"} for name in names]))

    def read(self, accepted=True):
        """The names of the sources that clang-tidy is called for, and the complaints."""
        names = []

        def findings(_tool, _build, source):
            names.append(source.name)
            return "" if accepted else "no"

        with unittest.mock.patch.object(check_tidy, "findings", findings), \
                unittest.mock.patch.object(shutil, "which", return_value=sys.executable):
            complaints, _ = check_tidy.check(self.root)
        return sorted(names), complaints

    def test_what_was_accepted_is_read_again_only_if_it_may_have_changed(self):
        self.assertEqual(self.read(), (["a.cpp", "b.cpp"], []))
        self.assertEqual(self.read(), ([], []))
        self.write("common/a.h", "#pragma once\nint f(int y);\n")
        self.assertEqual(self.read(), (["a.cpp"], []))
        self.write(".clang-tidy", "Checks: -*,bugprone-*\n")
        self.assertEqual(self.read(), (["a.cpp", "b.cpp"], []))

    def test_what_was_not_accepted_is_read_again(self):
        for _ in range(2):
            names, complaints = self.read(accepted=False)
            self.assertEqual(names, ["a.cpp", "b.cpp"])
            self.assertEqual(len(complaints), 2)

    def test_sources_are_read_once_within_the_one_that_includes_them(self):
        whole = "".join(f'#include "{self.root}/common/{name}.cpp"\n' for name in "ab")
        self.write("build/tidy/Unity/unity_common.cxx", whole)
        self.write("common/c.cpp", "int h() { return 1; }\n")
        self.compiled("common/a.cpp", "common/c.cpp", "build/tidy/Unity/unity_common.cxx")
        self.assertEqual(self.read(), (["c.cpp", "unity_common.cxx"], []))
        self.write("common/a.h", "#pragma once\nint f(int z);\n")
        self.assertEqual(self.read(), (["unity_common.cxx"], []))

    def test_no_source_is_a_complaint(self):
        self.compiled()
        self.assertEqual(len(self.read()[1]), 1)

    @unittest.skipUnless(shutil.which(check_tidy.TOOL), "clang-tidy is not installed")
    def test_a_planted_fault_is_found_in_a_source_that_is_included(self):
        self.write(".clang-tidy", "Checks: -*,misc-unused-parameters\nWarningsAsErrors: '*'\n"
                                  "HeaderFilterRegex: '/common/[a-z]*\\.(h|cpp)$'\n")
        self.write("common/b.cpp", "int g(int unused) { return 1; }\n")
        whole = "".join(f'#include "{self.root}/common/{name}.cpp"\n' for name in "ab")
        self.write("build/tidy/Unity/unity_common.cxx", whole)
        self.compiled("build/tidy/Unity/unity_common.cxx")
        complaints = check_tidy.check(self.root)[0]
        self.assertEqual(len(complaints), 1)
        self.assertIn("common/b.cpp:1", complaints[0])

    @unittest.skipUnless(shutil.which(check_tidy.TOOL), "clang-tidy is not installed")
    def test_a_planted_fault_is_found(self):
        self.assertEqual(check_tidy.check(self.root)[0], [])
        self.write("common/b.cpp", "int g(int unused) { return 1; }\n")
        complaints = check_tidy.check(self.root)[0]
        self.assertEqual(len(complaints), 1)
        self.assertIn("misc-unused-parameters", complaints[0])


class JavaScript(TreeTest):
    def test_no_tool_and_no_source_are_complaints(self):
        self.assert_one(check_javascript.check, {"a.js": ""}, "sees nothing")
        with unittest.mock.patch.object(shutil, "which", return_value=None):
            self.assert_one(check_javascript.check, {"decoder/a.mjs": ""}, "not installed")

    def test_failures_of_npm_are_explained(self):
        lint = str(check_javascript.LINT)
        tree = {"decoder/a.js": "", f"{lint}/package.json": "", f"{lint}/package-lock.json": ""}
        done = subprocess.CompletedProcess([], 1, "", "npm error code ENOTFOUND\n")
        with unittest.mock.patch.object(shutil, "which", return_value="npm"), \
                unittest.mock.patch.object(subprocess, "run", return_value=done):
            self.assert_one(check_javascript.check, tree, "needs a network: code ENOTFOUND")


class Subjects(unittest.TestCase):
    def assert_complaints(self, subject, *expected):
        found = list(commit_msg.complaints(subject))
        self.assertEqual(len(found), len(expected), (subject, found))
        for complaint, words in zip(found, expected):
            self.assertIn(words, complaint)

    def test_subjects_that_are_accepted(self):
        for subject in ("parse: Reject lcf_bits_minus1 below 3 (7.3.4)", "README: Wrap",
                        "streams, judge: Keep help within a screen", "glTF: Compress more",
                        "CMakeLists.txt: Embed pages", "C library: Bring the allocator along",
                        ".ci/run: Pass arguments on", "rlpcdec --as auto: Focus on skins",
                        "Merge branch 'a' into b.", 'Revert "parse: Reject lcf_bits_minus1"',
                        "fixup! parse: Reject lcf_bits_minus1 below 3"):
            self.assert_complaints(subject)

    def test_subjects_that_are_refused(self):
        self.assert_complaints("parse: Reject " + "x" * 59, "73 columns")
        self.assert_complaints("parse: Reject it.", "full stop")
        for subject in ("Reject it", "Parse: Reject it", "parse: reject it", "parse Reject it",
                        "parse:Reject it", ""):
            self.assert_complaints(subject, "is not `area: Sentence`")
        for word in ("Rejects", "Rejected", "Rejecting", "The", "Sizes,"):
            self.assert_complaints(f"parse: {word} what is wrong", "imperative")

    def test_git_passes_the_message_in_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            message = pathlib.Path(folder) / "COMMIT_EDITMSG"
            for text, said in (("\n# a comment\nparse: Reject it\n\nAll reasons.\n", ""),
                               ("Parse: Reject it\n", "commit-msg: the subject is not")):
                message.write_text(text, encoding="utf-8")
                done = subprocess.run([HOOK, message], capture_output=True, text=True)
                self.assertEqual(done.returncode, 1 if said else 0)
                self.assertTrue(done.stderr.startswith(said), done.stderr)


if __name__ == "__main__":
    unittest.main()
