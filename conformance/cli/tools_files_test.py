#!/usr/bin/env python3
"""The tools and their files: what they overwrite and leave behind, and where output goes.

    tools_files_test.py --bin BUILD/bin [unittest arguments, such as Interrupts]
"""

import json
import os
import pathlib
import resource
import shutil
import signal
import struct
import subprocess
import time

from tools_testing import Tools, ToolsTest, main, run, write_pc2


NO_CORE = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0))}


def processor_time(pid):
    """Returns the processor time of a process so far, in seconds, of all its threads."""
    stat = pathlib.Path(f"/proc/{pid}/stat").read_text()
    user, system = stat.rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


class Interrupts(ToolsTest):
    """A signal ends a tool before its work is done, and leaves no unfinished output."""

    def interrupted(self, by, started, tool, *arguments, **options):
        """Sends the signal as soon as the file `started` exists; the tool must end by it, within a
        second of processor time: time of a clock would depend on what else the machine does."""
        with subprocess.Popen([Tools.folder / tool, *map(str, arguments)],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              **options) as running:
            while not self.path(started).exists() and running.poll() is None:
                time.sleep(0.001)
            before = processor_time(running.pid)
            running.send_signal(by)
            _, status, usage = os.wait4(running.pid, 0)
            running.returncode = os.waitstatus_to_exitcode(status)
        self.assertEqual(running.returncode, -by, tool)
        self.assertLess(usage.ru_utime + usage.ru_stime - before, 1.0, tool)

    def long_clip(self):
        _, frames = self.clip(60)
        write_pc2(self.path("clip.pc2"), frames * 20)
        return [self.path("clip.obj"), "--points", self.path("clip.pc2")]

    def test_while_encoding_and_decoding(self):
        mesh = self.long_clip()
        encode = [*mesh, "-o", self.path("x.rlpc"), "--order-map", self.path("x.map")]
        for threads, by in ((1, signal.SIGTERM), (2, signal.SIGINT), (7, signal.SIGHUP)):
            self.interrupted(by, "x.map.partial", "rlpcenc", *encode, "--threads", threads)
            self.assertEqual(self.files(), ["clip.obj", "clip.pc2"])
        self.ok("rlpcenc", *mesh, "-o", self.path("x.rlpc"), "--kg", 5, "--preset", "fast", "-q")
        before = self.files()
        for started, output in (("out.partial", "out"), ("out.pc2.partial", "out.pc2"),
                                ("out.glb.partial", "out.glb")):
            self.interrupted(signal.SIGTERM, started, "rlpcdec", self.path("x.rlpc"), "-o",
                             self.path(output))
            self.assertEqual(self.files(), before)

    def test_while_a_page_is_made(self):
        mesh = self.long_clip()
        page = ["--html", self.path("page.html")]
        write_pc2(self.path("long.pc2"), self.clip(60)[1] * 400)
        long = self.path("long.pc2")
        pair = [mesh[0], mesh[0], "--points-a", long, "--points-b", long]
        self.interrupted(signal.SIGINT, "page.html.partial", "rlpccmp", *pair, *page)
        long.unlink()
        self.assertEqual(self.files(), ["clip.obj", "clip.pc2"])
        with subprocess.Popen(["sleep", "100"], stdout=subprocess.PIPE) as silent:
            self.interrupted(signal.SIGINT, "page.html.partial", "rlpcinfo", "-", *page,
                             stdin=silent.stdout)
            silent.kill()
        self.assertEqual(self.files(), ["clip.obj", "clip.pc2"])

    def test_every_signal_that_ends_a_process(self):
        mesh = self.long_clip()
        encode = [*mesh, "-o", self.path("x.rlpc"), "--order-map", self.path("x.map")]
        for by in (signal.SIGQUIT, signal.SIGXCPU, signal.SIGALRM, signal.SIGVTALRM,
                   signal.SIGPROF, signal.SIGUSR1, signal.SIGUSR2):
            self.interrupted(by, "x.map.partial", "rlpcenc", *encode, "--threads", 2, **NO_CORE)
            self.assertEqual(self.files(), ["clip.obj", "clip.pc2"])

    def test_time_that_runs_out(self):
        mesh = self.long_clip()
        limit = {"preexec_fn": lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, 10))}
        done = run("rlpcenc", *mesh, "-o", self.path("x.rlpc"), "--preset", "slow", **limit)
        self.assertEqual(done.code, -signal.SIGXCPU)
        self.assertEqual(self.files(), ["clip.obj", "clip.pc2"])

    def test_a_reader_that_goes_away(self):
        self.long_clip()
        self.encode_long()
        before = self.files()
        for tool, *arguments in (
                ("rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"), "-q",
                 "--kg", 5, "--preset", "fast", "-o", "-", "--order-map", self.path("x.map")),
                ("rlpcdec", self.path("x.rlpc"), "-o", "-", "--format", "rlpd", "-q"),
                ("rlpcinfo", self.path("x.rlpc"), "--trace")):
            with subprocess.Popen([Tools.folder / tool, *map(str, arguments)],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as running:
                running.stdout.close()
                self.assertEqual(running.wait(), -signal.SIGPIPE, tool)
            self.assertEqual(self.files(), before, tool)

    def encode_long(self):
        self.ok("rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"), "-o",
                self.path("x.rlpc"), "--kg", 5, "--preset", "fast", "-q")

    def test_signals_that_are_ignored(self):
        """SIGHUP is ignored, as under nohup."""
        self.clip(20)
        ignored = {"preexec_fn": lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)}
        with subprocess.Popen([Tools.folder / "rlpcenc", self.path("clip.obj"), "--points",
                               self.path("clip.pc2"), "-o", self.path("x.rlpc"), "-q"],
                              **ignored) as running:
            while not self.path("x.rlpc.partial").exists() and running.poll() is None:
                time.sleep(0.001)
            running.send_signal(signal.SIGHUP)
            self.assertEqual(running.wait(), 0)
        self.assertEqual(self.files(), ["clip.obj", "clip.pc2", "x.rlpc"])


