#!/usr/bin/env python3
"""The tables of Annex D list the names of the pseudo-code in spec/*.md.

They list each function with the clause that defines it; each syntax element with the clauses of its
syntax, and those of its semantics, where it is in bold; and each other variable with the clauses
that assign to it, to an element of it, or append to it, and with the clauses that read it.

  --write    update the tables
"""

import ast
import pathlib
import re
import sys

import check_clauses
import cpp_source

sys.path.append(str(cpp_source.repository_root() / "conformance" / "specdec"))
import spec_program

ANNEX = pathlib.Path("spec", "annex-d-index.md")
_SEMANTICS = ("7.", "F.3")  # F.3: those of attributes


def variable(node):
    """The variable of the whole process that a target such as Ring[v] belongs to, or None."""
    while isinstance(node, ast.Subscript):
        node = node.value
    known = isinstance(node, ast.Name) and spec_program.is_global(node.id)
    return node.id if known else None


def set_in(tree):
    """(variable, whether a descriptor reads it) of each assignment and append."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            call = node.value
            yield variable(node.targets[0]), (
                isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
                and spec_program.is_descriptor(call.func.id))
        elif isinstance(node, ast.Attribute):
            yield variable(node.value), False


def read_in(tree):
    """The variables of the whole process that a block reads."""
    changed = set()  # nodes that name what is assigned or appended to
    for node in ast.walk(tree):
        if isinstance(node, (ast.Assign, ast.Attribute)):
            node = node.targets[0] if isinstance(node, ast.Assign) else node.value
            while isinstance(node, ast.Subscript):
                node = node.value
            changed.add(node)
    called = {node.func for node in ast.walk(tree) if isinstance(node, ast.Call)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and spec_program.is_global(node.id):
            if node not in changed and node not in called:
                yield node.id


def _explained_in(spec, element):
    """The clauses that have a syntax element in bold."""
    clauses = [number for number, clause in spec.clauses.items()
               if number.startswith(_SEMANTICS) and f"**{element}**" in clause.text]
    return [a for a in clauses if not any(b.startswith(a + ".") for b in clauses)]


def _table(columns, rows):
    head, *lines = ("| " + " | ".join(cells) + " |\n" for cells in
                    (columns, *sorted(rows, key=lambda row: (row[0].lower(), row[0]))))
    return head + "|" + "---|" * len(columns) + "\n" + "".join(lines)


def tables(root):
    """{name: text} of the tables."""
    functions, clauses_of = {}, {False: {}, True: {}}  # read by a descriptor: {name: clauses}
    readers = {}
    for _, _, clause, text in spec_program.blocks(root / "spec"):
        tree = ast.parse(text)
        functions.update((node.name, clause) for node in tree.body
                         if isinstance(node, ast.FunctionDef))
        for name, read in set_in(tree):
            if name is not None:
                clauses_of[read].setdefault(name, {})[clause] = None  # each once, in order
        for name in read_in(tree):
            readers.setdefault(name, {})[clause] = None
    spec = check_clauses.Spec(root)
    elements = clauses_of[True]
    variables = {name: found for name, found in clauses_of[False].items() if name not in elements}
    return {
        "functions": _table(["function", "clause"],
                            [[f"{name}( )", clause] for name, clause in functions.items()]),
        "elements": _table(["syntax element", "syntax", "semantics"],
                           [[name, ", ".join(found), ", ".join(_explained_in(spec, name))]
                            for name, found in elements.items()]),
        "variables": _table(["variable", "set in", "read in"],
                            [[name, ", ".join(found), ", ".join(readers.get(name, ()))]
                             for name, found in variables.items()]),
    }


def updated(root):
    """(the text of the annex with its tables as they have to be, complaints)"""
    text, complaints = (root / ANNEX).read_text(encoding="utf-8"), []
    for name, table in tables(root).items():
        text, count = re.subn(rf"(<!-- begin: {name}\b.*-->\n)[^<]*(<!-- end: {name} -->\n)",
                              lambda marks: marks.group(1) + table + marks.group(2), text)
        if count != 1:
            complaints.append(f"{ANNEX}: no marks `begin: {name}`, `end: {name}`, once each")
    return text, complaints


def check(root):
    if not (root / ANNEX).is_file():
        return [f"there is no {ANNEX}"], ""
    text, complaints = updated(root)
    if text != (root / ANNEX).read_text(encoding="utf-8"):
        complaints.append(f"{ANNEX} is not up to date: scripts/index")
    complaints += [f"{ANNEX}: {row.split()[1]} is in bold nowhere in clauses 7 and F.3"
                   for row in tables(root)["elements"].splitlines() if row.endswith("|  |")]
    return complaints, f"{ANNEX} lists the names of the pseudo-code"


def write(root):
    (root / ANNEX).write_text(updated(root)[0], encoding="utf-8")


if __name__ == "__main__":
    sys.exit(cpp_source.run("index", __doc__, check, write))
