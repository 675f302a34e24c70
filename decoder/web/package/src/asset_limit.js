// Measures the JSON of an asset (a GLB) before it is parsed: a stream of a few kilobytes can hold
// megabytes of JSON, which take hundreds of megabytes as objects.
import { RlpcError } from "./error.js";
import { glbChunks } from "./glb.js";

const kMaxDepth = 100; // as in common/json/json_text.h
const kBytesOfValue = 160; // an object or array with its place in another
const kBytesOfByte = 4; // text as strings

const kQuote = 0x22;
const kBackslash = 0x5c;
const kComma = 0x2c;
const kOpening = new Set([0x5b, 0x7b]); // [ {
const kClosing = new Set([0x5d, 0x7d]);

/** Returns an upper bound of the memory of a text as objects, and their nesting depth. The text
 * need not be valid. Cost: linear in the text. */
export function measureJson(text) {
  let [values, depth, deepest, isString] = [1, 0, 0, false];
  for (let i = 0; i < text.length; ++i) {
    const byte = text[i];
    if (isString) {
      if (byte === kBackslash) ++i;
      else if (byte === kQuote) isString = false;
    } else if (byte === kQuote) {
      isString = true;
    } else if (kOpening.has(byte)) {
      ++values;
      deepest = Math.max(deepest, ++depth);
    } else if (kClosing.has(byte)) {
      --depth;
    } else if (byte === kComma) {
      ++values;
    }
  }
  return { bytes: kBytesOfValue * values + kBytesOfByte * text.length, deepest };
}

function jsonIn(glb) {
  try {
    return glbChunks(glb).json;
  } catch { // nothing will parse it
    return new Uint8Array();
  }
}

/** Throws an RlpcError if parsing the JSON of an asset would take more than maxBytes, or if that is
 * nested too deeply for functions that walk through it. */
export function checkAsset(glb, maxBytes) {
  const { bytes, deepest } = measureJson(jsonIn(glb));
  if (deepest > kMaxDepth) {
    throw new RlpcError(`the JSON of the asset is nested more than ${kMaxDepth} levels deep`,
      { kind: "invalid", element: "asset_size" });
  }
  if (bytes + glb.length > maxBytes) {
    throw new RlpcError(`the asset takes about ${bytes + glb.length} bytes, more than maxMemory, ` +
      `${maxBytes} bytes`, { kind: "limit", element: "asset_size" });
  }
}
