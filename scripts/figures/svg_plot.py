"""Line plots as SVG, with nothing but the standard library."""

import html
import math
import shutil
import subprocess

HEIGHT = 600
LEFT, RIGHT, TOP, BOTTOM = 80, 670, 56, 536  # of the plot
LEGEND_LEFT, NAME_LEFT, LEGEND_WIDTH = 22, 44, 228  # right of the plot; wider if names are long
CHARACTER = 8  # width, in pixels: names in wide fonts have room
INK, FAINT = "#222222", "#e4e4e4"


class Axis:
    """Values to pixels. Ticks at 1, 2, 5 of each decade, or at round numbers if linear."""

    def __init__(self, label, values, log, first_pixel, last_pixel):
        self.label, self.log = label, log
        low, high = min(values), max(values)
        if log:
            low, high = low / 1.15, high * 1.15
        else:
            low, high = min(low, 0), high + 0.04 * (high - min(low, 0) or 1)
        self.low, self.high = low, high
        self.first, self.last = first_pixel, last_pixel

    def pixel(self, value):
        scale = math.log if self.log else float
        share = (scale(value) - scale(self.low)) / (scale(self.high) - scale(self.low))
        return self.first + share * (self.last - self.first)

    def ticks(self):
        if self.log:
            decades = range(math.floor(math.log10(self.low)), math.ceil(math.log10(self.high)) + 1)
            values = [m * 10.0 ** e for e in decades for m in (1, 2, 5)]
        else:
            rough = (self.high - self.low) / 8
            unit = 10.0 ** math.floor(math.log10(rough))
            step = min((m * unit for m in (1, 2, 5, 10) if m * unit >= rough), default=unit)
            values = [i * step for i in range(int(self.high / step) + 1)]
        return [v for v in values if self.low <= v <= self.high]


class Series:
    """`marker`: "circle", "square" or "none"; `line`: "solid", "dashed" or "none"."""

    def __init__(self, name, points, colour, line="solid", marker="circle", width=2.0):
        self.name, self.points, self.colour = name, points, colour
        self.line, self.marker, self.width = line, marker, width


def text(x, y, words, size=13, anchor="start", colour=INK, extra=""):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" '
            f'fill="{colour}"{extra}>{html.escape(words)}</text>')


def line_style(series):
    dash = ' stroke-dasharray="7 4"' if series.line == "dashed" else ""
    return f'fill="none" stroke="{series.colour}" stroke-width="{series.width}"{dash}'


def marker(series, x, y):
    if series.marker == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.4" fill="{series.colour}"/>'
    if series.marker == "square":
        return (f'<rect x="{x - 4.5:.1f}" y="{y - 4.5:.1f}" width="9" height="9" fill="white" '
                f'stroke="{series.colour}" stroke-width="2"/>')
    return ""


def grid(x_axis, y_axis):
    for value in x_axis.ticks():
        x = x_axis.pixel(value)
        yield f'<path d="M{x:.1f} {TOP}V{BOTTOM}" stroke="{FAINT}"/>'
        yield text(x, BOTTOM + 20, f"{value:g}", anchor="middle")
    for value in y_axis.ticks():
        y = y_axis.pixel(value)
        yield f'<path d="M{LEFT} {y:.1f}H{RIGHT}" stroke="{FAINT}"/>'
        yield text(LEFT - 8, y + 4.5, f"{value:g}", anchor="end")
    yield (f'<rect x="{LEFT}" y="{TOP}" width="{RIGHT - LEFT}" height="{BOTTOM - TOP}" '
           f'fill="none" stroke="{INK}"/>')
    yield text((LEFT + RIGHT) / 2, HEIGHT - 18, x_axis.label, 14, "middle")
    middle = (TOP + BOTTOM) / 2
    yield text(22, middle, y_axis.label, 14, "middle",
               extra=f' transform="rotate(-90 22 {middle:.1f})"')


def legend(series_list):
    x, y = RIGHT + LEGEND_LEFT, TOP + 14
    for series in series_list:
        if series.line != "none":
            yield f'<path d="M{x} {y}h34" {line_style(series)}/>'
        yield marker(series, x + 17, y)
        yield text(x + NAME_LEFT, y + 4.5, series.name)
        y += 24


def save(path, svg):
    """Writes PATH.svg; PATH.png and PATH.pdf if rsvg-convert is installed. Returns the extensions."""
    path.with_name(path.name + ".svg").write_text(svg, encoding="utf-8")
    written = ["svg"]
    tool = shutil.which("rsvg-convert")
    for kind, options in (("png", ["--zoom", "2"]), ("pdf", [])):
        if tool:
            subprocess.run([tool, "--format", kind, *options, "-o", f"{path}.{kind}",
                            f"{path}.svg"], check=True)
            written.append(kind)
    return written


def plot(title, series_list, x_label, y_label, log_x=True, log_y=True):
    """The SVG text. Points are (x, y); above zero where an axis is logarithmic."""
    points = [p for series in series_list for p in series.points]
    x_axis = Axis(x_label, [p[0] for p in points], log_x, LEFT, RIGHT)
    y_axis = Axis(y_label, [p[1] for p in points], log_y, BOTTOM, TOP)
    longest = NAME_LEFT + CHARACTER * max(len(series.name) for series in series_list)
    width = RIGHT + LEGEND_LEFT + max(LEGEND_WIDTH, longest)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{HEIGHT}" '
             f'viewBox="0 0 {width} {HEIGHT}" font-family="Helvetica, Arial, sans-serif">',
             f'<rect width="{width}" height="{HEIGHT}" fill="white"/>',
             text(LEFT, 32, title, 17, extra=' font-weight="bold"')]
    parts += grid(x_axis, y_axis)
    for series in series_list:
        pixels = [(x_axis.pixel(x), y_axis.pixel(y)) for x, y in series.points]
        if series.line != "none":
            path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in pixels)
            parts.append(f'<path d="{path}" stroke-linejoin="round" {line_style(series)}/>')
        parts += [marker(series, x, y) for x, y in pixels]
    parts += legend(series_list)
    return "\n".join(part for part in parts if part) + "\n</svg>\n"
