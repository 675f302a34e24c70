"""Pictures of source and decoded .glb side by side, by three.js in Chromium, and how far their
pixels differ."""

import functools
import http.server
import json
import pathlib
import shutil
import sys
import threading

import gltf_file
import measure
import report

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[2] / "decoder" / "web" / "player"))
import chromium

SIZE = (1440, 512)
PICTURES = 3  # for each file: first frame, the one in the middle, and one after that

DEFINITION = (
    "Pixels: of those of 480 * 480 that show the model in either picture, drawn by three.js in "
    "Chromium at the same time of the same clip: mean and largest difference of a channel, of "
    "255, and per cent of them with a channel that differs by more than 16.")


class _Handler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Studio:
    """with Studio(folder) as studio: ...; `folder` holds the npm packages and all files shown."""

    def __init__(self, folder):
        self.folder = folder
        path = chromium.program()
        if path is None:
            raise measure.Failure("needs chromium; run scripts/setup --player")
        self._browser = chromium.Chromium(path, SIZE)

    def __enter__(self):
        shutil.copy(HERE / "pictures.html", self.folder)
        handler = functools.partial(_Handler, directory=self.folder)
        self._server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=self._server.serve_forever, daemon=True).start()
        self.browser = self._browser.__enter__()
        self.browser.open(f"http://127.0.0.1:{self._server.server_port}/pictures.html")
        self.browser.wait_for("globalThis.isReady === true")
        return self

    def __exit__(self, *_):
        self._browser.__exit__()
        self._server.shutdown()
        self._server.server_close()

    def show(self, source, decoded, clip, frame, title, target):
        """Mean and largest difference, and the share that is visible; `target`: a PNG file."""
        task = {"source": str(source.relative_to(self.folder)),
                "decoded": str(decoded.relative_to(self.folder)), "clip": clip,
                "seconds": frame / gltf_file.FPS, "title": title}
        found = self.browser.evaluate(f"show({json.dumps(task)})")
        self.browser.screenshot(target)
        return {**task, "picture": target.name, **found}


def take(studio, path, titles, pictures):
    """Pictures of a model: of each .glb file named in `titles`, in its folder below that of the
    studio."""
    folder = studio.folder / path.stem
    source = folder / "source.glb"
    shutil.copy(gltf_file.as_glb(path, folder), source)
    source.chmod(0o644)
    samples = gltf_file.frame_samples(gltf_file.clips(path), 5)
    found = []
    for name, title in titles.items():
        for number, (clip, frame) in enumerate((*samples[:2], samples[-2])[:PICTURES]):
            target = pictures / f"{path.stem}-{name}-{number}.png"
            found.append({"model": path.stem, "codec": title, **studio.show(
                source, folder / f"{name}.glb", clip, frame, title, target)})
    return found


def table(found):
    rows = [[f"{p['picture']}", p["codec"], f"{p['clip']}", f"{p['seconds']:.2f}",
             report.number(p["mean"], 2), f"{p['largest']}", report.number(p["visible_percent"], 2)]
            for p in found]
    return report.Table("Pictures", ["picture", "codec", "clip", "second", "mean", "largest",
                                     "visible, %"], rows)
