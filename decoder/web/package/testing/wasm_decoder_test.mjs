// Run by package_test.py: a module that runs out of memory.
import assert from "node:assert/strict";
import { test } from "node:test";

import { ByteRanges } from "../src/byte_ranges.js";
import { WasmDecoder } from "../src/wasm_decoder.js";
import { WasmAttributes } from "../src/wasm_attributes.js";

/** Makes a decoder whose export `name` traps, as all do when memory cannot grow. */
function without(name) {
  const decoder = new WasmDecoder();
  const memory = { buffer: new ArrayBuffer(64) };
  const known = { memory };
  decoder.exports = new Proxy(known, {
    get: (_, wanted) => known[wanted] ?? (() => {
      if (wanted === name) throw new WebAssembly.RuntimeError("unreachable");
      return 1;
    }),
  });
  return decoder;
}

function streamWithout(name) {
  return without(name).stream(new ByteRanges(), 100, {});
}

const kLimit = { name: "RlpcError", kind: "limit" };

test("AnyExportThatRunsOutOfMemoryIsALimit", () => {
  assert.throws(() => streamWithout("stream_new"), kLimit);
  assert.throws(() => streamWithout("stream_decode").decode(0), kLimit);
  assert.throws(() => streamWithout("stream_describe").describe(), kLimit);
  assert.throws(() => streamWithout("stream_edges").edges(), kLimit);
  assert.throws(() => streamWithout("stream_triangles").triangles(1), kLimit);
  const attributes = new WasmAttributes(streamWithout("stream_num_drawn"),
    { num_triangles: 1, num_vertices: 3 });
  assert.throws(() => attributes.drawn(), kLimit);
});

test("NothingIsDecodedAfterThat", () => {
  const stream = streamWithout("stream_edges");
  assert.equal(stream.comparedFrames(), 1);
  assert.throws(() => stream.edges(), kLimit);
  assert.throws(() => stream.comparedFrames(), kLimit);
});
