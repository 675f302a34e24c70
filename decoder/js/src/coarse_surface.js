// Attributes of coarse meshes: which drawn vertices of the whole mesh the corners of their triangles
// have. Positions of a coarse mesh are those of its vertices in the whole mesh, and each of these has
// one drawn vertex or, at a seam, several: one for each side. A coarse triangle takes those of one
// side.

const kMaxCopies = 64; // of a vertex, that are compared

/** The chart of each drawn vertex: those that triangles connect have the same number. */
function chartsOf({ vertices, indices }) {
  const parent = Uint32Array.from(vertices, (_, i) => i);
  const root = (i) => {
    let at = i;
    while (parent[at] !== at) {
      parent[at] = parent[parent[at]];
      at = parent[at];
    }
    return at;
  };
  for (let i = 0; i < indices.length; i += 3) {
    const a = root(indices[i]);
    const b = root(indices[i + 1]);
    if (a !== b) parent[b] = a;
    const c = root(indices[i + 2]);
    if (c !== a) parent[c] = a;
  }
  return parent.map((_, i) => root(i));
}

/** The first drawn vertex of each vertex of the stream, and the end. */
function firstCopies(vertices, numVertices) {
  const starts = new Uint32Array(numVertices + 1);
  for (const vertex of vertices) ++starts[vertex + 1];
  for (let v = 0; v < numVertices; ++v) starts[v + 1] += starts[v];
  return starts;
}

/** How badly two drawn vertices fit into one triangle: those of different charts by far the worst;
 * otherwise, how far apart their texture coordinates are. */
function misfit(charts, uv) {
  return (a, b) => {
    const apart = charts[a] === charts[b] ? 0 : 1e6;
    return uv ? apart + Math.hypot(uv[2 * a] - uv[2 * b], uv[2 * a + 1] - uv[2 * b + 1]) : apart;
  };
}

/** Writes the drawn vertices that fit best to three vertices of the stream. */
function chooseCorners(out, at, vertices, starts, cost) {
  const copies = (v) => [starts[v], Math.min(starts[v + 1], starts[v] + kMaxCopies)];
  const [first, firstEnd] = copies(vertices[0]);
  const [second, secondEnd] = copies(vertices[1]);
  const [third, thirdEnd] = copies(vertices[2]);
  let best = Infinity;
  for (let a = first; a < firstEnd; ++a) {
    let b = second;
    for (let i = second + 1; i < secondEnd; ++i) if (cost(a, i) < cost(a, b)) b = i;
    let c = third;
    const costOf = (i) => cost(a, i) + cost(b, i);
    for (let i = third + 1; i < thirdEnd; ++i) if (costOf(i) < costOf(c)) c = i;
    const sum = cost(a, b) + costOf(c);
    if (sum >= best) continue;
    best = sum;
    out[at] = a;
    out[at + 1] = b;
    out[at + 2] = c;
  }
}

/** For each drawn vertex, the triangles that have it: { starts, triangles }. */
function trianglesAround(indices, numDrawn) {
  const starts = new Uint32Array(numDrawn + 1);
  for (const vertex of indices) ++starts[vertex + 1];
  for (let v = 0; v < numDrawn; ++v) starts[v + 1] += starts[v];
  const next = starts.slice();
  const triangles = new Uint32Array(indices.length);
  for (let i = 0; i < indices.length; ++i) triangles[next[indices[i]]++] = Math.floor(i / 3);
  return { starts, triangles };
}

/** The material of each coarse triangle: the one that most of its corners have around them. */
function materialsOf(corners, indices, numDrawn, materials) {
  const { starts, triangles } = trianglesAround(indices, numDrawn);
  const votes = new Map();
  return Uint32Array.from({ length: corners.length / 3 }, (_, t) => {
    votes.clear();
    for (let k = 0; k < 3; ++k) {
      const corner = corners[3 * t + k];
      const share = 1 / (starts[corner + 1] - starts[corner] + 1); // below that of a corner
      const seen = new Set();
      for (let i = starts[corner]; i < starts[corner + 1]; ++i) {
        const number = materials[triangles[i]];
        votes.set(number, (votes.get(number) ?? 0) + share / 4 + (seen.has(number) ? 0 : 1));
        seen.add(number);
      }
    }
    let best;
    for (const [number, sum] of votes) if (best === undefined || sum > votes.get(best)) best = number;
    return best ?? 0;
  });
}

/** A coarse mesh with attributes. drawn, materialOf: those of the whole mesh, drawn() and the set
 * `material` of attributes(); coarse: { indices, vertices }, triangles and their vertices in the whole
 * mesh. Returns
 *   places      the drawn vertex, in the whole mesh, of each vertex of the result
 *   vertices    its place in coarse.vertices
 *   indices     triangles of these vertices
 *   attributes  as those of drawn()
 *   materialOf  as the one given, or undefined */
export function coarseSurface({ drawn, materialOf }, coarse) {
  const numVertices = Math.max(drawn.vertices.at(-1) ?? -1, coarse.vertices.at(-1) ?? -1) + 1;
  const starts = firstCopies(drawn.vertices, numVertices);
  const uv = drawn.attributes.get("uv0");
  const cost = misfit(chartsOf(drawn), uv?.components === 2 ? uv.values : undefined);
  const corners = new Uint32Array(coarse.indices.length);
  for (let i = 0; i < corners.length; i += 3) {
    const vertices = [0, 1, 2].map((k) => coarse.vertices[coarse.indices[i + k]]);
    chooseCorners(corners, i, vertices, starts, cost);
  }
  const { places, indices } = compacted(corners, drawn.vertices.length);
  const hasMaterials = materialOf?.domain === "triangle" && materialOf.components === 1;
  return {
    places, indices,
    vertices: indicesIn(coarse.vertices, places.map((place) => drawn.vertices[place])),
    attributes: new Map([...drawn.attributes].map(([name, set]) => [name, at(set, places)])),
    materialOf: hasMaterials ? { domain: "triangle", components: 1, integers:
      materialsOf(corners, drawn.indices, drawn.vertices.length, materialOf.integers) } : undefined,
  };
}

/** The vertices that are used, ascending, and triangles of these. */
export function compacted(corners, numVertices) {
  const numbers = new Uint32Array(numVertices);
  for (const corner of corners) numbers[corner] = 1;
  let count = 0;
  const places = new Uint32Array(numbers.reduce((sum, one) => sum + one, 0));
  for (let v = 0; v < numVertices; ++v) {
    if (numbers[v] === 0) continue;
    places[count] = v;
    numbers[v] = count++;
  }
  return { places, indices: corners.map((corner) => numbers[corner]) };
}

/** The index of each value in a list that has them all. */
export function indicesIn(list, values) {
  const indexOf = new Map();
  list.forEach((value, i) => indexOf.set(value, i));
  return values.map((value) => indexOf.get(value));
}

/** An attribute of drawn() at some of its vertices. */
function at({ name, components, values }, places) {
  const picked = new Float32Array(components * places.length);
  places.forEach((place, i) => {
    picked.set(values.subarray(components * place, components * (place + 1)), components * i);
  });
  return { name, components, values: picked };
}
