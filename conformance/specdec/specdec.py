#!/usr/bin/env python3
"""Decodes .rlpc streams by running the pseudo-code of the specification.

  specdec --rlpc-conformance                      capabilities, as JSON
  specdec decode IN.rlpc OUT.rlpd [--max-mem BYTES] [--trace] [--check-widths]
  specdec decode IN.rlpc OUT.rlpa ...             its attributes (Annex F)

  --max-mem BYTES   give up when the process needs more memory
  --trace           print every syntax element: bit position, name, value
  --check-widths    fail if an intermediate value exceeds 64 bits (slow)
  --spec FOLDER     the specification (default: spec/ of the project)
  --cache FOLDER    before the verb: keep the translated pseudo-code there
                    (default: $RLPC_SPECDEC_CACHE, if set)

OUT.rlpd holds exactly the frames before an error; OUT.rlpa is not written after
one, or without attributes. Exit code: 0 decoded; 1 not a
conforming stream; 2 not supported; 3 more memory needed than allowed; 4 a file
could not be read or written; 64 wrong usage; 70 the specification has an error.
On 1 to 3, the last line of standard error is
rlpc-verdict {"rule": ..., "bit": ..., "frame": ...}.
"""

import argparse
import functools
import json
import os
import pathlib
import re
import struct
import sys
import traceback
import zlib

sys.dont_write_bytecode = True
import program_cache
import spec_program

DONE, INVALID, UNSUPPORTED, LIMIT, IO, USAGE, SPEC_ERROR = 0, 1, 2, 3, 4, 64, 70
SPEC = pathlib.Path(__file__).resolve().parents[2] / "spec"
WITH_ATTRIBUTES = "stream_with_attributes"  # the function that is run for OUT.rlpa
_STREAM_HEADER_BYTES, _UNIT_HEADER, _CRC_BYTES = 10, struct.Struct(">BI"), 4
_ATTRIBUTES, _ASSET = 0x88, 0x89


class Verdict(Exception):
    """The stream ended the decoding."""

    def __init__(self, code, rule):
        super().__init__(rule)
        self.code = code
        self.rule = rule


class Decoder:
    """One run of the specification over one stream."""

    def __init__(self, program, data, write, trace=None, widths=False, write_attributes=None):
        """write(bytes) takes the output; trace(position, name, value) the syntax elements."""
        self._data = data
        self._trace = trace
        self._begin = 0
        self.variables = program.compile(
            {"StreamBytes": data, "require": self._require, "supported": self._supported,
             "inflates_to": self._inflates_to, "output_bytes": lambda b: write(bytes(b)),
             "output_attributes": lambda b: write_attributes(bytes(b)),
             "trace_begin": self._trace_begin, "trace_element": self._trace_element,
             "checked_width": _checked_width},
            trace=trace is not None, widths=widths)

    def call(self, name):
        with spec_program.without_collections():
            return self.variables[name]()

    def place(self):
        """(bit position, number of frames output) that decoding has reached."""
        if "BitPosition" not in self.variables:
            return 0, 0
        return self.call("Position"), self.variables.get("NumOutputFrames", 0)

    @staticmethod
    def _require(condition, rule):
        if not condition:
            raise Verdict(INVALID, rule)

    @staticmethod
    def _supported(condition, rule):
        if not condition:
            raise Verdict(UNSUPPORTED, rule)

    def _inflates_to(self, first, end, size):
        inflater = zlib.decompressobj()
        try:
            inflated = inflater.decompress(self._data[first:end], size + 1)
        except zlib.error:
            return 0
        return int(inflater.eof and not inflater.unused_data and len(inflated) == size)

    def _trace_begin(self, range_coded):
        v = self.variables
        self._begin = v["Position"]() if range_coded else v["BitPosition"]

    def _trace_element(self, name, value):
        self._trace(self._begin, name, int(value))


def _checked_width(value):
    if type(value) is int and not -(1 << 63) <= value < 1 << 63:
        raise OverflowError(f"{value} does not fit 64 bits")
    return value


def has_attribute_unit(data):
    """Whether there is one, or an asset unit, wherever it is; units are followed as far as their
    sizes lead."""
    at = _STREAM_HEADER_BYTES
    while at + _UNIT_HEADER.size <= len(data):
        code, size = _UNIT_HEADER.unpack_from(data, at)
        if code in (_ATTRIBUTES, _ASSET):
            return True
        at += _UNIT_HEADER.size + size + _CRC_BYTES
    return False


