"""The first frame of an animation as a mesh: triangles, texture coordinates and normals, compared
with Draco."""

import dataclasses
import json
import math
import shutil
import subprocess

import gltf_file
import measure
import models
import report
import soup

POSITION_BITS, UV_BITS, NORMAL_BITS = 14, 12, 10
DRACO = ("-cl", "10", "-qp", f"{POSITION_BITS}", "-qt", f"{UV_BITS}", "-qn", f"{NORMAL_BITS}")

DEFINITIONS = (
    "Input: the first frame as OBJ file, as three.js computes it: positions, normals, the first "
    "set of texture coordinates; equal ones merged.",
    f"Draco: draco_encoder {' '.join(DRACO)}. Its connectivity: the file of the same mesh without "
    "attributes, shrunk so that all positions but one fall into one quantisation step. Its UV and "
    "normals: what the file shrinks by without both.",
    f"RLPC: rlpcenc --profile high --lossless {POSITION_BITS} --stored-normals exact --normal-bits "
    f"{NORMAL_BITS} --uv-bits N, N the fewest bits that make the step of UV at most a ninth larger "
    "than that of Draco, which divides the range of the coordinates; connectivity and attributes "
    "with the headers of their units. The grid of positions is that of --lossless: its step is a "
    "power of two, up to twice that of Draco.",
    "Errors, RLPC / Draco: the largest of texture coordinates, in steps of 1/4096 of an image; the "
    "largest angle between normals, in degrees, and what rlpcenc states of its own.")


@dataclasses.dataclass
class Mesh:
    """Contents of an OBJ file: values as words, corners as indices from 0 or None."""
    positions: list
    uv: list
    normals: list
    triangles: list  # three corners (position, uv, normal) each

    def words(self, positions=None, attributes=True):
        lines = ["v " + " ".join(p) for p in positions or self.positions]
        if attributes:
            lines += ["vt " + " ".join(t) for t in self.uv]
            lines += ["vn " + " ".join(n) for n in self.normals]
        return "\n".join(lines + ["f " + " ".join(_corner(c if attributes else (c[0], None, None))
                                                  for c in t) for t in self.triangles]) + "\n"

    def soup(self):
        corners = [c for t in self.triangles for c in t]

        def of(values, place, width):
            return [float(x) for c in corners for x in values[c[place]][:width]]
        return soup.Soup([of(self.positions, 0, 3)],
                         [of(self.normals, 2, 3)] if self.normals else [],
                         [of(self.uv, 1, 2)] if self.uv else [], [c[0] for c in corners], [])


def _corner(corner):
    v, t, n = ("" if i is None else f"{i + 1}" for i in corner)
    return f"{v}/{t}/{n}".rstrip("/")


def read_obj(path):
    mesh = Mesh([], [], [], [])
    lists = {"v": mesh.positions, "vt": mesh.uv, "vn": mesh.normals}
    for line in path.read_text(encoding="utf-8").splitlines():
        kind, *words = line.split() or [""]
        if kind in lists:
            lists[kind].append(words[:3])
        elif kind == "f":
            corners = [[int(i) - 1 if i else None for i in (*word.split("/"), "", "")[:3]]
                       for word in words]
            mesh.triangles.append(corners)
    return mesh


def mesh_of(drawn):
    """Mesh of the first sample: equal values are one, triangles without area are left out."""
    mesh = Mesh([], [], [], [])

    def index_of(values, width, corner, into, seen):
        words = tuple(f"{x + 0.0:.9g}" for x in values[width * corner:width * corner + width])
        if words not in seen:
            seen[words] = len(into)
            into.append(words)
        return seen[words]

    seen = {}, {}, {}
    for first in range(0, drawn.num_corners, 3):
        triangle = []
        for corner in range(first, first + 3):
            places = (drawn.positions[0], 3, mesh.positions), \
                (drawn.uv[0] if drawn.uv else None, 2, mesh.uv), \
                (drawn.normals[0] if drawn.normals else None, 3, mesh.normals)
            triangle.append([values and index_of(values, width, corner, into, known)
                             for (values, width, into), known in zip(places, seen)])
        if len({corner[0] for corner in triangle}) == 3:
            mesh.triangles.append(triangle)
    return mesh


def shrunk(mesh):
    """Its positions, all but the first so near to each other that they fall into one step of any
    quantiser, and yet differ."""
    numbers = [[float(x) for x in p] for p in mesh.positions]
    size = max(map(abs, (x for p in numbers for x in p)))
    return [["1", "1", "1"], *([f"{x / size * 2 ** -30:.9g}" for x in p] for p in numbers[1:])]


def draco_uv_step(mesh):
    spans = [max(column) - min(column)
             for column in zip(*([float(x) for x in t[:2]] for t in mesh.uv))]
    return max(spans) / (2 ** UV_BITS - 1)


def uv_bits(mesh):
    """The fewest that make steps at most 2^0.15, a ninth, larger than those of Draco."""
    return min(max(math.ceil(-math.log2(draco_uv_step(mesh)) - 0.15), 1), 16)


