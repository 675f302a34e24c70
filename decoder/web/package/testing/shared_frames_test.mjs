// Run by package_test.py: frames that meshes of a stream share: clones, limits of memory, late or
// damaged frames, and the end.
import assert from "node:assert/strict";
import { test } from "node:test";

import { AnimationMixer, LoopOnce, Object3D, Scene } from "three";

import { RLPCMesh } from "../src/three.js";
import { positionsOf, settled } from "./fake_decoder.mjs";
import {
  assertBounds, assertNear, between, kClips, meshOf, positions,
} from "./mesh_helpers.mjs";

test("TimeWaitsAtAFrameUntilTheNextIsThere", async () => {
  const { decoder, mesh } = await meshOf();
  decoder.held = [];
  mesh.play();
  mesh.update(0);
  const shown = [];
  for (let i = 0; i < 100; ++i) {
    mesh.update(1 / 60);
    shown.push(mesh.time * 30);
    if (i % 4 === 3) await decoder.serve();
  }
  for (let i = 1; i < shown.length; ++i) {
    assert.ok(shown[i] >= shown[i - 1] - 1e-9 && shown[i] - shown[i - 1] <= 0.5 + 1e-9);
  }
  const last = shown.at(-1);
  assert.ok(last > 15 && last < 30, `${last}`);
});

test("FramesThatAreNotThereYetComeLater", async () => {
  const { decoder, mesh } = await meshOf({ clips: kClips });
  const before = positions(mesh).slice();
  decoder.held = [];
  const mixer = new AnimationMixer(mesh);
  const action = mixer.clipAction(mesh.animations[1]).play();
  action.time = 2.5 / 30;
  action.paused = true;
  mixer.update(0);
  mesh.updateMatrixWorld();
  assert.deepEqual(positions(mesh), before); // no frame of the clip is decoded
  await decoder.serve();
  mesh.updateMatrixWorld();
  assert.deepEqual(positions(mesh), positionsOf(14, 5));
  await decoder.serve(2);
  mesh.updateMatrixWorld();
  assertNear(positions(mesh), between(14.5, 5), 1e-5, "both are there");
});

test("AFrameThatCannotBeDecodedIsToldOnceAndLeftOut", async () => {
  const { decoder, mesh } = await meshOf({ clips: kClips });
  decoder.failing.add(15);
  const failed = [];
  mesh.addEventListener("error", ({ index }) => failed.push(index));
  const mixer = new AnimationMixer(mesh);
  const action = mixer.clipAction(mesh.animations[1]).play();
  action.time = 2.5 / 30;
  action.paused = true;
  mixer.update(0);
  for (let i = 0; i < 5; ++i) await mesh.ready();
  assert.deepEqual(positions(mesh), positionsOf(14, 5));
  assert.deepEqual(failed, [15]);
});

test("ClonesShareFramesAndHaveATimeOfTheirOwn", async () => {
  const { decoder, mesh } = await meshOf({ frames: 60 });
  mesh.name = "walker";
  mesh.position.set(1, 2, 3);
  const clones = Array.from({ length: 200 }, () => mesh.clone());
  assert.ok(clones.every((clone) => clone instanceof RLPCMesh && clone.name === "walker" &&
    clone.position.z === 3 && clone.material === mesh.material));
  assert.ok(clones.every((clone) => clone.geometry !== mesh.geometry));
  assert.deepEqual(positions(clones[5]), positionsOf(0, 5));
  const places = clones.map((_, i) => (i * 0.37) % 59);
  await Promise.all(clones.map((clone, i) => clone.seek(places[i] / 30)));
  clones.forEach((clone, i) => assertNear(positions(clone), between(places[i], 5), 1e-5, `${i}`));
  assert.equal(decoder.decoded.length, 60); // each once
  for (const clone of clones) clone.play();
  for (let i = 0; i < 100; ++i) {
    for (const clone of clones) clone.update(1 / 60);
    await settled();
  }
  assert.equal(decoder.decoded.length, 60);
});

test("AllClonesAdvanceWithLittleMemory", async () => {
  const { decoder, mesh } = await meshOf({ frames: 1000, vertices: 5 }, { frameMemory: 120 * 30 });
  const clones = [mesh, ...Array.from({ length: 9 }, () => mesh.clone())];
  const mixers = clones.map((clone, i) => {
    const mixer = new AnimationMixer(clone);
    mixer.clipAction(clone.animations[0]).play().time = 3 * i;
    return mixer;
  });
  for (let i = 0; i < 200; ++i) {
    for (const mixer of mixers) mixer.update(1 / 60);
    for (const clone of clones) clone.updateMatrixWorld();
    await settled();
    await settled();
  }
  await Promise.all(clones.map((clone) => clone.ready()));
  clones.forEach((clone, i) => {
    const place = 30 * ((3 * i + 200 / 60) % (999 / 30));
    assertNear(positions(clone), between(place, 5), 1e-2, `clone ${i}`);
  });
  assert.ok(decoder.maxInUse <= 30 + 3, `${decoder.maxInUse} frames at once`);
});