class SamePlaces(ToolsTest):
    """No output overwrites an input or another output."""

    def setUp(self):
        super().setUp()
        self.clip(4)
        self.encode(self.path("a.rlpc"))
        self.before = {name: self.path(name).read_bytes() for name in self.files()}

    def refused(self, words, tool, *arguments, code=64):
        self.fails(code, words, tool, *arguments)
        self.assertEqual({name: self.path(name).read_bytes() for name in self.files()},
                         self.before)

    def test_of_the_encoder(self):
        obj, pc2, out = self.path("clip.obj"), self.path("clip.pc2"), self.path("x.rlpc")
        (self.path("linked.obj")).symlink_to(obj)
        self.before["linked.obj"] = self.before["clip.obj"]
        for output in (obj, self.path("linked.obj"), self.path(".") / "clip.obj"):
            self.refused("is also an input", "rlpcenc", obj, "-o", output)
        self.refused("is also an input", "rlpcenc", obj, "--points", pc2, "-o", pc2)
        self.refused("is also an input", "rlpcenc", obj, "-o", out, "--order-map", obj)
        self.refused("two names", "rlpcenc", obj, "-o", out, "--order-map", out)
        for options in (["-o", "-", "--json"], ["-o", "-", "--order-map", "-"],
                        ["-o", out, "--order-map", "-", "--json"]):
            self.refused("cannot both", "rlpcenc", obj, *options)

    def test_of_files_that_the_input_points_to(self):
        self.path("frames").mkdir()
        for f in range(3):
            frame = self.path(f"frames/w_{f}.obj")
            frame.write_bytes(self.path("clip.obj").read_bytes())
        last, frames = frame.read_bytes(), self.path("frames")
        out = self.path("x.rlpc")
        for source in (frames, frames / "w_*.obj", frames / "w_%d.obj"):
            self.fails(64, "is an RLPC stream", "rlpcenc", source, "-o", frame)
            self.fails(64, "is also an input", "rlpcenc", source, "-o", out, "--order-map", frame)
            self.fails(64, "choose another name", "rlpccmp", source, source, "--csv", frame)
        self.assertEqual(frame.read_bytes(), last)
        self.assertFalse(out.exists())
        # The mesh next to the cache, which the command line does not name.
        self.fails(64, "choose another name", "rlpccmp", self.path("clip.pc2"),
                   self.path("clip.pc2"), "--csv", self.path("clip.obj"))
        buffer = struct.pack("<9f3H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2)
        self.path("data.bin").write_bytes(buffer)
        self.path("a.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                          {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                            {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
            "images": [{"uri": "skin.png"}], "textures": [{"source": 0}],
            "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            "buffers": [{"uri": "data.bin", "byteLength": 42}]}))
        skin = b"\x89PNG\r\n\x1a\n the picture"
        self.path("skin.png").write_bytes(skin)
        for name, content in (("data.bin", buffer), ("skin.png", skin)):
            self.fails(64, "is also an input", "rlpcenc", self.path("a.gltf"), "-o",
                       self.path(name))
            self.assertEqual(self.path(name).read_bytes(), content)
        self.ok("rlpcenc", self.path("a.gltf"), "-o", out)

    def test_of_numbered_files(self):
        stream, folder = self.path("a.rlpc"), self.path("numbered")
        folder.mkdir()
        for name, output in (("f_3.obj", "f_%d.obj"), ("f_0003.obj", "f_####.obj"),
                             ("frame_0003.obj", ""), ("f_9.ply", "f_%d.ply")):
            for place in (shutil.copy, os.link, os.symlink):
                place(stream, folder / name)
                source = folder / name if place is shutil.copy else stream
                self.fails(64, f"{name}: is also an input", "rlpcdec", source, "-o",
                           folder / output)
                self.assertEqual((folder / name).read_bytes(), stream.read_bytes())
                (folder / name).unlink()
        self.assertEqual(list(folder.iterdir()), [])

    def test_of_the_decoder(self):
        stream = self.path("a.rlpc")
        self.refused("is also an input", "rlpcdec", stream, "-o", stream, "--format", "rlpd")
        self.refused("is also an input", "rlpcdec", stream, "--html", stream)
        self.refused("is also an input", "rlpcinfo", stream, "--html", stream)
        # The mesh that nobody named.
        self.refused("clip.obj: already exists", "rlpcdec", stream, "-o", self.path("clip.pc2"),
                     code=4)
        self.refused("another name", "rlpcdec", stream, "-o", self.path("x.obj"), "--format",
                     "pc2", code=4)
        for _ in range(2):  # a mesh that rlpcdec wrote is replaced
            self.ok("rlpcdec", stream, "-o", self.path("b.mdd"))

    def test_of_the_comparison(self):
        obj, pc2, stream = self.path("clip.obj"), self.path("clip.pc2"), self.path("a.rlpc")
        pair = [obj, "--points-a", pc2, obj, "--points-b", pc2]
        for option in ("--csv", "--html"):
            self.refused("choose another name", "rlpccmp", *pair, option, obj)
            self.refused("choose another name", "rlpccmp", *pair, option, pc2)
            self.refused("choose another name", "rlpccmp", *pair, "--stream", stream, option,
                         stream)
        self.refused("choose another name", "rlpccmp", *pair, "--csv", self.path("x"), "--html",
                     self.path("x"))
        self.refused("cannot both", "rlpccmp", *pair, "--csv", "-", "--json")


class Places(ToolsTest):
    """Tests where output files are created, and with which permissions."""

    def setUp(self):
        super().setUp()
        self.clip(4)
        self.encode(self.path("a.rlpc"), "--kg", 1)
        self.path("p.obj").write_text("# frame_rate 30/1\n")
        self.path("out").mkdir()
        self.path("pictures").mkdir()

    def writers(self):
        """Commands, and the file that each writes."""
        stream, obj = self.path("a.rlpc"), self.path("clip.obj")
        encode = ["rlpcenc", obj, "-q", "--preset", "fast"]
        yield ["rlpcdec", stream, "-o", self.path("p.pc2")], "p.pc2"
        yield ["rlpcdec", stream, "-o", self.path("p.pc2")], "p.obj"
        yield ["rlpcdec", stream, "-o", self.path("p.rlpd")], "p.rlpd"
        yield ["rlpcdec", stream, "-o", self.path("p.glb")], "p.glb"
        yield ["rlpcdec", stream, "-o", self.path("out")], "out/frame_0001.obj"
        yield [*encode, "-o", self.path("p.rlpc")], "p.rlpc"
        yield [*encode, "-o", self.path("q.rlpc"), "--order-map", self.path("p.map")], "p.map"
        yield ["rlpccmp", obj, obj, "--csv", self.path("p.csv"), "-q"], "p.csv"
        yield ["rlpccmp", obj, obj, "--html", self.path("p.html"), "-q"], "p.html"
        yield ["rlpcinfo", stream, "--html", self.path("i.html")], "i.html"
        yield ["rlpcinfo", stream, "--pictures", self.path("pictures")], "pictures/layers.svg"
        yield ["rlpcinfo", stream, "--extract", "components=0", "-o", self.path("e.rlpc")], "e.rlpc"

    def test_permissions_are_kept(self):
        for command, name in self.writers():
            for mode in (0o600, 0o664):
                if not self.path(name).exists():
                    self.path(name).touch()
                self.path(name).chmod(mode)
                self.ok(*command)
                self.assertEqual(self.path(name).stat().st_mode & 0o777, mode, command)
            self.path(name).unlink()

    def test_links_are_followed(self):
        self.path("far").mkdir()
        for command, name in self.writers():
            target = self.path("far") / self.path(name).name
            self.path(name).unlink(missing_ok=True)
            self.path(name).symlink_to(target)
            for _ in range(2):  # without, then with an existing file
                self.ok(*command)
                self.assertTrue(self.path(name).is_symlink(), command)
                self.assertGreater(target.stat().st_size, 0, command)
            self.path(name).unlink()

    def test_long_names(self):
        longest = os.pathconf(self.folder, "PC_NAME_MAX")
        for size in (longest - 8, longest):
            name = "n" * (size - 5)
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path(name + ".rlpd"))
            self.ok("rlpcenc", self.path("clip.obj"), "-o", self.path(name + ".rlpc"), "-q")
            self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("n" * size))  # a folder
        self.assertEqual([name for name in self.files() if "partial" in name], [])


