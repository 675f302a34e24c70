"""Results as CSV, Markdown, plots, and one HTML page that holds all of it."""

import csv
import dataclasses
import html
import io

import arithmetic
import measure
import plots

NOTHING = "-"

STYLE = """
body { font: 15px/1.5 Helvetica, Arial, sans-serif; color: #222; max-width: 1180px;
       margin: 2em auto; padding: 0 1em; }
table { border-collapse: collapse; margin: 1em 0; font-variant-numeric: tabular-nums; }
th, td { padding: 3px 10px; border-bottom: 1px solid #e4e4e4; text-align: right;
         white-space: nowrap; }
th { background: #f6f6f6; } th:first-child, td:first-child { text-align: left; }
.wide { overflow-x: auto; } svg { max-width: 100%; height: auto; } li { margin: 2px 0; }
"""


@dataclasses.dataclass
class Table:
    title: str
    head: list
    rows: list  # lists of words

    def markdown(self):
        lines = ["| " + " | ".join(self.head) + " |",
                 "|---" + "|---:" * (len(self.head) - 1) + "|"]
        return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in self.rows]) + "\n"

    def text(self):
        """For terminals: the first column to the left, the others to the right."""
        widths = [max(map(len, column)) for column in zip(self.head, *self.rows)]
        lines = ["  ".join(cell.ljust(width) if i == 0 else cell.rjust(width)
                           for i, (cell, width) in enumerate(zip(row, widths)))
                 for row in (self.head, *self.rows)]
        return "\n".join(lines) + "\n"

    def html(self):
        def line(cells, tag):
            return "<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>\n"
        return (f'<div class="wide"><table>\n{line(self.head, "th")}'
                f'{"".join(line(row, "td") for row in self.rows)}</table></div>\n')


@dataclasses.dataclass(frozen=True)
class Curve:
    """A codec with its way to group frames: a column of the tables, a line of the plots."""
    codec: object
    gof: str
    title: str

    def points(self, points, sequence):
        wanted = (sequence.name, self.codec.name, self.gof)
        return [p for p in points if (p.sequence, p.codec, p.gof) == wanted]

    def sizes(self, points, sequence):
        return [(p.kg_error_percent, p.bytes) for p in self.points(points, sequence)]


def curves_of(codecs, gofs):
    """The first is the one that others are compared with."""
    found = []
    for codec in codecs:
        for gof in gofs if codec.has_gof else ("",):
            several = codec.has_gof and len(gofs) > 1
            found.append(Curve(codec, gof, f"{codec.title}, GOF {gof}" if several else codec.title))
    return found


def described(sequence):
    return f"{sequence.name}: {sequence.num_vertices} vertices, {sequence.num_frames} frames"


def number(value, digits=3):
    """Text with this many significant digits."""
    if value is None:
        return NOTHING
    if value == 0:
        return "0"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e" in text and abs(value) >= 1 else _padded(text, digits)


def _padded(text, digits):
    whole = text.lstrip("-0.").replace(".", "")
    if "e" in text or len(whole) >= digits:
        return text
    return text + ("" if "." in text else ".") + "0" * (digits - len(whole))


def percent(value):
    return NOTHING if value is None else f"{value:+.1f} %"


def bpvf_at(curve, points, sequence, kg):
    size = arithmetic.size_at(curve.sizes(points, sequence), kg)
    return None if size is None else 8 * size / sequence.size


def rates_table(sequences, curves, points, kg):
    rows = [[sequence.name, *(number(bpvf_at(c, points, sequence, kg)) for c in curves)]
            for sequence in sequences]
    if len(sequences) > 1:
        means = (arithmetic.geometric_mean(bpvf_at(c, points, s, kg) for s in sequences)
                 for c in curves)
        rows.append(["geometric mean", *map(number, means)])
    return Table(f"Bits per vertex and frame at KG error {kg:g} %",
                 ["sequence", *(c.title for c in curves)], rows)


