#!/usr/bin/env python3
"""Installs a build into a temporary prefix, and uses it from outside: builds the programs of
consumer/ against it, with find_package(rlpc), and with pkg-config if it is installed, and runs
them on an animation of streams/inputs. Also checks that exactly what scripts/quickstart builds is
installed."""

import argparse
import array
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

CONSUMER = pathlib.Path(__file__).resolve().parent / "consumer"
CLIP = CONSUMER.parents[2] / "streams" / "inputs" / "elephant.obj"
ACCEPT = CONSUMER.parents[2] / "streams" / "v1.2" / "accept"
TEXTURED = ACCEPT / "ATT" / "ATT-0001a.rlpc"
WITH_ASSET = ACCEPT / "AST" / "AST-0001a.rlpc"
PC2_HEADER_BYTES = 32
QUICKSTART = CONSUMER.parents[1] / "quickstart"
TARGET = "installed_files"
PAGES = ("rlpcenc", "rlpcdec", "rlpcinfo", "rlpccmp", "rlpcval")
# The libraries in C.
LIBRARIES = ("rlpc", "rlpc_static", "rlpcdec", "rlpcdec_static")
# Program: its source, the module of pkg-config, the standard.
PROGRAMS = {
    "examples_c": ("examples.c", "rlpc", "c99"),
    "examples_cpp": ("examples.cpp", "rlpc-encoder", "c++20"),
    **{f"decode_c_{library}": ("decode.c", library, "c99") for library in LIBRARIES},
    **{f"decode_cpp11_{library}": ("decode_cpp11.cpp", library, "c++11") for library in LIBRARIES},
    "encode_c_rlpc": ("encode.c", "rlpc", "c99"),
    "encode_c_rlpc_static": ("encode.c", "rlpc_static", "c99"),
    "draw": ("draw.c", "rlpcdec", "c99"), "inspect": ("inspect.c", "rlpcdec", "c99"),
    "memory": ("memory.c", "rlpcdec", "c99"),
    "play": ("play.c", "rlpcdec", "c11"), "skin": ("skin.c", "rlpcdec", "c99"),
    "vertices": ("vertices.c", "rlpcdec", "c99"),
    "decode_cpp": ("decode.cpp", "rlpc-decoder", "c++20"),
    "encode_cpp": ("encode.cpp", "rlpc-encoder", "c++20")}


class Wrong(Exception):
    """The installed package does not do what it should."""


def run(*command, **kwargs):
    print("+", shlex.join(map(str, command)), flush=True)
    return subprocess.run(command, check=True, **kwargs)


def require(condition, complaint):
    if not condition:
        raise Wrong(complaint)


def check_quickstart(build):
    """After scripts/quickstart, which builds one target and no tests, `cmake --install` finds what
    it looks for."""
    require(f"--target {TARGET}\n" in QUICKSTART.read_text(encoding="utf-8"),
            f"scripts/quickstart does not build {TARGET}")
    script = (build / "cmake_install.cmake").read_text(encoding="utf-8")
    looked_for = set(re.findall(rf'"{re.escape(str(build))}/([^"$]+)"', script))

    def ninja(*words):
        return run("ninja", "-C", build, "-t", *words, stdout=subprocess.PIPE, text=True).stdout
    built = looked_for & {line.partition(":")[0] for line in ninja("targets", "all").splitlines()}
    require(len(built) > 2 * len(PAGES), f"only {sorted(built)} of the installed files are built")
    commands = ninja("commands", TARGET)
    missing = sorted(path for path in built if path not in commands)
    require(not missing, f"{TARGET} does not build {missing}")


