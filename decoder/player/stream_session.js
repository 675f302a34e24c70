// A stream that is shown, with its reference and the check of all its frames: what the page asks
// of the package.
import { RlpcDecoder } from "../js/src/index.js";
import { vertexDistances } from "./distances.js";

/** At most so many arrays of frames that are not shown any more are kept. */
const kMostSpare = 4;

export class StreamSession {
  /** stream: a blob or a URL; options: of RlpcDecoder.open(). */
  static async open(stream, reference, options) {
    const session = new StreamSession();
    Object.assign(session, { stream, options, spare: [], isClosed: false });
    session.decoder = await RlpcDecoder.open(stream, options);
    if (reference) await session.openReference(reference);
    return session;
  }

  get isRemote() {
    return !(this.stream instanceof Blob);
  }

  /** Without it, the stream is played all the same. */
  async openReference(stream) {
    this.hasReference = true;
    try {
      this.reference = await RlpcDecoder.open(stream, this.options);
    } catch (error) {
      this.referenceError = error;
    }
  }

  /** Half of the vertex layers of a stream that comes from a server: they are there sooner.
   * Returns the mesh and its frame; undefined where there are no layers, or they have an error. */
  async coarseFrame(index) {
    const { layers } = this.decoder.info;
    if (!this.isRemote || layers < 2) return undefined;
    try {
      const coarse = await RlpcDecoder.open(this.decoder,
        { ...this.options, coarseLayers: Math.ceil(layers / 2) });
      const frame = await coarse.frame(index, { coordinates: true, normals: true });
      coarse.close();
      return { info: coarse.info, indices: coarse.indices, frame };
    } catch {
      return undefined; // the whole mesh has it, too, and it is said there
    }
  }

  /** A frame to draw, with distances from the reference. */
  async frame(index, { normals, signal }) {
    const frame = await this.decoder.frame(index, {
      positions: false, coordinates: true, integers: this.hasReference, normals, tolerant: true,
      signal, into: this.spare.pop() });
    if (this.hasReference) await this.compare(frame, signal);
    const { min, max } = this.boxOf(frame);
    return Object.assign(frame, { box: [...min, ...max] });
  }

  /** Of the coordinates, which are around the centre. */
  boxOf({ bounds }) {
    const scale = 2 ** (1 - this.decoder.info.positionBits) / this.decoder.gridStep;
    const half = bounds.max.map((most, axis) => ((most - bounds.min[axis]) * scale) / 2);
    return { min: half.map((value) => -value), max: half };
  }

  /** What is wrong with the reference is no fault of the stream. */
  async compare(frame, signal) {
    frame.referenceError = this.referenceError;
    if (!this.reference) return;
    try {
      const other = await this.reference.frame(frame.index, {
        positions: false, integers: true, tolerant: true, signal });
      if (other.error?.rule === "R-HSH-02") frame.referenceError = other.error;
      Object.assign(frame, vertexDistances(frame, this.decoder, other, this.reference));
    } catch (error) {
      if (error.name === "AbortError") throw error;
      frame.referenceError = error;
    }
  }

  /** A frame that is not shown any more. */
  recycle(frame) {
    if (this.spare.length < kMostSpare) this.spare.push(frame);
  }

  /** The whole stream, from then on as a blob. */
  async download() {
    if (this.isRemote) this.stream = await this.decoder.download();
  }

  /** Decodes all frames in order with a decoder of its own, so that playing goes on. Returns false
   * if it was stopped; throws what has ended it early. */
  async checkAll(receive) {
    const checker = await RlpcDecoder.open(this.stream, this.options);
    this.checker = checker;
    try {
      for (let index = 0; index < checker.info.frames && !this.isClosed; ++index) {
        const result = await checker.frame(index, { positions: false, tolerant: true })
          .catch((error) => ({ error }));
        if (result.error && checker !== this.checker) return false;
        if (["closed", "source"].includes(result.error?.kind)) throw result.error;
        receive(index, result);
      }
      return !this.isClosed;
    } finally {
      checker.close();
      this.checker = undefined;
    }
  }

  close() {
    this.isClosed = true;
    this.decoder.close();
    this.reference?.close();
    const { checker } = this;
    this.checker = undefined;
    checker?.close();
  }
}
