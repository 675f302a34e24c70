#!/usr/bin/env python3
"""The tables and figures of the RLPCA paper, made with our tools; called by scripts/reproduce."""

import re

import paper  # first: it adds folders to sys.path
import page
import plots
import report
import rlpca_findings
import rlpca_paths
import rlpca_published as published
from paper import OURS

METHODS = {  # options besides N, L and the quantisers, and a colour (as in figure 6 (a))
    "PCA": (["--frame", "world", "--no-rdo"], "#8a8a8a"),
    "LPCA": (["--frame", "world", "--no-rdo"], "#009e73"),
    "RLPCA": (["--frame", "lcf", "--no-rdo"], "#0072b2"),
    "ORLPCA": (["--frame", "lcf", "--rdo-rate", "vectors"], "#d55e00"),
}
COMPONENTS = (2, 4, 6, 10, 15, 20, 30, 40)
PCA_COMPONENTS = (5, 10, 20, 30, 45, 60, 80, 100)
TARGETS = (3, 2, 1, 0.5, 0.3, 0.2, 0.1, 0.05)
CLUSTERS = {30: "solid", 20: "dashed", 10: "dashed"}  # and lines
COUNT_COLOURS = {10: "#d55e00", 20: "#009e73", 30: "#0072b2"}
SETTINGS = {(20, 10): "#009e73", (20, 20): "#0072b2", (10, 10): "#d55e00"}  # figure 6 (d)
BITS = 12

NOTE = (
    f"{BITS} bits for eigenshapes, coefficients and seed positions; the whole sequence is one "
    "group of frames; all bytes of the stream are counted. RLPCA: L components in every cluster; "
    "ORLPCA: L on average, by rate and distortion; both with the cheapest of the variants that the "
    "paper leaves open, or with distant vertices of a cluster in place of a triangle. Main and "
    "High: the profiles of this codec, to the error of RLPCA. Times are those of the tools, "
    "reading and checking included; published ones are those of a 2.5 GHz Pentium 4 (RLPCA) and an "
    "Athlon64 XP 3200+ (CPCA). The paper prints t_FPS, of display while decoding, in seconds; it "
    "is probably frames per second.")
COW_NOTE = (
    "The paper prints L = 20 in the second row of its cow, the setting of the row above at another "
    "rate; L = 10 is what the rates of both methods fit.")
QUICK_SETTINGS = ((30, 20), (30, 10), (10, 10))  # for the cow
FRAMES_SETTING = (10, 10)  # N, L of figure 6 (a)
MAX_COMPONENTS = 64  # in a search for a rate


PUBLISHED_HEAD = ("CPCA bpvf", "KG, %", "enc, s", "t_FPS", "RLPCA bpvf", "KG, %", "enc, s",
                  "dec, s")


def published_cells(row):
    return [*(report.NOTHING if x is None else f"{x:g}" for x in row.cpca),
            *(f"{x:g}" for x in (row.bpvf, row.kg, row.encode_seconds, row.decode_seconds))]


