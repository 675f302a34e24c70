"""Files of decoded positions: .rlpd (Annex A) and .f32 (7.3), read as a stream of bytes."""

import array
import hashlib
import math
import struct
import sys

FIELDS = ("magic", "version", "num_vertices", "num_triangles", "num_frames",
          "frame_rate_numerator", "frame_rate_denominator", "grid_log2_step", "grid_origin[0]",
          "grid_origin[1]", "grid_origin[2]")
_HEADER = struct.Struct("<4s6I4i")
_BLOCK = 1 << 20
_LARGEST_FRAME = 12 << 23  # bytes, in the highest level


class RlpdError(Exception):
    """Bytes that are not an .rlpd file."""


def f32_bytes(origin, step, values):
    """The coordinates (7.3) of positions x, y, z, x, ... as little-endian binary32."""
    exact = [math.ldexp(p + origin[i % 3], step) for i, p in enumerate(values)]
    try:
        return struct.pack(f"<{len(exact)}f", *exact)
    except OverflowError:  # struct rounds as IEEE 754 does, but knows no infinity
        return b"".join(map(_f32, exact))


def _f32(value):
    try:
        return struct.pack("<f", value)
    except OverflowError:
        return struct.pack("<f", math.copysign(math.inf, value))


def integers(data, kind="i"):
    """The i32 values of little-endian bytes; with kind "f", the binary32 ones."""
    values = array.array(kind)
    assert values.itemsize == 4
    values.frombytes(data[:len(data) // 4 * 4])
    if sys.byteorder == "big":
        values.byteswap()
    return values


class Digest:
    """Consumes an .rlpd file in pieces; computes its hash, and that of each frame.

    on_frame(number, bytes), if given, is called with each complete frame.
    """

    def __init__(self, with_f32=False, on_frame=None):
        self.header = None  # the values of FIELDS, once there are 44 bytes
        self.frame_sha256 = []
        self.size = 0
        self._whole = hashlib.sha256()
        self._f32 = hashlib.sha256() if with_f32 else None
        self._on_frame = on_frame
        self._rest = bytearray()
        self._in_mesh = 0  # bytes of triangles still to come

    def feed(self, data):
        self._whole.update(data)
        self.size += len(data)
        self._rest += data
        if self.header is None:
            if len(self._rest) < _HEADER.size:
                return
            self.header = _HEADER.unpack_from(self._rest)
            self._in_mesh = 12 * self.header[3]
            del self._rest[:_HEADER.size]
        skipped = min(self._in_mesh, len(self._rest))
        self._in_mesh -= skipped
        del self._rest[:skipped]
        size = self.frame_bytes()
        if not 0 < size <= _LARGEST_FRAME:
            del self._rest[1:]  # implausible: not kept in memory
            return
        while not self._in_mesh and len(self._rest) >= size:
            self._take_frame(bytes(self._rest[:size]))
            del self._rest[:size]

    def _take_frame(self, frame):
        self.frame_sha256.append(hashlib.sha256(frame).hexdigest())
        if self._f32 is not None:
            self._f32.update(f32_bytes(self.header[8:], self.header[7], integers(frame)))
        if self._on_frame is not None:
            self._on_frame(len(self.frame_sha256) - 1, frame)

    def frame_bytes(self):
        return 12 * self.header[2] if self.header else 0

    def sha256(self):
        """The hash of all bytes; None if there were none."""
        return self._whole.hexdigest() if self.size else None

    def sha256_f32(self):
        return self._f32.hexdigest()

    def complaint(self):
        """Why it is not an .rlpd file, or None."""
        if self.header is None:
            return f"OUT has {self.size} bytes, which is less than a header"
        if self.header[0] != b"RLPD" or self.header[1] != 1:
            return "OUT does not begin with \"RLPD\" and version 1"
        if self._in_mesh:
            return "OUT ends within the triangles"
        if self._rest:
            return f"OUT ends within frame {len(self.frame_sha256)}"
        return None


def digest_of(path, on_frame=None):
    """The Digest of a file."""
    digest = Digest(on_frame=on_frame)
    with open(path, "rb") as file:
        for data in iter(lambda: file.read(_BLOCK), b""):
            digest.feed(data)
    return digest


def file_sha256(path):
    whole = hashlib.sha256()
    with open(path, "rb") as file:
        for data in iter(lambda: file.read(_BLOCK), b""):
            whole.update(data)
    return whole.hexdigest()


class Reader:
    """An .rlpd file, read part by part."""

    def __init__(self, path):
        self.path = path
        self._file = open(path, "rb")
        data = self._file.read(_HEADER.size)
        if len(data) < _HEADER.size:
            self._file.close()
            raise RlpdError("less than a header")
        self.header = _HEADER.unpack(data)
        self.num_vertices, self.num_triangles = self.header[2:4]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._file.close()

    def triangles(self):
        """The vertex indices of all triangles, as one sequence."""
        self._file.seek(_HEADER.size)
        return integers(self._file.read(12 * self.num_triangles))

    def frame_data(self, number):
        """The bytes of a frame; fewer if the file ends before."""
        size = 12 * self.num_vertices
        self._file.seek(_HEADER.size + 12 * self.num_triangles + size * number)
        return self._file.read(size)

    def frame(self, number):
        return integers(self.frame_data(number))
