#!/usr/bin/env python3
"""The tables and figures of the SSLPC paper, made with our tools; called by scripts/reproduce."""

import paper  # first: it adds folders to sys.path
import claims
import models
import page
import report
import rlpca_published
import sslpc_findings
import sslpc_published as published
import temporal_cuts
from bench import FLAT
from paper import OURS

FRAMES = ["--profile", "high", "--gof-kind", "inter"]
PLAIN = ["--frame-weights", "plain", "--rest", "prediction", "--patches", 0]
ONE_SIDE = ["--frame-pattern", "previous"]
BOTH_SIDES = ["--frame-pattern", "dyadic:2"]  # even frames from both sides, odd from the odd before
METHODS = {  # options, colour and line
    "SSLPC": ([*PLAIN, *ONE_SIDE], "#0072b2", "solid"),
    "STSLPC": ([*PLAIN, *BOTH_SIDES], "#d55e00", "solid"),
    "SSLPC, learned": (ONE_SIDE, "#0072b2", "dashed"),
    "STSLPC, learned": (BOTH_SIDES, "#d55e00", "dashed"),
}
# KG errors: of the chicken, whose motion across space makes those of the papers small; of others.
TARGETS_OF_CHICKEN = (0.2, 0.14, 0.1, 0.08, 0.06, 0.04, 0.03, 0.02, 0.014)
TARGETS = (1, 0.7, 0.5, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05)
FLAT_BITS_OF_CHICKEN = (9, 10, 11, 12, 13, 14)
FLAT_BITS = (7, 8, 9, 10, 11, 12)
FLAT_COLOUR = "#009e73"
MAX_LAYERS = 255  # each layer a group: more than there are


def scalable_of(num_layers):
    """Scalability: name, method, options."""
    return {
        f"SSLPC, {num_layers} spatial layers": ("SSLPC", ["--layer-groups", num_layers]),
        "SSLPC, all spatial layers": ("SSLPC", ["--layer-groups", MAX_LAYERS]),
        "STSLPC, 2 temporal layers": ("STSLPC", ["--temporal-layers", 2]),
        f"STSLPC, 2 temporal and {num_layers} spatial layers":
            ("STSLPC", ["--temporal-layers", 2, "--layer-groups", num_layers]),
    }


NOTE = (
    "SSLPC: each frame is predicted from the one before; a vertex moves as the mean of its ring in "
    "lower layers. STSLPC: odd frames are predicted from the odd frame before, even ones from both "
    "sides. Both are inter GOFs of the High profile with --frame-weights plain; layers, base "
    "and entropy coder are those of the format (8.9, 9), and even frames of STSLPC have quantiser "
    "steps 1.2 times as large. Learned: the same with the weights that each vertex learns. The "
    "whole sequence is one group of frames; all bytes of the stream are counted.")
FLAT_NOTE = (
    f"{FLAT}: prediction from three neighbours in space and the frame before, near Dynapack; not "
    "scalable.")
UNKNOWN_NOTE = (
    "The paper has no figures of this sequence: the number of layers, the error called lossless "
    "and the one above which gains are stated are those of its cow.")


