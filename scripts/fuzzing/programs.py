#!/usr/bin/env python3
"""Random and mutated inputs with random options through whole programs.

A case is a seed. Of each, rlpcenc encodes an input of any format, in most cases after a
mutation of its bytes, its numbers or its JSON; what it writes goes through rlpcval, rlpcdec,
rlpcinfo and rlpccmp, then again after a mutation. Whatever the input, a program must end by
itself with an exit code that its help page lists, without a report of a sanitizer, and leave
nothing but complete files; what rlpcenc writes must conform, decode, and keep its promise.

    scripts/fuzzing/programs.py --bin FOLDER [--first SEED] [--cases N | --minutes M]
"""

import argparse
import json
import os
import pathlib
import random
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import time

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
if __name__ == "__main__":
    sys.path.insert(0, str(ROOT / "scripts" / "fuzzing"))
import seeds  # after the path to it

CODES = {"rlpcenc": {0, 1, 2, 64}, "rlpcdec": {0, 1, 2, 3, 4, 64}, "rlpcinfo": {0, 1, 2, 3, 4, 64},
         "rlpcval": {0, 1, 2, 3, 64}, "rlpccmp": {0, 1, 2, 64}}
WRITTEN = {"rlpcenc": {0, 2}}
# Exit code of a sanitizer, which no program uses.
SANITIZER_CODE = 77
SECONDS = 300
FILE_BYTES = 1 << 30
REPORTS = ("Sanitizer", "runtime error:", "Assertion", "terminate called")
ODD_NUMBERS = ["0", "-0", "1", "-1", "nan", "inf", "-inf", "1e308", "-1e308", "1e-308", "1e39",
               "3.4028235e38", "2147483647", "-2147483648", "4294967296", "9223372036854775808",
               "1e", ".", "0x10", "999999999999999999999999", "0.1", "1e-46", "16777217"]
ODD_JSON = [None, True, -1, 0, 1, 1e300, 4294967296, 5121, 5126, 5125, "", "POSITION", "é\u0000",
            [], {}, [[]], [0], [1e39, 0, 0], {"index": 0}, "data:,", "../secret.png"]
MESHES = ["obj", "ply", "off"]
ENDINGS = ["rlpd", "obj", "ply", "pc2", "mdd", "glb"]


class Wrong(Exception):
    """Misbehaviour of a program; the text is for the user."""


# Inputs ---------------------------------------------------------------------------------------

def some_mesh(numbers):
    """Points and triangles: a tube, a grid, a single triangle or a soup."""
    shape = numbers.randrange(5)
    if shape == 0:
        return seeds.tube(numbers.randrange(2, 14), numbers.random() < 0.5)
    if shape == 1:
        return [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(0, 1, 2)]
    columns, rows = numbers.randrange(2, 9), numbers.randrange(2, 9)
    points = [(float(x), float(y), 0.3 * (x * y % 3)) for y in range(rows) for x in range(columns)]
    triangles = []
    for y in range(rows - 1):
        for x in range(columns - 1):
            a = y * columns + x
            triangles += [(a, a + 1, a + columns), (a + 1, a + columns + 1, a + columns)]
    if shape == 2:
        triangles = [tuple(numbers.randrange(len(points)) for _ in range(3)) for _ in triangles]
    return points, triangles


def some_motion(numbers, points, num_frames):
    """Frames: rigid, bent, noisy, static or far from the origin."""
    kind = numbers.randrange(5)
    offset = (1e6, -2e5, 3e4) if numbers.random() < 0.15 else (0.0, 0.0, 0.0)
    frames = []
    for f in range(num_frames):
        if kind == 0:
            frame = [(x + 0.25 * f, y, z - 0.5 * f) for x, y, z in points]
        elif kind == 1:
            frame = seeds.moved(points, f)
        elif kind == 2:
            frame = [tuple(c + numbers.uniform(-0.2, 0.2) for c in p) for p in points]
        elif kind == 3:
            frame = points
        else:
            frame = [tuple(c * (1 + 0.05 * f) for c in p) for p in points]
        frames.append([tuple(c + o for c, o in zip(p, offset)) for p in frame])
    return frames


def mesh_bytes(numbers, form, points, triangles):
    if form == "obj":
        return seeds.obj_text(points, triangles)
    return numbers.choice(list(seeds.mesh_files(form, points, triangles)))


def pc2_of(frames):
    head = b"POINTCACHE2\0" + struct.pack("<iiffi", 1, len(frames[0]), 0, 1, len(frames))
    return head + b"".join(struct.pack("<3f", *p) for frame in frames for p in frame)


def mdd_of(frames):
    head = struct.pack(">ii", len(frames), len(frames[0]))
    head += b"".join(struct.pack(">f", f / 24) for f in range(len(frames)))
    return head + b"".join(struct.pack(">3f", *p) for frame in frames for p in frame)


