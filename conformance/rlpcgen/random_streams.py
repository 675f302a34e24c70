"""Random legal streams from a seed, shaped to reach extremes.

A plan fixes what a stream is like (sizes, kind of mesh, how large residuals are); then the
specification itself asks for one element after the other, and each gets a random legal value,
often a limit. A requirement that fails here is an error of this file.
"""

import json

import mesh_gates
import recipe_source
import stream_writer
import writing_code
from recipe import Numbers
from spec_program import without_collections  # found through writing_code

_MAX_RESIDUAL = (1 << 28) - 1
MAX_RATE_MINUS1 = 4294967294  # R-HDR-03


class Plan:
    """Character of a random stream."""

    def __init__(self, numbers):
        n = self.numbers = numbers
        self.deep = n.chance(2)  # use as many components as a level allows
        self.reuse = int(n.chance(40))
        self.triangles = n.pick([0, 1, 2, n.between(3, 12), n.between(8, 90)])
        self.degenerate = n.pick([0, 0, 0, n.between(1, 4)])
        self.frames = n.pick([1, 2, n.between(3, 9), n.between(5, 24)])
        self.isolated = n.pick([0, 0, 0, 1, n.between(2, 9)])
        self.weights = {letter: n.pick([1, 3, 10, 40]) for letter in "BCAPNJ"}
        self.weights["B"] = n.pick([0, 1, 3, 20])
        self.far_percent = n.pick([0, 10, 60])
        self.level = n.pick([1, 1, 1, 2, 3, 4])
        self.clusters = n.pick([1, 1, 2, n.between(1, 9), n.between(1, 40)])
        self.lcf_percent = n.pick([0, 50, 90, 100])
        self.components = n.pick([0, 1, 2, n.between(1, 8)])
        self.hash_percent = n.pick([0, 50, 100])
        self.width = n.pick([0, 1, 3, 6, 12, 20, 28])  # bits of residuals
        self.escape_percent = n.pick([0, 0, 1, 10])
        if self.deep:
            self.level, self.frames, self.clusters, self.lcf_percent = 2, 1, 1, 0
            self.triangles, self.isolated, self.reuse = 0, n.between(0, 1), 0


