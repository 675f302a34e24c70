// JavaScript interface of the decoder of wasm/exports.cpp. Nothing here waits: a call that needs
// bytes that are not loaded throws MissingBytes, and can be repeated once they are.
import { RlpcError, kKinds } from "./error.js";
import { gathered } from "./gathered.js";

/** Arrays of frames, three numbers per vertex: the type, and the function that returns them. */
const kFrameArrays = {
  integers: [Int32Array, "stream_positions"],
  positions: [Float32Array, "stream_floats"],
  coordinates: [Float32Array, "stream_coordinates"],
  normals: [Float32Array, "stream_normals"],
};

export class MissingBytes extends Error {
  constructor(start, end) {
    super(`bytes ${start} to ${end} of the stream are not loaded`);
    this.start = start;
    this.end = end;
  }
}

/** Instance of the WebAssembly module, for one stream. */
export class WasmDecoder {
  /** Makes a decoder. module: a WebAssembly.Module, or its bytes. */
  static async create(module) {
    const decoder = new WasmDecoder();
    const result = await WebAssembly.instantiate(module, {
      rlpc: { read_stream: (offset, out, size) => decoder.read(offset, out, size) },
      env: { emscripten_notify_memory_growth: () => {} },
      wasi_snapshot_preview1: {
        proc_exit: (code) => {
          throw new Error(`the decoder ended with ${code}`);
        },
      },
    });
    decoder.exports = (result.instance ?? result).exports;
    decoder.exports._initialize();
    return decoder;
  }

  constructor() {
    this.ranges = undefined;
    this.missing = undefined;
    this.lastRead = 0;
  }

  read(offset, out, size) {
    const target = new Uint8Array(this.exports.memory.buffer, out >>> 0, size >>> 0);
    this.lastRead = offset;
    if (this.ranges.copy(offset, target)) return true;
    this.missing = new MissingBytes(offset, offset + target.length);
    return false;
  }

  /** Makes a stream of `size` bytes; `ranges` has those that are loaded. */
  stream(ranges, size, options) {
    this.ranges = ranges;
    return new WasmStream(this, size, options);
  }
}

function outOfMemory() {
  return new RlpcError("out of memory", { kind: "limit" });
}

/** Decodes frames of one stream in any order. Arrays that it returns are copies. */
class WasmStream {
  constructor(decoder, size, { maxMemory, coarseLayers, verifyHashes, skipDamagedUnits }) {
    this.decoder = decoder;
    this.stream = this.call("stream_new", size, maxMemory, coarseLayers, verifyHashes,
      skipDamagedUnits);
  }

  /** Offset of the last read. */
  get lastRead() {
    return this.decoder.lastRead;
  }

  open() {
    this.check("stream_open");
  }

  /** Returns the header and the number of frames, which an open-ended stream has at its end. */
  describe() {
    this.decoder.missing = undefined;
    const header = JSON.parse(this.text(this.ask("stream_describe")));
    if (this.decoder.missing) throw this.decoder.missing;
    header.metadata = this.text(this.ask("stream_metadata"));
    header.clips = Array.from({ length: header.num_clips }, (_, i) => ({
      name: this.text(this.ask("stream_clip_name", i)),
      firstFrame: this.ask("stream_clip_first_frame", i),
      frames: this.ask("stream_clip_num_frames", i),
    }));
    return header;
  }

  /** Returns the offsets of GOFs and shared rigs, and the end of the last one. */
  landmarks() {
    this.check("stream_find_index");
    const count = this.ask("stream_num_landmarks");
    return this.copy(Float64Array, "stream_landmarks", count);
  }

  triangles(numTriangles) {
    return this.copy(Uint32Array, "stream_triangles", 3 * numTriangles);
  }

  /** Returns the index in the whole mesh of each vertex of a coarse mesh. */
  coarseVertices(numVertices) {
    return this.copy(Uint32Array, "stream_coarse_vertices", numVertices);
  }

  edges() {
    const count = this.ask("stream_num_edges");
    return this.copy(Uint32Array, "stream_edges", 2 * count);
  }

  decode(frame) {
    this.check("stream_decode", frame);
  }

  /** Checks the rest of the stream, after the last frame. */
  finish() {
    this.check("stream_finish");
  }

  /** Returns an array of the frame that was decoded last. places: vertices to return, or undefined
   * for all; into: an array to fill, or undefined. */
  frameValues(name, numVertices, places, into) {
    const [Type, source] = kFrameArrays[name];
    if (!places) return this.copy(Type, source, 3 * numVertices, into);
    return gathered(this.view(Type, source, 3 * numVertices), places, 3, into);
  }

  /** Returns the minima and maxima of x, y, z, in grid units. */
  extent() {
    return this.copy(Int32Array, "stream_extent", 6);
  }

  crc() {
    return this.ask("stream_frame_crc") >>> 0;
  }

  comparedFrames() {
    return this.ask("stream_compared_frames");
  }

  /** Returns the error of a frame that was decoded but does not match its hash. */
  hashError() {
    return this.ask("stream_hash_differs") ? this.error() : undefined;
  }

  copy(Type, name, length, into, ...args) {
    const array = into?.length === length && into instanceof Type ? into : new Type(length);
    array.set(this.view(Type, name, length, ...args));
    return array;
  }

  /** Returns a view of memory, valid until the next call of the decoder. */
  view(Type, name, length, ...args) {
    const address = this.ask(name, ...args) >>> 0;
    return length > 0 ? new Type(this.decoder.exports.memory.buffer, address, length) : new Type();
  }

  text(address) {
    const bytes = new Uint8Array(this.decoder.exports.memory.buffer, address >>> 0);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  /** Calls an export of the module. */
  call(name, ...args) {
    if (this.decoder.isBroken) throw outOfMemory();
    try {
      return this.decoder.exports[name](...args);
    } catch (failure) {
      // A trap is the only failure inside a call; afterwards its memory is unusable.
      if (!(failure instanceof WebAssembly.RuntimeError)) throw failure;
      this.decoder.isBroken = true;
      throw outOfMemory();
    }
  }

  /** Calls an export with the stream as its first argument. */
  ask(name, ...args) {
    return this.call(name, this.stream, ...args);
  }

  /** Calls an export that returns true, or false and sets an error, which is thrown. */
  check(name, ...args) {
    this.decoder.missing = undefined;
    if (!this.ask(name, ...args)) throw this.decoder.missing ?? this.error();
  }

  error() {
    return new RlpcError(this.text(this.ask("stream_error_text")), {
      kind: kKinds[this.ask("stream_error_code")],
      rule: this.text(this.ask("stream_error_rule")),
      element: this.text(this.ask("stream_error_element")),
      bitOffset: this.ask("stream_error_bit"),
    });
  }
}
