// The geometries of one mesh, one for each level of detail that it has shown.
import { Box3, Sphere, Vector3 } from "three";

import { blend, blendBounds, blendNormals } from "./blend.js";

const scratch = [0, 0, 0];
const cameraPlace = new Vector3();
const meshPlace = new Vector3();

export class LevelGeometries {
  #stream;
  #geometries = new Map(); // by level
  #level;

  /** stream: a ShownStream, whose finest level is chosen. */
  constructor(stream) {
    this.#stream = stream;
    this.#level = stream.levels[0];
  }

  /** The geometry of the level that is chosen. */
  get geometry() {
    let geometry = this.#geometries.get(this.#level);
    if (!geometry) {
      geometry = this.#stream.geometryOf(this.#level);
      geometry.boundingBox = new Box3();
      geometry.boundingSphere = new Sphere();
      this.#geometries.set(this.#level, geometry);
    }
    return geometry;
  }

  get level() {
    return this.#level;
  }

  /** Returns the geometry, which may show an earlier frame, or none. */
  choose(level) {
    this.#level = level;
    return this.geometry;
  }

  /** The number of the level for a camera: the last one that does not begin farther away. The
   * chosen one ends nearer than it begins, by its hysteresis. */
  numberFor({ matrixWorld: cameraMatrix, zoom = 1 }, matrixWorld, chosenLevel) {
    cameraPlace.setFromMatrixPosition(cameraMatrix);
    meshPlace.copy(this.geometry.boundingSphere.center).applyMatrix4(matrixWorld);
    const distance = cameraPlace.distanceTo(meshPlace) / zoom;
    const { levels } = this.#stream;
    const chosen = levels.indexOf(chosenLevel);
    let number = 0;
    for (let i = 1; i < levels.length; ++i) {
      const { distance: start, hysteresis } = levels[i];
      if (distance >= (i <= chosen ? start * (1 - hysteresis) : start)) number = i;
    }
    return number;
  }

  /** Fills the geometry with a FrameMix. */
  show(mix) {
    const { geometry } = this;
    const { position, normal } = geometry.attributes;
    const { places } = this.#level;
    blend(position.array, mix, "positions", places);
    position.needsUpdate = true;
    if (normal) {
      blendNormals(normal.array, mix, places);
      normal.needsUpdate = true;
    }
    const { boundingBox, boundingSphere } = geometry;
    boundingBox.min.fromArray(blendBounds(scratch, mix, "min"));
    boundingBox.max.fromArray(blendBounds(scratch, mix, "max"));
    boundingBox.getBoundingSphere(boundingSphere);
  }

  /** Shows what other geometries of the same stream and level show. */
  copy({ geometry: from }) {
    const { geometry } = this;
    for (const name of ["position", "normal"]) {
      if (!geometry.attributes[name]) continue;
      geometry.attributes[name].array.set(from.attributes[name].array);
      geometry.attributes[name].needsUpdate = true;
    }
    geometry.boundingBox.copy(from.boundingBox);
    geometry.boundingSphere.copy(from.boundingSphere);
  }

  /** Frees what is not shared with geometries of other meshes. Renderers free the attributes that a
   * geometry has when it ends, and those of the stream end with its last mesh. */
  dispose() {
    const isLast = this.#stream.meshes.size === 1;
    for (const [level, geometry] of this.#geometries) {
      if (!isLast) {
        for (const name of Object.keys(level.shared.attributes)) geometry.deleteAttribute(name);
        geometry.setIndex(null);
      }
      geometry.dispose();
    }
  }
}
