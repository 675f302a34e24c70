"""Programs of the specification whose translation is kept in a folder: translating takes longer
than most streams."""

import functools
import hashlib
import marshal
import os
import pathlib
import sys
import tempfile

import spec_program


class CachedProgram:
    """Program(folder), which is only made when something else than compile( ) needs it. A kept
    translation is reused while the texts, the translator and Python are the same."""

    def __init__(self, folder, cache):
        self._folder = pathlib.Path(folder)
        self._cache = pathlib.Path(cache)
        texts = [*sorted(self._folder.glob("*.md")), pathlib.Path(spec_program.__file__)]
        digests = [hashlib.sha256(path.read_bytes()).hexdigest() for path in texts]
        self._codes = {}
        self._key = hashlib.sha256(" ".join([sys.version, *digests]).encode()).hexdigest()[:32]

    @functools.cached_property
    def _program(self):
        return spec_program.Program(self._folder)

    def __getattr__(self, name):
        return getattr(self._program, name)

    def compile(self, given, trace=False, widths=False):
        if (trace, widths) not in self._codes:
            self._codes[trace, widths] = self._code(trace, widths)
        return spec_program.run(self._codes[trace, widths], given)

    def _code(self, trace, widths):
        path = self._cache / f"{self._key}-{int(trace)}{int(widths)}"
        try:
            return marshal.loads(path.read_bytes())
        except FileNotFoundError:
            code = self._program.code(trace, widths)
            self._keep(path, marshal.dumps(code))
            return code

    def _keep(self, path, data):
        """Renamed only when complete, as other processes may be reading."""
        self._cache.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=self._cache, delete=False) as file:
            file.write(data)
        os.replace(file.name, path)