def some_input(numbers, folder):
    """Writes an input; its command line, and the files that may be mutated."""
    kind = numbers.choice(["cache", "cache", "folder", "glb", "gltf", "rlpd"])
    points, triangles = some_mesh(numbers)
    frames = some_motion(numbers, points, numbers.choice([1, 2, 3, 7, 12, 20]))
    form = numbers.choice(MESHES)
    if kind == "folder":
        paths = []
        (folder / "frames").mkdir()
        for f, frame in enumerate(frames):
            paths.append(folder / "frames" / f"f.{f:03}.{form}")
            paths[-1].write_bytes(mesh_bytes(numbers, form, frame, triangles))
        return [folder / "frames"], paths
    if kind == "cache":
        ending = numbers.choice(["pc2", "mdd"])
        mesh, cache = folder / f"m.{form}", folder / f"m.{ending}"
        mesh.write_bytes(mesh_bytes(numbers, form, points, triangles))
        cache.write_bytes(pc2_of(frames) if ending == "pc2" else mdd_of(frames))
        return [mesh, "--points", cache], [mesh, cache]
    if kind == "rlpd":
        path = folder / "a.rlpd"
        path.write_bytes(seeds.rlpd_bytes(points, triangles, len(frames)))
        return [path], [path]
    glb = [s[1:] for s in seeds.gltf_seeds(ROOT)][::3]
    binary = kind == "glb"
    path = folder / f"a.{kind}"
    path.write_bytes(numbers.choice([b for b in glb if (b[:4] == b"glTF") == binary] or glb))
    chosen = numbers.choice([[], ["--animation", "all"], ["--animation", "0"]])
    return [path, *chosen], [path]


# Mutations ------------------------------------------------------------------------------------

def mutate_bytes(numbers, data):
    data = bytearray(data)
    for _ in range(numbers.choice([1, 1, 2, 8])):
        at = numbers.randrange(len(data) + 1)
        size = numbers.choice([1, 2, 4, 64])
        action = numbers.randrange(6)
        if action == 0:
            del data[at:]
        elif action == 1:
            del data[at:at + size]
        elif action == 2:
            data[at:at] = data[at:at + size * 4]
        elif action == 3:
            data[at:at + size] = bytes(numbers.choice([0, 255, 127, 128]) for _ in range(size))
        else:
            data[at:at + 1] = bytes([numbers.randrange(256)])
    return bytes(data)


def mutate_words(numbers, data):
    """Numbers of a text replaced, words doubled, lines left out."""
    lines = data.decode("latin-1").split("\n")
    for _ in range(numbers.choice([1, 1, 3, 10])):
        at = numbers.randrange(len(lines))
        words = lines[at].split(" ")
        action = numbers.randrange(5)
        if action == 0:
            lines[at] = ""
        elif action == 1:
            lines.insert(at, lines[numbers.randrange(len(lines))])
        elif action == 2:
            lines[at] += " " + numbers.choice(ODD_NUMBERS)
        else:
            words[numbers.randrange(len(words))] = numbers.choice(ODD_NUMBERS)
            lines[at] = " ".join(words)
    return "\n".join(lines).encode("latin-1", errors="replace")


def members(node, found):
    """(container, key) of everything in a JSON tree."""
    for key in (list(node) if isinstance(node, dict) else range(len(node))):
        found.append((node, key))
        if isinstance(node[key], (dict, list)):
            members(node[key], found)
    return found


def mutate_tree(numbers, tree):
    for _ in range(numbers.choice([1, 1, 2, 5])):
        node, key = numbers.choice(members(tree, []))
        action = numbers.randrange(5)
        if action == 0:
            del node[key]
        elif action == 1 and isinstance(node[key], int):
            node[key] = max(0, node[key] + numbers.choice([-1, 1, 2, 1000]))
        elif action == 2:
            other, name = numbers.choice(members(tree, []))
            node[key] = json.loads(json.dumps(other[name]))
        elif action == 3 and isinstance(node, dict):
            node["extras"] = json.loads("[" * 40 + "]" * 40)
        else:
            node[key] = numbers.choice(ODD_JSON)
        if not members(tree, []):
            return


def mutate_gltf(numbers, data):
    binary = data[:4] == b"glTF"
    size = struct.unpack_from("<I", data, 12)[0] if binary else len(data)
    tree = json.loads(data[20:20 + size] if binary else data)
    mutate_tree(numbers, tree)
    text = json.dumps(tree).encode()
    if not binary:
        return text
    text += b" " * (-len(text) % 4)
    rest = data[20 + size:]
    return (struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A)
            + text + rest)


