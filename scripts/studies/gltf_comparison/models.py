"""Compares glTF files with gltfpack: bytes, errors of positions, uv and normals; seams."""

import dataclasses
import json
import pathlib
import subprocess

import gltf_file
import measure
import paths
import report
import soup

SAMPLES = 9  # frames that three.js draws, besides the one in the middle
HERE = pathlib.Path(__file__).resolve().parent
PACKED = "gltfpack"
# {kg}: the KG error of gltfpack's file.
KG = ("--kg", "0.1")
SETTINGS = {"default": KG, "high": (*KG, "--profile", "high"), "all": (*KG, "--gof", "all"),
            "equal": ("--kg", "{kg:.6g}"), "equal-high": ("--profile", "high", "--kg", "{kg:.6g}")}
TITLES = {"default": "RLPC", "high": "High", "all": "--gof all", "equal": "RLPC, equal KG",
          "equal-high": "High, equal KG"}

DEFINITIONS = (
    "kB: 1000 bytes, of whole files: all clips, attributes, materials and images. gltfpack: "
    "`gltfpack -cz`, then brotli -q 11. RLPC: `rlpcenc --animation all --fps 30 --kg 0.1`; "
    "High: with --profile high, which is in preparation; equal KG: with --kg and the error of "
    "gltfpack's file.",
    "KG error: 100 * ||B - B'|| / ||B - E(B)||, B the positions of all vertices in all frames at "
    "30 frames a second, E(B) the mean vertex of each frame, by rlpccmp. gltfpack reorders and "
    "merges vertices: each vertex of the source is compared with that of gltfpack's file whose "
    f"path is nearest in {paths.SAMPLES} frames, at the same time of the same clip.",
    "What is drawn: the corners of all triangles, as three.js computes them from the source and "
    f"from the decoded .glb in {SAMPLES} frames spread over all clips, and the one in the middle; "
    "each triangle of the source is compared with the one whose corners move most alike. Its KG "
    "error weights vertices by their triangles, and includes what a skin differs from the stream.",
    "UV: the largest error of a texture coordinate, in steps of 1/4096 of an image. Normals: "
    "angle to those of the source; mean / 99th percentile / largest, in degrees, in the first "
    "frame; in the middle frame.",
    "Seams: groups of source vertices that coincide in the first frame; of these, those that the "
    "source keeps closed in all drawn frames; of these, those that the decoded file keeps closed "
    f"({soup.COINCIDENT:g} of the diagonal); the largest gap, in per cent of the diagonal.")


@dataclasses.dataclass
class File:
    """Result of one codec for a model."""
    bytes: int
    kg_error_percent: float
    drawn: dict = None  # what measure_drawn() returns


@dataclasses.dataclass
class Model:
    name: str
    source_bytes: int
    num_vertices: int
    num_frames: int
    num_clips: int
    files: dict  # keys: PACKED and the names of SETTINGS


def run(toolbox, tool, *words, good=(0,)):
    done = subprocess.run([toolbox.path(tool), *map(str, words)], capture_output=True, text=True,
                          check=False)
    if done.returncode not in good:
        raise measure.Failure(f"{tool}: {done.stderr.strip()}")
    return done.stdout


def convert(toolbox, glb, folder, *options):
    """The animation as mesh and point cache, all clips joined, and its clips."""
    points = folder / f"{glb.stem}.pc2"
    run(toolbox, "peer_codec", "convert", glb, "--animation", "all", "--fps", gltf_file.FPS,
        *options, "-o", points)
    clips = gltf_file.clips(glb)
    sequence = measure.open_sequence(points.with_suffix(".obj"), points)
    expected = sum(clip.num_frames for clip in clips)
    if sequence.num_frames != expected:
        raise measure.Failure(f"{glb.name}: {sequence.num_frames} frames, not {expected}")
    return sequence, clips


def brotli_bytes(path):
    return len(subprocess.run(["brotli", "-q", "11", "-c", path], capture_output=True,
                              check=True).stdout)


def kg_of(toolbox, *words):
    return json.loads(run(toolbox, "rlpccmp", *words, "--json"))["metrics"]["kg_error_percent"]


def measure_drawn(source, other):
    found, alternatives = soup.match(source, other)
    return {"kg_error_percent": soup.kg_error_percent(source, other, found),
            "uv_error_steps": soup.uv_error_steps(source, other, found),
            "normals_first_frame": soup.normal_errors_degrees(source, other, found, 0),
            "normals_middle_frame": soup.normal_errors_degrees(source, other, found, 1),
            "same_clip_names": source.clips == other.clips,
            **dataclasses.asdict(soup.cracks(source, other, found, alternatives))}


