import {
  AnimationActionLoopStyles, AnimationClip, Camera, Loader, LoadingManager, Material, Mesh, BufferGeometry,
  Object3DEventMap,
} from "three";
import { Clip, OpenOptions, RlpcDecoder, RlpcError, Source } from "./index.js";

export interface RLPCMeshOptions {
  /** Replaces the materials of the stream: a material, or a function that makes one; or a list, in
   * which the attribute "material" of triangles is an index. Without any, a grey
   * MeshStandardMaterial. */
  material?: Material | Material[] | ((decoder: RlpcDecoder) => Material | Material[]);
  /** Whether each frame has normals. Default true, unless the stream has materials and no normals:
   * then shading is flat, as in glTF. `true` forces smooth shading. */
  normals?: boolean;
  /** false: only positions and triangles, without texture coordinates, colours and materials. */
  attributes?: boolean;
  /** false: materials without their textures, whose images are then not decoded. */
  textures?: boolean;
  /** Reads materials and textures: a GLTFLoader with additional decoders (KTX 2), or if
   * "three/addons/" cannot be imported. */
  gltfLoader?: MaterialsLoader;
  /** Whether to interpolate linearly between frames; default true. false: shows the frame that is
   * nearest in time. */
  interpolate?: boolean;
  /** Bytes for decoded frames of a mesh and all its clones; default 2^26. Up to four frames per mesh
   * that plays are kept in any case. */
  frameMemory?: number;
}

/** Level of detail of addLevel(). */
export interface RLPCLevelOptions {
  /** Number of the coarsest vertex layers whose vertices it has: at least 1, and below `layers` of
   * the decoder's info. */
  layers: number;
  /** Distance to the camera from which selectLevel() chooses it; default 0. */
  distance?: number;
  /** Part of the distance by which the camera must come nearer than that to leave it; default 0. */
  hysteresis?: number;
}

/** Part of GLTFLoader that is used. */
export interface MaterialsLoader {
  parseAsync(data: ArrayBuffer | string, path: string): Promise<unknown>;
}

export interface RLPCMeshEventMap extends Object3DEventMap {
  /** Another frame is shown, or is nearest to the interpolated one. */
  frame: { index: number };
  /** A clip with LoopOnce has ended. */
  finished: { clip: Clip | null };
  /** A clip restarts, or reverses (LoopPingPong). */
  loop: { clip: Clip | null };
  /** A frame cannot be decoded; playback continues with the next. */
  error: { error: RlpcError; index: number };
}

/** Mesh that plays a stream. Its geometry has positions, normals and bounds of the current picture,
 * and texture coordinates (uv, uv1, uv2, uv3) and colours (color) of the stream, with a group per
 * material. Errors of attributes and materials are reported with console.warn. */
export class RLPCMesh extends Mesh<BufferGeometry, Material | Material[], RLPCMeshEventMap> {
  /** Makes a mesh without attributes of the stream. */
  constructor(decoder: RlpcDecoder,
    options?: Pick<RLPCMeshOptions, "material" | "normals" | "interpolate" | "frameMemory">);
  /** Makes a mesh with attributes, materials and its first frame. The mesh closes the decoder when
   * it is disposed of. */
  static create(decoder: RlpcDecoder, options?: RLPCMeshOptions): Promise<RLPCMesh>;

  readonly decoder: RlpcDecoder;
  readonly clips: readonly Clip[];
  /** The clip that is played; null: the whole sequence. */
  readonly clip: Clip | null;
  readonly playing: boolean;
  /** Index of the frame that is shown, or is nearest to the interpolated one. */
  readonly frame: number;
  /** Seconds from the start of the clip; can be set. The first update() after its frames have been
   * decoded shows it. */
  time: number;
  /** Sets `time`. Resolves once it is shown, or the time of a later seek, or once it could not be
   * decoded, which an event reports. Rejects with an AbortError after dispose(). */
  seek(seconds: number): Promise<void>;
  /** Seconds of the clip at speed 1, from its first frame to its last: (n - 1) / frameRate for n
   * frames. When it repeats, its end is the start of the next pass. */
  readonly duration: number;
  /** Speed; default 1; negative: backwards. */
  speed: number;
  /** Loop; default LoopRepeat. */
  loop: AnimationActionLoopStyles;
  /** Whether to interpolate linearly between frames. */
  interpolate: boolean;
  /** For an AnimationMixer: an AnimationClip for each of `clips`, in their order; without clips, one
   * of the whole sequence. Actions blend positions; if the sum of their weights is below 1, playback
   * of the mesh itself has the rest. Additive blending has no effect. */
  animations: AnimationClip[];

  /** Resumes; with a clip or its name, or null for the whole sequence, plays that from its start. A
   * name of several clips means the first. */
  play(clip?: string | Clip | null): this;
  pause(): this;
  /** Stops and returns to the start. */
  stop(): this;
  /** Must be called for each picture, with the seconds since the last one, a finite number; time does
   * not advance if negative. Actions of an AnimationMixer do not need it. With a camera, also calls
   * selectLevel(). Returns whether the picture has changed. */
  update(delta: number, camera?: Camera): boolean;
  /** Resolves once the state set by actions of an AnimationMixer or by `time` is shown. Rejects with
   * an AbortError after dispose(). */
  ready(): Promise<void>;
  /** Makes an AnimationClip of a clip, or of the whole sequence, for actions of this mesh and its
   * clones: to blend a clip with itself. Keep and reuse it: it lives until the last mesh of the
   * stream is disposed of. */
  makeAnimation(clip: string | Clip | null): AnimationClip;

  /** Adds a coarser mesh of the same stream, for this mesh and its clones, with texture coordinates
   * and materials. Resolves to its number. */
  addLevel(options: RLPCLevelOptions): Promise<number>;
  /** The level that is shown, or will be as soon as its frames are decoded; 0: the finest. Levels are
   * in the order of their distances. */
  level: number;
  /** Chooses the level for the distance to a camera, whose matrixWorld is up to date. */
  selectLevel(camera: Camera): this;

  /** Makes a mesh of the same stream with a separate geometry, time and actions. It shares decoded
   * frames and materials; each mesh must be disposed of. */
  clone(recursive?: boolean): this;
  /** Frees the geometry; the last mesh of a stream also frees materials, textures and the decoder. */
  dispose(): void;
}

export class RLPCLoader extends Loader<RLPCMesh> {
  constructor(manager?: LoadingManager);
  setOptions(options: OpenOptions & RLPCMeshOptions): this;
  /** Loads from any source, as loadAsync() does from a URL: a dropped file, an ArrayBuffer, ... */
  open(source: Source, onProgress?: (event: ProgressEvent) => void): Promise<RLPCMesh>;
}
