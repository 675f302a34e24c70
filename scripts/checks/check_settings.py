#!/usr/bin/env python3
"""Messages of libraries name settings, and programs name the options for them.

* No literal of a library names an option, such as "--gof": callers of a library have none. Free
  are programs, command lines, and pages that point to programs (FREE), and tests.
* Each setting that a message names in quotes, such as 'gof_frames' or 'profile = high', is a
  member of a header in SETTINGS, and has an option in the table of its side (TABLES).
* Each entry of a table is such a member, and an option that a program of its side has.
"""

import re
import sys

import cpp_source

LIBRARIES = ("common", "decoder", "encoder")
FREE = ("common/cli", "decoder/programs", "decoder/report", "encoder/programs")
TABLES = {"decoder": "decoder/programs/setting_options.h",
          "encoder": "encoder/programs/setting_options.h"}
# What callers set: of the encoder and its readers; of the writers of mesh files and pages.
SETTINGS = {
    "decoder": ("decoder/meshes/frame_sink.h", "decoder/web/player/player_page.h",
                "common/files/output_file.h"),
    "encoder": ("encoder/codec/settings.h", "encoder/meshes/frame_source.h",
                "encoder/frame_encoder.h", "encoder/c_api/rlpc_c_encoder.h")}

_LITERAL = re.compile(r'"(?:\\.|[^"\\\n])*"')
_JOINT = re.compile(r'"\s*"')  # between literals of one text
_OPTION = re.compile(r"(?<![\w-])--[a-z][\w-]*")
_VALUE = r"[a-z]\w* = \w+"
_SETTING = re.compile(rf"'([a-z]\w*|{_VALUE}(?:, {_VALUE})*)'")
_ENTRY = re.compile(r'\{"([^"]*)", "([^"]*)"\}')


def literals(text):
    """The contents of each literal; those of one text are joined."""
    joined = _JOINT.sub("", cpp_source.without_comments(text))
    return [match.group()[1:-1] for match in _LITERAL.finditer(joined)]


def members(root, side):
    """Words of the code of the headers with the settings of a side."""
    text = "".join(cpp_source.code_only(cpp_source.read(root / name)) for name in SETTINGS[side])
    return set(re.findall(r"\w+", text))


def table_of(root, side):
    """{setting: option} of a side; empty: there is no table."""
    path = root / TABLES[side]
    return dict(_ENTRY.findall(cpp_source.read(path))) if path.is_file() else {}


def is_listed(setting, table):
    return setting in table or setting.partition(" = ")[0] in table


def is_library(root, path):
    folder = path.parent.relative_to(root).as_posix()
    is_free = any(folder == free or folder.startswith(free + "/") for free in FREE)
    return not (is_free or cpp_source.is_test(path))


def check_messages(root, tables):
    """Complaints on literals of libraries; the settings that they name."""
    complaints, named = [], set()
    for path in cpp_source.files(root, LIBRARIES):
        if not is_library(root, path):
            continue
        name = path.relative_to(root).as_posix()
        side = name.split("/")[0]
        for literal in literals(cpp_source.read(path)):
            complaints += [f"{name}: a message names the option {option}: name the setting"
                           for option in _OPTION.findall(literal)]
            for setting in _SETTING.findall(literal):
                named.add(setting)
                usable = [tables[side]] if side in tables else tables.values()
                if not any(is_listed(setting, table) for table in usable):
                    table = TABLES.get(side, "any table")
                    complaints.append(f"{name}: the setting '{setting}' has no option in {table}")
    return complaints, named


def check_table(root, side, table):
    complaints = []
    known = members(root, side)
    programs = "".join(cpp_source.read(path)
                       for path in cpp_source.files(root, (f"{side}/programs",))
                       if path.relative_to(root).as_posix() != TABLES[side])
    for setting, option in table.items():
        words = [part.partition(" = ")[0] for part in setting.split(", ")]
        complaints += [f"{TABLES[side]}: no setting is called {word}"
                       for word in words if word not in known]
        complaints += [f"{TABLES[side]}: no program has the option {word}"
                       for word in _OPTION.findall(option) if f'"{word}"' not in programs]
    return complaints


def check(root):
    tables = {side: table_of(root, side) for side in TABLES}
    complaints, named = check_messages(root, tables)
    for side, table in tables.items():
        if not table:
            complaints.append(f"{TABLES[side]}: has no entries")
        complaints += check_table(root, side, table)
    if not named:
        complaints.append("no message names a setting")
    return complaints, f"{len(named)} settings that messages name have options"


if __name__ == "__main__":
    sys.exit(cpp_source.run("settings", __doc__, check))
