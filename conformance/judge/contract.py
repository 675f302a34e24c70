"""A decoder under the contract: a command line (conformance/VALIDATE.md)."""

import dataclasses
import json
import pathlib
import shlex
import shutil
import tempfile

import rlpd
import sandbox
import schema
import suite

VERDICT = "rlpc-verdict "
DECODED, REJECTED, UNSUPPORTED, LIMIT = 0, 1, 2, 3


class ContractError(Exception):
    """A decoder with an invalid answer to --rlpc-conformance."""


@dataclasses.dataclass
class Run:
    """One decoding. verdict is None if the line is missing or malformed; see complaint."""

    finished: sandbox.Finished
    verdict: dict
    complaint: str
    output: pathlib.Path  # may not exist


@dataclasses.dataclass
class Limits:
    timeout: float
    max_mem: int  # address space in bytes; 0: no limit
    tell_decoder: bool = False  # pass --max-mem on


class Decoder:
    """A decoder under test. describe() comes first."""

    def __init__(self, command, limits):
        self.command = command
        self.limits = limits
        self._words = sandbox.command_words(command)
        self.answer = {}

    def describe(self):
        """Asks what the decoder decodes; keeps and returns the answer."""
        with tempfile.TemporaryDirectory(prefix="rlpc-judge-") as folder:
            done = sandbox.run([*self._words, "--rlpc-conformance"], pathlib.Path(folder),
                               self.limits.timeout, self.limits.max_mem)
        if done.code != 0:
            raise ContractError(self._refusal(f"{done.ending()}", done.stderr))
        try:
            self.answer = json.loads(done.stdout)
        except ValueError as error:
            said = "no JSON" if done.stdout.strip() else "nothing"
            raise ContractError(self._refusal(f"printed {said}", done.stderr)) from error
        try:
            schema.check(self.answer, schema.load("contract"), "the answer")
        except schema.SchemaError as error:
            raise ContractError(self._refusal(str(error), "")) from error
        return self.answer

    def _refusal(self, what, stderr):
        last = stderr.strip().splitlines()[-1:]
        return (f"{self.command} --rlpc-conformance: {what}" + "".join(f" ({t})" for t in last)
                + "\nIt must print one JSON object and exit with code 0, for example\n"
                '  {"contract":1,"name":"mydec","version":"0.1","spec":["1.0"],'
                '"profiles":["baseline"],"levels":[1,2],"outputs":["rlpd"]}')

    def declares(self, stream):
        """Whether the stream is within the profiles and levels that the decoder declares.

        A level includes all lower ones (B.2). A damaged stream that hides them is no excuse.
        """
        highest = max(self.answer["levels"], default=0)
        return (stream.spec in self.answer["spec"]
                and (stream.profile is None or stream.profile in self.answer["profiles"])
                and (stream.level is None or stream.level <= highest))

    def decode(self, stream, form, folder):
        """Decodes a copy of the stream file, under a neutral name."""
        folder = pathlib.Path(folder)
        copy = folder / "in.rlpc"
        shutil.copyfile(stream.path, copy)
        if rlpd.file_sha256(copy) != stream.sha256:
            raise suite.SuiteError(f"{stream.path}: was changed while it was judged; try again")
        output = folder / "work" / f"out.{form}"
        words = [*self._words, "decode", str(copy), str(output)]
        if self.limits.tell_decoder:
            words += ["--max-mem", str(self.limits.max_mem)]
        done = sandbox.run(words, folder, self.limits.timeout, self.limits.max_mem)
        verdict, complaint = read_verdict(done)
        return Run(done, verdict, complaint, output)

    def decode_command(self, stream, form="rlpd"):
        """The command line that repeats a decoding, for users."""
        return f"{self.command} decode {shlex.quote(str(stream.path))} out.{form}"


def read_verdict(done):
    """(verdict, None), or (None, complaint about the last line of standard error)."""
    if done.code not in (REJECTED, UNSUPPORTED, LIMIT):
        return None, None
    lines = done.stderr.splitlines()
    if not lines or not lines[-1].startswith(VERDICT):
        where = "; there is one earlier" if any(t.startswith(VERDICT) for t in lines) else ""
        return None, f"the last line of standard error does not begin with \"{VERDICT}\"{where}"
    try:
        verdict = json.loads(lines[-1][len(VERDICT):])
    except ValueError:
        return None, f"there is no JSON after \"{VERDICT}\" on the last line of standard error"
    try:
        schema.check(verdict, schema.load("verdict"), "the verdict")
    except schema.SchemaError as error:
        return None, f"the last line of standard error is not a verdict: {error}"
    return verdict, None
