// three.js: RLPCLoader loads a stream as an RLPCMesh, which plays it. three.d.ts describes both.
import { Loader } from "three";

import { RlpcDecoder } from "./index.js";
import { RLPCMesh } from "./rlpc_mesh.js";

export { RLPCMesh };

export class RLPCLoader extends Loader {
  constructor(manager) {
    super(manager);
    this.options = {};
  }

  /** Sets options of RlpcDecoder.open() and RLPCMesh. */
  setOptions(options) {
    this.options = { ...this.options, ...options };
    return this;
  }

  load(url, onLoad, onProgress, onError) {
    const address = this.manager.resolveURL((this.path ?? "") + url);
    this.manager.itemStart(address);
    this.open(address, onProgress).then((mesh) => {
      onLoad?.(mesh);
    }).catch((error) => {
      if (onError) onError(error);
      else console.error(error);
      this.manager.itemError(address);
    }).finally(() => this.manager.itemEnd(address));
  }

  /** Loads from any source of RlpcDecoder.open(), as loadAsync() does from a URL. */
  async open(source, onProgress) {
    const { material, normals, attributes, textures, gltfLoader, interpolate, frameMemory,
      ...options } = this.options;
    const decoder = await RlpcDecoder.open(source, {
      headers: this.requestHeader,
      credentials: this.withCredentials ? "include" : "same-origin",
      onProgress: onProgress && ((progress) =>
        onProgress({ lengthComputable: progress.total !== undefined, ...progress })),
      ...options,
    });
    return RLPCMesh.create(decoder, { material, attributes, textures, gltfLoader, interpolate,
      frameMemory, ...(normals === undefined ? {} : { normals }) });
  }
}
