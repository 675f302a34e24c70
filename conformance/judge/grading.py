"""Grades a decoding: an outcome, and a cell for each grade."""

import dataclasses
import tempfile

import divergence
import rlpd
from contract import DECODED, LIMIT, REJECTED, UNSUPPORTED

COLUMNS = (
    ("int", "int", "decodes to the right integers"),
    ("full", "full", "decodes to the right 32-bit floats"),
    ("strict", "strict", "is refused, after exactly the frames before the error"),
    ("diagnostic", "diagnostic", "is refused for the right rule"),
    ("attributes", "rlpa", "decodes to the right attributes, or is refused for them"),
)
# Grade: the columns that it takes.
GRADES = {"R-int": ("int",), "R-full": ("int", "full"), "R-strict": ("int", "strict"),
          "R-diagnostic": ("int", "strict", "diagnostic"), "R-attributes": ("attributes",)}
PASS, FAIL, NOT_RUN, NONE = "pass", "fail", "not run", ""
NOT_SUPPORTED, NOT_DECLARED, NO_RULE = "unsupported", "not declared", "no rule"


@dataclasses.dataclass
class Judgement:
    """outcome: PASS, FAIL-..., CRASH, UNSUPPORTED or NOT-RUN; reason: one word that says more."""

    outcome: str
    reason: str = ""
    text: str = ""
    cells: dict = dataclasses.field(default_factory=dict)
    details: dict = dataclasses.field(default_factory=dict)
    seconds: float = None


