"""Converts recipes to streams: the values of syntax elements, given or inferred."""

import zlib

import mesh_gates
import recipe as recipes
import stream_writer
import writing_code
from spec_program import without_collections  # found through writing_code

SIGNATURE = bytes([137, 82, 76, 80, 67, 13, 10, 26])

# Values of elements that the recipe does not give; 0 for all others.
DEFAULTS = {"profile_idc": 0, "level_idc": 1, "frame_rate_numerator_minus1": 29,
            "position_bits": 16, "urgent_degree": 5, "bones_flag": 1, "gof_kind": 1,
            "layer_step_minus1": 15, "temporal_weight": 256, "trajectory_flag": 1}

# Names of a recipe for absolute values: pseudo name -> (element, variable it differs from).
_ABSOLUTE = {"scale_idx": ("scale_idx_delta", "ScaleIdx"),
             "spatial_bits": ("spatial_bits_delta", "SpatialBits"),
             "temporal_bits": ("temporal_bits_delta", "TemporalBits"),
             "num_components": ("num_components_delta", None),
             "vertex_order": ("vertex_order_delta", None)}
_PSEUDO = set(_ABSOLUTE) | {"cluster", "gates", "mesh", "triangles", "json", "deflated", "payload",
                            "attribute_name", "payload_cut", "payload_append", "payload_replaced",
                            "section_end", "alignment", "stop"}
# The elements with which a component begins, unless that one comes directly before.
_FIRST_OF_COMPONENT = {"trajectory_flag": None, "scale_idx_delta": "trajectory_flag",
                       "spatial_bits_delta": "scale_idx_delta"}
_NEXT_SEED = 1000003  # step from one repetition of a unit to the next
_STREAM = ("version_major", "version_minor", "signature", "cut", "keep", "append", "flip")


def starts_component(name, before):
    """Whether an element starts a component or trajectory; before: the element before it."""
    return name in _FIRST_OF_COMPONENT and before != _FIRST_OF_COMPONENT[name]


def hexadecimal(entry):
    try:
        return bytes.fromhex(entry.text)  # blanks are skipped
    except ValueError as error:
        raise recipes.RecipeError(f"{entry.place}: hexadecimal bytes are expected") from error


