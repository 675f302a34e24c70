import {
  AnimationActionLoopStyles, AnimationClip, Camera, Loader, LoadingManager, Material, Mesh, BufferGeometry,
  Object3DEventMap,
} from "three";
import { Clip, OpenOptions, RlpcDecoder, RlpcError, Source } from "./index.js";

export interface RLPCMeshOptions {
  /** Instead of those of the stream: a material, or a function that makes one; or a list, in
   * which the attribute "material" of triangles is an index. Without both, a grey
   * MeshStandardMaterial. */
  material?: Material | Material[] | ((decoder: RlpcDecoder) => Material | Material[]);
  /** Whether each frame has normals. Usually true, unless there are materials and no normals in the
   * stream: then shading is flat, as in glTF. */
  normals?: boolean;
  /** false: positions and triangles only, without texture coordinates, colours and materials. */
  attributes?: boolean;
  /** false: materials without their textures, whose images are then not decoded. */
  textures?: boolean;
  /** Reads materials and textures: a GLTFLoader, if it needs decoders of its own (KTX 2), or
   * "three/addons/" cannot be imported. */
  gltfLoader?: MaterialsLoader;
  /** Whether what is between two frames is shown: their linear mix. Usually true; false: the frame
   * that is nearest in time. */
  interpolate?: boolean;
  /** Bytes for decoded frames that are kept, of a mesh and all its clones; usually 2^26. Up to
   * four frames for each mesh that plays are kept in any case. */
  frameMemory?: number;
}

/** A level of detail of addLevel(). */
export interface RLPCLevelOptions {
  /** It has the vertices of so many of the coarsest vertex layers: from 1 on, and below `layers` of
   * the decoder's info. */
  layers: number;
  /** From which distance to the camera selectLevel() chooses it; usually 0. */
  distance?: number;
  /** The part of the distance by which one has to come nearer than that for it to end; usually
   * 0. */
  hysteresis?: number;
}

/** What is used of a GLTFLoader. */
export interface MaterialsLoader {
  parseAsync(data: ArrayBuffer | string, path: string): Promise<unknown>;
}

export interface RLPCMeshEventMap extends Object3DEventMap {
  /** Another frame is shown, or is nearest to what is shown. */
  frame: { index: number };
  /** A clip with LoopOnce has ended. */
  finished: { clip: Clip | null };
  /** A clip begins again, or turns back (LoopPingPong). */
  loop: { clip: Clip | null };
  /** A frame cannot be decoded; playing goes on with the next. */
  error: { error: RlpcError; index: number };
}

/** A mesh that plays a stream. Its geometry has positions, normals and bounds of what is shown, and
 * texture coordinates (uv, uv1, uv2, uv3) and colours (color) of the stream, with a
 * group for each material. Errors of attributes and materials are told with console.warn. */
export class RLPCMesh extends Mesh<BufferGeometry, Material | Material[], RLPCMeshEventMap> {
  /** Without attributes of the stream. */
  constructor(decoder: RlpcDecoder,
    options?: Pick<RLPCMeshOptions, "material" | "normals" | "interpolate" | "frameMemory">);
  /** With attributes, materials and its first frame. The mesh closes the decoder when it is
   * disposed of. */
  static create(decoder: RlpcDecoder, options?: RLPCMeshOptions): Promise<RLPCMesh>;

  readonly decoder: RlpcDecoder;
  readonly clips: readonly Clip[];
  /** The clip that is played; null: the whole sequence. */
  readonly clip: Clip | null;
  readonly playing: boolean;
  /** Index of the frame that is shown, or is nearest to what is shown. */
  readonly frame: number;
  /** Seconds from the start of the clip; can be set. It is shown by the first update() after its
   * frames have been decoded. */
  time: number;
  /** Sets `time`, and resolves once it is shown, or that of a later seek, or once it could not
   * be decoded, of which an event tells. Rejects with an AbortError after dispose(). */
  seek(seconds: number): Promise<void>;
  /** Seconds that the clip takes at speed 1, from its first frame to its last: n frames take
   * (n - 1) / frameRate. Where it repeats, its end is the start of the next turn. */
  readonly duration: number;
  /** Usually 1; below 0, it plays backwards. */
  speed: number;
  /** Usually LoopRepeat. */
  loop: AnimationActionLoopStyles;
  /** Whether what is between two frames is shown: their linear mix. */
  interpolate: boolean;
  /** For an AnimationMixer: an AnimationClip for each of `clips`, in their order; without clips, one
   * of the whole sequence. Its actions blend positions; where the sum of their weights is below 1,
   * the rest is what the mesh plays by itself. Additive blending has no effect. */
  animations: AnimationClip[];

  /** Goes on; with a clip or the name of one, or null for the whole sequence, plays that from its
   * start. A name that several clips have is that of the first. */
  play(clip?: string | Clip | null): this;
  pause(): this;
  /** Back to the start. */
  stop(): this;
  /** To be called for each picture, with the seconds since the last, a finite number; below 0, no time
   * passes. Actions of an AnimationMixer do not need it. With a camera, it also calls selectLevel().
   * Returns whether something else is shown than before. */
  update(delta: number, camera?: Camera): boolean;
  /** Resolves once what is wanted now is shown, by actions of an AnimationMixer or by `time`. Rejects
   * with an AbortError after dispose(). */
  ready(): Promise<void>;
  /** A new AnimationClip of a clip, or of the whole sequence, for actions of this mesh and its clones:
   * to blend a clip with itself. To be kept and used again: it ends with the last mesh of the
   * stream. */
  makeAnimation(clip: string | Clip | null): AnimationClip;

  /** Adds a coarser mesh of the same stream, for this mesh and its clones, with texture coordinates
   * and materials. Resolves to its number. */
  addLevel(options: RLPCLevelOptions): Promise<number>;
  /** The level that is shown, or will be as soon as there are frames for it; 0: the finest. Levels are
   * in the order of their distances. */
  level: number;
  /** Chooses the level for the distance to a camera, whose matrixWorld is up to date. */
  selectLevel(camera: Camera): this;

  /** A mesh of the same stream with a geometry, a time and actions of its own. It shares decoded
   * frames and materials; each has to be disposed of. */
  clone(recursive?: boolean): this;
  /** Frees its geometry; the last mesh of a stream also frees materials, textures and the decoder. */
  dispose(): void;
}

export class RLPCLoader extends Loader<RLPCMesh> {
  constructor(manager?: LoadingManager);
  setOptions(options: OpenOptions & RLPCMeshOptions): this;
  /** As loadAsync(), of any source: a file that was dropped, an ArrayBuffer, ... */
  open(source: Source, onProgress?: (event: ProgressEvent) => void): Promise<RLPCMesh>;
}
