"""Converts streams to recipes."""

import sys

import recipe as recipes
import recipe_source
import spec_program
import stream_writer
import writing_code

import specdec  # found through stream_writer

# Elements whose default is not 0, so that a recipe must give a 0.
_NOT_ZERO = set(recipe_source.DEFAULTS) | {
    "first_frame", "num_gof_frames_minus1", "num_index_gofs_minus1", "first_gof_offset",
    "index_gof_frames_minus1", "index_gof_bytes", "num_index_rigs", "index_rig_idx",
    "index_rig_distance", "index_distance", "component_group_idx", "layer_group_idx",
    "frame_idx", "bone_pivot", "extra_bone"}
_GATE_FLAGS = {"boundary_flag": "B", "close_flag": "C", "new_vertex_flag": "A",
               "glue_previous_flag": "P", "glue_next_flag": "N"}
_INFERRED = ("ancillary_flag", "unit_type", "unit_size", "unit_crc", "position_crc", "frame_crc",
             "version_major", "version_minor")
_COMPONENT = ("trajectory_flag", "scale_idx_delta", "spatial_bits_delta", "temporal_bits_delta",
              "temporal_predictor", "spatial_predictor", "temporal_residual", "spatial_residual",
              "temporal_weight", "temporal_between", "trajectory_residual")


class _Recorder:
    """The elements of each unit of a stream, as the specification reads them."""

    def __init__(self, code, data):
        self.units = []  # (first byte, [(name, value)])
        self.ns = spec_program.run(code, {
            "StreamBytes": data, "require": self._require, "supported": self._require,
            "inflates_to": lambda first, end, size: 1, "output_bytes": lambda data: None,
            "output_attributes": lambda data: None,
            "write_element": self._element})
        self.ns["DecodeGof"] = lambda: None
        self._instances = []
        for name in ("component_start", "gate", "vertex_instance"):
            self.ns[name] = getattr(self, "_" + name)(self.ns[name])
        try:
            self.ns["stream"]()
        except specdec.Verdict:
            pass

    @staticmethod
    def _require(condition, rule):
        if not condition:
            raise specdec.Verdict(1, rule)

    # Operations of 6.4, recorded among the elements as ("gates", operation).

    def _component_start(self, run):
        def component_start():
            self._instances = []
            self._operation(run, lambda elements: "T")
        return component_start

    def _gate(self, run):
        def gate():
            self._instances = []
            self._operation(run, _operation_of)
        return gate

    def _vertex_instance(self, run):
        def vertex_instance():
            before = self.ns["NumCodedVertices"]
            vertex = run()
            new = self.ns["NumCodedVertices"] > before
            self._instances.append("." if new else str(vertex))
            return vertex
        return vertex_instance

    def _operation(self, run, letter):
        elements = self.units[-1][1]
        first = len(elements)
        run()
        operation = letter(elements[first:])
        if any(i != "." for i in self._instances):
            operation += ":" + ",".join(self._instances)
        elements[first:] = [("gates", operation)]

    def _element(self, name, indices, descriptor, *arguments):
        if name == "ancillary_flag":
            self.units.append((self.ns["BitPosition"] // 8, []))
        value = self.ns[descriptor](*arguments)
        if self.units:
            self.units[-1][1].append((name, value))
        return value


def _operation_of(elements):
    """The operation that the elements of a gate specify."""
    last = dict(elements)
    for name, letter in _GATE_FLAGS.items():
        if last.get(name) == 1:
            return letter
    if last["far_join_flag"] == 1:
        return f"J@{last['join_node']}"
    distance = 1
    prefix = sum(value for name, value in elements if name == "join_prefix_flag")
    if prefix > 0:
        distance = ((2 + last["join_top_bit"]) << (prefix - 1)) + last["join_low_bits"]
    return ("J+" if last["forward_join_flag"] == 1 else "J-") + str(distance)


def compressed(values):
    """1 1 1 2 -> 3*1 2."""
    words, at = [], 0
    while at < len(values):
        end = at
        while end < len(values) and values[end] == values[at]:
            end += 1
        words.append(str(values[at]) if end - at == 1 else f"{end - at}*{values[at]}")
        at = end
    return words


def _lines(indent, name, values):
    if name not in _NOT_ZERO and not any(values):
        return []
    line, lines = f"{indent}{name} =", []
    for word in compressed(values):
        if len(line) + len(word) > 94:
            lines.append(line)
            line = indent + "   "
        line += " " + word
    return lines + [line]


def _bytes(name, data):
    text = data.hex()
    return "".join(f"{f'  {name} =' if i == 0 else '   '} {text[i:i + 80]}\n"
                   for i in range(0, max(1, len(text)), 80))


def _grouped(elements):
    groups = {}
    for name, value in elements:
        groups.setdefault(name, []).append(value)
    return groups


def _unit_lines(elements):
    """The lines for the elements of a unit, with those of each component in a group."""
    common, components = [], []
    before = None
    for name, value in elements:
        if recipe_source.starts_component(name, before):
            components.append([])
        before = name
        if name in _COMPONENT and components:
            components[-1].append((name, value))
        elif name not in _INFERRED:
            common.append((name, value))
    lines = []
    for name, values in _grouped(common).items():
        lines += _lines("  ", name, values)
    for n, component in enumerate(components):
        lines.append(f"  component {n}")
        for name, values in _grouped(component).items():
            lines += _lines("    ", name, values)
    return lines


class Decompiler:
    """Writes recipes, and checks with the builder that they give the stream again."""

    def __init__(self, program):
        self._code = writing_code.writing_code(program)
        self._builder = recipe_source.StreamBuilder(program)

    def recipe(self, data, meta):
        """The text of a recipe for a stream. meta: its first lines."""
        ns = _Recorder(self._code, data)
        names = {code: name for name, code in recipe_source.unit_codes(ns.ns).items()}
        head = "".join(f"{key}: {value}\n" for key, value in meta.items())
        if data[:8] != recipe_source.SIGNATURE or len(data) < 10:
            raise recipes.RecipeError("the signature is damaged")
        if data[8:10] != b"\x01\x00":
            head += f"stream\n  version_major = {data[8]}\n  version_minor = {data[9]}\n"
        text, at = head, 10
        for number, (start, elements) in enumerate(ns.units):
            if start != at:
                break
            end = start + 9 + int.from_bytes(data[start + 1:start + 5], "big")
            if end > len(data):
                break
            name = names.get(data[start], f"0x{data[start]:02X}")
            text += self._unit(text, name, elements, data[start:end], start)
            at = end
        return self._rest(text, data[at:])

    def _unit(self, before, name, elements, unit, start):
        """The unit by its elements if these give its bytes, otherwise by its bytes."""
        head = f"unit {name}\n"
        lines = "".join(line + "\n" for line in _unit_lines(elements))
        if name == "METADATA":
            lines += _bytes("deflated", unit[9:-4])
        for candidate in (head + lines, head + "  section_end = highest\n" + lines):
            if self._gives(before + candidate, unit, start):
                return candidate
        text = head + _bytes("payload", unit[5:-4])
        if not self._gives(before + text, unit, start):
            text += f"  unit_crc = 0x{unit[-4:].hex()}\n"
        return text

    def _gives(self, text, unit, start):
        try:
            data = self._builder.build(recipes.parse("decompiled", text, None))[0]
        except (recipes.RecipeError, stream_writer.WriteError):
            return False
        return data[start:] == unit

    @staticmethod
    def _rest(text, rest):
        """Bytes that are not a complete unit."""
        if not rest:
            return text
        return text + f"stream\n  append = {rest.hex()}\n"


sys.dont_write_bytecode = True
