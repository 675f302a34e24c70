// RLPCMesh: a mesh of three.js that plays a stream. three.d.ts describes it.
import { LoopOnce, LoopPingPong, LoopRepeat, Mesh, Object3D } from "three";

import { FrameMix } from "./blend.js";
import { ClipPose, poseName } from "./clip_animations.js";
import { aborted } from "./error.js";
import { LevelGeometries } from "./level_geometries.js";
import { Playback } from "./playback.js";
import { PoseMix } from "./pose_mix.js";
import { ShownStream } from "./shown_stream.js";
import { dress, loadLook, usualMaterial } from "./three_look.js";

const kLoopNames =
  new Map([[LoopRepeat, "repeat"], [LoopOnce, "once"], [LoopPingPong, "pingpong"]]);

function givenMaterial(material, decoder) {
  return typeof material === "function" ? material(decoder) : material;
}

export class RLPCMesh extends Mesh {
  #stream;
  #playback;
  #loop = LoopRepeat;
  #clip = null;
  #isDisposed = false;
  #base; // frame of #playback that is shown, if any
  #firstError; // error of the first frame
  #poses = []; // ClipPose of each animation
  #poseMix;
  #wanted = new FrameMix();
  #shown = new FrameMix();
  #levels;
  #level; // wanted level, shown as soon as its frames are decoded

  /** Makes a mesh with its first frame, attributes, materials and textures. */
  static async create(decoder, options = {}) {
    let mesh;
    try {
      const look = await loadLook(decoder, options);
      const material = givenMaterial(options.material, decoder);
      mesh = new RLPCMesh(decoder, { normals: !look?.isFlat, ...options, material }, look);
      const stream = mesh.#stream;
      if (look) {
        mesh.material = await dress(mesh.geometry, look, material);
        stream.adopt(mesh.geometry);
      }
      const isOwn = typeof options.material === "function" ||
        !material?.isMaterial && !Array.isArray(material);
      if (isOwn) stream.materials = [mesh.material].flat();
      await mesh.#first();
      return mesh;
    } catch (error) {
      if (mesh) mesh.dispose();
      else decoder.close();
      throw error;
    }
  }

  constructor(decoder, options = {}, look = undefined) {
    const { material, normals = true, frameMemory, interpolate = true } = options;
    const stream = decoder instanceof ShownStream ? decoder
      : new ShownStream(decoder, { normals, frameMemory }, look);
    const levels = new LevelGeometries(stream);
    super(levels.geometry);
    this.type = "RLPCMesh";
    this.#stream = stream;
    this.#levels = levels;
    this.#level = levels.level;
    this.#poseMix = new PoseMix(stream, this.#poses);
    this.animations = [...stream.animations];
    stream.slots.forEach(() => this.addPose());
    stream.meshes.add(this);
    this.#playback = this.#makePlayback(interpolate);
    if (decoder === stream) return; // a clone
    const given = givenMaterial(material, decoder);
    this.material = given ?? usualMaterial({ flatShading: !normals });
    if (!given || typeof material === "function") stream.materials = [this.material].flat();
  }

