// Weighted sums of frames, for pictures between two frames and crossfades. Allocates nothing.

/** Frames and their weights, which add up to 1. */
export class FrameMix {
  constructor() {
    this.frames = [];
    this.weights = [];
    this.count = 0;
  }

  clear() {
    this.count = 0;
  }

  add(frame, weight) {
    if (weight <= 0) return;
    for (let i = 0; i < this.count; ++i) {
      if (this.frames[i] === frame) {
        this.weights[i] += weight;
        return;
      }
    }
    this.frames[this.count] = frame;
    this.weights[this.count++] = weight;
  }

  /** Makes the sum of the weights 1. */
  normalise() {
    let sum = 0;
    for (let i = 0; i < this.count; ++i) sum += this.weights[i];
    if (sum === 1) return;
    for (let i = 0; i < this.count; ++i) this.weights[i] /= sum;
  }

  /** Index of the largest weight. */
  get strongest() {
    let best = 0;
    for (let i = 1; i < this.count; ++i) if (this.weights[i] > this.weights[best]) best = i;
    return best;
  }

  equals(other) {
    if (this.count !== other.count) return false;
    for (let i = 0; i < this.count; ++i) {
      if (this.frames[i] !== other.frames[i] || this.weights[i] !== other.weights[i]) return false;
    }
    return true;
  }

  /** Copies another mix, and drops its own frames. */
  copy(other) {
    this.count = other.count;
    this.frames.length = other.count;
    for (let i = 0; i < other.count; ++i) {
      this.frames[i] = other.frames[i];
      this.weights[i] = other.weights[i];
    }
  }
}

/** Computes positions or normals of a mix. places: the vertex of the frames for each vertex of
 * `out`, or undefined. A single frame is copied exactly. */
export function blend(out, { frames, weights, count }, name, places) {
  const first = frames[0][name];
  if (count === 1) {
    if (places) gather(out, first, places);
    else out.set(first);
    return;
  }
  const second = frames[1][name];
  if (places) sumAt(out, first, weights[0], second, weights[1], places);
  else sum(out, first, weights[0], second, weights[1]);
  for (let k = 2; k < count; ++k) {
    if (places) addAt(out, frames[k][name], weights[k], places);
    else add(out, frames[k][name], weights[k]);
  }
}

function gather(out, a, places) {
  for (let i = 0, to = 0; i < places.length; ++i) {
    const from = 3 * places[i];
    out[to++] = a[from];
    out[to++] = a[from + 1];
    out[to++] = a[from + 2];
  }
}

function sum(out, a, weightA, b, weightB) {
  for (let i = 0; i < out.length; ++i) out[i] = weightA * a[i] + weightB * b[i];
}

function sumAt(out, a, weightA, b, weightB, places) {
  for (let i = 0, to = 0; i < places.length; ++i) {
    const from = 3 * places[i];
    out[to++] = weightA * a[from] + weightB * b[from];
    out[to++] = weightA * a[from + 1] + weightB * b[from + 1];
    out[to++] = weightA * a[from + 2] + weightB * b[from + 2];
  }
}

function add(out, a, weight) {
  for (let i = 0; i < out.length; ++i) out[i] += weight * a[i];
}

function addAt(out, a, weight, places) {
  for (let i = 0, to = 0; i < places.length; ++i) {
    const from = 3 * places[i];
    out[to++] += weight * a[from];
    out[to++] += weight * a[from + 1];
    out[to++] += weight * a[from + 2];
  }
}

const kSmallest = 1e-12; // smallest squared length of a sum of unit vectors with a direction

/** Computes normals of a mix: unit vectors; where those of the frames cancel out, the strongest. */
export function blendNormals(out, mix, places) {
  const { normals } = mix.frames[mix.strongest];
  if (mix.count === 2) {
    unitSum(out, mix, normals, places);
  } else {
    blend(out, mix, "normals", places);
    if (mix.count > 2) makeUnits(out, normals, places);
  }
}

/** Adds two frames, the usual number, in one pass. instead: normals where the sum is zero. */
function unitSum(out, { frames, weights: [weightA, weightB] }, instead, places) {
  const [{ normals: a }, { normals: b }] = frames;
  for (let i = 0; i < out.length; i += 3) {
    const from = places ? 3 * places[i / 3] : i;
    const x = weightA * a[from] + weightB * b[from];
    const y = weightA * a[from + 1] + weightB * b[from + 1];
    const z = weightA * a[from + 2] + weightB * b[from + 2];
    setUnit(out, i, x, y, z);
    if (x * x + y * y + z * z <= kSmallest) copyVector(out, i, instead, from);
  }
}

function makeUnits(out, instead, places) {
  for (let i = 0; i < out.length; i += 3) {
    const x = out[i];
    const y = out[i + 1];
    const z = out[i + 2];
    setUnit(out, i, x, y, z);
    if (x * x + y * y + z * z <= kSmallest) {
      copyVector(out, i, instead, places ? 3 * places[i / 3] : i);
    }
  }
}

function setUnit(out, at, x, y, z) {
  const scale = 1 / Math.sqrt(x * x + y * y + z * z);
  out[at] = x * scale;
  out[at + 1] = y * scale;
  out[at + 2] = z * scale;
}

function copyVector(out, at, from, place) {
  out[at] = from[place];
  out[at + 1] = from[place + 1];
  out[at + 2] = from[place + 2];
}

/** Computes the box of a mix by the same sums as positions, with the same rounding, so that it
 * holds every position. side: "min" or "max"; out: an array of three numbers. */
export function blendBounds(out, { frames, weights, count }, side) {
  for (let c = 0; c < 3; ++c) {
    if (count === 1) {
      out[c] = frames[0].bounds[side][c];
      continue;
    }
    let value = Math.fround(weights[0] * frames[0].bounds[side][c] +
      weights[1] * frames[1].bounds[side][c]);
    for (let k = 2; k < count; ++k) {
      value = Math.fround(value + weights[k] * frames[k].bounds[side][c]);
    }
    out[c] = value;
  }
  return out;
}
