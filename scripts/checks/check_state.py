#!/usr/bin/env python3
"""Annex E says how long the variables of the pseudo-code in spec/*.md live.

Table E-1 has each variable that a function assigns to, in a row whose function gives it a value;
Table E-2 each syntax element that another function reads than the one that gives it its value.
"""

import argparse
import ast
import pathlib
import re
import sys

import check_index
import cpp_source

ANNEX = pathlib.Path("spec", "annex-e-state.md")
_ROW = re.compile(r"^\| ([^|]+) \|(?: (\w+)\( \) \(([A-Z\d.]+)\) \|)? ([^|]+) \|$", re.MULTILINE)


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
    """Syntax elements that another function reads than those that read them from the stream."""
    readers, sources = {}, {}
    for name, (tree, _) in functions.items():
        for element, read in check_index.set_in(tree):
            if read:
                sources.setdefault(element, set()).add(name)
        for variable in check_index.read_in(tree):
            readers.setdefault(variable, set()).add(name)
    return {e for e, found in sources.items() if readers.get(e, set()) - found}, set(sources)


def check(root):
    if not (root / ANNEX).is_file():
        return [f"there is no {ANNEX}"], ""
    text = (root / ANNEX).read_text(encoding="utf-8")
    functions = _functions(root)
    outlive, elements = _outlive(functions)
    kept = {name for tree, _ in functions.values() for name, _ in check_index.set_in(tree)
            if name is not None} - elements
    listed, complaints = set(), []
    for lives, function, clause, names in _ROW.findall(text):
        if lives.startswith("-") or lives == "lives for":
            continue
        names = names.split(", ")
        listed.update(names)
        if not function:
            complaints += [f"{name} does not outlive the function that reads it"
                           for name in names if name not in outlive]
            continue
        tree, at = functions.get(function, (None, None))
        if at != clause:
            complaints.append(f"{clause} has no {function}( )")
            continue
        complaints += [f"{function}( ) gives {name} no value" for name in names
                       if name not in set(_begun(tree))]
    complaints += [f"{name} is missing" for name in sorted((kept | outlive) - listed)]
    complaints += [f"{name} is nothing that lives" for name in sorted(listed - kept - outlive)
                   if name not in elements]
    return ([f"{ANNEX}: {c}" for c in complaints],
            f"{ANNEX} lists {len(listed)} variables and syntax elements")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=cpp_source.repository_root())
    options = parser.parse_args()
    return cpp_source.report("state", *check(options.root))


if __name__ == "__main__":
    sys.exit(main())
