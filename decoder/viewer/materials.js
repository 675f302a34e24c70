// Base colours and textures of the parts of a mesh, for the surface shader.

export const kPictureUnit = 1; // of textures; the shadow has the first

/** Where no material tells another. */
const kPlain =
  { base: [0.491, 0.451, 0.392, 1], rows: [[1, 0, 0], [0, 1, 0]], uv: "uv0", cutoff: 0 };

function haveSame(sampler, other) {
  return Object.keys({ ...sampler, ...other }).every((key) => sampler[key] === other[key]);
}

export class Materials {
  constructor(gl) {
    this.gl = gl;
    const pixels = Uint8Array.of(255, 255, 255, 255);
    this.white = this.texture({ width: 1, height: 1, pixels }, {});
    this.list = [];
  }

  /** materials: { base, picture, sampler, uv, rows, blends, doubleSided, cutoff }; pictures are
   * images or undefined, samplers as in glTF, rows those of a matrix for texture coordinates. */
  set(materials) {
    this.clear();
    for (const material of materials) {
      const { picture, sampler } = material;
      const same = this.list.find((other) =>
        other.picture === picture && haveSame(sampler, other.sampler));
      const texture = picture && (same?.texture ?? this.texture(picture, sampler));
      this.list.push({ ...material, texture });
    }
  }

  clear() {
    for (const { texture } of this.list) this.gl.deleteTexture(texture ?? null);
    this.list = [];
  }

  texture(picture, { magFilter, minFilter, wrapS, wrapT }) {
    const { gl } = this;
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + kPictureUnit);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    if (picture.pixels) {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, picture.width, picture.height, 0, gl.RGBA,
        gl.UNSIGNED_BYTE, picture.pixels);
    } else {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
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

  /** Of the number in a part; under colours of vertices, what has no material is white. */
  at(number, hasTints) {
    return this.list[number] ?? (hasTints ? { ...kPlain, base: [1, 1, 1, 1] } : kPlain);
  }

  bind({ texture }) {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0 + kPictureUnit);
    gl.bindTexture(gl.TEXTURE_2D, texture ?? this.white);
    gl.activeTexture(gl.TEXTURE0);
  }
}
