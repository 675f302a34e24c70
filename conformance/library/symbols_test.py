#!/usr/bin/env python3
"""A shared library in C exports exactly the functions that its headers declare; with --decoder, the
headers of the decoder alone. Stripped, it is no larger than --max-bytes."""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = ("common/c_api/rlpc_clip.h", "common/c_api/rlpc_status.h",
           "decoder/c_api/rlpc_attributes.h", "decoder/c_api/rlpc_c_decoder.h",
           "decoder/c_api/rlpc_frame_output.h", "decoder/c_api/rlpc_pose.h",
           "encoder/c_api/rlpc_c_encoder.h")


def declared(headers):
    """Names of the functions in the headers."""
    text = "".join((ROOT / header).read_text(encoding="utf-8") for header in headers)
    return set(re.findall(r"^RLPC_API [^;(]*?\b(rlpc_\w+)\(", text, re.MULTILINE))


def small_enough(args):
    with tempfile.TemporaryDirectory() as folder:
        stripped = pathlib.Path(folder) / "stripped.so"
        subprocess.run([args.strip, args.library, "-o", stripped], check=True)
        num_bytes = stripped.stat().st_size
    print(f"{num_bytes} bytes when stripped")
    if args.max_bytes is None or num_bytes <= args.max_bytes:
        return True
    print(f"that is more than {args.max_bytes}")
    return False


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("library")
    parser.add_argument("--nm", default="nm")
    parser.add_argument("--strip", default="strip")
    parser.add_argument("--decoder", action="store_true")
    parser.add_argument("--max-bytes", type=int)
    args = parser.parse_args()
    headers = [header for header in HEADERS if not args.decoder or "encoder" not in header]
    lines = subprocess.run([args.nm, "-D", "--defined-only", args.library], check=True,
                           capture_output=True, text=True).stdout.splitlines()
    shown = {line.split()[-1].split("@")[0] for line in lines}
    wanted = declared(headers)
    for name in sorted(shown - wanted):
        print(f"exported, but in no header: {name}")
    for name in sorted(wanted - shown):
        print(f"in a header, but not exported: {name}")
    if shown == wanted and wanted:
        print(f"{len(shown)} functions are exported")
    return 0 if shown == wanted and wanted and small_enough(args) else 1


if __name__ == "__main__":
    sys.exit(main())
