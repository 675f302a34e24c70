// Look of a mesh in three.js: attributes of its vertices, and materials from the asset.
import { BufferAttribute, Mesh, MeshStandardMaterial } from "three";

import { coarseSurface } from "./coarse_surface.js";
import { RlpcDecoder } from "./decoder.js";
import { glbJson } from "./glb.js";
import { byMaterial, hasNormals, materialSet, nameInThree, uvName } from "./sets.js";

const kUsualColour = 0xb4bcc4;

const warnings = new Set();

/** Warns once for all meshes. */
function warn(text) {
  if (!warnings.has(text)) console.warn(`RLPCLoader: ${text}`);
  warnings.add(text);
}

/** Makes the default material: grey, or white under colours of vertices. */
export function usualMaterial({ vertexColors = false, flatShading = false } = {}) {
  const color = vertexColors ? 0xffffff : kUsualColour;
  return new MeshStandardMaterial({ color, roughness: 0.6, vertexColors, flatShading });
}

/** Loads the drawn mesh and, if wanted, the materials of a decoder; undefined if there are none, or
 * they have an error. isFlat: true for meshes without normals, as in glTF. A coarse mesh also has
 * places, the vertex of its frames for each drawn vertex, and whole, the look of the whole mesh. */
export async function loadLook(decoder,
  { attributes = true, textures = true, material, gltfLoader }) {
  const { hasAttributes, hasAsset, damagedUnits } = decoder.info;
  if (damagedUnits > 0) warn("attributes, materials, clips or metadata are damaged, and left out");
  if (!attributes || !hasAttributes && !hasAsset) return undefined;
  let whole;
  try {
    whole = decoder.coarseVertices ? await RlpcDecoder.open(decoder) : decoder;
    const [drawn, sets, asset] = await Promise.all([whole.drawn(), whole.attributes(),
      hasAsset ? loadAsset(decoder) : undefined]);
    const gltf = asset && !material ? await loadMaterials(asset, textures, gltfLoader) : undefined;
    const look = { drawn, materialOf: materialSet(sets), gltf, equalUvs: equalUvsOf(asset),
      isFlat: gltf && !hasNormals(sets) };
    return decoder.coarseVertices ? coarseLook(look, decoder) : look;
  } catch (error) {
    if (error.name === "AbortError" || ["network", "closed"].includes(error.kind)) throw error;
    warn(`attributes are left out: ${error.message}`);
    return undefined;
  } finally {
    if (whole !== decoder) whole?.close();
  }
}

function coarseLook(whole, { indices, coarseVertices }) {
  const drawn = coarseSurface(whole, { indices, vertices: coarseVertices });
  const { materialOf, vertices: places } = drawn;
  return { ...whole, drawn, materialOf, places, whole };
}

/** Loads the asset, a GLB; null if there is none, undefined if it cannot be decoded. */
async function loadAsset(decoder) {
  try {
    return await decoder.asset();
  } catch (error) {
    if (error.kind !== "limit" && error.kind !== "invalid") throw error;
    warn(`materials are left out: ${error.message}`);
    return undefined;
  }
}

/** Reads the asset with GLTFLoader of three.js; undefined if it cannot. */
async function loadMaterials(asset, textures, gltfLoader) {
  let loader = gltfLoader;
  if (!loader) {
    try {
      const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
      loader = new GLTFLoader();
    } catch (error) {
      warn("materials are left out, because three's GLTFLoader cannot be imported. Add " +
        '"three/addons/" to the import map, or pass a loader as the option gltfLoader, or a ' +
        `material (${error.message})`);
      return undefined;
    }
  }
  const canDecode = typeof createImageBitmap === "function" || typeof Image === "function";
  if (textures && !canDecode) warn("textures are left out, because there are no images here");
  try {
    return await loader.parseAsync(
      textures && canDecode ? asset.slice().buffer : withoutTextures(asset), "");
  } catch (error) {
    warn(`materials are left out: ${error.message}`);
    return undefined;
  }
}

/** For each set of texture coordinates of the encoder's input, the number of the first that is
 * equal, which alone is in the stream; empty if all differ. */
function equalUvsOf(asset) {
  try {
    const equal = asset && glbJson(asset).extras?.equal_uv;
    return Array.isArray(equal) ? equal : [];
  } catch { // not a GLB
    return [];
  }
}

/** Returns the materials without textures, as the text of a glTF file. */
function withoutTextures(glb) {
  const { asset, materials, extensionsUsed } = glbJson(glb);
  return JSON.stringify({ asset, materials, extensionsUsed },
    (key, value) => (key.endsWith("Texture") ? undefined : value));
}

/** Sets the attributes of a geometry. equalUvs: of the look; equal sets are one attribute with
 * several names. */
export function setAttributes(geometry, { attributes }, equalUvs) {
  for (const set of attributes.values()) {
    const name = nameInThree(set);
    if (name) geometry.setAttribute(name, new BufferAttribute(set.values, set.components));
  }
  for (const [number, first] of equalUvs.entries()) {
    const [name, from] = [number, first].map((n) =>
      nameInThree({ name: uvName(n), components: 2 }));
    if (!name || geometry.attributes[name] || !geometry.attributes[from]) continue;
    geometry.setAttribute(name, geometry.attributes[from]);
  }
}

/** Sets the index and its groups, and returns the material or materials. material: of the caller.
 * Records the numbers of materials in the look. */
export async function dress(geometry, look, material) {
  const { drawn, materialOf, gltf } = look;
  const usual = { vertexColors: "color" in geometry.attributes,
    flatShading: !("normal" in geometry.attributes) };
  const isList = Array.isArray(material);
  const numbers = gltf?.parser.json.materials?.length ?? (isList ? material.length - 1 : 0);
  const { indices, groups } = byMaterial(drawn.indices, materialOf, numbers);
  look.numMaterials = numbers;
  look.materialNumbers = groups.map((group) => group.material);
  geometry.setIndex(new BufferAttribute(indices, 1));
  if (material && !isList) return material;
  const materials = isList ? material : await Promise.all(groups.map(async (group) =>
    (group.material < numbers ? await finalMaterial(geometry, gltf.parser, group.material)
      : undefined) ?? usualMaterial(usual)));
  if (!isList && materials.length <= 1) return materials[0] ?? usualMaterial(usual);
  groups.forEach(({ start, count, material: number }, i) =>
    geometry.addGroup(start, count, isList ? number : i));
  return materials;
}

/** Returns the material that GLTFLoader would assign to a mesh with this geometry; undefined if it
 * cannot. */
async function finalMaterial(geometry, parser, number) {
  try {
    const mesh = new Mesh(geometry, await parser.getDependency("material", number));
    parser.assignFinalMaterial(mesh);
    return mesh.material;
  } catch (error) {
    warn(`material ${number} is left out: ${error.message}`);
    return undefined;
  }
}

export function dispose(material, withTextures) {
  if (withTextures) {
    for (const texture of Object.values(material).filter((value) => value?.isTexture)) {
      texture.dispose();
      texture.image?.close?.(); // an ImageBitmap
    }
  }
  material.dispose();
}
