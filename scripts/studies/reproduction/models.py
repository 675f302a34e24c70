"""The animations of the papers, and how a sequence is recognised as one of them."""

import dataclasses

NEAR = 0.01  # relative: ratios of norms that are the same


@dataclasses.dataclass(frozen=True)
class Model:
    """norm: of its KG errors, that with the mean of each frame over that with one mean of all
    frames, which similar motions of other meshes do not have; None: not known. `printed`: other
    numbers of vertices and frames that papers print for it."""
    name: str
    num_vertices: int
    num_triangles: int
    num_frames: int
    norm: float = None
    printed: tuple = ()

    def is_like(self, num_vertices, num_triangles, num_frames, norm):
        sizes = ((self.num_vertices, self.num_frames), *self.printed)
        return ((num_vertices, num_frames) in sizes and num_triangles == self.num_triangles
                and (self.norm is None or abs(norm / self.norm - 1) <= NEAR))


# The paper on registration has a chicken of 3,029 vertices, and 100 frames of the dance.
CHICKEN = Model("chicken", 3030, 5664, 400, 6.28, ((3029, 400),))
COW = Model("cow", 2904, 5804, 204, 1.4666)
DANCE = Model("dance", 7061, 14118, 201, None, ((7061, 100),))
DOLPHIN = Model("dolphin", 6179, 12337, 101)
FACE = Model("face", 757, 1468, 952)
MODELS = (CHICKEN, COW, DANCE, DOLPHIN, FACE)


def model_of(num_vertices, num_triangles, num_frames, norm):
    """The model with these numbers; None: no paper has it."""
    return next((m for m in MODELS if m.is_like(num_vertices, num_triangles, num_frames, norm)),
                None)


def count_triangles(mesh):
    """Triangles of an OBJ file: polygons count as the triangles that they are cut into."""
    with open(mesh, encoding="utf-8", errors="replace") as file:
        faces = (words for words in map(str.split, file) if words[:1] == ["f"])
        return sum(len(words) - 3 for words in faces)


def how_recognised(model):
    """A sentence on a sequence with the numbers of a model."""
    if model.norm is None:
        return (f"This is taken for the {model.name} of the papers by its numbers of vertices, "
                "triangles and frames alone.")
    return (f"This is taken for the {model.name} of the papers by its numbers of vertices, "
            "triangles and frames, and by the ratio of both norms of its KG errors, "
            f"{model.norm:.4g}.")
