// node clocks.mjs MODULES PACKAGE STREAM CASES.json
//
// Shows clips at times in every way of the package. A case: { clip (an index, -1: the whole
// sequence), seconds, repeats, speed }. Writes JSON: for each case, by way, { frame, place, xyz },
// with frames counted from the start of the sequence, and the first coordinates of the mesh.
import fs from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";

globalThis.self = globalThis; // a name that browsers have
const [modules, packed, stream, cases] = process.argv.slice(2);
const load = (...parts) => import(pathToFileURL(path.join(...parts)));
const THREE = await load(modules, "three/build/three.module.js");
const { RlpcDecoder } = await load(packed, "src/index.js");
const { RLPCMesh } = await load(packed, "src/three.js");
const { nearestFrame, placeAt } = await load(packed, "src/clip_time.js");

const decoder = await RlpcDecoder.open(fs.readFileSync(stream));
const mesh = await RLPCMesh.create(decoder, { attributes: false });
const settled = async () => {
  for (let i = 0; i < 8; ++i) await new Promise((next) => setImmediate(next));
};
const animationOfAll = mesh.makeAnimation(null);
const wholeSequence = { firstFrame: 0, frames: decoder.info.frames };

function shown(place) {
  const { array } = mesh.geometry.attributes.position;
  return { frame: mesh.frame, place, xyz: [...array.slice(0, 12)] };
}

/** Applies the rule directly. */
function byRule({ firstFrame, frames }, { seconds, repeats }) {
  const place = placeAt(seconds * decoder.info.frameRate, frames, repeats ? "repeat" : "once");
  return { frame: firstFrame + nearestFrame(place), place: firstFrame + place };
}

/** Sets mesh.time, a place in the clip. */
async function bySeeking({ firstFrame }, { clip, seconds }) {
  mesh.play(clip < 0 ? null : mesh.clips[clip]).pause();
  await mesh.seek(seconds);
  return shown(firstFrame + mesh.time * decoder.info.frameRate);
}

/** Calls mesh.update() for pictures of irregular length. */
async function byPlaying({ firstFrame }, { clip, seconds, repeats, speed }) {
  mesh.loop = repeats ? THREE.LoopRepeat : THREE.LoopOnce;
  mesh.speed = speed;
  mesh.play(clip < 0 ? null : mesh.clips[clip]);
  await settled();
  mesh.update(0);
  await settled();
  const end = seconds / Math.abs(speed);
  const longest = 0.9 / decoder.info.frameRate / Math.abs(speed);
  for (let at = 0, i = 1; at < end; ++i) {
    const next = Math.min(end, at + longest * ((i * 0.618) % 1));
    mesh.update(next - at);
    await settled();
    at = next;
  }
  const result = shown(firstFrame + mesh.time * decoder.info.frameRate);
  mesh.speed = 1;
  return result;
}

/** Runs an action of an AnimationMixer. */
async function byMixer(_, { clip, seconds, repeats }) {
  mesh.play(null).pause();
  const mixer = new THREE.AnimationMixer(mesh);
  const action = mixer.clipAction(clip < 0 ? animationOfAll : mesh.animations[clip]);
  action.setLoop(repeats ? THREE.LoopRepeat : THREE.LoopOnce, Infinity);
  action.clampWhenFinished = true;
  action.play();
  mixer.update(seconds);
  await mesh.ready();
  const result = shown();
  mixer.stopAllAction();
  mixer.uncacheRoot(mesh);
  return result;
}

const told = [];
for (const one of JSON.parse(fs.readFileSync(cases))) {
  const clip = one.clip < 0 ? wholeSequence : decoder.clips[one.clip];
  const result = { rule: byRule(clip, one) };
  if (one.ways.includes("seek")) result.seek = await bySeeking(clip, one);
  if (one.ways.includes("play")) result.play = await byPlaying(clip, one);
  if (one.ways.includes("mixer")) result.mixer = await byMixer(clip, one);
  told.push(result);
}
mesh.dispose();
process.stdout.write(JSON.stringify(told), () => process.exit(0)); // once all of it is written
