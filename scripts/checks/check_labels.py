#!/usr/bin/env python3
"""Every test has one of the labels of scripts/cmake/tests.cmake, so that `ctest -L` and
`scripts/test --fast` skip none by accident; and every test that a preset names exists.

  check_labels.py BUILD
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

import cpp_source

PRESETS = "CMakePresets.json"
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


def unknown_names(presets, tests):
    """Presets choose tests by `^(name|name...)`."""
    for preset in presets["testPresets"]:
        chosen = preset.get("filter", {}).get("include", {}).get("name")
        if chosen is None:
            continue
        names = re.fullmatch(r"\^\(([\w.|]+)\)", chosen)
        if not names:
            yield f"{PRESETS}: {preset['name']}: expected ^(name|name...), not {chosen}"
            continue
        for name in names.group(1).split("|"):
            if not any(test.startswith(name) for test in tests):
                yield f"{PRESETS}: {preset['name']}: no test's name begins with {name}"


def labels_of(build):
    done = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"],
                          capture_output=True, text=True, check=True)
    return {test["name"]: {label for p in test["properties"] if p["name"] == "LABELS"
                           for label in p["value"]}
            for test in json.loads(done.stdout)["tests"]
            if not test["name"].endswith("_NOT_BUILT")}  # ctest itself fails for these


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    tests = labels_of(parser.parse_args().build)
    root = cpp_source.repository_root()
    complaints = complaints_of(tests, kinds(root))
    complaints += unknown_names(json.loads((root / PRESETS).read_text(encoding="utf-8")), tests)
    return cpp_source.report("labels", complaints, f"{len(tests)} tests have their label")


if __name__ == "__main__":
    sys.exit(main())
