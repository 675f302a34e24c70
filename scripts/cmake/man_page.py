#!/usr/bin/env python3
"""Writes the manual page of a program from its --help-all."""

import argparse
import os
import pathlib
import re
import subprocess
import sys

TOOLS = ("rlpcenc", "rlpcdec", "rlpcinfo", "rlpccmp", "rlpcval")
COLUMN = 26  # column of descriptions in the help


def escaped(text):
    """Text for roff: no line is a request, and hyphens stay hyphens."""
    text = text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq").replace("`", r"\(ga")
    return r"\&" + text if text.startswith(".") else text


def bold(text):
    return r"\fB" + escaped(text) + r"\fR"


def option(first, more):
    """An entry: "  -o, --output FILE   Its description" with the lines that continue it."""
    name, description = re.fullmatch(r"  (.*?)(?:  +(.*))?", first).groups()
    words = [bold(word) if word.startswith("-") else escaped(word)
             for word in re.findall(r"[^ ,]+|[ ,]+", name)]
    term = "".join(words) if name.startswith("-") else bold(name)
    lines = ([description] if description else []) + more
    return [".TP", term, *(escaped(line.strip()) for line in lines)]


def options(lines):
    """The entries of a list of options or arguments."""
    out, entry = [], []
    for line in lines + ["  "]:
        begins = not line.startswith(" " * COLUMN)
        if begins and entry:
            out += option(entry[0], entry[1:])
            entry = []
        if line.strip():
            entry.append(line)
    return out


def paragraph(lines):
    """Paragraphs; lines that are indented or in columns stay as they are."""
    out, exact = [], False
    for line in lines:
        if (line.startswith(" ") or "   " in line) != exact:
            exact = not exact
            out.append(".nf" if exact else ".fi")
        out.append(escaped(line))
    return out + ([".fi"] if exact else [])


def footer(blocks):
    """Blocks of lines: a short first line without an end is a heading."""
    out, headed = [], False
    for block in blocks:
        heading = re.fullmatch(r"[A-Z][\w ()./-]{0,60}", block[0])
        code = re.match(r"Exit code: (.*)", block[0])
        if code:
            out += [".SH EXIT STATUS", *paragraph([code.group(1), *block[1:]])]
        elif heading and len(block) > 1 and block[1].startswith("  "):
            out += [".SH " + escaped(block[0].upper()), *paragraph(block[1:])]
        else:
            out += [".PP" if headed else ".SH DESCRIPTION", *paragraph(block)]
        headed = True
    return out


def page(tool, version, text):
    """The manual page for the text of --help-all."""
    blocks = [block.split("\n") for block in re.split(r"\n\n+", text.strip())]
    about, usage = blocks[0][0], blocks[0][1].removeprefix("Usage: ")
    purpose = about[0].lower() + about[1:].rstrip(".")
    arguments = usage.removeprefix(tool + " ")
    out = [f'.TH {tool.upper()} 1 "" "rlpc {version}" "RLPC"',
           ".SH NAME", f"{tool} \\- {escaped(purpose)}",
           ".SH SYNOPSIS", f"{bold(tool)} {escaped(arguments)}"]
    rest = blocks[1:]
    if rest[0][0].startswith("  "):
        out += [".SH ARGUMENTS", *options(rest[0])]
        rest = rest[1:]
    while rest and rest[0][0].endswith(":") and not rest[0][0].startswith(" "):
        out += [f".SH {escaped(rest[0][0].rstrip(':').upper())}", *options(rest[0][1:])]
        rest = rest[1:]
    out += footer(rest)
    others = [f"{bold(other)}(1)" for other in TOOLS if other != tool]
    return "\n".join([*out, ".SH SEE ALSO", ",\n".join(others), ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tool", type=pathlib.Path, help="the program")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--version", required=True)
    args = parser.parse_args()
    done = subprocess.run([args.tool, "--help-all"], check=True, capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C.UTF-8", "COLUMNS": "80"})
    text = page(args.tool.name, args.version, done.stdout)
    partial = args.output.with_name(args.output.name + ".partial")
    partial.write_text(text, encoding="utf-8")
    partial.replace(args.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
