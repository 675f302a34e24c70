"""Faults of OUT."""

import math
import struct


def _sizes(data):
    """(offset of the first frame, bytes of a frame)"""
    vertices, triangles = struct.unpack_from("<II", data, 8)
    return 44 + 12 * triangles, 12 * vertices


def one_vertex_off_by_one(request):
    """y of the vertex in the middle of the last frame."""
    if request.code == 0:
        _, size = _sizes(request.data)
        at = len(request.data) - size + size // 24 * 12 + 4
        value = struct.unpack_from("<i", request.data, at)[0]
        request.data = request.data[:at] + struct.pack("<i", value + 1) + request.data[at + 4:]


def last_frame_is_missing(request):
    if request.code == 0:
        request.data = request.data[:-_sizes(request.data)[1]]


def one_frame_too_many(request):
    if request.code == 0:
        request.data += request.data[-_sizes(request.data)[1]:]


def last_frame_is_cut(request):
    if request.code == 0:
        request.data = request.data[:-5]


def another_number_of_frames_in_the_header(request):
    """The frames themselves, and their number, are right."""
    if request.code == 0:
        count = struct.unpack_from("<I", request.data, 16)[0]
        request.data = request.data[:16] + struct.pack("<I", count + 1) + request.data[20:]


def a_triangle_is_turned(request):
    """Rotates the corners of the last triangle; its orientation stays."""
    at = _sizes(request.data)[0] - 12 if request.code == 0 else 0
    if at >= 44:
        a, b, c = struct.unpack_from("<III", request.data, at)
        request.data = request.data[:at] + struct.pack("<III", b, c, a) + request.data[at + 12:]


def always_the_first_output(request):
    """Outputs the first stream that it decoded for all later streams."""
    kept = request.kept_folder() / "stale"
    if request.code == 0 and not kept.exists():
        kept.write_bytes(request.data)
    if kept.exists():
        request.data = kept.read_bytes()


def writes_nothing(request):
    request.data = None


def stops_within_the_header(request):
    request.data = b"RLPD" if request.code == 0 else request.data


def drops_frames_before_an_error(request):
    """Writes output only if there is no error."""
    if request.code != 0:
        request.data = None


def a_frame_more_before_an_error(request):
    """Outputs one more frame, as if the frame with the error counted."""
    if request.code == 1 and request.verdict["frame"]:
        request.data += request.data[-_sizes(request.data)[1]:]


def writes_before_the_first_gof(request):
    """Writes the header as soon as its values are known."""
    if request.data is None:
        request.data = struct.pack("<4s10i", b"RLPD", 1, 400, 722, 5, 30, 1, 0, 0, 0, 0)


def one_wrong_frame_before_an_error(request):
    if request.code == 1 and request.verdict["frame"]:
        request.data = request.data[:-4] + bytes(4)


def _floats(request, convert):
    """Writes OUT.f32 if that is requested instead of OUT.rlpd."""
    if request.code != 0 or request.output.suffix != ".f32":
        return
    step, *origin = struct.unpack_from("<4i", request.data, 28)
    first, _ = _sizes(request.data)
    values = struct.unpack(f"<{(len(request.data) - first) // 4}i", request.data[first:])
    request.data = b"".join(convert(math.ldexp(p + origin[i % 3], step))
                            for i, p in enumerate(values))


def right_floats(request):
    """No fault."""
    _floats(request, lambda x: struct.pack("<f", x))


right_floats.declares = {"outputs": ["rlpd", "f32"]}


def floats_one_ulp_off(request):
    def convert(x):
        bits = struct.unpack("<I", struct.pack("<f", x))[0]
        return struct.pack("<I", bits + 1)

    _floats(request, convert)


floats_one_ulp_off.declares = right_floats.declares


def integers_for_floats(_):
    """Declares f32, but writes .rlpd whatever the extension of OUT."""


integers_for_floats.declares = right_floats.declares
