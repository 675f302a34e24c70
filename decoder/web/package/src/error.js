// Errors with which the package rejects promises.

/** Error of a stream, its source, or a limit. */
export class RlpcError extends Error {
  /** kind: one of kKinds. rule: id in the specification, or "". element: the syntax element, or
   * "". bitOffset: its start, from the start of the stream. */
  constructor(message, { kind, rule = "", element = "", bitOffset = 0 }) {
    super(message);
    this.name = "RlpcError";
    this.kind = kind;
    this.rule = rule;
    this.element = element;
    this.bitOffset = bitOffset;
  }
}

// The first five in the order of Errc (common/result.h).
export const kKinds =
  ["truncated", "invalid", "unsupported", "limit", "source", "network", "closed"];

export function aborted(reason = "the request was cancelled") {
  return new DOMException(reason, "AbortError");
}

export function closed() {
  return new RlpcError("the decoder is closed", { kind: "closed" });
}

/** Packs an error as a message, which would lose its class. */
export function packed(error) {
  const { name, message, kind, rule, element, bitOffset } = error;
  return { name, message, kind, rule, element, bitOffset };
}

export function unpacked(told) {
  if (told.name === "AbortError") return aborted(told.message);
  if (told.kind) return new RlpcError(told.message, told);
  return new Error(told.message);
}