class Grader:
    """Runs one decoder over streams."""

    def __init__(self, decoder, reference):
        self._decoder = decoder
        self._reference = reference
        self._floats = "f32" in decoder.answer["outputs"]
        self._attributes = "rlpa" in decoder.answer["outputs"]

    def judge(self, stream):
        with tempfile.TemporaryDirectory(prefix="rlpc-judge-") as folder:
            run = self._decoder.decode(stream, "rlpd", folder)
            judgement = self._outcome(stream, run)
        judgement.seconds = run.finished.seconds
        judgement.details.update({
            "verdict": run.verdict, "exit": run.finished.ending(),
            "stderr": "\n".join(run.finished.stderr.splitlines()[-8:])[-2000:],
            "command": self._decoder.decode_command(stream)})
        self._fill_cells(stream, judgement, run)
        return judgement

    def _outcome(self, stream, run):
        """Judges the exit code, and the output if it must be right."""
        done, expect = run.finished, stream.expect
        if done.code is None:
            return Judgement("CRASH", "timeout", done.ending())
        if done.code < 0:
            return Judgement("CRASH", "signal", done.ending())
        if done.code > LIMIT:
            return Judgement("CRASH", "exit-code",
                             f"{done.ending()}; the contract knows 0, 1, 2 and 3")
        if run.complaint:
            return Judgement("FAIL-verdict", "no-verdict", f"{done.ending()}, but {run.complaint}")
        if done.code == LIMIT:
            return Judgement("FAIL-resource", "limit", "reports that it needs too much memory")
        if done.code == UNSUPPORTED and expect != "unsupported":
            if not self._decoder.declares(stream):
                return Judgement("UNSUPPORTED", "not-declared",
                                 f"profile {stream.profile}, level {stream.level} not declared")
            return Judgement("FAIL-unsupported", "declared", "says unsupported, but declares it")
        if done.code == DECODED and expect in ("accept", "either"):
            return self._whole_output(stream, run)
        if done.code == DECODED:
            return Judgement("FAIL-overaccept", "accepted", f"accepts what it must {_must(stream)}")
        if done.code == REJECTED and expect in ("accept", "unsupported"):
            return Judgement("FAIL-overreject", "rejected", f"rejects what it must {_must(stream)}")
        return self._part_output(stream, run)

    def _whole_output(self, stream, run):
        if not run.output.is_file():
            return Judgement("FAIL-output", "no-output", "exit code 0, but OUT does not exist")
        if rlpd.digest_of(run.output).sha256() == stream.sha256_int:
            return Judgement("PASS")
        return self._located(stream, run, "FAIL-output")

    def _part_output(self, stream, run):
        """After a refusal, where it was due."""
        exists = run.output.is_file()
        digest = rlpd.digest_of(run.output) if exists else rlpd.Digest()
        exists = exists and digest.size > 0  # an empty OUT counts as none
        if stream.expect == "either":  # a decoder may notice anywhere
            hashes = digest.frame_sha256
            if not exists or (not digest.complaint()
                              and hashes == stream.frame_sha256[:len(hashes)]):
                return Judgement("PASS")
            return self._located(stream, run, "FAIL-frames")
        if digest.sha256() == stream.sha256_int:
            return Judgement("PASS")
        if not exists:
            return Judgement("FAIL-frames", "no-output", "OUT does not exist; expected the "
                             f"{stream.frames_before} frames before the error")
        if stream.sha256_int is None:
            return Judgement("FAIL-frames", "output", f"OUT has {digest.size} bytes; expected no "
                             "OUT, as the error comes before the first GOF unit")
        return self._located(stream, run, "FAIL-frames")

    def _located(self, stream, run, outcome):
        """A wrong output, with its first difference from the reference."""
        path, complaint = self._reference.output(stream)
        found = divergence.first_difference(run.output, path) if path else None
        if found:
            return Judgement(outcome, found["kind"], describe(found), details={"divergence": found})
        digest = rlpd.digest_of(run.output)
        text = digest.complaint() or "wrong hash"
        if stream.frame_sha256:
            pairs = zip(digest.frame_sha256, stream.frame_sha256)
            frame = next((f for f, (a, b) in enumerate(pairs) if a != b),
                         min(len(digest.frame_sha256), stream.frames))
            text += f"; frames before {frame} are right"
        return Judgement(outcome, "hash", f"{text} ({complaint})")

    def _fill_cells(self, stream, judgement, run):
        cells = dict.fromkeys((key for key, *_ in COLUMNS), NONE)
        state = {"PASS": PASS, "UNSUPPORTED": NOT_SUPPORTED}.get(judgement.outcome, FAIL)
        if stream.expect == "accept":
            cells["int"] = state
            cells["full"] = self._float_cell(stream, judgement, state)
        else:
            cells["strict"] = state
            cells["diagnostic"] = (self._rule_cell(stream, judgement, run) if state == PASS
                                   else state)
        judgement.cells = cells
        if stream.attributes is not None:
            cells["attributes"] = self._attributes_cell(stream, judgement, state)

    def _rule_cell(self, stream, judgement, run):
        if run.finished.code == UNSUPPORTED and not self._decoder.declares(stream):
            return NOT_SUPPORTED  # for example for its level
        return _rule_cell(stream, judgement, run)

    def _float_cell(self, stream, judgement, state):
        if not self._floats:
            return NOT_DECLARED
        if state != PASS:
            return state
        with tempfile.TemporaryDirectory(prefix="rlpc-judge-") as folder:
            run = self._decoder.decode(stream, "f32", folder)
            text, found = self._float_complaint(stream, run)
        if text is None:
            return PASS
        judgement.outcome, judgement.reason, judgement.text = "FAIL-float", "float", text
        judgement.details.update({"divergence": found, "exit": run.finished.ending(),
                                  "command": self._decoder.decode_command(stream, "f32")})
        return FAIL

    def _attributes_cell(self, stream, judgement, state):
        if not self._attributes:
            return NOT_DECLARED
        if state != PASS:
            return state
        with tempfile.TemporaryDirectory(prefix="rlpc-judge-") as folder:
            run = self._decoder.decode(stream, "rlpa", folder)
            text = _attributes_complaint(stream, run)
        if text is not None:
            judgement.outcome, judgement.reason, judgement.text = "FAIL-attributes", "rlpa", text
            judgement.details.update({"exit": run.finished.ending(),
                                      "command": self._decoder.decode_command(stream, "rlpa")})
            return FAIL
        if run.finished.code == REJECTED and judgement.cells["diagnostic"] == PASS:
            judgement.cells["diagnostic"] = _attributes_rule_cell(stream, judgement, run)
        return PASS

    def _float_complaint(self, stream, run):
        """(text or None, first difference or None) of the .f32 output."""
        if run.finished.code != DECODED:
            return f"decodes to .rlpd, but to .f32: {run.finished.ending()}", None
        if not run.output.is_file():
            return "exit code 0, but OUT.f32 does not exist", None
        if rlpd.file_sha256(run.output) == stream.sha256_f32:
            return None, None
        path, complaint = self._reference.output(stream)
        found = divergence.first_float_difference(run.output, path) if path else None
        return f"floats: {describe(found) if found else 'wrong hash'}", found


def _attributes_complaint(stream, run):
    """Returns what is wrong with a decoding to OUT.rlpa, or None."""
    due = stream.attributes
    done, exists = run.finished, run.output.is_file() and run.output.stat().st_size > 0
    if due.startswith("R-"):
        if done.code != REJECTED:
            return f"attributes: {done.ending()}, expected exit code 1, as they break {due}"
        if run.complaint:
            return f"attributes: {done.ending()}, but {run.complaint}"
        return "attributes are refused, but OUT.rlpa is written" if exists else None
    if done.code != DECODED:
        return f"decodes to .rlpd, but to .rlpa: {done.ending()}"
    if due == "none":
        return "writes OUT.rlpa, but the stream has no attributes" if exists else None
    if not exists:
        return "exit code 0, but OUT.rlpa does not exist"
    return None if rlpd.file_sha256(run.output) == due else "attributes: wrong hash"


