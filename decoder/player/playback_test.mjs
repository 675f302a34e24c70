// Run by player_test.py: which frames playback.js shows, with a decoder that is late.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Playback } from "./playback.js";

/** Answers requests `delay` ticks later; 10 frames a second, a tick is 50 ms. */
class Bench {
  constructor(numFrames, delay, framesAhead = 4) {
    this.delay = delay;
    this.now = 0;
    this.asked = [];
    this.numAsked = 0;
    this.discarded = 0;
    this.shown = [];
    this.playback = new Playback({
      numFrames, framesPerSecond: 10, framesAhead,
      request: (frame, order) => {
        ++this.numAsked;
        this.asked.push({ frame, order, at: this.now + this.delay });
      },
      discard: () => ++this.discarded,
    });
  }

  run(ticks) {
    for (let i = 0; i < ticks; ++i) {
      ++this.now;
      while (this.asked.length > 0 && this.asked[0].at <= this.now) {
        const { frame, order } = this.asked.shift();
        this.playback.receive({ frame, order });
      }
      const reply = this.playback.tick(0.05);
      if (reply) this.shown.push(reply.frame);
    }
    return this.shown;
  }
}

test("ShowsEachFrameInOrderAndStartsAgain", () => {
  const bench = new Bench(5, 1);
  bench.playback.play();
  assert.deepEqual(bench.run(25).slice(0, 12), [0, 1, 2, 3, 4, 0, 1, 2, 3, 4, 0, 1]);
  assert.equal(bench.discarded, 0);
});

test("KeepsTimeWhenDecodingIsFastEnough", () => {
  const bench = new Bench(1000, 1);
  bench.playback.play();
  bench.run(200);
  assert.ok(Math.abs(bench.playback.frame - 100) <= 2, `${bench.playback.frame}`);
});

test("LeavesNoFrameOutWhenDecodingIsSlow", () => {
  const bench = new Bench(1000, 9);
  bench.playback.play();
  const shown = bench.run(200);
  assert.deepEqual(shown, shown.map((_, i) => i));
  assert.ok(shown.length > 20 && shown.length < 60, `${shown.length}`);
});

test("FastPlaybackShowsOnlyTheLastFrameThatIsDue", () => {
  const bench = new Bench(1000, 0);
  bench.playback.speed = 4;
  bench.playback.play();
  const shown = bench.run(50);
  assert.ok(shown.every((frame, i) => i === 0 || frame > shown[i - 1]));
  assert.ok(shown.at(-1) > 80, `${shown.at(-1)}`);
  assert.equal(shown.length + bench.discarded, shown.at(-1) + 1);
});

test("SeekingWhilePausedAsksForThatFrameAlone", () => {
  const bench = new Bench(100, 2);
  bench.run(5);
  for (const frame of [10, 20, 30, 40]) bench.playback.seek(frame);
  assert.deepEqual(bench.run(10), [0, 40]);
  assert.deepEqual(bench.asked, []);
});

test("SeekingWhilePlayingGoesOnFromThere", () => {
  const bench = new Bench(100, 1);
  bench.playback.play();
  bench.run(10);
  bench.playback.seek(50);
  assert.deepEqual(bench.run(10).filter((frame) => frame >= 50).slice(0, 3), [50, 51, 52]);
});

for (const [numFrames, delay] of [[2, 0], [3, 0], [3, 1], [7, 0], [7, 1], [7, 5]]) {
  test(`AsksForEachFrameOnceInTurn (${numFrames} frames, delay ${delay})`, () => {
    const bench = new Bench(numFrames, delay, 8);
    bench.playback.play();
    const shown = bench.run(400);
    assert.deepEqual(shown, shown.map((_, i) => i % numFrames));
    assert.ok(shown.length > 60, `${shown.length}`);
    // What is not shown yet is on its way, or waits: each other frame at most once.
    assert.ok(bench.numAsked - shown.length < numFrames, `${bench.numAsked}`);
    assert.equal(bench.discarded, 0);
  });
}

test("AStillMeshIsShownOnceAndDoesNotPlay", () => {
  const bench = new Bench(1, 0, 8);
  bench.playback.play();
  assert.equal(bench.playback.playing, false);
  bench.run(30);
  assert.deepEqual(bench.shown, [0]);
  assert.equal(bench.playback.frame, 0);
  assert.equal(bench.numAsked, 1);
});
