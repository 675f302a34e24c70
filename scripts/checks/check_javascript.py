#!/usr/bin/env python3
"""JavaScript sources are as decoder/web/lint/eslint.config.js says, by ESLint.

Fetches ESLint and its rules from npm into build/lint, by the lock file, unless they are there.
"""

import json
import pathlib
import shutil
import subprocess
import sys

import cpp_source

LINT = pathlib.Path("decoder") / "web" / "lint"
OUT = pathlib.Path("build") / "lint"
_PACKAGES = ("package.json", "package-lock.json")
_CONFIG = "eslint.config.js"
_FOLDERS = ("decoder", "scripts")


def fetch(root):
    """Brings ESLint to build/lint; what is missing, or None."""
    folder = root / OUT
    texts = {name: (root / LINT / name).read_bytes() for name in _PACKAGES}
    stamp = folder / "fetched"
    if stamp.is_file() and stamp.read_bytes() == b"".join(texts.values()):
        return None
    folder.mkdir(parents=True, exist_ok=True)
    stamp.unlink(missing_ok=True)
    for name, text in texts.items():
        (folder / name).write_bytes(text)
    done = subprocess.run(["npm", "ci", "--ignore-scripts", "--no-audit", "--no-fund"],
                          cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        said = [line.removeprefix("npm error").strip() for line in done.stderr.splitlines()]
        return (f"npm could not fetch ESLint ({LINT}/package.json) into {OUT}; the first run "
                f"needs a network: {'; '.join(said[:3])}")
    stamp.write_bytes(b"".join(texts.values()))
    return None


def check(root):
    root = root.resolve()
    paths = [str(path.relative_to(root))
             for path in cpp_source.files(root, _FOLDERS, (".js", ".mjs"))]
    if not paths:
        return ["no JavaScript source is found: the check sees nothing"], ""
    for program in ("node", "npm"):
        if not shutil.which(program):
            return [f"{program} is not installed: run scripts/setup --player"], ""
    missing = fetch(root)
    if missing:
        return [missing], ""
    shutil.copy(root / LINT / _CONFIG, root / OUT)
    done = subprocess.run(["node", OUT / "node_modules" / "eslint" / "bin" / "eslint.js",
                           "--config", OUT / _CONFIG, "--format", "json", *paths],
                          cwd=root, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        return [f"ESLint failed: {done.stderr.strip()}"], ""
    complaints = [f"{pathlib.Path(file['filePath']).relative_to(root)}:{found['line']}: "
                  f"{found['message']} ({found['ruleId']})"
                  for file in json.loads(done.stdout) for found in file["messages"]]
    return complaints, f"{len(paths)} files are clean"


if __name__ == "__main__":
    sys.exit(cpp_source.run("javascript", __doc__, check))
