// Run by package_test.py: pictures of RLPCMesh between frames, and under actions of an
// AnimationMixer.
import assert from "node:assert/strict";
import { test } from "node:test";

import {
  AnimationClip, AnimationMixer, AnimationUtils, LoopOnce, LoopPingPong, LoopRepeat, Object3D,
  PerspectiveCamera, Raycaster, Vector3, VectorKeyframeTrack,
} from "three";

import { clipAnimation } from "../src/clip_animations.js";
import { normalsOf, positionsOf, random, settled } from "./fake_decoder.mjs";
import {
  assertBounds, assertNear, between, kClips, meshOf, positions,
} from "./mesh_helpers.mjs";

test("BetweenFramesItShowsTheirLinearMix", async () => {
  const next = random(3);
  const { mesh } = await meshOf({ frames: 40, vertices: 7 });
  for (let i = 0; i < 200; ++i) {
    const place = 39 * next();
    await mesh.seek(place / 30);
    assertNear(positions(mesh), between(place, 7), 1e-5, `place ${place}`);
    assert.ok(Math.abs(mesh.time * 30 - place) < 1e-6);
    assert.equal(mesh.frame, Math.round(place));
    assertBounds(mesh);
    const { array } = mesh.geometry.attributes.normal;
    for (let v = 0; v < 7; ++v) {
      assert.ok(Math.abs(Math.hypot(...array.subarray(3 * v, 3 * v + 3)) - 1) < 1e-5);
    }
  }
});

test("AtAFrameItIsExact", async () => {
  const { mesh } = await meshOf({ frames: 1000, frameRate: 24000 / 1001 });
  for (const index of [0, 1, 2, 7, 333, 998, 999]) {
    await mesh.seek(index * 1001 / 24000);
    assert.deepEqual(positions(mesh), positionsOf(index, 5));
    assert.deepEqual(mesh.geometry.attributes.normal.array, normalsOf(index, 5));
  }
});

test("WithoutInterpolationItShowsTheNearestFrame", async () => {
  const { mesh } = await meshOf({}, { interpolate: false });
  assert.equal(mesh.interpolate, false);
  for (const [place, index] of [[3.4, 3], [3.6, 4], [58.7, 59]]) {
    await mesh.seek(place / 30);
    assert.deepEqual(positions(mesh), positionsOf(index, 5));
  }
  mesh.interpolate = true;
  await mesh.seek(3.5 / 30);
  assertNear(positions(mesh), between(3.5, 5), 1e-5, "after switching it on");
});

for (const speed of [1, -1]) {
  for (const loop of [LoopRepeat, LoopPingPong]) {
    test(`PlaysBetweenFrames (speed ${speed}, loop ${loop})`, async () => {
      const { mesh } = await meshOf({ clips: kClips });
      const next = random(5);
      Object.assign(mesh, { loop, speed });
      mesh.play("run");
      await settled();
      mesh.update(0);
      await settled();
      let seconds = 0;
      let loops = 0;
      mesh.addEventListener("loop", () => ++loops);
      for (let i = 0; i < 400; ++i) {
        const delta = 0.02 * next();
        seconds += delta;
        mesh.update(delta);
        await settled();
        const turn = Math.floor(seconds * 30 / 8);
        let place = seconds * 30 - 8 * turn;
        if (loop === LoopPingPong && turn % 2 === 1) place = 8 - place;
        if (speed < 0) place = 8 - place;
        assertNear(positions(mesh), between(12 + place, 5), 1e-3, `picture ${i}`);
        assertBounds(mesh);
      }
      assert.equal(loops, Math.floor(seconds * 30 / 8));
    });
  }
}

/** Runs the same actions on an object whose values are all positions, by three.js itself. */
class Reference {
  constructor(mesh) {
    this.root = new Object3D();
    this.root.values = Array.from(positionsOf(0, mesh.decoder.info.vertices));
    this.mixer = new AnimationMixer(this.root);
    const { vertices, frameRate } = mesh.decoder.info;
    this.clips = mesh.decoder.clips.map(({ name, firstFrame, frames }) => {
      const times = Array.from({ length: frames }, (_, k) => k / frameRate);
      const values = times.flatMap((_, k) => Array.from(positionsOf(firstFrame + k, vertices)));
      return new AnimationClip(name, (frames - 1) / frameRate,
        [new VectorKeyframeTrack(".values", times, values)]);
    });
  }
}

