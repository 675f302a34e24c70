#!/usr/bin/env python3
"""librlpc.so exports exactly the functions that its headers declare."""

import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = ("common/c_api/rlpc_clip.h", "common/c_api/rlpc_status.h",
           "decoder/c_api/rlpc_decode.h", "encoder/c_api/rlpc_encode.h")


def declared():
    """Names of the functions in the headers."""
    text = "".join((ROOT / header).read_text(encoding="utf-8") for header in HEADERS)
    return set(re.findall(r"^RLPC_API [^;(]*?\b(rlpc_\w+)\(", text, re.MULTILINE))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("library")
    parser.add_argument("--nm", default="nm")
    args = parser.parse_args()
    lines = subprocess.run([args.nm, "-D", "--defined-only", args.library], check=True,
                           capture_output=True, text=True).stdout.splitlines()
    shown = {line.split()[-1].split("@")[0] for line in lines}
    wanted = declared()
    for name in sorted(shown - wanted):
        print(f"exported, but in no header: {name}")
    for name in sorted(wanted - shown):
        print(f"in a header, but not exported: {name}")
    if shown == wanted and wanted:
        print(f"{len(shown)} functions are exported")
    return 0 if shown == wanted and wanted else 1


if __name__ == "__main__":
    sys.exit(main())
