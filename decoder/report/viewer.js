// The viewer of a mesh: WebGL 2, without any library.
"use strict";
(() => {
const $ = (id) => document.getElementById(id);
const info = JSON.parse($("mesh-info").textContent);
const canvas = $("view");

const bytesOf = (id) => {
  const text = atob($(id).textContent);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
};
const V = info.vertices;
const triangles = new Uint32Array(bytesOf("mesh-triangles").buffer);
const levels = {
  original: new Uint16Array(bytesOf("mesh-original").buffer),
  decoded: new Uint16Array(bytesOf("mesh-decoded").buffer),
};
const errors = bytesOf("mesh-errors");

// ---- What is drawn ----

const edges = (() => {
  const list = [];
  const seen = new Set();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let i = 0; i < 3; ++i) {
      const a = triangles[t + i], b = triangles[t + (i + 1) % 3];
      const key = Math.min(a, b) * V + Math.max(a, b);
      if (a !== b && !seen.has(key)) {
        seen.add(key);
        list.push(a, b);
      }
    }
  }
  return new Uint32Array(list);
})();

// From the centre of all frames: far from the origin, 32 bits would not tell them apart.
function positionsOf(which, frame) {
  const from = levels[which].subarray(3 * V * frame, 3 * V * (frame + 1));
  const xyz = new Float32Array(3 * V);
  for (let i = 0; i < xyz.length; ++i) xyz[i] = info.step[i % 3] * (from[i] - 65535 / 2);
  return xyz;
}

// Normals of triangles, as long as twice their area.
function triangleNormals(xyz) {
  const normals = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = xyz[b] - xyz[a], uy = xyz[b + 1] - xyz[a + 1], uz = xyz[b + 2] - xyz[a + 2];
    const vx = xyz[c] - xyz[a], vy = xyz[c + 1] - xyz[a + 1], vz = xyz[c + 2] - xyz[a + 2];
    normals[t] = uy * vz - uz * vy;
    normals[t + 1] = uz * vx - ux * vz;
    normals[t + 2] = ux * vy - uy * vx;
  }
  return normals;
}

function vertexNormals(xyz) {
  const normals = new Float32Array(3 * V);
  const ofTriangles = triangleNormals(xyz);
  for (let t = 0; t < triangles.length; ++t) {
    const to = 3 * triangles[t], from = t - t % 3;
    for (let c = 0; c < 3; ++c) normals[to + c] += ofTriangles[from + c];
  }
  return normals;
}

// Whether many corners are sharp, so that shading across them would look wrong.
function isAngular(xyz) {
  const smooth = vertexNormals(xyz), flat = triangleNormals(xyz);
  let sharp = 0;
  for (let t = 0; t < triangles.length; ++t) {
    const s = smooth.subarray(3 * triangles[t], 3 * triangles[t] + 3);
    const f = flat.subarray(t - t % 3, t - t % 3 + 3);
    const dot = s[0] * f[0] + s[1] * f[1] + s[2] * f[2];
    if (dot < 0.77 * Math.hypot(...s) * Math.hypot(...f)) ++sharp;
  }
  return sharp > 0.2 * triangles.length;
}

// ---- WebGL ----

const gl = canvas.getContext("webgl2", {antialias: true, alpha: true});
if (!gl) {
  canvas.replaceWith("This browser has no WebGL 2, which the viewer needs.");
  return;
}

