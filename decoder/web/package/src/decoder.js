// RlpcDecoder: frames of a stream in any order, as typed arrays. index.d.ts describes it.
import { clipSeconds } from "./clip_time.js";
import { aborted, closed, unpacked } from "./error.js";
import { Link } from "./link.js";
import { describeSource } from "./sources.js";
import { compiledModule } from "./wasm_module.js";

const kProfiles = ["Baseline", "Main", "High"];
const kArrays = ["positions", "integers", "coordinates", "normals"];
const kUsualMemory = 2 ** 30;

function packageWorker() {
  return new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
}

function workerFrom(worker) {
  if (typeof worker === "function") return worker;
  return worker ?? typeof Worker === "function" ? packageWorker : undefined;
}

/** Parses metadata: null if there is none; undefined if it is not JSON, which decoders do not
 * check. */
function parsedMetadata(text) {
  try {
    return text === "" ? null : JSON.parse(text);
  } catch {
    return undefined;
  }
}

/** Returns clips with the frames that the stream has; an open-ended stream may declare more. */
function withinStream(clips, frames, frameRate) {
  return clips.map((clip) => ({ ...clip, frames: Math.min(clip.frames, frames - clip.firstFrame) }))
    .filter((clip) => clip.frames > 0)
    .map((clip) => ({ ...clip, duration: clipSeconds(clip.frames, frameRate) }));
}

function byName(sets) {
  return new Map(sets.map((set) => [set.name, set]));
}

export class RlpcDecoder {
  #link;
  #stream;
  #latest; // last request with `replace`
  #isClosed = false;
  #inherited; // options that other decoders of the stream inherit
  #known = new Map(); // promises of results that are requested once

  static async open(source, options = {}) {
    const shared = source instanceof RlpcDecoder ? source : undefined;
    const { signal, onProgress, maxMemory = kUsualMemory, coarseLayers = 0, verifyHashes = true,
      skipDamagedUnits = true, worker, wasm } = { ...shared?.#inherited, ...options };
    const described = shared ? undefined : describeSource(source, { ...options, maxMemory });
    if (!Number.isInteger(coarseLayers) || coarseLayers < 0) {
      throw new RangeError("coarseLayers is a whole number, from 1 on");
    }
    const module = await compiledModule(wasm);
    if (shared?.#isClosed) throw closed();
    const link = shared ? shared.#link : await Link.create(workerFrom(worker));
    const decoder = new RlpcDecoder();
    decoder.#link = link;
    decoder.#inherited = { maxMemory, verifyHashes, skipDamagedUnits, wasm: module };
    decoder.#stream = link.nextStream++;
    ++link.numUsers;
    if (onProgress) link.listeners.set(decoder.#stream, onProgress);
    try {
      decoder.#describe(await link.request({
        type: "open", module, source: described, shared: shared?.#stream, stream: decoder.#stream,
        options: { maxMemory, coarseLayers, verifyHashes, skipDamagedUnits },
      }, { signal }));
    } catch (error) {
      decoder.close();
      throw error;
    }
    return decoder;
  }

