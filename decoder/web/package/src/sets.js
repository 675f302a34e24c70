// Meaning of the names of attributes (Table F-1), for three.js and for the player.

/** Returns whether attributes() of a decoder have normals that can be computed for each frame. */
export function hasNormals(sets) {
  return ["unitVectors", "smoothing"].includes(sets.get("normal")?.kind);
}

/** Sorts triangles by material: { indices, groups }, groups with start, count and material.
 * materialOf: the set `material`, or undefined if all have the first. Numbers from `most` on mean
 * no material, and become `most`. */
export function byMaterial(indices, materialOf, most) {
  const count = indices.length / 3;
  const hasMaterials = materialOf?.domain === "triangle" && materialOf.components === 1;
  const numberOf = (t) => Math.min(hasMaterials ? materialOf.integers[t] : 0, most);
  const starts = new Uint32Array(most + 2);
  for (let t = 0; t < count; ++t) starts[numberOf(t) + 1] += 3;
  for (let m = 0; m <= most; ++m) starts[m + 1] += starts[m];
  const groups = Array.from({ length: most + 1 }, (_, material) =>
    ({ start: starts[material], count: starts[material + 1] - starts[material], material }))
    .filter((group) => group.count > 0);
  const sorted = new Uint32Array(indices.length);
  for (let t = 0; t < count; ++t) {
    const number = numberOf(t);
    sorted.set(indices.subarray(3 * t, 3 * t + 3), starts[number]);
    starts[number] += 3;
  }
  return { indices: sorted, groups };
}
