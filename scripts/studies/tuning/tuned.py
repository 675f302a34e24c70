"""The tuned constants of the encoder: where they stand, and sources in which they can be changed.

A constant that was found by trial says so at its declaration, behind it or on the lines above it:

  constexpr int kRounds = 3;  // tuned (off: 1): rounds of the solver
  // tuned (off: 1e9): Candidates are encoded up to this multiple of the least expected cost, as
  // expected costs are wrong by about a tenth.
  constexpr double kTryFactor = 1.1;

`off` is the value that does without whatever it tunes. A constant that trades neither bytes nor
time says `fixed:` instead: limits of the format, memory, tolerances of rounding.
"""

import dataclasses
import functools
import re

# Sources of the search: those of each kind of GOF (encoder/codec/kinds) among them. Constants
# that are found by trial elsewhere have the same marks.
_SEARCH = re.compile(r"encoder/codec/(?:spans|sequence|kinds)/")

_DECLARATION = re.compile(
    r"^(?P<indent>[ ]*)(?P<storage>(?:(?:static|inline)[ ]+)*)constexpr[ ]+"
    r"(?P<type>[\w:]+(?:<[^=;{}()]*>)?)[ ]+(?P<name>k[A-Z]\w*)[ ]*"
    r"(?:=[ ]*(?P<value>[^;]+)|(?P<braces>\{[^;]*\}));"
    r"(?:[ ]*//[ ](?P<comment>.*))?$", re.MULTILINE)
_TAG = re.compile(r"(?P<tag>tuned|fixed)(?: \(off: (?P<off>[^()]+)\))?: (?P<reason>\S.*)")


def is_of_search(path):
    return bool(_SEARCH.match(path))


@dataclasses.dataclass(frozen=True)
class Constant:
    path: str         # relative to the root
    name: str
    type: str
    value: str        # text in the source
    tag: str          # tuned, fixed, or empty
    off: str          # empty: there is none
    reason: str
    span: tuple       # place of the declaration in the text
    indent: str
    storage: str

    @property
    def id(self):
        return f"{self.path.rsplit('/', 1)[-1].split('.')[0]}.{self.name}"

    @property
    def is_number(self):
        return number(self.value) is not None


def number(text):
    """The value of a literal, or None."""
    try:
        return float(text.replace("'", "").rstrip("UuLl"))
    except ValueError:
        return None


def _comment_above(text, start):
    """The comment that ends on the line before, from the line that a tag begins."""
    lines = []
    for line in reversed(text[:start].rstrip("\n").split("\n")):
        if not line.lstrip().startswith("// "):
            return ""
        lines.insert(0, line.lstrip()[3:])
        if _TAG.match(lines[0]):
            return " ".join(lines)
    return ""


@functools.lru_cache(maxsize=None)
def declarations(path, text):
    """All constants that are declared on one line."""
    return tuple(_constant(path, text, match) for match in _DECLARATION.finditer(text))


def _constant(path, text, match):
    tag = _TAG.match(match["comment"] or _comment_above(text, match.start()))
    return Constant(path, match["name"], match["type"],
                    (match["value"] or match["braces"]).strip(),
                    tag["tag"] if tag else "", (tag["off"] or "") if tag else "",
                    tag["reason"] if tag else "", match.span(), match["indent"],
                    match["storage"])


def sources(root):
    """(path from the root, text) of all sources of the encoder but its tests."""
    for path in sorted((root / "encoder").rglob("*")):
        if path.suffix in (".h", ".cpp") and not path.stem.endswith(("_test", "_fuzz")):
            yield path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")


def tuned(root):
    """The tuned constants, in order of their files."""
    return [c for path, text in sources(root) for c in declarations(path, text)
            if c.tag == "tuned"]


def variants(constant):
    """{column: value} that the constant is tried with."""
    values = {}
    if constant.off:
        values["off"] = constant.off
    if constant.is_number:
        value = number(constant.value)
        half, twice = value / 2, value * 2
        if constant.type != "double":
            half, twice = max(1, int(half)), int(twice)
        values["half"], values["double"] = repr(half), repr(twice)
    return {column: v for column, v in values.items() if v != constant.value}


# Encodings of a search, at most; not tuned, but 1 ends a search with its first encoding.
TRIALS = "target_search.kMaxTrials"

# Reads what the script asks for; in the scratch copy only.
OVERRIDE_HEADER = "encoder/tuned_override.h"
OVERRIDE = """#pragma once
#include <cstdlib>
#include <cstring>
namespace rlpc {
// RLPC_TUNED is "ID=VALUE;...": the values of these constants; others have their own.
inline double tuned_override(const char* id, double value) {
  const std::size_t size = std::strlen(id);
  for (const char* at = std::getenv("RLPC_TUNED"); at != nullptr; at = std::strchr(at, ';')) {
    if (*at == ';') ++at;
    if (std::strncmp(at, id, size) == 0 && at[size] == '=') {
      return std::strtod(at + size + 1, nullptr);
    }
  }
  return value;
}
}  // namespace rlpc
"""


def instrumented(path, text):
    """The text with its tuned numbers, and TRIALS, read when the program starts."""
    parts = []
    end = 0
    for c in declarations(path, text):
        if not c.is_number or (c.tag != "tuned" and c.id != TRIALS):
            continue
        storage = c.storage
        if storage.startswith("static"):  # a member of a class
            storage = "static inline "
        elif c.indent and not storage:
            storage = "static "
        start, stop = c.span
        parts += [text[end:start],
                  f"{c.indent}{storage}const {c.type} {c.name} = "
                  f'static_cast<{c.type}>(tuned_override("{c.id}", {c.value}));']
        end = stop
    if not parts:
        return text
    return f'#include "{OVERRIDE_HEADER}"\n' + "".join(parts) + text[end:]
