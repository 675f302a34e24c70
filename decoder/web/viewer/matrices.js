// 4 x 4 matrices in column-major order, as in WebGL.

export function multiply(a, b) {
  const product = new Float64Array(16);
  for (let i = 0; i < 16; ++i) {
    for (let k = 0; k < 4; ++k) product[i] += a[4 * k + i % 4] * b[i - i % 4 + k];
  }
  return product;
}

/** Returns a perspective projection. tan: tangent of half the vertical field of view. */
export function perspective(tan, aspect, near, far) {
  return [1 / (tan * aspect), 0, 0, 0, 0, 1 / tan, 0, 0,
    0, 0, (near + far) / (near - far), -1, 0, 0, 2 * near * far / (near - far), 0];
}

/** Returns a projection of the cube from -size to size. */
export function orthographic(size, near, far) {
  return [1 / size, 0, 0, 0, 0, 1 / size, 0, 0,
    0, 0, 2 / (near - far), 0, 0, 0, (near + far) / (near - far), 1];
}

/** Returns unit vectors right, up and backward of a view turned by yaw and pitch; y is up. */
export function viewAxes(yaw, pitch) {
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  return [[cy, 0, -sy], [-sp * sy, cp, -sp * cy], [cp * sy, sp, cp * cy]];
}

export function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/** Returns the matrix from the world to a view with axes and the origin `eye`. */
export function viewMatrix(axes, eye) {
  const columns = [0, 1, 2].flatMap((c) => [axes[0][c], axes[1][c], axes[2][c], 0]);
  return [...columns, ...axes.map((axis) => -dot(axis, eye)), 1];
}
