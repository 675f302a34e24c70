#!/usr/bin/env python3
"""Files and relative links named in pages (*.md) exist.

A name is checked if it begins with one of the project's folders. It may be a glob; `X` stands
for a version that does not exist yet (streams/vX.Y). Tables that scripts write are between marks.
"""

import re
import sys

import cpp_source

_FOLDERS = ("common", "conformance", "decoder", "encoder", "scripts", "spec", "streams")
_NAME = re.compile(rf"(?<![\w/.%-])((?:{'|'.join(_FOLDERS)})/[\w./*-]*)")
_LINK = re.compile(r"\]\(([^)#:]+)(?:#[^)]*)?\)")

# Page: tables in it that a script writes between `<!-- begin: NAME ... -->` and `<!-- end: NAME -->`.
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
    complaints += [f"{page}: no marks `begin: {name}`, `end: {name}`, once each"
                   for page, name in unmarked(root)]
    return complaints, f"{len(found)} pages name only existing files"


if __name__ == "__main__":
    sys.exit(cpp_source.run("pages", __doc__, check))
