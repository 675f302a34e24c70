"""The source of zlib, for targets that have no package of it."""

import os
import pathlib
import re
import shutil

DEBIAN_KEY = pathlib.Path("/usr/share/keyrings/debian-archive-keyring.gpg")


class Unavailable(Exception):
    """This machine cannot fetch the source; the text says why."""


def fetch(work, run):
    """Fetches Debian's source package with apt-get and returns its folder. apt-get uses package
    lists of its own, so the system is not changed and no privileges are needed. run(command, cwd)
    raises if the command fails."""
    unpacked = sorted(work.glob("zlib-*/configure"))
    if unpacked:
        return unpacked[0].parent
    if not shutil.which("apt-get") or not shutil.which("dpkg-source"):
        raise Unavailable("needs apt-get and dpkg-dev")
    codename = re.search(r"^VERSION_CODENAME=(\w+)", pathlib.Path("/etc/os-release").read_text(),
                         re.MULTILINE)
    if not codename or not DEBIAN_KEY.exists():
        raise Unavailable("needs Debian, for its source package")
    for folder in ["lists/partial", "cache/archives/partial"]:
        (work / folder).mkdir(parents=True, exist_ok=True)
    (work / "debian.sources").write_text(
        "Types: deb-src\nURIs: http://deb.debian.org/debian\n"
        f"Suites: {codename.group(1)}\nComponents: main\nSigned-By: {DEBIAN_KEY}\n")
    apt = ["apt-get", "-q", "-o", f"Dir::State::Lists={work / 'lists'}",
           "-o", f"Dir::Cache={work / 'cache'}",
           "-o", f"Dir::Etc::SourceList={work / 'debian.sources'}",
           "-o", "Dir::Etc::SourceParts=-", "-o", f"APT::Sandbox::User={os.getuid()}"]
    run([*apt, "update"], work)
    run([*apt, "source", "zlib"], work)
    return next(work.glob("zlib-*/configure")).parent
