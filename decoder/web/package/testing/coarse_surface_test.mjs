// Run by package_test.py: texture coordinates and materials of coarse meshes.
import assert from "node:assert/strict";
import { test } from "node:test";

import { coarseSurface, indicesIn } from "../src/coarse_surface.js";
import { random } from "./fake_decoder.mjs";

/** Returns two triangles per cell of a grid, with vertex(row, column). */
function gridTriangles(rows, columns, vertex) {
  const triangles = [];
  for (let r = 0; r < rows; ++r) {
    for (let c = 0; c < columns; ++c) {
      const [a, b, d, e] = [vertex(r, c), vertex(r, c + 1), vertex(r + 1, c), vertex(r + 1, c + 1)];
      triangles.push(a, b, d, d, b, e);
    }
  }
  return Uint32Array.from(triangles);
}

/** Makes a closed tube: u jumps from 1 to 0 at a seam. Drawn vertices ascend by vertex, with those
 * of the seam twice. */
function tube(rows, columns) {
  const vertices = [];
  const uv = [];
  const drawnOf = new Map();
  for (let r = 0; r <= rows; ++r) {
    for (let c = 0; c < columns; ++c) {
      for (const u of c === 0 ? [0, 1] : [c / columns]) {
        drawnOf.set(`${r} ${u}`, vertices.length);
        vertices.push(r * columns + c);
        uv.push(u, r / rows);
      }
    }
  }
  const indices = gridTriangles(rows, columns, (r, c) => drawnOf.get(`${r} ${c / columns}`));
  return { vertices: Uint32Array.from(vertices), indices, attributes: new Map([["uv0",
    { name: "uv0", components: 2, values: Float32Array.from(uv) }]]) };
}

/** Returns every step-th row and column of the tube, the first one at `shift`. */
function coarseTube(rows, columns, step, shift = 0) {
  const vertices = [];
  for (let r = 0; r <= rows; r += step) {
    for (let c = shift; c < columns; c += step) vertices.push(r * columns + c);
  }
  const corners = gridTriangles(rows / step, columns / step,
    (r, c) => r * step * columns + (c * step + shift) % columns);
  return { vertices: Uint32Array.from(vertices), indices: indicesIn(vertices, corners) };
}

test("NoTriangleCrossesASeam", () => {
  const next = random(1);
  for (let i = 0; i < 40; ++i) {
    const step = 1 + Math.floor(3 * next());
    const rows = step * (1 + Math.floor(5 * next()));
    const columns = step * (3 + Math.floor(6 * next()));
    const drawn = tube(rows, columns);
    const coarse = coarseTube(rows, columns, step);
    const { places, vertices, indices, attributes } = coarseSurface({ drawn }, coarse);
    const uv = attributes.get("uv0").values;
    assert.equal(indices.length, coarse.indices.length);
    assert.equal(uv.length, 2 * places.length);
    for (let t = 0; t < indices.length; t += 3) {
      const us = [0, 1, 2].map((k) => uv[2 * indices[t + k]]);
      assert.ok(Math.max(...us) - Math.min(...us) <= step / columns + 1e-6, `${us}`);
      for (let k = 0; k < 3; ++k) {
        const corner = indices[t + k];
        assert.equal(vertices[corner], coarse.indices[t + k]);
        assert.equal(drawn.vertices[places[corner]], coarse.vertices[vertices[corner]]);
        for (let c = 0; c < 2; ++c) {
          const { values } = drawn.attributes.get("uv0");
          assert.equal(uv[2 * corner + c], values[2 * places[corner] + c]);
        }
      }
    }
  }
});

/** Returns the distance of u from the place of a vertex, without whole turns. */
function turnsApart(u, column, columns) {
  const apart = u - column / columns;
  return Math.abs(apart - Math.round(apart));
}

test("TextureCoordinatesGoOnAcrossASeamThatIsNotKept", () => {
  const next = random(2);
  for (let i = 0; i < 30; ++i) {
    const step = 2 + Math.floor(3 * next());
    const rows = step * (1 + Math.floor(4 * next()));
    const columns = step * (4 + Math.floor(5 * next()));
    const drawn = tube(rows, columns);
    // Columns next to the seam, which is at 0.
    const shift = 1 + Math.floor((step - 1) * next());
    const coarse = coarseTube(rows, columns, step, shift);
    const { places, indices, attributes } = coarseSurface({ drawn }, coarse);
    const uv = attributes.get("uv0").values;
    for (let t = 0; t < indices.length; t += 3) {
      const us = [0, 1, 2].map((k) => uv[2 * indices[t + k]]);
      assert.ok(Math.max(...us) - Math.min(...us) <= step / columns + 1e-5, `${us}`);
      for (let k = 0; k < 3; ++k) {
        const vertex = drawn.vertices[places[indices[t + k]]];
        assert.equal(vertex, coarse.vertices[coarse.indices[t + k]]);
        assert.ok(turnsApart(us[k], vertex % columns, columns) < 1e-5);
        const wanted = Math.floor(vertex / columns) / rows;
        assert.ok(Math.abs(uv[2 * indices[t + k] + 1] - wanted) < 1e-5);
      }
    }
  }
});

