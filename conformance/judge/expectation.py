"""The expected result for a stream, as the specification decodes it.

Not used by the judge, but for writing suites and by tests.
"""

import hashlib
import pathlib
import sys

import rlpd

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "specdec"))
import specdec


def expectation_of(data, program):
    """The specification's result for a stream: the decoded part of its sidecar.

    "expect" is accept, reject or unsupported; with accept come frames, sha256_int, sha256_f32 and
    frame_sha256, else rule, bit, frames_before and sha256_int (None: nothing is output).
    """
    digest = rlpd.Digest(with_f32=True)
    decoder = specdec.Decoder(program, data, digest.feed)
    try:
        decoder.call("stream")
    except specdec.Verdict as verdict:
        bit, frames = decoder.place()
        expect = "reject" if verdict.code == specdec.INVALID else "unsupported"
        return {"expect": expect, "rule": verdict.rule, "bit": bit, "frames_before": frames,
                "sha256_int": digest.sha256()}
    return {"expect": "accept", "frames": len(digest.frame_sha256),
            "sha256_int": digest.sha256(), "sha256_f32": digest.sha256_f32(),
            "frame_sha256": digest.frame_sha256}


def attributes_of(data, program):
    """The specification's result for OUT.rlpa, the sidecar's "attributes".

    The SHA-256 of the file, "none" if there is to be no file, or the rule that the stream breaks;
    None if the stream has no attribute unit.
    """
    if not specdec.has_attribute_unit(data):
        return None
    parts = []
    decoder = specdec.Decoder(program, data, lambda frames: None, write_attributes=parts.append)
    try:
        decoder.call(specdec.WITH_ATTRIBUTES)
    except specdec.Verdict as verdict:
        return verdict.rule
    return hashlib.sha256(b"".join(parts)).hexdigest() if parts else "none"