/** Applies a random change to an action of both. */
function act(next, both) {
  const [chosen, other] = [Math.floor(2 * next()), Math.floor(2 * next())];
  const kind = Math.floor(9 * next());
  const numbers = [next(), next()];
  for (const actions of both) {
    const action = actions[chosen];
    if (kind === 0) action.reset().play();
    if (kind === 1) action.reset().fadeIn(numbers[0] / 2).play();
    if (kind === 2) action.fadeOut(numbers[0] / 2);
    if (kind === 3) action.setEffectiveTimeScale(3 * numbers[0] - 1);
    if (kind === 4) {
      const loop = [LoopRepeat, LoopOnce, LoopPingPong][Math.floor(3 * numbers[0])];
      action.setLoop(loop, loop === LoopOnce ? 1 : Infinity);
      action.clampWhenFinished = numbers[1] < 0.5;
    }
    if (kind === 5) action.setEffectiveWeight(numbers[0]);
    if (kind === 6) action.stop();
    if (kind === 7 && chosen !== other) {
      actions[other].reset().setEffectiveWeight(1).play();
      action.crossFadeTo(actions[other], numbers[0], numbers[1] < 0.5);
    }
    if (kind === 8) action.warp(1, 2 * numbers[0], 0.3);
  }
}

test("ActionsShowWhatThreeMakesOfTheSameKeys", async () => {
  for (let seed = 1; seed <= 25; ++seed) {
    const next = random(seed);
    const { mesh } = await meshOf({ clips: kClips.slice(0, 2) });
    const mixer = new AnimationMixer(mesh);
    const reference = new Reference(mesh);
    const both = [mesh.animations.map((clip) => mixer.clipAction(clip)),
      reference.clips.map((clip) => reference.mixer.clipAction(clip))];
    assert.deepEqual(mesh.animations.map(({ name, duration }) => [name, duration]),
      reference.clips.map(({ name, duration }) => [name, duration]));
    for (let i = 0; i < 60; ++i) {
      if (next() < 0.3) act(next, both);
      const delta = 0.05 * next();
      mixer.update(delta);
      reference.mixer.update(delta);
      await mesh.ready();
      mesh.updateMatrixWorld();
      assertNear(positions(mesh), reference.root.values, 0.02, `seed ${seed}, picture ${i}`);
      assertBounds(mesh);
    }
  }
});

test("ACrossfadeBlendsPositionsOfBothClips", async () => {
  const { mesh } = await meshOf({ clips: kClips });
  const mixer = new AnimationMixer(mesh);
  const [walk, run] = mesh.animations.map((clip) => mixer.clipAction(clip));
  walk.play();
  mixer.update(0.1);
  run.play();
  walk.crossFadeTo(run, 0.2, false);
  mixer.update(0.05);
  await mesh.ready();
  const a = between(0.15 * 30, 5);
  const b = between(12 + 0.05 * 30, 5);
  assertNear(positions(mesh), a.map((x, i) => 0.75 * x + 0.25 * b[i]), 1e-4, "a quarter");
  mixer.update(0.2);
  await mesh.ready();
  assertNear(positions(mesh), between(12 + 0.25 * 30, 5), 1e-4, "the end");
  assert.equal(mesh.frame, 20);
});

test("ActionsEndInWhatTheMeshPlays", async () => {
  const { mesh } = await meshOf({ clips: kClips });
  await mesh.seek(1);
  const mixer = new AnimationMixer(mesh);
  const action = mixer.clipAction(mesh.animations[1]).play();
  mixer.update(0.1);
  await mesh.ready();
  assertNear(positions(mesh), between(15, 5), 1e-4, "while it runs");
  action.setEffectiveWeight(0.25);
  mixer.update(0);
  await mesh.ready();
  const [a, b] = [positionsOf(30, 5), positionsOf(15, 5)];
  assertNear(positions(mesh), Array.from(a, (x, i) => 0.75 * x + 0.25 * b[i]), 1e-4, "in part");
  action.stop();
  mesh.updateMatrixWorld();
  assert.deepEqual(positions(mesh), a);
});

test("AClipFadesIntoItselfWithAnAnimationOfItsOwn", async () => {
  const { mesh } = await meshOf({ clips: kClips });
  const clone = mesh.clone();
  for (const one of [mesh, clone]) {
    const mixer = new AnimationMixer(one);
    const first = mixer.clipAction(one.animations[0]).play();
    const second = mixer.clipAction(mesh.makeAnimation("walk")).play();
    first.time = 2 / 30;
    second.time = 10 / 30;
    first.setEffectiveWeight(0.5);
    second.setEffectiveWeight(0.5);
    mixer.update(0);
    await one.ready();
    const [a, b] = [positionsOf(2, 5), positionsOf(10, 5)];
    assertNear(positions(one), Array.from(a, (x, i) => (x + b[i]) / 2), 1e-4, "half of each");
  }
  assert.equal(mesh.animations.length, kClips.length);
});