class RecipeSource:
    """The values of the units of a recipe, unit by unit."""

    def __init__(self, recipe, elements):
        self._elements = elements
        self._seed = int(recipe.meta.get("seed", 0))
        self._values = {}
        self._scopes = {}
        self._component = None
        self._before = {}  # last absolute values
        self._gates = None
        self._name = []  # bytes left of the name of an attribute set
        self.unit_code = 0
        self.used = []  # (name, indices, value) as written

    def begin(self, unit, code, ns):
        self.unit_code = code
        seed = self._seed + unit.repetition * _NEXT_SEED
        self._values = self._group(unit.entries, seed)
        self._scopes = {n: self._group(e, seed + (n if isinstance(n, int) else 0))
                        for n, e in unit.components.items()}
        self._component = None
        self._before = {"num_components": 0, "vertex_order": 0}
        self._gates = self._gate_elements(ns)

    def _group(self, entries, seed):
        grouped = {}
        for entry in entries:
            if (entry.name not in self._elements and entry.name not in _PSEUDO
                    and entry.name != "unit_crc"):
                raise recipes.RecipeError(f"{entry.place}: {entry.name} is not a syntax element")
            # The later one of two entries with the same name and indices counts.
            grouped.setdefault(entry.name, {})[entry.indices] = recipes.Values(entry, seed)
        return grouped

    def entry(self, name):
        """The entry of a pseudo element, or None."""
        found = self._values.get(name, {}).get(())
        return found.entry if found else None

    def override(self, name, value):
        values = self._values.get(name, {}).get(())
        if values is None:
            return value
        if values.entry.text == "wrong":
            return value ^ 1
        return values.next()

    def unused(self):
        """Entries with values that nothing asked for."""
        groups = [self._values] + list(self._scopes.values())
        return [values.entry for group in groups for name, by_index in group.items()
                for values in by_index.values()
                if values.unused() and (name in self._elements or name in _ABSOLUTE)
                and name not in ("unit_size", "unit_crc")]

    def _gate_elements(self, ns):
        mesh = self.entry("mesh") or self.entry("triangles")
        if mesh is not None:
            follower = mesh_gates.MeshFollower(_triangles(mesh))

            def operation(gate):
                return follower.gate(ns) if gate else follower.component()
        else:
            values = self._values.get("gates", {}).get(())
            if values is None:
                return None

            def operation(gate):
                if values.done():
                    raise mesh_gates.GateError("no operation is left for "
                                               + ("a gate" if gate else "a component"))
                return values.next_text()
        return mesh_gates.GateElements(operation)

    def hook(self, ns):
        if self._gates is not None:
            self._gates.hook(ns)

    # Called by StreamWriter.

    def value(self, writer, name, indices, descriptor, arguments):
        value = self._value(writer, name, indices, arguments)
        self.used.append((name, indices, value))
        return value

    def _value(self, writer, name, indices, arguments):
        if name in ("ancillary_flag", "unit_type", "unit_size"):
            return {"ancillary_flag": self.unit_code >> 7, "unit_type": self.unit_code & 127,
                    "unit_size": 0}[name]
        if starts_component(name, self.used[-1][0] if self.used else None):
            self._component = 0 if self._component is None else self._component + 1
        found = self._given(name, indices)
        if found is None:
            found = self._absolute(writer.ns, name, indices)
        if found is None:
            found = self._cluster(writer.ns, name)
        if found is None and name.startswith("attribute_name_"):
            found = self._attribute_name(writer.ns, name)
        if found is None and self._gates is not None:
            found = self._gates.value(name)
        return inferred(writer, name, indices) if found is None else found

    def _groups(self):
        if self._component is not None:
            for key in (self._component, "all"):
                if key in self._scopes:
                    yield self._scopes[key]
        yield self._values

    def _given(self, name, indices):
        for group in self._groups():
            by_index = group.get(name, {})
            for length in range(len(indices), -1, -1):
                values = by_index.get(indices[:length])
                if values is not None and not values.done():
                    return values.next()
        return None

    def _absolute(self, ns, name, indices):
        for pseudo, (element, variable) in _ABSOLUTE.items():
            if element == name:
                wanted = self._given(pseudo, indices)
                if wanted is None:
                    return None
                before = self._before.get(pseudo, 0) if variable is None else ns[variable]
                self._before[pseudo] = wanted
                return wanted - before
        return None

    def _cluster(self, ns, name):
        if "cluster" not in self._values or name not in ("cluster_predicted_flag", "cluster_idx"):
            return None
        if name == "cluster_predicted_flag":
            self._before["cluster"] = self._given("cluster", ())
            return int(self._before["cluster"] == ns["PredictedCluster"])
        return self._before["cluster"]

    def _attribute_name(self, ns, element):
        """Size or next byte of the name of a set: of `attribute_name`, or "0", "1", ..."""
        if element == "attribute_name_size_minus1":
            values = self._values.get("attribute_name", {}).get(())
            given = values is not None and not values.done()
            text = values.next_text() if given else chr(ord("0") + len(ns["SetName"]))
            self._name = list(text.encode())
            return len(self._name) - 1
        return self._name.pop(0) if self._name else ord("0")


def _triangles(entry):
    text = entry.text.replace(",", " ").split()
    if entry.name == "triangles":
        numbers = [int(t) for t in text]
        if len(numbers) % 3:
            raise recipes.RecipeError(f"{entry.place}: triangles have three corners each")
        return [tuple(numbers[i:i + 3]) for i in range(0, len(numbers), 3)]
    if text[0] not in mesh_gates.MESHES:
        raise recipes.RecipeError(f"{entry.place}: known meshes are "
                                  + ", ".join(sorted(mesh_gates.MESHES)))
    return mesh_gates.MESHES[text[0]](*map(int, text[1:]))


