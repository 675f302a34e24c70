"""The animations to compare on: anything rlpcenc reads, as OBJ file and point cache."""

import dataclasses
import pathlib
import re
import shutil
import subprocess

import measure

READERS = pathlib.Path(__file__).resolve().parents[3] / "encoder" / "meshes"
_FORMAT = re.compile(r"^const InputFormat k\w+\{\s*\.holds = InputFormat::Holds::k(\w+),\s*"
                     r"\.extensions = (\w+),", re.MULTILINE)


def extensions(holds):
    """Extensions of the formats of rlpcenc that hold this, as its readers define them."""
    found = []
    for path in sorted(READERS.glob("*/*.cpp")):
        text = path.read_text(encoding="utf-8")
        for array in [m[2] for m in _FORMAT.finditer(text) if m[1] == holds]:
            values = re.search(rf"\b{array}\{{([^}}]*)\}}", text)[1]
            found += re.findall(r'"(\.\w+)"', values)
    return tuple(found)


MESHES = extensions("Mesh")
CACHES = extensions("Points")
WHOLE = extensions("Animation")  # the animation is one file
GLTF = (".glb", ".gltf")
_WILD = re.compile(r"[%*?\[]")


@dataclasses.dataclass(frozen=True)
class Input:
    name: str
    path: pathlib.Path
    points: pathlib.Path = None  # point cache; None: `path` holds the frames

    @property
    def is_pair(self):
        """Every codec reads it as it is."""
        return self.path.suffix == ".obj" and self.points and self.points.suffix == ".pc2"

    @property
    def is_gltf(self):
        return self.path.suffix.lower() in GLTF


def _cache_of(mesh):
    return next((mesh.with_suffix(s) for s in CACHES if mesh.with_suffix(s).is_file()), None)


def _of_folder(folder):
    """Meshes with caches, or else whole animations, or else one animation, a mesh per frame."""
    files = sorted(p for p in folder.iterdir() if p.is_file())
    meshes = [p for p in files if p.suffix.lower() in MESHES]
    pairs = [Input(p.stem, p, _cache_of(p)) for p in meshes if _cache_of(p)]
    whole = [Input(p.stem, p) for p in files if p.suffix.lower() in WHOLE]
    if not pairs and not whole and not meshes:
        raise measure.Failure(f"{folder}: holds no mesh, glTF or .rlpd files")
    return pairs or whole or [Input(folder.resolve().name, folder)]


def _of_file(path, rest):
    suffix = path.suffix.lower()
    if not path.is_file():
        raise measure.Failure(f"{path}: no such file")
    if suffix in WHOLE:
        return Input(path.stem, path)
    if suffix in CACHES:
        raise measure.Failure(f"{path}: is a point cache; name its mesh before it")
    points = (pathlib.Path(rest.pop(0)) if rest and pathlib.Path(rest[0]).suffix.lower() in CACHES
              else _cache_of(path))
    if points is None:
        raise measure.Failure(f"{path}: is one frame; name its point cache "
                              f"({', '.join(CACHES)}) after it")
    if not points.is_file():
        raise measure.Failure(f"{points}: no such file")
    return Input(path.stem, path, points)


def find(words):
    """The inputs named by the words of a command line."""
    found, rest = [], list(words)
    while rest:
        path = pathlib.Path(rest.pop(0))
        if path.is_dir():
            found += _of_folder(path)
        elif _WILD.search(path.name) and not path.exists():
            name = _WILD.split(path.name)[0].rstrip("_-. ")
            found.append(Input(name or path.resolve().parent.name, path))
        else:
            found.append(_of_file(path, rest))
    names = [i.name for i in found]
    for name in names:
        if names.count(name) > 1:
            raise measure.Failure(f"two inputs are called {name}")
    return found


def open_all(found, toolbox, folder, gltf_options=()):
    """A Sequence of each. All but pairs are converted to pairs, in `folder`."""
    if gltf_options and not any(i.is_gltf for i in found):
        raise measure.Failure(f"{gltf_options[0]}: no input is a glTF file")
    return [measure.open_sequence(i.path, i.points) if i.is_pair else
            _convert(i, toolbox, folder, gltf_options if i.is_gltf else ()) for i in found]


def _convert(found, toolbox, folder, options):
    tool = toolbox.path("peer_codec")
    if tool is None:
        raise measure.Failure(f"{found.path}: needs peer_codec to convert it, which "
                              f"{toolbox.not_there('peer_codec')}")
    target = folder / found.name
    shutil.rmtree(target, ignore_errors=True)
    target.mkdir(parents=True)
    points = target / f"{found.name}.pc2"
    words = [found.path, *(("--points", found.points) if found.points else ()), *options]
    done = subprocess.run([tool, "convert", *map(str, words), "-o", points], capture_output=True,
                          text=True, check=False)
    if done.returncode != 0:
        raise measure.Failure(done.stderr.strip().removeprefix("peer_codec: "))
    return measure.open_sequence(points.with_suffix(".obj"), points)