def ratios_table(sequences, curves, points, kgs):
    """Size against the first curve: geometric mean of the sequences where both reach the error."""
    rows = []
    for curve in curves[1:]:
        row = [curve.title]
        for kg in kgs:
            pairs = [(bpvf_at(curve, points, s, kg), bpvf_at(curves[0], points, s, kg))
                     for s in sequences]
            ratios = [a / b for a, b in pairs if a is not None and b is not None]
            mean = arithmetic.geometric_mean(ratios)
            some = 0 < len(ratios) < len(sequences)
            row.append(number(mean) + (f" ({len(ratios)} of {len(sequences)})" if some else ""))
        rows.append(row)
    return Table(f"Size against {curves[0].title} at equal KG error, geometric mean",
                 ["codec", *(f"KG {kg:g} %" for kg in kgs)], rows)


def ablation_tables(sequences, curves, points, kgs):
    """Gain of clusters; and gain of each other tool, against Main without clusters,
    as the variants without these tools have no clusters either."""
    names = list(dict.fromkeys(curve.codec.name for curve in curves))
    found = []
    for chosen in (names[:2], names[1:]):
        part = [curve for curve in curves if curve.codec.name in chosen]
        found += [extra_table(sequences, part, points, kgs), bd_table(sequences, part, points)]
    return found


def extra_table(sequences, curves, points, kgs):
    """Like ratios_table, but extra bytes in per cent, for every sequence."""
    rows = []
    for curve in curves[1:]:
        columns = []
        for kg in kgs:
            sizes = [(bpvf_at(curve, points, s, kg), bpvf_at(curves[0], points, s, kg))
                     for s in sequences]
            columns.append([None if None in pair else pair[0] / pair[1] for pair in sizes])
        cells = [" / ".join(_extra(column[i]) for column in columns)
                 for i in range(len(sequences))]
        means = [arithmetic.geometric_mean(column) for column in columns]
        rows.append([curve.title, *cells, " / ".join(map(_extra, means))])
    title = (f"Per cent more bytes than {curves[0].title} at KG error "
             + " / ".join(f"{kg:g}" for kg in kgs) + " %")
    return Table(title, ["variant", *(s.name for s in sequences), "mean"], rows)


def _extra(ratio):
    return NOTHING if ratio is None else f"{100 * (ratio - 1):+.1f}"


def bd_rates(curve, sequences, curves, points):
    """BD-rates against the first curve, in per cent; None if there is none."""
    return [arithmetic.bd_rate(curve.sizes(points, s), curves[0].sizes(points, s))
            for s in sequences]


def mean_bd_rate(rates):
    mean = arithmetic.geometric_mean(1 + x / 100 for x in rates if x is not None)
    return None if mean is None else 100 * (mean - 1)


def bd_table(sequences, curves, points):
    rows = []
    for curve in curves[1:]:
        found = bd_rates(curve, sequences, curves, points)
        rows.append([curve.title, *map(percent, found), percent(mean_bd_rate(found))])
    return Table(f"BD-rate against {curves[0].title} (above 0: more bytes)",
                 ["codec", *(s.name for s in sequences), "mean"], rows)


def speed_table(sequences, curves, points, kg):
    """Vertices times frames per second, and memory, at the point nearest to an error."""
    rows = []
    for curve in curves:
        encode, decode, peaks = [], [], []
        for sequence in sequences:
            at = [p for p in curve.points(points, sequence) if p.kg_error_percent > 0]
            if not at:
                continue
            point = min(at, key=lambda p: max(p.kg_error_percent / kg, kg / p.kg_error_percent))
            encode.append(sequence.size / point.encode_seconds)
            decode.append(sequence.size / point.decode_seconds)
            peaks.append((point.encode_peak_mib, point.decode_peak_mib))
        if encode:
            rows.append([curve.title, *(number(arithmetic.geometric_mean(x) / 1e6)
                                        for x in (encode, decode)),
                         *(f"{max(column):.0f}" for column in zip(*peaks))])
    return Table(f"Speed near KG {kg:g} %: million vertices times frames a second (geometric mean) "
                 "of the tools, files read and written; largest peak memory",
                 ["codec", "encode", "decode", "encode, MiB", "decode, MiB"], rows)


