#!/usr/bin/env python3
"""The specification as a decoder against rlpcdec: the same integers, or the same verdict.

    two_decoders_test.py --bin BUILD/bin [unittest arguments, such as Streams]
"""

import argparse
import json
import pathlib
import random
import re
import shutil
import struct
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import spec_program
from specdec_testing import (
    ROOT, FolderTest, cut_animation, encode, run_attributes, run_stream, soup_animation, stream_of,
    units_of)

BIN = None


class Clips(FolderTest):
    def encode(self, animation, *settings, profile="baseline"):
        return encode(BIN, self.folder, animation, *settings, profile=profile)

    def rlpcdec(self, data):
        """(exit code, rule or None, number of frames before the error or None, output)."""
        stream, output = self.folder / "in.rlpc", self.folder / "out.rlpd"
        stream.write_bytes(data)
        output.unlink(missing_ok=True)
        done = subprocess.run([BIN / "rlpcdec", "decode", stream, output], capture_output=True,
                              text=True, check=False)
        verdict = {}
        if done.returncode != 0:
            word, _, text = done.stderr.splitlines()[-1].partition(" ")
            self.assertEqual(word, "rlpc-verdict")
            verdict = json.loads(text)
        return (done.returncode, verdict.get("rule"), verdict.get("frame"),
                output.read_bytes() if output.exists() else b"")


class StreamTest(Clips):
    """Streams of rlpcenc decode to the same bytes, and read as the same syntax elements."""

    def agree(self, data):
        code, _, _, expected = self.rlpcdec(data)
        self.assertEqual(code, 0)
        elements = []
        decoded = run_stream(data, trace=lambda *element: elements.append(element))
        self.assertEqual(decoded[:2], (0, None))
        self.assertTrue(decoded[3] == expected, "other bytes than from rlpcdec")
        trace = subprocess.run([BIN / "rlpcinfo", self.folder / "in.rlpc", "--trace"], check=True,
                               capture_output=True, text=True).stdout
        listed = re.findall(r"^ *\d+    (\w+) = (-?\d+)$", trace, re.MULTILINE)
        self.assertEqual([(name, str(value)) for _, name, value in elements], listed)

    def numbers_matter(self, data, numbers):
        """Another number in the text of the specification gives another result."""
        expected = run_stream(data)
        for file, number, other in numbers:
            with self.subTest(number=number):
                copy = self.folder / "spec"
                shutil.copytree(ROOT / "spec", copy, dirs_exist_ok=True)
                text = (copy / file).read_text(encoding="utf-8")
                self.assertEqual(text.count(number), 1)
                (copy / file).write_text(text.replace(number, other), encoding="utf-8")
                try:
                    changed = run_stream(data, spec_program.Program(copy))
                except (IndexError, NameError):
                    changed = None
                self.assertFalse(changed == expected, "the same result")


class Streams(StreamTest):
    def test_many_gofs_with_index_hashes_order_and_metadata(self):
        note = self.folder / "note.json"
        note.write_text('{"title": "elephant"}')
        self.agree(self.encode(cut_animation(self.folder, "elephant", 33), "--kg", "0.5",
                               "--gof", "2", "--hash", "frame", "--keep-order", "--metadata", note))

    def test_local_frames_and_fine_components(self):
        self.agree(self.encode(cut_animation(self.folder, "robot_arm", 12), "--gof", "all",
                               "--clusters", "4", "--components", "6", "--qu", "20", "--qc", "20",
                               "--qdelta", "24", "--no-rdo", "--frame", "lcf"))

    def test_world_coordinates_at_low_rate(self):
        self.agree(self.encode(cut_animation(self.folder, "curtain", 9), "--bpvf", "2",
                               "--frame", "world", "--hash", "none", "--preset", "fast"))

    def test_triangle_soup(self):
        self.agree(self.encode(soup_animation(self.folder), "--kg", "1", "--clusters", "3"))

    def test_every_intermediate_fits_64_bits(self):
        data = self.encode(cut_animation(self.folder, "robot_arm", 3), "--gof", "all",
                           "--clusters", "2", "--components", "2", "--qu", "20", "--qc", "20",
                           "--qdelta", "24", "--no-rdo", "--frame", "lcf")
        self.assertEqual(run_stream(data, widths=True)[:2], (0, None))

    def test_numbers_of_the_text_matter(self):
        data = self.encode(cut_animation(self.folder, "robot_arm", 4), "--gof", "all",
                           "--clusters", "2", "--components", "3", "--qu", "11", "--qc", "11",
                           "--no-rdo", "--frame", "lcf", "--hash", "none")
        self.numbers_matter(data, (
            ("09-parsing.md", "RateTable(7)", "RateTable(6)"),
            ("08-decoding.md", "[32768, 35734, ", "[32769, 35735, "),
            ("07-semantics.md", "TrackOfVertex = [-1]", "TrackOfVertex = [0]"),
            ("annex-a-rlpd.md", "values = [1, ", "values = [2, ")))


