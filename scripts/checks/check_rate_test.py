#!/usr/bin/env python3
"""check_rate.py over an encoder that writes as many bytes as a file says."""

import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import check_rate

# The file `sizes`: SIZE NAME SETTING; 1000 for others. Below zero: the target was missed.
ENCODER = r"""#!/bin/sh
name=$(basename "${1%.*}")
if [ "$2" = --points ]; then [ "$3" = "${1%.obj}.pc2" ] || exit 1; shift 2; fi
out=$3
shift 3
setting="$*"
setting="${setting% --no-attributes}"
size=$(sed -n "s/ $name $setting\$//p" "$(dirname "$0")/sizes")
size=${size:-1000}
head -c "${size#-}" /dev/zero > "$out"
[ "$size" -gt 0 ] || exit 2
"""
SETTINGS = ("--kg 1", "--profile baseline --kg 1")
FIRST, *OTHERS = NAMES = [f"{name} {setting}" for name in ("cube", "rose") for setting in SETTINGS]


class Rate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.table = self.root / check_rate.TABLE
        self.table.parent.mkdir(parents=True)
        for name in ("cube.obj", "cube.pc2", "rose.glb"):
            (self.table.parent / name).touch()
        (self.root / "rlpcenc").write_text(ENCODER)
        (self.root / "rlpcenc").chmod(0o755)
        self.encode_as({})
        self.assert_clean("--write")

    def encode_as(self, sizes):
        lines = [f"{size} {name}\n" for name, size in sizes.items()]
        (self.root / "sizes").write_text("".join(lines))

    def run_check(self, *arguments):
        """Exit code, standard output, lines of errors."""
        with (contextlib.redirect_stdout(io.StringIO()) as out,
              contextlib.redirect_stderr(io.StringIO()) as errors,
              mock.patch.object(check_rate, "SETTINGS", SETTINGS)):
            status = check_rate.main(["--root", str(self.root), "--bin", str(self.root),
                                      *arguments])
        return status, out.getvalue(), errors.getvalue().splitlines()

    def assert_clean(self, *arguments):
        status, out, errors = self.run_check(*arguments)
        self.assertEqual((status, errors), (0, []))
        return out

    def assert_fails(self, *words):
        status, _, errors = self.run_check()
        self.assertEqual((status, len(errors)), (1, len(words)), errors)
        for error, word in zip(errors, words):
            self.assertIn(word, error)

    def test_the_same_and_fewer_bytes_pass(self):
        self.assertIn("4 streams, +0.00 %", self.assert_clean())
        self.encode_as({FIRST: 500})
        self.assertIn("4 streams, -15.91 %", self.assert_clean())

    def test_one_stream_may_grow_by_half_a_percent(self):
        self.encode_as({FIRST: 1005})
        self.assert_clean()
        self.encode_as({FIRST: 1006})
        self.assert_fails(f"{FIRST}: 1006 bytes, +0.60 % over 1000")

    def test_all_streams_may_grow_by_a_fifth_of_a_percent(self):
        self.encode_as(dict.fromkeys(NAMES, 1002))
        self.assert_clean()
        self.encode_as(dict.fromkeys(NAMES, 1003))
        self.assert_fails("all streams: +0.30 % on average")

    def test_what_others_save_does_not_excuse_a_rise(self):
        self.encode_as({FIRST: 1100, **dict.fromkeys(OTHERS, 500)})
        self.assert_fails(FIRST)

    def test_a_rise_passes_once_it_is_written(self):
        self.encode_as({FIRST: 1200})
        self.assert_fails("all streams: +4.66 %", FIRST)
        self.assertIn("+4.66 %", self.assert_clean("--write"))
        self.assert_clean()
        self.encode_as({FIRST: 1207})
        self.assert_fails(FIRST)

    def test_a_missed_target_fails_and_is_not_written(self):
        before = self.table.read_text()
        self.encode_as({FIRST: -900})
        self.assert_fails(f"{FIRST}: the target was missed")
        self.assertEqual(self.run_check("--write")[0], 1)
        self.assertEqual(self.table.read_text(), before)

    def test_entries_and_streams_belong_together(self):
        table = json.loads(self.table.read_text())
        self.table.write_text(json.dumps({**table, "cone --kg 1": 5}))
        self.assert_fails("cone --kg 1: ")
        del table[FIRST]
        self.table.write_text(json.dumps(table))
        self.assert_fails(f"{FIRST}: not in")
        self.table.unlink()
        self.assert_fails(*[": not in"] * len(NAMES))

    def test_nothing_to_encode_fails(self):
        for path in self.table.parent.iterdir():
            path.unlink()
        self.assert_fails("no animation was encoded")
        self.assertEqual(self.run_check("--write")[0], 1)
        self.assertFalse(self.table.exists())

    def test_an_encoder_that_fails_is_an_error(self):
        (self.root / "rlpcenc").write_text("#!/bin/sh\nexit 1\n")
        with self.assertRaises(subprocess.CalledProcessError):
            self.run_check()


class BundledTable(unittest.TestCase):
    """The committed table has each animation with each setting."""

    def test_it_is_whole(self):
        table = check_rate.read_table(check_rate.ROOT)
        names = [name for name, _ in check_rate.inputs(check_rate.ROOT)]
        self.assertIn("elephant", names)
        self.assertEqual(sorted(table), sorted(f"{name} {setting}" for name in names
                                               for setting in check_rate.SETTINGS))
        self.assertTrue(all(size > 500 for size in table.values()))


if __name__ == "__main__":
    unittest.main()
