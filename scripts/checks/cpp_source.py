"""Shared by the checks: C++ source text, split into code, comments and literals just well enough
for them; their reports and command lines."""

import argparse
import functools
import pathlib
import re

LAYERS = ("common", "decoder", "encoder", "conformance")

_TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<raw>\bu?8?R"(?P<delim>[^()\\\s]*)\(.*?\)(?P=delim)")
      | (?P<string>"(?:\\.|[^"\\\n])*")
      | (?P<char>(?<![0-9A-Za-z_])'(?:\\.|[^'\\\n])+')""",
    re.DOTALL | re.VERBOSE,
)


def repository_root():
    return pathlib.Path(__file__).resolve().parents[2]


def files(root, folders, suffixes=(".c", ".h", ".cpp")):
    """The files below `folders` with one of the suffixes, in sorted order."""
    return sorted(path for folder in folders for path in (root / folder).rglob("*")
                  if path.suffix in suffixes and path.is_file())


@functools.lru_cache(maxsize=None)
def _contents(path, _modified, _size):
    return path.read_text(encoding="utf-8")


def read(path):
    """The text of a file. Files that have not changed are read once."""
    state = path.stat()
    return _contents(path, state.st_mtime_ns, state.st_size)


def is_test(path):
    return path.stem.endswith(("_test", "_fuzz", "_bench")) or path.parent.name == "testing"


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


@functools.lru_cache(maxsize=None)
def code_only(text):
    """The text with comments and the contents of literals blanked; positions are kept."""
    return _TOKEN.sub(lambda m: _blank(m.group()), text)


@functools.lru_cache(maxsize=None)
def comments_only(text):
    """The text with everything but comments blanked; positions are kept."""
    parts = []
    end = 0
    for match in _TOKEN.finditer(text):
        parts.append(_blank(text[end:match.start()]))
        parts.append(match.group() if match.group("comment") else _blank(match.group()))
        end = match.end()
    return "".join(parts) + _blank(text[end:])


@functools.lru_cache(maxsize=None)
def without_comments(text):
    """The text with comments blanked, literals kept; positions are kept."""
    return _TOKEN.sub(lambda m: _blank(m.group()) if m.group("comment") else m.group(), text)


def kept(text, pattern):
    """The text with everything but matches of the pattern blanked; positions are kept."""
    parts = []
    end = 0
    for match in pattern.finditer(text):
        parts += [_blank(text[end:match.start()]), match.group()]
        end = match.end()
    return "".join(parts) + _blank(text[end:])


def line_of(text, position):
    return text.count("\n", 0, position) + 1


def report(name, complaints, summary):
    """Prints the complaints, or the summary when there are none; returns the exit code."""
    for complaint in complaints:
        print(complaint)
    print(f"{name}: {len(complaints)} complaint(s)" if complaints else f"{name}: {summary}")
    return 1 if complaints else 0


def run(name, doc, check, write=None):
    """The command line of a check: check(root) gives complaints and a summary; write(root) brings
    up to date what is checked, where scripts do that. Returns the exit code."""
    parser = argparse.ArgumentParser(description=doc,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=repository_root())
    if write:
        parser.add_argument("--write", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if write and options.write:
        write(options.root)
    return report(name, *check(options.root))
