// The decoder of player_exports.cpp, as JavaScript sees it.

export class StreamError extends Error {
  /** code: as the exit codes of rlpcdec; rule: of the specification, or "". */
  constructor(text, code, rule) {
    super(text);
    this.code = code;
    this.rule = rule;
  }
}

const kLimitExceeded = 3;

/** The module, ready for streams. */
export class DecoderModule {
  static async create(wasm) {
    const module = new DecoderModule();
    const { instance } = await WebAssembly.instantiate(wasm, {
      player: {
        read_stream: (stream, offset, out, size) =>
          new Uint8Array(module.exports.memory.buffer).set(
            module.streams[stream].subarray(offset, offset + size), out >>> 0),
      },
      env: { emscripten_notify_memory_growth: () => {} },
      wasi_snapshot_preview1: {
        proc_exit: (code) => {
          throw new Error(`the decoder ended with ${code}`);
        },
      },
    });
    module.exports = instance.exports;
    module.exports._initialize();
    return module;
  }

  constructor() {
    this.streams = [];
  }

  /** The bytes stay where they are: the decoder copies a unit at a time. */
  open(bytes) {
    const stream = this.streams.push(bytes) - 1;
    return new StreamDecoder(this.exports, this.exports.player_new(stream, bytes.length));
  }
}

/** Frames of one stream, in any order. Arrays that it returns are copies. */
class StreamDecoder {
  constructor(exports, page) {
    this.exports = exports;
    this.page = page;
    this.check(() => exports.player_open(page));
    this.header = JSON.parse(this.text(exports.player_describe(page)));
  }

  /** Throws if the frame cannot be decoded. */
  decode(frame) {
    this.check(() => this.exports.player_decode(this.page, frame));
  }

  /** After the last frame: throws if the rest of the stream is wrong. */
  finish() {
    this.check(() => this.exports.player_finish(this.page));
  }

  /** Draws it where another stream is drawn. */
  placeIn(other) {
    this.exports.player_place_in(this.page, other.page);
  }

  triangles() {
    return this.copy(Uint32Array, "player_triangles", 3 * this.header.num_triangles);
  }

  edges() {
    const count = this.exports.player_num_edges(this.page);
    return this.copy(Uint32Array, "player_edges", 2 * count);
  }

  // Of the frame that was decoded last.

  /** Integers on the grid: what decoders have to agree on. */
  positions() {
    return this.copy(Int32Array, "player_positions", 3 * this.header.num_vertices);
  }

  /** From the centre of the frame, in a cube from -1 to 1 that holds all positions. */
  coordinates(into) {
    return this.copy(Float32Array, "player_coordinates", 3 * this.header.num_vertices, into);
  }

  normals(into) {
    return this.copy(Int16Array, "player_normals", 4 * this.header.num_vertices, into);
  }

  /** In that cube; numbers of 64 bits, as frames may be small and far away. */
  centre() {
    return this.copy(Float64Array, "player_centre", 3);
  }

  /** Least and most coordinates. */
  box() {
    return this.copy(Float32Array, "player_box", 6);
  }

  frameCrc() {
    return this.exports.player_frame_crc(this.page) >>> 0;
  }

  hashDiffers() {
    return this.exports.player_hash_differs(this.page) !== 0;
  }

  comparedFrames() {
    return this.exports.player_compared_frames(this.page);
  }

  /** From the frame that another stream decoded last. */
  distances(reference, into) {
    const address = this.exports.player_distances(this.page, reference.page);
    return {
      distances: this.copyFrom(Float32Array, address, this.header.num_vertices, into),
      largest: this.exports.player_largest_distance(this.page),
      rms: this.exports.player_rms_distance(this.page),
    };
  }

  copy(Type, name, length, into) {
    return this.copyFrom(Type, this.exports[name](this.page), length, into);
  }

  copyFrom(Type, address, length, into) {
    const array = into?.length === length ? into : new Type(length);
    array.set(new Type(this.exports.memory.buffer, address >>> 0, length));
    return array;
  }

  text(address) {
    const bytes = new Uint8Array(this.exports.memory.buffer, address >>> 0);
    return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
  }

  /** call(): true, or the decoder knows an error. */
  check(call) {
    let done = false;
    try {
      done = call();
    } catch (failure) {
      // The only thing that stops it on the way; its memory cannot be trusted any more.
      if (!(failure instanceof WebAssembly.RuntimeError)) throw failure;
      throw new StreamError("out of memory", kLimitExceeded, "");
    }
    if (!done) throw this.error();
  }

  /** The last one: why a call has thrown, or that a hash differs. */
  error() {
    return new StreamError(
      this.text(this.exports.player_error_text(this.page)),
      this.exports.player_error_code(this.page),
      this.text(this.exports.player_error_rule(this.page)));
  }
}
