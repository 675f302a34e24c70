"""Checks the streams of an encoder against its inputs."""

import dataclasses
import math
import pathlib
import shlex
import shutil

import contract
import divergence
import rlpd
import sandbox
from grading import FAIL, NONE, NOT_RUN, PASS, Judgement
from mesh_input import Animation, InputError  # noqa: F401  (InputError: for `encode`)

INPUTS = pathlib.Path(__file__).resolve().parents[2] / "streams" / "inputs"
COLUMNS = (
    ("encodes", "encodes", "ends with exit code 0, and OUT is there"),
    ("valid", "valid", "the validator finds no error"),
    ("decodes", "decodes", "the reference decoder decodes it"),
    ("mesh", "mesh", "vertices, triangles and frames are those of the input"),
    ("error", "error", "no vertex is farther from the input than asked"),
)
PLACES = ("{mesh}", "{points}", "{out}", "{error}")
# Error bounds, as fractions of the diagonal of the first frame.
COARSE, FINE = 1 / 100, 1 / 2000
_ROUNDING = 1 + 1e-9  # for the rounding errors of sums


@dataclasses.dataclass
class Case:
    identity: str
    title: str
    animation: Animation
    max_error: float


def cases_of(folder, frames):
    """Each animation of the folder with two bounds, and its first frame alone."""
    cases = []
    for mesh in sorted(pathlib.Path(folder).glob("*.obj")):
        points = mesh.with_suffix(".pc2")
        if not points.is_file():
            continue
        clip = Animation(mesh, points, frames)
        still = Animation(mesh, points, 1)
        for name, animation, part in (("coarse", clip, COARSE), ("fine", clip, FINE),
                                      ("still", still, FINE)):
            bound = float(f"{part * animation.diagonal():.3g}")
            cases.append(Case(f"{mesh.stem}-{name}", f"{animation.num_frames} frame(s) of "
                              f"{animation.num_vertices} vertices, error at most {bound:g}",
                              animation, bound))
    return cases


def find_validator(encoder):
    """The command of rlpcval, next to the encoder or on the path; or None."""
    program = pathlib.Path(sandbox.command_words(encoder)[0])
    sibling = program.with_name("rlpcval")
    return shlex.quote(str(sibling)) if sibling.is_file() else shutil.which("rlpcval")


