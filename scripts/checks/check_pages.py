#!/usr/bin/env python3
"""Files, relative links and functions named in pages (*.md) exist, and files that scripts name.

A name is checked if it begins with one of the project's folders. It may be a glob; `X` denotes
a version that does not exist yet (streams/vX.Y). In CONTRIBUTING.md, names of sources without
their folders are checked as well. Scripts name files by ROOT and strings between slashes. Tables
that scripts write are between marks.
"""

import re
import sys

import cpp_source

_FOLDERS = ("common", "conformance", "decoder", "encoder", "scripts", "spec", "streams")
_NAME = re.compile(rf"(?<![\w/.%-])((?:{'|'.join(_FOLDERS)})/[\w./*-]*)")
# A function of ours, in CONTRIBUTING.md: `make_recon()`, `Decoder::pose()`.
_FUNCTION = re.compile(r"`(?:\w+::)*(\w+)\(\)`")
# A source without its folder, in CONTRIBUTING.md: `principal_shapes.h`.
_BARE = re.compile(r"`(?:[\w-]+/)*([\w-]+\.(?:h|cpp|c|py|mjs|js|cmake|md))`")
# A file that a script names, by the names of folders and file; not what it writes, in build/.
_OF_ROOT = re.compile(r'\bROOT((?:\s*/\s*"[\w.-]+")+)')
_LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")

# Page: tables in it that a script writes, between `<!-- begin: NAME ... -->` and
# `<!-- end: NAME -->`.
_WRITTEN = {"README.md": ("rates",)}


def pages(root):
    for folder in (".", *_FOLDERS):
        yield from sorted(root.glob("*.md") if folder == "." else (root / folder).rglob("*.md"))


def missing(root, path):
    """(line, name) of what a page names, but does not exist."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for match in _NAME.finditer(line):
            name = match.group(1).rstrip("./")
            if "vX.Y" not in name and not any(root.glob(name)):
                yield number, name
        for match in _LINK.finditer(line):
            if not (path.parent / match.group(1)).exists():
                yield number, match.group(1)


def files(root):
    return (path for folder in _FOLDERS for path in (root / folder).rglob("*") if path.is_file())


def without_source(root):
    """(line, name) of sources that CONTRIBUTING.md names without a folder, and are nowhere."""
    page = root / "CONTRIBUTING.md"
    if not page.is_file():
        return
    known = {path.name for path in (*files(root), *root.glob("*.md"))}
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        for name in _BARE.findall(line):
            if name not in known:
                yield number, name


def named_by_scripts(root):
    """(script, line, name) of files that a script in Python names, and do not exist."""
    for path in files(root):
        if path.suffix not in ("", ".py"):
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        for match in _OF_ROOT.finditer(text):
            name = "/".join(re.findall(r'"([\w.-]+)"', match.group(1)))
            if not name.startswith("build") and not (root / name).exists():
                yield path, text.count("\n", 0, match.start()) + 1, name


def without_code(root):
    """(line, name) of functions that CONTRIBUTING.md names, and no source declares."""
    path = root / "CONTRIBUTING.md"
    if not path.is_file():
        return
    sources = [p for layer in cpp_source.LAYERS for p in (root / layer).rglob("*")
               if p.suffix in (".h", ".cpp", ".c", ".py", ".js")]
    known = set()
    for source in sources:
        known |= set(re.findall(r"\b(\w+)\(", source.read_text(encoding="utf-8")))
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        for name in _FUNCTION.findall(line):
            if name not in known:
                yield number, name


def unmarked(root):
    """(page, name) of tables whose marks are missing or repeated."""
    for page, names in _WRITTEN.items():
        text = (root / page).read_text(encoding="utf-8")
        for name in names:
            marks = re.findall(rf"^<!-- (begin|end): {name}\b.*-->$", text, re.MULTILINE)
            if marks != ["begin", "end"]:
                yield page, name


def check(root):
    found = list(pages(root))
    complaints = [f"{path.relative_to(root)}:{line}: there is no {name}"
                  for path in found for line, name in missing(root, path)]
    complaints += [f"CONTRIBUTING.md:{line}: no source has {name}( )"
                   for line, name in without_code(root)]
    complaints += [f"CONTRIBUTING.md:{line}: there is no {name}"
                   for line, name in without_source(root)]
    complaints += [f"{path.relative_to(root)}:{line}: there is no {name}"
                   for path, line, name in named_by_scripts(root)]
    complaints += [f"{page}: no marks `begin: {name}`, `end: {name}`, once each"
                   for page, name in unmarked(root)]
    return complaints, f"{len(found)} pages name only existing files"


if __name__ == "__main__":
    sys.exit(cpp_source.run("pages", __doc__, check))
