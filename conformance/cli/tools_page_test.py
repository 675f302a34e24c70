#!/usr/bin/env python3
"""The pages of rlpcinfo and rlpccmp: their contents, and how a browser shows them.

    tools_page_test.py --bin BUILD/bin [unittest arguments, such as PagesInBrowser]
"""

import base64
import json
import re
import struct
import sys
import unittest
import zlib

from tools_testing import INPUTS, NAMES, ROOT, ToolsTest, limited, main, read_pc2, write_pc2

sys.path.insert(0, str(ROOT / "decoder" / "web" / "player"))
import chromium

BROWSER = chromium.program()


class PageTest(ToolsTest):
    def has(self, words, page, present=True):
        """Like assertIn, without printing the whole page."""
        self.assertTrue((words in page) == present, words)

    def compare(self, name="elephant", *options):
        """The text of the page of rlpccmp."""
        self.encode(self.path("a.rlpc"), "--kg", 1, "--gof", 20, "--order-map",
                    self.path("a.order"), name=name)
        self.ok("rlpccmp", INPUTS / f"{name}.obj", "--points-a", INPUTS / f"{name}.pc2",
                self.path("a.rlpc"), "--order-map", self.path("a.order"), "--html",
                self.path("a.html"), *options)
        return self.path("a.html").read_text()

    def inform(self, stream, *options):
        self.ok("rlpcinfo", stream, "--html", self.path("info.html"), *options)
        return self.path("info.html").read_text()


