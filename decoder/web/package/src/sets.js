// Names of attributes and their meaning (Table F-1), for three.js and for the player.

const kNormal = "normal";
const kMaterial = "material";
const kColour = "colour0"; // the set that is drawn

/** Returns the name of set `number` of texture coordinates. */
export function uvName(number) {
  return `uv${number}`;
}

/** Returns the number of a set of texture coordinates; undefined if it is another set. */
function uvNumber({ name, components }) {
  const digits = components === 2 ? /^uv(\d+)$/.exec(name)?.[1] : undefined;
  return digits === undefined ? undefined : Number(digits);
}

/** Returns the sets of texture coordinates among attributes by name. */
export function uvSets(attributes) {
  return [...attributes.values()].filter((set) => uvNumber(set) !== undefined);
}

/** Returns the colours to draw among attributes by name; undefined without any. */
export function colourSet(attributes) {
  const set = attributes.get(kColour);
  return set?.components >= 3 ? set : undefined;
}

/** Returns the materials of triangles among attributes by name; undefined without any. */
export function materialSet(attributes) {
  return attributes.get(kMaterial);
}

/** Returns the name of a set in three.js: uv, uv1, uv2, uv3, color; undefined if it has none. */
export function nameInThree(set) {
  const number = uvNumber(set);
  if (number <= 3) return number === 0 ? "uv" : `uv${number}`;
  return set.name === kColour && set.components >= 3 ? "color" : undefined;
}

/** Returns whether attributes() of a decoder have normals that can be computed for each frame. */
export function hasNormals(sets) {
  return ["unitVectors", "smoothing"].includes(sets.get(kNormal)?.kind);
}

/** Sorts triangles by material: { indices, groups }, groups with start, count and material.
 * materialOf: from materialSet(), or undefined if all have the first. Numbers from `max` on mean
 * no material, and become `max`. */
export function byMaterial(indices, materialOf, max) {
  const count = indices.length / 3;
  const hasMaterials = materialOf?.domain === "triangle" && materialOf.components === 1;
  const numberOf = (t) => Math.min(hasMaterials ? materialOf.integers[t] : 0, max);
  const starts = new Uint32Array(max + 2);
  for (let t = 0; t < count; ++t) starts[numberOf(t) + 1] += 3;
  for (let m = 0; m <= max; ++m) starts[m + 1] += starts[m];
  const groups = Array.from({ length: max + 1 }, (_, material) =>
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
