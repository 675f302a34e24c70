// Source of a stream on a server: in ranges (RFC 9110, 14), or whole if the server has none.
import { ByteRanges } from "./byte_ranges.js";
import { aborted, RlpcError } from "./error.js";

const kFirstBytes = 16384;
const kMaxCachedBytes = 256e6;

export class HttpSource {
  /** headers: [name, value] for each request; credentials: see fetch(); maxBytes: limit of a stream
   * that must be loaded whole; progress(loaded, size): callback. */
  constructor({ url, headers, credentials, maxBytes }, progress) {
    Object.assign(this, { url, headers, credentials, maxBytes, progress });
    this.ranges = new ByteRanges(kMaxCachedBytes);
    this.underWay = []; // { start, end, done }
    this.loaded = 0; // bytes from the server
    this.size = undefined;
    this.whole = undefined; // promise of a stream that is loaded from its start to its end
    this.waiting = []; // callers that wait for more of it
    this.stop = new AbortController(); // aborts all requests
  }

  /** Ends all loading, also without a user. */
  close() {
    this.stop.abort(aborted("the decoder is closed"));
    this.reader?.cancel().catch(() => {}); // reader of the whole stream
  }

  async open(signal) {
    const response = await this.request([0, kFirstBytes], signal);
    this.version = versionOf(response);
    if (response.status === 206) {
      const total = /\/(\d+)$/.exec(response.headers.get("content-range") ?? "")?.[1];
      const size = total === undefined ? await this.askForSize(signal) : Number(total);
      this.size = Number.isSafeInteger(size) ? size : undefined;
      if (this.size !== undefined) {
        return this.receive(response, 0, Math.min(kFirstBytes, this.size));
      }
      await response.body?.cancel();
      return this.openWhole(await this.request(undefined, signal));
    }
    if (response.status === 416) { // the file is empty
      this.size = 0;
      return undefined;
    }
    return this.openWhole(response);
  }

  /** Returns the size; undefined if unknown. Servers of other origins may hide Content-Range; some
   * lack HEAD. */
  async askForSize(signal) {
    const response = await this.request(undefined, signal, "HEAD").catch((error) => {
      if (error.name === "AbortError") throw error;
    });
    if (!response) return undefined;
    const length = response.headers.get("content-length");
    return length === null || response.headers.has("content-encoding") ? undefined : Number(length);
  }

  async request(range, signal, method = "GET") {
    const headers = new Headers(this.headers);
    if (range) headers.set("Range", `bytes=${range[0]}-${range[1] - 1}`);
    let response;
    const either = signal ? AbortSignal.any([signal, this.stop.signal]) : this.stop.signal;
    try {
      response = await fetch(this.url,
        { method, headers, credentials: this.credentials, signal: either });
    } catch (failure) {
      if (failure.name === "AbortError") throw failure;
      throw this.error(`cannot be reached (${failure.message})`);
    }
    if (!response.ok && response.status !== 416) {
      throw this.error(`the server answers ${response.status} ${response.statusText}`.trim());
    }
    return response;
  }

  /** Returns the body of a range, and reads no more than that. */
  async receive(response, start, end) {
    // Servers of other origins may hide it.
    const first = /^bytes (\d+)-/.exec(response.headers.get("content-range") ?? "")?.[1];
    if (response.status === 206 && first !== undefined && Number(first) !== start) {
      await response.body?.cancel();
      throw this.error(`the server sent bytes from ${first} on instead of ${start}`);
    }
    const bytes = await this.bodyOf(response, end - start);
    if (bytes.length !== end - start) {
      throw this.error(`the server sent ${bytes.length} bytes instead of ${end - start}`);
    }
    this.keep(start, bytes);
  }

  keep(start, bytes) {
    this.ranges.add(start, bytes);
    this.loaded += bytes.length;
    this.progress(this.loaded, this.size);
  }

  /** Returns the body. size: cancels a longer body, and throws. */
  async bodyOf(response, size) {
    const pieces = [];
    let length = 0;
    const reader = response.body?.getReader();
    while (reader) {
      const { done, value } = await reader.read().catch((failure) => {
        if (failure.name === "AbortError") throw failure;
        throw this.error(`the connection was lost (${failure.message})`);
      });
      if (done) break;
      pieces.push(value);
      length += value.length;
      if (length <= size) continue;
      await reader.cancel();
      throw this.error(`the server sent more than the ${size} bytes of the range`);
    }
    const bytes = new Uint8Array(length);
    let at = 0;
    for (const piece of pieces) {
      bytes.set(piece, at);
      at += piece.length;
    }
    return bytes;
  }

