// Colours, emission and their textures, and normal maps, from the asset of a stream: a GLB without
// geometry. It is from anybody: what does not fit is left out, and nothing is fetched.
import { glbChunks, glbJson } from "../package/src/glb.js";
import { uvName } from "../package/src/sets.js";

const kMaxPixels = 4096; // of a side of a texture; larger ones are scaled down
const kWhite = [1, 1, 1, 1];

function numbers(value, count, usual) {
  const fits = Array.isArray(value) && value.length === count && value.every(Number.isFinite);
  return fits ? value : usual;
}

/** Returns rows of a matrix from texture coordinates to those of the image (KHR_texture_transform).
 * */
function rowsOf({ offset, rotation, scale } = {}) {
  const [x, y] = numbers(offset, 2, [0, 0]);
  const [u, v] = numbers(scale, 2, [1, 1]);
  const angle = Number.isFinite(rotation) ? rotation : 0;
  const [sin, cos] = [Math.sin(angle), Math.cos(angle)];
  return [[cos * u, sin * v, x], [-sin * u, cos * v, y]];
}

function blobOf({ json, binary }, image) {
  if (/^data:/.test(image?.uri ?? "")) {
    const [type, text] = image.uri.slice(5).split(";base64,");
    return new Blob([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], { type });
  }
  const { byteOffset = 0, byteLength = 0 } = json.bufferViews?.[image?.bufferView] ?? {};
  return new Blob([binary.slice(byteOffset, byteOffset + byteLength)], { type: image?.mimeType });
}

async function pictureOf(blob) {
  const options = { colorSpaceConversion: "none", premultiplyAlpha: "none" };
  const picture = await createImageBitmap(blob, options);
  const { width, height } = picture;
  const scale = kMaxPixels / Math.max(width, height);
  if (scale >= 1) return picture;
  try {
    return await createImageBitmap(picture, { ...options, resizeWidth: Math.ceil(scale * width),
      resizeHeight: Math.ceil(scale * height), resizeQuality: "medium" });
  } finally {
    picture.close();
  }
}

/** Reads materials for Viewer.setMaterials(), and their problems: { materials, problems }. Throws
 * if the asset is not a GLB. */
export async function readMaterials(bytes) {
  const glb = { json: glbJson(bytes), binary: glbChunks(bytes).binary };
  const { materials = [], textures = [], images = [], samplers = [] } = glb.json;
  const problems = [];
  const pictures = new Map(); // promises, by number of the image
  const pictureAt = (number) => {
    if (!pictures.has(number)) {
      pictures.set(number, Promise.resolve(images[number]).then((image) => blobOf(glb, image))
        .then(pictureOf).catch(() => void problems.push(`texture ${number} cannot be shown`)));
    }
    return pictures.get(number);
  };
  const textureOf = async (info) => {
    const { index, texCoord, extensions } = info ?? {};
    const transform = extensions?.KHR_texture_transform;
    const { source, sampler, extensions: others } = textures[index] ?? {};
    const image = source ?? others?.EXT_texture_webp?.source;
    return {
      picture: index === undefined ? undefined : await pictureAt(image),
      sampler: samplers[sampler] ?? {},
      uv: uvName(transform?.texCoord ?? texCoord ?? 0),
      rows: rowsOf(transform),
    };
  };
  const read = async (material) => {
    const { pbrMetallicRoughness, normalTexture, emissiveFactor, emissiveTexture, alphaMode,
      alphaCutoff, doubleSided = false, extensions } = material ?? {};
    const { baseColorFactor, baseColorTexture } = pbrMetallicRoughness ?? {};
    const [strength] = numbers([extensions?.KHR_materials_emissive_strength?.emissiveStrength], 1,
      [1]);
    return {
      base: numbers(baseColorFactor, 4, kWhite),
      emission: numbers(emissiveFactor, 3, [0, 0, 0]).map((value) => value * strength),
      normalScale: numbers([normalTexture?.scale], 1, [1])[0],
      textures: {
        base: await textureOf(baseColorTexture),
        normal: await textureOf(normalTexture),
        emission: await textureOf(emissiveTexture),
      },
      blends: alphaMode === "BLEND",
      doubleSided,
      cutoff: alphaMode === "MASK" ? alphaCutoff ?? 0.5 : 0,
    };
  };
  return { materials: await Promise.all(materials.map(read)), problems };
}