class Bench:
    """Measures models. `folder`: for files, which are kept."""

    def __init__(self, toolbox, packages, folder, say, settings=("default", "high")):
        self.toolbox, self.packages, self.folder = toolbox, packages, folder
        self.say, self.settings = say, settings

    def measure(self, path):
        folder = self.folder / path.stem
        folder.mkdir(parents=True, exist_ok=True)
        source = gltf_file.as_glb(path, folder)
        sequence, clips = convert(self.toolbox, source, folder)
        samples = gltf_file.frame_samples(clips, SAMPLES)
        drawn = soup.sample(self.packages, source, samples, folder)
        files = {PACKED: self.packed(path, sequence, clips, folder)}
        files[PACKED].drawn = measure_drawn(drawn, soup.sample(
            self.packages, folder / f"{PACKED}.glb", samples, folder))
        for setting in self.settings:
            options = [word.format(kg=files[PACKED].kg_error_percent)
                       for word in SETTINGS[setting]]
            files[setting], glb = self.ours(path, setting, options, sequence, folder)
            files[setting].drawn = measure_drawn(
                drawn, soup.sample(self.packages, glb, samples, folder))
        sequence.points.unlink()
        return Model(path.stem, gltf_file.source_bytes(path), sequence.num_vertices,
                     sequence.num_frames, len(clips), files)

    def packed(self, path, sequence, clips, folder):
        packed, plain = folder / f"{PACKED}.glb", folder / f"{PACKED}-plain.glb"
        self.packages.gltfpack("-cz", "-i", path, "-o", packed)
        size = brotli_bytes(packed)
        # The same values in the older form, which three.js and our reader understand.
        self.packages.gltfpack("-cz", "-ce", "ext", "-i", path, "-o", packed)
        self.packages.node(HERE / "unpack.mjs", self.packages.three, packed, plain)
        other, other_clips = convert(self.toolbox, plain, folder)
        matched = folder / "matched.pc2"
        with paths.PointCache(sequence.points) as a, paths.PointCache(other.points) as b:
            frames = paths.joined_frames(clips, other_clips)
            paths.write_matched(a, b, frames, paths.nearest(a, b, frames), matched)
        kg = kg_of(self.toolbox, sequence.mesh, "--points-a", sequence.points, sequence.mesh,
                   "--points-b", matched)
        matched.unlink()
        other.points.unlink()
        self.say(f"{path.stem}, gltfpack: {size} bytes, KG error {kg:.4f} %")
        return File(size, kg)

    def ours(self, path, setting, options, sequence, folder):
        """The file, and the path of the decoded .glb."""
        stream, order = folder / f"{setting}.rlpc", folder / f"{setting}.order"
        run(self.toolbox, "rlpcenc", path, "--animation", "all", "--fps", gltf_file.FPS,
            *options, "-o", stream, "--order-map", order, "--quiet",
            good=(0, 2))
        glb = folder / f"{setting}.glb"
        run(self.toolbox, "rlpcdec", stream, "-o", glb, "--quiet")
        kg = kg_of(self.toolbox, sequence.mesh, "--points-a", sequence.points, stream,
                   "--order-map", order)
        size = stream.stat().st_size
        self.say(f"{path.stem}, {TITLES[setting]}: {size} bytes, KG error {kg:.4f} %")
        return File(size, kg), glb


def _kb(size):
    return f"{size / 1000:.1f}"


def _normals(angles):
    return report.NOTHING if angles is None else " / ".join(report.number(a, 2) for a in angles)


def sizes_table(models):
    settings = [s for s in SETTINGS if s in models[0].files]
    head = ["model", "clips", "source, kB"]
    for title in ("gltfpack + brotli", *(TITLES[s] for s in settings)):
        head += [f"{title}, kB", "KG, %"]
    rows = []
    for model in models:
        row = [model.name, f"{model.num_clips}", _kb(model.source_bytes)]
        for name in (PACKED, *settings):
            file = model.files[name]
            row += [_kb(file.bytes), report.number(file.kg_error_percent)]
        rows.append(row)
    return report.Table("Bytes and KG error", head, rows)


def drawn_table(models):
    rows = []
    for model in models:
        for name, file in model.files.items():
            drawn = file.drawn
            rows.append([
                model.name, TITLES.get(name, name), report.number(drawn["kg_error_percent"]),
                report.number(drawn["uv_error_steps"], 2),
                _normals(drawn["normals_first_frame"]), _normals(drawn["normals_middle_frame"]),
                f"{drawn['groups']}", f"{drawn['together']}", f"{drawn['closed']}",
                report.number(drawn["largest_gap_percent"], 2)])
    return report.Table(
        "What is drawn", ["model", "codec", "KG, %", "UV, 1/4096", "normals, first frame",
                          "normals, middle", "seams", "closed in source", "closed", "gap, %"], rows)