class Reproduction(paper.Paper):
    def __init__(self, bench, folder, quick):
        super().__init__("SSLPC", bench, folder, quick)
        self.known = published.decomposition_of(self.model)
        self.num_layers = len(self.known.layers)
        self.variants = scalable_of(self.num_layers)
        self.is_known = self.model is self.known.model
        is_chicken = self.model is models.CHICKEN
        self.targets = (TARGETS_OF_CHICKEN if is_chicken else TARGETS)[::self.step]
        self.flat_bits = (FLAT_BITS_OF_CHICKEN if is_chicken else FLAT_BITS)[::self.step]
        self.lossless = self.known.lossless
        # Targets for scalability, and for cuts of temporal layers.
        self.scalable_targets = tuple(self.lossless * x for x in (20 / 3, 2, 2 / 3))
        self.cut_targets = self.scalable_targets[:0:-1][:3 - self.step]
        self.curves = {}  # method: runs
        self.scalable = {}  # name: runs

    def settings(self, method, kg, more=()):
        return [*FRAMES, *METHODS[method][0], *more, *self.bench.target(kg)]

    def run_curves(self):
        for method in METHODS:
            self.curves[method] = [self.bench.run(method, self.settings(method, kg))
                                   for kg in self.targets]
        self.curves[FLAT] = [self.bench.flat(bits) for bits in self.flat_bits]
        for name in OURS:
            self.curves[name] = [self.at_error(name, kg) for kg in self.targets]

    def run_scalable(self):
        for kg in self.scalable_targets:
            for method in ("SSLPC", "STSLPC"):
                self.scalable.setdefault(method, []).append(
                    self.bench.run(method, self.settings(method, kg)))
            for name, (method, more) in self.variants.items():
                self.scalable.setdefault(name, []).append(
                    self.bench.run(name, self.settings(method, kg, more)))

    def layers_table(self):
        """Table 1. Returns it, and our layers."""
        info = self.bench.info(self.settings("SSLPC", 1), "--coarse")
        totals = [mesh["vertices"] for mesh in info["coarse_meshes"]]
        ours = [b - a for a, b in zip([0, *totals], totals)]
        columns = [published.CHICKEN.layers, published.COW.layers, ours]
        rows = []
        for layer in range(1, max(map(len, columns)) + 1):
            row = [str(layer)]
            for layers in columns:
                growth = published.growth(layers)[-layer] if layer <= len(layers) else None
                row += [str(layers[-layer]) if layer <= len(layers) else "",
                        f"{100 * growth:.1f} %" if growth else ""]
            rows.append(row)
        rows.append(["all", *(x for layers in columns for x in (str(sum(layers)), ""))])
        head = ["layer, from the finest"]
        for name in ("chicken, published", "cow, published", f"ours, {self.sequence.name}"):
            head += [name, "growth"]
        return report.Table("Table 1: vertices of each spatial layer", head, rows), ours

    def rates_table(self):
        """Rates at the errors of figure 5 (b), and at those of published numbers."""
        known = {kg: bpvf for bpvf, kg in published.cpca(self.model) if kg <= max(self.targets)}
        errors = sorted({*self.targets, *known}, reverse=True)
        rows = []
        for kg in errors:
            rates = {name: claims.rate_at(runs, kg) for name, runs in self.curves.items()}
            pair = [rates[name] for name in ("STSLPC", "SSLPC")]
            rows.append([f"{kg:g}", f"{kg * self.bench.norm:.4g}", report.number(known.get(kg)),
                         *map(report.number, rates.values()),
                         report.NOTHING if None in pair else claims.percent(pair[0] / pair[1], 1)])
        head = ["KG, %", "KG of frames, %", "CPCA, published", *self.curves, "STSLPC against SSLPC"]
        return report.Table("Figure 5 (b): bits per vertex and frame at a KG error", head, rows)

    def scalability_table(self):
        rows = []
        for name, runs in self.scalable.items():
            row = [name]
            for run, plain in zip(runs, self.scalable[name.split(",")[0]]):
                row += [f"{run.bpvf:.3f}", f"{run.kg:.4f}",
                        claims.percent(run.bpvf / plain.bpvf, 1)]
            rows.append(row)
        head = ["layers"]
        for kg in self.scalable_targets:
            head += [f"bpvf at {kg:.3g} %", "KG, %", "more"]
        title = "Scalability: bits per vertex and frame, and more than in a single layer"
        return report.Table(title, head, rows)

    def cuts(self):
        """Part of a stream that each spatial layer group takes."""
        settings = self.settings("SSLPC", self.lossless, ["--layer-groups", self.num_layers])
        info = self.bench.info(settings, "--coarse")
        vertices = [mesh["vertices"] for mesh in info["coarse_meshes"]]
        gof = info["gofs"][0]
        sizes = [0] * gof["num_layer_groups"]
        for part in gof["slices"]:
            sizes[part["layer_group_idx"]] += part["bytes"]
        rows, layers = [], 0
        for j, count in enumerate(gof["layer_group_size"]):
            layers += count
            rows.append([str(j + 1), str(layers), str(vertices[layers - 1]),
                         f"{100 * sum(sizes[:j + 1]) / sum(sizes):.1f} %",
                         f"{8 * sum(sizes[:j + 1]) / self.sequence.size:.3f}"])
        title = (f"Spatial layer groups at KG error {self.lossless} %: what a stream takes "
                 "that is cut after each")
        head = ["groups", "layers", "vertices", "of all frame bytes", "bpvf, of all vertices"]
        return report.Table(title, head, rows)

    def plot_curves(self):
        styles = {**{m: style[1:] for m, style in METHODS.items()}, FLAT: (FLAT_COLOUR, "solid"),
                  **{name: (colour, "solid") for name, (_, colour) in OURS.items()}}
        series = [paper.line(name, runs, *styles[name], width=2.8 if name in OURS else 2.0)
                  for name, runs in self.curves.items()]
        points = published.cpca(self.model)
        if points:
            series.append(paper.published_points("CPCA as published", points,
                                                 rlpca_published.CPCA_COLOUR))
        self.report.csv("curves.csv", *paper.curve_rows({**self.curves, **{
            name: runs for name, runs in self.scalable.items() if name in self.variants}}))
        self.heading("Figure 5 (b): rate and distortion")
        self.plot("curves", "rate and distortion, one group of frames", series)

    def make(self):
        self.run_curves()
        self.run_scalable()
        layers, ours = self.layers_table()
        temporal = temporal_cuts.table(temporal_cuts.TemporalCuts(self.bench, FRAMES),
                                       self.cut_targets)
        tables = [self.rates_table(), layers, self.scalability_table(), self.cuts(), temporal]
        self.tables(tables, f"{NOTE} {FLAT_NOTE}")
        for name, table in zip(("layers", "scalability", "cuts", "temporal"), tables[1:]):
            self.report.csv(f"{name}.csv", table.head, table.rows)
        self.plot_curves()
        for table in tables:
            self.heading(table.title)
            self.report.add(table)
        self.report.add(page.Text(NOTE))
        self.report.add(page.Text(FLAT_NOTE))
        if not self.is_known:
            self.report.add(page.Text(UNKNOWN_NOTE))
        items = sslpc_findings.claims_of_paper(self, ours)
        self.claims(items, "sslpc")
        self.report.save()
        return items


if __name__ == "__main__":
    paper.main("sslpc", __doc__, Reproduction)