def _attributes_rule_cell(stream, judgement, run):
    """Whether attributes that were refused correctly were refused for the right rule."""
    rule = run.verdict.get("rule")
    if rule is None:
        return NO_RULE
    if rule == stream.attributes:
        return PASS
    judgement.reason = "rule"
    judgement.text = f"attributes: reports {rule}, expected {stream.attributes}"
    return FAIL


def _must(stream):
    return {"accept": "decode", "reject": "reject",
            "unsupported": "call unsupported"}[stream.expect]


def _rule_cell(stream, judgement, run):
    """For a stream that was refused correctly, or may be refused."""
    if run.finished.code == DECODED:
        return PASS
    rules = [stream.rule] if stream.rule else stream.rules
    rule = run.verdict.get("rule")
    if rule is None:
        return NO_RULE
    if rule not in rules:
        judgement.reason = "rule"
        judgement.text = f"reports {rule}, expected {' or '.join(rules)}"
        return FAIL
    frame = run.verdict.get("frame")
    if stream.frames_before is not None and frame not in (None, stream.frames_before):
        judgement.reason = "frame"
        judgement.text = f"reports frame {frame}, expected {stream.frames_before}"
        return FAIL
    return PASS


def describe(found):
    """The first difference as one line of text."""
    place = {"header": "header, {field}", "triangle": "triangle {triangle}",
             "vertex": "frame {frame}, vertex {vertex}",
             "frame-count": "from frame {frame} on"}[found["kind"]].format(**found)
    return f"{place}: expected {_listed(found['expected'])}, got {_listed(found['got'])}"


def _listed(value):
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)


def not_run(stream, reason):
    """For a stream that was never decoded."""
    concerned = ("int", "full") if stream.expect == "accept" else ("strict", "diagnostic")
    if stream.attributes is not None:
        concerned += ("attributes",)
    return Judgement("NOT-RUN", "interrupted", reason,
                     {key: NOT_RUN if key in concerned else NONE for key, *_ in COLUMNS},
                     {"exit": "not run"})


def grade(rows, name):
    """The grade as a dictionary (report.schema.json): counts over its streams."""
    counts = dict.fromkeys((PASS, FAIL, NOT_SUPPORTED, NOT_DECLARED, NOT_RUN), 0)
    for row in rows:
        states = {row["cells"][column] for column in GRADES[name]} - {NONE}
        if not states:
            continue
        states = {FAIL if s == NO_RULE else s for s in states}
        counts[next(s for s in (NOT_RUN, FAIL, NOT_SUPPORTED, NOT_DECLARED, PASS)
                    if s in states)] += 1
    of = sum(counts.values())
    if counts[FAIL]:
        status = "FAIL"
    elif not of or counts[NOT_RUN]:
        status = "NOT RUN"
    elif not counts[PASS] or not _decodes_any(rows):
        status = "NOT DECLARED"
    else:
        status = "PASS"
    text = f"{counts[PASS]} of {of} streams passed"
    for state, words in ((FAIL, "failed"), (NOT_SUPPORTED, "unsupported, as declared"),
                         (NOT_DECLARED, "not declared"), (NOT_RUN, "not run")):
        if counts[state]:
            text += f", {counts[state]} {words}"
    return {"grade": name, "status": status, "passed": counts[PASS], "failed": counts[FAIL],
            "unsupported": counts[NOT_SUPPORTED] + counts[NOT_DECLARED],
            "not_run": counts[NOT_RUN], "of": of, "text": text}


def grades_of(rows):
    """All grades; R-attributes only where streams have attributes."""
    found = [grade(rows, name) for name in GRADES]
    return [g for g in found if g["of"] or g["grade"] != "R-attributes"]


def _decodes_any(rows):
    """A grade requires streams that decode, unless the suite has none."""
    states = {row["cells"]["int"] for row in rows} - {NONE}
    return not states or PASS in states


def everything_passed(grades, wanted=None):
    """Whether the exit code is 0: `wanted` passed, or everything that the decoder declares.

    R-diagnostic counts only if `wanted`, as a decoder need not name rules.
    """
    status = {g["grade"]: g["status"] for g in grades if g["of"]}
    if wanted:
        return status.get(wanted) == "PASS"
    return (bool(status) and status.get("R-int", "PASS") == "PASS"
            and status.get("R-full", "PASS") in ("PASS", "NOT DECLARED")
            and status.get("R-attributes", "PASS") in ("PASS", "NOT DECLARED")
            and status.get("R-strict", "PASS") == "PASS")