test("NothingIsAllocatedOnceTheMemoryIsFull", async () => {
  const { decoder, mesh } = await meshOf({ frames: 500 }, { frameMemory: 120 * 20 });
  mesh.play();
  const play = async (pictures) => {
    for (let i = 0; i < pictures; ++i) {
      mesh.update(1 / 60);
      await settled();
    }
  };
  await play(200);
  const { numAllocated } = decoder;
  assert.ok(numAllocated <= 24, `${numAllocated}`);
  const { array } = mesh.geometry.attributes.position;
  await play(400);
  assert.equal(decoder.numAllocated, numAllocated);
  assert.equal(mesh.geometry.attributes.position.array, array);
  assert.ok(decoder.decoded.length > 250);
});

test("SeekingManyTimesEndsAtTheLast", async () => {
  const { decoder, mesh } = await meshOf({ frames: 300 }, { frameMemory: 120 * 10 });
  decoder.held = [];
  const seeks = [50.5, 120.25, 7, 255.5].map((place) => mesh.seek(place / 30));
  for (let i = 0; i < 10; ++i) await decoder.serve();
  await Promise.all(seeks);
  assertNear(positions(mesh), between(255.5, 5), 1e-5, "the last");
  assert.ok(decoder.decoded.length <= 5, `${decoder.decoded}`);
});

test("TheDecoderEndsWithTheLastMesh", async () => {
  const { decoder, mesh } = await meshOf();
  const clone = mesh.clone();
  const late = clone.clone();
  let materials = 0;
  mesh.material.addEventListener("dispose", () => ++materials);
  mesh.dispose();
  mesh.dispose();
  assert.deepEqual([decoder.isClosed, materials], [false, 0]);
  await clone.seek(1.5);
  assert.deepEqual(positions(clone), positionsOf(45, 5));
  const waits = clone.seek(0.5).catch((error) => error.name);
  clone.dispose();
  assert.equal(await waits, "AbortError");
  assert.equal(decoder.isClosed, false);
  late.dispose();
  assert.deepEqual([decoder.isClosed, materials], [true, 1]);
  mesh.update(1);
  mesh.updateMatrixWorld();
});

test("ScenesAreClonedWithTheirMeshes", async () => {
  const { mesh } = await meshOf({ clips: kClips });
  const scene = new Scene();
  mesh.add(new Object3D());
  scene.add(mesh);
  mesh.loop = LoopOnce;
  mesh.speed = 2;
  await mesh.play("run").pause().seek(0.1);
  const [copy] = scene.clone().children;
  assert.ok(copy instanceof RLPCMesh && copy.children.length === 1);
  assert.deepEqual([copy.loop, copy.speed, copy.clip, copy.playing],
    [LoopOnce, 2, mesh.clips[1], false]);
  assert.ok(Math.abs(copy.time - 0.1) < 1e-6);
  assert.deepEqual(positions(copy), positions(mesh));
  assert.equal(mesh.clone(false).children.length, 0);
});

test("CrossfadesWithTheLeastMemoryShowNoFrameThatHasLeft", async () => {
  const clips =
    [{ name: "a", firstFrame: 0, frames: 50 }, { name: "b", firstFrame: 50, frames: 50 }];
  const { decoder, mesh } = await meshOf({ frames: 100, clips }, { frameMemory: 1 });
  const mixer = new AnimationMixer(mesh);
  const [a, b] = mesh.animations.map((clip) => mixer.clipAction(clip).play());
  a.setEffectiveWeight(0.5);
  b.setEffectiveWeight(0.5);
  b.time = 0.7;
  for (let i = 0; i < 300; ++i) {
    mixer.update(1 / 120);
    mesh.updateMatrixWorld();
    assert.ok(positions(mesh).every(Number.isFinite));
    assertBounds(mesh);
    await settled();
    await settled();
  }
  await mesh.ready();
  const halves = [30 * ((300 / 120) % (49 / 30)), 50 + 30 * ((0.7 + 300 / 120) % (49 / 30))]
    .map((place) => between(place, 5));
  assertNear(positions(mesh), halves[0].map((x, i) => (x + halves[1][i]) / 2), 1e-2, "the end");
  assert.ok(decoder.maxInUse <= 8 + 3, `${decoder.maxInUse}`);
  assert.ok(decoder.decoded.length < 3 * 150, `${decoder.decoded.length}`);
});
