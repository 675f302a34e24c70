#!/usr/bin/env python3
"""The manual pages: how they are generated, and that man accepts those built."""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
import man_page

HELP = """Does a thing.
Usage: rlpcdec STREAM [OPTIONS]

  STREAM                  What to do it to

Main options:
  -o, --output FILE       Where it goes
  --size-of-everything N
                          How large
                          it is

Help:
  -h, --help              Print this

OUT is one of
  a.x    one
.dots are text, and so is \\ as well

Exit code: 0 done;
4 not."""


class Page(unittest.TestCase):
    def test_sections_and_options(self):
        lines = man_page.page("rlpcdec", "1.2", HELP).split("\n")
        self.assertEqual(lines[0], '.TH RLPCDEC 1 "" "rlpc 1.2" "RLPC"')
        self.assertIn(r"rlpcdec \- does a thing", lines)
        self.assertIn(r"\fBrlpcdec\fR STREAM [OPTIONS]", lines)
        self.assertEqual([line for line in lines if line.startswith(".SH")],
                         [".SH NAME", ".SH SYNOPSIS", ".SH ARGUMENTS", ".SH MAIN OPTIONS",
                          ".SH HELP", ".SH OUT IS ONE OF", ".SH EXIT STATUS", ".SH SEE ALSO"])
        text = "\n".join(lines)
        for entry in ("\\fBSTREAM\\fR\nWhat to do it to",
                      "\\fB\\-o\\fR, \\fB\\-\\-output\\fR FILE\nWhere it goes",
                      "\\fB\\-\\-size\\-of\\-everything\\fR N\nHow large\nit is"):
            self.assertIn(".TP\n" + entry, text)
        self.assertIn(r"\&.dots are text, and so is \e as well", lines)
        self.assertIn("0 done;", lines)


class Built(unittest.TestCase):
    folder = None

    def test_every_option_is_documented(self):
        for tool in man_page.TOOLS:
            help_all = subprocess.run([self.folder.parent / "bin" / tool, "--help-all"], check=True,
                                      capture_output=True, text=True).stdout
            options = re.findall(r"^  (?:-\w, )?(--[\w-]+)", help_all, re.MULTILINE)
            self.assertGreater(len(options), 6, tool)
            page = (self.folder / f"{tool}.1").read_text(encoding="utf-8").split("\n")
            terms = [line for above, line in zip(page, page[1:]) if above == ".TP"]
            for option in options:
                name = man_page.bold(option)
                self.assertTrue(any(name in term for term in terms), f"{tool} {option}")

    def test_man_takes_them(self):
        pages = sorted(self.folder.glob("*.1"))
        self.assertEqual([page.stem for page in pages], sorted(man_page.TOOLS))
        for page in pages:
            for command in (["groff", "-man", "-ww", "-z"],
                            ["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z"]):
                if not shutil.which(command[0]):
                    continue
                done = subprocess.run([*command, page], capture_output=True, text=True, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, ""), (command[0], page))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=pathlib.Path, help="folder of the pages")
    Built.folder = parser.parse_args().folder
    unittest.main(argv=[sys.argv[0]])
