// Run by package_test.py: frames that src/playback.js shows with a late decoder.
import assert from "node:assert/strict";
import { test } from "node:test";

import { clipSeconds, nearestFrame, placeAt } from "../src/clip_time.js";
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
    // Frames that are not shown yet are requested or ready: each other frame at most once.
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

/** Makes a playback whose frames are ready at once, as with a fast decoder. */
function playing(count, frameRate, loop) {
  const playback = new Playback({ frames: count, frameRate, ahead: 8,
    request: (index) => Promise.resolve({ index }) });
  playback.setLoop(loop);
  playback.play();
  return playback;
}

const settled = () => new Promise((next) => setImmediate(next));

/** Returns the time for which each frame is shown, in intervals, counted on `fine` pictures per
 * interval. */
async function shares(playback, intervals, fine) {
  const shares = new Map();
  await settled();
  for (let i = 0; i < intervals * fine; ++i) {
    playback.tick(i === 0 ? 0 : 1 / (fine * playback.frameRate));
    await settled();
    shares.set(playback.frame, (shares.get(playback.frame) ?? 0) + 1 / fine);
  }
  return shares;
}

test("ALoopLastsOneIntervalLessThanItsFrames", async () => {
  const turns = 3;
  const last = 10; // same pose as 0: together they take one interval
  const shown = await shares(playing(last + 1, 32, "repeat"), turns * last, 64);
  for (let k = 1; k < last; ++k) assert.ok(Math.abs(shown.get(k) - turns) < 0.1, `${k}`);
  assert.ok(Math.abs(shown.get(0) + shown.get(last) - turns) < 0.1);
});

test("TheLastPoseIsThatOfTheEnd", async () => {
  const playback = playing(11, 32, "once");
  let ends = 0;
  playback.finished = () => ++ends;
  await settled();
  for (let i = 0; i < 10 * 64 + 1; ++i) {
    assert.equal(ends, 0);
    playback.tick(i === 0 ? 0 : 1 / (64 * 32));
    await settled();
  }
  assert.equal(ends, 1);
  assert.deepEqual([playback.frame, playback.seconds], [10, playback.duration]);
  assert.equal(playback.duration, 10 / 32);
});

/** Makes a generator of numbers below n. */
function random(seed) {
  let state = seed;
  return (n) => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return Math.floor((state / 2 ** 32) * n);
  };
}

// Returns the time that AnimationAction of three.js computes in a clip that lasts
// (n - 1) / frameRate.
function timeInClip(seconds, duration, loop) {
  if (loop === "once") return Math.min(seconds, duration);
  const turn = Math.floor(seconds / duration);
  const within = seconds - turn * duration;
  return loop === "pingpong" && turn % 2 === 1 ? duration - within : within;
}

test("PlacesAreThoseOfAnAnimationOfTheSameDuration", () => {
  const below = random(1);
  for (let i = 0; i < 10000; ++i) {
    const frames = 2 + below(200);
    const frameRate = [24, 25, 30, 60, 30000 / 1001, 12.5][below(6)];
    const loop = ["repeat", "once", "pingpong"][below(3)];
    const seconds = below(1e6) / 1e4;
    const duration = clipSeconds(frames, frameRate);
    assert.ok(Math.abs(duration * frameRate - frames + 1) < 1e-9);
    const place = placeAt(seconds * frameRate, frames, loop);
    assert.ok(place >= 0 && place <= frames - 1);
    const difference = Math.abs(place - timeInClip(seconds, duration, loop) * frameRate);
    assert.ok(difference < 1e-6 || (loop === "repeat" && difference > frames - 1 - 1e-6),
      `${difference}`);
  }
  assert.equal(placeAt(7.5, 1, "repeat"), 0);
});

for (const loop of ["repeat", "once", "pingpong"]) {
  test(`ShowsTheNearestFrameHoweverPicturesCome (${loop})`, async () => {
    const below = random(7);
    for (let i = 0; i < 30; ++i) {
      const count = 2 + below(9);
      const frameRate = [24, 25, 30, 60][below(4)];
      const playback = playing(count, frameRate, loop);
      let seconds = 0;
      await settled();
      playback.tick(0);
      await settled();
      for (let j = 0; j < 60; ++j) {
        const delta = below(1000) / 2000 / frameRate; // at most one frame, so that none is late
        playback.tick(delta);
        await settled();
        seconds += delta;
        const place = timeInClip(seconds, (count - 1) / frameRate, loop) * frameRate;
        const off = Math.abs(place - playback.frame);
        const wrapped = loop === "repeat" ? count - 1 - off : off; // the end is the start
        assert.ok(Math.min(off, wrapped) <= 0.5 + 1e-6, `${place} ${playback.frame}`);
        assert.ok(Math.abs(playback.seconds * frameRate - place) < 1e-6 ||
                  Math.abs(count - 1 - Math.abs(playback.seconds * frameRate - place)) < 1e-6);
      }
    }
  });
}