  /** Loads the whole stream from a response; returns once the size is known. */
  async openWhole(response) {
    this.ranges.maxBytes = Infinity;
    // The length counts these bytes only if they were not compressed for transfer, which servers of
    // other origins do not reveal.
    const length = response.headers.get("content-length");
    const isSure = response.type !== "cors" && !response.headers.has("content-encoding");
    if (length !== null && isSure) this.size = Number(length);
    if (this.size > this.maxBytes) await response.body.cancel();
    this.checkSize(this.size ?? 0);
    this.whole = this.readWhole(response);
    this.whole.catch(() => {}); // load() reports it
    if (this.size === undefined) await this.whole;
  }

  async readWhole(response) {
    const reader = response.body.getReader();
    this.reader = reader;
    for (let start = 0; ; ) {
      const { done, value } = await reader.read().catch((failure) => {
        throw this.error(`the connection was lost (${failure.message})`);
      });
      this.stop.signal.throwIfAborted();
      if (done) {
        if (this.size !== undefined && this.size !== start) {
          throw this.error(`the server sent ${start} bytes instead of ${this.size}`);
        }
        this.size = start;
        return;
      }
      if (start + value.length > this.maxBytes) await reader.cancel();
      this.checkSize(start + value.length);
      this.keep(start, value);
      start += value.length;
      this.waiting.splice(0).forEach((resolve) => resolve());
    }
  }

  checkSize(size) {
    if (size <= this.maxBytes) return;
    throw new RlpcError(`${this.url}: the server has no ranges, and the whole stream has more ` +
      `than maxMemory, ${this.maxBytes} bytes`, { kind: "limit" });
  }

  async load(start, end, signal) {
    for (let gap; (gap = this.ranges.gap(start, end)); ) {
      signal?.throwIfAborted();
      const before = this.underWay.find((r) => r.start <= gap[0] && gap[0] < r.end);
      if (this.whole) await this.more(signal);
      else if (before) await until(before.done, signal);
      else await this.loadRange(gap[0], Math.min(gap[1], ...this.startsAfter(gap[0])), signal);
    }
  }

  /** Returns the starts of pending requests after an offset. */
  startsAfter(offset) {
    return this.underWay.map((request) => request.start).filter((start) => start > offset);
  }

  /** Waits for more bytes of the whole stream. */
  more(signal) {
    const arrival = new Promise((resolve) => this.waiting.push(resolve));
    return until(Promise.race([this.whole, arrival]), signal);
  }

  async loadRange(start, end, signal) {
    const done = this.requestRange(start, end, signal);
    const entry = { start, end, done: done.catch(() => {}) }; // others try again
    this.underWay.push(entry);
    try {
      await done;
    } finally {
      this.underWay.splice(this.underWay.indexOf(entry), 1);
    }
  }

  async requestRange(start, end, signal) {
    const response = await this.request([start, end], signal);
    if (versionOf(response) !== this.version) throw this.error("it has changed on the server");
    if (response.status === 206) return this.receive(response, start, end);
    if (response.status === 416) throw this.error("it has become shorter on the server");
    if (this.size > this.maxBytes) await response.body?.cancel();
    this.checkSize(this.size);
    return this.receive(response, 0, this.size); // all of it, this time
  }

  error(text) {
    return new RlpcError(`${this.url}: ${text}`, { kind: "network" });
  }
}

/** Returns the version of the file on the server. */
function versionOf({ headers }) {
  return headers.get("etag") ?? headers.get("last-modified");
}

/** Returns the promise, or rejects as soon as the signal aborts. */
function until(promise, signal) {
  if (!signal) return promise;
  return new Promise((resolve, reject) => {
    const stop = () => reject(signal.reason);
    signal.throwIfAborted();
    signal.addEventListener("abort", stop, { once: true });
    promise.then(resolve, reject).finally(() => signal.removeEventListener("abort", stop));
  });
}
