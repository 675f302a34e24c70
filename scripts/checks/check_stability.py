#!/usr/bin/env python3
"""Released streams, and the bytes of the encoder, do not change.

* Every file listed in streams/vX.Y/SHA256SUMS has the digest in that file, and spec/versions.md
  marks exactly the versions and supplements with such a file as released. SHA256SUMS.sidecars lists
  the digests of all sidecars, which contain the expected output.
* The encoder writes the same bytes for streams/inputs as before:
  streams/inputs/encoder_digests.json lists the digests by version of the project (CMakeLists.txt).
  They may change with the version, or with an erratum (spec/errata.md) that the new entry names.
  While CHANGELOG.md marks a version as unreleased, its entry may be replaced: each change of the
  encoder's bytes is made on purpose.

  --bin FOLDER   folder of rlpcenc; without it, the encoder is not run
  --write        add an entry for the current encoder, or replace that of an unreleased version
  --erratum E    with --write: the erratum that explains the change
"""

import argparse
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
DIGESTS = "streams/inputs/encoder_digests.json"
BASELINE = ("--kg 0.3", "--kg 1 --preset fast --gof 20 --keep-order --hash frame",
            "--max-error 0.01 --frame world --gof 40",
            "--gof all --clusters 8 --components 6 --qu 12 --qc 12 --qdelta 12 --frame lcf")
MAIN = ("--profile main --kg 0.3",
        "--profile main --kg 1 --preset fast --gof 20 --keep-order --hash frame",
        "--profile main --bpvf 1.5 --preset fast --gof 40 --bones 4")
HIGH = ("--profile high --kg 0.3",
        "--profile high --kg 1 --preset fast --gof 20 --keep-order --hash frame",
        "--profile high --kg 0.3 --gof-kind inter --preset fast",
        "--profile high --max-error 0.01 --low-delay --keep-order")


def released(root):
    """Complaints about the streams of released versions."""
    text = (root / "spec" / "versions.md").read_text(encoding="utf-8")
    stated = {m.group(1): m.group(2).strip() for m in
              re.finditer(r"^\| (\d+\.\d+(?:s\d+)?) \|[^|]*\|([^|]*)\|$", text, re.MULTILINE)}
    if not stated:
        yield "spec/versions.md: no table of versions"
    for version, status in stated.items():
        sums = root / "streams" / f"v{version}" / "SHA256SUMS"
        if status.startswith("released") != sums.is_file():
            yield (f"spec/versions.md: {version} is `{status}`, but {sums.relative_to(root)} is "
                   f"{'there' if sums.is_file() else 'missing'}")
    for sums in sorted(root.glob("streams/v*/SHA256SUMS")):
        if sums.parent.name[1:] not in stated:
            yield f"{sums.relative_to(root)}: spec/versions.md does not know this version"
        yield from changed(sums, "; supersede the stream by a revision instead")
        yield from changed_sidecars(sums.with_name("SHA256SUMS.sidecars"))


def changed_sidecars(sums):
    if not sums.is_file():
        yield f"{sums}: missing, but the version is released; run scripts/streams sidecars"
        return
    yield from changed(sums, "; what is expected of it never changes. If fields were only added, "
                       "run scripts/streams sidecars")
    listed = {line.split("  ", 1)[1] for line in sums.read_text(encoding="utf-8").splitlines()}
    for path in sorted(sums.parent.glob("*/*/*.json")):
        name = path.relative_to(sums.parent).as_posix()
        if path.with_suffix(".rlpc").is_file() and name not in listed:
            yield f"{path}: not in {sums.name}"


def changed(sums, remedy):
    for line in sums.read_text(encoding="utf-8").splitlines():
        digest, name = line.split("  ", 1)
        path = sums.parent / name
        if not path.is_file():
            yield f"{path}: released, but missing"
        elif hashlib.sha256(path.read_bytes()).hexdigest() != digest:
            yield f"{path}: changed since its release{remedy}"


