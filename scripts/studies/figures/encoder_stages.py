#!/usr/bin/env python3
"""How long the stages of encoding take, animation by animation, with one thread.

  encoder_stages.py BIN OUT.json [OPTION...] [INPUT...]

BIN holds the programs; OPTION: --profile P, --preset P and --kg K, as for rlpcenc; INPUT: what
scripts/compare takes (default: the bundled animations). Prints a table, and writes it to OUT.json.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "scripts" / "studies" / "comparison"))
import inputs  # after the path to it
import measure


def encode(tool, found, options):
    """The times of an encoding: {"animation", "vertex_frames", "bytes",
    "stages": {stage: seconds}}."""
    with tempfile.TemporaryDirectory() as folder:
        words = [found.path, *(("--points", found.points) if found.points else ()),
                 "--threads", 1, "--no-attributes", "--quiet", "--json", "--verbose", *options,
                 "-o", pathlib.Path(folder) / "a.rlpc"]
        done = subprocess.run([str(tool), *map(str, words)], capture_output=True, text=True,
                              check=False)
    if not done.stdout:
        raise measure.Failure(f"{found.path}: {done.stderr.strip()}")
    report = json.loads(done.stdout)
    return {"animation": found.name, "vertex_frames": report["num_vertices"] * report["num_frames"],
            "bytes": report["bytes"], "stages": report["stage_seconds"]}


def order(runs):
    """The stages that take at least a hundredth of some encoding, those that take most first."""
    totals = {}
    for run in runs:
        for stage, seconds in run["stages"].items():
            totals.setdefault(stage, 0.0)
            totals[stage] += seconds / sum(run["stages"].values())
    shown = {stage for run in runs for stage, seconds in run["stages"].items()
             if seconds >= 0.01 * sum(run["stages"].values())}
    return sorted(shown, key=lambda stage: -totals[stage])


def table(runs):
    """Lines of a table: a row for each stage, a column for each animation; shares in per cent."""
    head = ["", *(run["animation"] for run in runs)]
    sums = [sum(run["stages"].values()) for run in runs]
    speeds = [run["vertex_frames"] / 1e6 / seconds
              for run, seconds in zip(runs, sums, strict=True)]
    rows = [head, ["seconds", *(f"{seconds:.2f}" for seconds in sums)],
            ["million vertex-frames/s", *(f"{speed:.3f}" for speed in speeds)],
            ["bytes", *(str(run["bytes"]) for run in runs)]]
    for stage in order(runs):
        shares = [100 * run["stages"].get(stage, 0.0) / seconds
                  for run, seconds in zip(runs, sums, strict=True)]
        rows.append([stage + ", %", *(f"{share:.0f}" for share in shares)])
    widths = [max(len(row[i]) for row in rows) for i in range(len(head))]
    return ["  ".join([row[0].ljust(widths[0]),
                       *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:],
                                                                  strict=True))]).rstrip()
            for row in rows]


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="scripts/bench --stages", allow_abbrev=False)
    parser.add_argument("bin", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("out", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("inputs", nargs="*", metavar="INPUT",
                        help="as for scripts/compare (default: the bundled animations)")
    for option, default in (("profile", "high"), ("preset", "medium"), ("kg", "0.1")):
        parser.add_argument(f"--{option}", default=default,
                            help=f"as for rlpcenc (default: {default})")
    given = parser.parse_intermixed_args(arguments)
    options = [word for option in ("profile", "preset", "kg")
               for word in (f"--{option}", getattr(given, option))]
    try:
        found = inputs.find(given.inputs or [ROOT / "streams" / "inputs"])
        runs = [encode(given.bin / "rlpcenc", each, options) for each in found]
    except measure.Failure as failure:
        sys.exit(f"bench: {failure}")
    given.out.parent.mkdir(parents=True, exist_ok=True)
    given.out.write_text(json.dumps(runs, indent=2) + "\n", encoding="utf-8")
    print("\n".join(table(runs)))


if __name__ == "__main__":
    main()
