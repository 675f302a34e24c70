// The mesh on a floor, in light, seen through a camera that turns around it.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { Floor } from "./floor.js";
import { paintDeviation } from "./deviation_paint.js";

const kMostShadowTriangles = 2e6; // beyond, a second drawing for the shadow costs too much
const kDirection = new THREE.Vector3(0.55, 0.36, 1).normalize(); // of the first view
const kBaseColour = 0xbab3a8;

export class Scene {
  constructor(canvas) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.toneMapping = THREE.ACESFilmicToneMapping;
    this.renderer.shadowMap.enabled = true;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.addEventListener("change", () => (this.isDrawn = false));
    this.axes = new THREE.Group(); // turned if z is up
    this.place = new THREE.Group(); // of the size of the view
    this.body = new THREE.Group(); // at the centre of the frame, from which it is drawn
    this.scene.add(this.axes.add(this.place.add(this.body)));
    this.floor = new Floor(this.scene);
    this.addLights();
    this.isDrawn = false;
  }

  addLights() {
    this.scene.add(new THREE.HemisphereLight(0xd5e3f5, 0x5a4e44, 1.15));
    const key = new THREE.DirectionalLight(0xfff0da, 3.1);
    key.castShadow = true;
    key.shadow.mapSize.set(2048, 2048);
    key.shadow.bias = -0.001;
    key.shadow.normalBias = 0.006;
    key.shadow.radius = 4;
    Object.assign(key.shadow.camera, { left: -1, right: 1, top: 1, bottom: -1, near: 0.1, far: 8 });
    const rim = new THREE.DirectionalLight(0x9fc4ff, 1.6);
    this.lights = [[key, new THREE.Vector3(1.6, 2.8, 1.7)], [rim, new THREE.Vector3(-1.8, 1.2, -2.2)]];
    for (const [light] of this.lights) this.scene.add(light, light.target);
    this.key = key;
  }

  /** Of a stream; the first frame follows with showFrame(). */
  setMesh(header, triangles) {
    this.removeMesh();
    const numVertices = header.num_vertices;
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    const dynamic = (array, size, normalized) =>
      new THREE.BufferAttribute(array, size, normalized).setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("position", dynamic(new Float32Array(3 * numVertices), 3));
    geometry.setAttribute("normal", dynamic(new Int16Array(4 * numVertices), 4, true));
    geometry.setAttribute("deviation", dynamic(new Float32Array(numVertices), 1));
    this.geometry = geometry;
    this.material = new THREE.MeshStandardMaterial({
      color: kBaseColour, roughness: 0.62, metalness: 0, side: THREE.DoubleSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    this.deviationScale = paintDeviation(this.material);
    this.surface = triangles.length > 0
      ? new THREE.Mesh(geometry, this.material)
      : new THREE.Points(geometry, new THREE.PointsMaterial({ size: 0.01, color: kBaseColour }));
    this.surface.frustumCulled = false; // there is no bounding sphere of what moves
    this.surface.castShadow = this.surface.receiveShadow =
      triangles.length / 3 <= kMostShadowTriangles;
    this.body.add(this.surface);
    this.lines = null;
    this.box = null;
    this.isDrawn = false;
  }

  /** Gives back what the graphics card holds of it. */
  removeMesh() {
    for (const object of this.body.children) {
      object.geometry.dispose();
      object.material.dispose();
    }
    this.body.clear();
  }

  /** Takes the arrays of a frame; returns those that it replaces. */
  showFrame({ coordinates, normals, distances, box, centre }) {
    const replaced = {
      coordinates: this.replace("position", coordinates),
      normals: this.replace("normal", normals),
      distances: this.replace("deviation", distances),
    };
    this.body.position.set(...centre);
    const first = this.box === null;
    this.box = new THREE.Box3(new THREE.Vector3(...box.subarray(0, 3)),
      new THREE.Vector3(...box.subarray(3)));
    if (first) {
      this.lookAtAll();
    } else {
      this.follow();
    }
    this.isDrawn = false;
    return replaced;
  }

  replace(name, array) {
    if (!array) return undefined;
    const attribute = this.geometry.getAttribute(name);
    const old = attribute.array;
    attribute.array = array;
    attribute.needsUpdate = true;
    return old;
  }

  /** The box of the frame as it stands in the scene. */
  worldBox() {
    this.axes.updateMatrixWorld(true);
    return this.box.clone().applyMatrix4(this.body.matrixWorld);
  }

  /** The frame has size 1, stands on the floor, and is seen whole. */
  lookAtAll() {
    const size = this.box.getSize(new THREE.Vector3()).length();
    const scale = size > 0 ? 1 / size : 1;
    this.place.scale.setScalar(scale);
    this.place.position.copy(this.body.position).multiplyScalar(-scale);
    const box = this.worldBox();
    this.floor.setHeight(box.min.y);
    this.controls.target.copy(box.getCenter(new THREE.Vector3()));
    const fov = (this.camera.fov * Math.PI) / 360;
    const narrow = Math.min(1, this.camera.aspect);
    const distance = 0.56 / Math.sin(fov) / narrow;
    this.camera.position.copy(kDirection).multiplyScalar(distance).add(this.controls.target);
    this.controls.update();
    this.lightFrom(this.controls.target);
    this.isDrawn = false;
  }

  /** Keeps what walks away in view: beyond a distance the camera goes along. */
  follow() {
    const box = this.worldBox();
    if (box.min.y < this.floor.height) this.floor.setHeight(box.min.y);
    const away = box.getCenter(new THREE.Vector3()).sub(this.controls.target).setY(0);
    const slack = 0.3;
    if (away.length() <= slack) return;
    away.setLength(away.length() - slack);
    this.controls.target.add(away);
    this.camera.position.add(away);
    this.lightFrom(this.controls.target);
  }

  lightFrom(target) {
    for (const [light, direction] of this.lights) {
      light.target.position.copy(target);
      light.position.copy(target).add(direction);
    }
    this.floor.setCentre(target);
  }

  setFlat(flat) {
    this.material.flatShading = flat;
    this.material.needsUpdate = true;
    this.isDrawn = false;
  }

  setEdges(edges) {
    const geometry = new THREE.BufferGeometry();
    geometry.setIndex(new THREE.BufferAttribute(edges, 1));
    geometry.setAttribute("position", this.geometry.getAttribute("position"));
    this.lines = new THREE.LineSegments(geometry,
      new THREE.LineBasicMaterial({ transparent: true }));
    this.lines.frustumCulled = false;
    this.body.add(this.lines);
  }

  /** mode: "off", "over" the surface, "alone". After setEdges(), unless it is off. */
  setWireframe(mode) {
    this.surface.visible = mode !== "alone";
    if (this.lines) {
      this.lines.visible = mode !== "off";
      this.lines.material.color.set(mode === "alone" ? 0xbfe6e2 : 0x10161d);
      this.lines.material.opacity = mode === "alone" ? 0.8 : 0.5;
    }
    this.isDrawn = false;
  }

  /** Distance that has the last colour; 0: the surface has its own. */
  setDeviationScale(scale) {
    this.deviationScale.value = scale;
    this.isDrawn = false;
  }

  setUp(axis) {
    this.axes.rotation.x = axis === "z" ? -Math.PI / 2 : 0;
    if (this.box) this.lookAtAll();
  }

  resize(width, height) {
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.isDrawn = false;
  }

  /** Draws if something has changed. */
  draw() {
    this.controls.update();
    if (this.isDrawn) return;
    this.isDrawn = true;
    this.renderer.render(this.scene, this.camera);
  }
}