def encoder_digests(root, bin_folder):
    """Digest of what the encoder writes, for each animation and setting."""
    digests = {}
    with tempfile.TemporaryDirectory(prefix="rlpc-stability-") as folder:
        out = pathlib.Path(folder, "a.rlpc")
        for mesh in sorted((root / "streams" / "inputs").glob("*.obj")):
            for setting in BASELINE + MAIN + HIGH:
                profile = () if setting in MAIN + HIGH else ("--profile", "baseline")
                subprocess.run([bin_folder / "rlpcenc", mesh, "--points", mesh.with_suffix(".pc2"),
                                "-o", out, *profile, *setting.split()], check=True,
                               capture_output=True)
                digest = hashlib.sha256(out.read_bytes()).hexdigest()
                digests[f"{mesh.stem} {setting}"] = digest[:32]
    return digests


def entries_of(root):
    path = root / DIGESTS
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else []


def committed_entries(root):
    done = subprocess.run(["git", "-C", root, "show", f"HEAD:{DIGESTS}"], capture_output=True)
    return json.loads(done.stdout) if done.returncode == 0 else []


def unreleased(root):
    """The version that CHANGELOG.md calls unreleased; None if all of them are released."""
    found = re.search(r"^## (\d+\.\d+\.\d+) - unreleased$",
                      (root / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    return found[1] if found else None


def entries(root, before):
    """Complaints about the list itself: entries are only added, each change has its reason.

    before: the entries of the last commit.
    """
    now = entries_of(root)
    kept = [e for e in before if e["version"] != unreleased(root)]
    if now[:len(kept)] != kept:
        yield f"{DIGESTS}: entries of released versions were changed; they may only be added to"
    errata = (root / "spec" / "errata.md").read_text(encoding="utf-8")
    for i, entry in enumerate(now):
        erratum = entry["erratum"]
        if erratum is not None and not re.search(rf"^### {re.escape(erratum)}\b", errata,
                                                 re.MULTILINE):
            yield f"{DIGESTS}: {erratum} is not in spec/errata.md"
        if erratum is None and entry["version"] in [e["version"] for e in now[:i]]:
            yield f"{DIGESTS}: a second entry for {entry['version']} names no erratum"


def encoder(root, bin_folder):
    """Complaints about what the encoder writes now."""
    version = project_version(root)
    found = [e for e in entries_of(root) if e["version"] == version]
    if not found:
        yield f"{DIGESTS}: no entry for version {version}; add one with --write"
        return
    now = encoder_digests(root, bin_folder)
    different = sorted(k for k in now.keys() | found[-1]["digests"].keys()
                       if now.get(k) != found[-1]["digests"].get(k))
    for name in different:
        remedy = ("--write" if version == unreleased(root) else
                  "raise the version in CMakeLists.txt or write an erratum, then --write")
        yield (f"the encoder writes other bytes than version {version} did: {name}. If that is "
               f"meant, {remedy}")


def project_version(root):
    text = (root / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(rlpc VERSION (\S+)", text).group(1)


def write(root, bin_folder, erratum):
    found = [e for e in entries_of(root) if e["version"] != unreleased(root)]
    found.append({"version": project_version(root), "erratum": erratum,
                  "digests": encoder_digests(root, bin_folder)})
    (root / DIGESTS).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=ROOT)
    parser.add_argument("--bin", type=pathlib.Path)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--erratum")
    options = parser.parse_args()
    if options.write:
        write(options.root, options.bin.resolve(), options.erratum)
    complaints = [*released(options.root),
                  *entries(options.root, committed_entries(options.root))]
    if options.bin is not None:
        complaints += encoder(options.root, options.bin.resolve())
    for complaint in complaints:
        print(f"stability: {complaint}", file=sys.stderr)
    streams = sum(len(p.read_text().splitlines())
                  for p in options.root.glob("streams/v*/SHA256SUMS*"))
    print(f"stability: {streams} released files, {len(entries_of(options.root))} states of the "
          f"encoder, {len(complaints)} complaints")
    return int(bool(complaints))


if __name__ == "__main__":
    sys.exit(main())