def mutate_file(numbers, path):
    data = path.read_bytes()
    is_text = path.suffix in (".obj", ".off") or (path.suffix == ".ply" and b"ascii" in data[:20])
    if path.suffix in (".glb", ".gltf") and numbers.random() < 0.8:
        try:
            data = mutate_gltf(numbers, data)
        except (ValueError, struct.error):  # a mutation before this one left no document
            data = mutate_bytes(numbers, data)
    elif is_text and numbers.random() < 0.7:
        data = mutate_words(numbers, data)
    else:
        data = mutate_bytes(numbers, data)
    path.write_bytes(data)


# Options --------------------------------------------------------------------------------------

TARGETS = [["--kg", "0.01"], ["--kg", "0.1"], ["--kg", "3"], ["--bpvf", "0.5"], ["--bpvf", "20"],
           ["--max-error", "0.01"], ["--max-error", "1"], ["--max-error", "1e-9"], ["--lossless"],
           ["--lossless", "6"], ["--quality", "good"], ["--quality", "preview"], [],
           ["--kg", "nan"], ["--bpvf", "0"], ["--max-error", "-1"]]
MORE = [["--gof", "all"], ["--gof", "1"], ["--gof", "5"], ["--gof", "0"], ["--keep-order"],
        ["--hash", "frame"], ["--hash", "none"], ["--threads", "3"], ["--no-attributes"],
        ["--no-textures"], ["--clusters", "3"], ["--gof-kind", "inter"], ["--gof-kind", "skinned"],
        ["--bones", "2"], ["--influences", "1"], ["--patches", "2"], ["--patches", "0"],
        ["--frame-pattern", "dyadic:4"], ["--frame-pattern", "first"], ["--prediction", "layers"],
        ["--no-clusters"], ["--temporal-layers", "3"], ["--component-groups", "2"],
        ["--layer-groups", "3"], ["--seeds", "spread"], ["--frame", "world"], ["--no-rdo"],
        ["--fps", "24"], ["--fps", "1/0"], ["--axes", "x,z,-y"], ["--axes", "x,x,y"],
        ["--max-memory", "20MB"], ["--max-memory", "1kB"], ["--clip", "a:0-1"], ["--clip", ":"],
        ["--uv-bits", "4"], ["--stored-normals", "smoothing"],
        ["--normals", "2"], ["--exact-attributes"], ["--json"],
        ["--low-delay"], ["--low-delay", "--box", "-2", "-2", "-2", "9", "9", "9"],
        ["--qu", "8", "--qc", "8"], ["--dry-run"], ["--track-levels", "2"], ["--no-weld"],
        ["--no-input-rig"]]


def some_options(numbers):
    options = list(numbers.choice(TARGETS))
    options += ["--profile", numbers.choice(["baseline", "main", "main", "high", "high"])]
    options += ["--preset", numbers.choice(["fast", "fast", "medium"])]
    for extra in numbers.sample(MORE, numbers.choice([0, 0, 1, 1, 2, 4])):
        options += extra
    return options


# Programs -------------------------------------------------------------------------------------

def environment():
    common = f"exitcode={SANITIZER_CODE}:"
    return {**os.environ, "UBSAN_OPTIONS": common + "print_stacktrace=1",
            "ASAN_OPTIONS": common + "detect_stack_use_after_return=1:strict_string_checks=1:"
                                     "hard_rss_limit_mb=6000:allocator_may_return_null=1"}


def limit_files():
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_BYTES, FILE_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


class Programs:
    """Runs programs in a folder, and checks how they end."""

    def __init__(self, binaries, folder):
        self.binaries = binaries
        self.folder = folder
        self.lines = []

    def run(self, name, *arguments, output=None):
        words = [str(word) for word in arguments]
        self.lines.append(" ".join([name, *words]))
        try:
            done = subprocess.run([self.binaries / name, *words], cwd=self.folder, timeout=SECONDS,
                                  stdin=subprocess.DEVNULL, capture_output=True,
                                  env=environment(), preexec_fn=limit_files, check=False)
        except subprocess.TimeoutExpired as expired:
            raise Wrong(f"{name} did not end in {SECONDS} s") from expired
        text = done.stderr.decode(errors="replace")
        if done.returncode not in CODES[name] or any(report in text for report in REPORTS):
            raise Wrong(f"{name} ended with {done.returncode}:\n{text[-3000:]}")
        if done.returncode not in WRITTEN.get(name, {0}) and not text.strip():
            if not (name == "rlpcval" or done.returncode == 0):
                raise Wrong(f"{name} ended with {done.returncode} without a word")
        self._check_files(name, done.returncode, output)
        return done

    def _check_files(self, name, code, output):
        left = [p.name for p in self.folder.rglob("*") if p.name.endswith(".partial")]
        if left:
            raise Wrong(f"{name} left {', '.join(left)}")
        if output is not None and output.exists() and code not in WRITTEN.get(name, {0}):
            raise Wrong(f"{name} ended with {code} and left {output.name}")


