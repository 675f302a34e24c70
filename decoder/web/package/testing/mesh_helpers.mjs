// Helpers of the tests of RLPCMesh.
import assert from "node:assert/strict";

import { Box3, Vector3 } from "three";

import { RLPCMesh } from "../src/three.js";
import { FakeDecoder, positionsOf } from "./fake_decoder.mjs";

export const kClips = [
  { name: "walk", firstFrame: 0, frames: 12 }, { name: "run", firstFrame: 12, frames: 9 },
  { name: "still", firstFrame: 21, frames: 1 }, { name: "walk", firstFrame: 22, frames: 5 }];

export async function meshOf(options = {}, meshOptions = {}) {
  const decoder = new FakeDecoder(options);
  return { decoder, mesh: await RLPCMesh.create(decoder, meshOptions) };
}

export function positions(mesh) {
  return mesh.geometry.attributes.position.array;
}

/** Interpolates two frames linearly, in double precision. */
export function between(place, vertices) {
  const before = Math.floor(place + 1e-6);
  const fraction = Math.max(0, place - before);
  const a = positionsOf(before, vertices);
  if (fraction < 1e-6) return Array.from(a);
  const b = positionsOf(before + 1, vertices);
  return Array.from(a, (x, i) => (1 - fraction) * x + fraction * b[i]);
}

export function assertNear(actual, expected, tolerance, text) {
  assert.equal(actual.length, expected.length);
  for (let i = 0; i < actual.length; ++i) {
    assert.ok(Math.abs(actual[i] - expected[i]) <= tolerance,
      `${text}: value ${i} is ${actual[i]}, not ${expected[i]}`);
  }
}

export function assertBounds(mesh) {
  const { boundingBox, boundingSphere, attributes: { position } } = mesh.geometry;
  const box = new Box3().setFromBufferAttribute(position);
  assert.ok(boundingBox.containsBox(box));
  const point = new Vector3();
  for (let i = 0; i < position.count; ++i) {
    point.fromBufferAttribute(position, i);
    assert.ok(boundingSphere.distanceToPoint(point) < 1e-5);
  }
}
