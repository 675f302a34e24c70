// Compiled by package_test.py, not run: all of the package, with its types.
import { LoopOnce, MeshBasicMaterial, Scene } from "three";
import { Playback, RlpcDecoder, RlpcError, type Frame } from "rlpc";
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

export function explain(error: unknown): string {
  if (!(error instanceof RlpcError)) return "";
  return error.kind === "network" ? error.message : `${error.rule} at bit ${error.bitOffset}`;
}

export async function show(scene: Scene, file: File): Promise<RLPCMesh> {
  const loader = new RLPCLoader().setOptions({ material: () => new MeshBasicMaterial() });
  const mesh = await loader.loadAsync("walk.rlpc");
  mesh.loop = LoopOnce;
  mesh.speed = -1;
  mesh.addEventListener("finished", ({ clip }) => console.log(clip?.name));
  mesh.play("Run").update(0.1);
  scene.add(mesh, await loader.open(file));
  mesh.dispose();
  return mesh;
}

export function playback(decoder: RlpcDecoder): Playback {
  const { frames, frameRate } = decoder.info;
  return new Playback({ frames, frameRate, request: (index, signal) => decoder.frame(index, { signal }) });
}
