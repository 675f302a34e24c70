#!/usr/bin/env python3
"""C++ sources are formatted as .clang-format says, by clang-format 14."""

import collections
import re
import shutil
import subprocess
import sys

import cpp_source

_TOOL = "clang-format-14"
_FILES_AT_A_TIME = 100
_COMPLAINT = re.compile(r"^(.*?):\d+:\d+: error: ", re.MULTILINE)


def ugly(root, paths):
    """Places that clang-format would change, by file."""
    done = subprocess.run([_TOOL, "--dry-run", "--Werror", *map(str, paths)], cwd=root,
                          capture_output=True, text=True)
    return _COMPLAINT.findall(done.stderr)


def check(root):
    if not shutil.which(_TOOL):
        return [f"{_TOOL} is not installed: run scripts/setup --test"], ""
    paths = [path.relative_to(root)
             for path in cpp_source.files(root, (*cpp_source.LAYERS, "scripts"))]
    parts = [paths[i:i + _FILES_AT_A_TIME] for i in range(0, len(paths), _FILES_AT_A_TIME)]
    places = collections.Counter()
    for part in parts:
        places.update(ugly(root, part))
    complaints = [f"{name}: {count} places; to format: {_TOOL} -i {name}"
                  for name, count in sorted(places.items())]
    return complaints, f"{len(paths)} files are formatted"


if __name__ == "__main__":
    sys.exit(cpp_source.run("format", __doc__, check))