const VERTEX = `#version 300 es
in vec3 position; in vec3 normal; in float level;
uniform mat4 view; uniform mat4 projection; uniform highp vec4 ink;
out vec3 seen; out vec3 turned; out float error;
void main() {
  vec4 p = view * vec4(position, 1.0);
  seen = p.xyz; turned = mat3(view) * normal; error = level * level;
  gl_Position = projection * p;
  gl_PointSize = 3.0;
  if (ink.a > 0.0) gl_Position.z -= 5e-4 * gl_Position.w;  // edges, before their triangles
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 seen; in vec3 turned; in float error;
uniform sampler2D colours; uniform float gain; uniform bool flatShading;
uniform highp vec4 ink;
out vec4 colour;
void main() {
  if (ink.a > 0.0) { colour = ink; return; }
  vec3 n = flatShading || dot(turned, turned) == 0.0 ? cross(dFdx(seen), dFdy(seen)) : turned;
  n = dot(n, n) > 0.0 ? normalize(n) : vec3(0.0, 0.0, 1.0);  // of points: towards us
  if (dot(n, seen) > 0.0) n = -n;
  float key = max(dot(n, normalize(vec3(0.45, 0.7, 0.9))), 0.0);
  float fill = max(dot(n, normalize(vec3(-0.8, -0.1, 0.5))), 0.0);
  float light = 0.42 + 0.56 * key + 0.14 * fill;
  vec3 paint = texture(colours, vec2(clamp(error * gain, 0.002, 0.998), 0.5)).rgb;
  colour = vec4(min(paint * light, 1.0), 1.0);
}`;

function compile() {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    throw new Error(gl.getProgramInfoLog(program));
  }
  gl.useProgram(program);
  return program;
}
const program = compile();
const uniform = (name) => gl.getUniformLocation(program, name);
const at = Object.fromEntries(["view", "projection", "gain", "flatShading", "ink"].map(
    (name) => [name, uniform(name)]));

function attribute(name, size, type, normalised) {
  const buffer = gl.createBuffer();
  const place = gl.getAttribLocation(program, name);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.enableVertexAttribArray(place);
  gl.vertexAttribPointer(place, size, type, normalised, 0, 0);
  return (values) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
  };
}
const setPositions = attribute("position", 3, gl.FLOAT, false);
const setNormals = attribute("normal", 3, gl.FLOAT, false);
const setLevels = attribute("level", 1, gl.UNSIGNED_BYTE, true);

const indices = gl.createBuffer();
gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, indices);
gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, 4 * (triangles.length + edges.length), gl.STATIC_DRAW);
gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, 0, triangles);
gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, 4 * triangles.length, edges);

// From no error to the top of the scale.
const STOPS = [[217, 222, 229], [250, 215, 110], [241, 140, 56], [207, 43, 74], [104, 22, 125]];
$("scale-bar").style.background =
    `linear-gradient(to right, ${STOPS.map((s) => `rgb(${s})`).join(", ")})`;
const ramp = new Uint8Array(4 * 256);
for (let i = 0; i < 256; ++i) {
  const place = i / 255 * (STOPS.length - 1);
  const low = Math.min(STOPS.length - 2, Math.floor(place));
  for (let c = 0; c < 3; ++c) {
    ramp[4 * i + c] = STOPS[low][c] + (place - low) * (STOPS[low + 1][c] - STOPS[low][c]);
  }
  ramp[4 * i + 3] = 255;
}
gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, ramp);
gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
gl.enable(gl.DEPTH_TEST);

// ---- Camera: turns about the centre; radii are of the sphere around all frames ----

const radius = Math.hypot(...info.step) * 65535 / 2 || 1;
const TAN = Math.tan(0.5 * 35 * Math.PI / 180);
let camera = {yaw: 0.6, pitch: 0.3, distance: 1, x: 0, y: 0};

function viewMatrix() {
  const {yaw, pitch, distance, x, y} = camera;
  const sy = Math.sin(yaw), cy = Math.cos(yaw), sp = Math.sin(pitch), cp = Math.cos(pitch);
  // Rows: right, up, backward; of a mesh whose y axis is up.
  let rows = [[cy, 0, -sy], [-sp * sy, cp, -sp * cy], [cp * sy, sp, cp * cy]];
  if ($("up").value === "z") rows = rows.map(([a, b, c]) => [a, -c, b]);
  return [0, 1, 2].flatMap((c) => [rows[0][c], rows[1][c], rows[2][c], 0])
      .concat(x, y, -distance, 1);
}

