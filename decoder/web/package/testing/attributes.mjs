// Run by package_test.py: attributes of streams, and drawn vertices, in node.
//
//   node attributes.mjs PACKAGE_FOLDER STREAM...   a line of JSON for each stream
import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [folder, ...paths] = process.argv.slice(2);
const { RlpcDecoder, RlpcError } =
  await import(new URL("src/index.js", `${pathToFileURL(folder)}/`));

function sha256(array) {
  return createHash("sha256").update(array).digest("hex");
}

function valueAt({ domain, corners }, decoder, corner) {
  if (domain === "corner") return corners[corner];
  return domain === "vertex" ? decoder.indices[corner] : Math.floor(corner / 3);
}

/** Checks that each corner has its position and its values. */
async function checkDrawn(decoder, sets) {
  const { vertices, indices, attributes } = await decoder.drawn();
  assert.equal(indices.length, decoder.indices.length);
  const drawable = [...sets.values()].filter(({ domain, components }) =>
    domain !== "triangle" && components > 0 && (domain === "vertex" || indices.length > 0));
  assert.deepEqual([...attributes.keys()], drawable.map(({ name }) => name));
  for (let corner = 0; corner < indices.length; ++corner) {
    const vertex = indices[corner];
    assert.equal(vertices[vertex], decoder.indices[corner]);
    for (const set of drawable) {
      const { components, values } = attributes.get(set.name);
      const at = valueAt(set, decoder, corner);
      for (let c = 0; c < components; ++c) {
        const given = values[components * vertex + c];
        assert.ok(Object.is(given, set.values[components * at + c]), set.name);
      }
    }
  }
  const last = decoder.info.frames - 1;
  const whole = await decoder.frame(last, { integers: true, normals: true });
  const drawn = await decoder.frame(last, { drawn: true, integers: true, normals: true });
  assert.equal(drawn.crc, whole.crc);
  for (const name of ["positions", "integers"]) {
    assert.deepEqual([...drawn[name]],
      [...vertices].flatMap((v) => [...whole[name].subarray(3 * v, 3 * v + 3)]));
  }
  assert.equal(drawn.normals.length, drawn.positions.length);
  if (!["unitVectors", "smoothing"].includes(sets.get("normal")?.kind)) {
    assert.deepEqual([...drawn.normals],
      [...vertices].flatMap((v) => [...whole.normals.subarray(3 * v, 3 * v + 3)]));
  }
  return { drawn: vertices.length, normals: [...drawn.normals] };
}

async function told(path) {
  const decoder = await RlpcDecoder.open(readFileSync(path));
  const result = { path, sets: [] };
  const { hasAttributes, hasAsset } = decoder.info;
  Object.assign(result, { hasAttributes, hasAsset, clips: decoder.clips,
    numFrames: decoder.info.frames });
  await assert.rejects(decoder.frames({ into: {} }).next(), TypeError);
  try {
    const sets = await decoder.attributes();
    assert.equal(await decoder.attributes(), sets);
    for (const { values, integers, corners, ...set } of sets.values()) {
      assert.equal(values.length, set.components * set.count);
      result.sets.push({ ...set, values: [...new Uint32Array(values.buffer)],
        integers: sha256(integers), corners: corners && sha256(corners) });
    }
    Object.assign(result, await checkDrawn(decoder, sets));
    const asset = await decoder.asset();
    result.asset = asset && Buffer.from(asset).toString("base64");
  } catch (error) {
    if (!(error instanceof RlpcError)) throw error;
    result.error = { rule: error.rule, kind: error.kind };
    result.frames = sha256((await decoder.frame(0)).positions).length; // they can be decoded
  }
  decoder.close();
  return result;
}

for (const path of paths) console.log(JSON.stringify(await told(path)));
