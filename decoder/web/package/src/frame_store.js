// Decoded frames of a stream, shared by all meshes that show it: each is decoded once while memory
// lasts, and the arrays of dropped frames are reused.
import { aborted } from "./error.js";

const kInFlight = 2; // requested frames: one is decoded while another is transferred
const kMinFrames = 8; // kept whatever their size
const kRetryMilliseconds = 2000; // until a frame that could not be decoded is requested again

/** Default bytes for frames that are kept. */
export const kUsualFrameMemory = 2 ** 26;

export class FrameStore {
  #decode;
  #capacity;
  #frames = new Map(); // key: index
  #pending = new Map(); // requests without a reply, by index
  #wants = new Map(); // index of the frame that each user wants; served in this order, in turn
  #failures = new Map(); // time of the failure by index
  #numWanted = 0; // number of #pending that users want
  #clock = 0; // counts uses
  #isClosed = false;
  #isDue = false; // whether #pump() will be called
  #pumpLater = () => {
    this.#isDue = false;
    this.#pump();
  };

  /** decode(index, into, signal) returns a promise of a frame, { positions, normals, bounds };
   * `into`: a frame whose arrays can be reused, or undefined. arrived() is called when a frame, or
   * its error, arrives. */
  constructor({ decode, bytesPerFrame, maxBytes = kUsualFrameMemory, arrived = () => {} }) {
    this.#decode = decode;
    this.#capacity = Math.max(kMinFrames, Math.floor(maxBytes / Math.max(1, bytesPerFrame)));
    this.arrived = arrived;
  }

  /** Maximum number of frames to keep, unless more are in use at the same time. */
  get capacity() {
    return this.#capacity;
  }

  get size() {
    return this.#frames.size;
  }

  has(index) {
    return this.#frames.has(index);
  }

  /** Returns a frame if it is decoded; valid until the caller awaits something. */
  get(index) {
    const frame = this.#frames.get(index);
    if (frame) frame.used = ++this.#clock;
    return frame;
  }

  /** Returns a frame if it is decoded, and keeps it until release(). */
  hold(index) {
    const frame = this.get(index);
    if (frame) ++frame.users;
    return frame;
  }

  /** Returns a promise of a frame, and keeps it until release(). */
  acquire(index, signal) {
    const there = this.hold(index);
    if (there) return Promise.resolve(there);
    const request = this.#pending.get(index) ?? this.#start(index);
    ++request.waiting;
    return new Promise((resolve, reject) => {
      const leave = () => {
        this.#leave(request);
        reject(signal.reason);
      };
      signal?.addEventListener("abort", leave, { once: true });
      request.promise.then((frame) => {
        signal?.removeEventListener("abort", leave);
        if (signal?.aborted) return;
        ++frame.users;
        resolve(frame);
      }, (error) => {
        signal?.removeEventListener("abort", leave);
        reject(error);
      });
    });
  }

  /** Ends a request without a user. */
  #leave(request) {
    if (--request.waiting > 0 || request.isWanted) return;
    this.#forget(request);
    request.controller.abort(aborted());
  }

  release(frame) {
    --frame.users;
    this.#trim();
  }

  /** Requests a frame on behalf of `who`, in place of the one it wanted before. Calls failed(error,
   * index) of `who` if the frame cannot be decoded. */
  want(who, index) {
    if (this.#isClosed || this.#frames.has(index) || this.hasFailed(index)) return;
    this.#wants.set(who, index);
    if (this.#isDue) return;
    this.#isDue = true;
    queueMicrotask(this.#pumpLater); // frames that are being blended now must not be reused
  }

  /** Ends the request of `who`. */
  dismiss(who) {
    this.#wants.delete(who);
  }

  /** Returns whether a frame could not be decoded recently. */
  hasFailed(index) {
    const when = this.#failures.get(index);
    if (when === undefined) return false;
    if (performance.now() - when < kRetryMilliseconds) return true;
    this.#failures.delete(index);
    return false;
  }

  close() {
    this.#isClosed = true;
    this.#wants.clear();
    for (const { controller } of this.#pending.values()) controller.abort(aborted());
    this.#pending.clear();
    this.#frames.clear();
  }

  #pump() {
    for (const [who, index] of this.#wants) {
      if (this.#numWanted >= kInFlight) return;
      this.#wants.delete(who);
      if (!this.#frames.has(index)) this.#serve(who, index);
    }
  }

  #serve(who, index) {
    const request = this.#pending.get(index) ?? this.#start(index);
    if (request.isWanted) return;
    request.isWanted = true;
    ++this.#numWanted;
    request.promise.catch((error) => {
      if (this.#isClosed) return;
      this.#failures.set(index, performance.now());
      who.failed(error, index);
      this.arrived();
    }).finally(() => {
      --this.#numWanted;
      if (!this.#isClosed) this.#pump();
    });
  }

  #start(index) {
    const request = { index, waiting: 0, isWanted: false, controller: new AbortController() };
    const { signal } = request.controller;
    this.#pending.set(index, request);
    request.promise = this.#decode(index, this.#spare(), signal).then((frame) => {
      this.#forget(request);
      if (signal.aborted) throw signal.reason;
      const { positions, normals, bounds } = frame;
      const kept = { index, positions, normals, bounds, users: 0, used: ++this.#clock };
      this.#frames.set(index, kept);
      this.#failures.delete(index);
      this.#trim();
      this.arrived();
      return kept;
    }, (error) => {
      this.#forget(request);
      throw error;
    });
    request.promise.catch(() => {}); // reported to users
    return request;
  }

  #forget(request) {
    if (this.#pending.get(request.index) === request) this.#pending.delete(request.index);
  }

  /** Returns a frame to reuse if there is no memory for one more. */
  #spare() {
    return this.#frames.size + this.#pending.size > this.#capacity ? this.#dropOldest() : undefined;
  }

  #trim() {
    while (this.#frames.size > this.#capacity && this.#dropOldest()) ;
  }

  /** Drops and returns the least recently used frame that is not in use; undefined if none. */
  #dropOldest() {
    let oldest;
    for (const frame of this.#frames.values()) {
      if (frame.users === 0 && !(frame.used > oldest?.used)) oldest = frame;
    }
    if (oldest) this.#frames.delete(oldest.index);
    return oldest;
  }
}