class Names(ToolsTest):
    """File names with control characters, or that are not UTF-8."""

    BAD = ("e\x1b[31m\x07", "line\nrlpcdec: all is well", "csi\udc9b31m", "bidi\u202egpj",
           "del\x7f", "nel\u0085")

    def setUp(self):
        super().setUp()
        self.clip(2)
        self.encode(self.path("a.rlpc"), "--kg", 1)

    def shown(self, code, tool, *arguments):
        """Standard output and error are printable, line by line."""
        done = subprocess.run([Tools.folder / tool, *arguments], capture_output=True, check=False)
        self.assertEqual(done.returncode, code, done.stderr)
        text = (done.stdout + done.stderr).decode()  # UTF-8
        for line in text.split("\n"):
            self.assertTrue(line.replace("\t", "").isprintable(), repr(line))
            self.assertFalse(line.startswith("rlpcdec: all is well"), repr(text))
        return text

    def test_that_are_not_there(self):
        for bad in self.BAD:
            none, out = self.path(bad), self.path("out")
            for code, *command in (
                    (4, "rlpcdec", none, "--verify"), (4, "rlpcdec", "decode", none, out),
                    (4, "rlpcdec", none, "--html", out), (4, "rlpcinfo", none),
                    (4, "rlpcinfo", none, "--extract", "layers=1", "-o", out),
                    (4, "rlpcval", none), (1, "rlpcenc", none, "-o", out),
                    (1, "rlpcenc", self.path("clip.obj"), "--points", none, "-o", out),
                    (2, "rlpccmp", none, none),
                    (4, "rlpcdec", self.path("a.rlpc"), "-o", none / "a.rlpd"),
                    (64, "rlpcdec", self.path("a.rlpc"), "--frames", bad, "--verify"),
                    (1, "rlpcenc", none, none, "-o", out), (64, "rlpcenc", none, "--kg", bad),
                    (64, "rlpcenc", none, "-o", out, "--gof", bad),
                    (64, "rlpcinfo", none, "--extract", bad, "-o", out),
                    (64, "rlpcval", "--explain", bad), (64, "rlpccmp", none, none, bad)):
                self.shown(code, *command)

    def test_that_are_there(self):
        for bad in self.BAD:
            stream, mesh = self.path(bad + ".rlpc"), self.path(bad + ".obj")
            stream.write_bytes(self.path("a.rlpc").read_bytes())
            mesh.write_bytes(self.path("clip.obj").read_bytes())
            out = self.path("o" + bad + ".rlpc")
            for command in (
                    ("rlpcdec", stream, "--verify"), ("rlpcinfo", stream), ("rlpcval", stream),
                    ("rlpcinfo", stream, "--extract", "components=0", "-o", out),
                    ("rlpccmp", mesh, mesh), ("rlpccmp", stream, stream),
                    ("rlpcenc", mesh, "-o", out), ("rlpcenc", mesh, "--dry-run")):
                self.assertIn("\\x", self.shown(0, *command))

    def test_json(self):
        for bad in self.BAD:
            stream, out = self.path(bad + ".rlpc"), self.path("o" + bad + ".rlpc")
            stream.write_bytes(self.path("a.rlpc").read_bytes())
            name = bad.replace("\udc9b", "\ufffd")
            told = self.ok("rlpccmp", stream, stream, "--json").json()
            self.assertTrue(told["a"].endswith(name + ".rlpc"), told["a"])
            told = self.ok("rlpcinfo", stream, "--extract", "components=0", "-o", out,
                           "--json").json()
            self.assertTrue(told["output"].endswith(name + ".rlpc"), told["output"])
            told = self.ok("rlpcval", stream, "--json").json()
            self.assertTrue(told["streams"][0]["file"].endswith(name + ".rlpc"))


if __name__ == "__main__":
    main()
