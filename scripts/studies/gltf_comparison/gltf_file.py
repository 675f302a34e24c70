"""glTF files as far as the comparison needs to know them: their document, their clips, and
.gltf files as .glb."""

import array
import base64
import dataclasses
import json
import math
import struct
import sys
import urllib.parse

import measure

FPS = 30


@dataclasses.dataclass(frozen=True)
class Clip:
    num_frames: int
    first_frame: int  # in all clips joined


def _chunks(path):
    """(JSON document, binary chunk) of a .glb file."""
    data = path.read_bytes()
    if data[:4] != b"glTF" or len(data) < 20:
        raise measure.Failure(f"{path}: not a .glb file")
    size, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + size]), data[28 + size:]


def _bytes_of_uri(path, uri):
    if uri.startswith("data:"):
        head, _, body = uri.partition(",")
        return base64.b64decode(body) if head.endswith(";base64") else \
            urllib.parse.unquote_to_bytes(body)
    return (path.parent / urllib.parse.unquote(uri)).read_bytes()


def read(path):
    """(document, bytes of its only buffer), of .glb and .gltf files."""
    if path.suffix.lower() == ".glb":
        return _chunks(path)
    document = json.loads(path.read_text(encoding="utf-8"))
    buffers = document.get("buffers", [])
    if len(buffers) != 1:
        raise measure.Failure(f"{path}: has {len(buffers)} buffers; only files with one are read")
    return document, _bytes_of_uri(path, buffers[0]["uri"])


def write_glb(path, document, binary):
    """Writes the file with images of URIs kept as they are."""
    binary += b"\0" * (-len(binary) % 4)
    document = {**document, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    path.write_bytes(b"".join((
        b"glTF", struct.pack("<II", 2, 28 + len(text) + len(binary)),
        struct.pack("<I", len(text)), b"JSON", text,
        struct.pack("<I", len(binary)), b"BIN\0", binary)))


def as_glb(path, folder):
    """A .glb file of the same content: `path` itself if it is one."""
    if path.suffix.lower() == ".glb":
        return path
    target = folder / f"{path.stem}-source.glb"
    write_glb(target, *read(path))
    return target


def source_bytes(path):
    """Bytes of the file, and of the files that it names."""
    size = path.stat().st_size
    if path.suffix.lower() == ".gltf":
        document = json.loads(path.read_text(encoding="utf-8"))
        for part in (*document.get("buffers", []), *document.get("images", [])):
            uri = part.get("uri", "data:")
            if not uri.startswith("data:"):
                size += (path.parent / urllib.parse.unquote(uri)).stat().st_size
    return size


def _floats(document, binary, accessor):
    view = document["bufferViews"][accessor["bufferView"]]
    first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    values = array.array("f", binary[first:first + 4 * accessor["count"]])
    if sys.byteorder == "big":
        values.byteswap()
    return values


def _on_grid(seconds, fps, milliseconds=False):
    frames = seconds * fps
    off = abs(frames - round(frames))
    return (off <= min(1e-3 + frames * 2 ** -23, 0.02)
            or milliseconds and off <= 0.00051 * fps)


def clips(path):
    """The clips as rlpcenc --fps samples them: from time 0 of each to its last key."""
    document, binary = read(path)
    keys = []
    for animation in document.get("animations", []):
        used = {channel["sampler"] for channel in animation["channels"]}
        keys.append([t for s in used for t in _floats(
            document, binary, document["accessors"][animation["samplers"][s]["input"]])])
    times = [t for clip_times in keys for t in clip_times]
    milliseconds = all(_on_grid(t, 1000) and _on_grid(t, FPS, True) for t in times)
    found, first = [], 0
    for clip_times in keys:
        end = max(clip_times)
        last = (round if _on_grid(end, FPS, milliseconds) else math.ceil)(end * FPS)
        found.append(Clip(max(last, 1) + 1 if end > 0 else 1, first))
        first += found[-1].num_frames
    return found or [Clip(1, 0)]


def frame_samples(found, wanted):
    """`wanted` frames, spread over all clips, as (clip, frame of the clip); the first frame first,
    the one in the middle second."""
    total = sum(clip.num_frames for clip in found)
    spread = [round(i * (total - 1) / (wanted - 1)) for i in range(wanted)]
    frames = list(dict.fromkeys([0, total // 2, *spread]))
    samples = []
    for frame in frames:
        number = max(n for n, clip in enumerate(found) if clip.first_frame <= frame)
        samples.append((number, frame - found[number].first_frame))
    return samples
