// Colours and textures of the parts of a mesh, for the surface shader.
import { uvName } from "../package/src/sets.js";

/** Texture units by contents; the shadow has the first. */
export const kUnits = { base: 1, normal: 2, emission: 3 };
const kUploadUnit = kUnits.base;

const kNoTexture = { sampler: {}, uv: uvName(0), rows: [[1, 0, 0], [0, 1, 0]] };

/** Default material. */
const kPlain = { base: [0.491, 0.451, 0.392, 1], emission: [0, 0, 0], normalScale: 1, cutoff: 0,
  textures: { base: kNoTexture, normal: kNoTexture, emission: kNoTexture } };

function haveSame(sampler, other) {
  return Object.keys({ ...sampler, ...other }).every((key) => sampler[key] === other[key]);
}

export class Materials {
  constructor(gl) {
    this.gl = gl;
    const pixels = Uint8Array.of(255, 255, 255, 255);
    this.white = this.upload({ width: 1, height: 1, pixels }, {}, gl.RGBA8);
    this.list = [];
    this.uploaded = []; // { texture, picture, sampler, format }
  }

  /** Sets materials: { base, emission, normalScale, textures: { base, normal, emission }, blends,
   * doubleSided, cutoff }. Textures: { picture, sampler, uv, rows }; pictures are images or
   * undefined, samplers as in glTF, and rows form a matrix for texture coordinates. */
  set(materials) {
    this.clear();
    this.list = materials;
    for (const { textures } of materials) {
      for (const [use, texture] of Object.entries(textures)) this.textureOf(use, texture);
    }
  }

  clear() {
    for (const { texture } of this.uploaded) this.gl.deleteTexture(texture);
    this.uploaded = [];
    this.list = [];
  }

  /** Returns the texture of a picture, uploaded once per sampler and number format. */
  textureOf(use, { picture, sampler }) {
    if (!picture) return this.white;
    const format = use === "normal" ? this.gl.RGBA8 : this.gl.SRGB8_ALPHA8;
    let found = this.uploaded.find((other) => other.picture === picture &&
      other.format === format && haveSame(sampler, other.sampler));
    if (!found) {
      found = { picture, sampler, format, texture: this.upload(picture, sampler, format) };
      this.uploaded.push(found);
    }
    return found.texture;
  }

  upload(picture, { magFilter, minFilter, wrapS, wrapT }, format) {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + kUploadUnit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    if (picture.pixels) {
      gl.texImage2D(gl.TEXTURE_2D, 0, format, picture.width, picture.height, 0, gl.RGBA,
        gl.UNSIGNED_BYTE, picture.pixels);
    } else {
      gl.texImage2D(gl.TEXTURE_2D, 0, format, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    }
    gl.generateMipmap(gl.TEXTURE_2D);
    for (const [name, value] of [["MAG_FILTER", magFilter ?? gl.LINEAR],
      ["MIN_FILTER", minFilter ?? gl.LINEAR_MIPMAP_LINEAR], ["WRAP_S", wrapS ?? gl.REPEAT],
      ["WRAP_T", wrapT ?? gl.REPEAT]]) {
      gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${name}`], value);
    }
    gl.activeTexture(gl.TEXTURE0);
    return texture;
  }

  /** Returns the material with the number of a part; without one, white under colours of vertices.
   * */
  at(number, hasTints) {
    return this.list[number] ?? (hasTints ? { ...kPlain, base: [1, 1, 1, 1] } : kPlain);
  }

  bind({ textures }) {
    const { gl } = this;
    for (const [use, unit] of Object.entries(kUnits)) {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this.textureOf(use, textures[use]));
    }
    gl.activeTexture(gl.TEXTURE0);
  }
}