def inferred(writer, name, indices):
    """The value of an element that the recipe does not give."""
    ns = writer.ns
    if name == "first_frame":
        return ns["NumParsedFrames"]
    if name == "num_gof_frames_minus1":
        return max(0, min(ns["NumFrames"] - ns["NumParsedFrames"], 64) - 1 if ns["open_end_flag"]
                   else ns["NumFrames"] - ns["NumParsedFrames"] - 1)
    if name == "position_crc":
        hashes = writer.hash_of_gof(ns["per_frame_flag"])
        return hashes[indices[0]] if indices[0] < len(hashes) else 0
    if name in ("frame_crc", "first_frame_crc"):
        return None  # known once the frame, or the whole stream, has been written
    if name == "layer_group_idx" and writer.source.unit_code == ns["FRAME"]:
        return ns["FrameGroups"][ns["frame_idx"]]
    if name == "rest_step_minus1" and ns["UnitCode"] == ns["GOF"] and ns["gof_kind"] == 3:
        return ns["frame_step_minus1"][0]
    if name == "unit_frames_minus1" and ns["layer_group_idx"] > 0:
        return max(0, len(ns["FramesToCome"]) - 1)
    if name in _SLICES:
        return _SLICES[name](ns)
    if name in writer.inferred:
        found = writer.inferred[name]
        if isinstance(found, list):
            return found.pop(0) if found else 0
        return found
    return DEFAULTS.get(name, 0)


def _next_group(ns):
    """The component group of the next slice, if none is left out: all layer groups of one first."""
    layer = ns["temporal_layer_idx"]
    if layer > 0:
        return sum(present > layer for present in ns["TemporalLayers"])
    group = ns["LastGroup"]
    if ns["HasVertices"] == 0 and group <= ns["num_component_groups"]:
        return group + 1  # its only slice has been written, or it is 0
    return group + (ns["SliceLayers"][group] > ns["num_layer_groups_minus1"])


def _next_layers(ns):
    group = ns["component_group_idx"]
    return ns["SliceLayers"][group] if group < len(ns["SliceLayers"]) else 0


def _next_frame(ns):
    """The frame of the next frame unit, if none is left out: all layer groups of one first."""
    if ns["FramesToCome"]:
        return ns["FramesToCome"][0]
    order, place = ns["FrameOrder"], ns["LastPlace"] + 1
    return order[place] if place < len(order) else ns["NumGofFrames"]


_SLICES = {"component_group_idx": _next_group, "layer_group_idx": _next_layers,
           "frame_idx": _next_frame,
           "bone_pivot": lambda ns: 1 << (ns["position_bits"] + 4),
           "extra_bone": lambda ns: next((b for b in range(ns["NumBones"])
                                          if ns["IsNewBone"](b)), 0)}


def unit_codes(ns):
    return {name: value for name, value in ns.items()
            if name.isupper() and isinstance(value, int) and name[0] != "_"}


class StreamBuilder:
    """Writes the stream of a recipe."""

    def __init__(self, program):
        self._program = program
        self._elements = set(writing_code.element_names(program))
        self._code = writing_code.writing_code(program)

    @without_collections()
    def build(self, recipe):
        """(bytes, StreamWriter)"""
        source = RecipeSource(recipe, self._elements)
        writer = stream_writer.StreamWriter(self._code, source)
        codes = unit_codes(writer.ns)
        settings = {e.name: e for e in recipe.stream}
        for name, entry in settings.items():
            if name not in _STREAM:
                raise recipes.RecipeError(f"{entry.place}: a stream can have {', '.join(_STREAM)}")
        writer.stream_header(*_stream_header(settings))
        offsets = []  # (code, first byte)
        for unit in recipe.units:
            code = int(unit.name, 16) if unit.name.startswith("0x") else codes.get(unit.name)
            if code is None:
                raise recipes.RecipeError(f"{recipe.path}: {unit.name} is not a unit; units are "
                                          + ", ".join(codes))
            _infer_positions(writer, codes, offsets, code)
            offsets.append((code, len(writer.data)))
            self._unit(recipe, writer, source, unit, code, codes)
        return _finish(writer.finish(self._program), settings), writer

    def _unit(self, recipe, writer, source, unit, code, codes):
        broken = len(writer.broken)
        source.begin(unit, code, writer.ns)
        with _Hooks(writer, source):
            try:
                writer.unit(code, _payload(source), lambda data: _change(source, data))
            except (mesh_gates.GateError, stream_writer.WriteError) as error:
                raise recipes.RecipeError(f"{recipe.path}: {unit.name}: {error}") from error
        if len(writer.broken) == broken and source.unused():
            entry = source.unused()[0]
            raise recipes.RecipeError(f"{entry.place}: {entry.name} has values that the unit "
                                      "does not use")
        if code == codes["SEQUENCE_HEADER"]:
            # If the version does not have the profile, GOFs are written as in the version.
            writer.ns["profile_idc"] = min(writer.ns["profile_idc"], writer.ns["version_minor"])
        if code == codes["GOF"]:
            writer.decode_gof()
        if code == codes["VERTEX_ORDER"]:
            writer.ns["HasVertexOrder"] = 1


