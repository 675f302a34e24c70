/** Bounds of a frame, or of all frames: [x, y, z] of each corner. */
export interface Bounds {
  min: [number, number, number];
  max: [number, number, number];
}

/** A named part of the sequence. */
export interface Clip {
  /** Clips may have the same name. */
  name: string;
  firstFrame: number;
  /** How many frames it has. */
  frames: number;
  /** Seconds from its first frame to its last, (frames - 1) / frameRate: the first pose is that of
   * its start and the last one that of its end, as keys of glTF are. */
  duration: number;
}

export interface StreamInfo {
  readonly vertices: number;
  readonly triangles: number;
  /** Of an open-ended stream that has been cut off: those of its whole GOFs. */
  readonly frames: number;
  /** Frames per second. */
  readonly frameRate: number;
  /** Seconds from the first frame to the last, (frames - 1) / frameRate. */
  readonly duration: number;
  readonly profile: "Baseline" | "Main" | "High";
  readonly level: number;
  /** Vertex layers, of which `coarseLayers` can decode the coarsest; 0 in the Baseline profile,
   * unless it was opened with `coarseLayers`. */
  readonly layers: number;
  /** Of an integer position. */
  readonly positionBits: number;
  /** Size of the stream. */
  readonly bytes: number;
  /** Whether there is anything in attributes(); a mesh of fewer layers has none all the same. */
  readonly hasAttributes: boolean;
  /** Whether there is an asset(). */
  readonly hasAsset: boolean;
  /** How many units before the first frame (attributes, the asset, clips, metadata) are damaged,
   * and count as absent. */
  readonly damagedUnits: number;
}

/** Whose values they are. */
export type AttributeDomain = "vertex" | "corner" | "triangle";
/** Of "smoothing", there are no values: corners with the same number share a normal, which follows
 * from the positions of each frame. */
export type AttributeKind = "integers" | "unitVectors" | "floats" | "smoothing";

/** A set of values, the same in all frames. */
export interface Attribute {
  /** "uv0", "normal", "colour0", "material", "part" and others (Table F-1 of the specification). */
  name: string;
  domain: AttributeDomain;
  kind: AttributeKind;
  /** Of a value: 1 to 4; 0 of smoothing. */
  components: number;
  /** How many values there are; 0 of smoothing. */
  count: number;
  /** Texture coordinates with (0, 0) in the upper left corner of an image, linear colours from 0 to
   * 1, unit vectors as x, y, z, indices of materials, or what else the encoder was given. */
  values: Float32Array;
  /** As in the stream, without scale and offset; unit vectors as points of an octahedron. */
  integers: Uint32Array;
  /** With the domain "corner": the index of the value of each corner, three for each triangle. */
  corners?: Uint32Array;
}

/** A mesh as graphics cards take it: vertices of the stream, each as often as it has different
 * combinations of values at its corners. */
export interface DrawnMesh {
  /** The vertex of the stream of each drawn vertex, ascending. */
  vertices: Uint32Array;
  /** Drawn vertices of each triangle, in the order of `indices` of the decoder. */
  indices: Uint32Array;
  /** Values at the drawn vertices, of the sets of vertices and corners, but smoothing. */
  attributes: ReadonlyMap<string, { name: string; components: number; values: Float32Array }>;
}

export interface Progress {
  /** Bytes that have come from the server. */
  loaded: number;
  /** Size of the stream, once it is known. */
  total?: number;
}

/** What a stream can be read from. A URL is read in ranges, as far as frames need them; a server
 * without ranges sends it whole. In node, a string without a scheme is the path of a file. Another
 * decoder shares its bytes and its worker, and its options but `coarseLayers`, unless they are given. */
export type Source = string | URL | ArrayBuffer | ArrayBufferView | Blob | RlpcDecoder;

