#!/usr/bin/env python3
"""Code and specification cite each other correctly.

Citations    "// 8.4.2 Title", "clause 8.4.2", "Annex B" and "Table 9-1" in comments of C++ code
             exist in spec/; a title after a number at the start of a comment equals the heading,
             or names a function of that clause, as in "// 6.3.1 sequence_header( )".
Parsers      each parse_*( ) of the headers of decoder/codec/parse/ and decoder/codec/kinds/*/parse/
             cites its clause.
Rules        every rule id in C++ code or pseudo-code, like R-HDR-03, is defined once in spec/,
             as {R-HDR-03}.
Elements     every syntax element of the `rlpc` blocks (name = u(1), name = ue(), name = ae(...))
             is a string literal in exactly one of these files (or the reader of units), or read
             in exactly one other file of decoder/, and no file reads other elements. An element
             that several functions of the specification read may be in as many files. Blocks of
             the clause of the parsing process describe bins, not elements.
"""

import collections
import functools
import dataclasses
import fnmatch
import itertools
import re
import sys

import cpp_source

PARSING_PROCESS = "9"
# Where parsers are: of what kinds of GOF share and of other units, of each kind, of unit headers.
PARSERS = ("decoder/codec/parse/", "decoder/codec/kinds/*/parse/",
           "decoder/codec/units/unit_reader.")

_NUMBER = r"(?:\d+|[A-Z])(?:\.\d+)*"
_DOTTED = r"(?:[1-9]\d*|[A-Z])(?:\.[1-9]\d*)+"
_HEADING = re.compile(rf"#{{1,6}}\s+(?:Annex\s+)?({_NUMBER})(?:[.:]?\s+|$)(.*)")
_CAPTION = re.compile(r"[#>*_\s]*Table ((?:\d+|[A-Z])-\d+)(?=\s*(?:$|[:.()*_—–-]|[A-Z]))")
_RULE = re.compile(r"\bR-[A-Z]{2,4}-\d{2}\b")
_ELEMENT = re.compile(
    r"\s*(?:\w+\.)*([a-z]\w*)\s*(?:\[[^=]*\]\s*)?=\s*(?:u|ue|se|ae|ae_\w+|bypass)\s*\(")
_FUNCTION = re.compile(r"def (\w+)")
_READ = re.compile(r'\.\s*(?:u|ue|se|flag)\(\s*(?:[^",()]*,\s*)?"(\w+)"')

# A free function that parses: its line begins with the type.
_PARSER = re.compile(r"^(?:inline )?[A-Z_a-z][\w:<>,& ]*? (parse_\w+)\(")

_CITED_START = re.compile(rf"({_DOTTED})(?![\w.]*\d)(.*)", re.DOTALL)
_CITED_CLAUSE = re.compile(
    rf"\b[Cc]lauses?\s+({_NUMBER}(?:(?:,|,?\s+(?:and|or|to))\s+{_DOTTED})*)(?!\w)")
_CITED_ANNEX = re.compile(r"\bAnnex\s+([A-Z])\b")
_CITED_TABLE = re.compile(r"\bTables?\s+((?:\d+|[A-Z])-\d+)(?:,?\s+(?:and|to)\s+([\dA-Z]+-\d+))?")


@dataclasses.dataclass
class Clause:
    title: str
    place: str
    text: str = ""


