#!/usr/bin/env python3
"""Tests rlpccmp against the definitions written down a second time, vertex by vertex: STED
as its authors' program has it, the edge difference in one ring, both norms of the KG error, and
both kinds of PSNR."""

import csv
import math
import random
import statistics

from tools_testing import ToolsTest, main, read_pc2, squared_angles, write_obj, write_pc2

DT, WEIGHT = 0.0003, 9.144e-5  # STED
BEFORE, AFTER = 5, 4  # steps of its window
SEEDS = range(1, 41)


def points(frame):
    return [tuple(frame[i:i + 3]) for i in range(0, len(frame), 3)]


def deviation(values):
    """Weighted deviation of (weight, value)."""
    total = math.fsum(w for w, _ in values)
    if total == 0:
        return 0.0
    mean = math.fsum(w * x for w, x in values) / total
    return math.sqrt(math.fsum(w * (x - mean) ** 2 for w, x in values) / total)


def edges_of(triangles):
    return {frozenset(pair) for t in triangles
            for pair in ((t[0], t[1]), (t[1], t[2]), (t[2], t[0]))
            if pair[0] != pair[1]}


def diagonal(*frames):
    axes = list(zip(*(p for frame in frames for p in frame)))
    return math.dist([min(a) for a in axes], [max(a) for a in axes])


def sted_spatial(triangles, a, b):
    """Spatial part of two frames: signed differences, edges of a vertex and of its neighbours."""
    edges = edges_of(triangles)
    found = []
    for v in range(len(a)):
        near = {v}.union(*(e for e in edges if v in e))
        values = []
        for edge in edges:
            if edge & near:
                i, j = edge
                before, after = math.dist(a[i], a[j]), math.dist(b[i], b[j])
                values.append((before, (before - after) / before if before else 0.0))
        found.append(deviation(values))
    return statistics.fmean(found)


def sted_temporal(a, b):
    """[step]. a, b: frames."""
    size = diagonal(a[0]) or 1.0

    def steps(frames):
        return [[math.sqrt((math.dist(p, q) / size) ** 2 + DT ** 2) for p, q in zip(f, g)]
                for f, g in zip(frames, frames[1:])]
    s, other = steps(a), steps(b)
    return [statistics.fmean(
        abs(s[f][v] - other[f][v])
        / statistics.fmean(s[k][v] for k in range(len(s)) if f - BEFORE <= k <= f + AFTER)
        for v in range(len(a[0]))) for f in range(len(s))]


def ring_spatial(triangles, a, b):
    """Unsigned differences, edges of a vertex."""
    edges = edges_of(triangles)
    found = []
    for v in range(len(a)):
        values = []
        for i, j in (tuple(e) for e in edges if v in e):
            before, after = math.dist(a[i], a[j]), math.dist(b[i], b[j])
            if before:
                values.append((before, abs(before - after) / before))
        found.append(deviation(values))
    return statistics.fmean(found)


def mean_vertex(frame):
    return [math.fsum(axis) / len(frame) for axis in zip(*frame)]


def squares(frame, centre):
    return math.fsum(math.dist(p, centre) ** 2 for p in frame)


