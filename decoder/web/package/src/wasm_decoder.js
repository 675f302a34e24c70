// The decoder of wasm/exports.cpp, as JavaScript sees it. Nothing here waits: a call that needs
// bytes which are not loaded throws MissingBytes, and can be made again once they are.
import { RlpcError, kKinds } from "./error.js";
import { gathered } from "./gathered.js";

/** What frames have of each vertex, three numbers: its type, and the function that gives it. */
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

/** An instance of the WebAssembly module, for one stream. */
export class WasmDecoder {
  /** module: a WebAssembly.Module, or its bytes. */
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

  /** The stream of `size` bytes, of which `ranges` has those that are loaded. */
  stream(ranges, size, options) {
    this.ranges = ranges;
    return new WasmStream(this, size, options);
  }
}

function outOfMemory() {
  return new RlpcError("out of memory", { kind: "limit" });
}

/** Frames of one stream, in any order. Arrays that it returns are copies. */
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

  /** The header, and what is known of the sequence. The number of frames of an open-ended stream
   * is at its end. */
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

  /** Offsets where GOFs and shared rigs begin, and the end of the last. */
  landmarks() {
    this.check("stream_find_index");
    const count = this.ask("stream_num_landmarks");
    return this.copy(Float64Array, "stream_landmarks", count);
  }

  triangles(numTriangles) {
    return this.copy(Uint32Array, "stream_triangles", 3 * numTriangles);
  }

  /** Of a coarse mesh: the index of each vertex in the whole mesh. */
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

  /** After the last frame: checks the rest of the stream. */
  finish() {
    this.check("stream_finish");
  }

  /** Of the frame that was decoded last. places: the vertex of each one that is wanted, or
   * undefined; `into` may be an array to fill. */
  ofFrame(name, numVertices, places, into) {
    const [Type, source] = kFrameArrays[name];
    if (!places) return this.copy(Type, source, 3 * numVertices, into);
    return gathered(this.view(Type, source, 3 * numVertices), places, 3, into);
  }

  /** On the grid: least and most x, y, z. */
  extent() {
    return this.copy(Int32Array, "stream_extent", 6);
  }

  crc() {
    return this.ask("stream_frame_crc") >>> 0;
  }

  comparedFrames() {
    return this.ask("stream_compared_frames");
  }

  /** The error of a frame that was decoded but does not fit its hash. */
  hashError() {
    return this.ask("stream_hash_differs") ? this.error() : undefined;
  }

  copy(Type, name, length, into, ...args) {
    const array = into?.length === length && into instanceof Type ? into : new Type(length);
    array.set(this.view(Type, name, length, ...args));
    return array;
  }

  /** Until the next call of the decoder. */
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
      // The only thing that stops it on the way; its memory cannot be trusted any more.
      if (!(failure instanceof WebAssembly.RuntimeError)) throw failure;
      this.decoder.isBroken = true;
      throw outOfMemory();
    }
  }

  /** Calls an export with the stream as its first argument. */
  ask(name, ...args) {
    return this.call(name, this.stream, ...args);
  }

  /** The same, for an export that returns true or leaves an error. */
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
