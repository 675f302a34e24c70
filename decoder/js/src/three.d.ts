import {
  AnimationActionLoopStyles, Loader, LoadingManager, Material, Mesh, BufferGeometry,
  Object3DEventMap,
} from "three";
import { Clip, OpenOptions, RlpcDecoder, RlpcError, Source } from "./index.js";

export interface RLPCMeshOptions {
  /** A material, or a function that makes one; usually a grey MeshStandardMaterial. */
  material?: Material | Material[] | ((decoder: RlpcDecoder) => Material | Material[]);
  /** Whether each frame has normals; usually true. Not needed for flat shading. */
  normals?: boolean;
}

export interface RLPCMeshEventMap extends Object3DEventMap {
  /** A frame is shown. */
  frame: { index: number };
  /** A clip with LoopOnce has ended. */
  finished: { clip: Clip | null };
  /** A frame cannot be decoded; playing goes on with the next. */
  error: { error: RlpcError; index: number };
}

/** A mesh that plays a stream. Its geometry has positions, normals and bounds of the frame that is
 * shown. */
export class RLPCMesh extends Mesh<BufferGeometry, Material | Material[], RLPCMeshEventMap> {
  constructor(decoder: RlpcDecoder, options?: RLPCMeshOptions);
  /** With its first frame. The mesh closes the decoder when it is disposed of. */
  static create(decoder: RlpcDecoder, options?: RLPCMeshOptions): Promise<RLPCMesh>;

  readonly decoder: RlpcDecoder;
  readonly clips: readonly Clip[];
  /** The clip that is played; null: the whole sequence. */
  readonly clip: Clip | null;
  readonly playing: boolean;
  /** Index of the frame that is shown. */
  readonly frame: number;
  /** Seconds from the start of the clip; can be set. */
  time: number;
  /** Seconds that the clip takes at speed 1. */
  readonly duration: number;
  /** Usually 1; below 0, it plays backwards. */
  speed: number;
  /** Usually LoopRepeat. */
  loop: AnimationActionLoopStyles;

  /** Goes on; with the name of a clip, or null for the whole sequence, plays that from its start. */
  play(name?: string | null): this;
  pause(): this;
  /** Back to the start. */
  stop(): this;
  /** To be called for each picture, with the seconds since the last. Returns whether a new frame
   * is shown. */
  update(delta: number): boolean;
  dispose(): void;
}

export class RLPCLoader extends Loader<RLPCMesh> {
  constructor(manager?: LoadingManager);
  setOptions(options: OpenOptions & RLPCMeshOptions): this;
  /** As loadAsync(), of any source: a file that was dropped, an ArrayBuffer, ... */
  open(source: Source, onProgress?: (event: ProgressEvent) => void): Promise<RLPCMesh>;
}
