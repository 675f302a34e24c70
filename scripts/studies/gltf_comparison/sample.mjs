// node sample.mjs THREE IN.glb OUT SAMPLES
//
// What three.js draws of a .glb file: positions and normals of the corners of all triangles, at
// SAMPLES, a JSON list of [clip, seconds]. Writes 64-bit floats:
//   OUT.positions, OUT.normals   [samples][corners][3]
//   OUT.uv                       [sets][corners][2], NaN where a mesh has none
// and to standard output, as JSON: the number of corners, their vertices and materials, whether
// there are normals, the number of UV sets, the names of clips.

import fs from "node:fs";
import { pathToFileURL } from "node:url";

globalThis.self = globalThis; // a name that browsers have
const [three, input, output, samples] = process.argv.slice(2);
const load = (path) => import(pathToFileURL(three + path));
const THREE = await load("/build/three.module.js");
const { GLTFLoader } = await load("/examples/jsm/loaders/GLTFLoader.js");
const { MeshoptDecoder } = await load("/examples/jsm/libs/meshopt_decoder.module.js");

console.error = console.warn = () => {}; // images, which node cannot decode
const bytes = fs.readFileSync(input);
const loader = new GLTFLoader();
loader.setMeshoptDecoder(MeshoptDecoder);
const gltf = await loader.parseAsync(
  bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
gltf.scene.updateMatrixWorld(true);

const meshes = [];
gltf.scene.traverse((object) => { if (object.isMesh) meshes.push(object); });
const UV_NAMES = ["uv", "uv1"];
const numSets = UV_NAMES.filter((name) => meshes.some((m) => m.geometry.attributes[name])).length;
const hasNormals = meshes.every((mesh) => mesh.geometry.attributes.normal);

// The transform that a material applies to a set of texture coordinates.
function uvTransform(material, set) {
  const found = [material?.pbrMetallicRoughness?.baseColorTexture, material?.occlusionTexture,
    material?.pbrMetallicRoughness?.metallicRoughnessTexture,
    material?.normalTexture, material?.emissiveTexture]
    .filter((texture) => texture)
    .map((texture) => (
      { set: texture.texCoord ?? 0, ...texture.extensions?.KHR_texture_transform }))
    .find((texture) => (texture.texCoord ?? texture.set) === set);
  return { offset: found?.offset ?? [0, 0], scale: found?.scale ?? [1, 1] };
}

const vertices = [], materials = [];
const uv = UV_NAMES.map(() => []);
let firstVertex = 0;
for (const mesh of meshes) {
  const { index, attributes } = mesh.geometry;
  const place = gltf.parser.associations.get(mesh);
  const primitive = gltf.parser.json.meshes[place.meshes].primitives[place.primitives ?? 0];
  const material = gltf.parser.json.materials?.[primitive.material];
  mesh.corners = index ? Array.from(index.array)
    : Array.from({ length: attributes.position.count }, (_, i) => i);
  for (const v of mesh.corners) {
    vertices.push(firstVertex + v);
    materials.push(material?.name ?? null);
  }
  for (let set = 0; set < numSets; set++) {
    const { offset, scale } = uvTransform(material, set);
    const values = attributes[UV_NAMES[set]];
    for (const v of mesh.corners) {
      uv[set].push(values ? offset[0] + scale[0] * values.getX(v) : NaN,
        values ? offset[1] + scale[1] * values.getY(v) : NaN);
    }
  }
  firstVertex += attributes.position.count;
}

// As the shaders of three.js do: morphed, then skinned.
function worldNormal(mesh, v, target) {
  const { attributes, morphAttributes, morphTargetsRelative } = mesh.geometry;
  target.fromBufferAttribute(attributes.normal, v);
  const change = new THREE.Vector3();
  (morphAttributes.normal ?? []).forEach((values, i) => {
    const weight = mesh.morphTargetInfluences[i];
    if (weight === 0) return;
    change.fromBufferAttribute(values, v);
    if (!morphTargetsRelative) change.sub(target);
    target.addScaledVector(change, weight);
  });
  if (mesh.isSkinnedMesh) {
    const { skinIndex, skinWeight } = attributes;
    const sum = new THREE.Vector3(), part = new THREE.Vector3(), bone = new THREE.Matrix4();
    target.transformDirection(mesh.bindMatrix);
    for (let i = 0; i < 4; i++) {
      const weight = skinWeight.getComponent(v, i);
      if (weight === 0) continue;
      const joint = skinIndex.getComponent(v, i);
      bone.multiplyMatrices(mesh.skeleton.bones[joint].matrixWorld,
        mesh.skeleton.boneInverses[joint]);
      part.copy(target).applyMatrix3(new THREE.Matrix3().setFromMatrix4(bone));
      sum.addScaledVector(part, weight);
    }
    target.copy(sum).transformDirection(mesh.bindMatrixInverse);
  }
  return target.applyNormalMatrix(new THREE.Matrix3().getNormalMatrix(mesh.matrixWorld));
}

const positions = fs.openSync(`${output}.positions`, "w");
const normals = fs.openSync(`${output}.normals`, "w");
for (const [number, seconds] of JSON.parse(samples)) {
  const clip = gltf.animations[number];
  const mixer = new THREE.AnimationMixer(gltf.scene);
  if (clip) {
    const action = mixer.clipAction(clip);
    action.setLoop(THREE.LoopOnce);
    action.clampWhenFinished = true;
    action.play();
    mixer.setTime(seconds);
  }
  gltf.scene.updateMatrixWorld(true);
  const at = [], towards = [];
  const p = new THREE.Vector3();
  for (const mesh of meshes) {
    const { count } = mesh.geometry.attributes.position;
    const vertexTracks = Array.from({ length: count }, (_, v) =>
      mesh.getVertexPosition(v, p).applyMatrix4(mesh.matrixWorld).toArray());
    for (const v of mesh.corners) at.push(...vertexTracks[v]);
    if (!hasNormals) continue;
    const normalsOfVertices = Array.from({ length: count }, (_, v) =>
      worldNormal(mesh, v, p).toArray());
    for (const v of mesh.corners) towards.push(...normalsOfVertices[v]);
  }
  fs.writeSync(positions, Buffer.from(new Float64Array(at).buffer));
  fs.writeSync(normals, Buffer.from(new Float64Array(towards).buffer));
  mixer.stopAllAction();
  mixer.uncacheRoot(gltf.scene);
}
fs.writeFileSync(`${output}.uv`, Buffer.from(new Float64Array(uv.flat()).buffer));
const clips = gltf.animations.map((clip) => clip.name);
console.log(JSON.stringify({
  corners: vertices.length, vertices, materials, hasNormals, numSets, clips }));
