"""Workload of every build: encodings, decodings, and the released streams."""

import concurrent.futures
import hashlib
import json
import os
import shutil
import struct
import subprocess

TIMEOUT_SECONDS = 1800
PC2_HEADER_BYTES = 32

# Settings that take different paths through the encoder, by profile.
SETTINGS = {
    "baseline": [
        "--kg 0.3",
        "--kg 1 --preset fast --gof 10 --keep-order --hash frame",
        "--max-error 0.01 --frame world --gof 20",
        "--bpvf 3 --seeds triangle",
        "--gof all --clusters 8 --components 6 --qu 12 --qc 12 --qdelta 12 --frame lcf",
        "--gof all --clusters 5 --components 4 --qu 10 --qc 11 --no-rdo --frame lcf --seeds spread",
        "--kg 1 --preset fast --gof 20 --partition kway",
        "--kg 1 --gof 20 --partition lloyd --clusters 6 --seeds triangle",
        "--kg 1 --preset fast --gof 20 --partition spectral",
        "--kg 1 --preset fast --gof 20 --partition motion",
    ],
    "main": [
        "--kg 0.3",
        "--kg 0.1 --preset fast --bones 4 --gof 5 --keep-order --hash frame",
        "--max-error 0.01 --preset fast --bones 6 --components 5",
    ],
}
# Settings for glTF documents, to compare how they are evaluated.
GLTF = "--animation all --kg 0.5 --preset fast --bones 4"
# The decoded frames of the first setting are also written as floats, and encoded again.
AGAIN = "--profile baseline --kg 1 --preset fast"


class RunFailed(Exception):
    """A program failed or took too long."""


def cut_animations(pairs, frames, folder):
    """Writes the first frames of each animation (0: all) to the folder; returns the meshes."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    meshes = []
    for mesh, cache in pairs:
        data = cache.read_bytes()
        if len(data) < PC2_HEADER_BYTES or not data.startswith(b"POINTCACHE2\0"):
            raise RunFailed(f"{cache}: not a PC2 point cache")
        points, = struct.unpack_from("<i", data, 16)
        samples, = struct.unpack_from("<i", data, 28)
        kept = min(samples, frames or samples)
        cut = folder / f"{len(meshes)}-{cache.stem}.pc2"
        cut.write_bytes(data[:28] + struct.pack("<i", kept)
                        + data[PC2_HEADER_BYTES:PC2_HEADER_BYTES + 12 * points * kept])
        meshes.append(cut.with_suffix(".obj"))
        shutil.copy(mesh, meshes[-1])
    return meshes


def released_streams(root):
    """Paths of the released streams, without those that only stress a decoder."""
    paths = []
    for suite in sorted((root / "streams").glob("v*/SUITE.json")):
        paths += [suite.parent / stream["path"]
                  for stream in json.loads(suite.read_text())["streams"]
                  if stream.get("tier") != "stress"]
    return paths


def digest_of(paths):
    whole = hashlib.sha256()
    for path in paths:
        whole.update(hashlib.sha256(path.read_bytes()).digest() if path.exists() else b"none")
    return whole.hexdigest()


class Workload:
    """The work of one build; results are digests by job, in four groups."""

    GROUPS = ["streams", "integers", "floats", "suite"]

    def __init__(self, root, meshes, suite, progress):
        """meshes: by profile. Documents are those of streams/inputs."""
        self.root = root
        self.meshes = meshes
        self.suite = suite
        self.progress = progress

    def run(self, emulator, bin_folder, work):
        """{group: {job: digest}}"""
        shutil.rmtree(work, ignore_errors=True)
        work.mkdir(parents=True)
        tools = {name: [*emulator, bin_folder / name] for name in ("rlpcenc", "rlpcdec")}
        jobs = [(self._encode, (profile, mesh), i) for profile, settings in SETTINGS.items()
                for mesh in self.meshes[profile] for i in range(len(settings))]
        documents = sorted((self.root / "streams" / "inputs").glob("*.glb"))
        jobs += [(self._encode_gltf, path, 0) for path in documents]
        jobs += [(self._decode_released, path, 0) for path in self.suite]
        results = {group: {} for group in self.GROUPS}
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            futures = [pool.submit(job, tools, work, what, i) for job, what, i in jobs]
            try:
                for done, future in enumerate(futures):
                    self.progress(f"{done} of {len(jobs)} jobs done")
                    for group, job, digest in future.result():
                        results[group][job] = digest
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise
        return results

    def _encode(self, tools, work, what, i):
        profile, mesh = what
        setting = f"--profile {profile} {SETTINGS[profile][i]}"
        job = f"{mesh.stem} {setting}"
        base = work / f"{mesh.stem}-{profile}-{i}"
        stream, integers = base.with_suffix(".rlpc"), base.with_suffix(".rlpd")
        met = self._call([*tools["rlpcenc"], mesh, "--points", mesh.with_suffix(".pc2"),
                          "-o", stream, "-q", *setting.split()], (0, 2))
        self._call([*tools["rlpcdec"], stream, "-o", integers, "-q"], (0,))
        results = [("streams", job, f"{met} {digest_of([stream])}"),
                   ("integers", job, digest_of([integers]))]
        if i == 0:
            floats, again = base.with_suffix(".pc2"), work / f"{base.name}-again.rlpc"
            self._call([*tools["rlpcdec"], stream, "-o", floats, "-q"], (0,))
            self._call([*tools["rlpcenc"], integers, "-o", again, "-q", *AGAIN.split()], (0, 2))
            results += [("floats", job, digest_of([floats, floats.with_suffix(".obj")])),
                        ("streams", f"{job}, decoded, {AGAIN}", digest_of([again]))]
        return results

    def _encode_gltf(self, tools, work, path, _):
        stream = work / f"{path.stem}-gltf.rlpc"
        met = self._call([*tools["rlpcenc"], path, "-o", stream, "-q", *GLTF.split()], (0, 2))
        return [("streams", f"{path.stem} {GLTF}", f"{met} {digest_of([stream])}")]

    def _decode_released(self, tools, work, path, _):
        job = str(path.relative_to(self.root / "streams"))
        out = work / (job.replace("/", "-") + ".rlpd")
        code, verdict = self._call([*tools["rlpcdec"], "decode", path, out], (0, 1, 2, 3), True)
        return [("suite", job, f"{code} {verdict} {digest_of([out])}")]

    def _call(self, command, codes, with_verdict=False):
        """The exit code, and if asked for, the last line of standard error."""
        try:
            done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  stdin=subprocess.DEVNULL, timeout=TIMEOUT_SECONDS)
        except subprocess.TimeoutExpired as error:
            raise RunFailed(f"more than {TIMEOUT_SECONDS} s: {shown(command)}") from error
        text = done.stderr.decode(errors="replace").strip()
        if done.returncode not in codes:
            raise RunFailed(f"exit code {done.returncode}: {shown(command)}\n{text[-2000:]}")
        last = text.splitlines()[-1] if text else ""
        return (done.returncode, last) if with_verdict else done.returncode


def shown(command):
    return " ".join(str(word) for word in command)