def points_csv(points):
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(field.name for field in dataclasses.fields(measure.Point))
    for point in points:
        rows.writerow(f"{value:.9g}" if isinstance(value, float) else value
                      for value in dataclasses.astuple(point))
    return text.getvalue()


def curve_plot(sequence, curves, points, kgs):
    """Around these errors. None if there is nothing to draw."""
    series = []
    for number_of, curve in enumerate(curves):
        line = sorted((8 * size / sequence.size, kg)
                      for kg, size in arithmetic.front(curve.sizes(points, sequence))
                      if min(kgs) / 2 <= kg <= 2 * max(kgs))
        second = any(c.codec is curve.codec for c in curves[:number_of])
        if line:
            series.append(plots.Series(curve.title, line, curve.codec.colour,
                                       "dashed" if second else curve.codec.line,
                                       width=2.8 if number_of == 0 else 2.0))
    if not series:
        return None
    return plots.Plot(described(sequence), series, "bits per vertex and frame (whole file)",
                      "KG error, per cent")


def page(title, notes, tables, pictures):
    """`pictures`: SVG."""
    parts = [f"<h1>{html.escape(title)}</h1>", *pictures]
    for table in tables:
        parts += [f"<h2>{html.escape(table.title)}</h2>", table.html()]
    parts += ["<h2>Notes</h2>", "<ul>", *(f"<li>{html.escape(note)}</li>" for note in notes),
              "</ul>"]
    return ("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>"
            f"<title>{html.escape(title)}</title><style>{STYLE}</style></head><body>\n"
            + "\n".join(parts) + "\n</body></html>\n")


def markdown(title, notes, tables, pictures):
    """`pictures`: names of SVG files in the same folder, without extension."""
    lines = [f"# {title}"]
    for name in pictures:
        lines += ["", f"![{name}](<{name}.svg>)"]
    for table in tables:
        lines += ["", f"## {table.title}", "", table.markdown().rstrip()]
    lines += ["", "## Notes", "", *(f"- {note}" for note in notes)]
    return "\n".join(lines) + "\n"


def readme_rates(sequences, curves, points, kgs):
    """A row for each codec: rates, and the BD-rate."""
    rows = []
    for curve in curves:
        cells = [" / ".join(number(bpvf_at(curve, points, s, kg)) for kg in kgs)
                 for s in sequences]
        if curve is not curves[0]:
            cells = [f"{cell} ({_whole_percent(bd)})" for cell, bd in
                     zip(cells, bd_rates(curve, sequences, curves, points))]
        rows.append([curve.title, *cells])
    return Table("", ["bpvf at KG error " + " / ".join(f"{kg:g}" for kg in kgs) + " % (BD-rate)",
                      *map(described, sequences)], rows)


def readme_bd_rates(sequences, curves, points, kg):
    """A row for each sequence: what the first codec takes, and BD-rates of the others."""
    columns = [bd_rates(curve, sequences, curves, points) for curve in curves[1:]]
    rows = [[described(s),
             number(bpvf_at(curves[0], points, s, kg)),
             *(_whole_percent(column[i]) for column in columns)]
            for i, s in enumerate(sequences)]
    rates = (bpvf_at(curves[0], points, s, kg) for s in sequences)
    rows.append(["geometric mean", number(arithmetic.geometric_mean(rates)),
                 *(_whole_percent(mean_bd_rate(column)) for column in columns)])
    return Table("", ["BD-rate", f"{curves[0].title}: bpvf at {kg:g} %",
                      *(c.title for c in curves[1:])], rows)


def _whole_percent(value):
    return NOTHING if value is None else f"{value:+.0f} %"


def marks(name):
    """The lines around a table of README.md."""
    return f"<!-- begin: {name} -->", f"<!-- end: {name} -->"


def replace_marked(text, name, table):
    """`text` with the lines between the marks replaced."""
    first, last = marks(name)
    begin, end = text.find(first), text.find(last)
    if begin < 0 or end < begin:
        raise measure.Failure(f"README.md has no lines {first} and {last}")
    return text[:begin + len(first)] + "\n" + table + text[end:]
