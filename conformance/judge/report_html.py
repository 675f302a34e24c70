"""A report as a self-contained HTML page: no network, readable without scripts."""

import html as escaping
import json
import pathlib
import string

_PAGE = pathlib.Path(__file__).resolve().parent / "page.html"
_KINDS = ("PASS", "FAIL", "CRASH", "UNSUPPORTED", "NOT-RUN")
_CELLS = {"pass": ("c-pass", "✓"), "fail": ("c-fail", "✗"), "": ("c-none", "·"),
          "not declared": ("c-other", "n. d."), "not run": ("c-other", "n. r."),
          "unsupported": ("c-other", "uns.")}
_LABELS = {"divergence": "first difference", "command": "command", "repeat": "to repeat",
           "stderr": "standard error", "exit": "end", "verdict": "verdict"}
_ORDER = ("divergence", "exit", "verdict", "stderr", "command", "repeat")


def _e(value):
    return escaping.escape(str(value))


def _kind(row):
    return row["outcome"] if row["outcome"] == "NOT-RUN" else row["outcome"].split("-")[0]


def html(report):
    columns = report["columns"]
    rows = report["rows"]
    return string.Template(_PAGE.read_text(encoding="utf-8")).substitute(
        title=_e(report["title"]),
        verdict="passed" if report["passed"] else "not passed",
        verdict_class="PASS" if report["passed"] else "FAIL",
        facts="".join(f"<dt>{_e(k)}</dt><dd>{_e(v)}</dd>" for k, v in report["facts"].items()),
        grades="".join(map(_grade, report["grades"])),
        buttons=_buttons(rows),
        counts=f"{len(rows)} of {len(rows)} shown",
        row_name="stream" if report["report"] == "decoder" else "case",
        heads="".join(f'<th class="cell" title="{_e(c["meaning"])}">{_e(c["label"])}</th>'
                      for c in columns),
        rows="\n".join(_row(row, columns) for row in rows),
        legend="Columns: " + "; ".join(f"<b>{_e(c['label'])}</b> {_e(c['meaning'])}"
                                       for c in columns)
        + ". ✓ yes, ✗ no, · not asked of this row, n. d. not declared, n. r. not run, "
        "uns. unsupported.")


def _grade(g):
    style = {"PASS": "PASS", "FAIL": "FAIL"}.get(g["status"], "")
    share = 100 / max(1, g["of"])
    return (f'<div class="grade"><h2>{_e(g["grade"])} '
            f'<span class="badge {style}">{_e(g["status"])}</span></h2>'
            f'<div class="bar"><i class="p" style="width:{share * g["passed"]:.1f}%"></i>'
            f'<i class="f" style="width:{share * g["failed"]:.1f}%"></i></div>'
            f'<p>{_e(g["text"])}</p></div>')


def _buttons(rows):
    result = f'<button data-outcome="" aria-pressed="true">all {len(rows)}</button>'
    for kind in _KINDS:
        count = sum(_kind(row) == kind for row in rows)
        if count:
            result += (f'<button data-outcome="{kind}" aria-pressed="false">'
                       f'<span class="badge {kind}">{kind}</span> {count}</button>')
    return result


def _row(row, columns):
    words = " ".join([row["id"], row["title"], row["expect"], row["outcome"], row["reason"],
                      row["text"]]).lower()
    cells = ""
    for column in columns:
        state = row["cells"].get(column["key"], "")
        style, mark = _CELLS.get(state, ("c-other", state))
        cells += (f'<td class="cell {style}" title="{_e(column["label"])}: '
                  f'{_e(state or "not asked")}">{_e(mark)}</td>')
    return (f'<tr class="row" id="{_e(row["id"])}" data-kind="{_kind(row)}" '
            f'data-outcome="{_e(row["outcome"])}" data-text="{_e(words)}">'
            f'<td><button class="name" aria-expanded="false">{_e(row["id"])}</button> '
            f'<span class="title">{_e(row["title"])}</span></td>'
            f'<td class="expect">{_e(row["expect"])}</td>'
            f'<td><span class="badge {_kind(row)}">{_e(row["outcome"])}</span> '
            f'<span class="why">{_e(row["text"])}</span></td>{cells}</tr>\n'
            f'<tr class="details" hidden><td colspan="{3 + len(columns)}">'
            f'<dl>{_details(row)}</dl></td></tr>')


def _details(row):
    result = f"<dt>title</dt><dd>{_e(row['title'])}</dd>"
    details = row["details"]
    for name in [n for n in _ORDER if n in details] + sorted(set(details) - set(_ORDER)):
        value = details[name]
        if value in (None, "", {}):
            continue
        if isinstance(value, dict) and name == "divergence":
            value = "\n".join(f"{k}: {_shown(v)}" for k, v in value.items())
        elif not isinstance(value, str):
            value = json.dumps(value, ensure_ascii=False)
        result += f"<dt>{_e(_LABELS.get(name, name))}</dt><dd><pre>{_e(value)}</pre></dd>"
    if row["seconds"] is not None:
        result += f"<dt>time</dt><dd>{row['seconds']:.2f} s</dd>"
    return result


def _shown(value):
    return " ".join(map(str, value)) if isinstance(value, list) else value
