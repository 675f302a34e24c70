#!/usr/bin/env python3
"""No floating point in the integer folders (scripts/checks/rooms.py), except in common/files
and common/surface.

Tests may use it. Division and shifts of signed numbers are not checked: text alone cannot
distinguish them from those of unsigned numbers, which are exact.
"""

import re
import sys

import cpp_source
import rooms

_FLOAT = re.compile(
    r"""\b(?:float|double|float_t|double_t)\b
      | <(?:cmath|math\.h|cfloat|complex|numbers|random)>
      | \b(?:std::)?(?:sqrt|cbrt|hypot|pow|exp|exp2|log|log2|log10|sin|cos|tan|atan2?|floor|ceil
          |round|lround|llround|trunc|fabs|ldexp|fma)f?\s*\(
      | (?<![\w.])(?:\d[\d']*\.[\d']*|\.\d[\d']*)(?:[eE][+-]?\d+)?[fFlL]?(?![\w.])
      | (?<![\w.])\d[\d']*[eE][+-]?\d+[fFlL]?(?!\w)""",
    re.VERBOSE,
)


def covered(root):
    return [path for path in cpp_source.files(root, rooms.INTEGER_FOLDERS)
            if not cpp_source.is_test(path)
            and path.parent.relative_to(root).as_posix() not in (rooms.FILES, rooms.SURFACE)]


def check(root):
    complaints = [f"{folder}/ has no sources"
                  for folder in rooms.INTEGER_FOLDERS if not cpp_source.files(root, (folder,))]
    paths = covered(root)
    for path in paths:
        text = cpp_source.read(path)
        for match in _FLOAT.finditer(cpp_source.code_only(text)):
            line = cpp_source.line_of(text, match.start())
            complaints.append(f"{path.relative_to(root)}:{line}: floating point: "
                              f"{match.group().rstrip(' (')}")
    return complaints, f"{len(paths)} files use integers only"


if __name__ == "__main__":
    sys.exit(cpp_source.run("float", __doc__, check))
