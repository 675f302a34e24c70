#!/usr/bin/env python3
"""spec/rules.json lists the rules that spec/*.md defines.

Every rule id in braces ends a sentence that begins with "It is a requirement of bitstream
conformance that" (a stream that breaks it is invalid) or "A stream is unsupported unless". The list
states id, clause, effect and sentence of each rule, and which process of the pseudo-code checks it:
decoding in order, only decoding of attributes, only random access, or none.

Every rule is checked by rlpcval: its id is a string in the code of the validator, in the parsers
that the validator includes, or in the readers of bits and sections that these share.

Every rule is broken by a stream of some version in streams/, or by one that a decoder may refuse;
and sidecars name no other rules. What decoders may refuse or not is in spec/permissive.md.

  --write    update spec/rules.json
"""

import json
import re
import sys

import check_clauses
import cpp_source

EFFECTS = {"It is a requirement of bitstream conformance that": "invalid",
           "A stream is unsupported unless": "unsupported"}

DECODING, RANDOM_ACCESS, NONE = "decoding", "random access", "none"
ATTRIBUTES = "attributes"
# Decoding in order runs no block of these: GOF index, and random access.
_RANDOM_ACCESS_CLAUSES = ("6.9", "8.8")

_ID = re.compile(r"\{(R-[A-Z]{2,4}-\d{2})\}")


def prose(root):
    """(place, clause number, paragraph) of spec/*.md, without blocks."""
    for path in sorted((root / "spec").glob("*.md")):
        clause, fenced, lines = "", False, []
        for number, line in enumerate(cpp_source.read(path).splitlines() + [""], 1):
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


def checked_by(spec, rule):
    """The process that checks a rule."""
    if rule not in spec.required:
        return NONE
    clauses = [number for number, clause in spec.clauses.items() if f'"{rule}"' in clause.text]
    innermost = [a for a in clauses if not any(b.startswith(a + ".") for b in clauses)]
    if all(number.startswith("F.") for number in innermost):
        return ATTRIBUTES  # Annex F, which a decoder may leave out
    return RANDOM_ACCESS if set(innermost) <= set(_RANDOM_ACCESS_CLAUSES) else DECODING


def rules(root):
    """(list of rules, complaints)"""
    spec = check_clauses.Spec(root)
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
                          "checked_by": checked_by(spec, match.group(1)), "sentence": sentence})
        for start in EFFECTS:
            if re.search(rf'(?<!"){start}', text[end:]):
                complaints.append(f"{place}: a sentence with `{start}` has no rule id")
    return sorted(found, key=lambda rule: rule["rule"]), complaints


def text_of(found):
    return json.dumps(found, indent=2, ensure_ascii=False) + "\n"


# Includes of parsers, and of what finds the parser of each kind of GOF.
_PARSER = re.compile(r'#include "(decoder/codec/(?:parse/|kinds/|units/access_unit_parser)'
                     r'[\w/]*)\.h"')


def validator_code(root):
    """The code with which rlpcval checks streams, without comments; "" if there is none."""
    own = [path for path in sorted((root / "conformance" / "rlpcval").glob("validator*"))
           if path.suffix in (".h", ".cpp") and not cpp_source.is_test(path)]
    text = "".join(cpp_source.without_comments(cpp_source.read(path)) for path in own)
    if not own:
        return ""
    seen, waiting = set(), {"common/codec/bits/bit_reader.cpp"}
    while waiting:
        seen |= waiting
        paths = [root / name for name in sorted(waiting) if (root / name).exists()]
        text += "".join(cpp_source.without_comments(cpp_source.read(path))
                        for path in paths)
        included = _PARSER.findall(text)
        waiting = {name + end for name in included for end in (".h", ".cpp")} - seen
    return text


def without_check(root, found):
    """Ids of rules that rlpcval does not check."""
    code = validator_code(root)
    return [rule["rule"] for rule in found if code and f'"{rule["rule"]}"' not in code]


def broken_by_streams(root):
    """For each version in streams/: (its name, ids of the rules that its streams break)."""
    for version in sorted((root / "streams").glob("v*")):
        sidecars = [json.loads(cpp_source.read(path))
                    for kind in ("reject", "either") for path in version.glob(f"{kind}/*/*.json")]
        if sidecars:
            yield version.name, {rule for sidecar in sidecars if not sidecar.get("superseded_by")
                                 for rule in sidecar["rules"]}


def stream_complaints(root, found):
    """(complaints about rules and streams, number of rules without a stream that breaks them)"""
    complaints, ids = [], {rule["rule"] for rule in found}
    versions = dict(broken_by_streams(root))
    for version, broken in versions.items():
        complaints += [f"streams/{version}: a sidecar names {rule}, which spec/ does not define"
                       for rule in sorted(broken - ids)]
    without = ids.difference(*versions.values()) if versions else set()
    complaints += [f"streams/: no stream breaks {rule}: write a recipe"
                   for rule in sorted(without)]
    return complaints, len(without)


def not_left_open(root):
    """Complaints about rules that decoders need not check, as some streams state, but that the
    page on differences between decoders does not name."""
    page = root / "spec" / "permissive.md"
    text = cpp_source.read(page) if page.is_file() else ""
    named = set(re.findall(r"R-[A-Z]{2,4}-\d{2}", text))
    for area, first, last in re.findall(r"(R-[A-Z]{2,4}-)(\d{2})\s+to\s+\1(\d{2})", text):
        named |= {f"{area}{number:02}" for number in range(int(first), int(last) + 1)}
    places = {}
    for path in sorted((root / "streams").glob("v*/either/*/*.json")):
        sidecar = json.loads(cpp_source.read(path))
        for rule in () if sidecar.get("superseded_by") else sidecar["rules"]:
            places.setdefault(rule, path.stem)
    return [f"spec/permissive.md: {rule} is left open by {place}, but not named here"
            for rule, place in sorted(places.items()) if rule not in named]


def check(root):
    found, complaints = rules(root)
    if not (root / "spec").is_dir():
        return ["there is no spec/"], ""
    path = root / "spec" / "rules.json"
    if not path.exists() or cpp_source.read(path) != text_of(found):
        complaints.append("spec/rules.json is not up to date: scripts/rules")
    unchecked = [rule["rule"] for rule in found if rule["checked_by"] != DECODING]
    missing = without_check(root, found)
    complaints += [f"{rule} has no check in rlpcval: conformance/rlpcval/validator*.cpp"
                   for rule in missing]
    about_streams, without = stream_complaints(root, found)
    complaints += [*about_streams, *not_left_open(root)]
    return complaints, (f"{len(found)} rules, of which {len(unchecked)} are not checked by the "
                        f"decoding process ({', '.join(unchecked)}), and {len(missing)} not by "
                        f"rlpcval; rules without a stream that breaks them: {without}")


def write(root):
    (root / "spec" / "rules.json").write_text(text_of(rules(root)[0]), encoding="utf-8")


if __name__ == "__main__":
    sys.exit(cpp_source.run("rules", __doc__, check, write))
