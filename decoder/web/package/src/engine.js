// Decodes streams, one request after the other: in a worker, or on the thread of its caller.
//
//   request                                         result
//   open        module, source or shared, options   stream  and its description
//   frame       stream, frame, wants, spare,        arrays, extent, crc, compared, ms, error
//               drawn, tolerant
//   edges       stream                              edges
//   attributes  stream                              sets
//   drawn       stream                              vertices, indices, attributes
//   asset       stream                              bytes
//   load        stream                              bytes   of the whole stream
//   close       stream
//
// Each has an id, which its reply repeats: { id, result } or { id, error }. { cancel: id } ends a
// request early. Messages without an id report what has been loaded: { stream, loaded, size }.
import { checkAsset } from "./asset_limit.js";
import { aborted, packed } from "./error.js";
import { openSource } from "./sources.js";
import { WasmAttributes } from "./wasm_attributes.js";
import { MissingBytes, WasmDecoder } from "./wasm_decoder.js";

const kTailBytes = 4096; // usually holds the GOF index
const kBlockBytes = 16384; // loaded at least, without an index
const kMaxBlockBytes = 1 << 20; // largest of consecutive blocks, each twice as large
const kSparseBytes = 1024; // block for a coarse mesh, which omits most slices
const kStepBytes = 1 << 20; // step of a stream that is loaded whole
const kUnitHeaderBytes = 5; // header of the next unit, which ends an access unit

/** Resolves after the messages that wait have been received. */
function messagesReceived() {
  return new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve();
    };
    port2.postMessage(null);
  });
}

/** Decoder and source of a stream. */
class OpenStream {
  constructor(source, options) {
    this.source = source;
    this.options = options;
    this.marks = new Float64Array(); // landmarks of the index
    this.block = { start: 0, bytes: kBlockBytes }; // last block; it begins at the requested place
    this.lastFrame = -1;
    this.endIsChecked = false;
  }

  async open(wasm, signal) {
    const { source } = this;
    if (source.size === undefined) await source.open(signal);
    this.decoder = wasm.stream(source.ranges, source.size, this.options);
    try {
      await this.complete(() => this.decoder.open(), signal);
    } catch (error) {
      if (error.rule === "R-STR-01") error.message += this.guess();
      throw error;
    }
    // A server that sends the stream from its start to its end sends the index last.
    if (!source.whole) await this.findIndex(signal);
    this.header = await this.complete(() => this.decoder.describe(), signal);
    this.look = new WasmAttributes(this.decoder, this.header);
    return this.describe();
  }

  /** Returns the apparent type of a file that is not a stream. */
  guess() {
    const start = new Uint8Array(4);
    if (!this.source.ranges.copy(0, start)) return "";
    const text = String.fromCharCode(...start);
    if (text === "glTF") return "; it looks like glTF: rlpcenc makes a stream of it";
    return text.startsWith("<") ? "; it looks like a page: is the address right?" : "";
  }

  async findIndex(signal) {
    const { size } = this.source;
    await this.source.load(Math.max(0, size - kTailBytes), size, signal); // at once
    try {
      this.marks = await this.complete(() => this.decoder.landmarks(), signal);
    } catch (error) {
      // A wrong index is an error only for calls that need it.
      if (error.name === "AbortError" || error.kind === "network") throw error;
    }
  }

  describe() {
    const { decoder, header, source } = this;
    const isCoarse = this.options.coarseLayers > 0;
    return {
      header, size: source.size,
      indices: decoder.triangles(header.num_triangles),
      coarseVertices: isCoarse ? decoder.coarseVertices(header.num_vertices) : undefined,
    };
  }

  /** Returns the result of a call, which is repeated whenever bytes have been loaded for it. */
  async complete(call, signal) {
    this.source.ranges.protect();
    for (;;) {
      try {
        return call();
      } catch (missing) {
        if (!(missing instanceof MissingBytes)) throw missing;
        // A stream that arrives from its start to its end is awaited only as far as needed.
        const [start, end] =
          this.source.whole ? [missing.start, missing.end] : this.widened(missing);
        await this.source.load(start, end, signal);
      }
    }
  }

  /** Widens a range to the rest of a GOF: few requests, with few unneeded bytes. */
  widened({ start, end }) {
    if (this.options.coarseLayers > 0) {
      return [start, Math.min(Math.max(end, start + kSparseBytes), this.source.size)];
    }
    const mark = this.marks.find((offset) => offset > start);
    const wanted = mark >= end ? mark + kUnitHeaderBytes : this.blockEnd(start);
    return [start, Math.min(Math.max(end, wanted), this.source.size)];
  }

  /** Returns the end of a block of a stream without an index. Reading in order takes fewer and
   * fewer requests. */
  blockEnd(start) {
    const { start: before, bytes } = this.block;
    const follows = start >= before + bytes && start < before + 2 * bytes;
    this.block = { start, bytes: follows ? Math.min(2 * bytes, kMaxBlockBytes) : kBlockBytes };
    return start + this.block.bytes;
  }

