#!/usr/bin/env python3
"""Installs a build into a temporary prefix and builds consumer/ against it, from outside:
with find_package(rlpc), and with pkg-config where there is one."""

import argparse
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

CONSUMER = pathlib.Path(__file__).resolve().parent / "consumer"


def run(*command, **kwargs):
    print("+", shlex.join(map(str, command)), flush=True)
    return subprocess.run(command, check=True, **kwargs)


def try_consumer(program):
    """It runs, and finds that an empty file is no stream."""
    empty = program.parent / "empty.rlpc"
    empty.touch()
    print("+", program, empty, flush=True)
    code = subprocess.run([program, empty], check=False).returncode
    if code != 1:
        raise subprocess.CalledProcessError(code, [program, empty])


def with_cmake(args, prefix, work):
    run(args.cmake, "-S", CONSUMER, "-B", work, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_CXX_COMPILER={args.cxx}", f"-DCMAKE_CXX_FLAGS={args.flags}")
    run(args.cmake, "--build", work)
    try_consumer(work / "consumer")


def with_pkg_config(args, prefix, work):
    folders = [str(path.parent) for path in prefix.rglob("rlpc-decoder.pc")]
    found = run("pkg-config", "--cflags", "--libs", "rlpc-decoder", stdout=subprocess.PIPE,
                text=True, env={**os.environ, "PKG_CONFIG_PATH": os.pathsep.join(folders)})
    work.mkdir()
    run(args.cxx, "-std=c++20", *shlex.split(args.flags), CONSUMER / "consumer.cpp", "-o",
        work / "consumer", *shlex.split(found.stdout))
    try_consumer(work / "consumer")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=pathlib.Path, help="a finished build directory")
    parser.add_argument("--cmake", default="cmake")
    parser.add_argument("--cxx", default="g++")
    parser.add_argument("--flags", default="", help="the C++ flags of the build")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        try:
            run(args.cmake, "--install", args.build, "--prefix", work / "installed",
                stdout=subprocess.DEVNULL)
            # The package must not depend on the place it was installed to.
            prefix = (work / "installed").rename(work / "moved")
            with_cmake(args, prefix, work / "cmake")
            if shutil.which("pkg-config"):
                with_pkg_config(args, prefix, work / "pkg-config")
            else:
                print("pkg-config is not installed: its file was not tried")
        except subprocess.CalledProcessError as error:
            print(f"install: {error}")
            return 1
    print("install: the installed package can be used")
    return 0


if __name__ == "__main__":
    sys.exit(main())
