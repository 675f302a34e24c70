// Compiled by package_test.py, not run: uses the whole package with its types.
import { AnimationMixer, LoopOnce, MeshBasicMaterial, PerspectiveCamera, Scene } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { Playback, RlpcDecoder, RlpcError, type Attribute, type DrawnMesh, type Frame } from "rlpc";
import { RLPCLoader, RLPCMesh } from "rlpc/three";

export async function decode(url: string): Promise<number> {
  const decoder = await RlpcDecoder.open(url, {
    coarseLayers: 3, maxMemory: 1e8, onProgress: ({ loaded, total }) => console.log(loaded, total) });
  const profile: "Baseline" | "Main" | "High" = decoder.info.profile;
  const frame: Frame = await decoder.frame(0, { normals: true, replace: true });
  const first: number = frame.positions[0] + decoder.gridOrigin[0] * decoder.gridStep;
  for await (const { bounds } of decoder.frames({ first: 1, ahead: 2 })) console.log(bounds.min[0]);
  const clip: string | undefined = decoder.clips.at(0)?.name;
  // @ts-expect-error: without positions
  (await decoder.frame(0, { positions: false })).positions.length;
  const again = await RlpcDecoder.open(decoder);
  const blob: Blob = await again.download();
  decoder.close();
  return first + blob.size + profile.length + (clip?.length ?? 0);
}

export async function attributes(decoder: RlpcDecoder): Promise<number> {
  const sets: ReadonlyMap<string, Attribute> = await decoder.attributes();
  const uv = sets.get("uv0");
  const corners: Uint32Array | undefined = uv?.domain === "corner" ? uv.corners : undefined;
  const { vertices, indices, attributes: values }: DrawnMesh = await decoder.drawn();
  const frame = await decoder.frame(3, { drawn: true, normals: true });
  const glb: Uint8Array | null = decoder.info.hasAsset ? await decoder.asset() : null;
  const normals: Float32Array = frame.normals;
  const plain: Frame = await decoder.frame(0);
  // @ts-expect-error: without normals
  const none: Float32Array = plain.normals;
  for await (const { integers } of decoder.frames({ integers: true })) console.log(integers[0], none);
  return normals.length + (corners?.length ?? 0) + vertices.length + indices.length + frame.positions.length +
    (values.get("uv0")?.values[0] ?? 0) + (glb?.length ?? 0) + (uv?.kind === "smoothing" ? 1 : 0);
}

export function explain(error: unknown): string {
  if (!(error instanceof RlpcError)) return "";
  return error.kind === "network" ? error.message : `${error.rule} at bit ${error.bitOffset}`;
}

export async function show(scene: Scene, file: File): Promise<RLPCMesh> {
  const loader = new RLPCLoader().setOptions({ material: () => new MeshBasicMaterial() });
  loader.setOptions({ attributes: true, textures: false, gltfLoader: new GLTFLoader() });
  const mesh = await loader.loadAsync("walk.rlpc");
  mesh.loop = LoopOnce;
  mesh.speed = -1;
  mesh.addEventListener("finished", ({ clip }) => console.log(clip?.name));
  mesh.play("Run").update(0.1);
  mesh.play(mesh.clips.find((clip) => clip.duration > 1) ?? null);
  scene.add(mesh, await loader.open(file));
  mesh.dispose();
  return mesh;
}

export function playback(decoder: RlpcDecoder): Playback {
  const { frames, frameRate } = decoder.info;
  return new Playback({ frames, frameRate, request: (index, signal) => decoder.frame(index, { signal }),
    peek: () => undefined });
}

export async function crowd(scene: Scene, mesh: RLPCMesh, camera: PerspectiveCamera): Promise<number> {
  const copy: RLPCMesh = mesh.clone();
  copy.play();
  const mixer = new AnimationMixer(mesh);
  const [walk, run] = mesh.animations.map((clip) => mixer.clipAction(clip));
  walk.play().crossFadeTo(run.play(), 0.3, true);
  mixer.clipAction(mesh.makeAnimation(null)).play();
  const level: number = await mesh.addLevel({ layers: 4, distance: 10, hysteresis: 0.1 });
  mesh.interpolate = false;
  mesh.addEventListener("loop", ({ clip }) => console.log(clip?.name));
  await mesh.ready();
  scene.add(copy);
  return copy.update(0.1, camera) ? level : copy.selectLevel(camera).level;
}

export function between(decoder: RlpcDecoder): number {
  const playback = new Playback({ frames: 2, frameRate: 30, interpolates: true,
    request: (index) => decoder.frame(index) });
  playback.setInterpolates(!playback.interpolates);
  return playback.fraction * (playback.following?.positions[0] ?? 0);
}
