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
    """With images of URIs kept as they are."""
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
    """Of the file, and of the files that it names."""
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


def clips(path):
    """The clips as rlpcenc samples them: from the first key of each to the last whole step."""
    document, binary = read(path)
    found, first = [], 0
    for animation in document.get("animations", []):
        used = {channel["sampler"] for channel in animation["channels"]}
        keys = [_floats(document, binary, document["accessors"][animation["samplers"][s]["input"]])
                for s in used]
        seconds = max(k[-1] for k in keys) - min(k[0] for k in keys)
        count = math.floor(seconds * FPS * (1 + 2 ** -24) + 1e-3) + 1
        found.append(Clip(count, first))
        first += count
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
