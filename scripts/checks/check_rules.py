#!/usr/bin/env python3
"""spec/rules.json lists the rules that spec/*.md defines.

Every rule id in braces ends a sentence that begins with "It is a requirement of bitstream
conformance that" (a stream that breaks it is invalid) or "A stream is unsupported unless". Of each
rule the list has: id, clause, effect, sentence, and whether the pseudo-code checks it.

  --write    brings spec/rules.json up to date
"""

import argparse
import json
import pathlib
import re
import sys

import check_clauses
import cpp_source

EFFECTS = {"It is a requirement of bitstream conformance that": "invalid",
           "A stream is unsupported unless": "unsupported"}

_ID = re.compile(r"\{(R-[A-Z]{2,4}-\d{2})\}")


def prose(root):
    """(place, clause number, paragraph) of spec/*.md, without blocks."""
    for path in sorted((root / "spec").glob("*.md")):
        clause, fenced, lines = "", False, []
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines() + [""], 1):
            heading = None if fenced else check_clauses._HEADING.match(line)
            if line.startswith("```"):
                fenced = not fenced
            if line and not fenced and not heading and not line.startswith("```"):
                lines.append(line.strip())
            elif lines:
                yield f"{path.relative_to(root)}:{number - len(lines)}", clause, " ".join(lines)
                lines = []
            if heading:
                clause = heading.group(1)


def rules(root):
    """(list of rules, complaints)"""
    required = check_clauses.Spec(root).required
    found, complaints = [], []
    for place, clause, text in prose(root):
        end = 0
        for match in _ID.finditer(text):
            before, end = text[end:match.start()].strip(), match.end()
            starts = [before.rfind(start) for start in EFFECTS]
            if max(starts) < 0 or not before.endswith("."):
                complaints.append(f"{place}: no sentence of the fixed form ends with "
                                  f"{match.group(1)}")
                continue
            sentence = before[max(starts):]
            effect = list(EFFECTS.values())[starts.index(max(starts))]
            found.append({"rule": match.group(1), "clause": clause, "effect": effect,
                          "checked_by_pseudo_code": match.group(1) in required,
                          "sentence": sentence})
        for start in EFFECTS:
            if re.search(rf'(?<!"){start}', text[end:]):
                complaints.append(f"{place}: a sentence with `{start}` has no rule id")
    return sorted(found, key=lambda rule: rule["rule"]), complaints


def text_of(found):
    return json.dumps(found, indent=2, ensure_ascii=False) + "\n"


def check(root):
    found, complaints = rules(root)
    if not (root / "spec").is_dir():
        return [], "there is no spec/"
    path = root / "spec" / "rules.json"
    if not path.exists() or path.read_text(encoding="utf-8") != text_of(found):
        complaints.append("spec/rules.json is not up to date: scripts/rules")
    unchecked = [rule["rule"] for rule in found if not rule["checked_by_pseudo_code"]]
    return complaints, (f"{len(found)} rules, of which {len(unchecked)} are not checked by the "
                        f"decoding process ({', '.join(unchecked)})")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", type=pathlib.Path, default=cpp_source.repository_root())
    parser.add_argument("--write", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.write:
        (options.root / "spec" / "rules.json").write_text(text_of(rules(options.root)[0]),
                                                         encoding="utf-8")
    return cpp_source.report("rules", *check(options.root))


if __name__ == "__main__":
    sys.exit(main())
