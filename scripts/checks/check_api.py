#!/usr/bin/env python3
"""The public headers document the libraries, and their examples compile.

* The text of each example in a comment of a public header is in a program of consumer/, which
  check_install.py compiles and runs, between "// Example of HEADER" and "// End of the example",
  and each such text is in its header. Comparisons ignore line breaks.
* In C, each function, type and macro has a comment of its own.
* In C, what the first version of the interface did not have (c_api_names.txt) names the version
  that added it: "Since 1.2." in its comment, or in that of its type. What it had is still there.
"""

import pathlib
import re
import sys

import cpp_source

C_HEADERS = ("common/c_api/rlpc_*.h", "decoder/c_api/rlpc_*.h", "encoder/c_api/rlpc_*.h")
CPP_HEADERS = ("decoder/rlpc_decoder.h", "decoder/describe_error.h", "encoder/rlpc_encoder.h",
               "encoder/frame_encoder.h")
CONSUMER = "scripts/checks/consumer"
RELEASED = pathlib.Path(__file__).with_name("c_api_names.txt")

_INDENTED = re.compile(r"// {3}(.*)")
_CODE = re.compile(r"[;{](?:\s*//.*)?$", re.MULTILINE)
_MARKED = re.compile(r"// Example of (\S+)\n(.*?)// End of the example", re.DOTALL)
_SINCE = re.compile(r"\b[Ss]ince (\d+\.\d+)\b")
_SOME = re.compile(r"Names with (RLPC_\w+_): since (\d+\.\d+)")
_FUNCTION = re.compile(r"^RLPC_API [\w\s*]*?\b(rlpc_\w+)\(", re.MULTILINE)
_TYPE = re.compile(r"^typedef (struct|enum) (\w+) \{\n(.*?)^\} \2;", re.MULTILINE | re.DOTALL)
_HANDLE = re.compile(r"^typedef struct (\w+) \1;", re.MULTILINE)
_MACRO = re.compile(r"^#define (RLPC_(?!API)\w+) \S", re.MULTILINE)
_ENUMERATOR = re.compile(r"^ +(RLPC_\w+) =", re.MULTILINE)
_MEMBER = re.compile(r"^ +[a-z][^;()]*?\b(\w+)(?:\[[^\]]*\])*;|\(\*(\w+)\)\(", re.MULTILINE)


def one_line(text):
    return " ".join(text.split())


def examples(text):
    """The code in the comments of a header, in order."""
    block = []
    for line in [*text.splitlines(), ""]:
        match = _INDENTED.match(line)
        if match:
            block.append(match.group(1))
            continue
        if _CODE.search("\n".join(block)):
            yield one_line(" ".join(block))
        block = []


def check_examples(root, headers):
    consumers = {path: cpp_source.read(path) for path in cpp_source.files(root, (CONSUMER,))}
    compiled = {(name, one_line(code)) for text in consumers.values()
                for name, code in _MARKED.findall(text)}
    shown = {(path.relative_to(root).as_posix(), code)
             for path in headers for code in examples(cpp_source.read(path))}
    complaints = [f"{name}: {CONSUMER}/ has no such example: {code[:60]}"
                  for name, code in sorted(shown - compiled)]
    complaints += [f"{CONSUMER}: {name} has no such example: {code[:60]}"
                   for name, code in sorted(compiled - shown)]
    return (complaints if shown else [*complaints, "no header has an example"]), len(shown)


def comment_above(text, position):
    """The comment that ends on the line before."""
    lines = text[:position].splitlines()
    above = []
    while lines and lines[-1].lstrip().startswith("//") and "NOLINT" not in lines[-1]:
        above.append(lines.pop().strip()[2:])
    return one_line(" ".join(reversed(above)))


def comment_of(text, match):
    """The comments above and behind the line of a match."""
    start = text.rfind("\n", 0, match.start(match.lastindex or 0)) + 1
    return comment_above(text, start) + " " + text[start:].partition("\n")[0].partition("//")[2]


def declared(text):
    """(name, its comment, the comment of its type) of all that a header in C declares."""
    for pattern in (_FUNCTION, _HANDLE, _MACRO):
        for match in pattern.finditer(text):
            yield match.group(1), comment_above(text, match.start()), ""
    for match in _TYPE.finditer(text):
        kind, name, body = match.groups()
        own = comment_above(text, match.start())
        yield name, own, ""
        for member in (_ENUMERATOR if kind == "enum" else _MEMBER).finditer(body):
            word = member.group(1) or member.group(2)
            yield (word if kind == "enum" else f"{name}.{word}", comment_of(body, member), own)


def since(name, own, type_comment):
    """Whether the comments name the version that added a name."""
    # "Names with RLPC_PROFILE_: since 1.2" is about some of the values of a type.
    for prefix, version in _SOME.findall(type_comment):
        if name.startswith(prefix):
            return version
    return _SINCE.search(_SOME.sub("", own)) or _SINCE.search(_SOME.sub("", type_comment))


def check_names(root, headers, released):
    complaints, found = [], set()
    for path in headers:
        relative = path.relative_to(root).as_posix()
        for name, own, type_comment in declared(cpp_source.read(path)):
            found.add(name)
            if not own.strip() and "." not in name and not type_comment:
                complaints.append(f"{relative}: {name} has no comment")
            if bool(since(name, own, type_comment)) == (name in released):
                complaints.append(f"{relative}: {name} " + (
                    "is in the first version of the interface" if name in released else
                    'does not say since which version it is there: "Since 1.2."'))
    complaints += [f"{RELEASED.name}: {name} is declared nowhere"
                   for name in sorted(released - found)]
    return complaints, len(found)


def check(root):
    c_headers = [path for pattern in C_HEADERS for path in sorted(root.glob(pattern))]
    headers = [*c_headers, *(root / name for name in CPP_HEADERS if (root / name).is_file())]
    if len(headers) < len(C_HEADERS) + len(CPP_HEADERS):
        return ["public headers are missing"], ""
    released = set(RELEASED.read_text(encoding="utf-8").split())
    complaints, num_examples = check_examples(root, headers)
    others, num_names = check_names(root, c_headers, released)
    return [*complaints, *others], (f"{num_examples} examples are compiled, {num_names} names have "
                                    "comments and versions")


if __name__ == "__main__":
    sys.exit(cpp_source.run("api", __doc__, check))