class MainStreams(StreamTest):
    """The same for the Main profile."""

    def encode_main(self, name, frames, *settings):
        return self.encode(cut_animation(self.folder, name, frames), *settings, profile="main")

    def test_many_gofs_with_index_hashes_and_order(self):
        self.agree(self.encode_main("elephant", 9, "--kg", "0.5", "--gof", "3", "--hash", "frame",
                                    "--keep-order"))

    def test_bones(self):
        data = self.encode_main("robot_arm", 12, "--kg", "0.3", "--gof", "all")
        self.agree(data)
        self.assertEqual(run_stream(data, widths=True)[:2], (0, None))

    def test_triangle_soup(self):
        self.agree(self.encode(soup_animation(self.folder), "--kg", "1", profile="main"))

    def test_slices_can_be_left_out(self):
        data = self.encode_main("curtain", 6, "--kg", "0.5", "--hash", "none", "--bones", "1")
        whole = units_of(data)
        slices = [i for i, (kind, _) in enumerate(whole) if kind == SLICE]
        self.assertGreater(len(slices), 1)
        outputs = set()
        for first in slices:
            cut = stream_of(data, [u for i, u in enumerate(whole) if i not in slices or i < first])
            code, rule, frames, output = run_stream(cut)
            self.assertEqual((code, frames), (0, 6), rule)
            self.assertTrue(output == self.rlpcdec(cut)[3], "other bytes than from rlpcdec")
            outputs.add(output)
        self.assertEqual(len(outputs), len(slices))

    def test_numbers_of_the_text_matter(self):
        data = self.encode_main("curtain", 9, "--kg", "0.05", "--hash", "none", "--bones", "1")
        self.numbers_matter(data, (
            ("08-decoding.md", "left = 16384", "left = 19384"),
            ("08-decoding.md", "range(1, 7)", "range(1, 6)"),
            ("08-decoding.md", "[0, 1, 2, 0, 0, 1]", "[0, 1, 2, 0, 0, 2]"),
            ("09-parsing.md", "GroupEnd = [3]", "GroupEnd = [2]"),
            ("09-parsing.md", "[8, 13, 20, 32]", "[8, 13, 20, 33]"),
            ("09-parsing.md", "96 * ComponentMean[l]", "95 * ComponentMean[l]")))


class HighStreams(StreamTest):
    """The same for the High profile, with several GOFs of one shared rig."""

    def encode_high(self, name, frames, *settings):
        data = self.encode(cut_animation(self.folder, name, frames), *settings, profile="high")
        self.assertIn(RIG, [kind for kind, _ in units_of(data)])
        return data

    def test_several_gofs(self):
        self.agree(self.encode_high("elephant", 9, "--kg", "0.3", "--gof", "3", "--keep-order"))
        self.agree(self.encode_high("robot_arm", 12, "--kg", "0.3", "--gof", "4", "--hash",
                                    "frame"))

    def test_slices_can_be_left_out(self):
        data = self.encode_high("curtain", 8, "--kg", "0.3", "--gof", "4", "--hash", "none")
        whole = units_of(data)
        last = max(i for i, (kind, _) in enumerate(whole) if kind == SLICE)
        first = next(i for i, (kind, _) in enumerate(whole) if kind == SLICE)
        outputs = set()
        for kept in ([], [first], range(first, last), range(first, last + 1)):
            cut = stream_of(data, [u for i, u in enumerate(whole)
                                   if u[0] != SLICE or i in kept])
            code, rule, frames, output = run_stream(cut)
            self.assertEqual((code, frames), (0, 8), rule)
            self.assertTrue(output == self.rlpcdec(cut)[3], "other bytes than from rlpcdec")
            outputs.add(output)
        self.assertEqual(len(outputs), 4)

    def test_numbers_of_the_text_matter(self):
        data = (ROOT / "streams/v1.2/accept/MDL/MDL-0004a.rlpc").read_bytes()
        self.numbers_matter(data, (
            ("06-syntax.md", "NumGofFrames = 0\n", "NumGofFrames = 1\n"),
            ("08-decoding.md", "FirstOwnGroup = num_component_groups + 1",
             "FirstOwnGroup = num_component_groups + 2"),
            ("08-decoding.md", "AdaptiveWeights.append(CopyOf(weights))",
             "AdaptiveWeights.append([0] * len(weights))"),
            ("08-decoding.md", "NumTrajectories = GroupEnd[component_group_idx] - 3",
             "NumTrajectories = GroupEnd[component_group_idx] - 4")))


SLICE, RIG = 6, 7


