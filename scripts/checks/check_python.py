#!/usr/bin/env python3
"""Python sources are as .flake8 says, by flake8."""

import shutil
import subprocess
import sys

import cpp_source

_TOOL = "flake8"
_FOLDERS = (*cpp_source.LAYERS, "scripts")
_FIRST_LINE = b"#!/usr/bin/env python3\n"


def is_script(path):
    """Whether a file without a suffix is Python."""
    if path.suffix or not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(_FIRST_LINE)) == _FIRST_LINE


def sources(root):
    scripts = (path for folder in _FOLDERS for path in (root / folder).rglob("*")
               if is_script(path))
    return sorted([*cpp_source.files(root, _FOLDERS, (".py",)), *scripts])


def check(root):
    if not shutil.which(_TOOL):
        return [f"{_TOOL} is not installed: run scripts/setup --test"], ""
    paths = [str(path.relative_to(root)) for path in sources(root)]
    if not paths:
        return ["no Python source is found: the check sees nothing"], ""
    done = subprocess.run([_TOOL, *paths], cwd=root, capture_output=True, text=True)
    complaints = done.stdout.splitlines()
    if done.returncode and not complaints:
        complaints = [f"{_TOOL} failed: {done.stderr.strip()}"]
    return complaints, f"{len(paths)} files are clean"


if __name__ == "__main__":
    sys.exit(cpp_source.run("python", __doc__, check))