class Output:
    """A file that is created with the first bytes written to it."""

    def __init__(self, path):
        self._path = path
        self._file = None

    def write(self, data):
        if self._file is None:
            self._file = open(self._path, "wb")
        self._file.write(data)

    def close(self):
        if self._file is not None:
            self._file.close()


def program_of(folder, cache=None):
    cache = cache or os.environ.get("RLPC_SPECDEC_CACHE")
    return program_cache.CachedProgram(folder, cache) if cache else spec_program.Program(folder)


@functools.cache
def levels_of(program):
    """The levels of Table B-1."""
    variables = program.compile(
        {"StreamBytes": b"", "require": None, "supported": None, "inflates_to": None,
         "output_bytes": None, "output_attributes": None})
    return list(range(1, len(variables["Levels"]) + 1))


def describe(folder, cache=None):
    """The answer to --rlpc-conformance, all of it from the specification."""
    text = "\n".join(p.read_text(encoding="utf-8") for p in sorted(folder.glob("*.md")))
    version = re.search(r"\bspecifies RLPC version (\d+\.\d+)", text).group(1)
    profiles = re.findall(r"^\|\s*\d+\s*\|\s*(\w+)\s*\|\s*(\d+\.\d+)\s*\|", text, re.MULTILINE)
    return {"contract": 1, "name": "specdec", "version": version,
            "spec": [since for _, since in profiles],  # each minor version adds one
            "profiles": [name.lower() for name, _ in profiles],
            "levels": levels_of(program_of(folder, cache)), "outputs": ["rlpd", "rlpa"]}


def print_element(position, name, value):
    print(f"{position:10d}    {name} = {value}")


def limit_memory(size):
    import resource
    resource.setrlimit(resource.RLIMIT_AS, (size, size))


def decode(options):
    try:
        data = pathlib.Path(options.input).read_bytes()
    except OSError as error:
        print(f"specdec: {error}", file=sys.stderr)
        return IO
    program = program_of(options.spec, options.cache)
    if options.max_mem is not None:
        limit_memory(options.max_mem)
    output = Output(options.output)
    wants_attributes = pathlib.Path(options.output).suffix == ".rlpa"
    write = (lambda _: None) if wants_attributes else output.write
    decoder = Decoder(program, data, write, print_element if options.trace else None,
                      options.check_widths, output.write)
    verdict = {}
    try:
        decoder.call(WITH_ATTRIBUTES if wants_attributes else "stream")
        code = DONE
    except Verdict as error:
        code = error.code
        verdict["rule"] = error.rule
    except MemoryError:
        code = LIMIT
    except OSError as error:
        print(f"specdec: {error}", file=sys.stderr)
        return IO
    finally:
        output.close()
    if code != DONE:
        verdict["bit"], verdict["frame"] = decoder.place()
        sys.stdout.flush()
        print("rlpc-verdict " + json.dumps(verdict, separators=(",", ":")), file=sys.stderr)
    return code


class _Arguments(argparse.ArgumentParser):
    def error(self, message):
        self.print_usage(sys.stderr)
        print(f"specdec: {message}", file=sys.stderr)
        sys.exit(USAGE)


def arguments(argv):
    parser = _Arguments(prog="specdec", description=__doc__,
                        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rlpc-conformance", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--spec", type=pathlib.Path, default=SPEC, help=argparse.SUPPRESS)
    parser.add_argument("--cache", type=pathlib.Path, help=argparse.SUPPRESS)
    verbs = parser.add_subparsers(dest="verb", parser_class=_Arguments)
    verb = verbs.add_parser("decode")
    verb.add_argument("input")
    verb.add_argument("output")
    verb.add_argument("--max-mem", type=int)
    verb.add_argument("--trace", action="store_true")
    verb.add_argument("--check-widths", action="store_true")
    options = parser.parse_args(argv)
    if options.verb is None and not options.rlpc_conformance:
        parser.error("give a verb: decode, or --rlpc-conformance")
    return options


def main(argv=None):
    options = arguments(argv)
    try:
        if options.rlpc_conformance:
            print(json.dumps(describe(options.spec, options.cache)))
            return DONE
        return decode(options)
    except spec_program.SpecError as error:
        print(f"specdec: {error}", file=sys.stderr)
    except MemoryError:  # before decoding began
        print("rlpc-verdict {}", file=sys.stderr)
        return LIMIT
    except Exception:  # not the stream's fault: must not look like a verdict
        traceback.print_exc()
    return SPEC_ERROR


if __name__ == "__main__":
    sys.exit(main())
