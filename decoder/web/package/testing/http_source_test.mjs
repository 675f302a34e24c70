// Run by package_test.py: servers that reject requests, hide headers or send too much.
import assert from "node:assert/strict";
import { test } from "node:test";

import { HttpSource } from "../src/http_source.js";

const kStream = Uint8Array.from({ length: 40000 }, (_, i) => i % 251);

/** Answers requests with `answer`, and counts them. */
function serve(answer) {
  const methods = [];
  globalThis.fetch = async (_, { method, headers }) => {
    methods.push(method);
    return answer(method, headers.get("range"));
  };
  return methods;
}

/** Makes a body in pieces of 10,000 bytes. sent: counts those taken, and records whether it was
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
    return range ? new Response(kStream.slice(0, 16384), { status: 206 })
      : new Response(inPieces());
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

test("ClosingEndsWhatIsLoaded", async () => {
  const sent = { pieces: 0, isCancelled: false };
  const signals = [];
  globalThis.fetch = async (_, { signal }) => {
    signals.push(signal);
    return new Response(inPieces(sent), { headers: { "content-length": `${kStream.length}` } });
  };
  const whole = source();
  await whole.open();
  const waits = whole.load(39000, 40000);
  whole.close();
  await assert.rejects(waits, { name: "AbortError" });
  assert.ok(signals[0].aborted);
  assert.ok(sent.isCancelled && sent.pieces < 4, `${sent.pieces}`);
});

test("ABodyOfMoreThanTheLimitIsCancelled", async () => {
  const sent = { pieces: 0, isCancelled: false };
  serve(() => new Response(inPieces(sent))); // unknown length
  await assert.rejects(source(15000).open(), { kind: "limit", message: /maxMemory, 15000 bytes/ });
  assert.equal(sent.isCancelled, true);
  assert.ok(sent.pieces <= 3, `${sent.pieces} pieces were loaded`);
});

test("AStreamThatIsShorterThanToldIsAnError", async () => {
  serve(() => new Response(inPieces(), { headers: { "content-length": "40001" } }));
  const whole = source();
  await whole.open();
  await assert.rejects(whole.load(40000, 40001),
    { kind: "network", message: /40000 bytes instead/ });
});

/** Makes a body without end. sent: see inPieces(). */
function endless(sent) {
  return new ReadableStream({
    pull(controller) {
      ++sent.pieces;
      controller.enqueue(new Uint8Array(10000));
    },
    cancel() {
      sent.isCancelled = true;
    },
  }, { highWaterMark: 0 });
}

/** Returns headers of a range of a stream of `size` bytes. */
function rangeOf(start, end, size = 1e9) {
  return { "content-range": `bytes ${start}-${end - 1}/${size}` };
}

test("ARangeWithoutAnEndIsCancelled", async () => {
  const sent = { pieces: 0, isCancelled: false };
  serve(() => new Response(endless(sent), { status: 206, headers: rangeOf(0, 16384) }));
  await assert.rejects(source().open(), { kind: "network", message: /more than the 16384 bytes/ });
  assert.equal(sent.isCancelled, true);
  assert.ok(sent.pieces <= 3, `${sent.pieces} pieces were loaded`);
});

test("ALaterRangeWithoutAnEndIsCancelled", async () => {
  const sent = { pieces: 0, isCancelled: false };
  serve((_, range) => (range === "bytes=0-16383"
    ? new Response(kStream.slice(0, 16384), { status: 206, headers: rangeOf(0, 16384) })
    : new Response(endless(sent), { status: 206, headers: rangeOf(20000, 45000) })));
  const ranged = source(1e6);
  await ranged.open();
  await assert.rejects(ranged.load(20000, 45000),
    { kind: "network", message: /more than the 25000/ });
  assert.equal(sent.isCancelled, true);
  assert.ok(sent.pieces <= 4, `${sent.pieces} pieces were loaded`);
});

test("ARangeFromAnotherPlaceIsAnError", async () => {
  serve(() => new Response(kStream.slice(1, 16385), { status: 206, headers: rangeOf(1, 16385) }));
  await assert.rejects(source().open(),
    { kind: "network", message: /bytes from 1 on instead of 0/ });
});

test("AWholeStreamInPlaceOfARangeIsNotLoadedBeyondTheLimit", async () => {
  const sent = { pieces: 0, isCancelled: false };
  serve((_, range) => (range === "bytes=0-16383"
    ? new Response(kStream.slice(0, 16384), { status: 206, headers: rangeOf(0, 16384) })
    : new Response(endless(sent))));
  const ranged = source(1e6);
  await ranged.open();
  await assert.rejects(ranged.load(20000, 45000), { kind: "limit" });
  assert.ok(sent.pieces <= 1, `${sent.pieces} pieces were loaded`);
});

test("ASizeThatIsNoNumberLeadsToTheWholeStreamWithinTheLimit", async () => {
  const sizes = ["bytes 0-16383/1" + "0".repeat(400), "bytes 0-16383/*"];
  for (const range of sizes) {
    const sent = { pieces: 0, isCancelled: false };
    serve((method) => (method === "HEAD" ? new Response(null, { status: 405 })
      : new Response(endless(sent), { status: 206, headers: { "content-range": range } })));
    await assert.rejects(source(50000).open(), { kind: "limit" });
    assert.ok(sent.pieces <= 7, `${sent.pieces} pieces were loaded`);
  }
});
