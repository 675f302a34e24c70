#!/usr/bin/env python3
"""Messages that say what is wrong and what to do: each of these once misled a user."""

import re
import shutil
import subprocess

from tools_testing import INPUTS, Tools, ToolsTest, main, run


class Messages(ToolsTest):
    def stream(self, *options):
        path = self.path("a.rlpc")
        self.encode(path, "--kg", 1, *options)
        return path

    def test_limits_are_named_with_what_is_needed(self):
        stream = self.stream()
        trace = self.ok("rlpcinfo", stream, "--trace").out.decode()
        for limits, words in (
                (["--max-memory", "50KiB"], r"needs at least \d+ KiB of memory, more than the "
                 r"limit \(--max-memory, 50 KiB\)"),
                (["--max-vertices", 500], r"num_vertices_minus1: more vertices than the limit "
                                          r"\(--max-vertices 500\)"),
                (["--max-frames", 59], r"num_frames_minus1: more frames than the limit "
                                       r"\(--max-frames 59\)")):
            result = self.fails(3, "", "rlpcdec", stream, "--verify", *limits)
            self.assertRegex(result.err, words)
            place, element = re.search(r"bit (\d+): (\w+): ", result.err).groups()
            self.assertRegex(trace, rf"(?m)^ *{place}    {element} = ")
        for size, said in (("50kB", "50 kB"), ("50000", "50 kB"), ("48828KiB", ""), ("50MB", ""),
                           ("40Ki", "40 KiB"), ("40KB", "40 kB"), ("40k", "40 kB")):
            result = run("rlpcdec", stream, "--verify", "--max-memory", size)
            self.assertEqual(result.code, 3 if said else 0)
            self.assertIn(f"(--max-memory, {said})" if said else "decoded", result.err)
        needed = re.search(r"(\d+) KiB of", self.fails(
            3, "", "rlpcinfo", stream, "--max-memory", "50KiB").err).group(1)
        # With one KiB less the mesh does not fit; with that limit it does.
        less = run("rlpcinfo", stream, "--max-memory", 1024 * (int(needed) - 1))
        self.assertIn(f"at least {needed} KiB", less.err)
        enough = run("rlpcinfo", stream, "--max-memory", 1024 * int(needed))
        self.assertNotIn(f"at least {needed} KiB", enough.err)
        result = run("rlpcval", stream, "--max-memory", "50KiB")
        self.assertIn(b"of memory, more than the limit", result.out)

    def test_settings_of_libraries_are_named_as_options(self):
        self.clip(2)
        encode = ["rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"), "-o",
                  self.path("a.rlpc")]
        for options, words in (
                (["--clusters", 2], "--clusters needs --profile baseline: use that, or leave out "
                                    "--clusters"),
                (["--profile", "baseline", "--bones", 2], "--bones needs --profile main"),
                (["--profile", "baseline", "--no-rdo"], "--no-rdo needs a number of components "
                                                        "per cluster (--components)"),
                (["--low-delay", "--profile", "high", "--bpvf", 1],
                 "use --quality, --kg, --max-error or --lossless BITS instead of --bpvf"),
                (["--temporal-layers", 2, "--frame-pattern", "previous", "--profile", "high",
                  "--gof-kind", "inter"], "(--temporal-layers)")):
            error = run(*encode, *options).err
            self.assertIn(words, error)
            self.assertNotIn("'", error)
        self.assertIn("(--max-memory). A smaller --gof needs less",
                      run(*encode, "--max-memory", "1MB").err)

    def test_one_frame_is_no_plural(self):
        self.clip(2)
        self.path("one.obj").write_bytes(self.path("clip.obj").read_bytes())
        self.fails(2, "one.obj has 1 frame, but ", "rlpccmp", self.path("one.obj"),
                   self.path("clip.obj"), "--points-b", self.path("clip.pc2"))
        said = self.ok("rlpccmp", self.path("one.obj"), self.path("one.obj")).out.decode()
        self.assertIn(" vertices, 1 frame\n", said)

    def test_what_is_no_stream_is_recognised(self):
        stream = self.stream().read_bytes()
        files = {"fox.glb": (b"glTF\2\0\0\0", "it looks like glTF"),
                 "fox.gltf": (b'\n {"asset": 1}', "it looks like glTF or other JSON"),
                 "m.obj": (b"v 1 2 3\n", "it looks like an OBJ mesh"),
                 "c.pc2": (b"POINTCACHE2\0", "it looks like a PC2 point cache"),
                 "a.rlpc.gz": (b"\x1f\x8b\x08", "it looks like a gzip file"),
                 "text.rlpc": (stream[:4] + b"C\n\x1a" + stream[7:], "a transfer as text"),
                 "none.rlpc": (b"", "the stream ends too early"),
                 "noise.rlpc": (bytes(range(128, 200)), "not an RLPC stream (rule R-STR-01)\n")}
        for name, (content, words) in files.items():
            self.path(name).write_bytes(content)
            for tool, options in (("rlpcdec", ["--verify"]), ("rlpcinfo", [])):
                self.fails(1, [name, words], tool, self.path(name), *options)
        self.fails(1, "standard input: not an RLPC stream", "rlpcinfo", "-",
                   input=files["fox.glb"][0] + bytes(64))

    def test_the_output_is_a_stream(self):
        self.clip(2)
        for name in ("fox.glb", "fox.PC2", "frames.obj"):
            self.fails(64, ["the output is an RLPC stream", name.split(".")[0] + ".rlpc"],
                       "rlpcenc", self.path("clip.obj"), "-o", self.path(name))
            self.assertFalse(self.path(name).exists())

    def test_what_gltf_loses(self):
        said = self.ok("rlpcenc", INPUTS / "tulip.glb", "-o", self.path("a.rlpc"), "--kg", 1,
                       "--preset", "fast").err
        self.assertIn("merged 53 duplicate vertices (172 left)", said)
        dropped = re.search(r"dropped: (.*)", said).group(1).split(", ")
        self.assertIn("skeleton (not its motion)", dropped)
        self.assertNotIn("UVs", dropped)  # it has none

    def test_points_are_advised_for_meshes_only(self):
        triangles, frames = self.clip(1)
        said = self.ok("rlpcenc", self.path("clip.obj"), "--dry-run", "--kg", 1).err
        self.assertIn("clip.obj: is a single frame; did you mean --points "
                      f"{self.path('clip.pc2')}?", said)
        self.ok("rlpcenc", self.path("clip.obj"), "-o", self.path("a.rlpc"), "--kg", 1)
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("clip.glb"))
        self.assertNotIn("--points",
                         self.ok("rlpcenc", self.path("clip.glb"), "--dry-run", "--kg", 1).err)
        self.assertEqual((len(triangles), len(frames)), (1072, 1))

    def test_advice_on_visible_errors_helps(self):
        clip = [INPUTS / "curtain.obj", "--points", INPUTS / "curtain.pc2", "--preset", "fast"]
        for options in (["--kg", 1], ["--max-error", 0.05]):
            said = run("rlpcenc", *clip, "-o", self.path("a.rlpc"), *options).err
            found = re.search(r"may be visible: .*\(above 3 %\)\. Try (--\S+) (\S+)\.\n", said)
            self.assertIsNotNone(found, said)
            said = run("rlpcenc", *clip, "-o", self.path("a.rlpc"), *found.groups()).err
            self.assertNotIn("visible", said, found.groups())

    def test_advice_on_missed_targets_helps(self):
        clip = [INPUTS / "robot_arm.obj", "--points", INPUTS / "robot_arm.pc2", "--preset", "fast",
                "-o", self.path("a.rlpc")]
        for options in (["--kg", 1e-5], ["--max-error", 1e-7], ["--bpvf", 0.02],
                        ["--kg", 0.01, "--components", 2, "--bones", 1]):
            said = self.fails(2, "out of reach", "rlpcenc", *clip, *options).err
            found = re.search(r"Try (?:more --components, or )?(--\S+) (\S+?)"
                              r"(?:, or a longer --gof)?\.\n", said)
            self.assertIsNotNone(found, said)
            self.assertEqual(found.group(1), options[0])
            self.ok("rlpcenc", *clip, *found.groups(), *options[2:])

    def test_choices_of_the_encoder_are_reported_on_request(self):
        self.clip(4)
        clip = ["rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"), "--dry-run"]
        self.assertNotIn(b"trial", self.ok(*clip).out)
        self.assertRegex(self.ok(*clip, "--verbose").out, rb"GOF.* components?, \d+ trial")

    def test_stages_are_timed_on_request(self):
        self.clip(4)
        clip = ["rlpcenc", self.path("clip.obj"), "--points", self.path("clip.pc2"),
                "-o", self.path("a.rlpc")]
        self.assertNotIn("stage_seconds", self.ok(*clip, "--json").json())
        self.assertIn("connectivity", self.ok(*clip, "--json", "-v").json()["stage_seconds"])
        self.assertRegex(self.ok(*clip, "-v", "--threads", 1).out, rb"\n  seconds: ")
        self.assertRegex(self.ok(*clip, "-v", "--threads", 2).out,
                         rb"\n  seconds of the first thread: ")

    def test_the_player_is_not_built(self):
        stream = self.stream()
        self.fails(4, "none.html: cannot read the player", "rlpcdec", stream, "--html",
                   self.path("a.html"), "--player", self.path("none.html"))
        self.path("bin").mkdir()  # contains nothing else
        shutil.copy(Tools.folder / "rlpcdec", self.path("bin"))
        done = subprocess.run([self.path("bin") / "rlpcdec", stream, "--html", self.path("a.html")],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.stderr,
                         "rlpcdec: player not built: run scripts/player first, or pass "
                         "--player PAGE\n")


if __name__ == "__main__":
    main()