/** Returns the difference between the times of a playback and a clip, in intervals. */
function timeOff({ seconds, frameRate, count, speed }, played, loop) {
  const duration = (count - 1) / frameRate;
  const within = timeInClip(played, duration, loop);
  const off = frameRate * Math.abs(seconds - (speed < 0 ? duration - within : within));
  return loop === "once" ? off : Math.min(off, Math.abs(count - 1 - off)); // the end is the start
}

// hasAll: frames are in memory; otherwise, each is decoded before the next picture.
for (const loop of ["repeat", "once", "pingpong"]) {
  for (const hasAll of [false, true]) {
    test(`TimeNeverWaitsForFramesThatAreThere (${loop}, in memory: ${hasAll})`, async () => {
      const below = random(11);
      for (let i = 0; i < 60; ++i) {
        const interpolates = i % 2 === 0;
        const frameRate = [24, 25, 30000 / 1001, 12.5][below(4)];
        const playback = new Playback({ frames: 40, frameRate, ahead: 1 + below(4), interpolates,
          request: (index) => Promise.resolve({ index }),
          peek: (index) => (hasAll ? { index } : undefined) });
        playback.setSpeed([1, -1, 0.5, -2][below(4)]);
        playback.setLoop(loop);
        playback.setRange(below(20), 2 + below(i < 30 ? 4 : 18));
        playback.play();
        await settled();
        playback.tick(0);
        let played = 0;
        for (let j = 0; j < 60; ++j) {
          await settled();
          const max = hasAll ? 3 : 0.45; // intervals
          const delta = max * (below(1000) / 1000) / frameRate / Math.abs(playback.speed);
          playback.tick(delta);
          played += delta * Math.abs(playback.speed);
          const off = timeOff(playback, played, loop);
          const { count, ahead } = playback;
          assert.ok(off < 1e-6, `${loop} ${count} frames, ahead ${ahead}: ${off}`);
        }
      }
    });
  }
}

for (const loop of ["repeat", "once", "pingpong"]) {
  test(`ALongRestTakesOneTurn (${loop})`, async () => {
    const playback = new Playback({ frames: 10, frameRate: 10, interpolates: true,
      request: () => new Promise(() => {}), peek: (index) => ({ index }) });
    let turns = 0;
    playback.looped = () => ++turns;
    playback.setLoop(loop);
    playback.play();
    playback.tick(0);
    for (const rest of [3600.2, 1e300]) playback.tick(rest);
    assert.ok(turns <= 8, `${turns}`);
    assert.equal(turns > 0, loop !== "once");
    assert.equal(playback.playing, loop !== "once");
    if (loop === "once") return;
    playback.setRange(0, 10);
    playback.play();
    playback.tick(0);
    playback.tick(3600.25);
    assert.ok(timeOff(playback, 3600.25, loop) < 1e-6);
  });
}

test("TimesAreNumbersAndDoNotGoBack", async () => {
  const playback = playing(10, 10, "repeat");
  await settled();
  playback.tick(0);
  playback.tick(0.12);
  for (const wrong of [NaN, Infinity, undefined]) {
    assert.throws(() => playback.tick(wrong), RangeError);
  }
  for (const wrong of [NaN, Infinity, "2"]) {
    assert.throws(() => playback.setSpeed(wrong), RangeError);
  }
  for (const wrong of [NaN, undefined]) {
    assert.throws(() => playback.seekSeconds(wrong), RangeError);
  }
  playback.tick(-5); // pictures may have been requested before the clock was read
  assert.ok(Math.abs(playback.seconds - 0.12) < 1e-9);
});

test("OnlyWhatRepeatsTurns", async () => {
  const playback = playing(3, 10, "once");
  let turns = 0;
  playback.looped = () => ++turns;
  await settled();
  for (let i = 0; i < 20; ++i) {
    playback.tick(0.05);
    await settled();
  }
  assert.deepEqual([turns, playback.playing], [0, false]);
});

test("SeekingToATimeShowsTheNearestFrameAndKeepsTheTime", () => {
  const request = () => new Promise(() => {});
  const playback = new Playback({ frames: 100, frameRate: 10, request });
  playback.setRange(20, 11);
  for (const [seconds, frame] of [[0, 20], [0.04, 20], [0.06, 21], [0.5, 25], [1, 30]]) {
    playback.seekSeconds(seconds);
    assert.equal(playback.frame, frame);
    assert.ok(Math.abs(playback.seconds - seconds) < 1e-9);
  }
  playback.seekSeconds(7);
  assert.deepEqual([playback.frame, playback.seconds], [30, 1]);
  playback.seekSeconds(-7);
  assert.deepEqual([playback.frame, playback.seconds], [20, 0]);
  playback.seekSeconds(0.3);
  playback.setSpeed(-1);
  assert.deepEqual([playback.frame, nearestFrame(10 * playback.seconds)], [23, 3]);
});
