// Run by package_test.py: loaded parts of a stream.
import assert from "node:assert/strict";
import { test } from "node:test";

import { ByteRanges } from "../src/byte_ranges.js";

const kBytes = Uint8Array.from({ length: 100 }, (_, i) => i);

function add(ranges, start, end) {
  ranges.add(start, kBytes.slice(start, end));
}

function read(ranges, start, end) {
  const out = new Uint8Array(end - start);
  return ranges.copy(start, out) ? [...out] : undefined;
}

test("BytesAreReadAcrossParts", () => {
  const ranges = new ByteRanges();
  add(ranges, 20, 30);
  add(ranges, 10, 20);
  add(ranges, 30, 31);
  assert.deepEqual(read(ranges, 12, 31), [...kBytes.slice(12, 31)]);
  assert.equal(read(ranges, 12, 32), undefined);
  assert.equal(read(ranges, 9, 12), undefined);
  assert.deepEqual(read(ranges, 40, 40), []);
});

test("GapsAreFoundFromTheLeft", () => {
  const ranges = new ByteRanges();
  assert.deepEqual(ranges.gap(5, 9), [5, 9]);
  add(ranges, 10, 20);
  add(ranges, 30, 40);
  assert.deepEqual(ranges.gap(5, 50), [5, 10]);
  assert.deepEqual(ranges.gap(10, 50), [20, 30]);
  assert.deepEqual(ranges.gap(35, 50), [40, 50]);
  assert.equal(ranges.gap(12, 18), undefined);
  assert.equal(ranges.gap(50, 50), undefined);
});

test("PartsThatOverlapAreKeptOnce", () => {
  const ranges = new ByteRanges();
  add(ranges, 10, 20);
  add(ranges, 30, 40);
  add(ranges, 5, 50);
  assert.equal(ranges.numBytes, 45);
  assert.deepEqual(read(ranges, 5, 50), [...kBytes.slice(5, 50)]);
});

test("ThePartUsedLongestAgoGoesFirst", () => {
  const ranges = new ByteRanges(20);
  add(ranges, 0, 10);
  add(ranges, 20, 30);
  read(ranges, 0, 10);
  ranges.protect();
  add(ranges, 40, 50);
  assert.equal(ranges.numBytes, 20);
  assert.equal(read(ranges, 20, 30), undefined);
  assert.deepEqual(read(ranges, 0, 10), [...kBytes.slice(0, 10)]);
});

test("PartsInUseStay", () => {
  const ranges = new ByteRanges(20);
  ranges.protect();
  for (const start of [0, 20, 40, 60]) add(ranges, start, start + 10);
  assert.equal(ranges.numBytes, 40);
  ranges.protect();
  add(ranges, 80, 90);
  assert.equal(ranges.numBytes, 20);
  assert.deepEqual(read(ranges, 80, 90), [...kBytes.slice(80, 90)]);
});
