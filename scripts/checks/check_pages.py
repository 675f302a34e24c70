#!/usr/bin/env python3
"""Files, relative links and functions named in pages (*.md) exist.

A name is checked if it begins with one of the project's folders. It may be a glob; `X` denotes
a version that does not exist yet (streams/vX.Y). Tables that scripts write are between marks.
"""

import re
import sys

import cpp_source

_FOLDERS = ("common", "conformance", "decoder", "encoder", "scripts", "spec", "streams")
_NAME = re.compile(rf"(?<![\w/.%-])((?:{'|'.join(_FOLDERS)})/[\w./*-]*)")
# A function of ours, in CONTRIBUTING.md: `make_recon()`, `Decoder::pose()`.
_FUNCTION = re.compile(r"`(?:\w+::)*(\w+)\(\)`")
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
    complaints += [f"{page}: no marks `begin: {name}`, `end: {name}`, once each"
                   for page, name in unmarked(root)]
    return complaints, f"{len(found)} pages name only existing files"


if __name__ == "__main__":
    sys.exit(cpp_source.run("pages", __doc__, check))