class Clip:
    """The animation as the tools of the prefix see it, and as raw numbers."""

    def __init__(self, prefix, work):
        self.tools = prefix / "bin"
        self.stream = work / "clip.rlpc"
        cache = CLIP.with_suffix(".pc2")
        run(self.tools / "rlpcenc", CLIP, "--points", cache, "--kg", "0.2", "--preset", "fast",
            "-q", "-o", self.stream)
        run(self.tools / "rlpcdec", self.stream, "-q", "-o", work / "clip.pc2")
        self.decoded = (work / "clip.pc2").read_bytes()[PC2_HEADER_BYTES:]
        vertices, = array.array("i", cache.read_bytes()[16:20])
        frames, = array.array("i", cache.read_bytes()[28:32])
        self.shape = [str(vertices), str(frames)]
        self.triangles, self.frames = work / "triangles.u32", work / "frames.f32"
        faces = [line.split()[1:] for line in CLIP.read_text().splitlines()
                 if line.startswith("f ")]
        indices = array.array("I", [int(word.split("/")[0]) - 1 for face in faces for word in face])
        self.triangles.write_bytes(indices.tobytes())
        self.frames.write_bytes(cache.read_bytes()[PC2_HEADER_BYTES:])


def try_decoder(program, clip, work):
    """Its floats are those of rlpcdec, and it reports that an empty file is not a stream."""
    out = work / "decoded.f32"
    run(program, clip.stream, out)
    require(out.read_bytes() == clip.decoded, f"{program.name} and rlpcdec decode differently")
    empty = work / "empty.rlpc"
    empty.touch()
    print("+", program, empty, flush=True)
    code = subprocess.run([program, empty, out], check=False).returncode
    require(code == 1, f"{program.name}: exit code {code} for an empty file")


def try_decoders(folder, clip, work):
    for name in PROGRAMS:
        if name.startswith("decode_"):
            try_decoder(folder / name, clip, work)


def try_examples(folder, clip, work):
    shown = run(folder / "play", clip.stream, stdout=subprocess.PIPE, text=True).stdout
    require([line.split(":")[0] for line in shown.splitlines()]
            == ["forward", "backward", "back and forth"], f"play prints {shown}")
    shown = run(folder / "memory", clip.stream, stdout=subprocess.PIPE, text=True).stdout
    require(shown.endswith("; 0 bytes left\n"), f"memory prints {shown}")
    shown = run(folder / "skin", clip.stream, stdout=subprocess.PIPE, text=True).stdout
    require(re.match(r"a quarter after frame 0: .*\n"
                     r"frame 0: \d+ bones, skinning is off by up to \S+\n", shown),
            f"skin prints {shown}")
    out = work / "frame.bin"
    run(folder / "vertices", clip.stream, out, stdout=subprocess.DEVNULL)
    vertices = int(clip.shape[0])
    triangles = len(clip.triangles.read_bytes()) // 12
    require(out.stat().st_size == 6 * triangles + 10 * vertices, "vertices: the wrong size")
    told = run(folder / "inspect", TEXTURED, out, stdout=subprocess.PIPE, text=True).stdout
    require("\nuv0: " in told and "GOFs, the first with" in told, f"inspect prints {told}")
    run(folder / "inspect", WITH_ASSET, out, stdout=subprocess.DEVNULL)
    require(out.read_bytes().startswith(b"glTF"), "inspect writes no GLB")
    mesh = run(folder / "draw", TEXTURED, "0", stdout=subprocess.PIPE, text=True).stdout
    count = {word: len(re.findall(rf"^{word} ", mesh, re.MULTILINE))
             for word in ("v", "vn", "vt", "f")}
    require(count["v"] == count["vn"] == count["vt"] > 20 and count["f"] == 24,
            f"draw writes {count}")


def try_header_examples(folder, clip, work):
    """Runs the examples in the comments of the public headers."""
    shutil.copy(clip.stream, work / "dance.rlpc")
    run((folder / "examples_c").resolve(), "triangle.rlpc", cwd=work)
    run(clip.tools / "rlpcval", work / "triangle.rlpc")
    run((folder / "examples_cpp").resolve(), CLIP, CLIP.with_suffix(".pc2"), cwd=work)


