// node unpack.mjs THREE IN.glb OUT.glb
//
// Decodes EXT_meshopt_compression, so that readers without it see the same values.

import fs from "node:fs";
import { pathToFileURL } from "node:url";

const NAME = "EXT_meshopt_compression";
const [three, input, output] = process.argv.slice(2);
const decoder = `${three}/examples/jsm/libs/meshopt_decoder.module.js`;
const { MeshoptDecoder } = await import(pathToFileURL(decoder));
await MeshoptDecoder.ready;

const file = fs.readFileSync(input);
const jsonLength = file.readUInt32LE(12);
const gltf = JSON.parse(file.subarray(20, 20 + jsonLength));
const binary = file.subarray(28 + jsonLength);

const pieces = [];
let length = 0;
for (const view of gltf.bufferViews) {
  const packed = view.extensions?.[NAME];
  let bytes;
  if (packed) {
    bytes = new Uint8Array(packed.count * packed.byteStride);
    const source = binary.subarray(packed.byteOffset ?? 0,
      (packed.byteOffset ?? 0) + packed.byteLength);
    MeshoptDecoder.decodeGltfBuffer(bytes, packed.count, packed.byteStride, source, packed.mode,
      packed.filter);
    delete view.extensions;
  } else {
    bytes = binary.subarray(view.byteOffset ?? 0, (view.byteOffset ?? 0) + view.byteLength);
  }
  Object.assign(view, { buffer: 0, byteOffset: length, byteLength: bytes.length });
  const padding = Buffer.alloc(-bytes.length & 3);
  pieces.push(bytes, padding);
  length += bytes.length + padding.length;
}
gltf.buffers = [{ byteLength: length }];
for (const list of ["extensionsUsed", "extensionsRequired"]) {
  gltf[list] = (gltf[list] ?? []).filter((name) => name !== NAME);
  if (gltf[list].length === 0) delete gltf[list];
}

let json = Buffer.from(JSON.stringify(gltf));
json = Buffer.concat([json, Buffer.alloc(-json.length & 3, " ")]);
const chunk = (size, type) => {
  const head = Buffer.alloc(8);
  head.writeUInt32LE(size, 0);
  head.write(type, 4, "latin1");
  return head;
};
const head = Buffer.alloc(12);
head.write("glTF", 0, "latin1");
head.writeUInt32LE(2, 4);
head.writeUInt32LE(28 + json.length + length, 8);
fs.writeFileSync(output, Buffer.concat([
  head, chunk(json.length, "JSON"), json, chunk(length, "BIN\0"), ...pieces]));
