"""What the tests of the player have in common."""

import argparse
import hashlib
import json
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import textured_box

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[2]
STREAMS = ROOT / "streams"
PLAYER = ROOT / "build" / "player" / "player.html"
PACKAGE = ROOT / "build" / "player" / "package"
MODULES = ROOT / "build" / "player" / "page" / "node_modules"
RLPD_HEADER = struct.Struct("<4sIIIIIIi3i")
PC2_HEADER = struct.Struct("<12siiffi")
ELEPHANT = STREAMS / "inputs" / "elephant"


class Tools:
    folder = ROOT / "build" / "release" / "bin"  # --bin


def run(tool, *arguments, **options):
    return subprocess.run([Tools.folder / tool, *map(str, arguments)], capture_output=True,
                          timeout=120, check=False, **options)


def need_player():
    if not PLAYER.exists() or not (PACKAGE / "src" / "rlpc.wasm").exists():
        raise unittest.SkipTest("the player is not built: scripts/player")


def need_node():
    if not shutil.which("node"):
        raise unittest.SkipTest("no node here: scripts/setup --player")


class Decoded:
    """What rlpcdec makes of a stream: frames, CRCs, and its verdict, with our names."""

    def __init__(self, stream, folder):
        self.stream = stream
        out = folder / "native.rlpd"
        out.unlink(missing_ok=True)
        done = run("rlpcdec", "decode", stream, out)
        verdict = re.search(r"^rlpc-verdict (.*)$", done.stderr.decode(), re.MULTILINE)
        self.code = done.returncode
        told = json.loads(verdict[1]) if verdict else {}
        self.verdict = {ours: told[theirs] for ours, theirs in
                        (("rule", "rule"), ("bitOffset", "bit"))
                        if theirs in told}
        data = out.read_bytes() if out.exists() else b""
        self.triangles, positions, self.crcs = b"", b"", []
        if data:
            _, _, vertices, triangles, *_ = RLPD_HEADER.unpack_from(data)
            end = RLPD_HEADER.size + 12 * triangles
            self.triangles, positions = data[RLPD_HEADER.size:end], data[end:]
            size = 12 * vertices
            self.crcs = [zlib.crc32(positions[at:at + size])
                         for at in range(0, len(positions), size)]
        self.positions = hashlib.sha256(positions).hexdigest()

    def floats(self, folder):
        """The hash of all positions as floats."""
        return hashlib.sha256(b"".join(float_frames(self.stream, folder))).hexdigest()


def float_frames(stream, folder):
    """Positions of each frame, 32-bit floats."""
    out = folder / "native.pc2"
    done = run("rlpcdec", "-q", stream, "-o", out)
    if done.returncode != 0:
        raise AssertionError(done.stderr.decode())
    data = out.read_bytes()
    _, _, vertices, _, _, frames = PC2_HEADER.unpack_from(data)
    size = 12 * vertices
    return [data[PC2_HEADER.size + size * f:PC2_HEADER.size + size * (f + 1)]
            for f in range(frames)]


class InFolder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    @classmethod
    def encode(cls, name, *arguments):
        stream = cls.folder / name
        done = run("rlpcenc", "-q", f"{ELEPHANT}.obj", "--points", f"{ELEPHANT}.pc2", "--preset",
                   "fast", "-o", stream, *arguments)
        if done.returncode != 0:
            raise AssertionError(done.stderr.decode())
        return stream

    @classmethod
    def encode_box(cls, name, *look, **more):
        """The box of textured_box.py, as name.glb and name.rlpc; the path of the latter."""
        return cls.encode_glb(name, textured_box.box(*look, **more))

    @classmethod
    def encode_glb(cls, name, data):
        """A GLB as name.glb and name.rlpc; the path of the latter."""
        glb = cls.folder / f"{name}.glb"
        glb.write_bytes(data)
        stream = glb.with_suffix(".rlpc")
        done = run("rlpcenc", "-q", glb, "-o", stream, "--preset", "fast")
        if done.returncode != 0:
            raise AssertionError(done.stderr.decode())
        return stream


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=pathlib.Path, default=Tools.folder)
    options, rest = parser.parse_known_args()
    Tools.folder = options.bin.resolve()
    program = unittest.main(argv=[sys.argv[0], *rest], exit=False)
    result = program.result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.skipped:
        for _, reason in result.skipped:
            print(f"skipped: {reason}")
        sys.exit(77)
