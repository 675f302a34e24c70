/** Bounds of a frame, or of all frames: [x, y, z] of each corner. */
export interface Bounds {
  min: [number, number, number];
  max: [number, number, number];
}

/** Named part of the sequence. */
export interface Clip {
  /** Clips may have the same name. */
  name: string;
  firstFrame: number;
  /** Number of frames. */
  frames: number;
  /** Seconds from its first frame to its last, (frames - 1) / frameRate: the first pose is at its
   * start and the last one at its end, like keys of glTF. */
  duration: number;
}

export interface StreamInfo {
  readonly vertices: number;
  readonly triangles: number;
  /** Number of frames; of an open-ended stream that has been cut off, those of its whole GOFs. */
  readonly frames: number;
  /** Frames per second. */
  readonly frameRate: number;
  /** Seconds from the first frame to the last, (frames - 1) / frameRate. */
  readonly duration: number;
  readonly profile: "Baseline" | "Main" | "High";
  readonly level: number;
  /** Number of vertex layers, the maximum of `coarseLayers`; 0 in the Baseline profile, unless
   * opened with `coarseLayers`. */
  readonly layers: number;
  /** Bits of an integer position. */
  readonly positionBits: number;
  /** Size of the stream. */
  readonly bytes: number;
  /** Whether the stream has attributes(); a coarse mesh has none in any case. */
  readonly hasAttributes: boolean;
  /** Whether the stream has an asset(). */
  readonly hasAsset: boolean;
  /** Number of damaged units before the first frame (attributes, the asset, clips, metadata) that
   * are ignored. */
  readonly damagedUnits: number;
}

/** Elements that have values. */
export type AttributeDomain = "vertex" | "corner" | "triangle";
/** Kind of values. "smoothing" has none: corners with the same number share a normal, computed from
 * the positions of each frame. */
export type AttributeKind = "integers" | "unitVectors" | "floats" | "smoothing";

/** Set of values, the same in all frames. */
export interface Attribute {
  /** "uv0", "normal", "colour0", "material", "part" and others (Table F-1 of the specification). */
  name: string;
  domain: AttributeDomain;
  kind: AttributeKind;
  /** Components of a value, 1 to 4; smoothing: 0. */
  components: number;
  /** Number of values; smoothing: 0. */
  count: number;
  /** Texture coordinates with (0, 0) in the upper left corner of an image, linear colours from 0 to
   * 1, unit vectors as x, y, z, indices of materials, or other input of the encoder. */
  values: Float32Array;
  /** Coded values, without scale and offset; unit vectors as points of an octahedron. */
  integers: Uint32Array;
  /** Index of the value of each corner, three per triangle; only with the domain "corner". */
  corners?: Uint32Array;
}

/** Mesh for graphics cards: a copy of each vertex of the stream for each combination of values at
 * its corners. */
export interface DrawnMesh {
  /** Vertex of the stream of each drawn vertex, ascending. */
  vertices: Uint32Array;
  /** Drawn vertices of each triangle, in the order of `indices` of the decoder. */
  indices: Uint32Array;
  /** Values at the drawn vertices, of sets of vertices and corners, except smoothing. */
  attributes: ReadonlyMap<string, { name: string; components: number; values: Float32Array }>;
}

export interface Progress {
  /** Bytes received from the server. */
  loaded: number;
  /** Size of the stream, if known. */
  total?: number;
}

/** Source of a stream. A URL is read in ranges, as far as frames need them; a server without ranges
 * sends it whole. In node, a string without a scheme is the path of a file. Another decoder shares
 * its bytes, its worker and, unless they are given, its options except `coarseLayers`. */
export type Source = string | URL | ArrayBuffer | ArrayBufferView | Blob | RlpcDecoder;

