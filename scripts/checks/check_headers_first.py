#!/usr/bin/env python3
"""Every source includes the header of its name first, which shows that it compiles alone.

Headers without such a source are compiled by themselves (checks.headers).
"""

import re
import sys

import cpp_source

_FIRST = re.compile(r'^[ \t]*#[ \t]*include[ \t]*"([^"\n]*)"|^[ \t]*#[ \t]*include', re.MULTILINE)


def check(root):
    complaints, pairs = [], 0
    for header in cpp_source.files(root, cpp_source.LAYERS, (".h",)):
        source = header.with_suffix(".cpp")
        if not source.is_file():
            continue
        pairs += 1
        name = header.relative_to(root).as_posix()
        first = _FIRST.search(cpp_source.without_comments(cpp_source.read(source)))
        if not first or first.group(1) != name:
            complaints.append(f'{source.relative_to(root)}: "{name}" is not included first')
    if pairs == 0:
        complaints.append("no header has a source of its name")
    return complaints, f"{pairs} sources include the header of their name first"


if __name__ == "__main__":
    sys.exit(cpp_source.run("headers_first", __doc__, check))
