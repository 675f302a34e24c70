"""The first difference of an output from the reference, in file order."""

import contextlib
import pathlib
import sys
import tempfile
import threading

import rlpd
import sandbox

SPECDEC = [sys.executable, "-B",
           str(pathlib.Path(__file__).resolve().parents[1] / "specdec" / "specdec.py")]


class Reference:
    """Outputs of a trusted decoder, made on demand and kept until the end."""

    def __init__(self, folder, command=None, timeout=600):
        self.name = command or "specdec"
        self._words = sandbox.command_words(command) if command else SPECDEC
        self._folder = pathlib.Path(folder)
        self._timeout = timeout
        self._lock = threading.Lock()
        self._known = {}  # SHA-256 of a stream: (path or None, complaint)

    def output(self, stream):
        """(path of the .rlpd file, None), or (None, reason)."""
        with self._lock:  # one at a time: slow, and rarely needed
            if stream.sha256 not in self._known:
                self._known[stream.sha256] = self._make(stream)
            return self._known[stream.sha256]

    def _make(self, stream):
        path = self._folder / f"{stream.sha256}.rlpd"
        with tempfile.TemporaryDirectory(prefix="rlpc-judge-") as folder:
            done = sandbox.run([*self._words, "decode", str(stream.path.resolve()), str(path)],
                               pathlib.Path(folder), self._timeout)
        if not path.is_file():
            return None, f"{self.name} gave no output: {done.ending()}"
        if rlpd.digest_of(path).sha256() != stream.sha256_int:
            return None, f"{self.name} itself differs from the sidecar of {stream.id}"
        return path, None


def first_difference(got, expected):
    """A dictionary with "kind" header, triangle, vertex or frame-count; None if there is none.

    got and expected are paths; expected is a valid .rlpd file.
    """
    with rlpd.Reader(expected) as right:
        with contextlib.ExitStack() as stack:
            try:
                left = stack.enter_context(rlpd.Reader(got))
            except rlpd.RlpdError:
                size = pathlib.Path(got).stat().st_size
                return {"kind": "header", "field": "file", "expected": "a header of 44 bytes",
                        "got": f"{size} bytes"}
            return (_in_header(left, right) or _in_triangles(left, right)
                    or _in_frames(left, right))


def _in_header(left, right):
    for name, got, expected in zip(rlpd.FIELDS, left.header, right.header):
        if got != expected:
            return {"kind": "header", "field": name, "expected": _plain(expected),
                    "got": _plain(got)}
    return None


def _plain(value):
    return value.decode("latin-1") if isinstance(value, bytes) else value


def _in_triangles(left, right):
    got, expected = left.triangles(), right.triangles()
    if got == expected:
        return None
    t = _first(got, expected) // 3
    return {"kind": "triangle", "triangle": t, "expected": list(expected[3 * t:3 * t + 3]),
            "got": list(got[3 * t:3 * t + 3])}


def _in_frames(left, right):
    frame = 0
    while True:
        got, expected = left.frame_data(frame), right.frame_data(frame)
        if got != expected or not expected:
            break
        frame += 1
    if not got and not expected:
        return None
    if len(got) == len(expected):
        return {"kind": "vertex", "frame": frame,
                **_vertex(rlpd.integers(got), rlpd.integers(expected))}
    return {"kind": "frame-count", "frame": frame,
            "expected": f"{_frames(right)} frames", "got": f"{_frames(left)} frames"}


def _frames(reader):
    size = 12 * reader.num_vertices
    total = pathlib.Path(reader.path).stat().st_size - 44 - 12 * reader.num_triangles
    whole, rest = divmod(max(0, total), size)
    return f"{whole} and a part of" if rest else whole


def _vertex(got, expected):
    v = _first(got, expected) // 3
    wrong = sum(got[i:i + 3] != expected[i:i + 3] for i in range(0, len(expected), 3))
    return {"vertex": v, "expected": list(expected[3 * v:3 * v + 3]),
            "got": list(got[3 * v:3 * v + 3]),
            "also": f"{wrong} of {len(expected) // 3} vertices of this frame differ"}


def _first(a, b):
    return next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))


def first_float_difference(got, expected):
    """The same for an .f32 file, against the .rlpd file of the reference."""
    with open(got, "rb") as file, rlpd.Reader(expected) as right:
        frame = 0
        while True:
            integers = right.frame(frame)
            wanted = rlpd.f32_bytes(right.header[8:], right.header[7], integers)
            data = file.read(12 * right.num_vertices)
            if data != wanted:
                break
            if not wanted:
                return None
            frame += 1
    if len(data) != len(wanted):
        return {"kind": "frame-count", "frame": frame, "expected": f"{len(wanted)} bytes here",
                "got": f"{len(data)} bytes"}
    v = _first(data, wanted) // 12
    return {"kind": "vertex", "frame": frame, "vertex": v,
            "expected": _floats(wanted[12 * v:12 * v + 12]),
            "got": _floats(data[12 * v:12 * v + 12]),
            "also": f"position {list(integers[3 * v:3 * v + 3])}"}


def _floats(data):
    return [value.hex() for value in rlpd.integers(data, "f")]