export interface OpenOptions {
  /** Number of the coarsest vertex layers to decode, as a mesh with fewer vertices and triangles. */
  coarseLayers?: number;
  /** Maximum bytes of memory for decoding, and of a stream that a server sends whole; default
   * 2^30. */
  maxMemory?: number;
  /** Whether to compare frames with the hashes of the stream; default true. */
  verifyHashes?: boolean;
  /** Whether to ignore damaged attributes, assets, clips and metadata (`info.damagedUnits`); default
   * true. Otherwise, open() rejects. */
  skipDamagedUnits?: boolean;
  /** Called whenever bytes arrive from a server. */
  onProgress?: (progress: Progress) => void;
  /** Rejects open() with an AbortError. */
  signal?: AbortSignal;
  /** Headers of each request to a server. */
  headers?: HeadersInit;
  credentials?: RequestCredentials;
  /** false: decodes on this thread, as node does. A function makes the worker from `rlpc/worker`,
   * for bundlers that do not find it. */
  worker?: boolean | (() => Worker);
  /** The WebAssembly module, `rlpc/rlpc.wasm`, for bundlers that do not find it. */
  wasm?: WebAssembly.Module | ArrayBuffer | ArrayBufferView | string | URL;
}

export interface FrameOptions {
  /** Whether to return positions; default true. */
  positions?: boolean;
  integers?: boolean;
  normals?: boolean;
  coordinates?: boolean;
  /** Whether arrays have the vertices of drawn() instead of those of the stream. Normals are then
   * those of the set "normal" in this frame, if the stream has it. */
  drawn?: boolean;
  /** Cancels the previous request with `replace` that still waits: for scrubbing. */
  replace?: boolean;
  /** Returns a frame that does not match its hash, with `error`. With the last frame, `error` also
   * reports errors in the rest of the stream. */
  tolerant?: boolean;
  /** Rejects frame() with an AbortError. */
  signal?: AbortSignal;
  /** A frame that is no longer needed, whose arrays are reused. They cannot be used afterwards. */
  into?: Partial<Pick<Frame, "positions" | "integers" | "normals" | "coordinates">>;
}

export interface Frame {
  index: number;
  /** Seconds from the start of the sequence. */
  time: number;
  /** x, y, z of each vertex, in units. */
  positions: Float32Array;
  /** x, y, z of each vertex on the grid; (integer + gridOrigin) * gridStep is in units. */
  integers?: Int32Array;
  /** x, y, z of each vertex: the mean of the normals of its triangles, weighted by area; with
   * `drawn`, the normals of the stream. */
  normals?: Float32Array;
  /** x, y, z of each vertex relative to `centre`, in a cube from -1 to 1 that holds all positions:
   * precise even if the mesh is small and far from the origin. */
  coordinates?: Float32Array;
  centre?: [number, number, number];
  /** Bounding box of the frame, in units. */
  bounds: Bounds;
  /** Hash of the frame (clause 9.7.2 of the specification). */
  crc: number;
  /** Number of frames found to match the hashes of the stream with this one. */
  comparedFrames: number;
  /** Decoding time. */
  milliseconds: number;
  error?: RlpcError;
}

type OptionalArray = "integers" | "normals" | "coordinates";
type ArraysOf<O> = { [K in OptionalArray]: O extends { [P in K]: true } ? K : never }[OptionalArray];

/** Frame with the arrays that its options request. */
export type FrameOf<O> =
  Omit<Frame, ArraysOf<O> | (O extends { positions: false } ? "positions" : never)> &
  Required<Pick<Frame, ArraysOf<O>>>;

export interface FramesOptions extends Omit<FrameOptions, "into" | "replace"> {
  first?: number;
  /** The last frame; default: that of the sequence. */
  last?: number;
  /** Number of frames to decode ahead; default 4. */
  ahead?: number;
}

export class RlpcDecoder {
  private constructor();

  /** Reads the header, the triangles and the index of a stream. */
  static open(source: Source, options?: OpenOptions): Promise<RlpcDecoder>;

  readonly info: StreamInfo;
  /** Three vertices of each triangle, the same in all frames. */
  readonly indices: Uint32Array;
  /** Index of each vertex in the whole mesh; only with `coarseLayers`. */
  readonly coarseVertices?: Uint32Array;
  readonly clips: readonly Clip[];
  /** Metadata of the encoder, from JSON; null without. */
  readonly metadata: unknown;
  /** Box that holds all frames, possibly larger than their extent. */
  readonly bounds: Bounds;
  /** Offset of integer positions. */
  readonly gridOrigin: [number, number, number];
  /** Step of the grid, in units. */
  readonly gridStep: number;