  #makePlayback(interpolates) {
    const stream = this.#stream;
    const { frames, frameRate } = stream.decoder.info;
    const playback = new Playback({
      frames, frameRate, interpolates, ahead: stream.ahead,
      request: (index, signal) => stream.frames.acquire(index, signal),
      peek: (index) => stream.frames.hold(index),
      discard: (frame) => stream.frames.release(frame),
      failed: (error, index) => this.#failed(error, index),
    });
    playback.arrived = () => stream.arrived();
    playback.finished = () => this.dispatchEvent({ type: "finished", clip: this.#clip });
    playback.looped = () => this.dispatchEvent({ type: "loop", clip: this.#clip });
    return playback;
  }

  #failed(error, index) {
    this.#firstError ??= error;
    this.dispatchEvent({ type: "error", error, index });
  }

  /** Makes the property that an animation moves. Called for each animation of the stream. */
  addPose() {
    const pose = new ClipPose();
    pose.failed = (error, index) => this.#failed(error, index);
    Object.defineProperty(this, poseName(this.#poses.length), { value: pose });
    this.#poses.push(pose);
  }

  get decoder() {
    return this.#stream.decoder;
  }

  get clips() {
    return this.decoder.clips;
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

  /** Sets time, and resolves once its frame, or that of a later seek, is shown. */
  async seek(seconds) {
    this.time = seconds;
    while (!this.#isDisposed && !this.#playback.isReady) await this.#stream.arrival();
    if (this.#isDisposed) throw aborted("the mesh has been disposed of");
    this.update(0);
  }

  /** Resolves once all frames that the actions of an AnimationMixer want now are shown. */
  async ready() {
    while (!this.#isDisposed) {
      this.update(0);
      if (this.#poseMix.isComplete) return;
      await this.#stream.arrival();
    }
    throw aborted("the mesh has been disposed of");
  }

  async #first() {
    while (!this.#playback.isReady) await this.#stream.arrival();
    this.update(0);
    if (!this.#base) throw this.#firstError;
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

  /** Whether to interpolate between frames. */
  get interpolate() {
    return this.#playback.interpolates;
  }

  set interpolate(interpolate) {
    this.#playback.setInterpolates(Boolean(interpolate));
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

  /** Resumes; with a clip, its name, or null for the whole sequence, plays that from its start. */
  play(clip) {
    if (clip !== undefined) this.#choose(this.#found(clip));
    this.#playback.play();
    return this;
  }

  /** Returns a clip, given by name (the first with it) or as a clip of another mesh of the stream.
   * */
  #found(wanted) {
    if (wanted === null || this.clips.includes(wanted)) return wanted;
    const clip = this.clips.find(({ name, firstFrame, frames }) => name === wanted ||
      name === wanted.name && firstFrame === wanted.firstFrame && frames === wanted.frames);
    if (clip) return clip;
    const names = this.clips.map(({ name }) => `"${name}"`).join(", ");
    throw new RangeError(typeof wanted === "string"
      ? `no clip "${wanted}"; there are ${names || "none"}`
      : "a clip is one of `clips`, its name, or null for the whole sequence");
  }

  #choose(clip) {
    this.#clip = clip;
    this.#playback.setRange(clip?.firstFrame ?? 0, clip?.frames ?? this.decoder.info.frames);
  }

  pause() {
    this.#playback.pause();
    return this;
  }

  /** Stops and returns to the start. */
  stop() {
    this.pause();
    this.#choose(this.#clip);
    return this;
  }

  /** Advances playback. Must be called for each picture, with the seconds since the last one. */
  update(delta, camera) {
    if (this.#isDisposed) return false;
    this.#playback.ahead = this.#stream.ahead;
    const reply = this.#playback.tick(delta);
    if (reply?.frame) {
      if (this.#base) this.#stream.frames.release(this.#base);
      this.#base = reply.frame;
    }
    if (camera) this.selectLevel(camera);
    return this.#apply() || reply !== undefined;
  }

  /** Shows the state set by actions of an AnimationMixer; three.js calls it before each picture. */
  updateMatrixWorld(force) {
    this.#apply();
    super.updateMatrixWorld(force);
  }

  /** Updates the picture. Returns whether it has changed. */
  #apply() {
    if (this.#isDisposed) return false;
    const mix = this.#wanted;
    this.#poseMix.fill(mix, this.#playback, this.#base);
    const switches = this.#level !== this.#levels.level;
    const waits = !this.#playback.isShown && this.#shown.count > 0 && !this.#poseMix.hasPoses;
    if (mix.count === 0 || !switches && (waits || mix.equals(this.#shown))) return false;
    if (switches) this.geometry = this.#levels.choose(this.#level);
    this.#levels.show(mix);
    this.#shown.copy(mix);
    const { index } = this.#poseMix;
    if (index === this.frame) return true;
    this.frame = index;
    this.dispatchEvent({ type: "frame", index });
    return true;
  }

  /** Adds a level of detail: { layers, distance, hysteresis }. Resolves to its number. */
  async addLevel(options) {
    const level = await this.#stream.addLevel(options);
    return this.#stream.levels.indexOf(level);
  }

  get level() {
    return this.#stream.levels.indexOf(this.#level);
  }

  set level(number) {
    const { levels } = this.#stream;
    if (!levels[number]) throw new RangeError(`level is a whole number below ${levels.length}`);
    if (levels[number] === this.#level) return;
    this.#level = levels[number];
    this.#apply();
  }

  /** Chooses the level for the distance to a camera, as LOD of three.js does. */
  selectLevel(camera) {
    this.level = this.#levels.numberFor(camera, this.matrixWorld, this.#level);
    return this;
  }

  /** Makes an AnimationClip of a clip, its name, or null for the whole sequence: for a second
   * simultaneous action of a clip, for example to fade it into itself. */
  makeAnimation(clip) {
    return this.#stream.animation(this.#found(clip));
  }

  /** Makes a mesh of the same stream with a separate time and actions. */
  clone(recursive) {
    return new RLPCMesh(this.#stream, { interpolate: this.interpolate }).copy(this, recursive);
  }

  copy(source, recursive) {
    if (!(#stream in source) || source.#stream !== this.#stream) {
      throw new TypeError("copy() takes a mesh of the same stream");
    }
    Object3D.prototype.copy.call(this, source, recursive);
    this.material = Array.isArray(source.material) ? source.material.slice() : source.material;
    this.animations = [...source.animations];
    this.frame = source.frame;
    this.loop = source.loop;
    this.speed = source.speed;
    this.#choose(source.#clip);
    this.time = source.time;
    if (source.playing) this.play();
    this.#level = source.#level;
    this.geometry = this.#levels.choose(this.#level);
    this.#levels.copy(source.#levels);
    return this;
  }

  dispose() {
    if (this.#isDisposed) return;
    this.#isDisposed = true;
    this.#playback.pause();
    this.#playback.cancel();
    if (this.#base) this.#stream.frames.release(this.#base);
    this.#base = undefined;
    for (const pose of this.#poses) this.#stream.frames.dismiss(pose);
    this.#levels.dispose();
    this.#stream.leave(this);
  }
}
