// Attributes, drawn vertices and the asset of a stream, from wasm/attribute_exports.cpp.
import { gathered } from "./gathered.js";

const kDomains = ["vertex", "corner", "triangle"];
const kKinds = ["integers", "unitVectors", "floats", "smoothing"];

export class WasmAttributes {
  /** stream: an open stream of WasmDecoder. */
  constructor(stream, { num_triangles: numTriangles, num_vertices: numVertices }) {
    Object.assign(this, { stream, numTriangles, numVertices });
  }

  /** Decodes the attributes. Must be called before the functions below, except asset(). */
  decode() {
    this.stream.check("stream_decode_attributes");
  }

  sets() {
    return Array.from({ length: this.ask("stream_num_sets") }, (_, set) => this.set(set));
  }

  set(set) {
    const { stream } = this;
    const count = this.ask("stream_set_num_values", set);
    const components = this.ask("stream_set_components", set);
    const domain = kDomains[this.ask("stream_set_domain", set)];
    const copy = (Type, name, length) => stream.copy(Type, name, length, undefined, set);
    return {
      name: stream.text(this.ask("stream_set_name", set)),
      domain, kind: kKinds[this.ask("stream_set_kind", set)], components, count,
      values: copy(Float32Array, "stream_set_numbers", components * count),
      integers: copy(Uint32Array, "stream_set_integers",
        count * this.ask("stream_set_coded_components", set)),
      corners: domain === "corner"
        ? copy(Uint32Array, "stream_set_corners", 3 * this.numTriangles) : undefined,
    };
  }

  /** Makes vertices with one value of each set. */
  drawn() {
    const { stream } = this;
    const count = this.ask("stream_num_drawn");
    const attributes = [];
    for (const { name, components, values } of this.sets()) {
      const set = attributes.length;
      const places = this.placesOf(set, count);
      attributes.push(places && { name, components, values: gathered(values, places, components) });
    }
    return {
      vertices: stream.copy(Uint32Array, "stream_drawn_vertices", count),
      indices: stream.copy(Uint32Array, "stream_drawn_triangles", 3 * this.numTriangles),
      attributes: attributes.filter(Boolean),
    };
  }

  /** Returns the place of the value of each drawn vertex. */
  placesOf(set, count) {
    const address = this.ask("stream_drawn_values", set) >>> 0;
    return address === 0 ? undefined
      : new Uint32Array(this.stream.decoder.exports.memory.buffer, address, count);
  }

  /** Returns an array of the frame that was decoded last, at the drawn vertices. */
  frameValues(name, into) {
    const { stream } = this;
    this.numDrawn ??= this.ask("stream_num_drawn");
    this.numNormals ??= this.ask("stream_num_set_normals");
    if (name === "normals" && this.numNormals > 0) {
      const normals = stream.view(Float32Array, "stream_set_normals", 3 * this.numNormals);
      return gathered(normals, stream.view(Uint32Array, "stream_drawn_normals", this.numDrawn), 3,
        into);
    }
    this.vertices ??= stream.copy(Uint32Array, "stream_drawn_vertices", this.numDrawn);
    return stream.frameValues(name, this.numVertices, this.vertices, into);
  }

  /** Reads the asset; null if the stream has none. */
  asset() {
    this.stream.check("stream_read_asset");
    const size = this.ask("stream_asset_size");
    return size > 0 ? this.stream.copy(Uint8Array, "stream_asset", size) : null;
  }

  ask(name, ...args) {
    return this.stream.ask(name, ...args);
  }
}
