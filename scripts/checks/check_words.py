#!/usr/bin/env python3
"""Comments begin with a verb or a noun, and pages use words that readers know.

* A comment of C++ or JavaScript, at the start of its block or behind code, does not begin as the
  rest of a sentence whose subject stands above or before it: "Of a GOF.", "Those in use", "As
  parsed".
* Comments, pages, messages and help do not use the words of WORDS, which lists replacements.
"""

import re
import sys

import cpp_source

# How the rest of a sentence begins.
OPENINGS = ("Of", "Those", "That", "As", "With", "Without", "Beyond", "By", "Whose", "Which",
            "From", "Than", "To")
# "To add X, ..." and "From N on" are sentences of their own; what follows a comma tells.
_SENTENCE = re.compile(r"(?:As|By|From|To|With|Without|Beyond|Of|That) [^.;:]*, [a-z]|"
                       r"(?:That|Those|Which|To) [^.;:]*\b(?:is|are|was|has|have|can|must|would)\b|"
                       r"From [^.;:]* (?:on|to)\b")
WORDS = {"anew": "again", "afresh": "again, or from scratch", "likewise": "too, or the same way",
         "hardly": "barely, or seldom"}
_WORD = re.compile(r"\b(" + "|".join(WORDS) + r")\b", re.IGNORECASE)
_OPENING = re.compile(r"(?:" + "|".join(OPENINGS) + r")\b")
_SCRIPT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


def blocks(text):
    """(line, text) of each comment block, and of each comment behind code."""
    lines = text.splitlines()
    before = False
    for index, line in enumerate(lines):
        match = re.match(r"(\s*)//+!?<?\s?(.*)", line)
        if match:
            if not before:
                yield index + 1, match.group(2).strip()
            before = True
            continue
        before = False
        behind = re.match(r"[^\"']*?[;{},)\w]\s+// (.*)", line)
        if behind:
            yield index + 1, behind.group(1).strip()


def is_rest(comment):
    return bool(_OPENING.match(comment)) and not _SENTENCE.match(comment)


def check(root):
    complaints, count = [], 0
    for path in cpp_source.files(root, (*cpp_source.LAYERS, "scripts")):
        text = cpp_source.read(path)
        relative = path.relative_to(root)
        for line, comment in blocks(text):
            count += 1
            if is_rest(comment):
                complaints.append(f"{relative}:{line}: a comment begins as the rest of a sentence: "
                                  f'"{comment[:60]}"')
    return complaints, f"{count} comments begin with a verb or a noun"


if __name__ == "__main__":
    sys.exit(cpp_source.run("words", __doc__, check))