def try_encoders(folder, clip, work):
    out = work / "encoded.rlpc"
    run(folder / "encode_cpp", CLIP, CLIP.with_suffix(".pc2"), out)
    require(out.read_bytes() == clip.stream.read_bytes(), "encode_cpp and rlpcenc differ")
    cut = work / "cut.f32"
    cut.write_bytes(clip.frames.read_bytes()[:-1])
    for program in (folder / "encode_c_rlpc", folder / "encode_c_rlpc_static"):
        run(program, *clip.shape, clip.triangles, clip.frames, out)
        run(clip.tools / "rlpcval", out)
        print("+", program, "too few frames", flush=True)
        code = subprocess.run([program, *clip.shape, clip.triangles, cut, out],
                              check=False).returncode
        require(code == 1, f"{program.name}: exit code {code} for too few frames")


def with_cmake(args, prefix, work):
    # The runtime of sanitizers comes with the C++ compiler.
    link = [f"-DCMAKE_C_LINK_EXECUTABLE={args.cxx} <FLAGS> <LINK_FLAGS> <OBJECTS> -o <TARGET> "
            "<LINK_LIBRARIES>"] if args.flags else []
    run(args.cmake, "-S", CONSUMER, "-B", work, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_C_COMPILER={args.cc}", f"-DCMAKE_CXX_COMPILER={args.cxx}",
        f"-DCMAKE_C_FLAGS={args.flags}", f"-DCMAKE_CXX_FLAGS={args.flags}", *link)
    run(args.cmake, "--build", work, "--parallel", "1")
    return work


def with_pkg_config(args, prefix, work):
    work.mkdir()
    folders = {str(path.parent) for path in prefix.rglob("rlpc*.pc")}
    environment = {**os.environ, "PKG_CONFIG_PATH": os.pathsep.join(folders)}
    flags = shlex.split(args.flags)
    for name, (source, module, standard) in PROGRAMS.items():
        module, _, static = module.partition("_")
        found = run("pkg-config", *(["--static"] if static else []), "--cflags", "--libs", module,
                    stdout=subprocess.PIPE, text=True, env=environment).stdout.split()
        folder = next(word[2:] for word in found if word.startswith("-L"))
        if static:  # the shared library is there too
            found = [f"{folder}/lib{module}.a" if word == f"-l{module}" else word
                     for word in found]
        compiler = args.cc if source.endswith(".c") else args.cxx
        run(compiler, f"-std={standard}", *flags, "-c", CONSUMER / source, "-o",
            work / f"{name}.o", *[word for word in found if word.startswith(("-I", "-D"))])
        linker = args.cc if source.endswith(".c") and not flags else args.cxx
        run(linker, *flags, work / f"{name}.o", "-o", work / name, f"-Wl,-rpath,{folder}",
            *[word for word in found if not word.startswith(("-I", "-D"))])
    return work


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path, help="a finished build directory")
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("--cc", default="gcc")
    parser.add_argument("--cxx", default="g++")
    parser.add_argument("--flags", default="", help="the C++ flags of the build")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        try:
            if (args.build / "build.ninja").exists():
                check_quickstart(args.build.resolve())
            run(args.cmake, "--install", args.build, "--prefix", work / "installed",
                stdout=subprocess.DEVNULL)
            # The package must not depend on the place it was installed to.
            prefix = (work / "installed").rename(work / "moved")
            clip = Clip(prefix, work)
            programs = with_cmake(args, prefix, work / "cmake")
            try_decoders(programs, clip, work)
            try_encoders(programs, clip, work)
            try_examples(programs, clip, work)
            try_header_examples(programs, clip, work)
            if shutil.which("pkg-config"):
                try_decoders(with_pkg_config(args, prefix, work / "pkg-config"), clip, work)
            else:
                print("pkg-config is not installed: its files were not tested")
            pages = {path.name for path in (prefix / "share" / "man" / "man1").iterdir()}
            require(pages == {f"{page}.1" for page in PAGES}, f"manual pages: {sorted(pages)}")
        except (subprocess.CalledProcessError, Wrong) as error:
            print(f"install: {error}")
            return 1
    print("install: the installed package can be used")
    return 0


if __name__ == "__main__":
    sys.exit(main())
