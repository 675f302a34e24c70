// Decodes streams with the WebAssembly decoder in node, for tests and measurements.
//
//   node decode_streams.mjs PLAYER.wasm STREAM...   a line of JSON for each stream
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { performance } from "node:perf_hooks";

import { DecoderModule, StreamError } from "./stream_decoder.js";

const [wasm, ...paths] = process.argv.slice(2);

async function decode(path) {
  const module = await DecoderModule.create(readFileSync(wasm));
  const hash = createHash("sha256");
  const result = { path, frames: 0, compared: 0, ms: 0 };
  try {
    const start = performance.now();
    const decoder = module.open(readFileSync(path));
    const { num_frames: numFrames } = decoder.header;
    result.vertices = decoder.header.num_vertices;
    result.triangles = createHash("sha256").update(decoder.triangles()).digest("hex");
    while (result.frames < numFrames) {
      decoder.decode(result.frames);
      if (decoder.hashDiffers()) throw decoder.error();
      result.compared += decoder.comparedFrames();
      result.ms = performance.now() - start;
      hash.update(decoder.positions());
      ++result.frames;
    }
    decoder.finish();
  } catch (error) {
    if (!(error instanceof StreamError)) throw error;
    result.error = { rule: error.rule, code: error.code, text: error.message };
  }
  result.positions = hash.digest("hex");
  return result;
}

for (const path of paths) {
  console.log(JSON.stringify(await decode(path)));
}
