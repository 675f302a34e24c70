"""The subset of JSON Schema used by conformance/schema, with complaints that name the place.

Keywords: type, enum, pattern, minimum, properties, required, additionalProperties, items. A
schema with any other keyword is refused, so that none is ignored by mistake.
"""

import json
import pathlib
import re

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "schema"
_TYPES = {"object": dict, "array": list, "string": str, "integer": int, "number": (int, float),
          "boolean": bool, "null": type(None)}
_KEYWORDS = {"title", "type", "enum", "pattern", "minimum", "properties", "required",
             "additionalProperties", "items"}


class SchemaError(Exception):
    """A value that violates its schema."""


def load(name):
    """The schema conformance/schema/NAME.schema.json."""
    return json.loads((FOLDER / f"{name}.schema.json").read_text(encoding="utf-8"))


def check(value, schema, place="the value"):
    """Raises SchemaError with the first violation."""
    for complaint in complaints(value, schema, place):
        raise SchemaError(complaint)


def complaints(value, schema, place):
    """Yields a sentence per violation."""
    unknown = set(schema) - _KEYWORDS
    if unknown:
        raise ValueError(f"the schema of {place} has keywords not known here: {sorted(unknown)}")
    if "type" in schema and not _is_of(value, schema["type"]):
        wanted = schema["type"]
        wanted = wanted if isinstance(wanted, str) else " or ".join(wanted)
        yield f"{place} is {_shown(value)}; expected: {wanted}"
        return
    if "enum" in schema and not any(type(value) is type(e) and value == e for e in schema["enum"]):
        choices = ", ".join(json.dumps(e) for e in schema["enum"])
        yield f"{place} is {_shown(value)}; expected one of: {choices}"
    if isinstance(value, str) and "pattern" in schema and not re.search(schema["pattern"], value):
        yield f"{place} is {_shown(value)}; expected the form {schema['pattern']}"
    if (isinstance(value, (int, float)) and "minimum" in schema
            and value < schema["minimum"]):
        yield f"{place} is {_shown(value)}; expected at least {schema['minimum']}"
    if isinstance(value, dict):
        yield from _complaints_of_object(value, schema, place)
    if isinstance(value, list) and "items" in schema:
        for number, item in enumerate(value):
            yield from complaints(item, schema["items"], f"{place}[{number}]")


def _complaints_of_object(value, schema, place):
    properties = schema.get("properties", {})
    for name in schema.get("required", []):
        if name not in value:
            yield f"{place} has no \"{name}\""
    for name, item in value.items():
        if name in properties:
            yield from complaints(item, properties[name], f"{place}.{name}")
        elif schema.get("additionalProperties", True) is False:
            yield f"{place} has \"{name}\", which is not known here"


def _is_of(value, types):
    names = [types] if isinstance(types, str) else types
    if isinstance(value, bool):  # in Python, a bool is an int
        return "boolean" in names
    return any(isinstance(value, _TYPES[name]) for name in names)


def _shown(value):
    text = json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."
