// three.js: RLPCLoader loads a stream as an RLPCMesh, which plays it. three.d.ts describes both.
import {
  Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage, Loader, LoopOnce, LoopPingPong,
  LoopRepeat, Mesh, MeshStandardMaterial, Sphere, Vector3,
} from "three";

import { Playback, RlpcDecoder } from "./index.js";

const kLoopNames = new Map([[LoopRepeat, "repeat"], [LoopOnce, "once"], [LoopPingPong, "pingpong"]]);
const kMostSpare = 4;
const kBytesAhead = 64e6;

function usualMaterial() {
  return new MeshStandardMaterial({ color: 0xb4bcc4, roughness: 0.6 });
}

export class RLPCMesh extends Mesh {
  #decoder;
  #playback;
  #spare = []; // frames whose arrays are not in use any more
  #withNormals;
  #ownMaterial;
  #loop = LoopRepeat;
  #clip = null;

  /** Its first frame is there. */
  static async create(decoder, options = {}) {
    const mesh = new RLPCMesh(decoder, options);
    try {
      mesh.#show(await mesh.#first);
    } catch (error) {
      mesh.dispose();
      throw error;
    }
    return mesh;
  }

  #first;

  constructor(decoder, { material, normals = true } = {}) {
    super(new BufferGeometry(), material?.isMaterial ? material : (material ?? usualMaterial)(decoder));
    this.type = "RLPCMesh";
    this.#decoder = decoder;
    this.#withNormals = normals;
    this.#ownMaterial = !material?.isMaterial;
    const { vertices, frames, frameRate } = decoder.info;
    this.geometry.setIndex(new BufferAttribute(decoder.indices, 1));
    for (const name of normals ? ["position", "normal"] : ["position"]) {
      const attribute = new BufferAttribute(new Float32Array(3 * vertices), 3);
      this.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
    this.geometry.boundingBox = new Box3();
    this.geometry.boundingSphere = new Sphere();
    this.#playback = new Playback({
      frames, frameRate,
      ahead: Math.min(8, Math.max(1, Math.floor(kBytesAhead / (24 * vertices)))),
      request: (index, signal) => this.#request(index, signal),
      discard: (frame) => this.#recycle(frame),
      failed: (error, index) => this.dispatchEvent({ type: "error", error, index }),
    });
    this.#playback.finished = () => this.dispatchEvent({ type: "finished", clip: this.#clip });
  }

  get decoder() {
    return this.#decoder;
  }

  get clips() {
    return this.#decoder.clips;
  }

  /** The clip that is played; null: the whole sequence. */
  get clip() {
    return this.#clip;
  }

  get playing() {
    return this.#playback.playing;
  }

  /** Seconds from the start of the clip. */
  get time() {
    return this.#playback.seconds;
  }

  set time(seconds) {
    const { first, frameRate } = this.#playback;
    this.#playback.seek(first + Math.floor(seconds * frameRate + 1e-6));
  }

  get duration() {
    return this.#playback.count / this.#playback.frameRate;
  }

  get speed() {
    return this.#playback.speed;
  }

  set speed(speed) {
    this.#playback.setSpeed(speed);
  }

  /** LoopRepeat, LoopOnce or LoopPingPong of three.js. */
  get loop() {
    return this.#loop;
  }

  set loop(loop) {
    if (!kLoopNames.has(loop)) throw new RangeError("loop is LoopRepeat, LoopOnce or LoopPingPong");
    this.#loop = loop;
    this.#playback.setLoop(kLoopNames.get(loop));
  }

  /** Goes on; with the name of a clip, or null for the whole sequence, plays that from its start. */
  play(name) {
    if (name !== undefined) this.#choose(name);
    this.#playback.play();
    return this;
  }

  #choose(name) {
    const clip = name === null ? null : this.clips.find((one) => one.name === name);
    if (clip === undefined) {
      const names = this.clips.map((one) => `"${one.name}"`).join(", ");
      throw new RangeError(`no clip "${name}"; there are ${names || "none"}`);
    }
    this.#clip = clip;
    this.#playback.setRange(clip?.firstFrame ?? 0, clip?.frames ?? this.#decoder.info.frames);
  }

  pause() {
    this.#playback.pause();
    return this;
  }

  /** Back to the start. */
  stop() {
    this.pause();
    this.#choose(this.#clip?.name ?? null);
    return this;
  }

  /** To be called for each picture, with the seconds since the last. */
  update(delta) {
    const reply = this.#playback.tick(delta);
    if (reply?.frame) this.#show(reply.frame);
    return reply !== undefined;
  }

  #request(index, signal) {
    const frame = this.#decoder.frame(index, {
      normals: this.#withNormals, signal, into: this.#spare.pop() });
    this.#first ??= frame;
    return frame;
  }

  /** Of a frame that is not shown. */
  #recycle(frame) {
    const isShown = frame.positions === this.geometry.attributes.position.array;
    if (!isShown && this.#spare.length < kMostSpare) this.#spare.push(frame);
  }

  #show(frame) {
    const { position, normal } = this.geometry.attributes;
    if (position.array === frame.positions) return;
    const before = { positions: position.array, normals: normal?.array };
    position.array = frame.positions;
    position.needsUpdate = true;
    if (normal) {
      normal.array = frame.normals;
      normal.needsUpdate = true;
    }
    this.#recycle(before);
    const { boundingBox, boundingSphere } = this.geometry;
    boundingBox.set(new Vector3(...frame.bounds.min), new Vector3(...frame.bounds.max));
    boundingBox.getBoundingSphere(boundingSphere);
    this.frame = frame.index;
    this.dispatchEvent({ type: "frame", index: frame.index });
  }

  /** A mesh that shows the same frames. */
  clone(recursive) {
    return new Mesh().copy(this, recursive);
  }

  dispose() {
    this.#playback.pause();
    this.#playback.cancel();
    this.#decoder.close();
    this.geometry.dispose();
    if (this.#ownMaterial) [this.material].flat().forEach((material) => material.dispose());
  }
}

export class RLPCLoader extends Loader {
  constructor(manager) {
    super(manager);
    this.options = {};
  }

  /** Of RlpcDecoder.open() and of RLPCMesh: material, normals. */
  setOptions(options) {
    this.options = { ...this.options, ...options };
    return this;
  }

  load(url, onLoad, onProgress, onError) {
    const address = this.manager.resolveURL((this.path ?? "") + url);
    this.manager.itemStart(address);
    this.open(address, onProgress).then((mesh) => {
      onLoad?.(mesh);
    }).catch((error) => {
      if (onError) onError(error);
      else console.error(error);
      this.manager.itemError(address);
    }).finally(() => this.manager.itemEnd(address));
  }

  /** As loadAsync(), of any source that RlpcDecoder.open() takes. */
  async open(source, onProgress) {
    const { material, normals, ...options } = this.options;
    const decoder = await RlpcDecoder.open(source, {
      headers: this.requestHeader,
      credentials: this.withCredentials ? "include" : "same-origin",
      onProgress: onProgress && ((progress) =>
        onProgress({ lengthComputable: progress.total !== undefined, ...progress })),
      ...options,
    });
    return RLPCMesh.create(decoder, { material, normals });
  }
}
