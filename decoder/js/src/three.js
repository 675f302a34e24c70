// three.js: RLPCLoader loads a stream as an RLPCMesh, which plays it. three.d.ts describes both.
import {
  Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage, Loader, LoopOnce, LoopPingPong,
  LoopRepeat, Mesh, Sphere, Vector3,
} from "three";

import { aborted } from "./error.js";
import { Playback, RlpcDecoder } from "./index.js";
import { dispose, dress, loadLook, setAttributes, usualMaterial } from "./three_look.js";

const kLoopNames = new Map([[LoopRepeat, "repeat"], [LoopOnce, "once"], [LoopPingPong, "pingpong"]]);
const kMostSpare = 4;
const kBytesAhead = 64e6;

export class RLPCMesh extends Mesh {
  #decoder;
  #playback;
  #spare = []; // frames whose arrays are not in use any more
  #withNormals;
  #isDrawn; // frames have drawn vertices
  #ownMaterial;
  #ownTextures;
  #loop = LoopRepeat;
  #clip = null;
  #isDisposed = false;
  #waiting = []; // seeks, each until a frame arrives

  /** Its first frame is there, with attributes, materials and textures. */
  static async create(decoder, options = {}) {
    let mesh;
    try {
      const look = await loadLook(decoder, options);
      mesh = new RLPCMesh(decoder, { normals: !look?.isFlat, ...options }, look);
      const [frame, material] = await Promise.all([mesh.#first,
        look && dress(mesh.geometry, look, mesh.#given(options.material))]);
      if (look) mesh.material = material;
      mesh.#show(frame);
      return mesh;
    } catch (error) {
      if (mesh) mesh.dispose();
      else decoder.close();
      throw error;
    }
  }

  #first;

  constructor(decoder, { material, normals = true } = {}, look = undefined) {
    super(new BufferGeometry());
    this.type = "RLPCMesh";
    this.#decoder = decoder;
    this.#withNormals = normals;
    this.#isDrawn = look !== undefined;
    this.#ownMaterial = !material?.isMaterial && !Array.isArray(material);
    this.#ownTextures = look?.gltf !== undefined;
    const { frames, frameRate } = decoder.info;
    const vertices = look?.drawn.vertices.length ?? decoder.info.vertices;
    for (const name of normals ? ["position", "normal"] : ["position"]) {
      const attribute = new BufferAttribute(new Float32Array(3 * vertices), 3);
      this.geometry.setAttribute(name, attribute.setUsage(DynamicDrawUsage));
    }
    if (look) setAttributes(this.geometry, look.drawn);
    else this.geometry.setIndex(new BufferAttribute(decoder.indices, 1));
    this.material = this.#given(material) ?? usualMaterial({ flatShading: !normals });
    this.geometry.boundingBox = new Box3();
    this.geometry.boundingSphere = new Sphere();
    this.#playback = new Playback({
      frames, frameRate,
      ahead: Math.min(8, Math.max(1, Math.floor(kBytesAhead / (24 * vertices)))),
      request: (index, signal) => this.#request(index, signal),
      discard: (frame) => this.#recycle(frame),
      failed: (error, index) => this.dispatchEvent({ type: "error", error, index }),
    });
    this.#playback.arrived = () => this.#arrived();
    this.#playback.finished = () => this.dispatchEvent({ type: "finished", clip: this.#clip });
  }

  /** The material of the caller, made once. */
  #given(material) {
    return typeof material === "function" ? (this.#made ??= material(this.#decoder)) : material;
  }

  #made;

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
    this.#playback.seekSeconds(seconds);
  }

  /** Sets time, and resolves once its frame is shown, or that of a later seek. */
  async seek(seconds) {
    this.time = seconds;
    while (!this.#isDisposed && !this.#playback.isReady) {
      await new Promise((resolve) => {
        this.#waiting.push(resolve);
      });
    }
    if (this.#isDisposed) throw aborted("the mesh has been disposed of");
    this.update(0);
  }

  #arrived() {
    for (const resolve of this.#waiting.splice(0)) resolve();
  }

  get duration() {
    return this.#playback.duration;
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

  /** Goes on; with a clip, the name of one, or null for the whole sequence, plays that from its
   * start. */
  play(clip) {
    if (clip !== undefined) this.#choose(this.#found(clip));
    this.#playback.play();
    return this;
  }

  /** Of several clips with a name, the first. */
  #found(wanted) {
    if (wanted === null || this.clips.includes(wanted)) return wanted;
    const clip = this.clips.find(({ name }) => name === wanted);
    if (clip) return clip;
    const names = this.clips.map(({ name }) => `"${name}"`).join(", ");
    throw new RangeError(`no clip "${wanted?.name ?? wanted}"; there are ${names || "none"}`);
  }

  #choose(clip) {
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
    this.#choose(this.#clip);
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
      normals: this.#withNormals, drawn: this.#isDrawn, signal, into: this.#spare.pop() });
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
    this.#isDisposed = true;
    this.#playback.pause();
    this.#playback.cancel();
    this.#arrived();
    this.#decoder.close();
    this.geometry.dispose();
    if (!this.#ownMaterial) return;
    for (const material of [this.material].flat()) dispose(material, this.#ownTextures);
  }
}

export class RLPCLoader extends Loader {
  constructor(manager) {
    super(manager);
    this.options = {};
  }

  /** Of RlpcDecoder.open() and of RLPCMesh. */
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
    const { material, normals, attributes, textures, gltfLoader, ...options } = this.options;
    const decoder = await RlpcDecoder.open(source, {
      headers: this.requestHeader,
      credentials: this.withCredentials ? "include" : "same-origin",
      onProgress: onProgress && ((progress) =>
        onProgress({ lengthComputable: progress.total !== undefined, ...progress })),
      ...options,
    });
    return RLPCMesh.create(decoder, { material, attributes, textures, gltfLoader,
      ...(normals === undefined ? {} : { normals }) });
  }
}
