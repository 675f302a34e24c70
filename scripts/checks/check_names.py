#!/usr/bin/env python3
"""Identifiers are nouns or verbs of the field, not the rest of a sentence.

In C++, C, JavaScript and Python, no identifier is called of_frame, most, least_bytes, kOfGof or
kMostBytes: these are frame_bytes, max, min_bytes, kGofBytes and kMaxBytes. KEPT and KEPT_IN list
exceptions.
"""

import io
import re
import sys
import tokenize

import check_python
import cpp_source

# Members of the released C interface; a term of the field; statistics that a file of rlpccov names.
KEPT = {"least_level", "least_squares"}
KEPT_IN = {"conformance/rlpccov": {"least"}}

_SUFFIXES = (".c", ".h", ".cpp", ".js", ".mjs", ".ts")
_NAME = re.compile(r"\b(?:(?:of|most|least)_\w*|(?:of|most|least)[A-Z]\w*|most|least"
                   r"|k(?:Most|Least)(?:[A-Z0-9]\w*)?|kOf[A-Z]\w*|(?:OF|MOST|LEAST)_[A-Z]\w*)\b")


def names_in_script(text):
    """(line, identifier) of a file in Python."""
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.NAME:
            yield token.start[0], token.string


def names_in(path, text):
    """(line, identifier that begins as the rest of a sentence) of a file."""
    if path.suffix in _SUFFIXES:
        code = cpp_source.code_only(text)
        return [(cpp_source.line_of(code, match.start()), match.group())
                for match in _NAME.finditer(code)]
    if not _NAME.search(text):
        return []
    return [(line, name) for line, name in names_in_script(text) if _NAME.fullmatch(name)]


def kept(folder):
    rooms = [names for room, names in KEPT_IN.items() if folder.startswith(room)]
    return KEPT.union(*rooms)


def check(root):
    complaints, count = [], 0
    sources = cpp_source.files(root, (*cpp_source.LAYERS, "scripts"), _SUFFIXES)
    for path in [*sources, *check_python.sources(root)]:
        relative = path.relative_to(root)
        folder = relative.parent.as_posix()
        if "node_modules" in path.parts:
            continue
        count += 1
        allowed = kept(folder)
        complaints += [f"{relative}:{line}: {name} is the rest of a sentence: use a noun"
                       for line, name in names_in(path, cpp_source.read(path))
                       if name not in allowed]
    if count == 0:
        complaints.append("no sources are found: the check sees nothing")
    return complaints, f"{count} files have nouns and verbs as names"


if __name__ == "__main__":
    sys.exit(cpp_source.run("names", __doc__, check))