class RandomSource:
    """Values of elements for a writer, by the names of the specification."""

    def __init__(self, plan):
        self.plan = plan
        self.numbers = plan.numbers
        self.unit_code = 0
        self.used = []
        self._gates = None
        self._component = None
        self._count = 0
        self._order = []
        self._seen = []

    def override(self, name, value):
        return value

    def value(self, writer, name, indices, descriptor, arguments):
        method = getattr(self, "_" + name, None)
        if method is not None:
            value = method(writer.ns, indices, arguments)
        else:
            value = self._gates.value(name) if self._gates else None
            if value is None:
                value = recipe_source.inferred(writer, name, indices)
        self.used.append((name, indices, value))
        return value

    # Draws.

    def near(self, low, high):
        """A number of a range: a limit, a number near a limit, or a number of any magnitude."""
        n = self.numbers
        if n.chance(25):
            return n.pick([low, high])
        if n.chance(30):
            return n.between(low, high)
        span = min(high - low, (1 << n.between(0, max(1, (high - low).bit_length()))) - 1)
        return low + n.between(0, span) if n.chance(70) else high - n.between(0, span)

    def residual(self, limit=_MAX_RESIDUAL, width=None):
        n = self.numbers
        bits = self.plan.width if width is None else width
        if n.chance(self.plan.escape_percent):
            bits = n.between(0, 28)
        magnitude = min(limit, n.between(0, (1 << n.between(0, bits)) - 1))
        if bits == 28 and n.chance(10):
            magnitude = limit
        return -magnitude if n.chance(50) else magnitude

    # Units and sequence header.

    def _ancillary_flag(self, ns, indices, arguments):
        return self.unit_code >> 7

    def _unit_type(self, ns, indices, arguments):
        return self.unit_code & 127

    def _level_idc(self, ns, indices, arguments):
        return self.plan.level

    def _num_vertices_minus1(self, ns, indices, arguments):
        return self.plan.vertices - 1

    def _num_triangles(self, ns, indices, arguments):
        return self.plan.all_triangles

    def _num_frames_minus1(self, ns, indices, arguments):
        return self.plan.frames - 1

    def _frame_rate_numerator_minus1(self, ns, indices, arguments):
        return self.near(0, MAX_RATE_MINUS1)

    _frame_rate_denominator_minus1 = _frame_rate_numerator_minus1

    def _grid_log2_step(self, ns, indices, arguments):
        return self.near(-150, 120)

    def _grid_origin(self, ns, indices, arguments):
        return self.near(-(1 << 26), 1 << 26)

    def _position_bits(self, ns, indices, arguments):
        return self.near(2, 24)

    # Connectivity.

    def _num_degenerate_triangles(self, ns, indices, arguments):
        return self.plan.degenerate

    def _urgent_degree(self, ns, indices, arguments):
        return self.plan.urgent_degree

    def _vertex_reuse_flag(self, ns, indices, arguments):
        return self.plan.reuse

    def _degenerate_vertex(self, ns, indices, arguments):
        return self.numbers.between(0, ns["NumVertices"] - 1)

    # GOF.

    def _num_gof_frames_minus1(self, ns, indices, arguments):
        left = ns["NumFrames"] - ns["NumParsedFrames"]
        return self.near(0, left - 1)

    def _num_clusters_minus1(self, ns, indices, arguments):
        self._component = None
        self._count = 0
        self._seen = []
        return min(self.plan.clusters, ns["MaxClusters"]) - 1

    def _fraction_bits(self, ns, indices, arguments):
        return self.near(0, 24)

    def _seed_step_minus1(self, ns, indices, arguments):
        return self.near(0, 65535)

    def _seed_predictor(self, ns, indices, arguments):
        return self.numbers.between(0, 4)

    def _seed_coupling_flag(self, ns, indices, arguments):
        return self.numbers.between(0, 1)

    def _lcf_flag(self, ns, indices, arguments):
        return int(ns["NumVertices"] >= 3 and self.numbers.chance(self.plan.lcf_percent))

    def _seed_vertex(self, ns, indices, arguments):
        if indices[1] == 0:
            self._seen = []
        free = [v for v in range(ns["NumVertices"]) if v not in self._seen]
        tracked = [v for v in ns["TrackVertex"] if v not in self._seen]
        if tracked and self.numbers.chance(30):
            free = tracked
        self._seen.append(self.numbers.pick(free))
        return self._seen[-1]

    def _cluster_predicted_flag(self, ns, indices, arguments):
        return int(self.numbers.chance(70))

    def _cluster_idx(self, ns, indices, arguments):
        return self.numbers.between(0, ns["NumClusters"] - 1)

    def _seed_residual(self, ns, indices, arguments):
        if indices[1:] == (0, 0) and self.numbers.chance(25):
            self._flat = True
        elif indices[1:] == (0, 0):
            self._flat = False
        return 0 if self._flat else self.residual()

    def _num_components_delta(self, ns, indices, arguments):
        wanted = self.numbers.between(0, 2 * self.plan.components)
        if self.plan.deep:
            wanted = ns["MaxComponents"]
        self._count, before = wanted, self._count
        return wanted - before

    def _scale_idx_delta(self, ns, indices, arguments):
        self._width = self.numbers.pick([self.plan.width, self.numbers.between(0, 28)])
        if self.plan.deep:
            self._width = 28
            return (127 if self.numbers.chance(90) else self.near(0, 127)) - ns["ScaleIdx"]
        return self.near(0, 127) - ns["ScaleIdx"]

    def _spatial_bits_delta(self, ns, indices, arguments):
        return (24 if self.plan.deep else self.near(1, 24)) - ns["SpatialBits"]

    def _temporal_bits_delta(self, ns, indices, arguments):
        return (26 if self.plan.deep else self.near(1, 26)) - ns["TemporalBits"]

    def _temporal_predictor(self, ns, indices, arguments):
        return self.numbers.between(0, 4)

    def _spatial_predictor(self, ns, indices, arguments):
        return self.numbers.between(0, 2)

    def _temporal_residual(self, ns, indices, arguments):
        return -_MAX_RESIDUAL if self.plan.deep else self.residual(width=self._width)

    _spatial_residual = _temporal_residual

    # Units after a GOF, and the rest.

    def _per_frame_flag(self, ns, indices, arguments):
        return self.numbers.between(0, 1)

    def _vertex_order_delta(self, ns, indices, arguments):
        if not self._order:
            self._order = list(range(ns["NumVertices"]))
            for i in range(len(self._order) - 1, 0, -1):
                k = self.numbers.between(0, i)
                self._order[i], self._order[k] = self._order[k], self._order[i]
            self._before = 0
        index = self._order.pop()
        self._before, before = index, self._before
        return index - before

    def gates(self, next_operation, ns):
        self._gates = mesh_gates.GateElements(next_operation)
        self._gates.hook(ns)


def _random_operation(plan, ns, gate):
    """A legal operation on the gate, or the start of a component."""
    n = plan.numbers
    if not gate:
        return "T:" + ",".join(_instance(plan, ns, k) for k in range(3))
    possible = {"B": True, "C": ns["CanClose"](), "A": ns["CanAddVertex"](),
                "P": ns["CanGluePrevious"](), "N": ns["CanGlueNext"]()}
    targets = [t for t in range(len(ns["NodeVertex"])) if ns["IsJoinTarget"](t)]
    possible["J"] = bool(targets)
    letters = [x for x in "BCAPNJ" if possible[x] for _ in range(plan.weights[x])]
    letter = n.pick(letters or ["B"])
    if letter == "A":
        return "A:" + _instance(plan, ns, 0)
    return letter + (_join(plan, ns, n.pick(targets)) if letter == "J" else "")