@dataclasses.dataclass
class Sizes:
    """In bytes."""
    connectivity: int
    attributes: int
    file: int
    uv_error_steps: float
    normal_error_degrees: float
    stated_normal_error: float = None  # reported by rlpcenc

    @property
    def both(self):
        return self.connectivity + self.attributes


class Bench:
    """`folder`: for files, which are kept."""

    def __init__(self, toolbox, packages, folder, say):
        self.toolbox, self.packages, self.folder, self.say = toolbox, packages, folder, say
        for program in ("draco_encoder", "draco_decoder"):
            if shutil.which(program) is None:
                raise measure.Failure(f"needs {program}; run scripts/setup --compare")

    def measure(self, path):
        """(vertices, triangles, bits of UV or None, Sizes of RLPC, of Draco)"""
        folder = self.folder / path.stem
        folder.mkdir(parents=True, exist_ok=True)
        mesh = self.first_frame(path, folder)
        (folder / "mesh.obj").write_text(mesh.words(), encoding="utf-8")
        bits = uv_bits(mesh) if mesh.uv else None
        drawn = mesh.soup()
        ours, theirs = self.ours(folder, bits, drawn), self.draco(folder, mesh, drawn)
        self.say(f"{path.stem}: {ours.both} bytes, Draco {theirs.both}")
        return len(mesh.positions), len(mesh.triangles), bits, ours, theirs

    def first_frame(self, path, folder):
        source = gltf_file.as_glb(path, folder)
        drawn = soup.sample(self.packages, source, [(0, 0)], folder)
        return mesh_of(drawn)

    def ours(self, folder, bits, drawn):
        stream = folder / "mesh.rlpc"
        said = json.loads(models.run(
            self.toolbox, "rlpcenc", folder / "mesh.obj", "--profile", "high", "--lossless",
            POSITION_BITS, "--stored-normals", "exact", "--normal-bits", NORMAL_BITS,
            *(("--uv-bits", bits) if bits else ()), "--json", "-o", stream))
        models.run(self.toolbox, "rlpcdec", stream, "--quiet", "-o", folder / "ours_%d.obj")
        return Sizes(said["bits"]["connectivity"] // 8, said["bits"]["attributes"] // 8,
                     stream.stat().st_size, *errors(drawn, next(folder.glob("ours_*.obj"))),
                     next((a["largest_error_degrees"] for a in said.get("attributes", ())
                           if a["name"] == "normal"), None))

    def draco(self, folder, mesh, drawn):
        def size(name, words, *options):
            obj, file = folder / f"{name}.obj", folder / f"{name}.drc"
            obj.write_text(words, encoding="utf-8")
            subprocess.run(["draco_encoder", *DRACO, *options, "-i", obj, "-o", file], check=True,
                           capture_output=True)
            return file.stat().st_size
        whole = size("draco", mesh.words())
        bare = size("draco-bare", mesh.words(attributes=False))
        connectivity = size("draco-shrunk", mesh.words(shrunk(mesh), attributes=False))
        decoded = folder / "draco-decoded.obj"
        subprocess.run(["draco_decoder", "-i", folder / "draco.drc", "-o", decoded], check=True,
                       capture_output=True)
        return Sizes(connectivity, whole - bare, whole, *errors(drawn, decoded))


def errors(drawn, path):
    """Largest error of texture coordinates and normals."""
    decoded = read_obj(path).soup()
    found, _ = soup.match(drawn, decoded)
    angles = soup.normal_errors_degrees(drawn, decoded, found, 0)
    return soup.uv_error_steps(drawn, decoded, found), angles and angles[-1]


def table(measured):
    """`measured`: (name, what Bench.measure() returns)."""
    rows, ratios = [], []
    for name, (vertices, triangles, bits, ours, theirs) in measured:
        ratios.append(ours.both / theirs.both)
        rows.append([name, f"{vertices}", f"{triangles}", f"{bits or report.NOTHING}",
                     f"{ours.connectivity} + {ours.attributes} = {ours.both}",
                     f"{theirs.connectivity} + {theirs.attributes} = {theirs.both}",
                     report.percent(100 * (ratios[-1] - 1)), f"{ours.file} / {theirs.file}",
                     _pair(ours.uv_error_steps, theirs.uv_error_steps),
                     report.number(ours.stated_normal_error, 2),
                     _pair(ours.normal_error_degrees, theirs.normal_error_degrees)])
    mean = math.exp(math.fsum(map(math.log, ratios)) / len(ratios))
    rows.append(["geometric mean", *[""] * 5, report.percent(100 * (mean - 1)), *[""] * 4])
    return report.Table(
        "Connectivity + UV and normals, bytes",
        ["model", "vertices", "triangles", "--uv-bits", "RLPC", "Draco", "RLPC", "whole files",
         "UV error", "stated",
         "normals, degrees"], rows)


def _pair(ours, theirs):
    return report.NOTHING if ours is None and theirs is None else \
        f"{report.number(ours, 2)} / {report.number(theirs, 2)}"
