#!/usr/bin/env python3
"""rlpcval and rlpcdec agree on random legal streams with slices, and on damaged copies; rlpcdec and
the suite on where streams break which rule.

    agreement_test.py --bin BUILD/bin [unittest arguments, such as Agreement]
"""

import json
import pathlib
import random
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "cli"))
from tools_testing import ROOT, ToolsTest, main, run

for folder in ("judge", "specdec", "rlpcgen"):
    sys.path.insert(0, str(ROOT / "conformance" / folder))
import random_high
from specdec_testing import PROGRAM, stream_of, units_of

SLICE = 6
RIG = 7


def damaged(stream, numbers):
    """The stream with one fault, of a kind drawn from `numbers`."""
    units = units_of(stream)
    slices = [u for u, (code, _) in enumerate(units) if code in (SLICE, RIG)]
    kind = numbers.choice(["flip", "flip", "flip", "payload", "cut", "short", "drop", "drop",
                           "swap", "move"])
    if kind == "cut":
        return stream[:numbers.randrange(len(stream))]
    if kind == "flip":
        data = bytearray(stream)
        data[numbers.randrange(len(data))] ^= 1 << numbers.randrange(8)
        return bytes(data)
    if kind == "drop":
        del units[numbers.choice(slices or range(len(units)))]
    elif kind == "swap":
        a, b = (numbers.choice(slices or range(len(units))) for _ in range(2))
        units[a], units[b] = units[b], units[a]
    elif kind == "move":
        unit = units.pop(numbers.choice(slices or range(len(units))))
        units.insert(numbers.randint(0, len(units)), unit)
    else:
        u = numbers.choice([u for u, (_, payload) in enumerate(units) if payload])
        code, payload = units[u]
        payload = bytearray(payload)
        if kind == "short":
            del payload[numbers.randrange(len(payload)):]
        else:
            payload[numbers.randrange(len(payload))] ^= 1 << numbers.randrange(8)
        units[u] = code, bytes(payload)
    return stream_of(stream, units)


class Agreement(ToolsTest):
    SEEDS = 25  # per profile
    FAULTS = 6  # damaged copies per stream

    def verdict_of_decoder(self, path):
        """(rule, bit), or None if rlpcdec decodes the stream."""
        result = run("rlpcdec", "decode", path, self.path("out.rlpd"))
        if result.code == 0:
            return None
        _, verdict = result.err.splitlines()[-1].split("rlpc-verdict ")
        verdict = json.loads(verdict)
        return verdict["rule"], verdict["bit"]

    def check(self, profile, num_rules):
        builder = random_high.builder_of(profile)(PROGRAM)
        paths = []
        for seed in range(self.SEEDS):
            good, numbers = builder.build(seed)[0], random.Random(seed)
            for number in range(self.FAULTS + 1):
                paths.append(self.path(f"{seed}-{number}.rlpc"))
                paths[-1].write_bytes(damaged(good, numbers) if number else good)
        streams = run("rlpcval", "--json", *paths).json()["streams"]
        rules = set()
        for path, stream in zip(paths, streams, strict=True):
            first = [(f["id"], f["bit"]) for f in stream["findings"] if f["stops_decoder"]]
            verdict = self.verdict_of_decoder(path)
            rules.add(verdict and verdict[0])
            self.assertEqual(first, [verdict] if verdict else [], path.name)
            if path.stem.endswith("-0"):
                self.assertEqual(stream["verdict"], "conforming", path.name)
        self.assertGreater(len(rules), num_rules)

    def test_first_rule_and_its_place_of_the_suite(self):
        places = sorted((ROOT / "streams").glob("v1.*/reject/*/*.json"))
        numbered = [(place, fields) for place in places
                    if "bit" in (fields := json.loads(place.read_text(encoding="utf-8")))]
        self.assertGreater(len(numbered), 300)
        for place, fields in numbered:
            self.assertEqual(self.verdict_of_decoder(place.with_suffix(".rlpc")),
                             (fields["rule"], fields["bit"]), place.name)

    def test_streams_cut_off_behind_frames_with_wrong_hashes(self):
        places = [p for p in sorted((ROOT / "streams").glob("v1.*/reject/*/*.json"))
                  if json.loads(p.read_text(encoding="utf-8"))["rules"] == ["R-HSH-02"]]
        self.assertGreater(len(places), 3)
        for place in places:
            stream = place.with_suffix(".rlpc").read_bytes()
            cut = self.path(place.stem + ".rlpc")
            units = units_of(stream)
            cut.write_bytes(stream_of(stream, units[:-1]))
            findings = run("rlpcval", "--json", cut).json()["streams"][0]["findings"]
            first = [(f["id"], f["bit"]) for f in findings if f["stops_decoder"]]
            self.assertEqual(first, [self.verdict_of_decoder(cut)], place.name)

    def test_first_rule_and_its_place_of_main_streams(self):
        self.check("main", 10)

    def test_first_rule_and_its_place_of_high_streams(self):
        self.check("high", 10)


if __name__ == "__main__":
    main()
