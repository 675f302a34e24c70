#!/usr/bin/env python3
"""Every test has one label that says what it tests, so that `ctest -L` and `scripts/test --fast`
leave none out unseen. The labels are those of scripts/cmake/tests.cmake.

  check_labels.py BUILD
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

import cpp_source

LIST = pathlib.Path("scripts/cmake/tests.cmake")
_LINE = re.compile(r"^#   (\w+) {2,}\S", re.MULTILINE)
MORE = {"slow", "pure"}


def kinds(root):
    return set(_LINE.findall((root / LIST).read_text(encoding="utf-8")))


def complaints_of(tests, known):
    """`tests`: name to labels."""
    found = []
    for name, labels in sorted(tests.items()):
        if len(labels & known) != 1:
            found.append(f"{name}: one label of {', '.join(sorted(known))} is expected, "
                         f"not {', '.join(sorted(labels & known)) or 'none'}")
        for label in sorted(labels - known - MORE):
            found.append(f"{name}: {label}: not in {LIST}")
    for label in sorted(known - set().union(*tests.values())):
        found.append(f"{LIST}: no test is labelled {label}")
    return found


def labels_of(build):
    done = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"],
                          capture_output=True, text=True, check=True)
    return {test["name"]: {label for p in test["properties"] if p["name"] == "LABELS"
                           for label in p["value"]}
            for test in json.loads(done.stdout)["tests"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    tests = labels_of(parser.parse_args().build)
    complaints = complaints_of(tests, kinds(cpp_source.repository_root()))
    return cpp_source.report("labels", complaints, f"{len(tests)} tests have their label")


if __name__ == "__main__":
    sys.exit(main())
