#!/usr/bin/env python3
"""Every constant of the encoder's search is marked as tuned or fixed.

In the sources of the search (scripts/studies/tuning/tuned.py), each constant that is declared with
a number has a comment `tuned: REASON` or `fixed: REASON` behind or above it. No other number has a
fraction, except in plain formulas (halves, bits of a byte, per cent). Tuned constants have
different names, and encoder/codec/kinds/skinned/search/README.md has a row for each, and for no
other, with its value and reason.
"""

import functools
import re
import sys

import cpp_source

sys.path.insert(0, str(cpp_source.repository_root() / "scripts" / "studies" / "tuning"))
import tuned
import worth

PAGE = "encoder/codec/kinds/skinned/search/README.md"
# Halves and doubles, coordinates, bits of a byte (or eighths of an octave), the variance of a
# uniform distribution, per cent.
PLAIN = {"0.0", "0.5", "1.0", "2.0", "3.0", "8.0", "12.0", "100.0"}

_CONSTANT = re.compile(r"\bconstexpr\b[^;(){}=]*?\b(k[A-Z]\w*)\s*(=[^;]*|\{[^;]*\});")
# On the first line; of a list, which fills it, on the next.
_FIXED = re.compile(r"[^\n]*(?:\{\n\s*)?// fixed: \S")
_NUMBER = re.compile(r"(?<![\w.'])(?:\d[\d']*|0x[\da-fA-F.]+(?:p[+-]?\d+)?)(?![\w.'])")
_FRACTION = re.compile(
    r"(?<![\w.])(?:0x[\da-fA-F.]+p[+-]?\d+|\d[\d']*\.[\d']*(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)"
    r"[fF]?(?![\w.])")


@functools.lru_cache(maxsize=None)
def untagged(path, text):
    """Complaints about constants that say nothing."""
    return tuple(_untagged(path, text))


def _untagged(path, text):
    code = cpp_source.code_only(text)
    spans = []
    tagged = {c.span[0] + len(c.indent): c for c in tuned.declarations(path, text) if c.tag}
    for match in _CONSTANT.finditer(code):
        spans.append(match.span())
        line_start = text.rfind("\n", 0, match.start()) + 1
        start = line_start + len(text[line_start:]) - len(text[line_start:].lstrip(" "))
        if start in tagged or _FIXED.match(text, start):
            continue
        if not (_NUMBER.search(match[2]) or _FRACTION.search(match[2])):
            continue
        line = cpp_source.line_of(text, match.start())
        yield (f"{path}:{line}: {match[1]} says neither `tuned: REASON` nor `fixed: REASON`")
    for match in _FRACTION.finditer(code):
        if match.group() in PLAIN or any(a <= match.start() < b for a, b in spans):
            continue
        line = cpp_source.line_of(text, match.start())
        yield f"{path}:{line}: {match.group()} is no named constant"


def page_rows(root, constants):
    """Complaints about the table of constants."""
    page = root / PAGE
    listed = worth.rows(page.read_text(encoding="utf-8")) if page.is_file() else []
    known = [c.id for c in constants]
    for name in sorted(set(known) - set(listed)):
        yield f"{PAGE}: no row for {name}; scripts/constants --measure ... --write"
    for name in sorted(set(listed) - set(known)):
        yield f"{PAGE}: {name} is no tuned constant"
    if listed and set(listed) == set(known):
        text = page.read_text(encoding="utf-8")
        if worth.with_constants(text, constants) != text:
            yield f"{PAGE}: values or reasons have changed; run scripts/constants --write"


def check(root):
    constants = tuned.tuned(root)
    complaints = []
    for path, text in tuned.sources(root):
        if tuned.is_of_search(path):
            complaints += untagged(path, text)
    names = [c.id for c in constants]
    complaints += [f"{name}: two tuned constants of this name"
                   for name in sorted({n for n in names if names.count(n) > 1})]
    if not constants:
        complaints.append("no tuned constant is found: the check sees nothing")
    complaints += page_rows(root, constants)
    return complaints, f"{len(constants)} constants are tuned"


if __name__ == "__main__":
    sys.exit(cpp_source.run("constants", __doc__, check))