def _instance(plan, ns, before):
    coded = ns["NumCodedVertices"]
    if plan.reuse and coded and (coded + before >= ns["NumVertices"] or plan.numbers.chance(25)):
        return str(plan.numbers.between(0, coded - 1))
    return "."


def _join(plan, ns, target):
    if not plan.numbers.chance(plan.far_percent):
        forward, backward = ns["NodeNext"][ns["Gate"]], ns["Gate"]
        steps = plan.numbers.chance(50)
        for distance in range(1, 1024):
            forward, backward = ns["NodeNext"][forward], ns["NodePrevious"][backward]
            if steps and forward == target:
                return f"+{distance}"
            if not steps and backward == target:
                return f"-{distance}"
    return f"@{target}"


class RandomBuilder:
    """Builds random streams of a profile: `plan`, `source` and `sequence` are its classes."""

    def __init__(self, program, plan=None, source=None, sequence=None):
        self._program = program
        self._code = writing_code.writing_code(program)
        self._plan_class = plan or Plan
        self._source_class = source or RandomSource
        self._sequence_class = sequence or Sequence

    @without_collections()
    def build(self, seed):
        """(bytes, StreamWriter)"""
        plan = self._plan_class(Numbers(seed))
        plan.urgent_degree = plan.numbers.between(0, 15)
        operations = self._plan_connectivity(plan)
        source = self._source_class(plan)
        writer = stream_writer.StreamWriter(self._code, source, strict=True)
        writer.stream_header(recipe_source.SIGNATURE, [1, self._sequence_class.version_minor])
        source.gates(lambda gate: operations.pop(0), writer.ns)
        self._sequence_class(plan, writer).write()
        return writer.finish(self._program), writer

    def _plan_connectivity(self, plan):
        """Runs the connectivity once, to know the number of vertices it needs."""
        room = plan.numbers.between(3, 40) if plan.reuse else 3 * plan.triangles + 3
        source = self._source_class(plan)
        writer = stream_writer.StreamWriter(self._code, source, strict=True)
        writer.ns.update(NumVertices=room, NumTriangles=plan.triangles + plan.degenerate)
        operations = []

        def operation(gate):
            operations.append(_random_operation(plan, writer.ns, gate))
            return operations[-1]

        source.gates(operation, writer.ns)
        writer.unit(recipe_source.unit_codes(writer.ns)["CONNECTIVITY"])
        if not plan.reuse:
            # The vertices that occur, and some that do not.
            room = max(1, writer.ns["NumCodedVertices"] + plan.isolated)
        plan.vertices = room
        plan.all_triangles = plan.triangles + plan.degenerate
        return operations


class Sequence:
    """The units of a random stream, one after the other."""

    version_minor = 0

    def __init__(self, plan, writer):
        self._n = plan.numbers
        self._plan = plan
        self._writer = writer
        self._codes = recipe_source.unit_codes(writer.ns)
        self._offsets = []

    def _unit(self, name, payload=None):
        code = self._codes.get(name, name)
        recipe_source._infer_positions(self._writer, self._codes, self._offsets, code)
        self._offsets.append((code, len(self._writer.data)))
        self._writer.highest_end = self._n.chance(30)
        self._writer.unit(code, payload)

    def _skippable(self):
        if self._n.chance(10):
            text = json.dumps({"n": self._n.between(0, 99)}).encode()
            self._unit("METADATA", len(text).to_bytes(4, "big") + recipe_source._stored_zlib(text))
        if self._n.chance(10):
            size = self._n.between(0, 5)
            unknown = bytes(self._n.between(0, 255) for _ in range(size))
            self._unit(128 + self._n.pick([0, 4, 60, 127]), unknown)

    def _gof(self):
        self._unit("GOF")

    def _has_more(self):
        return self._writer.ns["NumParsedFrames"] < self._writer.ns["NumFrames"]

    def _may_have_hash(self):
        return True

    def write(self):
        self._unit("SEQUENCE_HEADER")
        self._skippable()
        self._unit("CONNECTIVITY")
        self._skippable()
        if self._n.chance(30):
            self._unit("VERTEX_ORDER")
            self._writer.ns["HasVertexOrder"] = 1
        self._skippable()
        while self._has_more():
            self._gof()
            self._writer.decode_gof()
            if self._n.chance(self._plan.hash_percent) and self._may_have_hash():
                self._unit("GOF_HASH")
            self._skippable()
        if self._n.chance(30):
            self._unit("GOF_INDEX")
        self._unit("END_OF_SEQUENCE")