test("ATurnedAndMirroredSideIsContinued", () => {
  // A flat sheet whose right half lies elsewhere in the texture, turned, mirrored or scaled.
  const next = random(3);
  for (let i = 0; i < 40; ++i) {
    const [size, half] = [8, 4];
    const [scale, angle, sign] = [0.5 + next(), 6 * next(), next() < 0.5 ? 1 : -1];
    const [cos, sin] = [scale * Math.cos(angle), scale * Math.sin(angle)];
    const vertices = [];
    const uv = [];
    const drawnOf = new Map();
    for (let r = 0; r <= size; ++r) {
      for (let c = 0; c <= size; ++c) {
        for (const side of c < half ? [0] : c > half ? [1] : [0, 1]) {
          drawnOf.set(`${r} ${c} ${side}`, vertices.length);
          vertices.push(r * (size + 1) + c);
          if (side === 0) uv.push(c, r);
          else uv.push(cos * c - sin * sign * r + 30, sin * c + cos * sign * r - 7);
        }
      }
    }
    const triangles = [0, 1].flatMap((side) => [...gridTriangles(size, half, (r, c) =>
      drawnOf.get(`${r} ${c + half * side} ${side}`))]);
    const uv0 = { name: "uv0", components: 2, values: Float32Array.from(uv) };
    const drawn = { vertices: Uint32Array.from(vertices), indices: Uint32Array.from(triangles),
      attributes: new Map([["uv0", uv0]]) };
    // A triangle with two corners on the left, and one on the right.
    const corners = [[1, 1], [3, 6], [5, 2]].map(([r, c]) => r * (size + 1) + c);
    const coarse = { vertices: Uint32Array.from(corners).sort(), indices: Uint32Array.of(0, 1, 2) };
    const { attributes, indices, vertices: places } = coarseSurface({ drawn }, coarse);
    for (const corner of indices) {
      const vertex = coarse.vertices[places[corner]];
      const [c, r] = [vertex % (size + 1), Math.floor(vertex / (size + 1))];
      const [u, v] = attributes.get("uv0").values.subarray(2 * corner, 2 * corner + 2);
      assert.ok(Math.hypot(u - c, v - r) < 1e-3, `${[u, v]} at ${[c, r]}`);
    }
  }
});

test("ACoarseMeshOfAllVerticesIsTheMesh", () => {
  const drawn = tube(4, 6);
  const coarse = coarseTube(4, 6, 1);
  const { places, indices } = coarseSurface({ drawn }, coarse);
  assert.deepEqual(indices.map((corner) => places[corner]), drawn.indices);
});

test("TrianglesKeepTheirMaterial", () => {
  const [rows, columns, step] = [12, 12, 2];
  const drawn = tube(rows, columns);
  const materialOf = { domain: "triangle", components: 1,
    integers: Uint32Array.from({ length: drawn.indices.length / 3 },
      (_, t) => (t < drawn.indices.length / 6 ? 3 : 1)) };
  const coarse = coarseTube(rows, columns, step);
  const { materialOf: coarsened } = coarseSurface({ drawn, materialOf }, coarse);
  const half = coarse.indices.length / 6;
  coarsened.integers.forEach((number, t) => assert.equal(number, t < half ? 3 : 1, `${t}`));
  assert.equal(coarseSurface({ drawn }, coarse).materialOf, undefined);
});

test("ChartsThatTouchAreNotMixed", () => {
  // Two squares that share an edge, each a separate chart, far apart in the texture.
  const drawn = {
    vertices: Uint32Array.of(0, 1, 1, 2, 3, 4, 4, 5),
    indices: Uint32Array.of(0, 1, 4, 4, 1, 5, 2, 3, 6, 6, 3, 7),
    attributes: new Map([["uv0", { name: "uv0", components: 2, values: Float32Array.of(
      0, 0, 0.1, 0, 0.8, 0, 0.9, 0, 0, 0.1, 0.1, 0.1, 0.8, 0.1, 0.9, 0.1) }]]),
  };
  const coarse = { vertices: Uint32Array.of(0, 1, 2, 3, 4, 5),
    indices: Uint32Array.of(0, 1, 3, 3, 1, 4, 1, 2, 4, 4, 2, 5) };
  const { places, indices } = coarseSurface({ drawn }, coarse);
  assert.deepEqual(indices.map((corner) => places[corner]), drawn.indices);
});