export interface OpenOptions {
  /** Decodes a mesh of this many of the coarsest vertex layers, with fewer vertices and
   * triangles. */
  coarseLayers?: number;
  /** Bytes that decoding may take, and that a stream may have which a server sends whole;
   * usually 2^30. */
  maxMemory?: number;
  /** Whether frames are compared with the hashes of the stream; usually true. */
  verifyHashes?: boolean;
  /** Whether attributes, assets, clips and metadata that are damaged count as absent
   * (`info.damagedUnits`); usually true. Otherwise, they are errors of open(). */
  skipDamagedUnits?: boolean;
  /** Called whenever bytes have come from a server. */
  onProgress?: (progress: Progress) => void;
  /** Rejects open() with an AbortError. */
  signal?: AbortSignal;
  /** Of each request to a server. */
  headers?: HeadersInit;
  credentials?: RequestCredentials;
  /** false: decodes on this thread, as node does. A function: makes the worker, from
   * `rlpc/worker`, where a bundler does not find it. */
  worker?: boolean | (() => Worker);
  /** The WebAssembly module, `rlpc/rlpc.wasm`, where a bundler does not find it. */
  wasm?: WebAssembly.Module | ArrayBuffer | ArrayBufferView | string | URL;
}

export interface FrameOptions {
  /** Usually true. */
  positions?: boolean;
  integers?: boolean;
  normals?: boolean;
  coordinates?: boolean;
  /** Arrays have the vertices of drawn() instead of those of the stream. Normals are then those of
   * the set "normal", computed for this frame, if there is one. */
  drawn?: boolean;
  /** Cancels the request before that also had `replace`, if it still waits: for scrubbing. */
  replace?: boolean;
  /** A frame that does not fit its hash is given all the same, with `error`. With the last frame,
   * `error` also tells what is wrong with the rest of the stream. */
  tolerant?: boolean;
  /** Rejects frame() with an AbortError. */
  signal?: AbortSignal;
  /** A frame whose arrays are not needed any more, to be filled again. They cannot be used
   * afterwards. */
  into?: Partial<Pick<Frame, "positions" | "integers" | "normals" | "coordinates">>;
}

export interface Frame {
  index: number;
  /** Seconds from the start of the sequence. */
  time: number;
  /** x, y, z of each vertex, in units. */
  positions: Float32Array;
  /** x, y, z of each vertex on the grid; plus gridOrigin, times gridStep: in units. */
  integers?: Int32Array;
  /** x, y, z of each vertex: the mean of the normals of its triangles, weighted by area. With
   * `drawn`, as the stream has them. */
  normals?: Float32Array;
  /** x, y, z of each vertex from `centre`, in a cube from -1 to 1 that holds all positions: these
   * keep their precision where the mesh is small and far from the origin. */
  coordinates?: Float32Array;
  centre?: [number, number, number];
  /** The smallest box that holds the frame, in units. */
  bounds: Bounds;
  /** Its hash (clause 9.7.2 of the specification). */
  crc: number;
  /** How many frames have now been found equal to the hashes of the stream. */
  comparedFrames: number;
  /** What decoding took. */
  milliseconds: number;
  error?: RlpcError;
}

type OptionalArray = "integers" | "normals" | "coordinates";
type ArraysOf<O> = { [K in OptionalArray]: O extends { [P in K]: true } ? K : never }[OptionalArray];

/** A frame with the arrays that its options ask for. */
export type FrameOf<O> =
  Omit<Frame, ArraysOf<O> | (O extends { positions: false } ? "positions" : never)> &
  Required<Pick<Frame, ArraysOf<O>>>;

export interface FramesOptions extends Omit<FrameOptions, "into" | "replace"> {
  first?: number;
  /** The last frame; usually that of the sequence. */
  last?: number;
  /** How many frames are decoded before they are asked for; usually 4. */
  ahead?: number;
}

export class RlpcDecoder {
  private constructor();

  /** Reads the header, the triangles and the index of a stream. */
  static open(source: Source, options?: OpenOptions): Promise<RlpcDecoder>;

  readonly info: StreamInfo;
  /** Three vertices of each triangle, the same in all frames. */
  readonly indices: Uint32Array;
  /** With `coarseLayers`: the index of each vertex in the whole mesh. */
  readonly coarseVertices?: Uint32Array;
  readonly clips: readonly Clip[];
  /** What the encoder noted, from JSON; null if it noted nothing. */
  readonly metadata: unknown;
  /** A box that holds all frames, and may be larger. */
  readonly bounds: Bounds;
  /** Added to integer positions. */
  readonly gridOrigin: [number, number, number];
  /** The step of the grid, in units. */
  readonly gridStep: number;

