#!/usr/bin/env python3
"""No two headers define a type of the same name.

All types are in one namespace, and programs link encoder and decoder: the linker would use the
destructor of one of two classes with the same name for both.
"""

import re
import sys

import cpp_source

_TYPE = re.compile(r"^(?:class|struct|union|enum(?: class)?) +(?:alignas\([^)]*\) +)?(\w+)"
                   r"(?: final)?(?: *:[^:;{][^;{]*)? *\{", re.MULTILINE)


def check(root):
    places, complaints = {}, []
    for header in cpp_source.files(root, cpp_source.LAYERS, (".h",)):
        name = header.relative_to(root).as_posix()
        for match in _TYPE.finditer(cpp_source.code_only(cpp_source.read(header))):
            first = places.setdefault(match.group(1), name)
            if first != name:
                complaints.append(f"{name}: {match.group(1)} is defined in {first}, too")
    if not places:
        complaints.append("no header defines a type")
    return complaints, f"{len(places)} types have one header each"


if __name__ == "__main__":
    sys.exit(cpp_source.run("types", __doc__, check))