class DamagedStreams(Clips):
    """Damaged streams draw the same verdict, and the same frames before it, from both decoders."""

    def agree(self, cases):
        for number, data in enumerate(cases):
            with self.subTest(number=number):
                code, rule, frames, output = run_stream(data)
                got = self.rlpcdec(data)
                self.assertEqual((code, rule, frames if code else None), got[:3])
                self.assertTrue(output == got[3], "other bytes than from rlpcdec")
                if output:
                    vertices, triangles = struct.unpack_from("<II", output, 8)
                    self.assertEqual(len(output), 44 + 12 * triangles + 12 * vertices * frames)

    def stream(self):
        return self.encode(soup_animation(self.folder), "--kg", "2", "--gof", "3",
                           "--clusters", "3", "--keep-order", "--hash", "frame", "--frame", "lcf")

    def test_cut_off(self):
        data = self.stream()
        self.agree(data[:n] for n in list(range(0, 30, 4)) + list(range(30, len(data), 101)))

    def test_changed_payloads_with_good_crcs(self):
        data = self.stream()
        r = random.Random(3)
        cases = []
        for _ in range(80):
            all_units = units_of(data)
            i = r.randrange(len(all_units))
            payload = bytearray(all_units[i][1])
            payload[r.randrange(min(len(payload), r.choice((8, 1000))))] = r.randrange(256)
            all_units[i] = (all_units[i][0], bytes(payload))
            cases.append(stream_of(data, all_units))
        self.agree(cases)

    def test_misplaced_units(self):
        data = self.stream()
        cases = []
        for i in range(1, len(units_of(data))):
            for kind in (0x01, 0x05, 0x06, 0x07, 0x84):
                all_units = units_of(data)
                cases.append(stream_of(data, all_units[:i] + [(kind, b"?")] + all_units[i:]))
            del all_units[i]
            cases.append(stream_of(data, all_units))
        self.agree(cases)


class DamagedMainStreams(DamagedStreams):
    """The same for the Main profile."""

    def stream(self):
        return self.encode(soup_animation(self.folder), "--kg", "2", "--gof", "4",
                           "--keep-order", "--hash", "frame", profile="main")


class DamagedMixedStreams(DamagedStreams):
    """The same for a stream with cluster GOFs and skinned GOFs."""

    def stream(self):
        return (ROOT / "streams/v1.1/accept/MIX/MIX-0201a.rlpc").read_bytes()


class DamagedHighStreams(DamagedStreams):
    """The same for streams with shared rigs."""

    def stream(self):
        return (ROOT / "streams/v1.2/accept/MDL/MDL-0005a.rlpc").read_bytes()


class Attributes(Clips):
    """Annex F: the same .rlpa, or the same rule."""

    def decode_both(self, data, case):
        stream, output = self.folder / "in.rlpc", self.folder / "out.rlpa"
        stream.write_bytes(data)
        output.unlink(missing_ok=True)
        done = subprocess.run([BIN / "rlpcdec", "decode", stream, output], capture_output=True,
                              text=True, check=False)
        rule = None
        if done.returncode != 0:
            word, _, text = done.stderr.splitlines()[-1].partition(" ")
            self.assertEqual(word, "rlpc-verdict", case)
            rule = json.loads(text).get("rule")
        found = output.read_bytes() if output.exists() else b""
        expected = run_attributes(data)
        self.assertEqual((done.returncode, rule), expected[:2], case)
        self.assertTrue(found == expected[2], f"{case}: other bytes")
        return rule

    def test_damaged_units(self):
        r = random.Random(11)
        rules = set()
        for path in sorted((ROOT / "streams/v1.2/accept/ATT").glob("*.rlpc")):
            data = path.read_bytes()
            if len(data) > 3000:
                continue
            for number in range(4):
                all_units = units_of(data)
                at = next(u for u, (code, _) in enumerate(all_units) if code == 0x88)
                payload = bytearray(all_units[at][1])
                if number == 3:
                    del payload[r.randrange(len(payload)):]
                else:
                    payload[r.randrange(min(len(payload), r.choice((12, 1000))))] ^= (
                        1 << r.randrange(8))
                all_units[at] = 0x88, bytes(payload)
                rules.add(self.decode_both(stream_of(data, all_units), f"{path.name} {number}"))
        self.assertGreaterEqual(rules, {None, "R-RNG-01", "R-BIT-01", "R-ATT-08"})

    def test_every_intermediate_fits_64_bits(self):
        for name in ("ATT-0006a", "ATT-0008a", "ATT-0010a", "ATT-0030a", "ATT-0033a"):
            data = (ROOT / f"streams/v1.2/accept/ATT/{name}.rlpc").read_bytes()
            self.assertEqual(run_attributes(data, widths=True)[0], 0, name)

    def test_units_do_not_matter_to_positions(self):
        data = (ROOT / "streams/v1.2/accept/ATT/ATT-0001a.rlpc").read_bytes()
        all_units = units_of(data)
        plain = stream_of(data, [unit for unit in all_units if unit[0] != 0x88])
        damaged = stream_of(data, [(code, b"\xff" if code == 0x88 else payload)
                                   for code, payload in all_units])
        for stream in (data, damaged):
            self.assertEqual(self.rlpcdec(stream), self.rlpcdec(plain))
            self.assertEqual(run_stream(stream), run_stream(plain))


def main():
    global BIN
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=pathlib.Path, required=True)
    options, rest = parser.parse_known_args()
    BIN = options.bin.resolve()
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