def promised(options):
    """The arguments with which rlpccmp checks what the options promise."""
    for name, check in (("--max-error", "--max-error"), ("--lossless", "--max-error")):
        if name in options:
            return [check, options[options.index(name) + 1] if name == check else "0"]
    return None


def check_stream(programs, numbers, source, options, stream, missed):
    """missed: whether rlpcenc said that it did not reach its target."""
    if programs.run("rlpcval", stream).returncode != 0:
        raise Wrong("rlpcval finds errors in what rlpcenc wrote")
    decoded = programs.folder / f"d.{numbers.choice(ENDINGS)}"
    programs.run("rlpcdec", stream, "-o", decoded, output=decoded)
    if programs.run("rlpcdec", stream, "--verify").returncode != 0:
        raise Wrong("rlpcdec cannot decode what rlpcenc wrote")
    programs.run("rlpcinfo", stream, *numbers.choice([[], ["--json"], ["--gofs"]]))
    if "--low-delay" in options or "--axes" in options or "--fps" in options:
        return
    names = {"--points": "--points-a", "--animation": "--animation-a"}
    command = [names.get(word, word) for word in source]
    if "--no-weld" in options:
        command.append("--no-weld-a")
    bound = None if missed else promised(options)
    grid = "--lossless" in options and options[options.index("--lossless") + 1].isdigit()
    gate = bound if bound is not None and not grid else []
    compared = programs.run("rlpccmp", *command, stream, "--order-map", "order", "--json", *gate)
    if compared.returncode != 0:
        raise Wrong(f"rlpccmp ended with {compared.returncode} on what rlpcenc wrote:\n"
                    + compared.stderr.decode(errors="replace")[-2000:])


def run_case(binaries, seed, folder):
    """Raises Wrong, with the commands in `folder`/commands."""
    numbers = random.Random(seed)
    programs = Programs(binaries, folder)
    try:
        source, files = some_input(numbers, folder)
        options = some_options(numbers)
        for _ in range(numbers.choice([0, 0, 1, 1, 2])):
            mutate_file(numbers, numbers.choice(files))
        stream = folder / "s.rlpc"
        done = programs.run("rlpcenc", *source, "-o", stream, "--order-map", "order", *options,
                            output=stream)
        if stream.exists():
            check_stream(programs, numbers, source, options, stream, done.returncode == 2)
            mutated = folder / "m.rlpc"
            mutated.write_bytes(mutate_bytes(numbers, stream.read_bytes()))
            name = numbers.choice(["rlpcdec", "rlpcinfo", "rlpcval", "rlpccmp"])
            last = {"rlpcdec": ["-o", "x.glb"], "rlpccmp": [stream]}.get(name, [])
            programs.run(name, mutated, *last)
        elif numbers.random() < 0.3:
            programs.run("rlpccmp", *files[:1], *files[:1])
    finally:
        (folder / "commands").write_text("\n".join(programs.lines) + "\n")


def run(binaries, first, count, seconds, findings):
    """Runs cases until one of the limits; keeps the folder of each that fails in `findings`.

    Returns the number of cases and the (seed, text) of those that failed."""
    start, failed, done = time.monotonic(), [], 0
    while done < count and (seconds is None or time.monotonic() - start < seconds):
        seed = first + done
        folder = pathlib.Path(tempfile.mkdtemp(prefix="rlpc-programs-"))
        try:
            run_case(binaries, seed, folder)
        except Wrong as wrong:
            failed.append((seed, str(wrong)))
            kept = findings / f"programs-{seed}"
            shutil.rmtree(kept, ignore_errors=True)
            findings.mkdir(parents=True, exist_ok=True)
            shutil.copytree(folder, kept)
        finally:
            shutil.rmtree(folder, ignore_errors=True)
        done += 1
    return done, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True, metavar="FOLDER")
    parser.add_argument("--first", type=int, default=0, metavar="SEED")
    parser.add_argument("--cases", type=int, default=1 << 40, metavar="N")
    parser.add_argument("--minutes", type=float, metavar="M")
    parser.add_argument("--findings", type=pathlib.Path, metavar="FOLDER",
                        default=ROOT / "build" / "fuzz-findings")
    options = parser.parse_args()
    if options.cases == 1 << 40 and options.minutes is None:
        parser.error("--cases or --minutes is needed")
    seconds = None if options.minutes is None else 60 * options.minutes
    done, failed = run(options.bin.resolve(), options.first, options.cases, seconds,
                       options.findings)
    for seed, text in failed:
        print(f"case {seed}: {text}\n  files and commands: {options.findings}/programs-{seed}")
    print(f"{done} cases, {len(failed)} failed")
    return 1 if failed or done == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
