// Animation of a MeshView (mesh_view.h) within a page, and the controls below it.
import { Camera, Viewer, kRampCss } from "../web/viewer/viewer.js";

const $ = (id) => document.getElementById(id);

class MeshView {
  constructor() {
    const bytesOf = (id) => Uint8Array.from(atob($(id).textContent), (c) => c.charCodeAt(0));
    this.info = JSON.parse($("mesh-info").textContent);
    this.triangles = new Uint32Array(bytesOf("mesh-triangles").buffer);
    this.levels = {
      original: new Uint16Array(bytesOf("mesh-original").buffer),
      decoded: new Uint16Array(bytesOf("mesh-decoded").buffer),
    };
    this.errors = bytesOf("mesh-errors");
    this.camera = new Camera();
    this.camera.addListener(() => this.redraw());
    this.viewers = {};
    this.frame = 0;
    this.playing = false;
  }

  // ---- Drawing ----

  /** Returns coordinates relative to the centre of all frames: far from the origin, 32 bits would
   * not resolve them. */
  coordinatesOf(which, frame) {
    const { vertices, step } = this.info;
    const levels = this.levels[which].subarray(3 * vertices * frame, 3 * vertices * (frame + 1));
    return Float32Array.from(levels, (level, i) => step[i % 3] * (level - 65535 / 2));
  }

  distancesOf(frame) {
    const { vertices, largest } = this.info;
    const levels = this.errors.subarray(vertices * frame, vertices * (frame + 1));
    return Float32Array.from(levels, (level) => largest * (level / 255) ** 2);
  }

  boxOf(coordinates) {
    const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
    coordinates.forEach((value, i) => {
      box[i % 3] = Math.min(box[i % 3], value);
      box[i % 3 + 3] = Math.max(box[i % 3 + 3], value);
    });
    return box;
  }

  /** Returns normals of triangles, as long as twice their area. */
  triangleNormals(xyz) {
    const normals = new Float32Array(this.triangles.length);
    for (let t = 0; t < normals.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((i) => 3 * this.triangles[t + i]);
      const ux = xyz[b] - xyz[a], uy = xyz[b + 1] - xyz[a + 1], uz = xyz[b + 2] - xyz[a + 2];
      const vx = xyz[c] - xyz[a], vy = xyz[c + 1] - xyz[a + 1], vz = xyz[c + 2] - xyz[a + 2];
      normals[t] = uy * vz - uz * vy;
      normals[t + 1] = uz * vx - ux * vz;
      normals[t + 2] = ux * vy - uy * vx;
    }
    return normals;
  }

  vertexNormals(xyz) {
    const normals = new Float32Array(xyz.length);
    const triangleNormals = this.triangleNormals(xyz);
    this.triangles.forEach((vertex, t) => {
      for (let c = 0; c < 3; ++c) normals[3 * vertex + c] += triangleNormals[t - t % 3 + c];
    });
    return normals;
  }

  /** Returns whether many corners are sharp, so that smooth shading would look wrong. */
  isAngular(xyz) {
    const smooth = this.vertexNormals(xyz), flat = this.triangleNormals(xyz);
    let sharp = 0;
    this.triangles.forEach((vertex, t) => {
      const s = smooth.subarray(3 * vertex, 3 * vertex + 3);
      const f = flat.subarray(t - t % 3, t - t % 3 + 3);
      const dot = s[0] * f[0] + s[1] * f[1] + s[2] * f[2];
      if (dot < 0.77 * Math.hypot(...s) * Math.hypot(...f)) ++sharp;
    });
    return sharp > 0.2 * this.triangles.length;
  }

  edges() {
    const list = [];
    const seen = new Set();
    this.triangles.forEach((a, t) => {
      const b = this.triangles[t % 3 < 2 ? t + 1 : t - 2];
      const key = Math.min(a, b) * this.info.vertices + Math.max(a, b);
      if (a !== b && !seen.has(key)) {
        seen.add(key);
        list.push(a, b);
      }
    });
    return Uint32Array.from(list);
  }

  // ---- Viewers: one per mesh shown ----

  shown() {
    const { value } = $("show");
    return value === "both" ? ["original", "decoded"] : [value];
  }

  viewerOf(which) {
    if (!this.viewers[which]) {
      const viewer = new Viewer($(`view-${which}`), this.camera);
      viewer.setMesh(this.info.vertices, this.triangles);
      viewer.setEdges(this.edges());
      viewer.up = $("up").value;
      this.viewers[which] = viewer;
    }
    return this.viewers[which];
  }

  showMeshes() {
    for (const which of ["original", "decoded"]) {
      $(`view-${which}`).parentElement.hidden = !this.shown().includes(which);
    }
    for (const which of this.shown()) this.viewerOf(which).resize();
    this.showFrame(this.frame);
    this.lookAtAll();
  }

  lookAtAll() {
    for (const which of this.shown()) this.viewerOf(which).lookAtAll();
  }

  showFrame(to) {
    this.frame = Math.max(0, Math.min(this.info.frames - 1, to));
    const box = this.boxOf(this.coordinatesOf("decoded", this.frame)); // shared: one camera
    for (const which of this.shown()) {
      const coordinates = this.coordinatesOf(which, this.frame);
      const normals = $("flat").checked ? undefined : this.vertexNormals(coordinates);
      const distances = this.distancesOf(this.frame);
      this.viewerOf(which).showFrame({ coordinates, normals, distances, box, centre: [0, 0, 0] });
    }
    $("time").value = this.frame;
    const shown = this.frame * this.info.stride;
    $("frame").textContent = `frame ${shown} / ${this.info.all_frames - 1}`;
    document.dispatchEvent(new CustomEvent("frame-shown", { detail: shown }));
    this.redraw();
  }

