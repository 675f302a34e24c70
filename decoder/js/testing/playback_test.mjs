// Run by package_test.py: which frames src/playback.js shows, with a decoder that is late.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Playback } from "../src/playback.js";

/** Answers requests `delay` ticks later; 10 frames a second, a tick is 50 ms. */
class Bench {
  constructor(frames, delay, ahead = 4) {
    this.delay = delay;
    this.now = 0;
    this.asked = [];
    this.numAsked = 0;
    this.numCancelled = 0;
    this.discarded = 0;
    this.shown = [];
    this.failing = new Set();
    this.failures = [];
    this.playback = new Playback({
      frames, frameRate: 10, ahead,
      request: (index, signal) => new Promise((resolve, reject) => {
        ++this.numAsked;
        const entry = { index, at: this.now + this.delay, resolve, reject };
        this.asked.push(entry);
        signal.addEventListener("abort", () => {
          ++this.numCancelled;
          this.asked = this.asked.filter((other) => other !== entry);
          reject(signal.reason);
        });
      }),
      discard: () => ++this.discarded,
      failed: (error, index) => this.failures.push(index),
    });
  }

  async run(ticks) {
    for (let i = 0; i < ticks; ++i) {
      ++this.now;
      while (this.asked.length > 0 && this.asked[0].at <= this.now) {
        const { index, resolve, reject } = this.asked.shift();
        if (this.failing.has(index)) reject(new Error("damaged"));
        else resolve({ index });
        await new Promise((next) => setImmediate(next));
      }
      const reply = this.playback.tick(0.05);
      if (reply) this.shown.push(reply.index);
    }
    return this.shown;
  }
}

test("ShowsEachFrameInOrderAndStartsAgain", async () => {
  const bench = new Bench(5, 1);
  bench.playback.play();
  assert.deepEqual((await bench.run(25)).slice(0, 12), [0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 0, 1]);
  assert.equal(bench.discarded, 0);
});

test("KeepsTimeWhenDecodingIsFastEnough", async () => {
  const bench = new Bench(1000, 1);
  bench.playback.play();
  await bench.run(200);
  assert.ok(Math.abs(bench.playback.frame - 100) <= 2, `${bench.playback.frame}`);
});

test("LeavesNoFrameOutWhenDecodingIsSlow", async () => {
  const bench = new Bench(1000, 9);
  bench.playback.play();
  const shown = await bench.run(200);
  assert.deepEqual(shown, shown.map((_, i) => i));
  assert.ok(shown.length > 20 && shown.length < 60, `${shown.length}`);
});

test("FastPlaybackShowsOnlyTheLastFrameThatIsDue", async () => {
  const bench = new Bench(1000, 0);
  bench.playback.setSpeed(4);
  bench.playback.play();
  const shown = await bench.run(50);
  assert.ok(shown.every((frame, i) => i === 0 || frame > shown[i - 1]));
  assert.ok(shown.at(-1) > 80, `${shown.at(-1)}`);
  assert.equal(shown.length + bench.discarded, shown.at(-1) + 1);
});

test("SeekingWhilePausedCancelsAllFramesButTheLast", async () => {
  const bench = new Bench(100, 2);
  await bench.run(5);
  for (const frame of [10, 20, 30, 40]) bench.playback.seek(frame);
  assert.equal(bench.asked.length, 1);
  assert.deepEqual(await bench.run(10), [0, 40]);
  assert.deepEqual(bench.asked, []);
});

test("SeekingWhilePlayingGoesOnFromThere", async () => {
  const bench = new Bench(100, 1);
  bench.playback.play();
  await bench.run(10);
  bench.playback.seek(50);
  assert.deepEqual((await bench.run(10)).filter((frame) => frame >= 50).slice(0, 3), [50, 51, 52]);
});

test("ARangeIsPlayedAlone", async () => {
  const bench = new Bench(100, 1);
  bench.playback.setRange(20, 3);
  bench.playback.play();
  assert.deepEqual((await bench.run(20)).slice(0, 7), [20, 21, 22, 20, 21, 22, 20]);
  bench.playback.seek(90);
  assert.equal(bench.playback.frame, 22);
});

test("ARangePlayedOnceEndsAndCanStartAgain", async () => {
  const bench = new Bench(100, 1);
  let ends = 0;
  bench.playback.finished = () => ++ends;
  bench.playback.setLoop("once");
  bench.playback.setRange(5, 3);
  bench.playback.play();
  assert.deepEqual(await bench.run(40), [5, 6, 7]);
  assert.equal(ends, 1);
  assert.equal(bench.playback.playing, false);
  bench.playback.play();
  assert.deepEqual(await bench.run(40), [5, 6, 7, 5, 6, 7]);
  assert.equal(ends, 2);
});

test("PingPongTurnsAtBothEnds", async () => {
  const bench = new Bench(4, 1);
  bench.playback.setLoop("pingpong");
  bench.playback.play();
  assert.deepEqual((await bench.run(40)).slice(0, 10), [0, 1, 2, 3, 2, 1, 0, 1, 2, 3]);
});

test("PlaysBackwards", async () => {
  const bench = new Bench(10, 1);
  bench.playback.seek(3);
  bench.playback.setSpeed(-1);
  bench.playback.play();
  assert.deepEqual((await bench.run(20)).slice(0, 6), [3, 2, 1, 0, 9, 8]);
});

test("PlayingGoesOnPastFramesThatCannotBeDecoded", async () => {
  const bench = new Bench(5, 1);
  bench.failing.add(2);
  bench.playback.play();
  assert.deepEqual((await bench.run(12)).slice(0, 4), [0, 1, 2, 3]);
  assert.equal(bench.failures[0], 2);
});

for (const [frames, delay] of [[2, 0], [3, 0], [3, 1], [7, 0], [7, 1], [7, 5]]) {
  test(`AsksForEachFrameOnceInTurn (${frames} frames, delay ${delay})`, async () => {
    const bench = new Bench(frames, delay, 8);
    bench.playback.play();
    const shown = await bench.run(400);
    assert.deepEqual(shown, shown.map((_, i) => i % frames));
    assert.ok(shown.length > 60, `${shown.length}`);
    // What is not shown yet is on its way, or waits: each other frame at most once.
    assert.ok(bench.numAsked - shown.length < frames, `${bench.numAsked}`);
    assert.equal(bench.discarded, 0);
  });
}

test("AStillMeshIsShownOnceAndDoesNotPlay", async () => {
  const bench = new Bench(1, 0, 8);
  bench.playback.play();
  assert.equal(bench.playback.playing, false);
  await bench.run(30);
  assert.deepEqual(bench.shown, [0]);
  assert.equal(bench.playback.frame, 0);
  assert.equal(bench.numAsked, 1);
});
