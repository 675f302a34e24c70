#!/usr/bin/env python3
"""Folders include, import and link only what they may.

Each folder includes only what scripts/checks/rooms.py allows, and no two include each other,
directly or through others: common includes neither side, encoder and decoder never include each
other, parsing includes nothing that reconstructs, readers and writers of mesh files nothing of
coding. Eigen stays in the encoder and the writer of glTF; common and decoder neither throw nor
catch; the specification interpreter and the judge are plain Python.
"""

import ast
import functools
import re
import sys

import cpp_source
import rooms

LAYERS = ("common", "decoder", "encoder", "conformance")

# common/ only computes: no input, output or logging, except in the folders that rooms.LIBRARIES
# names.
INPUT_OUTPUT = {"cstdio", "filesystem", "fstream", "iomanip", "ios", "iostream", "istream",
                "ostream", "streambuf", "syncstream"}
INSTALLED = "scripts/cmake/install.cmake"  # names the public headers
# Headers of the standard library that our C headers include.
C_HEADERS = {"stddef.h", "stdint.h"}
# Folder: other folders whose modules it may import.
PLAIN_PYTHON = {"conformance/specdec": (), "conformance/judge": ("conformance/specdec",)}

# A free function of a header: its line begins with the type, not with white space.
_DECLARATION = re.compile(r"^[A-Za-z][\w:<>,&*\[\] ]*?[ &*](\w+)\(", re.MULTILINE)
_INCLUDE = re.compile(r"^[ \t]*#[ \t]*include\b[ \t]*(.*)$", re.MULTILINE)


def public_headers(root):
    """Headers that scripts/cmake/install.cmake installs."""
    text = (root / INSTALLED).read_text(encoding="utf-8")
    return sorted(set(re.findall(r"\b(?:common|decoder|encoder)/[\w/]+\.h\b", text)))


@functools.lru_cache(maxsize=None)
def includes(text):
    """(line, bracket, path) of every include; bracket is '"', '<', or '' for a macro."""
    found = []
    for match in _INCLUDE.finditer(cpp_source.without_comments(text)):
        target = re.match(r'(["<])([^">]+)[">]', match.group(1))
        line = cpp_source.line_of(text, match.start())
        found.append((line, *target.groups()) if target else (line, "", match.group(1).strip()))
    return found


def check_ours(root, path, included):
    folder = path.parent.relative_to(root).as_posix()
    if included.split("/")[0] not in LAYERS or ".." in included.split("/"):
        return f'"{included}" is not spelled from the top, like "common/result.h"'
    if not (root / included).is_file():
        return f'"{included}" does not exist'
    if not rooms.allowed(folder, included, cpp_source.is_test(path)):
        return f'{folder}/ must not include "{included}" (scripts/checks/rooms.py)'
    return None


def check_library(layer, relative, included):
    first = included.split("/")[0]
    if first in LAYERS:
        return f'<{included}> is ours: write "{included}"'
    if first in rooms.LIBRARIES[layer] or (cpp_source.is_test(relative)
                                           and first in rooms.TEST_LIBRARIES):
        return None
    if "/" in included or first in set().union(rooms.TEST_LIBRARIES, *rooms.LIBRARIES.values()):
        return f"{layer}/ must not use <{included}>"
    if layer == "common" and not cpp_source.is_test(relative):
        if included in INPUT_OUTPUT:
            return f"common/ does no input or output (it includes <{included}>)"
        is_c = relative.parent.name == "c_api" and included in C_HEADERS
        if included.endswith(".h") and not is_c:
            return f"common/ uses only the standard library (it includes <{included}>)"
    return None


@functools.lru_cache(maxsize=None)
def file_complaints(root, path, text):
    relative = path.relative_to(root)
    return [*check_includes(root, path, relative, text), *check_exceptions(relative, text)]


def check_includes(root, path, relative, text):
    folder = relative.parent.as_posix()
    layer = folder if folder in rooms.LIBRARIES else relative.parts[0]
    for line, bracket, included in includes(text):
        if bracket == '"':
            complaint = check_ours(root, path, included)
        elif bracket == "<":
            complaint = check_library(layer, relative, included)
        else:
            complaint = f"an include that cannot be followed: {included}"
        if complaint:
            yield f"{relative}:{line}: {complaint}"


def check_exceptions(relative, text):
    """Errors are results (common/result.h); what `new` throws passes through."""
    if relative.parts[0] not in rooms.NEITHER_THROW_NOR_CATCH or cpp_source.is_test(relative):
        return
    if rooms.MAY_CATCH & {relative.as_posix(), relative.parent.as_posix()}:
        return
    for match in re.finditer(r"\b(throw|try|catch)\b", cpp_source.code_only(text)):
        yield (f"{relative}:{cpp_source.line_of(text, match.start())}: "
               f"{relative.parts[0]}/ must neither throw nor catch (`{match.group(1)}`)")


def check_public_header(root, header):
    """A user of an installed header needs only our headers and the standard library."""
    queue, seen = [header], set()
    while queue:
        current = queue.pop()
        if current in seen or not (root / current).is_file():
            continue
        seen.add(current)
        for line, bracket, included in includes((root / current).read_text(encoding="utf-8")):
            if bracket == '"':
                queue.append(included)
            elif included not in C_HEADERS and ("/" in included or included.endswith(".h")):
                yield (f"{current}:{line}: the public {header} reaches <{included}>; "
                       "only the standard library may be visible there")


