#!/usr/bin/env python3
"""Compression does not get worse.

Encodes the bundled animations with fixed settings and compares the bytes with
streams/inputs/encoder_bytes.json. Fails if one stream grows by more than 0.5 %, or all of them by
more than 0.2 % in the geometric mean; also fails for a missed target, a stream without an entry, or
an entry without a stream. Streams may get smaller; --write then records the gain.

  --bin FOLDER   folder of rlpcenc
  --write        replace the table by the current results; the commit states the reason
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = "streams/inputs/encoder_bytes.json"
# Settings that check_stability.py does not already encode.
POSITIONS_ALONE = ("--no-attributes",)
SETTINGS = ("--kg 1", "--kg 0.2", "--kg 0.05", "--kg 0.1 --gof all", "--kg 0.2 --gof 30",
            "--kg 0.2 --preset fast",
            "--profile baseline --kg 1", "--profile baseline --kg 0.1 --gof all",
            "--profile baseline --kg 0.2 --gof 30",
            "--profile high --kg 1", "--profile high --kg 0.1",
            "--profile high --kg 0.3 --gof-kind inter --preset fast")
MAX_RISE_PER_MILLE = 5
MAX_MEAN_RISE = 0.002


def inputs(root):
    """The arguments of rlpcenc for each animation."""
    folder = root / "streams" / "inputs"
    yield from ((p.stem, (p, "--points", p.with_suffix(".pc2"))) for p in folder.glob("*.obj"))
    yield from ((p.stem, (p,)) for p in folder.glob("*.glb"))


def measure(root, bin_folder):
    """Bytes of each stream; none where the target was missed."""
    found = {}
    with tempfile.TemporaryDirectory(prefix="rlpc-rate-") as folder:
        out = pathlib.Path(folder, "a.rlpc")
        for name, arguments in sorted(inputs(root)):
            for setting in SETTINGS:
                done = subprocess.run([bin_folder / "rlpcenc", *arguments, "-o", out,
                                       *setting.split(), *POSITIONS_ALONE],
                                      capture_output=True)
                if done.returncode not in (0, 2):
                    raise subprocess.CalledProcessError(done.returncode, done.args,
                                                        stderr=done.stderr)
                met = done.returncode == 0
                found[f"{name} {setting}"] = out.stat().st_size if met else None
    return found


def compare(table, found):
    """Complaints about streams that were measured."""
    if not found:
        yield "no animation was encoded"
    if mean_ratio(table, found) > 1 + MAX_MEAN_RISE:
        yield f"all streams: {100 * (mean_ratio(table, found) - 1):+.2f} % on average"
    for name in sorted(table.keys() | found.keys()):
        if name not in found:
            yield f"{name}: {TABLE} has it, but it was not encoded"
        elif found[name] is None:
            yield f"{name}: the target was missed"
        elif name not in table:
            yield f"{name}: not in {TABLE}; add it with --write"
        elif 1000 * (found[name] - table[name]) > MAX_RISE_PER_MILLE * table[name]:
            yield (f"{name}: {found[name]} bytes, {100 * (found[name] / table[name] - 1):+.2f} % "
                   f"over {table[name]}")


def mean_ratio(table, found):
    """Geometric mean of bytes now over those in the table."""
    logs = [math.log(found[name] / table[name]) for name in table if found.get(name)]
    return math.exp(sum(logs) / len(logs)) if logs else 1.0


def read_table(root):
    path = root / TABLE
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def write_table(root, found):
    (root / TABLE).write_text(json.dumps(found, indent=1, sort_keys=True) + "\n",
                              encoding="utf-8")


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args(arguments)
    table, found = read_table(options.root), measure(options.root, options.bin.resolve())
    change = 100 * (mean_ratio(table, found) - 1)
    if options.write and found and None not in found.values():
        write_table(options.root, found)
        table = found
    complaints = list(compare(table, found))
    for complaint in complaints:
        print(f"rate: {complaint}", file=sys.stderr)
    print(f"rate: {len(found)} streams, {change:+.2f} % on average, "
          f"{len(complaints)} complaints")
    return int(bool(complaints))


if __name__ == "__main__":
    sys.exit(main())