class Reproduction(paper.Paper):
    def __init__(self, bench, folder, quick):
        super().__init__("RLPCA", bench, folder, quick)
        self.curves = {}  # (method, N): runs

    def settings(self, method, clusters, components, bits=BITS):
        return ["--profile", "baseline", "--clusters", clusters, "--components", components,
                "--qu", bits, "--qc", bits, "--qdelta", BITS, *METHODS[method][0]]

    def run(self, method, clusters, components, bits=BITS):
        return self.bench.run(method, self.settings(method, clusters, components, bits), clusters,
                              components)

    def run_curves(self):
        frames = self.sequence.num_frames
        self.curves["PCA", 1] = [self.run("PCA", 1, n) for n in PCA_COMPONENTS[::self.step]
                                 if n <= frames]
        for method in ("LPCA", "RLPCA", "ORLPCA"):
            for clusters in CLUSTERS:
                self.curves[method, clusters] = [self.run(method, clusters, n)
                                                 for n in COMPONENTS[::self.step] if n <= frames]
        for name in OURS:
            self.curves[name, 0] = [self.at_error(name, kg) for kg in TARGETS[::self.step]]

    def at_rate(self, method, clusters, bpvf):
        """The run whose rate is nearest, of those with any number of components."""
        low, high = 1, min(MAX_COMPONENTS, self.sequence.num_frames)
        while high - low > 1:
            middle = (low + high) // 2
            if self.run(method, clusters, middle).bpvf < bpvf:
                low = middle
            else:
                high = middle
        return min((self.run(method, clusters, n) for n in (low, high)),
                   key=lambda run: max(run.bpvf / bpvf, bpvf / run.bpvf))

    def own_rows(self):
        """Rows of table 1 that are of this sequence."""
        return [row for row in published.TABLE if row.model is self.model]

    def settings_of_table(self):
        """(row, N, L): rows of this sequence; or settings of the paper that it has frames for."""
        own = self.own_rows()
        if own:
            return [(row, row.clusters, row.components) for row in own]
        return [(None, n, l) for n, l in (QUICK_SETTINGS if self.quick else published.settings())
                if l <= self.sequence.num_frames]

    def table(self):
        """Table 1. Returns what was run: published row or None, RLPCA, Main, High."""
        head = ["model", "N", "L", *PUBLISHED_HEAD]
        for name in ("RLPCA", "ORLPCA"):
            head += [f"our {name} bpvf", "KG, %", "KG of frames, %", "enc, s", "dec, s"]
        for name in OURS:
            head += [f"{name} bpvf", "KG, %"]
        rows, done = [], []
        for row, clusters, components in self.settings_of_table():
            plain, best = (self.run(m, clusters, components) for m in ("RLPCA", "ORLPCA"))
            main, high = (self.at_error(name, plain.kg) for name in OURS)
            done.append((row, plain, main, high))
            cells = [self.sequence.name, clusters, components,
                     *(published_cells(row) if row else [report.NOTHING] * len(PUBLISHED_HEAD))]
            for r in (plain, best):
                cells += [f"{r.bpvf:.3f}", f"{r.kg:.4f}", f"{r.frame_kg:.4f}",
                          f"{r.encode_seconds:.2f}", f"{r.decode_seconds:.2f}"]
            for r in (main, high):
                cells += [f"{r.bpvf:.3f}", f"{r.kg:.4f}"]
            rows.append([*map(str, cells)])
        return report.Table("Table 1", head, rows), done

    def other_rows(self):
        """Table 1, as published, of sequences that this one is not."""
        rows = [[row.model.name, str(row.clusters), str(row.components), *published_cells(row)]
                for row in published.TABLE if row.model is not self.model]
        return report.Table("Table 1 as published, other sequences",
                            ["model", "N", "L", *PUBLISHED_HEAD], rows)

    def tables_of_page(self):
        table, done = self.table()
        others = self.other_rows()
        self.heading("Table 1: rate, error and time")
        self.report.add(table)
        self.report.add(page.Text(NOTE))
        if self.model is published.COW:
            self.report.add(page.Text(COW_NOTE))
        self.heading(others.title)
        self.report.add(others)
        self.tables([table, others], NOTE)
        return done

    def plot_curves(self):
        self.report.csv("curves.csv", *paper.curve_rows(self.curves))
        series = []
        for (method, clusters), runs in self.curves.items():
            if clusters == 20:  # in figure 6 (f)
                continue
            name = f"{method}, N = {clusters}" if clusters > 1 else method
            colour = METHODS[method][1] if method in METHODS else OURS[method][1]
            series.append(paper.line(name, runs, colour, CLUSTERS.get(clusters, "solid"),
                                     2.0 if method in METHODS else 2.8))
        own = self.own_rows()
        if own:
            series += [paper.published_points("RLPCA as published", [(r.bpvf, r.kg) for r in own],
                                              METHODS["RLPCA"][1]),
                       paper.published_points("CPCA as published", [r.cpca[:2] for r in own],
                                              published.CPCA_COLOUR)]
        self.heading("Figure 6 (b), (c), (e): rate and distortion")
        self.plot("curves", "rate and distortion, one group of frames", series)
        self.heading("Figure 6 (f): number of clusters")
        self.plot("clusters", "number of clusters",
                  [paper.line(f"RLPCA, N = {n}", self.curves["RLPCA", n], COUNT_COLOURS[n])
                   for n in sorted(CLUSTERS)])

    def frames(self, name, heading, title, runs):
        """Figures of the error of each frame. runs: label, (method, N, L, colour). Returns the
        errors by label."""
        errors, series = {}, []
        for label, (method, clusters, components, colour) in runs.items():
            run = self.run(method, clusters, components)
            errors[label] = self.bench.frame_errors(self.settings(method, clusters, components))
            series.append(plots.Series(f"{label}: {run.bpvf:.2f} bpvf",
                                       list(enumerate(errors[label])), colour, marker="none"))
        self.report.csv(f"{name}.csv", ["frame", *(f"{x}_rms_error" for x in errors)],
                        [[f, *e] for f, e in enumerate(zip(*errors.values()))])
        self.heading(heading)
        self.plot(name, title, series, "frame", "RMS error, units", log_x=False, log_y=False)
        return errors

    def seeds(self):
        """Seed triangles of RLPCA, N = 10, as vertices of the input."""
        def use(stream, order, _):
            trace, _ = self.bench.call("rlpcinfo", stream, "--trace")
            input_vertex = [int(line) for line in order.read_text(encoding="utf-8").split()]
            found = [input_vertex[int(v)] for v in re.findall(r"seed_vertex = (\d+)", trace)]
            return list(zip(found[0::3], found[1::3], found[2::3]))
        return self.bench.encode(self.settings("RLPCA", 10, 10), use)

    def paths(self):
        """Figure 2."""
        found = rlpca_paths.paths(rlpca_paths.Positions(self.sequence), self.seeds())
        self.report.csv("paths.csv", ["vertex", "frame", "x", "y", "z", "local_x", "local_y",
                                      "local_z"],
                        [[path.vertex, f, *world, *local] for path in found
                         for f, (world, local) in enumerate(zip(path.world, path.local))])
        self.heading("Figure 2: paths of six vertices")
        for name, words in (("world", "world coordinates"), ("local", "local coordinates")):
            lines = rlpca_paths.projected([getattr(path, name) for path in found])
            series = [plots.Series(f"vertex {path.vertex}", line, colour, marker="none")
                      for path, line, colour in zip(found, lines, paper.COLOURS)]
            self.plot(f"paths_{name}", f"six vertices in {words}, widest axes", series, "", "",
                      log_x=False, log_y=False)
        return found

    def errors_of_methods(self):
        """Figure 6 (a): errors of each frame at equal N and L, and at equal rates. Returns both,
        and the runs of the second."""
        clusters, components = FRAMES_SETTING
        methods = ("LPCA", "RLPCA", "ORLPCA")
        equal = self.frames(
            "frames", f"Figure 6 (a): error of each frame, N = {clusters}, L = {components}",
            f"error of each frame, N = {clusters}, L = {components}",
            {m: (m, clusters, components, METHODS[m][1]) for m in methods})
        bpvf = self.run("RLPCA", clusters, components).bpvf
        runs = {m: self.at_rate(m, clusters, bpvf) for m in methods}
        rates = self.frames(
            "frames_rate", "Figure 6 (a): error of each frame at about the rate of RLPCA",
            f"error of each frame at about {bpvf:.2f} bpvf",
            {m: (m, clusters, runs[m].components, METHODS[m][1]) for m in methods})
        return equal, rates, runs

    def make(self):
        self.run_curves()
        done = self.tables_of_page()
        self.plot_curves()
        methods, rates, runs = self.errors_of_methods()
        settings = self.frames("frames_settings",
                               "Figure 6 (d): error of each frame, three settings (N, L)",
                               "error of each frame, RLPCA (N, L)",
                               {f"({n}, {l})": ("RLPCA", n, l, colour)
                                for (n, l), colour in SETTINGS.items()})
        paths = self.paths()
        items = rlpca_findings.claims_of_paper(self, methods, settings, paths)
        items += rlpca_findings.at_equal_rates(rates, runs)
        if self.own_rows():
            items += rlpca_findings.against_published(self, done)
        self.claims(items, "rlpca")
        self.report.save()
        return items


if __name__ == "__main__":
    paper.main("rlpca", __doc__, Reproduction)
