"""Programs of the specification whose translation is kept in a folder: translating takes longer
than most streams."""

import hashlib
import marshal
import os
import pathlib
import sys
import tempfile

import spec_program


class CachedProgram:
    """Program(folder) as far as compile( ) goes. A kept translation is reused while the texts,
    the translator and Python are the same."""

    def __init__(self, folder, cache):
        self._folder = pathlib.Path(folder)
        self._cache = pathlib.Path(cache)
        texts = [*sorted(self._folder.glob("*.md")), pathlib.Path(spec_program.__file__)]
        digests = [hashlib.sha256(path.read_bytes()).hexdigest() for path in texts]
        self._key = hashlib.sha256(" ".join([sys.version, *digests]).encode()).hexdigest()[:32]

    def compile(self, given, trace=False, widths=False):
        path = self._cache / f"{self._key}-{int(trace)}{int(widths)}"
        try:
            code = marshal.loads(path.read_bytes())
        except FileNotFoundError:
            code = spec_program.Program(self._folder).code(trace, widths)
            self._keep(path, marshal.dumps(code))
        return spec_program.run(code, given)

    def _keep(self, path, data):
        """Renamed only when complete, as other processes may be reading."""
        self._cache.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=self._cache, delete=False) as file:
            file.write(data)
        os.replace(file.name, path)
