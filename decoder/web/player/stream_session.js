// Shown stream, with its reference and the check of all its frames: the page's use of the package.
import { RlpcDecoder } from "../package/src/index.js";
import { byMaterial, colourSet, hasNormals, materialSet, uvSets } from "../package/src/sets.js";
import { readMaterials } from "./asset_materials.js";
import { vertexDistances } from "./distances.js";

/** Maximum number of frames kept to reuse their arrays. */
const kMaxSpare = 4;

/** Returns the look for Viewer.setMesh(), from the names of attributes. */
function lookOf({ attributes }, parts) {
  const uvs = uvSets(attributes).map(({ name, values }) => [name, values]);
  return { uvs, tints: colourSet(attributes), parts };
}

export class StreamSession {
  /** Opens a stream. stream: a blob or a URL; options: of RlpcDecoder.open(). */
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

  /** Opens the reference. The stream plays without it if that fails. */
  async openReference(stream) {
    this.hasReference = true;
    try {
      const reference = await RlpcDecoder.open(stream, this.options);
      const { vertices, triangles } = this.decoder.info;
      if (reference.info.vertices !== vertices || reference.info.triangles !== triangles) {
        reference.close();
        throw new Error(`it has ${reference.info.vertices} vertices and ` +
          `${reference.info.triangles} triangles, not ${vertices} and ${triangles}`);
      }
      this.reference = reference;
    } catch (error) {
      this.referenceError = error;
    }
  }

  /** Decodes half of the vertex layers of a stream from a server, which arrive sooner. Returns the
   * mesh and its frame; undefined without layers, or if they have an error. */
  async coarseFrame(index) {
    const { layers } = this.decoder.info;
    if (!this.isRemote || layers < 2) return undefined;
    try {
      const coarse = await RlpcDecoder.open(this.decoder,
        { ...this.options, coarseLayers: Math.ceil(layers / 2) });
      try {
        const frame = await coarse.frame(index, { coordinates: true, normals: true });
        return { info: coarse.info, indices: coarse.indices, frame };
      } finally {
        coarse.close();
      }
    } catch {
      return undefined; // the whole mesh has the same error, and reports it
    }
  }

  /** Returns the mesh for the viewer: { numVertices, triangles, look, isFlat }, without a look if
   * the stream has none; problems: parts that cannot be shown. */
  async mesh() {
    const { decoder } = this;
    const { vertices, hasAttributes, hasAsset, damagedUnits } = decoder.info;
    const lost = damagedUnits === 0 ? []
      : ["Attributes, materials, clips or metadata are damaged, and left out"];
    const plain = { numVertices: vertices, triangles: decoder.indices, problems: lost };
    if (!hasAttributes && !hasAsset) return plain;
    try {
      const [drawn, sets, told] =
        await Promise.all([decoder.drawn(), decoder.attributes(), this.readAsset()]);
      const { materials, problems } = told;
      this.drawn = drawn;
      const { indices, groups } =
        byMaterial(drawn.indices, materialSet(sets), materials.length);
      return { numVertices: drawn.vertices.length, triangles: indices, materials,
        problems: [...lost, ...problems],
        isFlat: materials.length > 0 && !hasNormals(sets), look: lookOf(drawn, groups) };
    } catch (error) {
      if (error.kind === "closed") throw error;
      return { ...plain,
        problems: [...lost, `The attributes cannot be decoded: ${error.message}`] };
    }
  }

  /** Reads the asset. Its errors do not affect the mesh. */
  async readAsset() {
    try {
      const asset = await this.decoder.asset();
      return asset ? await readMaterials(asset) : { materials: [], problems: [] };
    } catch (error) {
      if (error.kind === "closed") throw error;
      return { materials: [], problems: [`The materials cannot be read: ${error.message}`] };
    }
  }

  /** Returns edges, pairs of drawn vertices. */
  async edges() {
    const edges = await this.decoder.edges();
    if (!this.drawn) return edges;
    const place = new Uint32Array(this.decoder.info.vertices);
    this.drawn.vertices.forEach((vertex, drawn) => (place[vertex] = drawn));
    return edges.map((vertex) => place[vertex]);
  }

  /** Decodes a frame to draw, with distances from the reference. */
  async frame(index, { normals, signal }) {
    const frame = await this.decoder.frame(index, {
      positions: false, coordinates: true, integers: this.hasReference, normals, tolerant: true,
      drawn: Boolean(this.drawn), signal, into: this.spare.pop() });
    if (this.hasReference) await this.compare(frame, signal);
    const { min, max } = this.boxOf(frame);
    return Object.assign(frame, { box: [...min, ...max] });
  }

  /** Returns the box of the coordinates, which are relative to the centre. */
  boxOf({ bounds }) {
    const scale = 2 ** (1 - this.decoder.info.positionBits) / this.decoder.gridStep;
    const half = bounds.max.map((max, axis) => ((max - bounds.min[axis]) * scale) / 2);
    return { min: half.map((value) => -value), max: half };
  }

  /** Compares a frame with the reference, whose errors do not affect the stream. */
  async compare(frame, signal) {
    frame.referenceError = this.referenceError;
    if (!this.reference) return;
    try {
      const other = await this.reference.frame(frame.index, {
        positions: false, integers: true, tolerant: true, signal });
      if (other.error?.rule === "R-HSH-02") frame.referenceError = other.error;
      Object.assign(frame, vertexDistances(frame, this.decoder, other, this.reference,
        this.drawn?.vertices));
    } catch (error) {
      if (error.name === "AbortError") throw error;
      frame.referenceError = error;
    }
  }

  /** Keeps a frame that is no longer shown, to reuse its arrays. */
  recycle(frame) {
    if (this.spare.length < kMaxSpare) this.spare.push(frame);
  }

  /** Loads the whole stream, which is a blob from then on. */
  async download() {
    if (this.isRemote) this.stream = await this.decoder.download();
  }

  /** Decodes all frames in order with a separate decoder, so that playback continues. Returns false
   * if it was stopped; throws the error that ended it. */
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
