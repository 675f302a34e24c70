// Attributes of coarse meshes. The vertices of a coarse mesh are vertices of the whole mesh, which
// have one drawn vertex or, at a seam, one per side. The corners of a coarse triangle take the
// drawn vertices of one side; where it has corners on both, texture coordinates of one side are
// continued to the other.
import { uvSets } from "./sets.js";
import { mapped, Unfolding } from "./unfolding.js";

/** Returns the first place of each number below `count` in an ascending list, and the end. */
function starts(ascending, count) {
  const first = new Uint32Array(count + 1);
  for (const number of ascending) ++first[number + 1];
  for (let i = 0; i < count; ++i) first[i + 1] += first[i];
  return first;
}

/** Triangles around each drawn vertex. */
class TrianglesAround {
  constructor({ indices, vertices }) {
    this.first = starts(indices, vertices.length);
    const next = this.first.slice();
    this.triangles = new Uint32Array(indices.length);
    for (let i = 0; i < indices.length; ++i) {
      this.triangles[next[indices[i]]++] = Math.floor(i / 3);
    }
  }

  of(drawn) {
    return this.triangles.subarray(this.first[drawn], this.first[drawn + 1]);
  }
}

/** Corners of coarse triangles: drawn vertices of the whole mesh, and copies of these with other
 * texture coordinates. */
class Corners {
  constructor(drawn, around, numVertices) {
    this.sets = uvSets(drawn.attributes);
    this.unfolding = new Unfolding(drawn, this.sets.map(({ values }) => values));
    this.copies = starts(drawn.vertices, numVertices); // [vertex of the stream] first drawn vertex
    this.around = around;
    this.numDrawn = drawn.vertices.length;
    // Copies, { drawn, uvs }: uvs by set, or undefined: those of the drawn vertex.
    this.further = [];
    this.numbers = new Map(); // numbers of the copies, by their contents
  }

  /** Returns drawn vertices, or numDrawn and more for copies, for three vertices of the stream. */
  choose([first, ...others]) {
    let best;
    for (let copy = this.copies[first]; copy < this.copies[first + 1]; ++copy) {
      const found = this.unfolding.walk([...this.around.of(copy)], others);
      if (found && !(found.steps >= best?.found.steps)) best = { copy, found };
    }
    if (!best) return [first, ...others].map((vertex) => this.copies[vertex]);
    return [best.copy, ...best.found.ends.map((end) => this.#number(end))];
  }

  #number({ drawn, maps }) {
    const uvs = maps.map((map, i) => mapped(map, this.sets[i].values, drawn));
    if (uvs.every((uv) => uv === undefined)) return drawn;
    const key = `${drawn} ${uvs.map((uv) => uv?.map(Math.fround))}`;
    if (!this.numbers.has(key)) {
      this.numbers.set(key, this.numDrawn + this.further.length);
      this.further.push({ drawn, uvs });
    }
    return this.numbers.get(key);
  }

  drawnOf(number) {
    return number < this.numDrawn ? number : this.further[number - this.numDrawn].drawn;
  }

  /** Returns an attribute of drawn() at corners. */
  at(set, numbers) {
    const { name, components, values } = set;
    const picked = new Float32Array(components * numbers.length);
    const index = this.sets.indexOf(set);
    numbers.forEach((number, i) => {
      const drawn = this.drawnOf(number);
      const uv = index < 0 ? undefined : this.further[number - this.numDrawn]?.uvs[index];
      const value = uv ?? values.subarray(components * drawn, components * (drawn + 1));
      picked.set(value, components * i);
    });
    return { name, components, values: picked };
  }
}

/** Returns the material of each coarse triangle: the most frequent one around its corners. */
function materialsOf(corners, around, materials) {
  const votes = new Map();
  return Uint32Array.from({ length: corners.length / 3 }, (_, t) => {
    votes.clear();
    for (let k = 0; k < 3; ++k) {
      const triangles = around.of(corners[3 * t + k]);
      const share = 0.25 / (triangles.length + 1); // all together below the vote of a corner
      const seen = new Set();
      for (const triangle of triangles) {
        const number = materials[triangle];
        votes.set(number, (votes.get(number) ?? 0) + share + (seen.has(number) ? 0 : 1));
        seen.add(number);
      }
    }
    let best;
    for (const [number, sum] of votes) {
      if (best === undefined || sum > votes.get(best)) best = number;
    }
    return best ?? 0;
  });
}

/** Makes a coarse mesh with attributes. drawn, materialOf: drawn() of the whole mesh and the set
 * `material` of its attributes(); coarse: { indices, vertices }, triangles and their vertices in
 * the whole mesh. Returns
 *   places      the drawn vertex, in the whole mesh, of each vertex of the result
 *   vertices    its place in coarse.vertices
 *   indices     triangles of these vertices
 *   attributes  in the form of drawn()
 *   materialOf  in the form of the argument, or undefined
 * Time: usually proportional to the triangles of the whole mesh. */
export function coarseSurface({ drawn, materialOf }, coarse) {
  const numVertices = Math.max(drawn.vertices.at(-1) ?? -1, coarse.vertices.at(-1) ?? -1) + 1;
  const around = new TrianglesAround(drawn);
  const corners = new Corners(drawn, around, numVertices);
  const chosen = new Uint32Array(coarse.indices.length);
  for (let i = 0; i < chosen.length; i += 3) {
    chosen.set(corners.choose([0, 1, 2].map((k) => coarse.vertices[coarse.indices[i + k]])), i);
  }
  const { numbers, indices } = compacted(chosen, corners.numDrawn + corners.further.length);
  const places = numbers.map((number) => corners.drawnOf(number));
  const hasMaterials = materialOf?.domain === "triangle" && materialOf.components === 1;
  return {
    places, indices,
    vertices: indicesIn(coarse.vertices, places.map((place) => drawn.vertices[place])),
    attributes: new Map([...drawn.attributes].map(
      ([name, set]) => [name, corners.at(set, numbers)])),
    materialOf: hasMaterials ? { domain: "triangle", components: 1, integers: materialsOf(
      chosen.map((number) => corners.drawnOf(number)), around, materialOf.integers) } : undefined,
  };
}

/** Returns the numbers that are used, ascending, and the corners as indices into them. */
function compacted(corners, count) {
  const indexOf = new Uint32Array(count);
  for (const corner of corners) indexOf[corner] = 1;
  const numbers = new Uint32Array(indexOf.reduce((sum, one) => sum + one, 0));
  let used = 0;
  for (let i = 0; i < count; ++i) {
    if (indexOf[i] === 0) continue;
    numbers[used] = i;
    indexOf[i] = used++;
  }
  return { numbers, indices: corners.map((corner) => indexOf[corner]) };
}

/** Returns the index of each value in a list that has them all. */
export function indicesIn(list, values) {
  const indexOf = new Map();
  list.forEach((value, i) => indexOf.set(value, i));
  return values.map((value) => indexOf.get(value));
}
