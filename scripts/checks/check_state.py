#!/usr/bin/env python3
"""Annex E states the lifetimes of the variables of the pseudo-code in spec/*.md.

Table E-1 lists each variable that a function assigns to, in a row whose function gives it a value;
Table E-2 lists each syntax element that is used outside the functions that read it from the stream,
in a row with the function that reads it. The rows of Table E-2 are written by hand, except the
clauses of their functions and the column of elements.

  --write    update these
"""

import ast
import pathlib
import re
import sys

import check_index
import cpp_source

ANNEX = pathlib.Path("spec", "annex-e-state.md")
_VARIABLES_ROW = re.compile(r"^\| ([^|]+) \| (\w+)\( \) \(([A-Z\d.]+)\) \| ([^|]+) \|$",
                            re.MULTILINE)
_ELEMENTS = re.compile(r"(<!-- begin: elements\b.*-->\n)([^<]*)(<!-- end: elements -->\n)")
_ELEMENTS_ROW = re.compile(r"^\| ([^|]+) \| (\w+\( \)[^|]*) \|[^|]*\|$", re.MULTILINE)


def _functions(root):
    """{name: (tree, clause)} of the pseudo-code."""
    return {node.name: (node, clause)
            for _, _, clause, text in check_index.spec_program.blocks(root / "spec")
            for node in ast.parse(text).body if isinstance(node, ast.FunctionDef)}


def _begun(tree):
    """Variables that a function gives a value, not only to an element."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            yield check_index.variable(node.targets[0])


def _outlive(functions):
    """{function: syntax elements that it reads from the stream and others use}, all elements"""
    users, elements = {}, {}
    for name, (tree, _) in functions.items():
        elements[name] = _elements(tree)
        for variable in check_index.read_in(tree):
            users.setdefault(variable, set()).add(name)
    every = {element for found in elements.values() for element in found}
    sources = {e: {name for name, found in elements.items() if e in found} for e in every}
    return {name: [e for e in found if users.get(e, set()) - sources[e]]
            for name, found in elements.items()}, every


def _elements(tree):
    """The syntax elements that a function reads from the stream, in order, each once."""
    assignments = sorted((node for node in ast.walk(tree) if isinstance(node, ast.Assign)),
                         key=lambda node: node.lineno)
    return list(dict.fromkeys(element for node in assignments
                              for element, is_read in check_index.set_in(node) if is_read))


def updated(root):
    """(the text of the annex with Table E-2 as it has to be, complaints)"""
    text, functions = (root / ANNEX).read_text(encoding="utf-8"), _functions(root)
    outlive, _ = _outlive(functions)
    complaints, listed = [], []

    def row(match):
        readers = re.findall(r"(\w+)\( \)", match.group(2))
        listed.extend(readers)
        names = dict.fromkeys(e for name in readers for e in outlive.get(name, ()))
        places = ", ".join(f"{name}( )" + (f" ({functions[name][1]})" if name in functions else "")
                           for name in readers)
        return f"| {match.group(1)} | {places} | {', '.join(names)} |"

    text, count = _ELEMENTS.subn(
        lambda marks: marks.group(1) + _ELEMENTS_ROW.sub(row, marks.group(2)) + marks.group(3),
        text)
    if count != 1:
        complaints.append("no marks `begin: elements`, `end: elements`, once each")
    table = _ELEMENTS.search(text)
    complaints += [f"a row without a function: {line}"
                   for line in (table.group(2).splitlines()[2:] if table else ())
                   if not _ELEMENTS_ROW.match(line)]
    complaints += [f"{name}( ) is in two rows" for name in sorted(set(listed))
                   if listed.count(name) > 1]
    complaints += [f"{name}( ) reads no element that outlives it" for name in listed
                   if not outlive.get(name)]
    complaints += [f"{name}( ) reads {', '.join(found)}, and has no row"
                   for name, found in outlive.items() if found and name not in listed]
    return text, complaints


def _check_variables(text, functions):
    """Complaints of Table E-1, and the variables that it lists."""
    _, elements = _outlive(functions)
    kept = {name for tree, _ in functions.values() for name, _ in check_index.set_in(tree)
            if name is not None} - elements
    listed, complaints = set(), []
    for _, function, clause, names in _VARIABLES_ROW.findall(text):
        names = names.split(", ")
        listed.update(names)
        tree, at = functions.get(function, (None, None))
        if at != clause:
            complaints.append(f"{clause} has no {function}( )")
            continue
        complaints += [f"{function}( ) gives {name} no value" for name in names
                       if name not in set(_begun(tree))]
    complaints += [f"{name} is missing" for name in sorted(kept - listed)]
    complaints += [f"{name} does not outlive a function" for name in sorted(listed - kept)]
    return complaints, listed


def check(root):
    if not (root / ANNEX).is_file():
        return [f"there is no {ANNEX}"], ""
    text = (root / ANNEX).read_text(encoding="utf-8")
    fresh, complaints = updated(root)
    more, listed = _check_variables(_ELEMENTS.sub("", text), _functions(root))
    if text != fresh:
        complaints.append("Table E-2 is not up to date: scripts/index")
    return ([f"{ANNEX}: {c}" for c in complaints + more],
            f"{ANNEX} lists {len(listed)} variables, and the syntax elements that outlive a "
            "function")


def write(root):
    (root / ANNEX).write_text(updated(root)[0], encoding="utf-8")


if __name__ == "__main__":
    sys.exit(cpp_source.run("state", __doc__, check, write))
