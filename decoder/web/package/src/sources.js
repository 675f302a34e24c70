// Sources of the bytes of a stream. Each has its size after open(), and puts bytes into `ranges`
// with load(start, end, signal), which waits for them.
import { isFile, urlOf } from "./address.js";
import { ByteRanges } from "./byte_ranges.js";
import { RlpcError } from "./error.js";
import { HttpSource } from "./http_source.js";

class BytesSource {
  constructor(bytes) {
    this.ranges = new ByteRanges();
    this.ranges.add(0, bytes);
    this.size = bytes.length;
  }

  async open() {}

  async load() {}
}

const kMaxCachedBytes = 256e6;

class BlobSource {
  constructor(blob) {
    this.blob = blob;
    this.size = blob.size;
    this.ranges = new ByteRanges(kMaxCachedBytes);
  }

  async open() {}

  async load(start, end) {
    const gap = this.ranges.gap(start, end);
    if (!gap) return;
    try {
      const bytes = await this.blob.slice(gap[0], end).arrayBuffer();
      this.ranges.add(gap[0], new Uint8Array(bytes));
    } catch (error) { // a file that has changed or gone
      throw new RlpcError(`the file cannot be read: ${error.message}`, { kind: "source" });
    }
  }
}

/** Source of a file, in node. */
class FileSource {
  constructor(url) {
    this.url = new URL(url);
    this.ranges = new ByteRanges(kMaxCachedBytes);
  }

  async open() {
    await this.use(async (file) => {
      ({ size: this.size } = await file.stat());
    });
  }

  async load(start, end) {
    const gap = this.ranges.gap(start, end);
    if (!gap) return;
    await this.use(async (file) => {
      const bytes = new Uint8Array(end - gap[0]);
      const { bytesRead } = await file.read(bytes, 0, bytes.length, gap[0]);
      if (bytesRead < bytes.length) throw new Error("it has become shorter");
      this.ranges.add(gap[0], bytes);
    });
  }

  async use(action) {
    let file;
    try {
      file = await process.getBuiltinModule("node:fs/promises").open(this.url);
      await action(file);
    } catch (error) {
      throw new RlpcError(`the file cannot be read: ${error.message}`, { kind: "source" });
    } finally {
      await file?.close();
    }
  }
}

/** Opens a source. description: { bytes }, { blob }, { file } or { url, ... }; see HttpSource.
 * progress(loaded, size): callback. */
export function openSource(description, progress) {
  const { bytes, blob, file } = description;
  if (bytes) return new BytesSource(bytes);
  if (blob) return new BlobSource(blob);
  if (file) return new FileSource(file);
  return new HttpSource(description, progress);
}

/** Describes the source that a caller passes to RlpcDecoder.open(), so that it can be sent to a
 * worker. */
export function describeSource(source, { headers, credentials, maxMemory }) {
  if (source instanceof Blob) return { blob: source };
  if (source instanceof ArrayBuffer) return { bytes: new Uint8Array(source) };
  if (ArrayBuffer.isView(source)) {
    return { bytes: new Uint8Array(source.buffer, source.byteOffset, source.byteLength) };
  }
  if (typeof source === "string" || source instanceof URL) {
    const url = urlOf(source);
    if (isFile(url)) return { file: url.href };
    return { url: url.href, headers: [...new Headers(headers)], credentials, maxBytes: maxMemory };
  }
  throw new TypeError("a stream is a URL, an ArrayBuffer, a typed array or a Blob");
}
