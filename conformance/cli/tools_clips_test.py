#!/usr/bin/env python3
"""Clips: parts of an animation that a stream names.

    tools_clips_test.py --bin BUILD/bin
"""

from tools_testing import INPUTS, ROOT, ToolsTest, main


class Clips(ToolsTest):
    def test_clips_are_named_and_found(self):
        clips = ["--clip", "Run:0-19", "--clip", "L\u00e4ufe: 2:18-18"]
        report = self.encode(self.path("a.rlpc"), "--kg", 1, *clips)
        self.assertGreater(report["bits"]["metadata"], 0)
        info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
        self.assertEqual(info["clips"],
                         [{"name": "Run", "first_frame": 0, "num_frames": 20, "duration": 19 / 30},
                          {"name": "L\u00e4ufe: 2", "first_frame": 18, "num_frames": 1,
                           "duration": 0}])
        self.assertEqual(info["duration"], 59 / 30)
        text = self.ok("rlpcinfo", self.path("a.rlpc")).out
        self.assertRegex(text.decode(), r"\n  clip .* frames +seconds\n  Run .* 0-19 +0.633\n")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("run.rlpd"), "--clip", "Run")
        self.ok("rlpcdec", self.path("a.rlpc"), "-o", self.path("part.rlpd"), "--frames", "0-19")
        self.assertEqual(self.path("run.rlpd").read_bytes(), self.path("part.rlpd").read_bytes())

    def test_wrong_clips_are_refused(self):
        for wrong in ("Run", "Run:", "Run:3-", "Run:5-3", "Run:x", ":0-3"):
            self.fails(64, ["clip"], "rlpcenc", INPUTS / "elephant.obj", "--points",
                       INPUTS / "elephant.pc2", "-o", self.path("a.rlpc"), "--clip", wrong)
        self.fails(1, ["clip `Run` has frames beyond the last, 59"], "rlpcenc",
                   INPUTS / "elephant.obj", "--points", INPUTS / "elephant.pc2", "-o",
                   self.path("a.rlpc"), "--preset", "fast", "--clip", "Run:0-60")
        self.assertEqual(self.files(), [])
        self.encode(self.path("a.rlpc"), "--kg", 2)
        self.fails(64, ["has no clips"], "rlpcdec", self.path("a.rlpc"), "-o",
                   self.path("b.pc2"), "--clip", "Run")
        self.encode(self.path("b.rlpc"), "--kg", 2, "--clip", "Walk:0-9")
        self.fails(64, ["expected one of `Walk`"], "rlpcdec", self.path("b.rlpc"), "-o",
                   self.path("b.pc2"), "--clip", "Run")

        self.fails(64, ["--clip", "the name is empty"], "rlpcdec", self.path("b.rlpc"), "-o",
                   self.path("b.pc2"), "--clip", "")
        self.encode(self.path("c.rlpc"), "--kg", 2, "--clip", "A:0-9", "--clip", "A:20-29")
        self.fails(64, ["several clips are called `A`; use --frames 0-9 or 20-29"], "rlpcdec",
                   self.path("c.rlpc"), "-o", self.path("b.pc2"), "--clip", "A")

    def test_a_clip_may_end_after_an_open_ended_stream(self):
        stream = ROOT / "streams" / "v1.2" / "accept" / "CLP" / "CLP-0004a.rlpc"
        self.fails(64, ["`all` ends with frame 16777215, but the stream ends with frame 2"],
                   "rlpcdec", stream, "-o", self.path("a.pc2"), "--clip", "all")
        self.assertEqual(self.files(), [])
        beyond = ROOT / "streams" / "v1.2" / "accept" / "CLP" / "CLP-0005a.rlpc"
        self.fails(64, ["`late` ends with frame 9, but the stream ends with frame 2"], "rlpcdec",
                   beyond, "-o", self.path("a.pc2"), "--clip", "late")


if __name__ == "__main__":
    main()
