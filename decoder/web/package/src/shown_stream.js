// State that a mesh shares with its clones: decoder, decoded frames, levels of detail, animations.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage } from "three";

import { clipAnimation } from "./clip_animations.js";
import { clipSeconds } from "./clip_time.js";
import { coarseSurface, indicesIn } from "./coarse_surface.js";
import { RlpcDecoder } from "./decoder.js";
import { FrameStore } from "./frame_store.js";
import { byMaterial } from "./sets.js";
import { dispose, setAttributes } from "./three_look.js";

const kMaxAhead = 8; // frames that a mesh requests before they are shown

/** Geometry to fill with frames. places: the vertex of the frames for each of its vertices, or
 * undefined. All meshes that show this level share triangles and attributes. */
class Level {
  constructor({ layers, distance, hysteresis, count, places }) {
    Object.assign(this, { layers, distance, hysteresis, count, places });
    this.shared = new BufferGeometry();
  }
}

export class ShownStream {
  constructor(decoder, { normals, frameMemory }, look) {
    this.decoder = decoder;
    this.hasNormals = normals;
    this.look = look;
    this.isDrawn = look !== undefined && !look.places; // frames have drawn vertices
    this.ownTextures = look?.gltf !== undefined;
    this.materials = []; // disposed of with the last mesh
    this.meshes = new Set();
    this.waiting = []; // callers that wait for the next frame
    const inFrames = this.isDrawn ? look.drawn.vertices.length : decoder.info.vertices;
    this.bytesPerFrame = (normals ? 24 : 12) * inFrames;
    this.frames = new FrameStore({
      decode: (index, into, signal) => this.#decode(index, into, signal),
      bytesPerFrame: this.bytesPerFrame, maxBytes: frameMemory, arrived: () => this.arrived() });
    this.levels = [this.#finest()];
    this.#animate();
  }

  #decode(index, into, signal) {
    return this.decoder.frame(index,
      { normals: this.hasNormals, drawn: this.isDrawn, signal, into });
  }

  /** Number of frames that each mesh requests before they are shown. */
  get ahead() {
    const fair = Math.floor(this.frames.capacity / (4 * Math.max(1, this.meshes.size)));
    return Math.min(kMaxAhead, Math.max(1, fair));
  }

  /** Calls all that wait for a frame. */
  arrived() {
    for (const resolve of this.waiting.splice(0)) resolve();
  }

  /** Resolves when a frame or its error arrives, or a mesh is disposed of. */
  arrival() {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
    });
  }

  #finest() {
    const { look, decoder } = this;
    const level = new Level({ layers: Infinity, distance: 0, hysteresis: 0,
      count: look?.drawn.vertices.length ?? decoder.info.vertices, places: look?.places });
    if (look) setAttributes(level.shared, look.drawn, look.equalUvs);
    level.shared.setIndex(new BufferAttribute(look?.drawn.indices ?? decoder.indices, 1));
    return level;
  }

  /** Makes a geometry for one mesh, without groups if all triangles share a material. */
  geometryOf(level) {
    const geometry = new BufferGeometry();
    for (const name of this.hasNormals ? ["position", "normal"] : ["position"]) {
      const attribute = new BufferAttribute(new Float32Array(3 * level.count), 3);
      geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
    for (const [name, attribute] of Object.entries(level.shared.attributes)) {
      geometry.setAttribute(name, attribute);
    }
    geometry.setIndex(level.shared.index);
    for (const { start, count, materialIndex } of level.shared.groups) {
      geometry.addGroup(start, count, materialIndex);
    }
    return geometry;
  }

  /** Adds a coarse mesh of the vertices of `layers` vertex layers. */
  async addLevel({ layers, distance = 0, hysteresis = 0 } = {}) {
    const { decoder, look, levels } = this;
    if (!Number.isInteger(layers) || layers < 1) {
      throw new RangeError("layers is a whole number, from 1 on");
    }
    if (!(distance >= 0)) throw new RangeError("distance is a number, from 0 on");
    if (!(hysteresis >= 0 && hysteresis < 1)) {
      throw new RangeError("hysteresis is a number from 0 to below 1");
    }
    const coarse = await RlpcDecoder.open(decoder, { coarseLayers: layers });
    const { indices, coarseVertices, info } = coarse;
    coarse.close();
    if (coarseVertices.length >= decoder.info.vertices) {
      throw new RangeError(`layers: a mesh of ${layers} layers, of ${info.layers}, is not coarser`);
    }
    const level = look ? this.#dressed(indices, coarseVertices, { layers, distance, hysteresis })
      : this.#plain(indices, coarseVertices, { layers, distance, hysteresis });
    levels.push(level);
    levels.sort((a, b) => a.distance - b.distance || b.layers - a.layers);
    return level;
  }

  /** Makes a level without attributes. */
  #plain(indices, vertices, options) {
    const whole = this.decoder.coarseVertices; // set if the mesh itself is coarse
    const inFrames = whole ? indicesIn(whole, vertices) : vertices;
    const level = new Level({ ...options, count: vertices.length, places: inFrames });
    level.shared.setIndex(new BufferAttribute(indices, 1));
    return level;
  }

  #dressed(indices, vertices, options) {
    const { look, decoder } = this;
    const whole = look.whole ?? look;
    const surface = coarseSurface(whole, { indices, vertices });
    const places = !look.whole ? surface.places : indicesIn(decoder.coarseVertices,
      surface.places.map((place) => whole.drawn.vertices[place]));
    const level = new Level({ ...options, count: places.length, places });
    setAttributes(level.shared, surface, look.equalUvs);
    this.#group(level.shared, surface);
    return level;
  }

  /** Sets triangles by material, with the indices that materials have in the finest mesh. */
  #group(geometry, { indices, materialOf }) {
    const { groups: finest } = this.levels[0].shared;
    const { materialNumbers, numMaterials } = this.look;
    const { indices: sorted, groups } = byMaterial(indices, materialOf, numMaterials);
    geometry.setIndex(new BufferAttribute(sorted, 1));
    if (finest.length === 0) return; // one material for all
    for (const { start, count, material } of groups) {
      const i = Math.max(0, materialNumbers.indexOf(material));
      geometry.addGroup(start, count, finest[i].materialIndex);
    }
  }

  /** Takes triangles and groups that dress() has set on a geometry of the finest level. */
  adopt({ index, groups }) {
    const { shared } = this.levels[0];
    shared.setIndex(index);
    for (const { start, count, materialIndex } of groups) {
      shared.addGroup(start, count, materialIndex);
    }
  }

  /** Makes an animation for each clip, or for the whole sequence without clips. */
  #animate() {
    const { clips } = this.decoder;
    this.slots = []; // { first, count } of each animation
    this.animations = clips.map((clip) => this.animation(clip));
    if (clips.length === 0) this.animations.push(this.animation(null));
  }

  /** Makes an animation of a clip, or of the whole sequence, with a separate slot. */
  animation(clip) {
    const { frames, frameRate } = this.decoder.info;
    const range = clip ?? { name: "sequence", firstFrame: 0, frames };
    const slot = this.slots.length;
    this.slots.push({ first: range.firstFrame, count: range.frames });
    for (const mesh of this.meshes) mesh.addPose();
    return clipAnimation(range, slot, frameRate, clipSeconds(range.frames, frameRate));
  }

  /** Removes a mesh that is disposed of; the last one ends everything. */
  leave(mesh) {
    this.meshes.delete(mesh);
    this.arrived();
    if (this.meshes.size > 0) return;
    this.frames.close();
    this.decoder.close();
    for (const material of this.materials) dispose(material, this.ownTextures);
  }
}
