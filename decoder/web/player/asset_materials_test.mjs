// Run by player_test.py: materials of assets, some of which are damaged.
import assert from "node:assert/strict";
import { test } from "node:test";

import { readMaterials } from "./asset_materials.js";

const kPicture = Uint8Array.of(1, 2, 3, 4);

globalThis.createImageBitmap = async (source) => {
  if (source.width) return { ...source, isScaled: true };
  if (source.size === 0) throw new Error("no picture");
  return { width: source.type === "image/large" ? 16384 : 4, height: 4,
    bytes: new Uint8Array(await source.arrayBuffer()), close() { this.isClosed = true; } };
};

function glb(json, binary = kPicture) {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const bytes = new Uint8Array(28 + text.length + binary.length);
  const view = new DataView(bytes.buffer);
  [0x46546c67, 2, bytes.length, text.length, 0x4e4f534a].forEach((number, i) =>
    view.setUint32(4 * i, number, true));
  bytes.set(text, 20);
  view.setUint32(20 + text.length, binary.length, true);
  view.setUint32(24 + text.length, 0x004e4942, true);
  bytes.set(binary, 28 + text.length);
  return bytes;
}

const kTextured = {
  materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0, texCoord: 1 } } },
    { pbrMetallicRoughness: { baseColorFactor: [0.5, 0, 1, 0.25] }, alphaMode: "MASK" },
    { alphaMode: "BLEND" }],
  textures: [{ source: 0, sampler: 0 }], samplers: [{ wrapS: 33071 }],
  images: [{ bufferView: 0, mimeType: "image/png" }],
  bufferViews: [{ buffer: 0, byteOffset: 1, byteLength: 2 }],
};

test("TexturesFactorsAndOpacity", async () => {
  const { materials, problems } = await readMaterials(glb(kTextured));
  assert.deepEqual(problems, []);
  const [textured, cut, clear] = materials;
  const { picture, uv, sampler } = textured.textures.base;
  assert.deepEqual([...picture.bytes], [2, 3]);
  assert.deepEqual([uv, sampler.wrapS], ["uv1", 33071]);
  assert.deepEqual(textured.base, [1, 1, 1, 1]);
  assert.deepEqual([cut.base, cut.cutoff], [[0.5, 0, 1, 0.25], 0.5]);
  assert.equal(cut.textures.base.picture, undefined);
  assert.deepEqual([clear.blends, clear.cutoff], [true, 0]);
});

test("EmissionAndNormalMaps", async () => {
  const texture = { index: 0, texCoord: 2 };
  const { materials, problems } = await readMaterials(glb({ ...kTextured, materials: [
    { emissiveFactor: [0.5, 1, 0], emissiveTexture: texture,
      extensions: { KHR_materials_emissive_strength: { emissiveStrength: 4 } } },
    { normalTexture: { ...texture, scale: 0.5 } },
    { emissiveFactor: ["1", 2], normalTexture: { index: 9, scale: "2" } }] }));
  const [glows, bumpy, wrong] = materials;
  assert.deepEqual([glows.emission, glows.normalScale], [[2, 4, 0], 1]);
  assert.equal(glows.textures.emission.uv, "uv2");
  assert.deepEqual([...glows.textures.emission.picture.bytes], [2, 3]);
  assert.deepEqual([bumpy.emission, bumpy.normalScale], [[0, 0, 0], 0.5]);
  assert.equal(bumpy.textures.normal.picture, glows.textures.emission.picture);
  assert.equal(bumpy.textures.emission.picture, undefined);
  assert.deepEqual([wrong.emission, wrong.normalScale], [[0, 0, 0], 1]);
  assert.equal(wrong.textures.normal.picture, undefined);
  assert.equal(problems.length, 1);
});

test("TextureCoordinatesAreTransformed", async () => {
  const transform = { offset: [0.25, 0], scale: [2, 4], rotation: Math.PI / 2, texCoord: 3 };
  const texture = { index: 0, extensions: { KHR_texture_transform: transform } };
  const { materials } = await readMaterials(glb({ ...kTextured,
    materials: [{ pbrMetallicRoughness: { baseColorTexture: texture } }] }));
  const { rows, uv } = materials[0].textures.base;
  assert.equal(uv, "uv3");
  const expected = [[0, 4, 0.25], [-2, 0, 0]];
  rows.flat().forEach((value, i) => assert.ok(Math.abs(value - expected.flat()[i]) < 1e-12));
});

test("LargeTexturesAreScaledDown", async () => {
  const { materials } = await readMaterials(glb({ ...kTextured,
    images: [{ bufferView: 0, mimeType: "image/large" }] }));
  assert.ok(materials[0].textures.base.picture.isScaled);
});

test("PicturesThatAreNotThereAreLeftOut", async () => {
  for (const image of [{ bufferView: 7 }, {}, null, { uri: "http://example.com/a.png" },
    { uri: "data:image/png;base64,?" }]) {
    const { materials, problems } = await readMaterials(glb({ ...kTextured, images: [image] }));
    assert.equal(materials.length, 3);
    assert.equal(materials[0].textures.base.picture, undefined);
    assert.equal(problems.length, 1);
  }
});

test("WhatIsNoGlbIsAnError", async () => {
  const whole = glb(kTextured);
  for (const bytes of [new Uint8Array(), new Uint8Array(40), whole.slice(0, 60),
    glb([1, 2]).slice(0, 22)]) {
    await assert.rejects(readMaterials(bytes), Error);
  }
  await assert.rejects(readMaterials(glb({ materials: 5 })), Error);
});

test("WhatDoesNotFitIsLeftOut", async () => {
  for (const material of [null, 7, { normalTexture: null, pbrMetallicRoughness: null },
    { emissiveTexture: 5, extensions: null }]) {
    const { materials, problems } = await readMaterials(glb({ ...kTextured,
      materials: [material, kTextured.materials[0]] }));
    assert.deepEqual([materials[0].base, materials[0].emission], [[1, 1, 1, 1], [0, 0, 0]]);
    assert.equal(materials[0].textures.normal.picture, undefined);
    assert.ok(materials[1].textures.base.picture);
    assert.deepEqual(problems, []);
  }
});
