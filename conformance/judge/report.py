"""Reports: one dictionary (report.schema.json), and the formats written from it."""

import collections
import json
import os
import sys
import xml.etree.ElementTree as ElementTree

import suite
from report_html import html

_MARKS = {"pass": "✓", "fail": "✗", "no rule": "no rule", "": "·"}


def kind_of(outcome):
    """PASS, FAIL, CRASH, UNSUPPORTED or NOT-RUN."""
    return outcome if outcome == "NOT-RUN" else outcome.split("-")[0]


def row_of(identity, title, expect, judgement):
    return {"id": identity, "title": title, "expect": expect, "outcome": judgement.outcome,
            "reason": judgement.reason, "text": judgement.text, "cells": judgement.cells,
            "seconds": None if judgement.seconds is None else round(judgement.seconds, 3),
            "details": judgement.details}


def report_of(about, title, facts, columns, grades, rows, passed):
    """about: decoder or encoder; columns: (key, label, meaning)."""
    return {"report": about, "title": title, "facts": facts,
            "columns": [{"key": k, "label": label, "meaning": m} for k, label, m in columns],
            "grades": grades,
            "outcomes": dict(collections.Counter(kind_of(r["outcome"]) for r in rows)),
            "passed": passed, "rows": rows}


def counts_text(report):
    """Every outcome with its number, and the denominator."""
    total = len(report["rows"])
    parts = [f"{n} {name}" for name, n in sorted(report["outcomes"].items())]
    return f"{total} in all: " + (", ".join(parts) or "none")


def text(report):
    """For a terminal."""
    lines = []
    for row in report["rows"]:
        if row["outcome"] in ("PASS", "UNSUPPORTED") and not row["reason"]:
            continue
        lines.append(f"{row['outcome']:17s} {row['id']:12s} {row['text']}")
        if kind_of(row["outcome"]) in ("FAIL", "CRASH"):
            lines.append(f"{'':18s}{row['details'].get('repeat', '')}")
    lines += [""] if lines else []
    lines.append(counts_text(report))
    for g in report["grades"]:
        lines.append(f"{g['grade']:13s} {g['status']:13s} {g['text']}")
    return "\n".join(lines) + "\n"


def markdown(report):
    lines = [f"# {report['title']}", ""]
    lines += [f"* {name}: {_code(value)}" for name, value in report["facts"].items()]
    lines += ["", counts_text(report), "", "| grade | status | |", "|---|---|---|"]
    lines += [f"| {g['grade']} | **{g['status']}** | {g['text']} |" for g in report["grades"]]
    labels = [c["label"] for c in report["columns"]]
    lines += ["", "| | expected | outcome | " + " | ".join(labels) + " | |",
              "|---|---|---|" + "---|" * len(labels) + "---|"]
    for row in report["rows"]:
        cells = [_MARKS.get(row["cells"][c["key"]], row["cells"][c["key"]])
                 for c in report["columns"]]
        lines.append(f"| {row['id']} | {row['expect']} | {row['outcome']} | " + " | ".join(cells)
                     + f" | {_escaped(row['text'])} |")
    return "\n".join(lines) + "\n"


def _code(value):
    return f"`{value}`" if "`" not in str(value) else str(value)


def _escaped(value):
    for character in "\\|<*_`":
        value = value.replace(character, "\\" + character)
    return value.replace("\n", " ")


def junit(report):
    """One test case per row; rows not run or unsupported are skipped."""
    kinds = [kind_of(row["outcome"]) for row in report["rows"]]
    root = ElementTree.Element(
        "testsuite", name=report["title"], tests=str(len(kinds)), failures=str(kinds.count("FAIL")),
        errors=str(kinds.count("CRASH")),
        skipped=str(kinds.count("UNSUPPORTED") + kinds.count("NOT-RUN")),
        time=f"{sum(row['seconds'] or 0 for row in report['rows']):.3f}")
    properties = ElementTree.SubElement(root, "properties")
    for name, value in report["facts"].items():
        ElementTree.SubElement(properties, "property", name=name, value=str(value))
    for row, kind in zip(report["rows"], kinds):
        case = ElementTree.SubElement(root, "testcase", name=row["id"], classname=row["expect"],
                                      time=f"{row['seconds'] or 0:.3f}")
        element = {"FAIL": "failure", "CRASH": "error", "UNSUPPORTED": "skipped",
                   "NOT-RUN": "skipped"}.get(kind)
        if element:
            inner = ElementTree.SubElement(case, element, message=_printable(row["text"]),
                                           type=row["outcome"])
            inner.text = _printable(json.dumps(row["details"], indent=1, ensure_ascii=False))
    return ('<?xml version="1.0" encoding="UTF-8"?>\n'
            + ElementTree.tostring(root, encoding="unicode") + "\n")


def _printable(value):
    """Removes control characters that XML forbids."""
    return "".join(c if c >= " " or c in "\n\t" else "\ufffd" for c in value)


def check_places(options):
    """Raises OSError early if a requested report could not be written in the end."""
    for path in (options.json, options.junit, options.markdown, options.html):
        folder = os.path.dirname(path or "") or "."
        if not os.access(folder, os.W_OK | os.X_OK):
            raise OSError(f"{path}: cannot be written; is {folder} a folder that you may write to?")


def write(report, options):
    """Writes the requested files: options has json, junit, markdown and html."""
    if options.json:
        suite.write_file(options.json, json.dumps(report, indent=1, ensure_ascii=False) + "\n")
    for path, form in ((options.junit, junit), (options.markdown, markdown), (options.html, html)):
        if path:
            suite.write_file(path, form(report))


def add_options(parser):
    group = parser.add_argument_group("reports")
    group.add_argument("--json", metavar="F", help="all results, for programs")
    group.add_argument("--junit", metavar="F", help="for continuous integration")
    group.add_argument("--markdown", metavar="F", help="a page for people")
    group.add_argument("--html", metavar="F", help="an interactive page in one file")


class Progress:
    """A progress line, on a terminal."""

    def __init__(self, total):
        self._total = total
        self._done = collections.Counter()
        self._shown = sys.stderr.isatty()

    def add(self, row):
        self._done[kind_of(row["outcome"])] += 1
        if self._shown:
            parts = " ".join(f"{name} {n}" for name, n in sorted(self._done.items()))
            done = sum(self._done.values())
            sys.stderr.write(f"\r\033[K{done}/{self._total}  {parts}  {row['id']}")
            sys.stderr.flush()

    def finish(self):
        if self._shown:
            sys.stderr.write("\r\033[K")
            sys.stderr.flush()
