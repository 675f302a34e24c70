// Run by player_test.py: distances between frames on the same grid, and on different ones.
import assert from "node:assert/strict";
import { test } from "node:test";

import { vertexDistances } from "./distances.js";

function decoder(positionBits, gridStep, gridOrigin) {
  return { info: { positionBits }, gridStep, gridOrigin };
}

test("DistancesAreEuclidean", () => {
  const grid = decoder(4, 0.25, [0, 0, 0]); // 8 steps are 1 in the cube
  const { distances, largest, rms } = vertexDistances(
    { integers: Int32Array.of(0, 0, 0, 1, 1, 1) }, grid,
    { integers: Int32Array.of(3, 0, 4, 1, 1, 1) }, grid);
  assert.deepEqual([...distances], [5 / 8, 0]);
  assert.equal(largest, 5 / 8);
  assert.ok(Math.abs(rms - Math.sqrt(12.5) / 8) < 1e-12);
});

test("DrawnVerticesOfAVertexCountOnce", () => {
  const grid = decoder(4, 0.25, [0, 0, 0]);
  const reference = { integers: Int32Array.of(3, 0, 4, 1, 1, 1) };
  const { distances, rms } = vertexDistances(
    { integers: Int32Array.of(0, 0, 0, 1, 1, 1, 1, 1, 1) }, grid, reference, grid, [0, 1, 1]);
  assert.deepEqual([...distances], [5 / 8, 0, 0]);
  assert.ok(Math.abs(rms - Math.sqrt(12.5) / 8) < 1e-12);
});

test("TheSamePositionOnAFinerGridIsAtDistance0", () => {
  const grid = decoder(16, 2 ** -9, [1000, -5, 0]);
  const fine = decoder(24, 2 ** -15, [63000, 7, -100]);
  const position = [40, -3, 7];
  const same = position.map((x, c) => 64 * (x + grid.gridOrigin[c]) - fine.gridOrigin[c]);
  const distancesOf = (integers) => vertexDistances(
    { integers: Int32Array.from(position) }, grid, { integers: Int32Array.from(integers) }, fine);
  assert.equal(distancesOf(same).largest, 0);
  const moved = [same[0] + 64, same[1], same[2]]; // moved by a step of the coarser grid
  assert.equal(distancesOf(moved).largest, 2 ** -15);
});
