// Draws a lit, animated mesh on a floor, with WebGL 2 alone.
import { Camera } from "./camera.js";
import { Materials, kUnits } from "./materials.js";
import { multiply, orthographic, viewAxes, viewMatrix } from "./matrices.js";
import { kDepth, kEdges, kFloor, kSurface } from "./shaders.js";

export { Camera } from "./camera.js";
export { kRampCss } from "./shaders.js";

const kShadowPixels = 2048;
const kMaxShadowTriangles = 2e6; // beyond it, drawing a shadow takes too long
const kAttributes =
  ["position", "normal", "deviation", "tint", "uv", "normalUv", "emissionUv"];
const kKey = viewAxes(0.755, 0.876); // axes of the lights; the last one points to the light
const kRim = viewAxes(-2.455, 0.38);

/** Returns at most `max` vertices, [x, y, z]. */
function sampled(coordinates, max = 5000) {
  const numVertices = coordinates.length / 3;
  const every = Math.ceil(numVertices / max);
  return Array.from({ length: Math.ceil(numVertices / every) }, (_, i) =>
    [...coordinates.subarray(3 * every * i, 3 * every * i + 3)]);
}

class Program {
  constructor(gl, { vertex, fragment }) {
    this.program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(this.program, shader);
    }
    kAttributes.forEach((name, place) => gl.bindAttribLocation(this.program, place, name));
    gl.linkProgram(this.program);
    if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) {
      const logs = gl.getAttachedShaders(this.program).map((shader) => gl.getShaderInfoLog(shader));
      throw new Error([gl.getProgramInfoLog(this.program), ...logs].join("\n"));
    }
    this.gl = gl;
    this.places = new Map();
  }

  /** Uses the program with values by names of uniforms: matrices, vectors, numbers, booleans. */
  use(uniforms) {
    const { gl } = this;
    gl.useProgram(this.program);
    for (const [name, value] of Object.entries(uniforms)) {
      if (!this.places.has(name)) {
        this.places.set(name, gl.getUniformLocation(this.program, name));
      }
      const place = this.places.get(name);
      if (typeof value === "number") gl.uniform1f(place, value);
      else if (typeof value === "boolean") gl.uniform1i(place, value);
      else if (value.length === 16) gl.uniformMatrix4fv(place, false, Float32Array.from(value));
      else gl[`uniform${value.length}fv`](place, value);
    }
  }
}

export class Viewer {
  /** Two viewers may share a camera. */
  constructor(canvas, camera = new Camera()) {
    this.canvas = canvas;
    this.camera = camera;
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
    if (!gl) throw new Error("it has no WebGL 2");
    this.gl = gl;
    this.programs = Object.fromEntries(Object.entries({ surface: kSurface, depth: kDepth,
      edges: kEdges, floor: kFloor }).map(([name, text]) => [name, new Program(gl, text)]));
    this.makeShadowMap();
    this.makeFloor();
    this.materials = new Materials(gl);
    this.programs.surface.use({});
    for (const [use, unit] of Object.entries(kUnits)) {
      gl.uniform1i(gl.getUniformLocation(this.programs.surface.program, `${use}Picture`), unit);
    }
    this.vertices = gl.createVertexArray();
    this.buffers = new Map(); // buffers of the mesh by name
    this.flat = false;
    this.wire = "off"; // or "over" the surface, or "alone"
    this.deviationScale = 0; // distance of the last colour of the ramp; 0: no colours
    this.plain = false; // without texture, colours and materials
    this.up = "y";
    this.numEdges = 0;
    camera.attach(canvas);
    camera.addListener(() => (this.isDrawn = false));
    this.isDrawn = false;
  }

