// Decodes streams in node, for tests and measurements.
//
//   node decode_streams.mjs PACKAGE_FOLDER STREAM...   a line of JSON for each stream
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { performance } from "node:perf_hooks";
import { pathToFileURL } from "node:url";

const [folder, ...paths] = process.argv.slice(2);
const { RlpcDecoder, RlpcError } =
  await import(new URL("src/index.js", `${pathToFileURL(folder)}/`));

async function decode(path) {
  const hash = createHash("sha256");
  const floats = createHash("sha256");
  const result = { path, frames: 0, compared: 0, ms: 0 };
  let decoder;
  try {
    const start = performance.now();
    decoder = await RlpcDecoder.open(readFileSync(path), { skipDamagedUnits: false });
    result.vertices = decoder.info.vertices;
    result.triangles = createHash("sha256").update(decoder.indices).digest("hex");
    for (; result.frames < decoder.info.frames; ++result.frames) {
      const frame = await decoder.frame(result.frames, { integers: true, tolerant: true });
      if (frame.error?.rule === "R-HSH-02") throw frame.error;
      result.compared += frame.comparedFrames;
      result.ms = performance.now() - start;
      hash.update(frame.integers);
      floats.update(frame.positions);
      if (!frame.error) continue;
      ++result.frames;
      throw frame.error; // behind the last frame
    }
  } catch (error) {
    if (!(error instanceof RlpcError)) throw error;
    const { rule, kind, element, bitOffset, message } = error;
    result.error = { rule, kind, element, bitOffset, message };
  }
  decoder?.close();
  result.positions = hash.digest("hex");
  result.floats = floats.digest("hex");
  return result;
}

for (const path of paths) {
  console.log(JSON.stringify(await decode(path)));
}
