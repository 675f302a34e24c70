#!/usr/bin/env python3
"""clang-tidy 14 accepts all C++ sources that the preset `tidy` compiles.

The sources of a folder are read as the one source that includes them (RLPC_UNITY): nearly all of
the time goes into headers, most of them those of libraries.

A verdict is kept in build/check/tidy under a digest of everything in the repository that it
depends on: the source, what it includes, its compile command, .clang-tidy. Sources that were
accepted before are not read again, and a check that was interrupted goes on.
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
_IN_TESTS = "-bugprone-implicit-widening-of-multiplication-result"
_IN_UNITY = "-bugprone-suspicious-include"  # it includes sources


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


def _is_unity(source):
    return source.suffix == ".cxx"


def _contents(source):
    """The sources that a compiled source consists of."""
    return tuple(map(pathlib.Path, _includes(source))) if _is_unity(source) else (source,)


def _options(source):
    less = [_IN_TESTS] if any(path.stem.endswith("_test") for path in _contents(source)) else []
    less += [_IN_UNITY] if _is_unity(source) else []
    return ["--checks=" + ",".join(less)] if less else []


def key(root, source, command, version):
    """A digest of what the verdict on a source depends on."""
    digest = hashlib.sha256()
    settings = (root / ".clang-tidy").read_text(encoding="utf-8")
    for text in (version, settings, command.replace(str(root), ""), *_options(source)):
        digest.update(hashlib.sha256(text.encode()).digest())
    for path in dependencies(source, _folders(root, shlex.split(command))):
        text = path.read_bytes().replace(str(root).encode(), b"")
        digest.update(hashlib.sha256(text).digest())
    return digest.hexdigest()


def _is_in_layers(root, source):
    return root in source.parents and source.relative_to(root).parts[0] in cpp_source.LAYERS


def sources(root, build):
    """Of what the list of compile commands compiles, as little as contains every C++ source of the
    layers, with its commands."""
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    compiled = {}
    for entry in sorted(entries, key=lambda entry: entry["file"]):
        path = pathlib.Path(entry["file"])
        contents = _contents(path) if path.suffix in (".cpp", ".cxx") else ()
        if contents and all(_is_in_layers(root, source) for source in contents):
            compiled[path] = (contents, entry["command"])
    chosen, read = {}, set()
    for path in sorted(compiled, key=lambda path: (-len(compiled[path][0]), path)):
        contents, command = compiled[path]
        if not read.issuperset(contents):
            chosen[path] = command
            read.update(contents)
    return chosen


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
    compiled = sources(root, build)
    keys = {source: key(root, source, command, version) for source, command in compiled.items()}
    if not keys:
        return ["the preset compiles no source of the layers"], ""
    waiting = [source for source in keys if not (kept / keys[source]).is_file()]
    complaints = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, text in zip(waiting, pool.map(
                lambda source: _verdict(tool, build, source, kept / keys[source]), waiting)):
            if text:
                complaints.append(f"{source.relative_to(root)}:\n{text}")
    count = len({source for path in keys for source in _contents(path)})
    return complaints, (f"{count} sources are accepted, read as {len(keys)}, "
                        f"{len(waiting)} of them now")


def _verdict(tool, build, source, kept):
    text = findings(tool, build, source)
    if not text:
        kept.touch()
    return text


if __name__ == "__main__":
    sys.exit(cpp_source.run("tidy", __doc__, check))