  #describe({ header, size, indices, coarseVertices }) {
    const rate = header.frame_rate_numerator / header.frame_rate_denominator;
    const metadata = parsedMetadata(header.metadata);
    this.info = Object.freeze({
      vertices: header.num_vertices,
      triangles: header.num_triangles,
      frames: header.num_frames,
      frameRate: rate,
      duration: clipSeconds(header.num_frames, rate),
      profile: kProfiles[header.profile_idc],
      level: header.level_idc,
      layers: header.num_layers,
      positionBits: header.position_bits,
      bytes: size,
      hasAttributes: Boolean(header.has_attributes),
      hasAsset: Boolean(header.has_asset),
      damagedUnits: header.num_damaged_units + (metadata === undefined ? 1 : 0),
    });
    this.gridOrigin = header.grid_origin;
    this.gridStep = 2 ** header.grid_log2_step;
    this.indices = indices;
    this.coarseVertices = coarseVertices;
    this.clips = withinStream(header.clips, header.num_frames, rate);
    this.metadata = metadata ?? null;
    const half = 2 ** (header.position_bits - 1);
    this.bounds = this.#box([-half, -half, -half, half - 1, half - 1, half - 1]);
  }

  /** Returns a box of the grid, in units. */
  #box(extent) {
    const units = (positions) => Array.from(positions, (position, axis) =>
      Math.fround((position + this.gridOrigin[axis]) * this.gridStep));
    return { min: units(extent.slice(0, 3)), max: units(extent.slice(3)) };
  }

  async frame(index, { positions = true, integers = false, coordinates = false, normals = false,
    drawn = false, replace = false, tolerant = false, signal, into } = {}) {
    if (!Number.isInteger(index) || index < 0 || index >= this.info.frames) {
      throw new RangeError(`frame ${index} is not one of 0 to ${this.info.frames - 1}`);
    }
    const wanted = { positions, integers, coordinates, normals };
    const wants = kArrays.filter((name) => wanted[name]);
    const spare = Object.fromEntries(kArrays.filter((name) => into?.[name]).map(
      (name) => [name, into[name]]));
    const result = await this.#request(
      { type: "frame", frame: index, wants, spare, drawn, tolerant },
      { signal: replace ? this.#replacing(signal) : signal,
        transfer: Object.values(spare).map((array) => array.buffer) });
    if (result.error && !tolerant) throw unpacked(result.error);
    return this.#frame(index, result);
  }

  /** Returns a signal, and ends the previous request if that waits. */
  #replacing(signal) {
    this.#latest?.abort(aborted("a later request took its place"));
    this.#latest = new AbortController();
    return signal ? AbortSignal.any([signal, this.#latest.signal]) : this.#latest.signal;
  }

  #frame(index, { ms, error, compared, crc, extent, ...arrays }) {
    const frame = { index, time: index / this.info.frameRate, ...arrays,
      bounds: this.#box(extent), crc, comparedFrames: compared, milliseconds: ms };
    if (error) frame.error = unpacked(error);
    if (!arrays.coordinates) return frame;
    // The cube from -1 to 1 holds the grid.
    const scale = 2 ** (1 - this.info.positionBits);
    frame.centre = [0, 1, 2].map((axis) => scale * (extent[axis] + extent[axis + 3]) / 2);
    return frame;
  }

  async *frames({ first = 0, last = this.info.frames - 1, ahead = 4, signal, ...options } = {}) {
    if (options.into || options.replace) {
      throw new TypeError("frames() decodes ahead: `into` and `replace` are for frame()");
    }
    const stop = new AbortController();
    const either = signal ? AbortSignal.any([signal, stop.signal]) : stop.signal;
    const waiting = [];
    try {
      for (let next = first; next <= last || waiting.length > 0; ) {
        while (next <= last && waiting.length <= ahead) {
          const request = this.frame(next++, { ...options, signal: either });
          request.catch(() => {}); // reported in its turn
          waiting.push(request);
        }
        yield await waiting.shift();
      }
    } finally {
      stop.abort(aborted());
    }
  }

  attributes() {
    return this.#once("attributes", ({ sets }) => byName(sets));
  }

  drawn() {
    return this.#once("drawn", (drawn) => ({ ...drawn, attributes: byName(drawn.attributes) }));
  }

  asset() {
    return this.#once("asset", ({ bytes }) => bytes);
  }

  /** Requests a result once, or again after a failure. */
  #once(type, made) {
    if (!this.#known.has(type)) {
      this.#known.set(type, this.#request({ type }).then(made).catch((error) => {
        this.#known.delete(type);
        throw error;
      }));
    }
    return this.#known.get(type);
  }

  async edges() {
    return (await this.#request({ type: "edges" })).edges;
  }

  async download({ signal } = {}) {
    const { bytes } = await this.#request({ type: "load" }, { signal });
    return new Blob([bytes]);
  }

  #request(message, options) {
    if (this.#isClosed) {
      return Promise.reject(closed());
    }
    return this.#link.request({ ...message, stream: this.#stream }, options);
  }

  close() {
    if (this.#isClosed) return;
    this.#request({ type: "close" }).catch(() => {});
    this.#isClosed = true;
    this.#link.listeners.delete(this.#stream);
    this.#link.release();
  }
}