  makeShadowMap() {
    const { gl } = this;
    this.shadowMap = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.shadowMap);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, kShadowPixels, kShadowPixels);
    for (const [name, value] of [["MIN_FILTER", gl.LINEAR], ["MAG_FILTER", gl.LINEAR],
      ["WRAP_S", gl.CLAMP_TO_EDGE], ["WRAP_T", gl.CLAMP_TO_EDGE],
      ["COMPARE_MODE", gl.COMPARE_REF_TO_TEXTURE]]) {
      gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${name}`], value);
    }
    this.shadowFrame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadowMap, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  makeFloor() {
    const { gl } = this;
    this.floor = gl.createVertexArray();
    gl.bindVertexArray(this.floor);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, Float32Array.of(-1, -1, 1, -1, -1, 1, 1, 1), gl.STATIC_DRAW);
    const place = gl.getAttribLocation(this.programs.floor.program, "corner");
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, 2, gl.FLOAT, false, 0, 0);
  }

  /** Sets the mesh. The first frame follows with showFrame(), materials perhaps with
   * setMaterials(). look: { uvs, tints, parts }: texture coordinates, [name, values]; colours of
   * vertices { values, components } or undefined; triangles of each material: { start, count,
   * material }. */
  setMesh(numVertices, triangles, look) {
    for (const buffer of this.buffers.values()) this.gl.deleteBuffer(buffer);
    this.buffers.clear();
    this.gl.deleteVertexArray(this.vertices);
    this.vertices = this.gl.createVertexArray();
    this.numVertices = numVertices;
    this.numCorners = triangles.length;
    this.numEdges = 0;
    this.frame = null;
    this.store("triangles", this.gl.ELEMENT_ARRAY_BUFFER, triangles);
    this.look = look;
    this.materials.clear();
    for (const [name, values] of look?.uvs ?? []) this.store(name, this.gl.ARRAY_BUFFER, values);
    if (look?.tints) this.store("tint", this.gl.ARRAY_BUFFER, look.tints.values);
    this.isDrawn = false;
  }

  /** Sets materials (Materials.set()) for the numbers in the parts of the mesh. */
  setMaterials(materials) {
    this.materials.set(materials);
    this.isDrawn = false;
  }

  store(name, target, values) {
    const { gl } = this;
    gl.bindVertexArray(this.vertices);
    if (!this.buffers.has(name)) this.buffers.set(name, gl.createBuffer());
    gl.bindBuffer(target, this.buffers.get(name));
    gl.bufferData(target, values, gl.DYNAMIC_DRAW);
  }

  setAttribute(name, values) {
    const { gl } = this;
    const place = kAttributes.indexOf(name);
    if (!values) return;
    this.store(name, gl.ARRAY_BUFFER, values);
    gl.enableVertexAttribArray(place);
    const isPacked = values instanceof Int16Array; // four values per vertex
    gl.vertexAttribPointer(place, name === "deviation" ? 1 : 3, isPacked ? gl.SHORT : gl.FLOAT,
      isPacked, isPacked ? 8 : 0, 0);
  }

  /** Shows a frame, whose arrays may be reused afterwards. coordinates and box ([min x, y, z, max
   * x, y, z]): relative to `centre`. normals and distances are optional. */
  showFrame({ coordinates, normals, distances, box, centre }) {
    this.setAttribute("position", coordinates);
    this.setAttribute("normal", normals);
    this.setAttribute("deviation", distances);
    const isFirst = !this.frame;
    this.frame = { box: [...box], centre: [...centre], sample: sampled(coordinates) };
    if (isFirst) {
      this.lookAtAll();
    } else {
      const placed = this.placed(this.frame);
      this.floorHeight = Math.min(this.floorHeight, placed.centre[1] - placed.halfSize[1]);
      this.camera.follow(placed, this.samplePoints());
    }
    this.isDrawn = false;
  }

  /** Scales the frame to size 1, puts it on the floor, and shows all of it. */
  lookAtAll() {
    const { box, centre } = this.frame;
    const size = Math.hypot(box[3] - box[0], box[4] - box[1], box[5] - box[2]);
    this.scale = size > 0 ? 1 / size : 1;
    this.origin = centre;
    const placed = this.placed(this.frame);
    this.floorHeight = placed.centre[1] - placed.halfSize[1];
    this.camera.look(placed, this.samplePoints());
    this.isDrawn = false;
  }

  turned([x, y, z]) {
    return this.up === "z" ? [x, z, -y] : [x, y, z];
  }

  /** Returns the box of a frame in the world. */
  placed({ box, centre }) {
    const middle = [0, 1, 2].map((i) =>
      this.scale * (centre[i] - this.origin[i] + (box[i] + box[i + 3]) / 2));
    const half = [0, 1, 2].map((i) => this.scale * (box[i + 3] - box[i]) / 2);
    return { centre: this.turned(middle), halfSize: this.turned(half).map(Math.abs) };
  }

  /** Returns some of the vertices, in the world. */
  samplePoints() {
    const offset = this.frame.centre.map((value, i) => value - this.origin[i]);
    return this.frame.sample.map((point) =>
      this.turned(point.map((value, i) => this.scale * (value + offset[i]))));
  }

  modelMatrix() {
    const columns = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map((axis) =>
      [...this.turned(axis).map((value) => value * this.scale), 0]);
    const offset = this.frame.centre.map((value, i) => this.scale * (value - this.origin[i]));
    return [...columns.flat(), ...this.turned(offset), 1];
  }

  setEdges(edges) {
    this.numEdges = edges.length / 2;
    this.store("edges", this.gl.ELEMENT_ARRAY_BUFFER, edges);
    this.isDrawn = false;
  }

  /** Sets some of flat, wire, plain and deviationScale. */
  set(settings) {
    Object.assign(this, settings);
    this.isDrawn = false;
  }

  setUp(axis) {
    this.up = axis;
    if (this.frame) this.lookAtAll();
  }

  /** Resizes the canvas to its place in the page. */
  resize() {
    const ratio = Math.min(devicePixelRatio || 1, 2);
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    this.camera.setAspect(this.canvas.clientWidth / Math.max(this.canvas.clientHeight, 1));
    this.isDrawn = false;
  }

  drawTriangles() {
    const { gl } = this;
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers.get("triangles"));
    gl.drawElements(gl.TRIANGLES, this.numCorners, gl.UNSIGNED_INT, 0);
  }

  /** Draws the shadow. Returns the matrix from the world to the view of the light. */
  drawShadow(model) {
    const { gl } = this;
    const matrix = multiply(orthographic(1.2, -4, 4), viewMatrix(kKey, this.camera.target));
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.viewport(0, 0, kShadowPixels, kShadowPixels);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    if (this.hasShadow()) {
      this.programs.depth.use({ model, light: matrix });
      this.drawTriangles();
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return matrix;
  }

  hasShadow() {
    return this.wire !== "alone" && this.numCorners > 0 &&
      this.numCorners / 3 <= kMaxShadowTriangles;
  }

  /** Draws if something has changed. */
  draw() {
    if (this.isDrawn) return;
    this.isDrawn = true;
    const { gl, camera } = this;
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    if (!this.frame) {
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      return;
    }
    const model = this.modelMatrix();
    const light = this.drawShadow(model);
    const { view, projection, eye } = camera.matrices();
    const common =
      { model, light, camera: multiply(projection, view), hasShadow: this.hasShadow() };
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (this.wire !== "alone") this.drawSurface({ ...common, eye });
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    if (this.wire !== "off" && this.numEdges > 0) this.drawEdges(common);
    this.drawFloor(common);
    gl.disable(gl.BLEND);
  }

  drawSurface(common) {
    const { gl } = this;
    this.programs.surface.use({
      ...common, keyDirection: kKey[2], rimDirection: kRim[2], isPoint: this.numCorners === 0,
      flatShading: this.flat || !this.buffers.has("normal"), deviationScale: this.deviationScale });
    gl.bindVertexArray(this.vertices);
    const parts = this.plain ? undefined : this.look?.parts;
    this.point("tint", this.plain ? undefined : this.look?.tints?.components);
    for (const blends of [false, true]) this.drawParts(parts ?? [{ material: -1 }], blends);
  }

  /** Draws opaque parts, or parts that blend, which come after them. */
  drawParts(parts, blends) {
    const { gl, look } = this;
    if (blends) {
      gl.enable(gl.BLEND);
      gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    }
    for (const { start = 0, count = this.numCorners, material } of parts) {
      const chosen = this.materials.at(material, !this.plain && Boolean(look?.tints));
      if (Boolean(chosen.blends) !== blends) continue;
      const { base, emission, normalScale, cutoff, textures } = chosen;
      const [row0, row1] = textures.base.rows;
      const [normalRow0, normalRow1] = textures.normal.rows;
      const [emissionRow0, emissionRow1] = textures.emission.rows;
      const hasNormalMap = Boolean(textures.normal.picture);
      this.programs.surface.use({ base, emission, normalScale, cutoff, blends, hasNormalMap, row0,
        row1, normalRow0, normalRow1, emissionRow0, emissionRow1 });
      this.materials.bind(chosen);
      if (blends && !chosen.doubleSided) gl.enable(gl.CULL_FACE);
      else gl.disable(gl.CULL_FACE);
      for (const [name, { uv }] of [["uv", textures.base], ["normalUv", textures.normal],
        ["emissionUv", textures.emission]]) {
        this.point(name, this.buffers.has(uv) ? 2 : undefined, uv);
      }
      if (this.numCorners > 0) {
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers.get("triangles"));
        gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 4 * start);
      } else {
        gl.drawArrays(gl.POINTS, 0, this.numVertices);
      }
    }
    gl.disable(gl.BLEND);
    gl.disable(gl.CULL_FACE);
  }

  /** Binds an attribute to the floats of a buffer; without components, to the constant white or 0.
   * */
  point(name, components, buffer = name) {
    const { gl } = this;
    const place = kAttributes.indexOf(name);
    if (!components) {
      gl.disableVertexAttribArray(place);
      gl.vertexAttrib4fv(place, name === "tint" ? [1, 1, 1, 1] : [0, 0, 0, 1]);
      return;
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.get(buffer));
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, components, gl.FLOAT, false, 0, 0);
  }

  drawEdges(common) {
    const { gl } = this;
    const ink = this.wire === "alone" ? [0.66, 0.86, 0.84, 0.85] : [0.06, 0.09, 0.11, 0.5];
    this.programs.edges.use({ ...common, ink });
    gl.bindVertexArray(this.vertices);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffers.get("edges"));
    gl.drawElements(gl.LINES, 2 * this.numEdges, gl.UNSIGNED_INT, 0);
  }

  drawFloor(common) {
    const { gl } = this;
    const [x, , z] = this.camera.target;
    this.programs.floor.use({ ...common, centre: [x, this.floorHeight - 0.002, z] });
    gl.bindVertexArray(this.floor);
    gl.depthMask(false);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.depthMask(true);
  }
}
