// Run by player_test.py: places of points in the view of the camera.
import assert from "node:assert/strict";
import { test } from "node:test";

import { Camera } from "./camera.js";
import { multiply } from "./matrices.js";

/** Returns the corners of a box with a centre and half its size. */
function corners({ centre, halfSize }) {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((corner) =>
    centre.map((value, i) => value + (corner >> i & 1 ? halfSize[i] : -halfSize[i])));
}

/** Returns [left, right, bottom, top] of points in the view, from -1 to 1. */
function seen(camera, points) {
  const { view, projection } = camera.matrices();
  const m = multiply(projection, view);
  const places = points.map((p) => [0, 1, 3].map((r) =>
    m[r] * p[0] + m[4 + r] * p[1] + m[8 + r] * p[2] + m[12 + r]));
  const xs = places.map(([x, , w]) => x / w), ys = places.map(([, y, w]) => y / w);
  return [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
}

const kBoxes = [
  { centre: [0, 0, 0], halfSize: [0.4, 0.2, 0.2] },
  { centre: [0, 3, -9], halfSize: [0.05, 0.5, 0.05] },
  { centre: [7, 0, 0], halfSize: [0.5, 0, 0.1] },
];

function framed(camera, box, min = 0.8) {
  const [left, right, bottom, top] = seen(camera, corners(box));
  assert.ok(Math.max(right - left, top - bottom) / 2 > min, [left, right, bottom, top]);
  for (const edge of [-left, right, -bottom, top]) assert.ok(edge < 1, [left, right, bottom, top]);
}

test("the mesh is large and whole in windows of any shape", () => {
  for (const aspect of [0.4, 1, 2.5]) {
    for (const box of kBoxes) {
      const camera = new Camera();
      camera.setAspect(aspect);
      camera.look(box, corners(box));
      framed(camera, box);
    }
  }
});

test("what moves away or grows is followed", () => {
  const camera = new Camera();
  camera.look(kBoxes[0], corners(kBoxes[0]));
  for (let t = 1; t < 20; ++t) {
    const box = { centre: [t, 2 * t, -t], halfSize: kBoxes[0].halfSize.map((h) => h * 1.2 ** t) };
    camera.follow(box, corners(box));
    framed(camera, box, 0.7);
  }
});

test("a window that becomes narrow still shows all", () => {
  const camera = new Camera();
  camera.setAspect(2);
  camera.look(kBoxes[0], corners(kBoxes[0]));
  camera.setAspect(0.5);
  framed(camera, kBoxes[0], 0.3);
});

test("the view is turned, moved and zoomed, and comes back", () => {
  const camera = new Camera();
  let changes = 0;
  camera.addListener(() => ++changes);
  camera.look(kBoxes[0], corners(kBoxes[0]));
  const first = seen(camera, corners(kBoxes[0]));
  camera.zoom(0.5);
  assert.ok(seen(camera, corners(kBoxes[0]))[1] > 1.5 * first[1]);
  camera.move(100, 0, 500); // a fifth of the height: 0.4 in the view
  const middle = (box) => (box[0] + box[1]) / 2;
  assert.ok(middle(seen(camera, [kBoxes[0].centre])) > 0.3);
  camera.turn(30, 1e6);
  assert.ok(camera.pitch < Math.PI / 2);
  camera.look(kBoxes[0], corners(kBoxes[0]));
  assert.deepEqual(seen(camera, corners(kBoxes[0])), first);
  assert.equal(changes, 2);
});

test("pointers turn, move and zoom", () => {
  const camera = new Camera();
  const on = {};
  camera.attach({ clientHeight: 500, setPointerCapture() {},
    addEventListener: (name, handler) => (on[name] = handler) });
  const at = (pointerId, clientX, clientY, more = {}) =>
    ({ pointerId, clientX, clientY, buttons: 1, preventDefault() {}, ...more });
  const state = () => [camera.yaw, camera.pitch, camera.distance, ...camera.pan];
  const changed = (before) => state().map((value, i) => value !== before[i]);
  const [turned, moved, zoomed] = [[0, 1], [3, 4, 5], [2]].map((which) =>
    [0, 1, 2, 3, 4, 5].map((i) => which.includes(i)));

  let before = state();
  on.pointermove(at(1, 50, 50)); // not held
  assert.deepEqual(state(), before);
  on.pointerdown(at(1, 0, 0));
  on.pointermove(at(1, 10, 10));
  assert.deepEqual(changed(before), turned);
  before = state();
  on.pointermove(at(1, 20, 20, { shiftKey: true }));
  assert.deepEqual(changed(before), moved);
  before = state();
  on.pointerdown(at(2, 120, 20)); // two fingers, 100 apart; then 200
  on.pointermove(at(2, 220, 20));
  assert.equal(camera.distance, before[2] / 2);
  assert.equal(camera.yaw, before[0]);
  on.pointerup(at(1, 20, 20));
  on.pointercancel(at(2, 220, 20));
  before = state();
  on.pointermove(at(2, 0, 0));
  assert.deepEqual(state(), before);
  on.wheel(at(0, 0, 0, { deltaY: 100 }));
  assert.deepEqual(changed(before), zoomed);
});
