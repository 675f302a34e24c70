"""The builds that are compared: native compilers, and Debian's cross compilers with qemu-user."""

import dataclasses
import os
import pathlib
import re
import shutil
import subprocess

import zlib_source

SANITIZERS = "-O1 -fsanitize=address,undefined -fno-sanitize-recover=all"
GOOGLETEST = pathlib.Path("/usr/src/googletest")


class NotRun(Exception):
    """This machine cannot build or run a platform; the text says why."""


class BuildFailed(Exception):
    """A build failed; the text says where its log is."""


@dataclasses.dataclass
class Platform:
    name: str
    compiler: str
    flags: str
    triplet: str = ""  # prefix of a cross compiler
    qemu: str = ""
    unit_tests: bool = False  # runs those of common/

    def emulator(self):
        """The words before the command of a program of this platform."""
        return [self.qemu, "-L", f"/usr/{self.triplet}"] if self.qemu else []


def native():
    levels = ["-O0", "-O2", "-O3", "-O3 -march=native"]
    names = ["O0", "O2", "O3", "O3-native"]
    found = [Platform(f"{short}-{name}", compiler, flags)
             for short, compiler in [("gcc", "g++"), ("clang", "clang++-14")]
             for name, flags in zip(names, levels)]
    return found + [Platform("clang-sanitize", "clang++-14", SANITIZERS)]


def cross():
    """32 bits and the other byte order run the unit tests as well."""
    return [Platform(name, f"{triplet}-g++", "-O2", triplet, qemu, tests)
            for name, triplet, qemu, tests in [
                ("aarch64", "aarch64-linux-gnu", "qemu-aarch64", False),
                ("armhf", "arm-linux-gnueabihf", "qemu-arm", True),
                ("riscv64", "riscv64-linux-gnu", "qemu-riscv64", False),
                ("s390x", "s390x-linux-gnu", "qemu-s390x", True)]]


class Builder:
    """Builds the tools, in OUT/NAME for each platform; libraries of targets in OUT/target."""

    def __init__(self, root, out):
        self.root = root
        self.out = out

    def build(self, platform):
        """Builds everything that the platform runs; returns the folder of the programs."""
        for program in filter(None, [platform.compiler, platform.qemu]):
            if not shutil.which(program):
                raise NotRun(f"no {program}")
        log = self.out / f"{platform.name}.log"
        with log.open("w") as out:
            arguments = self._target(platform, out) if platform.triplet else [
                f"-DCMAKE_CXX_COMPILER={platform.compiler}"]
            if shutil.which("ccache"):
                arguments.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
            folder = self.out / platform.name
            self._run(out, ["cmake", "-S", self.root, "-B", folder, "-G", "Ninja",
                            f"-DBUILD_TESTING={'ON' if self._tested(platform) else 'OFF'}",
                            "-DCMAKE_BUILD_TYPE=None", f"-DCMAKE_CXX_FLAGS={platform.flags}",
                            *arguments])
            self._run(out, ["cmake", "--build", folder, "--target", "rlpcenc", "rlpcdec"])
            tests = self.unit_tests(platform)
            for name in tests:
                (folder / "bin" / name).unlink(missing_ok=True)
            if tests:  # the other installed programs must build there, too
                self._run(out, ["cmake", "--build", folder, "--target", "rlpc", "rlpcinfo",
                                "rlpccmp", "rlpcval"])
                # A test that does not build counts as failed.
                subprocess.run(["cmake", "--build", folder, "--target", *tests, "--", "-k0"],
                               stdout=out, stderr=out)
        return folder / "bin"

    def unit_tests(self, platform):
        """Names of the test programs of common/ that the build of the platform has."""
        if not self._tested(platform):
            return []
        lists = (self.root / "common" / "CMakeLists.txt").read_text()
        names = re.findall(r"^ *rlpc_test\((\w+)", lists, re.MULTILINE)
        targets = subprocess.run(["cmake", "--build", self.out / platform.name, "--target", "help"],
                                 capture_output=True, text=True, check=True).stdout.split()
        return [name for name in names if f"{name}:" in targets]

    @staticmethod
    def _tested(platform):
        return platform.unit_tests and GOOGLETEST.is_dir()

    def run_unit_tests(self, platform, bin_folder):
        """Unit tests that fail or do not build."""
        failed = []
        with (self.out / f"{platform.name}.log").open("a") as out:
            for name in self.unit_tests(platform):
                command = [*platform.emulator(), bin_folder / name, "--gtest_brief=1"]
                if not (bin_folder / name).exists() or subprocess.run(
                        command, stdout=out, stderr=out,
                        stdin=subprocess.DEVNULL).returncode != 0:
                    failed.append(name)
        return failed

    def _target(self, platform, out):
        """Arguments of CMake for a cross compiler, with the libraries of the target built."""
        target = self.out / "target" / platform.name
        arguments = [
            f"-DCMAKE_TOOLCHAIN_FILE={self.root / 'scripts' / 'cmake' / 'cross_toolchain.cmake'}",
            f"-DRLPC_TRIPLET={platform.triplet}", f"-DRLPC_QEMU={platform.qemu}",
            f"-DRLPC_TARGET_ROOT={target}"]
        if not (target / "lib" / "libz.a").exists():
            self._zlib(platform, target, out)
        if self._tested(platform) and not (target / "lib" / "libgtest.a").exists():
            work = target / "googletest"
            self._run(out, ["cmake", "-S", GOOGLETEST, "-B", work, "-G", "Ninja",
                            "-DBUILD_GMOCK=OFF", "-DCMAKE_BUILD_TYPE=Release",
                            f"-DCMAKE_INSTALL_PREFIX={target}", *arguments])
            self._run(out, ["cmake", "--build", work, "--target", "install"])
        return arguments

    def _zlib(self, platform, target, out):
        work = target / "zlib"
        shutil.rmtree(work, ignore_errors=True)
        shutil.copytree(self._zlib_source(out), work)
        self._run(out, ["./configure", "--static"], cwd=work,
                  env={**os.environ, "CHOST": platform.triplet})
        self._run(out, ["make", "libz.a"], cwd=work)
        for folder, names in [("include", ["zlib.h", "zconf.h"]), ("lib", ["libz.a"])]:
            (target / folder).mkdir(exist_ok=True)
            for name in names:
                shutil.copy(work / name, target / folder)

    def _zlib_source(self, out):
        try:
            return zlib_source.fetch(self.out / "zlib-source",
                                     lambda command, cwd: self._run(out, command, cwd=cwd))
        except (zlib_source.Unavailable, BuildFailed) as failure:
            raise NotRun(f"no zlib for it: {failure}") from failure

    @staticmethod
    def _run(out, command, **options):
        out.flush()
        if subprocess.run(command, stdout=out, stderr=out, stdin=subprocess.DEVNULL,
                          **options).returncode != 0:
            raise BuildFailed(out.name)
