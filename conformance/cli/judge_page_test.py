#!/usr/bin/env python3
"""The page of the judge, in a browser.

    judge_page_test.py --bin BUILD/bin [unittest arguments]
"""

import re
import sys
import unittest

from tools_page_test import ROOT, chromium, png_pixels

for folder in ("judge", "specdec"):
    sys.path.insert(0, str(ROOT / "conformance" / folder))
from judge_testing import JudgeTest, main
from report_test import FAULTY


@unittest.skipUnless(chromium.program(), "chromium is not installed (Debian package chromium)")
class Page(JudgeTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        browser = chromium.Chromium(chromium.program())
        cls.browser = browser.__enter__()
        cls.addClassCleanup(browser.__exit__)

    def setUp(self):
        super().setUp()
        self.page = self.folder / "report.html"
        self.judge(FAULTY, "--html", self.page)

    def browse(self, fragment="", width=1280):
        self.browser.resize(width, 900)
        self.browser.load(f"{self.page.as_uri()}#{fragment}")

    def shown(self, fragment):
        """(ids of the rows that are shown, ids of those opened, text of the counter)"""
        self.browse(fragment)
        dom = self.browser.page()
        rows = re.findall(r'<tr class="row" id="([^"]+)"([^>]*)>', dom)
        opened = re.findall(r'<tr class="row" id="([^"]+)"[^>]*>.*?<tr class="details"([^>]*)>',
                            dom, re.DOTALL)
        return ([i for i, rest in rows if "hidden" not in rest],
                [i for i, rest in opened if "hidden" not in rest],
                re.search(r'id="shown"[^>]*>([^<]*)<', dom).group(1))

    def test_filters(self):
        ids = ["GOF-0001a", "GOF-0002a", "LVL-0001a", "MET-0001a"]
        self.assertEqual(self.shown("outcome=FAIL"), (ids, [], "4 of 8 shown"))
        self.assertEqual(self.shown("outcome=FAIL-output&text=gof+vertex&open=GOF-0001a"),
                         (ids[:2], ids[:1], "2 of 8 shown"))
        self.assertEqual(self.shown("")[2], "8 of 8 shown")

    def test_page_is_drawn_wide_and_narrow(self):
        for width in (1280, 400):
            image = self.folder / f"{width}.png"
            self.browse("open=GOF-0001a", width)
            self.browser.screenshot(image)
            got, height, colours = png_pixels(image)
            self.assertEqual((got, height), (width, 900))
            self.assertGreater(len(colours), 30)

    def test_page_fits_a_narrow_window(self):
        text = self.page.read_text().replace("recall();", "", 1)
        self.page.write_text(text.replace('class="details" hidden', 'class="details"'))
        for width in (1280, 400, 340):
            self.browse(width=width)
            shown = self.browser.evaluate("document.documentElement.scrollWidth")
            self.assertEqual(shown, width)


if __name__ == "__main__":
    main()
