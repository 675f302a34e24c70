"""Operations on the gates of 6.4.4 from a list of triangles, and some small meshes."""


class GateError(ValueError):
    """An operation that is not possible on the current gate."""


def grid(columns, rows, wrap_columns=0, wrap_rows=0):
    """Two triangles for each cell; wrapped around: a tube or a torus."""
    across = columns + (0 if wrap_columns else 1)
    down = rows + (0 if wrap_rows else 1)

    def vertex(x, y):
        return (y % down) * across + x % across

    triangles = []
    for y in range(rows):
        for x in range(columns):
            a, b = vertex(x, y), vertex(x + 1, y)
            c, d = vertex(x, y + 1), vertex(x + 1, y + 1)
            triangles += [(a, b, c), (b, d, c)]
    return triangles


def fan(count, closed=0):
    """Triangles around vertex 0."""
    last = count if closed else count + 1
    return [(0, 1 + i, 1 + (i + 1) % last if closed else 2 + i) for i in range(count)]


def tetrahedron():
    return [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]


def octahedron():
    ring = [1, 2, 3, 4]
    pairs = list(zip(ring, ring[1:] + ring[:1]))
    return [(0, a, b) for a, b in pairs] + [(5, b, a) for a, b in pairs]


def separate(count, sides):
    """Closed fans without common vertices."""
    return [tuple(v + (sides + 1) * i for v in t) for i in range(count) for t in fan(sides, 1)]


MESHES = {"grid": grid, "fan": fan, "tetrahedron": tetrahedron, "octahedron": octahedron,
          "separate": separate}


class MeshFollower:
    """Finds for each gate the operation that gives the triangles of a mesh."""

    def __init__(self, triangles):
        self._triangles = [tuple(t) for t in triangles]
        self._used = [False] * len(self._triangles)
        self._by_edge = {}
        for i, t in enumerate(self._triangles):
            for k in range(3):
                self._by_edge.setdefault((t[k], t[(k + 1) % 3]), []).append(i)
        self._mesh_vertex = []  # [decoded vertex]
        self._decoded = {}

    def _instance(self, vertex):
        if vertex in self._decoded:
            return str(self._decoded[vertex])
        self._decoded[vertex] = len(self._mesh_vertex)
        self._mesh_vertex.append(vertex)
        return "."

    def component(self):
        """The operation that starts the next component."""
        for i, used in enumerate(self._used):
            if not used:
                self._used[i] = True
                return "T:" + ",".join(self._instance(v) for v in self._triangles[i])
        raise GateError("all triangles are there, but more are announced")

    def gate(self, ns):
        """The operation on the gate."""
        following, previous = ns["NodeNext"], ns["NodePrevious"]
        gate = ns["Gate"]
        start, end = self._at(ns, gate), self._at(ns, following[gate])
        found = [i for i in self._by_edge.get((start, end), []) if not self._used[i]]
        if not found:
            return "B"
        triangle = self._triangles[found[0]]
        self._used[found[0]] = True
        k = next(k for k in range(3) if (triangle[k], triangle[(k + 1) % 3]) == (start, end))
        third = triangle[(k + 2) % 3]
        if ns["CanClose"]() and self._at(ns, previous[gate]) == third:
            return "C"
        if third in self._decoded:
            if ns["CanGluePrevious"]() and self._at(ns, previous[gate]) == third:
                return "P"
            if ns["CanGlueNext"]() and self._at(ns, following[following[gate]]) == third:
                return "N"
            target = self._join_target(ns, third)
            if target is not None:
                return target
        return "A:" + self._instance(third)

    def _at(self, ns, node):
        return self._mesh_vertex[ns["NodeVertex"][node]]

    def _join_target(self, ns, vertex):
        gate, following, previous = ns["Gate"], ns["NodeNext"], ns["NodePrevious"]
        forward, backward = following[gate], gate
        for distance in range(1, 1024):
            forward, backward = following[forward], previous[backward]
            for node, sign in ((forward, "+"), (backward, "-")):
                if self._at(ns, node) == vertex and ns["IsJoinTarget"](node):
                    return f"J{sign}{distance}"
        for node in range(len(ns["NodeVertex"])):
            if self._at(ns, node) == vertex and ns["IsJoinTarget"](node):
                return f"J@{node}"
        return None


class GateElements:
    """The syntax elements of 6.4.3 to 6.4.6, from operations.

    T            starts a component        T:.,3,.  with these vertices; . is a new one
    B C P N      boundary, close, glue previous, glue next
    A  A:5       a new vertex instance, of vertex 5
    J+2 J-2 J@9  join with the node two steps forwards or backwards, or of number 9
    """

    _FLAGS = {"close_flag": "C", "new_vertex_flag": "A", "glue_previous_flag": "P",
              "glue_next_flag": "N"}

    def __init__(self, next_operation):
        """next_operation(gate) gives text; gate: for a gate, not for a component."""
        self._next = next_operation
        self._operation = ""
        self._instances = []
        self._instance = "."
        self._digits_left = 0

    def hook(self, ns):
        """Learns from the running specification where a component or an instance begins."""
        start, instance = ns["component_start"], ns["vertex_instance"]

        def component_start():
            self._begin(False)
            start()

        def vertex_instance():
            self._instance = self._instances.pop(0) if self._instances else "."
            return instance()

        ns.update(component_start=component_start, vertex_instance=vertex_instance)

    def value(self, name):
        """The value of an element, or None if it is not one of these."""
        if name == "boundary_flag":
            self._begin(True)
            return int(self._operation == "B")
        if name == "vertex_reused_flag":
            return int(self._instance != ".")
        if name == "reused_vertex":
            return int(self._instance)
        if name in self._FLAGS:
            return int(self._operation[0] == self._FLAGS[name])
        return self._join(name) if "join" in name else None

    def _begin(self, gate):
        self._operation = self._next(gate)
        if self._operation[0] not in ("BCAPNJ" if gate else "T"):
            raise GateError(f"{self._operation}: expected "
                            + ("an operation on a gate" if gate else "T"))
        self._instances = self._operation[2:].split(",") if ":" in self._operation else []

    def _join(self, name):
        if self._operation[0] != "J":
            raise GateError(f"{self._operation} is not possible on this gate")
        kind, number = self._operation[1], int(self._operation[2:])
        if name == "far_join_flag":
            self._digits_left = number.bit_length() - 1
            return int(kind == "@")
        if name == "join_node":
            return number
        if name == "forward_join_flag":
            return int(kind == "+")
        top = number.bit_length() - 1
        if name == "join_prefix_flag":
            self._digits_left -= 1
            return int(self._digits_left >= 0)
        if name == "join_top_bit":
            return (number >> (top - 1)) & 1
        return number & ((1 << (top - 1)) - 1)  # join_low_bits