  /** Decodes a frame at random access. Rejects with an RlpcError if it cannot be decoded; other frames
   * may still be. */
  frame<O extends FrameOptions = FrameOptions>(index: number, options?: O): Promise<FrameOf<O>>;
  /** Decodes frames in order and ahead. */
  frames<O extends FramesOptions = FramesOptions>(options?: O):
    AsyncGenerator<FrameOf<O>, void, undefined>;
  /** Decodes texture coordinates, normals, colours, materials and others, by name; empty if the
   * stream has none. Loads the first frame. Frames can be decoded even if it rejects. */
  attributes(): Promise<ReadonlyMap<string, Attribute>>;
  /** Makes the vertices to draw with attributes; see `drawn` of frame(). */
  drawn(): Promise<DrawnMesh>;
  /** Reads materials, textures and names, as a GLB without geometry; null if the stream has none. It
   * is unchecked input of the encoder: a reader of glTF must check it. */
  asset(): Promise<Uint8Array | null>;
  /** Returns pairs of vertices: each edge of the triangles once, for a wireframe. */
  edges(): Promise<Uint32Array>;
  /** Loads the rest of the stream, while frames are decoded. */
  download(options?: { signal?: AbortSignal }): Promise<Blob>;
  /** Rejects pending requests. The worker ends with the last decoder that uses it. */
  close(): void;
}

/** truncated: the stream ends too early; invalid: it does not conform to the specification;
 * unsupported: it has a later version; limit: beyond maxMemory; source: it cannot be read; network:
 * the server does not send it; closed: the decoder was closed. */
export type ErrorKind =
  "truncated" | "invalid" | "unsupported" | "limit" | "source" | "network" | "closed";

export class RlpcError extends Error {
  constructor(message: string,
    details: { kind: ErrorKind; rule?: string; element?: string; bitOffset?: number });
  readonly kind: ErrorKind;
  /** The broken rule of the specification, such as "R-UNT-03", or "". */
  readonly rule: string;
  /** The syntax element, or "". */
  readonly element: string;
  /** Start of the element, in bits from the start of the stream. */
  readonly bitOffset: number;
}

export type PlaybackLoop = "repeat" | "once" | "pingpong";

/** Schedules frames: shows the one that is nearest in time. A range of n frames lasts n - 1
 * intervals; when it repeats, its end is the start of the next pass, so that a loop whose last pose
 * equals its first does not pause. Every frame is decoded and shown: if decoding is too slow, time
 * passes more slowly. */
export class Playback<F = Frame> {
  constructor(options: {
    frames: number;
    frameRate: number;
    /** Number of frames to hold; default 4. */
    ahead?: number;
    /** Whether `following` and `fraction` are used: then time waits until both frames are ready. */
    interpolates?: boolean;
    request: (index: number, signal: AbortSignal) => Promise<F>;
    /** Returns a frame that is already available, which is then not requested. */
    peek?: (index: number) => F | undefined;
    /** Takes frames that are no longer needed. */
    discard?: (frame: F) => void;
    failed?: (error: unknown, index: number) => void;
  });
  readonly playing: boolean;
  readonly speed: number;
  readonly loop: PlaybackLoop;
  /** The frame that is shown, or will be shown as soon as it is decoded. */
  readonly frame: number;
  /** Seconds from the start of the range, also between frames. */
  readonly seconds: number;
  /** Seconds from the start of the range to its end. */
  readonly duration: number;
  readonly interpolates: boolean;
  /** The frame after the one that is shown, if it interpolates and the frame is ready. */
  readonly following: F | undefined;
  /** Position between the shown and the following frame, from 0 to 1. */
  readonly fraction: number;
  /** Called at the end of a range that is played once. */
  finished: () => void;
  /** Called where a range restarts or reverses. */
  looped: () => void;
  /** Plays these frames, from the first. */
  setRange(first: number, count: number): void;
  /** Sets the speed; negative: backwards. */
  setSpeed(speed: number): void;
  setLoop(loop: PlaybackLoop): void;
  setInterpolates(interpolates: boolean): void;
  play(): void;
  pause(): void;
  seek(frame: number): void;
  /** Seeks to a time from the start of the range, at most to its end. */
  seekSeconds(seconds: number): void;
  /** Ends all requests. */
  cancel(): void;
  /** Advances time; not for negative seconds. Returns the frame to show now, if it is new; without a
   * frame if it cannot be decoded. */
  tick(seconds: number): { index: number; frame?: F } | undefined;
}
