"""Plots, drawn by plot_svg (decoder/report/svg_plot.h)."""

import dataclasses
import json
import shutil
import subprocess


class Failure(Exception):
    """A plot was not drawn; the text says why."""


@dataclasses.dataclass
class Series:
    name: str
    points: list  # (x, y)
    colour: str
    line: str = "solid"  # or "dashed" or "none"
    marker: str = "circle"  # or "square" or "none"
    width: float = 2.0


@dataclasses.dataclass
class Plot:
    """Points are above 0 where an axis is logarithmic. `categories`: words of the horizontal axis
    at 1, 2, 3 ... in place of numbers."""
    title: str
    series: list
    x_label: str
    y_label: str
    log_x: bool = True
    log_y: bool = True
    categories: tuple = ()

    def json(self):
        return json.dumps({
            "title": self.title, "x": {"label": self.x_label, "is_log": self.log_x,
                                       "categories": self.categories},
            "y": {"label": self.y_label, "is_log": self.log_y},
            "series": [dataclasses.asdict(series) for series in self.series]})

    def svg(self, tool):
        """`tool`: path of plot_svg."""
        try:
            done = subprocess.run([tool], input=self.json(), capture_output=True, text=True,
                                  encoding="utf-8", check=False)
        except OSError as error:
            raise Failure(f"{tool}: {error.strerror}") from error
        if done.returncode != 0:
            raise Failure(f"{self.title}: {done.stderr.strip()}")
        return done.stdout

    def save(self, tool, path):
        """Writes PATH.svg; PATH.png and PATH.pdf if rsvg-convert is installed. Returns the
        extensions."""
        path.with_name(path.name + ".svg").write_text(self.svg(tool), encoding="utf-8")
        written = ["svg"]
        converter = shutil.which("rsvg-convert")
        for kind, options in (("png", ["--zoom", "2"]), ("pdf", [])):
            if converter:
                subprocess.run([converter, "--format", kind, *options, "-o", f"{path}.{kind}",
                                f"{path}.svg"], check=True)
                written.append(kind)
        return written