  /** Applies the settings of the controls. */
  applySettings() {
    const top = this.info[$("top").value];
    const paints = $("colour").value === "error";
    for (const which of this.shown()) {
      this.viewerOf(which).set({
        flat: $("flat").checked,
        wire: $("wires").checked ? "over" : "off",
        deviationScale: paints && (which === "decoded" || this.shown().length === 1) ? top : 0,
      });
    }
    $("scale").hidden = !paints || this.info.largest === 0;
    const digits = (value) => String(Number(value.toPrecision(3)));
    const share = this.info.diagonal > 0 ? digits(100 * top / this.info.diagonal) : "–";
    $("scale-title").textContent = `distance in units of A; top: ${share} % of the diagonal`;
    $("scale-middle").textContent = digits(top / 2);
    $("scale-top").textContent = (top < this.info.largest ? "≥ " : "") + digits(top);
    this.redraw();
  }

  draw() {
    this.pending = false;
    for (const which of this.shown()) this.viewerOf(which).draw();
  }

  redraw() {
    if (!this.pending) requestAnimationFrame(() => this.draw());
    this.pending = true;
  }

  resize() {
    for (const which of this.shown()) this.viewerOf(which).resize();
    this.redraw();
  }

  // ---- Time ----

  rate() {
    return this.info.frame_rate / this.info.stride * Number($("speed").value) / 1000;
  }

  /** Keeps the time. began: when frame 0 would have been shown, at this speed. */
  keepTime() {
    this.began = performance.now() - this.frame / this.rate();
  }

  play(on) {
    this.playing = on && this.info.frames > 1;
    $("play").textContent = this.playing ? "\u275A\u275A" : "\u25B6";
    this.keepTime();
    if (this.playing) requestAnimationFrame((time) => this.tick(time));
  }

  tick(time) {
    if (!this.playing) return;
    const to = Math.floor(Math.max(0, time - this.began) * this.rate()) % this.info.frames;
    if (to !== this.frame) this.showFrame(to);
    requestAnimationFrame((next) => this.tick(next));
  }

  step(to) {
    this.play(false);
    this.showFrame(to);
  }

  // ---- Controls ----

  addControls() {
    $("time").max = this.info.frames - 1;
    $("time").oninput = () => this.step(Number($("time").value));
    $("play").onclick = () => this.play(!this.playing);
    $("speed").onchange = () => this.keepTime();
    $("reset").onclick = () => this.lookAtAll();
    $("show").onchange = () => {
      this.showMeshes();
      this.applySettings();
    };
    $("up").onchange = () => {
      for (const viewer of Object.values(this.viewers)) viewer.up = $("up").value;
      this.lookAtAll();
    };
    $("flat").onchange = () => {
      this.applySettings();
      this.showFrame(this.frame); // normals may have changed
    };
    for (const id of ["colour", "top", "wires"]) $(id).onchange = () => this.applySettings();
    document.addEventListener("go-to-frame",
      (event) => this.step(Math.round(event.detail / this.info.stride)));
    document.addEventListener("keydown", (event) => {
      if (/^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName)) return;
      if (event.key === " ") this.play(!this.playing);
      else if (event.key === "ArrowLeft") this.step(this.frame - 1);
      else if (event.key === "ArrowRight") this.step(this.frame + 1);
      else return;
      event.preventDefault();
    });
    new ResizeObserver(() => this.resize()).observe($("stage"));
  }

  /** Starts with the frame and settings of a link: #frame=12&show=both&edges */
  start() {
    const asked = new URLSearchParams(location.hash.slice(1));
    for (const id of ["show", "colour", "top", "up"]) {
      if ([...$(id).options].some((o) => o.value === asked.get(id))) $(id).value = asked.get(id);
    }
    $("wires").checked = asked.has("edges");
    $("flat").checked = asked.has("flat") || this.isAngular(this.coordinatesOf("decoded", 0));
    $("scale-bar").style.background = kRampCss;
    this.addControls();
    this.showMeshes();
    this.applySettings();
    this.showFrame(Math.round((Number(asked.get("frame")) || 0) / this.info.stride));
    this.draw();
    this.describe();
  }

  /** Returns, for tests, the frame and the box of the drawn mesh, as parts of the canvas from the
   * upper left. */
  describe() {
    const { gl, canvas } = this.viewerOf(this.shown()[0]);
    const { width, height } = canvas;
    const pixels = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    const box = [width, height, 0, 0];
    let covered = 0;
    for (let i = 3; i < pixels.length; i += 4) {
      if (pixels[i] < 255) continue; // the floor
      const x = (i >> 2) % width, y = height - 1 - Math.floor((i >> 2) / width);
      box[0] = Math.min(box[0], x);
      box[1] = Math.min(box[1], y);
      box[2] = Math.max(box[2], x + 1);
      box[3] = Math.max(box[3], y + 1);
      ++covered;
    }
    Object.assign($("stage").dataset, { frame: this.frame * this.info.stride, covered,
      box: box.map((value, i) => (value / [width, height][i % 2]).toFixed(3)).join(" ") });
  }
}

try {
  new MeshView().start();
} catch (error) {
  $("stage").replaceWith(`This browser cannot show the mesh: ${error.message}.`);
}
