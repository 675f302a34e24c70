// node loops.mjs MODULES PACKAGE STREAM SOURCE.glb DECODED.glb
//
// Plays the clips of a stream with RLPCMesh, and those of both files with three's AnimationMixer,
// at the same moments. Writes JSON: the durations of each clip, and the largest difference of the
// times in it, in seconds, for each kind of loop.
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

globalThis.self = globalThis; // a name that browsers have
const [modules, packed, stream, source, decoded] = process.argv.slice(2);
const load = (...parts) => import(pathToFileURL(path.join(...parts)));
const THREE = await load(modules, "three/build/three.module.js");
const { GLTFLoader } = await load(modules, "three/examples/jsm/loaders/GLTFLoader.js");
const { RlpcDecoder } = await load(packed, "src/index.js");
const { RLPCMesh } = await load(packed, "src/three.js");

console.warn = () => {}; // about features that node lacks

async function animations(file) {
  const bytes = fs.readFileSync(file);
  const gltf = await new GLTFLoader().parseAsync(
    bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), "");
  return gltf.animations.map((clip) => {
    const mixer = new THREE.AnimationMixer(gltf.scene);
    return { clip, mixer, action: mixer.clipAction(clip) };
  });
}

const decodedOnes = await animations(decoded);
const sourceOnes = await animations(source);
const decoder = await RlpcDecoder.open(fs.readFileSync(stream));
const mesh = await RLPCMesh.create(decoder, { attributes: false });
const settled = async () => {
  for (let i = 0; i < 8; ++i) await new Promise((next) => setImmediate(next));
};

/** Plays irregular pictures for a number of passes. Returns the largest difference. */
async function furthest(index, loop, turns) {
  const others = [decodedOnes[index], sourceOnes[index]];
  for (const { action } of others) {
    action.reset().setLoop(loop, Infinity);
    action.clampWhenFinished = true;
    action.play();
  }
  mesh.loop = loop;
  mesh.play(mesh.clips[index]);
  await settled();
  mesh.update(0);
  await settled();
  let apart = 0;
  const { duration } = mesh;
  for (let seconds = 0, i = 0; seconds < turns * duration; ++i) {
    const delta = (0.1 + 0.4 * ((i * 0.618) % 1)) / decoder.info.frameRate;
    seconds += delta;
    mesh.update(delta);
    await settled();
    for (const { mixer, action } of others) {
      mixer.update(delta);
      // On the way back, the action counts its time from the end.
      const isBack = loop === THREE.LoopPingPong && Math.floor(seconds / duration) % 2 === 1;
      const off = Math.abs(mesh.time - (isBack ? duration - action.time : action.time));
      // The end of a pass is the start of the next.
      apart = Math.max(
        apart, loop === THREE.LoopOnce ? off : Math.min(off, Math.abs(duration - off)));
    }
  }
  for (const { action } of others) action.stop();
  return apart;
}

const told = [];
for (const [index, clip] of mesh.clips.entries()) {
  mesh.play(clip).pause();
  told.push({
    name: clip.name,
    durations: [clip.duration, mesh.duration, decodedOnes[index].clip.duration,
      sourceOnes[index].clip.duration],
    apart: [await furthest(index, THREE.LoopRepeat, 4), await furthest(index, THREE.LoopOnce, 1.2),
      await furthest(index, THREE.LoopPingPong, 3)],
  });
}
mesh.dispose();
process.stdout.write(JSON.stringify(told), () => process.exit(0)); // once all of it is written
