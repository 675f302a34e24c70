// Run by package_test.py: servers that refuse, hide or send more than they should.
import assert from "node:assert/strict";
import { test } from "node:test";

import { HttpSource } from "../src/http_source.js";

const kStream = Uint8Array.from({ length: 40000 }, (_, i) => i % 251);

/** Answers requests as `answer` says, and counts them. */
function serve(answer) {
  const methods = [];
  globalThis.fetch = async (_, { method, headers }) => {
    methods.push(method);
    return answer(method, headers.get("range"));
  };
  return methods;
}

/** A body in pieces of 10,000 bytes; sent: tells how many were taken, and whether it was
 * cancelled. */
function inPieces(sent = { pieces: 0, isCancelled: false }) {
  return new ReadableStream({
    async pull(controller) {
      await new Promise((next) => setTimeout(next, 1));
      const start = 10000 * sent.pieces++;
      if (start >= kStream.length) return controller.close();
      return controller.enqueue(kStream.slice(start, start + 10000));
    },
    cancel() {
      sent.isCancelled = true;
    },
  }, { highWaterMark: 0 });
}

function source(maxBytes = Infinity) {
  return new HttpSource({ url: "walk.rlpc", headers: [], maxBytes }, () => {});
}

function bytesOf(whole, start, end) {
  const bytes = new Uint8Array(end - start);
  assert.ok(whole.ranges.copy(start, bytes));
  return bytes;
}

test("WithoutASizeTheWholeStreamIsLoaded", async () => {
  // Ranges, but neither Content-Range nor HEAD.
  const methods = serve((method, range) => {
    if (method === "HEAD") return new Response(null, { status: 405 });
    return range ? new Response(kStream.slice(0, 16384), { status: 206 }) : new Response(inPieces());
  });
  const whole = source();
  await whole.open();
  assert.deepEqual(methods, ["GET", "HEAD", "GET"]);
  assert.equal(whole.size, kStream.length);
  assert.deepEqual(bytesOf(whole, 0, kStream.length), kStream);
});

test("AllWhoWaitForPartsOfAWholeStreamGetThem", async () => {
  serve(() => new Response(inPieces(), { headers: { "content-length": `${kStream.length}` } }));
  const whole = source();
  await whole.open();
  const parts = [[35000, 40000], [9000, 11000], [25000, 26000], [39999, 40000]];
  await Promise.all(parts.map(([start, end]) => whole.load(start, end)));
  for (const [start, end] of parts) {
    assert.deepEqual(bytesOf(whole, start, end), kStream.slice(start, end));
  }
});

test("ABodyOfMoreThanTheLimitIsCancelled", async () => {
  const sent = { pieces: 0, isCancelled: false };
  serve(() => new Response(inPieces(sent))); // of unknown length
  await assert.rejects(source(15000).open(), { kind: "limit", message: /maxMemory, 15000 bytes/ });
  assert.equal(sent.isCancelled, true);
  assert.ok(sent.pieces <= 3, `${sent.pieces} pieces were loaded`);
});

test("AStreamThatIsShorterThanToldIsAnError", async () => {
  serve(() => new Response(inPieces(), { headers: { "content-length": "40001" } }));
  const whole = source();
  await whole.open();
  await assert.rejects(whole.load(40000, 40001), { kind: "network", message: /40000 bytes instead/ });
});
