#!/usr/bin/env python3
"""clang-tidy 14 accepts all C++ sources that the preset `tidy` compiles.

A verdict is kept in build/check/tidy under a digest of everything in the repository that it
depends on: the source, the headers that it includes, its compile command, .clang-tidy. Sources
that were accepted before are not read again, and a check that was interrupted goes on.
"""

import concurrent.futures
import functools
import hashlib
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import cpp_source

TOOL = "clang-tidy-14"
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"\n]+)"', re.MULTILINE)
_NOISE = re.compile(r"^\d+ warnings? generated\.$|note: expanded from macro")

# Widths of products of small constants do not matter in tests.
_OF_TESTS = ["--checks=-bugprone-implicit-widening-of-multiplication-result"]


@functools.lru_cache(maxsize=None)
def _includes(path):
    return tuple(_INCLUDE.findall(path.read_text(encoding="utf-8")))


def dependencies(source, folders):
    """The source and every file that it includes by a name in quotes from one of the folders,
    directly or not, in sorted order."""
    found, waiting = set(), [source]
    while waiting:
        path = waiting.pop()
        if path in found:
            continue
        found.add(path)
        for name in _includes(path):
            for folder in (path.parent, *folders):
                if (folder / name).is_file():
                    waiting.append((folder / name).resolve())
                    break
    return sorted(found)


def _folders(root, arguments):
    names = [part[2:] for part in arguments if part.startswith("-I") and len(part) > 2]
    return [folder for folder in map(pathlib.Path, names)
            if folder == root or root in folder.parents]


def _options(source):
    return _OF_TESTS if source.stem.endswith("_test") else []


def key(root, source, command, version):
    """A digest of what the verdict on a source depends on."""
    digest = hashlib.sha256()
    settings = (root / ".clang-tidy").read_text(encoding="utf-8")
    for text in (version, settings, command.replace(str(root), ""), *_options(source)):
        digest.update(hashlib.sha256(text.encode()).digest())
    for path in dependencies(source, _folders(root, shlex.split(command))):
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.hexdigest()


def sources(root, build):
    """The C++ sources of the layers in the list of compile commands, with their commands."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    commands = {}
    for entry in entries:
        path = pathlib.Path(entry["file"])
        if path.suffix == ".cpp" and root in path.parents and \
                path.relative_to(root).parts[0] in cpp_source.LAYERS:
            commands.setdefault(path, entry["command"])
    return dict(sorted(commands.items()))


def findings(tool, build, source):
    """What clang-tidy says of a source; empty if it accepts it."""
    result = subprocess.run([tool, "--quiet", "-p", str(build), *_options(source), str(source)],
                            capture_output=True, text=True, errors="replace", check=False)
    lines = [line for line in (result.stdout + result.stderr).splitlines()
             if not _NOISE.search(line)]
    if result.returncode == 0:
        return ""
    return "\n".join(lines) or f"{TOOL} ended with {result.returncode}"


def check(root):
    tool = shutil.which(TOOL)
    if tool is None:
        return [f"{TOOL} is not installed"], ""
    build = root / "build" / "tidy"
    kept = root / "build" / "check" / "tidy"
    kept.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([tool, "--version"], capture_output=True, text=True,
                             check=True).stdout
    keys = {source: key(root, source, command, version)
            for source, command in sources(root, build).items()}
    if not keys:
        return ["the preset compiles no source of the layers"], ""
    waiting = [source for source in keys if not (kept / keys[source]).is_file()]
    complaints = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, text in zip(waiting, pool.map(
                lambda source: _verdict(tool, build, source, kept / keys[source]), waiting)):
            if text:
                complaints.append(f"{source.relative_to(root)}:\n{text}")
    return complaints, f"{len(keys)} sources are accepted, {len(waiting)} of them read now"


def _verdict(tool, build, source, kept):
    text = findings(tool, build, source)
    if not text:
        kept.touch()
    return text


if __name__ == "__main__":
    sys.exit(cpp_source.run("tidy", __doc__, check))
