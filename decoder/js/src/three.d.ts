import {
  AnimationActionLoopStyles, Loader, LoadingManager, Material, Mesh, BufferGeometry,
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
}

/** What is used of a GLTFLoader. */
export interface MaterialsLoader {
  parseAsync(data: ArrayBuffer | string, path: string): Promise<unknown>;
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
 * shown, and texture coordinates (uv, uv1, uv2, uv3) and colours (color) of the stream, with a
 * group for each material. Errors of attributes and materials are told with console.warn. */
export class RLPCMesh extends Mesh<BufferGeometry, Material | Material[], RLPCMeshEventMap> {
  /** Without attributes of the stream. */
  constructor(decoder: RlpcDecoder, options?: Pick<RLPCMeshOptions, "material" | "normals">);
  /** With attributes, materials and its first frame. The mesh closes the decoder when it is
   * disposed of. */
  static create(decoder: RlpcDecoder, options?: RLPCMeshOptions): Promise<RLPCMesh>;

  readonly decoder: RlpcDecoder;
  readonly clips: readonly Clip[];
  /** The clip that is played; null: the whole sequence. */
  readonly clip: Clip | null;
  readonly playing: boolean;
  /** Index of the frame that is shown. */
  readonly frame: number;
  /** Seconds from the start of the clip; can be set. The frame that is nearest in time is shown by
   * the first update() after it has been decoded. */
  time: number;
  /** Sets `time`, and resolves once its frame is shown, or that of a later seek, or once it could not
   * be decoded, of which an event tells. Rejects with an AbortError after dispose(). */
  seek(seconds: number): Promise<void>;
  /** Seconds that the clip takes at speed 1, from its first frame to its last: n frames take
   * (n - 1) / frameRate. Where it repeats, its end is the start of the next turn. */
  readonly duration: number;
  /** Usually 1; below 0, it plays backwards. */
  speed: number;
  /** Usually LoopRepeat. */
  loop: AnimationActionLoopStyles;

  /** Goes on; with a clip or the name of one, or null for the whole sequence, plays that from its
   * start. A name that several clips have is that of the first. */
  play(clip?: string | Clip | null): this;
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
