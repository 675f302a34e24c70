"""Shared by the reproductions of all papers: a report on one animation, with the Main and High
profiles, and the command line."""

import argparse
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "scripts" / "studies" / folder) for folder in ("comparison", "figures")]
import codec_table
import inputs
import measure
import plots

import bench as benches
import models
import not_reproduced
import page

OURS = {"Main": ("main", "#111111"), "High": ("high", "#8e44ad")}
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#111111")
RATE = "bits per vertex and frame (everything counted)"
KG = "KG error, per cent, one mean of all frames"
# Programs of every paper, and of some; `scripts/quickstart` builds the first four.
TOOLS = ("rlpcenc", "rlpcdec", "rlpcinfo", "rlpccmp", "plot_svg")
MORE_TOOLS = {"sslpc": ("peer_codec",), "cobra": ("cobra_basis",)}


class Paper:
    """name: of the paper, in titles."""

    def __init__(self, name, bench, folder, quick):
        self.bench, self.quick = bench, quick
        self.step = 2 if quick else 1  # step through lists of settings
        self.sequence = bench.sequence
        self.report = page.Report(f"{name} on {self.sequence.name}", folder, bench.tools)
        self.model = models.model_of(
            self.sequence.num_vertices, models.count_triangles(self.sequence.mesh),
            self.sequence.num_frames, bench.norm)
        self.report.add(page.Text(self.norm_note))
        if self.model:
            self.report.add(page.Text(models.how_recognised(self.model)))

    @property
    def norm_note(self):
        return ("KG errors are 100 * ||A - B|| / ||A - E(A)||, E(A) being one mean of all vertices "
                "of all frames, the norm of the published figures. With the mean of each frame, as "
                "rlpcenc --kg has them and rlpccmp states them first, those of this sequence are "
                f"{self.bench.norm:.4g} times as large.")

    def at_error(self, name, kg):
        """A run of Main or High."""
        return self.bench.run(name, ["--profile", OURS[name][0], *self.bench.target(kg)])

    def plot(self, name, title, series, x_label=RATE, y_label=KG, **scales):
        title = f"{self.sequence.name}: {title}"
        self.report.plot(name, plots.Plot(title, series, x_label, y_label, **scales))

    def heading(self, text):
        self.report.add(page.Heading(text))

    def claims(self, items, paper):
        self.heading("Claims of the paper")
        self.report.add(page.Items(items))
        self.heading("Not reproduced, and why")
        self.report.add(page.Items(not_reproduced.of(paper)))

    def tables(self, tables, note):
        """Adds tables (report.Table), the first of them to table.csv; all to table.md."""
        self.report.csv("table.csv", tables[0].head, tables[0].rows)
        self.report.text("table.md", "\n".join(
            [f"{self.norm_note}\n", *(t.markdown() for t in tables), f"{note}\n"]))


def curve_rows(curves):
    """CSV of the runs of all curves: head, rows."""
    return (["method", "clusters", "components", "bpvf", "kg_sequence_error_percent",
             "kg_error_percent", "encode_seconds", "decode_seconds"],
            [[r.method, r.clusters or "", r.components or "", r.bpvf, r.kg, r.frame_kg,
              f"{r.encode_seconds:.3f}", f"{r.decode_seconds:.3f}"]
             for runs in curves.values() for r in runs])


def line(name, runs, colour, style="solid", width=2.0):
    points = [(r.bpvf, r.kg) for r in runs if r.kg > 0]
    return plots.Series(name, points, colour, style, width=width)


def published_points(name, points, colour):
    """points: (bpvf, KG)."""
    return plots.Series(name, list(points), colour, "none", "square")


def find_inputs(words):
    """The bundled elephant; bundled animations by name; or anything that rlpcenc reads."""
    bundled = ROOT / "streams" / "inputs"
    return inputs.find(
        str(bundled / f"{word}.obj") if (bundled / f"{word}.obj").is_file()
        and not pathlib.Path(word).exists() else word for word in words or ["elephant"])


def check_tools(toolbox, paper):
    """Complains of all programs that are missing at once."""
    missing = [tool for tool in (*TOOLS, *MORE_TOOLS.get(paper, ()))
               if not (toolbox.folder / tool).is_file()]
    if missing:
        remedy = toolbox.how_to_build(" ".join(missing)).replace(" it ", " them ")
        raise benches.Failure(f"{toolbox.folder} has no {', '.join(missing)}; {remedy}")


def main(paper, description, reproduction):
    """paper: a folder of build/reproduce. reproduction(bench, folder, quick).make() returns
    sentences."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("-o", dest="folder", type=pathlib.Path)
    parser.add_argument("sequences", nargs="*")
    options = parser.parse_args()
    try:
        toolbox = codec_table.Toolbox(options.bin.resolve())
        check_tools(toolbox, paper)
        root = options.folder or ROOT / "build" / "reproduce" / paper
        sequences = inputs.open_all(find_inputs(options.sequences),
                                    toolbox, root / "inputs")
        for sequence in sequences:
            folder = root
            if options.folder is None or len(sequences) > 1:
                folder = folder / sequence.name
            folder.mkdir(parents=True, exist_ok=True)
            bench = benches.Bench(options.bin.resolve(), sequence, folder,
                                  lambda text: print(text, flush=True))
            made = reproduction(bench, folder, options.quick)
            items = made.make()
            print(f"\n{(folder / 'table.md').read_text(encoding='utf-8')}")
            print("\n".join(items))
            print(f"\nreproduce: wrote to {folder}: {', '.join(sorted(made.report.files))}")
    except (benches.Failure, measure.Failure, plots.Failure) as failure:
        sys.exit(f"reproduce: {failure}")