  /** Loads the next GOF, or the next block without an index, while this one is played. Errors are
   * reported when its bytes are needed. */
  loadAhead() {
    const { lastRead } = this.decoder;
    const { marks, source } = this;
    if (source.whole) return;
    const next = marks.length > 0
      ? marks.find((offset) => offset >= lastRead && offset < marks.at(-1))
      : source.ranges.gap(lastRead, Math.min(lastRead + this.block.bytes, source.size))?.[0];
    if (next === undefined || next === this.loadedAhead) return;
    this.loadedAhead = next;
    source.load(...this.widened({ start: next, end: next + 1 })).catch(() => {});
  }

  /** Returns all bytes of the stream. */
  async whole(signal) {
    const { source } = this;
    source.ranges.maxBytes = Infinity;
    for (let start = 0; start < source.size; start += kStepBytes) {
      await source.load(start, Math.min(start + kStepBytes, source.size), signal);
    }
    const bytes = new Uint8Array(source.size);
    source.ranges.copy(0, bytes);
    return bytes;
  }

  /** Decodes a frame. tolerant: also checks the rest of the stream after the last frame. */
  async frame({ frame, wants, spare, drawn, tolerant }, signal) {
    const { decoder, look, header: { num_vertices: numVertices, num_frames: numFrames } } = this;
    if (drawn) await this.complete(() => look.decode(), signal);
    const start = performance.now();
    await this.complete(() => decoder.decode(frame), signal);
    const result = { ms: performance.now() - start, error: decoder.hashError(),
      compared: decoder.comparedFrames(), crc: decoder.crc(), extent: decoder.extent() };
    for (const name of wants) {
      result[name] = drawn ? look.frameValues(name, spare[name])
        : decoder.frameValues(name, numVertices, undefined, spare[name]);
    }
    if (tolerant && frame + 1 === numFrames && !this.endIsChecked && !result.error) {
      try {
        await this.complete(() => decoder.finish(), signal);
        this.endIsChecked = true;
      } catch (error) {
        result.error = error;
      }
    }
    result.error &&= packed(result.error);
    if (frame === this.lastFrame + 1) this.loadAhead();
    this.lastFrame = frame;
    return result;
  }

  async attributes(signal) {
    await this.complete(() => this.look.decode(), signal);
    return { sets: this.look.sets() };
  }

  async drawn(signal) {
    await this.complete(() => this.look.decode(), signal);
    return this.look.drawn();
  }

  async asset(signal) {
    const bytes = await this.complete(() => this.look.asset(), signal);
    if (bytes) checkAsset(bytes, this.options.maxMemory);
    return { bytes };
  }
}

/** Returns the buffers of the arrays in a result. */
function buffersIn(result) {
  if (ArrayBuffer.isView(result)) return [result.buffer];
  if (result === null || typeof result !== "object") return [];
  return Object.values(result).flatMap(buffersIn);
}

export class Engine {
  /** post(message, transfer) sends a message to the other side. */
  constructor(post) {
    this.post = post;
    this.streams = new Map();
    this.entries = new Map(); // requests without a reply, by id
    this.queue = [];
    this.isRunning = false;
  }

  receive(message) {
    if (message.cancel !== undefined) {
      this.entries.get(message.cancel)?.controller.abort(aborted());
      return;
    }
    const entry = { message, controller: new AbortController() };
    this.entries.set(message.id, entry);
    if (message.type === "load") {
      this.answer(entry); // decoding continues meanwhile
    } else {
      this.queue.push(entry);
      if (!this.isRunning) this.run();
    }
  }

  async run() {
    this.isRunning = true;
    while (this.queue.length > 0) {
      await messagesReceived(); // which may cancel a request
      await this.answer(this.queue.shift());
    }
    this.isRunning = false;
  }

  async answer({ message, controller: { signal } }) {
    const { id, type } = message;
    try {
      signal.throwIfAborted();
      const result = await this[type](message, signal);
      this.post({ id, result }, buffersIn(result));
    } catch (error) {
      this.post({ id, error: packed(error) });
    }
    this.entries.delete(id);
  }

  async open({ module, source, shared, options, stream }, signal) {
    const from = shared === undefined
      ? openSource(source, (loaded, size) => this.post({ stream, loaded, size }))
      : this.streams.get(shared).source;
    const opened = new OpenStream(from, options);
    try {
      // A separate instance per stream: one whose memory is exhausted is lost.
      const result = await opened.open(await WasmDecoder.create(module), signal);
      this.streams.set(stream, opened);
      return result;
    } catch (error) {
      this.leave(from);
      throw error;
    }
  }

  frame(message, signal) {
    return this.streams.get(message.stream).frame(message, signal);
  }

  attributes({ stream }, signal) {
    return this.streams.get(stream).attributes(signal);
  }

  drawn({ stream }, signal) {
    return this.streams.get(stream).drawn(signal);
  }

  asset({ stream }, signal) {
    return this.streams.get(stream).asset(signal);
  }

  edges({ stream }) {
    return { edges: this.streams.get(stream).decoder.edges() };
  }

  async load({ stream }, signal) {
    return { bytes: await this.streams.get(stream).whole(signal) };
  }

  close({ stream }) {
    const source = this.streams.get(stream)?.source;
    this.streams.delete(stream);
    if (source) this.leave(source);
  }

  /** Closes a source once no stream uses it. */
  leave(source) {
    if (![...this.streams.values()].some((other) => other.source === source)) source.close?.();
  }
}
