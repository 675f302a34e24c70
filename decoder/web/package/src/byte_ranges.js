// Parts of a stream that have been loaded.

export class ByteRanges {
  /** maxBytes: beyond it, the least recently used parts are dropped, except those used since
   * protect(). */
  constructor(maxBytes = Infinity) {
    this.maxBytes = maxBytes;
    this.numBytes = 0;
    this.parts = []; // { start, end, bytes, used }, ascending, disjoint
    this.time = 0;
    this.protectedFrom = 0;
  }

  /** Keeps all parts that are used from now on. */
  protect() {
    this.protectedFrom = this.time + 1;
  }

  /** Returns the index of the first part that ends after `offset`. */
  indexAt(offset) {
    let low = 0;
    let high = this.parts.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.parts[middle].end > offset) high = middle;
      else low = middle + 1;
    }
    return low;
  }

  /** Returns the first gap [start, end) in a range; undefined if it has none. */
  gap(start, end) {
    for (let i = this.indexAt(start); start < end; ++i) {
      const part = this.parts[i];
      if (!part || part.start > start) return [start, Math.min(end, part?.start ?? end)];
      start = part.end;
    }
    return undefined;
  }

  /** Adds bytes; drops those that are already loaded. */
  add(start, bytes) {
    const end = start + bytes.length;
    for (let gap = this.gap(start, end); gap; gap = this.gap(start, end)) {
      const [from, to] = gap;
      const part = { start: from, end: to, bytes: bytes.subarray(from - start, to - start),
        used: ++this.time };
      this.parts.splice(this.indexAt(from), 0, part);
      this.numBytes += to - from;
    }
    while (this.numBytes > this.maxBytes && this.dropOldest());
  }

  dropOldest() {
    const oldest = this.parts.reduce((a, b) => (a.used <= b.used ? a : b));
    if (oldest.used >= this.protectedFrom) return false;
    this.parts.splice(this.parts.indexOf(oldest), 1);
    this.numBytes -= oldest.end - oldest.start;
    return true;
  }

  /** Fills `out` from an offset; returns false if bytes are missing. */
  copy(offset, out) {
    const end = offset + out.length;
    if (this.gap(offset, end)) return false;
    for (let i = this.indexAt(offset), at = offset; at < end; ++i) {
      const part = this.parts[i];
      const to = Math.min(end, part.end);
      out.set(part.bytes.subarray(at - part.start, to - part.start), at - offset);
      part.used = ++this.time;
      at = to;
    }
    return true;
  }
}