class Spec:
    """Headings, tables, rule definitions and syntax elements of spec/*.md."""

    def __init__(self, root):
        self.files = sorted((root / "spec").glob("*.md"))
        self.clauses = {}
        self.tables = set()
        self.rules = collections.defaultdict(list)
        self.required = {}
        self.elements = {}
        self.readers = collections.defaultdict(set)  # [element]: functions of the blocks
        self.complaints = []
        for path in self.files:
            self._read(path, path.relative_to(root))

    def _read(self, path, relative):
        fence = None
        number = None
        function = None
        for line_number, line in enumerate(cpp_source.read(path).splitlines(), 1):
            place = f"{relative}:{line_number}"
            heading = None
            if line.startswith("```"):
                fence = line[3:].strip() if fence is None else None
            elif fence is None:
                heading = _HEADING.match(line)
                caption = _CAPTION.match(line)
                if caption:
                    self.tables.add(caption.group(1))
                for rule in re.findall(r"\{(R-[A-Z]{2,4}-\d{2})\}", line):
                    self.rules[rule].append(place)
            elif fence == "rlpc":
                for rule in re.findall(rf'"({_RULE.pattern})"', line):
                    self.required.setdefault(rule, place)
                function = _FUNCTION.match(line) or function
                element = _ELEMENT.match(line)
                if element and (number or "").split(".")[0] != PARSING_PROCESS:
                    self.elements.setdefault(element.group(1), place)
                    self.readers[element.group(1)].add(function and function.group(1))
            if heading:
                number = heading.group(1)
                self._add_clause(number, heading.group(2), place)
            self._add_text(number, line)

    def _add_clause(self, number, title, place):
        if number in self.clauses:
            self.complaints.append(
                f"{place}: clause {number} is already at {self.clauses[number].place}")
            return
        self.clauses[number] = Clause(re.sub(r"[`*]", "", title).strip(" #"), place)

    def _add_text(self, number, line):
        parts = number.split(".") if number else []
        for end in range(1, len(parts) + 1):
            clause = self.clauses.get(".".join(parts[:end]))
            if clause:
                clause.text += line + "\n"

    def names(self, number, title):
        """Whether the words after a clause number are its title, or a function in it."""
        clause = self.clauses[number]
        words = " ".join(title.split())
        heading = " ".join(clause.title.split())
        if heading and re.match(re.escape(heading) + r"(?!\w)", words):
            return True
        call = re.match(r"([A-Za-z_]\w*)\s*\(", words)
        return bool(call and re.search(rf"\b{call.group(1)}\s*\(", clause.text))


@functools.lru_cache(maxsize=None)
def comment_lines(text):
    """(line number, the comment from there on) for every line that starts a comment text."""
    return tuple(_comment_lines(text))


def _comment_lines(text):
    bare = re.sub(r"//+|/\*+|\*/|^[ \t]*\*", lambda m: " " * len(m.group()),
                  cpp_source.comments_only(text), flags=re.MULTILINE)
    lines = bare.splitlines()
    for index, line in enumerate(lines):
        goes_on = index > 0 and re.search(r"\b(?:clauses?|and|or|to|,)\s*$", lines[index - 1])
        if line.strip() and not goes_on:
            # A title may be wrapped once.
            yield index + 1, "\n".join(part.strip() for part in lines[index:index + 2])


def check_start(spec, relative, text):
    """Comments that begin with a clause number."""
    for line, comment in comment_lines(text):
        match = _CITED_START.match(comment)
        if not match:
            continue
        number, rest = match.groups()
        if re.fullmatch(r"\d+\.\d+", number) and re.match(r" [a-z]+ (?!\()", rest + " "):
            if number not in spec.clauses:
                continue  # "1.5 times it" is prose
        if number.split(".")[0] not in spec.clauses and not re.match(r"[:\s]\s*\w", rest):
            continue  # "62.5, up" too
        more = re.match(rf"(?:,|\s+(?:to|and|or))\s+({_DOTTED})", rest)
        if more and more.group(1) not in spec.clauses:
            yield f"{relative}:{line}: there is no clause {more.group(1)}"
        if number not in spec.clauses:
            yield f"{relative}:{line}: there is no clause {number}"
        elif not more and rest[:1].isspace() and rest.split("\n")[0].strip():
            if not spec.names(number, rest):
                yield (f'{relative}:{line}: clause {number} is "{spec.clauses[number].title}", '
                       f'not "{rest.splitlines()[0].strip()}"')


@functools.lru_cache(maxsize=None)
def citations(text):
    """(position, kind, name) of clauses, annexes and tables named within comments, and of rules
    named anywhere."""
    comments = re.sub(r"\n([ \t]*)//", r"\n\1  ", cpp_source.comments_only(text))
    cited = []
    for match in _CITED_CLAUSE.finditer(comments):
        cited += [(match.start(), "clause", number)
                  for number in re.findall(_NUMBER, match.group(1))]
    for match in _CITED_ANNEX.finditer(comments):
        cited.append((match.start(), "Annex", match.group(1)))
    for match in _CITED_TABLE.finditer(comments):
        cited += [(match.start(), "Table", table) for table in match.groups() if table]
    for match in _RULE.finditer(text):
        cited.append((match.start(), "rule", match.group()))
    return tuple(cited)