class Metrics(ToolsTest):
    def animation(self, seed):
        """A random mesh and two animations of it, as they are in files: edges with any number of
        triangles, vertices without any, the mean vertex moving or at rest."""
        rng = random.Random(seed)
        count, num_frames = rng.randint(3, 14), rng.choice((1, 2, 3, 6, 15))
        triangles = [tuple(rng.sample(range(count), 3)) for _ in range(rng.randint(1, 16))]
        shape = [rng.uniform(-1, 1) for _ in range(3 * count)]
        motion = rng.choice((0.0, 0.1, 3.0))
        noise = rng.choice((1e-3, 0.1))
        originals, decoded = [], []
        drift = [0.0] * 3
        for _ in range(num_frames):
            drift = [x + rng.uniform(-motion, motion) for x in drift]
            frame = [x + drift[i % 3] + rng.uniform(-0.1, 0.1) * (motion > 0)
                     for i, x in enumerate(shape)]
            originals.append(frame)
            decoded.append([x + rng.gauss(0, noise) for x in frame])
        write_obj(self.path("a.obj"), originals[0], triangles)
        write_pc2(self.path("a.pc2"), originals)
        write_pc2(self.path("b.pc2"), decoded)
        return (triangles, *([points(f) for f in read_pc2(self.path(name))]
                             for name in ("a.pc2", "b.pc2")))

    def compared(self):
        """Report, and columns of the CSV."""
        inputs = (self.path("a.obj"), "--points-a", self.path("a.pc2"), self.path("a.obj"),
                  "--points-b", self.path("b.pc2"), "-q")
        report = self.ok("rlpccmp", *inputs, "--json").json()
        self.ok("rlpccmp", *inputs, "--csv", self.path("a.csv"))
        with open(self.path("a.csv"), newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        return report, {name: [float(row[name]) for row in rows] for name in rows[0]}

    def near(self, found, expected, what):
        self.assertLessEqual(abs(found - expected), 1e-9 * abs(expected) + 1e-9, what)

    def test_random_meshes(self):
        for seed in SEEDS:
            with self.subTest(seed=seed):
                triangles, a, b = self.animation(seed)
                report, columns = self.compared()
                self.check_sted(triangles, a, b, report["surface"], columns)
                self.check_ring(triangles, a, b, report["surface"], columns)
                self.check_normals(triangles, a, b, report["surface"], columns)
                self.check_errors(a, b, report["metrics"])
                self.check_psnr(a, b, report["metrics"], columns)

    def check_sted(self, triangles, a, b, surface, columns):
        spatial = [sted_spatial(triangles, f, g) for f, g in zip(a, b)]
        temporal = sted_temporal(a, b)
        for found, expected in zip(columns["sted_spatial"], spatial, strict=True):
            self.near(found, expected, "spatial")
        for found, expected in zip(columns["sted_temporal"], [0.0, *temporal], strict=True):
            self.near(found, expected, "temporal")
        parts = statistics.fmean(spatial), statistics.fmean(temporal or [0.0])
        self.near(surface["sted_spatial"], parts[0], "spatial")
        self.near(surface["sted_temporal"], parts[1], "temporal")
        self.near(surface["sted"], math.hypot(parts[0], WEIGHT * parts[1]), "STED")
        self.assertEqual((surface["sted_dt"], surface["sted_c"]), (DT, WEIGHT))

    def check_ring(self, triangles, a, b, surface, columns):
        spatial = [ring_spatial(triangles, f, g) for f, g in zip(a, b)]
        for found, expected in zip(columns["ring_edge_difference_spatial"], spatial, strict=True):
            self.near(found, expected, "ring")
        temporal = columns["ring_edge_difference_temporal"]
        part = math.fsum(temporal) / max(len(a) - 2, 1)
        self.near(surface["ring_edge_difference"], math.hypot(statistics.fmean(spatial), part),
                  "ring")

    def check_normals(self, triangles, a, b, surface, columns):
        found = [squared_angles(triangles, f, g) for f, g in zip(a, b)]
        for rms, (total, area, _) in zip(columns["vertex_normal_rms_degrees"], found, strict=True):
            self.near(rms, math.sqrt(total / area) if area else 0.0, "vertex normals")
        area = math.fsum(area for _, area, _ in found)
        whole = math.sqrt(math.fsum(total for total, _, _ in found) / area) if area else 0.0
        self.near(surface["vertex_normal_rms_degrees"], whole, "vertex normals")
        changes, areas = [], []
        for (_, _, before), (_, _, after) in zip(found, found[1:]):
            changes += [math.degrees(math.dist(e, d)) ** 2 * w
                        for (e, _), (d, w) in zip(before, after)]
            areas += [w for _, w in after]
        whole = math.sqrt(math.fsum(changes) / math.fsum(areas)) if any(areas) else 0.0
        self.near(surface["normal_flicker_rms_degrees"], whole, "flicker")
        self.assertEqual(columns["normal_flicker_rms_degrees"][0], 0)

    def check_errors(self, a, b, metrics):
        error = math.fsum(math.dist(p, q) ** 2 for f, g in zip(a, b) for p, q in zip(f, g))
        everything = [p for frame in a for p in frame]
        by_frame = math.fsum(squares(f, mean_vertex(f)) for f in a)
        overall = squares(everything, mean_vertex(everything))
        self.near(metrics["kg_error_percent"], 100 * math.sqrt(error / by_frame), "KG")
        self.near(metrics["kg_sequence_error_percent"], 100 * math.sqrt(error / overall), "KG")
        self.near(metrics["rms_spread"], math.sqrt(by_frame / len(everything)), "spread")
        self.near(metrics["rms_sequence_spread"], math.sqrt(overall / len(everything)), "spread")

    def check_psnr(self, a, b, metrics, columns):
        size = diagonal(*a)
        self.near(metrics["diagonal_psnr_db"], 20 * math.log10(size / metrics["rms_error"]), "PSNR")
        moved = [len(a[0])] + [sum(p != q for p, q in zip(f, g)) or len(f)
                               for f, g in zip(a, a[1:])]
        peak = max((math.dist(p, q) for f, g in zip(a, a[1:]) for p, q in zip(f, g)), default=0)
        ramanathan = []
        for f, g, count in zip(a, b, moved):
            error = math.fsum(math.dist(p, q) ** 2 for p, q in zip(f, g))
            ramanathan.append(-10 * math.log10(error / (3 * count * (peak or size) ** 2)))
        for found, expected in zip(columns["ramanathan_psnr_db"], ramanathan, strict=True):
            self.near(found, expected, "Ramanathan's PSNR")
        self.near(metrics["ramanathan_psnr_db"], statistics.fmean(ramanathan), "Ramanathan's PSNR")

    def test_a_bundled_animation(self):
        """The whole of one frame with the noise of another scale, so that edges of all lengths
        count."""
        triangles, (first, second) = self.clip(2)
        write_obj(self.path("a.obj"), first, triangles)
        write_pc2(self.path("a.pc2"), [first])
        write_pc2(self.path("b.pc2"), [second])
        report, _ = self.compared()
        self.assertGreater(report["surface"]["sted"], 0)
        self.near(report["surface"]["sted"], sted_spatial(triangles, points(first),
                                                          points(second)), "STED")

    def test_the_report_names_what_it_prints(self):
        self.animation(5)
        said = self.ok("rlpccmp", self.path("a.obj"), "--points-a", self.path("a.pc2"),
                       self.path("a.obj"), "--points-b", self.path("b.pc2")).out.decode()
        report, _ = self.compared()
        metrics, surface = report["metrics"], report["surface"]
        for words in (f"KG error  {metrics['kg_error_percent']:.4g} %, mean of each frame; "
                      f"{metrics['kg_sequence_error_percent']:.4g} %, one mean of all frames\n",
                      f"PSNR      {metrics['diagonal_psnr_db']:.2f} dB of the diagonal; "
                      f"{metrics['ramanathan_psnr_db']:.2f} dB, Ramanathan's, mean of frames\n",
                      f"STED      {surface['sted']:.6g} (",
                      f"ring      {surface['ring_edge_difference']:.6g}, edge difference in one"):
            self.assertIn(words, said)


if __name__ == "__main__":
    main()
