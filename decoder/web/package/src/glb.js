// The container of binary glTF (a GLB), which the asset of a stream is: a header, a chunk of JSON,
// and a chunk of the bytes that the JSON refers to.

const kMagic = 0x46546c67; // "glTF"
const kJsonChunk = 0x4e4f534a;
const kHeaderBytes = 12;
const kChunkBytes = 8; // before the contents of each chunk

/** The contents of the chunks: { json, binary }, both Uint8Array, the second perhaps empty. Throws
 * an Error if the bytes are no GLB, or end within a chunk. */
export function glbChunks(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < kHeaderBytes + kChunkBytes || view.getUint32(0, true) !== kMagic ||
      view.getUint32(kHeaderBytes + 4, true) !== kJsonChunk) {
    throw new Error("it is no GLB");
  }
  const chunks = [];
  for (let at = kHeaderBytes; at + kChunkBytes <= bytes.length; ) {
    const size = view.getUint32(at, true);
    const chunk = bytes.subarray(at + kChunkBytes, at + kChunkBytes + size);
    if (chunk.length < size) throw new Error("its GLB is cut off");
    chunks.push(chunk);
    at += kChunkBytes + size;
  }
  return { json: chunks[0], binary: chunks[1] ?? new Uint8Array() };
}

/** The JSON of a GLB as an object. Throws as glbChunks(), and where it is not JSON. */
export function glbJson(bytes) {
  return JSON.parse(new TextDecoder().decode(glbChunks(bytes).json));
}
