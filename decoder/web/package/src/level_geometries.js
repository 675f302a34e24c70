// Geometries of one mesh, one for each level of detail that it has shown.
import { Box3, Sphere, Vector3 } from "three";

import { blend, blendBounds, blendNormals } from "./blend.js";

const scratch = [0, 0, 0];
const cameraPlace = new Vector3();
const meshPlace = new Vector3();

export class LevelGeometries {
  #stream;
  #geometries = new Map(); // key: level
  #level;

  /** stream: a ShownStream. Chooses its finest level. */
  constructor(stream) {
    this.#stream = stream;
    this.#level = stream.levels[0];
  }

  /** Geometry of the chosen level. */
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

  /** Chooses a level. Returns its geometry, which may show an earlier frame, or none. */
  choose(level) {
    this.#level = level;
    return this.geometry;
  }

  /** Returns the number of the level for a camera: the last one that does not begin farther away.
   * The chosen level ends nearer than it begins, by its hysteresis. */
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

  /** Copies the picture of other geometries of the same stream and level. */
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

  /** Frees attributes that geometries of other meshes do not share. Renderers free the attributes
   * of a geometry with it; those of the stream live until its last mesh ends. */
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