def check_links(root):
    """A library is not linked where it must not be included."""
    for layer in ("common", "decoder", "encoder"):
        for path in sorted((root / layer).rglob("CMakeLists.txt")):
            for number, line in enumerate(cpp_source.read(path).splitlines(), 1):
                code = line.split("#")[0]
                for other in re.findall(r"\brlpc(?:_|::)(decoder|encoder)\b", code):
                    if other not in ("common", layer):
                        yield (f"{path.relative_to(root)}:{number}: "
                               f"{layer}/ must not link rlpc_{other}")
                if "Eigen" in code and "Eigen" not in rooms.libraries_within(layer):
                    yield f"{path.relative_to(root)}:{number}: {layer}/ must not use Eigen"


@functools.lru_cache(maxsize=None)
def imports(text):
    """(line, module) of all that a Python file imports."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            found.append((node.lineno, node.module))
    return found


def check_python(root, folder, others):
    """Only the standard library, and modules in the file's own folder or in other folders."""
    base = root / folder
    local = {base.name} | {path.stem for path in base.rglob("*.py")}
    local |= {path.stem for other in others for path in (root / other).rglob("*.py")}
    local |= {path.name for path in base.rglob("*") if path.is_dir()}
    paths = sorted(base.rglob("*.py"))
    if not paths:
        yield f"{folder}/ has no Python in it"
    for path in paths:
        for line, name in imports(cpp_source.read(path)):
            top = name.split(".")[0]
            if top not in sys.stdlib_module_names and top not in local:
                yield f"{path.relative_to(root)}:{line}: {folder} must not import {name}"


def called_functions(root, places):
    """Names of the free functions that headers of folders, and single headers, declare."""
    names = set()
    for place in places:
        headers = [root / place] if place.endswith(".h") else sorted((root / place).glob("*.h"))
        for header in headers:
            code = cpp_source.code_only(cpp_source.read(header))
            names |= set(_DECLARATION.findall(code))
    return names


def check_calls(root, folder, places):
    """Code of a room does not call what it must not know, whichever header declares it."""
    names = called_functions(root, places)
    if not names:
        yield f"scripts/checks/rooms.py: NOT_CALLED of {folder} names no function"
        return
    call = re.compile(r"\b(" + "|".join(sorted(names)) + r")\s*\(")
    for path in sorted((root / folder).glob("*")):
        if path.suffix not in (".h", ".cpp") or cpp_source.is_test(path):
            continue
        text = cpp_source.read(path)
        for match in call.finditer(cpp_source.code_only(text)):
            yield (f"{path.relative_to(root)}:{cpp_source.line_of(text, match.start())}: "
                   f"{folder}/ must not call {match.group(1)}( )")


def check_rooms(root, paths):
    """Every folder with sources is a room, and every room has some."""
    found = {path.parent.relative_to(root).as_posix() for path in paths}
    found = {folder for folder in found if rooms.layer_of(folder) != rooms.BOTH_SIDES}
    for folder in sorted(found - set(rooms.ROOMS)):
        yield f"{folder}/ has sources, but is not a room of scripts/checks/rooms.py"
    for folder in sorted(set(rooms.ROOMS) - found):
        yield f"scripts/checks/rooms.py: {folder}/ has no sources"


def find_cycle(graph):
    """A list of folders of which each includes the next, and the last the first; none: []."""
    done = set()
    for start in sorted(graph):
        way, tries = [start], [iter(sorted(graph.get(start, ())))]
        while way:
            target = next(tries[-1], None)
            if target in way:
                return way[way.index(target):]
            if target is None:
                done.add(way.pop())
                tries.pop()
            elif target not in done:
                way.append(target)
                tries.append(iter(sorted(graph.get(target, ()))))
    return []


def check_cycles(root, paths):
    """No folder includes what includes it, over however many folders, tests aside."""
    graph = {}
    for path in paths:
        folder = path.parent.relative_to(root).as_posix()
        if cpp_source.is_test(path) or rooms.layer_of(folder) == rooms.BOTH_SIDES:
            continue
        text = cpp_source.read(path)
        targets = {included.rpartition("/")[0] for _, bracket, included in includes(text)
                   if bracket == '"' and rooms.allowed(folder, included, False)}
        graph.setdefault(folder, set()).update(targets - {folder})
    cycle = find_cycle(graph)
    if cycle:
        yield "folders include each other in a circle: " + " -> ".join([*cycle, cycle[0]])


def check(root):
    paths = cpp_source.files(root, cpp_source.LAYERS)
    complaints = list(check_rooms(root, paths))
    known = [path for path in paths if path.parent.relative_to(root).as_posix() in rooms.ROOMS
             or path.relative_to(root).parts[0] == rooms.BOTH_SIDES]
    for path in known:
        complaints += file_complaints(root, path, cpp_source.read(path))
    for folder, places in rooms.NOT_CALLED.items():
        complaints += check_calls(root, folder, places)
    headers = public_headers(root)
    if not headers:
        complaints.append(f"{INSTALLED}: names no public header")
    for header in headers:
        if not (root / header).is_file():
            complaints.append(f"{header}: this public header does not exist")
        complaints += check_public_header(root, header)
    complaints += check_cycles(root, known)
    complaints += check_links(root)
    for folder, others in PLAIN_PYTHON.items():
        complaints += check_python(root, folder, others)
    return complaints, f"{len(paths)} files in {len(rooms.ROOMS)} rooms include only what they may"


if __name__ == "__main__":
    sys.exit(cpp_source.run("layers", __doc__, check))