function projectionMatrix(aspect) {
  const near = Math.max(camera.distance - 1.6 * radius, camera.distance * 0.04);
  const far = camera.distance + 1.6 * radius;
  const fit = TAN * Math.max(1, 1 / aspect);  // as much is seen of a narrow stage
  return [1 / (fit * aspect), 0, 0, 0, 0, 1 / fit, 0, 0,
          0, 0, (near + far) / (near - far), -1, 0, 0, 2 * near * far / (near - far), 0];
}

// All of the animation in sight, as large as that allows.
function fitCamera() {
  camera = {yaw: 0.6, pitch: 0.3, distance: 0, x: 0, y: 0};
  const m = viewMatrix();
  const aspect = canvas.clientWidth / canvas.clientHeight / ($("show").value === "both" ? 2 : 1);
  const fit = TAN * Math.max(1, 1 / aspect);
  const seen = [];
  const every = Math.ceil(info.frames / 12);
  for (let f = 0; f < info.frames; f += every) {
    const xyz = positionsOf("decoded", f);
    for (let i = 0; i < xyz.length; i += 3) {
      seen.push([0, 1, 2].map((r) =>
          m[r] * xyz[i] + m[4 + r] * xyz[i + 1] + m[8 + r] * xyz[i + 2] + m[12 + r]));
    }
  }
  const middle = [0, 1].map((c) => {
    let low = Infinity, high = -Infinity;
    for (const p of seen) {
      low = Math.min(low, p[c]);
      high = Math.max(high, p[c]);
    }
    return (low + high) / 2;
  });
  for (const [x, y, z] of seen) {
    camera.distance = Math.max(camera.distance, z + 1.1 * Math.max(
        Math.abs(x - middle[0]) / (fit * aspect), Math.abs(y - middle[1]) / fit));
  }
  camera.distance = camera.distance || radius;
  camera.x = -middle[0];
  camera.y = -middle[1];
}

// ---- Drawing ----

let frame = 0;
let pending = false;

function drawMesh(which, withErrors, x, width, height) {
  const xyz = positionsOf(which, frame);
  setPositions(xyz);
  setNormals($("flat").checked ? new Float32Array(3 * V) : vertexNormals(xyz));
  setLevels(errors.subarray(V * frame, V * (frame + 1)));
  gl.viewport(x, 0, width, height);
  gl.uniformMatrix4fv(at.view, false, viewMatrix());
  gl.uniformMatrix4fv(at.projection, false, projectionMatrix(width / height));
  const top = info[$("top").value];
  gl.uniform1f(at.gain, withErrors && top > 0 ? info.largest / top : 0);
  gl.uniform1i(at.flatShading, $("flat").checked);
  gl.uniform4f(at.ink, 0, 0, 0, 0);
  gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
  if (triangles.length === 0) gl.drawArrays(gl.POINTS, 0, V);
  if ($("wires").checked) {
    gl.uniform4f(at.ink, 0.08, 0.1, 0.13, 0.9);
    gl.drawElements(gl.LINES, edges.length, gl.UNSIGNED_INT, 4 * triangles.length);
  }
}

function draw() {
  pending = false;
  const ratio = window.devicePixelRatio || 1;
  canvas.width = Math.round(canvas.clientWidth * ratio);
  canvas.height = Math.round(canvas.clientHeight * ratio);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  const show = $("show").value, byError = $("colour").value === "error";
  const {width, height} = canvas;
  if (show === "both") {
    const half = Math.floor(width / 2);
    drawMesh("original", false, 0, half, height);
    drawMesh("decoded", byError, half, width - half, height);
  } else {
    drawMesh(show, byError, 0, width, height);
  }
}
function redraw() {
  if (!pending) requestAnimationFrame(draw);
  pending = true;
}

const digits = (value) => String(Number(value.toPrecision(3)));
function showScale() {
  const top = info[$("top").value];
  $("scale").hidden = $("colour").value === "none" || info.largest === 0;
  const share = info.diagonal > 0 ? digits(100 * top / info.diagonal) : "–";
  $("scale-title").textContent = `distance in units of A; top: ${share} % of the diagonal`;
  $("scale-middle").textContent = digits(top / 2);
  $("scale-top").textContent = (top < info.largest ? "≥ " : "") + digits(top);
  const show = $("show").value;
  $("tag-left").textContent = show === "both" ? "original" : show;
  $("tag-right").textContent = show === "both" ? "decoded" : "";
  redraw();
}