class Pages(PageTest):
    def block(self, page, name):
        return re.search(f'id="{name}">([^<]*)<', page).group(1)

    def test_nothing_comes_from_elsewhere(self):
        self.compare()
        for page in (self.path("a.html").read_text(), self.inform(self.path("a.rlpc")),
                     self.inform(self.path("a.rlpc"), "--coarse")):
            self.assertEqual(re.findall(r"(?i)[a-z]+://|src=|href=|@import|url\(|fetch\(", page),
                             [])

    def test_positions_and_errors_are_those_of_the_animation(self):
        page = self.compare("curtain")
        info = json.loads(self.block(page, "mesh-info"))
        self.assertEqual((info["vertices"], info["frames"], info["stride"]), (400, 82, 1))
        originals = read_pc2(INPUTS / "curtain.pc2")
        levels = struct.unpack(f"<{3 * 400 * 82}H",
                               base64.b64decode(self.block(page, "mesh-original")))
        for i, level in enumerate(levels):
            value = originals[i // 1200][i % 1200]
            shown = info["low"][i % 3] + info["step"][i % 3] * level
            self.assertLessEqual(abs(value - shown), 0.51 * info["step"][i % 3])
        errors = base64.b64decode(self.block(page, "mesh-errors"))
        self.assertEqual((len(errors), max(errors)), (400 * 82, 255))
        report = self.ok("rlpccmp", INPUTS / "curtain.obj", self.path("a.rlpc"), "--order-map",
                         self.path("a.order"), "--json").json()["metrics"]
        self.assertAlmostEqual(info["largest"], report["max_error"], delta=1e-6)
        frame, vertex = divmod(errors.index(255), 400)
        self.assertEqual((frame, vertex), (report["max_error_frame"], report["max_error_vertex"]))
        triangles = base64.b64decode(self.block(page, "mesh-triangles"))
        self.assertEqual(len(triangles), 12 * 722)

    def test_figures_are_those_of_the_report(self):
        page = self.compare()
        report = self.ok("rlpccmp", INPUTS / "elephant.obj", self.path("a.rlpc"), "--order-map",
                         self.path("a.order"), "--json").json()
        self.has(f"<b>{report['metrics']['kg_error_percent']:#.3g} %</b>", page)
        self.has(f"<b>{report['surface']['sted']:#.3g}</b>", page)
        self.has(f"<b>{report['bpvf']:#.4g}</b>", page)
        info = self.ok("rlpcinfo", self.path("a.rlpc"), "--json").json()
        for page in (page, self.inform(self.path("a.rlpc"))):
            for part, bits in info["bits"].items():
                row = re.search(rf"</i>{part}</td><td>([0-9,]+)</td>", page)
                self.assertEqual(row is not None, bits > 0, part)
                if row:
                    self.assertEqual(int(row.group(1).replace(",", "")), (bits + 4) // 8)
        charts = [json.loads(text.replace("&quot;", '"'))
                  for text in re.findall(r'data-chart="([^"]*)"', page)]
        self.assertEqual(charts[0]["bars"], [[0, 20], [20, 20], [40, 20]])
        for g, gof in enumerate(info["gofs"]):
            size = gof["bytes"] + sum(n["bytes"] for n in gof["slices"])
            shown = sum(values[g] for values in charts[0]["values"]) * 538 * 20 / 8
            self.assertLessEqual(size, shown * 1.001)  # there are hashes, too
            self.assertLess(shown, size + 40)

    def test_both_kinds_of_gofs_are_listed(self):
        page = self.inform(ROOT / "streams/v1.1/accept/MIX/MIX-0201a.rlpc")
        for words in ("<th>bones</th>", "<th>clusters</th>", "Units of frames 4 – 8"):
            self.has(words, page)
        self.has("Units of frames 0", page, False)
        self.encode(self.path("a.rlpc"), "--kg", 5, "--profile", "baseline")
        page = self.inform(self.path("a.rlpc"))
        self.has("<th>clusters</th>", page)
        self.has("<th>bones</th>", page, False)

    def test_without_a_stream_there_is_no_rate(self):
        self.ok("rlpccmp", INPUTS / "elephant.obj", INPUTS / "elephant.obj", "--html",
                self.path("a.html"))
        page = self.path("a.html").read_text()
        self.has("Error along the frames", page)
        self.has("<h2>Rate</h2>", page, False)
        self.has("∞", page)  # PSNR
        self.assertEqual(re.findall(r">-?(?:nan|inf)\b", page), [])

    def test_large_animations_show_some_frames(self):
        frames = read_pc2(INPUTS / "elephant.pc2")
        write_pc2(self.path("long.pc2"), (frames * 45)[:2600])  # 18 MB in 13 bytes a vertex
        long = [INPUTS / "elephant.obj", "--points-a", self.path("long.pc2"),
                INPUTS / "elephant.obj", "--points-b", self.path("long.pc2")]
        self.ok("rlpccmp", *long, "--html", self.path("a.html"), "-q")
        page = self.path("a.html").read_text()
        self.has("Shows one of every 2 frames", page)
        self.has("the largest of 3 each", page)
        info = json.loads(self.block(page, "mesh-info"))
        self.assertEqual((info["frames"], info["stride"], info["all_frames"]), (1300, 2, 2600))
        self.assertLess(len(page), 24 << 20)

    def test_pages_appear_when_they_are_whole(self):
        self.encode(self.path("a.rlpc"), "--kg", 1, "--keep-order")
        compare = (INPUTS / "elephant.obj", self.path("a.rlpc"), "-q")
        for tool, arguments, code in (("rlpccmp", compare, 2),
                                      ("rlpcinfo", compare[1:2], 4)):
            for place in ("none/a.html", "."):
                self.fails(code, str(self.path(place)), tool, *arguments, "--html",
                           self.path(place))
            self.path("old.html").write_text("old")
            self.fails(code, "old.html", tool, *arguments, "--html", self.path("old.html"),
                       **limited(4096))
            self.assertEqual(self.path("old.html").read_text(), "old")
        self.path("bad.rlpc").write_bytes(self.path("a.rlpc").read_bytes()[:-20])
        self.fails(1, "", "rlpcinfo", self.path("bad.rlpc"), "--html", self.path("bad.html"))
        self.fails(64, "", "rlpcinfo", self.path("a.rlpc"), "--trace", "--html",
                   self.path("b.html"))
        self.assertEqual(self.files(), ["a.rlpc", "bad.rlpc", "old.html"])


def png_pixels(path):
    """(width, height, a sample of its bytes), to see whether anything is drawn."""
    data = path.read_bytes()
    width, height = struct.unpack_from(">II", data, 16)
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        packed += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += 12 + size
    return width, height, set(zlib.decompress(packed)[::97])


@unittest.skipUnless(BROWSER, "chromium is not installed (Debian package chromium)")
class PagesInBrowser(PageTest):
    compared = {}  # name: (page, stream)

    @classmethod
    def setUpClass(cls):
        browser = chromium.Chromium(BROWSER)
        cls.browser = browser.__enter__()
        cls.addClassCleanup(browser.__exit__)

    def compare(self, name="elephant"):
        """As above, once for each animation."""
        if name not in self.compared:
            self.compared[name] = super().compare(name), self.path("a.rlpc").read_bytes()
        page, stream = self.compared[name]
        self.path("a.html").write_text(page)
        self.path("a.rlpc").write_bytes(stream)

    def browse(self, page, fragment="", size=(780, 440)):
        """The page, once it is complete; fails if it logs anything."""
        self.browser.resize(*size)
        self.browser.load(f"{self.path(page).as_uri()}#{fragment}")
        dom = self.browser.page()
        said = [text for text in self.browser.said
                if "GL Driver Message (OpenGL, Performance" not in text]
        self.assertEqual(said, [])
        return dom

    def drawn(self, dom):
        """(frame, opaque pixels, their box in shares of the canvas: left, top, right, bottom)"""
        tag = re.search(r'<div class="stage"[^>]*>', dom).group(0)
        found = dict(re.findall(r'data-([a-z]+)="([^"]*)"', tag))
        return int(found["frame"]), int(found["covered"]), [*map(float, found["box"].split())]

    def test_the_viewer_draws(self):
        for name in NAMES:
            covered = set()
            self.compare(name)
            more = ("frame=30&show=both&edges", "frame=30&up=z") if name == NAMES[0] else ()
            for fragment in ("frame=30", *more):
                dom = self.browse("a.html", fragment)
                frame, pixels, box = self.drawn(dom)
                self.assertEqual(frame, 30)
                self.has("frame 30 / ", dom)
                self.assertGreater(pixels, 2000, (name, fragment))
                self.framed(box)
                covered.add(pixels)
            self.assertEqual(len(re.findall('<path class="now" d="M', dom)), 9)
            self.assertEqual(len(covered), 1 + len(more))

    def framed(self, box):
        """The mesh is drawn large, completely and in the middle."""
        left, top, right, bottom = box
        self.assertGreater(max(right - left, bottom - top), 0.6, box)
        self.assertGreater(min(left, top, 1 - right, 1 - bottom), 0.01, box)
        self.assertLess(abs(left + right - 1), 0.2, box)
        self.assertLess(abs(top + bottom - 1), 0.2, box)

    def test_what_moves_away_or_grows_stays_in_view(self):
        """A mesh that jumps and stretches was once drawn tiny, at the bottom of the view."""
        frames = [[5 * f + x for x in xyz] for f, xyz in enumerate(self.clip(3)[1])]
        frames.append([4 * x for x in frames[0]])
        write_pc2(self.path("clip.pc2"), frames)
        moving = [self.path("clip.obj"), self.path("clip.obj"), "--points-a", self.path("clip.pc2"),
                  "--points-b", self.path("clip.pc2"), "-q", "--html", self.path("a.html")]
        self.ok("rlpccmp", *moving)
        for frame in range(4):
            self.framed(self.drawn(self.browse("a.html", f"frame={frame}"))[2])

    def test_points_and_single_frames_are_drawn(self):
        self.path("points.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\n")
        self.path("moved.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 2 0.1\nv 0 0 3\n")
        self.ok("rlpccmp", self.path("points.obj"), self.path("moved.obj"), "--html",
                self.path("a.html"))
        self.assertGreater(self.drawn(self.browse("a.html"))[1], 20)

    def test_pages_are_drawn_light_and_dark(self):
        self.compare()
        self.inform(self.path("a.rlpc"))
        pictures = set()
        for page in ("a.html", "info.html"):
            for scheme in ("dark", "light"):
                self.browser.call("Emulation.setEmulatedMedia", features=[
                    {"name": "prefers-color-scheme", "value": scheme}])
                image = self.path("shot.png")
                self.browse(page, size=(1240, 900))
                self.browser.screenshot(image)
                got, height, colours = png_pixels(image)
                self.assertEqual((got, height), (1240, 900))
                self.assertGreater(len(colours), 30)
                pictures.add(image.read_bytes())
        self.assertEqual(len(pictures), 4)

    def test_pages_fit_a_narrow_window(self):
        self.compare()
        self.inform(self.path("a.rlpc"))
        for page in ("a.html", "info.html"):
            for width in (1240, 340):
                self.browse(page, size=(width, 800))
                shown = self.browser.evaluate("document.documentElement.scrollWidth")
                self.assertEqual(shown, width, page)

    def test_far_from_the_origin_it_looks_the_same(self):
        """Coordinates of 24 bits, exact in both places; a step is 1/1024."""
        faces = [line for line in (INPUTS / "elephant.obj").read_text().splitlines()
                 if line.startswith("f ")]
        xyz = [round(1024 * value) / 1024 for value in read_pc2(INPUTS / "elephant.pc2")[0]]
        shots = []
        for place in (0, 8192):
            lines = [f"v {xyz[i] + place} {xyz[i + 1] + place} {xyz[i + 2] + place}"
                     for i in range(0, len(xyz), 3)]
            self.path("far.obj").write_text("\n".join(lines + faces))
            self.ok("rlpccmp", self.path("far.obj"), self.path("far.obj"), "-q", "--html",
                    self.path("a.html"))
            self.browse("a.html", "flat=1", size=(1000, 1200))
            self.browser.screenshot(self.path("shot.png"))
            shots.append(self.path("shot.png").read_bytes())
        self.assertTrue(shots[0] == shots[1], "the pictures differ")

    def test_charts_show_values(self):
        """Simulates a pointer over the first chart."""
        self.compare()
        page = self.path("a.html")
        page.write_text(page.read_text().replace("</body>", """<script>
          const svg = document.querySelector("figure[data-chart] svg");
          const box = svg.getBoundingClientRect();
          const place = {clientX: box.left + box.width / 2, clientY: box.top + 50, bubbles: true};
          svg.dispatchEvent(new PointerEvent("pointermove", place));
          svg.dispatchEvent(new MouseEvent("click", place));
          </script></body>"""))
        dom = self.browse("a.html", "frame=3")
        tip = re.search(r'<div class="tip"[^>]*>(.*?)</figure>', dom, re.DOTALL).group(1)
        self.assertRegex(tip, r"<div>frame (2[5-9]|3\d)</div>")
        self.assertRegex(tip, r"RMS: 0\.\d+.*largest: 0\.\d+")
        shown = re.search(r'<output id="frame"[^>]*>frame (\d+)', dom).group(1)
        self.has(f"<div>frame {shown}</div>", tip)


if __name__ == "__main__":
    main()
