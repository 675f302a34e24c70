// Distances of vertices from the same vertices of another encoding of the animation.

/** Computes distances between frames with integers on the grids of their decoders, in the cube from
 * -1 to 1 that holds the grid of the first. vertices: if the frame has drawn vertices, their
 * vertices of the stream, each of which counts once in the root mean square. */
export function vertexDistances(frame, decoder, reference, referenceDecoder, vertices) {
  const scale = 2 ** (1 - decoder.info.positionBits);
  const referenceScale = (scale / decoder.gridStep) * referenceDecoder.gridStep;
  const [origin, referenceOrigin] = [decoder.gridOrigin, referenceDecoder.gridOrigin];
  const [a, b] = [frame.integers, reference.integers];
  const distances = new Float32Array(a.length / 3);
  let sum = 0;
  let count = 0;
  let largest = 0;
  for (let v = 0; v < distances.length; ++v) {
    const other = vertices ? vertices[v] : v;
    let square = 0;
    for (let c = 0; c < 3; ++c) {
      const i = 3 * v + c;
      // Scales are powers of two: nothing is rounded.
      const wanted = (b[3 * other + c] + referenceOrigin[c]) * referenceScale;
      const d = (a[i] + origin[c]) * scale - wanted;
      square += d * d;
    }
    if (!vertices || other !== vertices[v - 1]) {
      sum += square;
      ++count;
    }
    distances[v] = Math.sqrt(square);
    largest = Math.max(largest, distances[v]);
  }
  return { distances, largest, rms: Math.sqrt(sum / Math.max(1, count)) };
}