  /** A frame, in any order. Rejects with an RlpcError if it cannot be decoded; others can. */
  frame<O extends FrameOptions = FrameOptions>(index: number, options?: O): Promise<FrameOf<O>>;
  /** Frames in order, decoded ahead. */
  frames<O extends FramesOptions = FramesOptions>(options?: O):
    AsyncGenerator<FrameOf<O>, void, undefined>;
  /** Texture coordinates, normals, colours, materials and others, by name; empty if the stream has
   * none. Loads the first frame. Frames can be decoded even if it rejects. */
  attributes(): Promise<ReadonlyMap<string, Attribute>>;
  /** The vertices to draw with attributes; see `drawn` of frame(). */
  drawn(): Promise<DrawnMesh>;
  /** Materials, textures and names, as a GLB without geometry; null if the stream has none. It is
   * as the encoder was given it: a reader of glTF has to check it. */
  asset(): Promise<Uint8Array | null>;
  /** Pairs of vertices: each edge of the triangles once, for a wireframe. */
  edges(): Promise<Uint32Array>;
  /** Loads the rest of the stream, while frames are decoded. */
  download(options?: { signal?: AbortSignal }): Promise<Blob>;
  /** Rejects pending requests. The worker ends with the last decoder that uses it. */
  close(): void;
}

/** truncated: the stream ends too early; invalid: it does not conform to the specification;
 * unsupported: of a later version; limit: beyond maxMemory; source: it cannot be read; network: the
 * server does not send it; closed: the decoder was closed. */
export type ErrorKind =
  "truncated" | "invalid" | "unsupported" | "limit" | "source" | "network" | "closed";

export class RlpcError extends Error {
  constructor(message: string,
    details: { kind: ErrorKind; rule?: string; element?: string; bitOffset?: number });
  readonly kind: ErrorKind;
  /** The rule of the specification that is broken, as "R-UNT-03", or "". */
  readonly rule: string;
  /** The syntax element, or "". */
  readonly element: string;
  /** Where the element begins, in bits from the start of the stream. */
  readonly bitOffset: number;
}

export type PlaybackLoop = "repeat" | "once" | "pingpong";

/** Which frame is shown when: the one that is nearest in time. A range of n frames takes n - 1
 * intervals from its first frame to its last; where it repeats, its end is the start of the next
 * turn, so that a loop whose last pose is its first does not halt. Every frame is decoded and none
 * is left out: if decoding is too slow, time passes more slowly. */
export class Playback<F = Frame> {
  constructor(options: {
    frames: number;
    frameRate: number;
    /** Frames to hold; usually 4. */
    ahead?: number;
    /** Whether `following` and `fraction` matter: then time waits until both frames are there. */
    interpolates?: boolean;
    request: (index: number, signal: AbortSignal) => Promise<F>;
    /** A frame that is there already: it is then not requested. */
    peek?: (index: number) => F | undefined;
    /** Takes frames that are not wanted any more. */
    discard?: (frame: F) => void;
    failed?: (error: unknown, index: number) => void;
  });
  readonly playing: boolean;
  readonly speed: number;
  readonly loop: PlaybackLoop;
  /** The frame that is shown, or will be as soon as it is decoded. */
  readonly frame: number;
  /** Seconds from the start of the range, also between frames. */
  readonly seconds: number;
  /** Seconds from the start of the range to its end. */
  readonly duration: number;
  readonly interpolates: boolean;
  /** The frame after the one that is shown, if it interpolates, and if that is there. */
  readonly following: F | undefined;
  /** How far on the way to the following frame, from 0 to 1. */
  readonly fraction: number;
  /** Called at the end of a range that is played once. */
  finished: () => void;
  /** Called where a range begins again, or turns back. */
  looped: () => void;
  /** Plays these frames, from the first. */
  setRange(first: number, count: number): void;
  /** Below 0: backwards. */
  setSpeed(speed: number): void;
  setLoop(loop: PlaybackLoop): void;
  setInterpolates(interpolates: boolean): void;
  play(): void;
  pause(): void;
  seek(frame: number): void;
  /** To the time from the start of the range; to its end, where that comes before. */
  seekSeconds(seconds: number): void;
  /** Ends all requests. */
  cancel(): void;
  /** Lets time pass; below 0, none does. Returns what is to be shown now, if that is new; without a
   * frame if it cannot be decoded. */
  tick(seconds: number): { index: number; frame?: F } | undefined;
}
