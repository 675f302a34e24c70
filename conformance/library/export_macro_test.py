#!/usr/bin/env python3
"""RLPC_API is what each platform needs: the headers, preprocessed as there."""

import argparse
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADER = "decoder/c_api/rlpc_c_decoder.h"
FUNCTION = "size_t rlpc_decoder_bytes(void);"
# Definitions, and what stands before the function.
CASES = {
    ("-D_WIN32", "-DRLPC_BUILDING"): "__declspec(dllexport)",
    ("-D_WIN32",): "__declspec(dllimport)",
    ("-D_WIN32", "-DRLPC_STATIC"): "",
    ("-U_WIN32",): '__attribute__((visibility("default")))',
    ("-U_WIN32", "-DRLPC_BUILDING"): '__attribute__((visibility("default")))',
    ("-U_WIN32", "-DRLPC_STATIC"): "",
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cc", default="cc")
    args = parser.parse_args()
    wrong = 0
    for definitions, expected in CASES.items():
        text = subprocess.run(
            [args.cc, "-std=c99", "-E", "-P", "-I", ROOT, *definitions, "-x", "c",
             ROOT / HEADER], check=True, capture_output=True, text=True).stdout
        lines = [line.strip() for line in text.splitlines() if line.endswith(FUNCTION)]
        if lines != [f"{expected} {FUNCTION}".strip()]:
            print(f"{' '.join(definitions)}: expected {expected!r}, got {lines}")
            wrong += 1
    print(f"{len(CASES) - wrong} of {len(CASES)} as expected")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