def check_references(spec, relative, text):
    """Clauses, annexes and tables named within comments; rules named anywhere."""
    known = {"clause": spec.clauses, "Annex": spec.clauses, "Table": spec.tables,
             "rule": spec.rules}
    for position, kind, name in citations(text):
        if kind == "rule" and cpp_source.is_test(relative):
            continue  # tests may make up rules
        if name not in known[kind]:
            yield (f"{relative}:{cpp_source.line_of(text, position)}: there is no "
                   f"{kind} {name}")


def check_elements(spec, parsers):
    """`parsers` maps file names to the text of the parsing functions, without comments."""
    homes = collections.defaultdict(set)
    for name, text in parsers.items():
        for literal in re.findall(r'"(\w+)"', text):
            homes[literal].add(name)
    for element, place in sorted(spec.elements.items()):
        count = len(homes[element])
        if count == 0:
            yield f"{place}: syntax element {element} is read by no parser"
        elif count > len(spec.readers[element]):
            yield (f"{place}: syntax element {element} is named by {count} parsers: "
                   + ", ".join(sorted(homes[element])))
    if spec.elements:
        for name, text in parsers.items():
            for match in _READ.finditer(text):
                if match.group(1) not in spec.elements:
                    yield (f"{name}:{cpp_source.line_of(text, match.start())}: "
                           f"{match.group(1)} is in no syntax table")


def is_in(place, name):
    return fnmatch.fnmatchcase(name, place + "*")


def is_parser(relative):
    return any(is_in(place, relative.as_posix()) for place in PARSERS)


def uncited(root, spec):
    """Declarations of parsers without a clause, in the comment above them or that of the file."""
    for path in cpp_source.files(root, ("decoder",)):
        if (path.suffix != ".h" or cpp_source.is_test(path)
                or not is_parser(path.relative_to(root))):
            continue
        lines = cpp_source.read(path).splitlines()
        opening = " ".join(itertools.takewhile(lambda line: line.startswith("//"), lines))
        for index, line in enumerate(lines):
            match = _PARSER.match(line)
            if not match:
                continue
            above = index
            while above > 0 and lines[above - 1].lstrip().startswith("//"):
                above -= 1
            cited = re.findall(_DOTTED, opening + " " + " ".join(lines[above:index]))
            if not any(number in spec.clauses for number in cited):
                yield (f"{path.relative_to(root)}:{index + 1}: {match.group(1)}( ) cites no "
                       "clause, nor does its file")


def check(root):
    spec = Spec(root)
    if not spec.files:
        return ["spec/ is empty"], ""
    complaints = list(spec.complaints)
    for rule, places in sorted(spec.rules.items()):
        if len(places) > 1:
            complaints.append(f"{places[1]}: rule {rule} is already defined at {places[0]}")
    for rule, place in sorted(spec.required.items()):
        if rule not in spec.rules:
            complaints.append(f"{place}: rule {rule} is defined nowhere")
    parsers = {}
    used = set()
    for path in cpp_source.files(root, cpp_source.LAYERS):
        text = cpp_source.read(path)
        relative = path.relative_to(root)
        complaints += check_start(spec, relative, text)
        complaints += check_references(spec, relative, text)
        used |= set(_RULE.findall(text))
        if relative.parts[0] == "decoder" and not cpp_source.is_test(path):
            text = cpp_source.without_comments(text)
            parsers[str(relative)] = (text if is_parser(relative)
                                      else cpp_source.kept(text, _READ))
    complaints += [f"{place} has no sources" for place in PARSERS
                   if not any(is_in(place, name) for name in parsers)]
    complaints += check_elements(spec, parsers)
    complaints += uncited(root, spec)
    summary = (f"{len(spec.clauses)} clauses, {len(spec.elements)} syntax elements, "
               f"{len(spec.rules)} rules of which {len(used & set(spec.rules))} in code")
    return complaints, summary


if __name__ == "__main__":
    sys.exit(cpp_source.run("clauses", __doc__, check))
