// Decoder for tests of RLPCMesh: frames are functions of their index, and as late as the test
// wants.

/** Makes a generator of numbers from 0 to 1. */
export function random(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

export const settled = () => new Promise((next) => setImmediate(next));

/** Returns positions (or normals) of a frame, 32-bit floats. */
export function positionsOf(index, vertices) {
  const next = random(index * 7919 + 1);
  return Float32Array.from({ length: 3 * vertices }, () => 20 * next() - 10);
}

export function normalsOf(index, vertices) {
  const next = random(index * 104729 + 5);
  const normals = new Float32Array(3 * vertices);
  for (let i = 0; i < vertices; ++i) {
    const vector = [next() - 0.5, next() - 0.5, next() - 0.5];
    const length = Math.hypot(...vector);
    normals.set(vector.map((x) => x / length), 3 * i);
  }
  return normals;
}

export function boundsOf(positions) {
  const bounds = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity] };
  positions.forEach((x, i) => {
    bounds.min[i % 3] = Math.min(bounds.min[i % 3], x);
    bounds.max[i % 3] = Math.max(bounds.max[i % 3], x);
  });
  return bounds;
}

export class FakeDecoder {
  constructor({ frames = 60, vertices = 5, frameRate = 30, clips = [] } = {}) {
    this.info = { frames, vertices, triangles: 1, frameRate, hasAttributes: false, hasAsset: false,
      damagedUnits: 0 };
    this.clips = clips;
    this.indices = Uint32Array.of(0, 1, 2);
    this.decoded = []; // indices, in order
    this.numAllocated = 0; // frames decoded without arrays to reuse
    this.numInUse = 0; // arrays that callers hold
    this.maxInUse = 0;
    this.failing = new Set();
    this.isClosed = false;
    this.held = undefined; // a list: requests wait until serve()
  }

  async frame(index, { signal, into, normals }) {
    if (this.held) {
      await new Promise((resolve, reject) => {
        this.held.push(resolve);
        signal?.addEventListener("abort", () => reject(signal.reason));
      });
    }
    signal?.throwIfAborted();
    this.decoded.push(index);
    if (this.failing.has(index)) throw new Error(`frame ${index} is damaged`);
    const { vertices } = this.info;
    if (!into) {
      ++this.numAllocated;
      this.maxInUse = Math.max(this.maxInUse, ++this.numInUse);
    }
    const positions = positionsOf(index, vertices);
    // Transferred arrays can no longer be used, as with a worker.
    if (into) structuredClone(into.positions.buffer, { transfer: [into.positions.buffer] });
    return { index, positions, bounds: boundsOf(positions),
      normals: normals ? normalsOf(index, vertices) : undefined };
  }

  /** Answers `count` waiting requests. */
  async serve(count = 1) {
    for (let i = 0; i < count; ++i) {
      await settled();
      this.held.shift()?.();
      await settled();
    }
  }

  close() {
    this.isClosed = true;
  }
}