class Checker:
    """Checks cases one by one. validator may be None: streams are not validated."""

    def __init__(self, encoder, validator, reference, timeout):
        self._words = sandbox.command_words(encoder)
        missing = [place for place in PLACES if place not in encoder]
        if len(missing) == len(PLACES):
            self._words += ["encode", "{mesh}", "{points}", "{out}", "--max-error", "{error}"]
        elif missing:
            raise sandbox.CommandError(f"--encoder has no {', '.join(missing)}; either all of "
                                       f"{', '.join(PLACES)} are in it, or none")
        self._validator = sandbox.command_words(validator) if validator else None
        self._reference = sandbox.command_words(reference) if reference else divergence.SPECDEC
        self.reference_name = reference or "specdec"
        self._timeout = timeout

    def check(self, case, folder):
        """The judgement of one case; stops at the first failed check."""
        judgement = Judgement("PASS", cells={key: NOT_RUN for key, *_ in COLUMNS})
        stream = self._encode(case, folder, judgement)
        if stream is None:
            return judgement
        self._validate(stream, folder, judgement)
        decoded = self._decode(stream, folder, judgement)
        if decoded is not None:
            order = self._read_order(case, folder, judgement)
            if order is not None:
                self._compare(case, decoded, order, judgement)
        return judgement

    def _fail(self, judgement, column, text):
        judgement.cells[column] = FAIL
        if judgement.outcome == "PASS":
            judgement.outcome, judgement.reason, judgement.text = f"FAIL-{column}", column, text

    def _encode(self, case, folder, judgement):
        points, stream = folder / "in.pc2", folder / "out.rlpc"
        case.animation.write_points(points)
        names = {"{mesh}": str(case.animation.mesh.resolve()), "{points}": str(points),
                 "{out}": str(stream), "{error}": f"{case.max_error:g}",
                 "{order}": str(folder / "order")}
        words = [_filled(word, names) for word in self._words]
        done = sandbox.run(words, folder, self._timeout)
        judgement.seconds = done.seconds
        judgement.details.update({"exit": done.ending(), "command": shlex.join(words),
                                  "stderr": "\n".join(done.stderr.splitlines()[-8:])})
        if done.code is None or done.code < 0:
            judgement.outcome, judgement.reason, judgement.text = "CRASH", "end", done.ending()
            judgement.cells["encodes"] = FAIL
        elif done.code != 0:
            said = done.stderr.strip().splitlines()[-1:]
            self._fail(judgement, "encodes", ": ".join([done.ending(), *said]))
        elif not stream.is_file():
            self._fail(judgement, "encodes", "exit code 0, but OUT does not exist")
        else:
            judgement.cells["encodes"] = PASS
            judgement.details["size"] = f"{stream.stat().st_size} bytes"
            return stream
        return None

    def _validate(self, stream, folder, judgement):
        if self._validator is None:
            return
        done = sandbox.run([*self._validator, str(stream)], folder, self._timeout)
        judgement.cells["valid"] = PASS
        if done.code != 0:
            said = done.stdout.decode("utf-8", "replace") + done.stderr
            judgement.details["validator"] = said[-2000:]
            first = next(iter(said.strip().splitlines()), "")
            self._fail(judgement, "valid", f"validator: {done.ending()}: {first}")

    def _decode(self, stream, folder, judgement):
        output = folder / "out.rlpd"
        words = [*self._reference, "decode", str(stream), str(output)]
        done = sandbox.run(words, folder, 10 * self._timeout)
        if done.code == contract.DECODED and output.is_file():
            judgement.cells["decodes"] = PASS
            return output
        last = (done.stderr.strip().splitlines() or [""])[-1]
        self._fail(judgement, "decodes", f"{self.reference_name}: {done.ending()} {last}")
        return None

    def _read_order(self, case, folder, judgement):
        """The input index of each decoded vertex."""
        count = case.animation.num_vertices
        if not any("{order}" in word for word in self._words):
            return range(count)
        try:
            order = [int(word) for word in (folder / "order").read_text().split()]
        except (OSError, ValueError) as error:
            self._fail(judgement, "mesh", f"cannot read the file of {{order}}: {error}")
            return None
        if sorted(order) != list(range(count)):
            self._fail(judgement, "mesh",
                       "the file of {order} is not a permutation of the vertices")
            return None
        return order

    def _compare(self, case, decoded, order, judgement):
        animation = case.animation
        frames = len(rlpd.digest_of(decoded).frame_sha256)
        with rlpd.Reader(decoded) as reader:
            sizes = (reader.num_vertices, reader.num_triangles, frames)
            wanted = (animation.num_vertices, len(animation.triangles), animation.num_frames)
            if sizes != wanted:
                self._fail(judgement, "mesh", "%d vertices, %d triangles, %d frames" % sizes
                           + "; in the input %d, %d, %d" % wanted)
                return
            corners = [order[v] for v in reader.triangles()]
            if _turned(corners) != _turned([v for t in animation.triangles for v in t]):
                self._fail(judgement, "mesh", "the triangles differ from those of the input (are "
                           "the vertices in decoded order?)")
                return
            judgement.cells["mesh"] = PASS
            worst, frame, vertex = _largest_error(animation, reader, order)
        judgement.details["largest error"] = (f"{worst:.6g}, frame {frame}, vertex {vertex}; "
                                              f"bound {case.max_error:g}")
        judgement.cells["error"] = PASS
        if worst > case.max_error * _ROUNDING:
            self._fail(judgement, "error", f"{worst:.6g} at frame {frame}, vertex {vertex} of the "
                       f"input; asked for at most {case.max_error:g}")


def _filled(word, names):
    for place, value in names.items():
        word = word.replace(place, value)
    return word


def _turned(corners):
    """Triangles as a sorted list, each beginning with its lowest index."""
    result = []
    for i in range(0, len(corners), 3):
        a, b, c = corners[i:i + 3]
        result.append(min((a, b, c), (b, c, a), (c, a, b)))
    return sorted(result)


def _largest_error(animation, reader, order):
    """(distance, frame, input vertex) of the largest error."""
    step, origin = reader.header[7], reader.header[8:]
    worst = (-1.0, 0, 0)
    for f in range(animation.num_frames):
        expected, got = animation.frame(f), reader.frame(f)
        for v, source in enumerate(order):
            square = 0.0
            for c in range(3):
                value = math.ldexp(got[3 * v + c] + origin[c], step)
                square += (value - expected[3 * source + c]) ** 2
            worst = max(worst, (math.sqrt(square), f, source))
    return worst


def grade(rows, column):
    """A column as a grade (report.schema.json)."""
    key, label, _ = column
    states = [row["cells"][key] for row in rows if row["cells"][key] != NONE]
    passed, failed, left = (states.count(s) for s in (PASS, FAIL, NOT_RUN))
    status = "FAIL" if failed else "NOT RUN" if left or not states else "PASS"
    text = f"{passed} of {len(states)} cases passed"
    text += f", {failed} failed" if failed else ""
    text += f", {left} not run" if left else ""
    return {"grade": label, "status": status, "passed": passed, "failed": failed,
            "unsupported": 0, "not_run": left, "of": len(states), "text": text}
