// Run by package_test.py: assets whose JSON would take much memory or stack.
import assert from "node:assert/strict";
import { test } from "node:test";

import { checkAsset, measureJson } from "../src/asset_limit.js";

function glbOf(text) {
  const json = new TextEncoder().encode(text);
  const glb = new Uint8Array(20 + json.length);
  const view = new DataView(glb.buffer);
  view.setUint32(0, 0x46546c67, true);
  view.setUint32(4, 2, true);
  view.setUint32(8, glb.length, true);
  view.setUint32(12, json.length, true);
  view.setUint32(16, 0x4e4f534a, true);
  glb.set(json, 20);
  return glb;
}

test("ObjectsOfASmallStreamCountTowardsTheLimit", () => {
  const bomb = glbOf(`{"materials":[${"[],".repeat(1e6)}0]}`);
  assert.throws(() => checkAsset(bomb, 50e6), { kind: "limit", element: "asset_size" });
  assert.doesNotThrow(() => checkAsset(bomb, 500e6));
});

test("NestingIsLimited", () => {
  const nested = (depth) => glbOf("[".repeat(depth) + "]".repeat(depth));
  assert.doesNotThrow(() => checkAsset(nested(100), 1e6));
  assert.throws(() => checkAsset(nested(101), 1e6), { kind: "invalid", message: /100 levels/ });
  assert.throws(() => checkAsset(nested(200000), 1e9), { kind: "invalid" });
});

test("StringsHoldNoStructure", () => {
  const text = new TextEncoder().encode(JSON.stringify({ a: '[[,,{{\\"[' }));
  assert.equal(measureJson(text).deepest, 1);
  assert.deepEqual(measureJson(text), { bytes: 2 * 160 + 4 * text.length, deepest: 1 });
});

test("WhatIsNoGlbIsLeftToItsReader", () => {
  for (const size of [0, 5, 19, 20, 21]) {
    assert.doesNotThrow(() => checkAsset(new Uint8Array(size), 1e4));
  }
  const cut = glbOf("[[[[").subarray(0, 22);
  assert.doesNotThrow(() => checkAsset(cut, 1e4));
});

/** Returns the memory of objects in the engine that runs this. */
test("TheBoundHolds", () => {
  const items = ["[]", "{}", "0", '""', "[[]]", '{"a":0}', '{"a":{"b":[]}}', '"abcdefgh"', "1.5"];
  for (const item of items) {
    const text = `[${Array(100000).fill(item).join()}]`;
    global.gc?.();
    const before = process.memoryUsage().heapUsed;
    const value = JSON.parse(text);
    const taken = process.memoryUsage().heapUsed - before;
    assert.equal(value.length, 100000);
    const { bytes } = measureJson(new TextEncoder().encode(text));
    assert.ok(taken <= bytes + 1e6, `${item}: ${taken}`);
  }
});
