// Texture coordinates across seams. Each side of a seam has its own; a triangle of a coarse mesh
// may have corners on both. From one of its corners, this walks over the triangles of the whole
// mesh to the others, and continues the texture coordinates of that corner: where the walk crosses
// a seam, a similarity aligns the texture of the far side with that of the near side.

const kCrossingSteps = 1; // additional cost of a step across a seam
const kMaxSteps = 1 << 12; // triangles that one walk visits
const kLargestScale = 4; // largest scale of a similarity; beyond it, sides are only moved

/** Map z -> factor * z + move, or factor * conj(z) + move, of complex numbers. */
const kIdentity = { re: 1, im: 0, x: 0, y: 0, isMirror: false };

function apply({ re, im, x, y, isMirror }, u, v) {
  const w = isMirror ? -v : v;
  return [re * u - im * w + x, re * w + im * u + y];
}

/** Returns the map first(second(z)). */
function compose(first, second) {
  if (first === kIdentity) return second;
  if (second === kIdentity) return first;
  const [x, y] = apply(first, second.x, second.y);
  const im = first.isMirror ? -second.im : second.im;
  return { re: first.re * second.re - first.im * im, im: first.re * im + first.im * second.re, x, y,
    isMirror: first.isMirror !== second.isMirror };
}

/** Returns the similarity that maps an edge of the far side to that of the near side: [u, v] each.
 * */
function similarity(near, far, isMirror) {
  const [[a, b], [c, d]] = [near, far].map(([from, to]) => [to[0] - from[0], to[1] - from[1]]);
  const e = isMirror ? -d : d;
  const length = c * c + e * e;
  let [re, im] = [(a * c + b * e) / length, (b * c - a * e) / length];
  const scale = Math.hypot(re, im);
  if (!(scale < kLargestScale && scale > 1 / kLargestScale)) [re, im] = [1, 0];
  const [x, y] = apply({ re, im, x: 0, y: 0, isMirror }, ...far[0]);
  return { re, im, x: near[0][0] - x, y: near[0][1] - y, isMirror };
}

export class Unfolding {
  /** { vertices, indices }: drawn() of a decoder; uvs: values of its sets of texture coordinates.
   * */
  constructor({ vertices, indices }, uvs) {
    Object.assign(this, { vertices, indices, uvs });
    this.opposite = this.#opposites();
    this.visited = new Uint32Array(indices.length / 3); // last walk that visited each triangle
    this.numWalks = 0;
  }

  /** Returns, for each corner, the corner at which the same edge begins in the neighbouring
   * triangle; -1: none. */
  #opposites() {
    const { indices, vertices } = this;
    const opposite = new Int32Array(indices.length).fill(-1);
    const open = new Map();
    const count = (vertices.at(-1) ?? 0) + 1;
    for (let corner = 0; corner < indices.length; ++corner) {
      const [a, b] = [vertices[indices[corner]], vertices[indices[this.#next(corner)]]];
      const key = Math.min(a, b) * count + Math.max(a, b);
      const other = open.get(key);
      if (other === undefined) {
        open.set(key, corner);
      } else {
        open.delete(key);
        opposite[corner] = other;
        opposite[other] = corner;
      }
    }
    return opposite;
  }

  #next(corner) {
    return corner % 3 === 2 ? corner - 2 : corner + 1;
  }

  /** Walks from triangles to two vertices of the stream. Returns { steps, ends }: ends has, for
   * each vertex, the drawn vertex, and a map per set that continues texture coordinates from the
   * start; undefined if the walk is too long. */
  walk(triangles, targets) {
    const walk = ++this.numWalks;
    const buckets = [triangles.map((triangle) => [triangle, this.uvs.map(() => kIdentity)])];
    const ends = [];
    let visits = 0;
    let total = 0;
    for (let steps = 0; steps < buckets.length; ++steps) {
      for (const [triangle, maps] of buckets[steps] ?? []) {
        if (this.visited[triangle] === walk) continue;
        this.visited[triangle] = walk;
        if (++visits > kMaxSteps) return undefined;
        for (let corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
          const drawn = this.indices[corner];
          targets.forEach((target, i) => {
            if (this.vertices[drawn] !== target || ends[i]) return;
            ends[i] = { drawn, maps };
            total += steps;
          });
          this.#step(corner, maps, steps, buckets, walk);
        }
        if (targets.every((_, i) => ends[i])) return { steps: total, ends };
      }
    }
    return undefined;
  }

  #step(corner, maps, steps, buckets, walk) {
    const other = this.opposite[corner];
    if (other < 0 || this.visited[Math.floor(other / 3)] === walk) return;
    const beyond = this.#beyond(corner, other, maps);
    const at = steps + 1 + (beyond === maps ? 0 : kCrossingSteps);
    (buckets[at] ??= []).push([Math.floor(other / 3), beyond]);
  }

  /** Returns the maps of the neighbour across an edge; unchanged if the edge is not a seam. */
  #beyond(corner, other, maps) {
    const { indices, vertices } = this;
    const near = [indices[corner], indices[this.#next(corner)]];
    let far = [indices[other], indices[this.#next(other)]];
    if (vertices[far[0]] !== vertices[near[0]]) far = [far[1], far[0]];
    if (near[0] === far[0] && near[1] === far[1]) return maps;
    let result = maps;
    this.uvs.forEach((values, i) => {
      const ends = (drawn) => drawn.map((vertex) => [values[2 * vertex], values[2 * vertex + 1]]);
      const [a, b] = [ends(near), ends(far)];
      if (a.every(([u, v], k) => u === b[k][0] && v === b[k][1])) return;
      const isMirror = this.#turns(values, corner) !== this.#turns(values, other);
      if (result === maps) result = [...maps];
      result[i] = compose(maps[i], similarity(a, b, isMirror));
    });
    return result;
  }

  /** Returns whether the triangle of a corner turns left in the texture. */
  #turns(values, corner) {
    const first = corner - corner % 3;
    const [a, b, c] = [0, 1, 2].map((k) => this.indices[first + k]);
    const [x, y] = [0, 1].map((axis) => values[2 * b + axis] - values[2 * a + axis]);
    return x * (values[2 * c + 1] - values[2 * a + 1]) - y * (values[2 * c] - values[2 * a]) > 0;
  }
}

/** Returns texture coordinates of a drawn vertex under a map of walk(); undefined if it changes
 * nothing. */
export function mapped(map, values, drawn) {
  return map === kIdentity ? undefined : apply(map, values[2 * drawn], values[2 * drawn + 1]);
}
