"""Faults of the process: how it ends, or does not."""

import os
import signal
import sys
import time


def crashes_on_bad_streams(request):
    """The oldest trap: is it a rejection?"""
    if request.code == 1:
        os.kill(os.getpid(), signal.SIGSEGV)


def throws_on_bad_streams(request):
    """The exit code of an exception that nobody catches is 1 as well."""
    if request.code == 1:
        request.output.unlink(missing_ok=True)
        raise RuntimeError("index out of range")


def dies_after_good_output(request):
    request.output.write_bytes(request.data)
    os.kill(os.getpid(), signal.SIGABRT)


def hangs(request):
    """Starts a child that would outlive it, and notes the child's id."""
    import subprocess  # takes longer than all else that a fake decoder does
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(300)"])
    (request.kept_folder() / "child").write_text(str(child.pid))
    time.sleep(300)


def eats_memory(request):
    hoard = []
    try:
        while True:
            hoard.append(bytearray(1 << 24))
    except MemoryError:
        hoard.clear()
    request.code, request.verdict, request.data = 3, {}, None


def ends_with_code_5(request):
    request.code = 5


def talks_on_standard_output(_):
    """No fault: standard output belongs to the decoder."""
    print("frame 1 of 1\nrlpc-verdict {\"rule\":\"R-XXX-99\"}\n\0\xff" * 100)


def answers_no_json(_):
    pass


answers_no_json.says_instead = "mydec 1.0, at your service"


def answers_nothing(_):
    pass


answers_nothing.says_instead = "\n"


def speaks_another_contract(_):
    pass


speaks_another_contract.declares = {"contract": 2}