function showFrame(to) {
  frame = Math.max(0, Math.min(info.frames - 1, to));
  $("time").value = frame;
  const shown = frame * info.stride;
  $("frame").textContent = `frame ${shown} / ${info.all_frames - 1}`;
  document.dispatchEvent(new CustomEvent("frame-shown", {detail: shown}));
  redraw();
}

// ---- Controls ----

let playing = false;
let began = 0;  // when frame 0 would have been shown, at this speed
function rate() { return info.frame_rate / info.stride * Number($("speed").value) / 1000; }
function keepTime() { began = performance.now() - frame / rate(); }
function play(on) {
  playing = on && info.frames > 1;
  $("play").textContent = playing ? "\u275A\u275A" : "\u25B6";
  keepTime();
  if (playing) requestAnimationFrame(tick);
}
function tick(time) {
  if (!playing) return;
  const to = Math.floor(Math.max(0, time - began) * rate()) % info.frames;
  if (to !== frame) showFrame(to);
  requestAnimationFrame(tick);
}
function step(to) {
  play(false);
  showFrame(to);
}

$("time").max = info.frames - 1;
$("time").addEventListener("input", () => step(Number($("time").value)));
$("play").addEventListener("click", () => play(!playing));
$("speed").addEventListener("change", keepTime);
$("reset").addEventListener("click", () => { fitCamera(); redraw(); });
for (const id of ["show", "up"]) $(id).addEventListener("change", fitCamera);
for (const id of ["show", "colour", "top"]) $(id).addEventListener("change", showScale);
for (const id of ["flat", "wires", "up"]) $(id).addEventListener("change", redraw);
document.addEventListener("go-to-frame", (event) => step(Math.round(event.detail / info.stride)));
document.addEventListener("keydown", (event) => {
  if (/^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName)) return;
  if (event.key === " ") play(!playing);
  else if (event.key === "ArrowLeft") step(frame - 1);
  else if (event.key === "ArrowRight") step(frame + 1);
  else return;
  event.preventDefault();
});
canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
canvas.addEventListener("pointermove", (event) => {
  if (!canvas.hasPointerCapture(event.pointerId)) return;
  if (event.shiftKey || event.buttons === 2) {
    const perPixel = 2 * camera.distance * TAN / canvas.clientHeight;
    camera.x += event.movementX * perPixel;
    camera.y -= event.movementY * perPixel;
  } else {
    camera.yaw -= event.movementX * 0.008;
    camera.pitch = Math.max(-1.55, Math.min(1.55, camera.pitch + event.movementY * 0.008));
  }
  redraw();
});
canvas.addEventListener("contextmenu", (event) => event.preventDefault());
canvas.addEventListener("wheel", (event) => {
  event.preventDefault();
  camera.distance = Math.max(0.05 * radius, Math.min(
      20 * radius, camera.distance * Math.exp(event.deltaY * 0.001)));
  redraw();
}, {passive: false});
new ResizeObserver(redraw).observe(canvas);

// A link may name frame and settings: #frame=12&show=both&edges
const asked = new URLSearchParams(location.hash.slice(1));
for (const id of ["show", "colour", "top", "up"]) {
  if ([...$(id).options].some((o) => o.value === asked.get(id))) $(id).value = asked.get(id);
}
$("wires").checked = asked.has("edges");
$("flat").checked = asked.has("flat") || isAngular(positionsOf("decoded", 0));
fitCamera();
showScale();
showFrame(Math.round((Number(asked.get("frame")) || 0) / info.stride));

// The first picture, at once; and a sign for tests that it is there.
draw();
const pixels = new Uint8Array(4 * canvas.width * canvas.height);
gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
let covered = 0;
for (let i = 3; i < pixels.length; i += 4) covered += pixels[i] > 0;
canvas.dataset.coveredPixels = covered;
canvas.dataset.frame = frame * info.stride;
})();
