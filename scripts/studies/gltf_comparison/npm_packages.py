"""The npm packages of package.json, fetched once: gltfpack, and three.js with its decoder of
EXT_meshopt_compression."""

import pathlib
import shutil
import subprocess

import measure

HERE = pathlib.Path(__file__).resolve().parent


class Packages:
    """`folder`: where npm puts them; fetched unless they are there."""

    def __init__(self, folder):
        self.modules = folder / "node_modules"
        for program in ("node", "npm"):
            if shutil.which(program) is None:
                raise measure.Failure(f"needs {program}; run scripts/setup --player")
        wanted = (HERE / "package.json").read_text(encoding="utf-8")
        have = folder / "package.json"
        if (self.modules.is_dir() and have.is_file()
                and have.read_text(encoding="utf-8") == wanted):
            return
        folder.mkdir(parents=True, exist_ok=True)
        shutil.copy(HERE / "package.json", have)
        done = subprocess.run(["npm", "install", "--ignore-scripts", "--no-audit", "--no-fund",
                               "--no-package-lock"], cwd=folder, capture_output=True, text=True,
                              check=False)
        if done.returncode != 0:
            have.unlink()
            said = [line.removeprefix("npm error").strip() for line in done.stderr.splitlines()]
            reason = next((line for line in said if "Error:" in line), "".join(said[:1]))
            raise measure.Failure(
                f"npm could not fetch gltfpack and three.js into {folder}; the first run needs a "
                f"network ({reason})")

    @property
    def three(self):
        return self.modules / "three"

    def node(self, script, *arguments):
        """Standard output of a script: one of this folder, or one of a package."""
        done = subprocess.run(["node", script, *map(str, arguments)], capture_output=True,
                              text=True, check=False)
        if done.returncode != 0:
            raise measure.Failure(f"{pathlib.Path(script).name}: {done.stderr.strip()}")
        return done.stdout

    def gltfpack(self, *arguments):
        self.node(self.modules / "gltfpack" / "cli.js", *arguments)
