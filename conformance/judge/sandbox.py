"""Runs a command in a folder, with limits on time and memory, leaving nothing behind."""

import dataclasses
import os
import shlex
import shutil
import signal
import subprocess
import threading
import time

# A decoder that never stops writing must not fill the disk.
MAX_FILE_BYTES = 1 << 32
_TAIL = 1 << 16
# sh sets the limits and execs the command, so that no code runs between fork and exec here. A
# tighter limit already in place is kept.
_LIMITED = ('ulimit -c 0; ulimit -f "$1" 2>/dev/null; [ "$2" = 0 ] || ulimit -v "$2" 2>/dev/null; '
            'shift 2; exec "$@"')

_running = set()
_lock = threading.Lock()
_stopped = threading.Event()


class CommandError(Exception):
    """A command that cannot be run at all."""


@dataclasses.dataclass
class Finished:
    """The end of a command. code is negative for a signal, and None after a timeout."""

    code: int
    seconds: float
    stdout: bytes
    stderr: str  # the end of it

    def ending(self):
        """The end as text, such as "exit code 1" or "killed by SIGSEGV"."""
        if self.code is None:
            return f"still running after {self.seconds:.0f} s"
        if self.code < 0:
            return f"killed by {signal_name(-self.code)}"
        return f"exit code {self.code}"


def signal_name(number):
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"


def command_words(text):
    """The words of a command line, usable from another folder: files get absolute paths."""
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise CommandError(f"{text}: {error}") from error
    if not words:
        raise CommandError("the command is empty")
    program = shutil.which(words[0])
    if program is None:
        raise CommandError(f"{words[0]}: no such program, or it is not executable")
    return [os.path.abspath(program)] + [os.path.abspath(w) if os.path.exists(w) else w
                                         for w in words[1:]]


def run(words, folder, timeout, max_bytes=0):
    """Runs the words in `folder`/work; max_bytes bounds its address space (0: no bound)."""
    work = folder / "work"
    work.mkdir(exist_ok=True)
    limits = [str(MAX_FILE_BYTES // 512), str(max_bytes // 1024)]
    start = time.monotonic()
    with open(folder / "stdout", "wb") as out, open(folder / "stderr", "wb") as err:
        with _lock:
            if _stopped.is_set():
                raise CommandError("interrupted")
            process = subprocess.Popen(["/bin/sh", "-c", _LIMITED, "sh", *limits, *words],
                                       cwd=work, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                       start_new_session=True)
            _running.add(process.pid)
        try:
            code = process.wait(timeout)
        except subprocess.TimeoutExpired:
            code = None
        finally:
            _kill_group(process.pid)
            process.wait()
            with _lock:
                _running.discard(process.pid)
    return Finished(code, time.monotonic() - start, _tail(folder / "stdout"),
                    _tail(folder / "stderr").decode("utf-8", "replace"))


def stop_all():
    """Kills all running commands, and lets no more start; for interrupts."""
    with _lock:
        _stopped.set()
        for pid in _running:
            _kill_group(pid)


def _kill_group(pid):
    try:
        os.killpg(pid, signal.SIGKILL)  # including its children
    except ProcessLookupError:
        pass


def _tail(path):
    with open(path, "rb") as file:
        size = file.seek(0, os.SEEK_END)
        file.seek(max(0, size - _TAIL))
        return file.read()
