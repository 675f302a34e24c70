export { RlpcDecoder } from "./decoder.js";
export { RlpcError } from "./error.js";
export { Playback } from "./playback.js";
