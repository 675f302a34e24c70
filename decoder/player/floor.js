// A floor that shows where the mesh stands and how it moves: lines that fade away, a shadow.
import * as THREE from "three";

const kSize = 12;

const kVertexShader = `
  varying vec2 place;
  varying vec2 fromCentre;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    place = world.xz;
    fromCentre = position.xy;
    gl_Position = projectionMatrix * viewMatrix * world;
  }`;

const kFragmentShader = `
  varying vec2 place;
  varying vec2 fromCentre;
  float lines(float spacing) {
    vec2 p = place / spacing;
    vec2 nearest = abs(fract(p - 0.5) - 0.5) / fwidth(p);
    return 1.0 - min(min(nearest.x, nearest.y), 1.0);
  }
  void main() {
    float fade = exp(-0.9 * dot(fromCentre, fromCentre));
    float ink = max(0.11 * lines(0.1), 0.22 * lines(0.5));
    gl_FragColor = vec4(vec3(0.85, 0.92, 1.0), ink * fade);
  }`;

export class Floor {
  constructor(scene) {
    const plane = new THREE.PlaneGeometry(kSize, kSize);
    this.shadow = new THREE.Mesh(plane, new THREE.ShadowMaterial({ opacity: 0.42 }));
    this.shadow.receiveShadow = true;
    this.lines = new THREE.Mesh(plane, new THREE.ShaderMaterial({
      vertexShader: kVertexShader, fragmentShader: kFragmentShader,
      transparent: true, depthWrite: false, side: THREE.DoubleSide,
    }));
    for (const mesh of [this.shadow, this.lines]) {
      mesh.rotation.x = -Math.PI / 2;
      scene.add(mesh);
    }
  }

  get height() {
    return this.lines.position.y;
  }

  setHeight(height) {
    this.lines.position.y = height - 0.001;
    this.shadow.position.y = height - 0.002;
  }

  setCentre({ x, z }) {
    for (const mesh of [this.shadow, this.lines]) mesh.position.set(x, mesh.position.y, z);
  }
}