test("ClipsWithOneNameAreAnimationsOfTheirOwn", async () => {
  const { mesh } = await meshOf({ clips: kClips });
  const mixer = new AnimationMixer(mesh);
  mixer.clipAction(mesh.animations[3]).play();
  mixer.update(1 / 30);
  await mesh.ready();
  assert.deepEqual(positions(mesh), positionsOf(23, 5));
  assert.deepEqual((await meshOf()).mesh.animations.map(({ name }) => name), ["sequence"]);
  assert.throws(() => mesh.makeAnimation("jump"), RangeError);
});

test("PartsOfClipsAndStretchedClips", async () => {
  const { mesh } = await meshOf({ clips: kClips });
  const mixer = new AnimationMixer(mesh);
  const part = AnimationUtils.subclip(mesh.animations[0], "part", 3, 8, 30);
  const slow = mesh.animations[1].clone();
  slow.tracks[0].scale(2);
  slow.resetDuration();
  for (const [clip, seconds, place] of [[part, 1.5 / 30, 4.5], [slow, 3 / 30, 13.5]]) {
    mixer.stopAllAction();
    const action = mixer.clipAction(clip).reset().play();
    mixer.update(seconds);
    await mesh.ready();
    assertNear(positions(mesh), between(place, 5), 1e-3, clip.name);
    action.stop();
  }
});

test("PartsBeginAtTheFrameThatIsAskedFor", () => {
  for (const frameRate of [24, 25, 30, 60, 30000 / 1001, 12.5]) {
    const whole = clipAnimation({ name: "a", frames: 60 }, 0, frameRate, 59 / frameRate);
    for (let first = 0; first < 58; ++first) {
      const { tracks: [{ values }] } =
        AnimationUtils.subclip(whole, "part", first, first + 2, frameRate);
      assert.deepEqual([values[0], values.length], [first, 4], `${frameRate}`);
    }
  }
});

test("OnlyMeshesOfTheSameStreamAreCopied", async () => {
  const { mesh } = await meshOf();
  const copy = mesh.clone();
  copy.copy(mesh);
  const { mesh: other } = await meshOf();
  for (const wrong of [other, new Object3D()]) assert.throws(() => copy.copy(wrong), TypeError);
});

test("RaysHitWhatIsShownBetweenFrames", async () => {
  const { mesh } = await meshOf({ vertices: 3 });
  const next = random(11);
  for (let i = 0; i < 50; ++i) {
    await mesh.seek(59 * next() / 30);
    const [a, b, c] = [0, 3, 6].map((at) => new Vector3().fromArray(positions(mesh), at));
    const target = a.clone().add(b).add(c).divideScalar(3);
    const from = b.clone().sub(a).cross(c.clone().sub(a)).normalize().multiplyScalar(5).add(target);
    mesh.updateMatrixWorld();
    const ray = new Raycaster(from, target.clone().sub(from).normalize());
    assert.ok(ray.intersectObject(mesh)[0]?.point.distanceTo(target) < 1e-3);
  }
});

test("NormalsThatCancelOutAreThoseOfTheStrongerFrame", async () => {
  const { mesh } = await meshOf({ vertices: 3 });
  const { decoder } = mesh;
  const { frame } = decoder;
  decoder.frame = async (index, options) => {
    const made = await frame.call(decoder, index, options);
    made.normals.fill(0);
    for (let v = 0; v < 3; ++v) made.normals[3 * v + 2] = index % 2 === 0 ? 1 : -1;
    return made;
  };
  await mesh.seek(10.5 / 30);
  const { array } = mesh.geometry.attributes.normal;
  for (let v = 0; v < 3; ++v) assert.equal(Math.abs(array[3 * v + 2]), 1);
});

test("LevelsNeedADecoderThatHasThem", async () => {
  const { mesh } = await meshOf();
  for (const wrong of [undefined, { layers: 0 }, { layers: 2.5 }, { layers: 1, distance: NaN },
    { layers: 1, distance: -1 }, { layers: 1, hysteresis: 1 }, { layers: 1, hysteresis: NaN }]) {
    await assert.rejects(mesh.addLevel(wrong), RangeError);
  }
  assert.throws(() => {
    mesh.level = 1;
  }, RangeError);
  mesh.selectLevel(new PerspectiveCamera());
  assert.equal(mesh.level, 0);
});