class _Hooks:
    """Settings of a writer that last for one unit."""

    def __init__(self, writer, source):
        self._writer = writer
        self._kept = {n: writer.ns[n] for n in ("component_start", "vertex_instance")}
        end, alignment = source.entry("section_end"), source.entry("alignment")
        writer.highest_end = end is not None and end.text == "highest"
        writer.alignment = alignment.text if alignment is not None else "0"
        writer.stop_broken = source.entry("stop") is not None
        source.hook(writer.ns)

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self._writer.ns.update(self._kept)


def _payload(source):
    entry = source.entry("payload")
    return hexadecimal(entry) if entry is not None else None


def _change(source, payload):
    """The payload with the bytes that follow its elements, damaged as the recipe asks."""
    if source.entry("deflated") is not None:
        payload += hexadecimal(source.entry("deflated"))
    elif source.entry("json") is not None:
        text = source.entry("json").text.encode()
        if not source._values.get("metadata_size"):
            payload = len(text).to_bytes(4, "big")
        payload += _stored_zlib(text)
    if source.entry("payload_replaced") is not None:
        payload = hexadecimal(source.entry("payload_replaced"))
    if source.entry("payload_cut") is not None:
        payload = payload[:len(payload) - int(source.entry("payload_cut").text)]
    if source.entry("payload_append") is not None:
        payload += hexadecimal(source.entry("payload_append"))
    return payload


def _stored_zlib(text):
    """A zlib stream that does not depend on the version of a library: stored blocks."""
    out = b"\x78\x01"
    blocks = [text[i:i + 65535] for i in range(0, len(text), 65535)] or [b""]
    for i, block in enumerate(blocks):
        size = len(block).to_bytes(2, "little")
        out += bytes([int(i == len(blocks) - 1)]) + size + bytes(b ^ 255 for b in size) + block
    return out + zlib.adler32(text).to_bytes(4, "big")


def _stream_header(settings):
    signature = SIGNATURE
    if "signature" in settings:
        signature = hexadecimal(settings["signature"])
    version = [int(settings[n].text) if n in settings else d
               for n, d in (("version_major", 1), ("version_minor", 0))]
    return signature, version


def _finish(data, settings):
    """Damages the whole stream: inverts bits, cuts off or appends bytes."""
    if "flip" in settings:
        changed = bytearray(data)
        for bit in settings["flip"].text.split():
            changed[int(bit) // 8] ^= 128 >> (int(bit) % 8)
        data = bytes(changed)
    if "cut" in settings:
        data = data[:len(data) - int(settings["cut"].text)]
    if "keep" in settings:
        data = data[:int(settings["keep"].text)]
    if "append" in settings:
        data += hexadecimal(settings["append"])
    return data


def _infer_positions(writer, codes, offsets, code):
    """Infers the elements of index and end that describe the units before them."""
    here = len(writer.data)
    if code == codes["GOF_INDEX"]:
        gofs = [at for c, at in offsets if c == codes["GOF"]]
        writer.inferred["num_index_gofs_minus1"] = max(0, len(gofs) - 1)
        writer.inferred["first_gof_offset"] = gofs[0] if gofs else 0
        writer.inferred["index_gof_bytes"] = [b - a for a, b in zip(gofs, gofs[1:] + [here])]
        writer.inferred["index_gof_frames_minus1"] = list(writer.gof_frames)
        rigs = [at for c, at in offsets if c == codes["RIG"]]
        writer.inferred["num_index_rigs"] = len(rigs)
        writer.inferred["index_rig_idx"] = list(writer.rig_indices)
        writer.inferred["index_rig_distance"] = [b - a for a, b in zip([0] + rigs, rigs)]
    elif code == codes["END_OF_SEQUENCE"]:
        indexed = offsets and offsets[-1][0] == codes["GOF_INDEX"]
        writer.inferred["index_distance"] = here - offsets[-1][1] if indexed else 0
        writer.inferred["num_sequence_frames"] = writer.ns.get("NumParsedFrames", 0)
