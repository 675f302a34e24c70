"""Animations as encoders read them: MESH.obj for the triangles, POINTS.pc2 for the frames."""

import pathlib
import struct

import rlpd

_HEADER = struct.Struct("<12siiffi")


class InputError(Exception):
    """An invalid input file."""


class Animation:
    """num_vertices, triangles (lists of three indices), and the frames as lists of floats."""

    def __init__(self, mesh, points, max_frames=0):
        self.mesh = pathlib.Path(mesh)
        self.triangles = _triangles(self.mesh)
        data = pathlib.Path(points).read_bytes()
        if len(data) < _HEADER.size or data[:12] != b"POINTCACHE2\0":
            raise InputError(f"{points}: not a .pc2 file")
        _, _, self.num_vertices, self._start, self._rate, samples = _HEADER.unpack_from(data)
        self.num_frames = min(samples, max_frames) if max_frames else samples
        self._size = 12 * self.num_vertices
        self._data = data[_HEADER.size:_HEADER.size + self._size * self.num_frames]
        if len(self._data) != self._size * self.num_frames:
            raise InputError(f"{points}: the file ends within a frame")

    def frame(self, number):
        return rlpd.integers(self._data[self._size * number:self._size * (number + 1)], "f")

    def write_points(self, path):
        header = _HEADER.pack(b"POINTCACHE2\0", 1, self.num_vertices, self._start, self._rate,
                              self.num_frames)
        pathlib.Path(path).write_bytes(header + self._data)

    def diagonal(self):
        """The diagonal of the bounding box of the first frame."""
        values = self.frame(0)
        sides = [max(values[c::3]) - min(values[c::3]) for c in range(3)]
        return sum(side * side for side in sides) ** 0.5


def _triangles(path):
    """Faces of an OBJ file; those with more corners as fans."""
    triangles = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        words = line.split()
        if words[:1] == ["f"]:
            try:
                corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            except ValueError as error:
                raise InputError(f"{path}:{number}: {error}") from error
            triangles += [[corners[0], corners[k], corners[k + 1]]
                          for k in range(1, len(corners) - 1)]
    return triangles
