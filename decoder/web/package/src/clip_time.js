// The time of clips (7.3 and 7.15 of the specification). Frame k of a clip is its pose
// k / frameRate seconds after its start, as keys of glTF are: n frames take n - 1 intervals, the
// first pose is that of the start and the last one that of the end. Where a clip repeats, its end
// is the start of the next turn. A clip whose last pose is the first, as loops have it, thus never
// halts.
//
// Times here are in intervals, from one frame to the next; loop is "repeat", "once" or "pingpong".
// Times of frames are rounded, as those of callers are: what is within kExact of a frame, or of the
// middle between two, counts as being there. common/files/clip_time.h has the same rules.

/** In intervals. */
export const kExact = 1e-6;

/** The time from the first to the last of so many frames, in seconds. */
export function clipSeconds(frames, frameRate) {
  return (frames - 1) / frameRate;
}

/** Where a clip of so many frames is after `time` intervals of playing: a place from 0, the first
 * frame, to frames - 1, the last. Between frames, it has a fraction. A time below 0 is 0. */
export function placeAt(time, frames, loop) {
  const last = frames - 1;
  if (!(time > 0) || last === 0) return 0;
  if (loop === "once") return exactPlace(Math.min(time, last));
  if (loop === "repeat") return exactPlace(time % last) % last;
  const place = exactPlace(time % (2 * last));
  return place > last ? 2 * last - place : place;
}

/** The place, or the frame if it is that near to one. */
export function exactPlace(place) {
  const frame = Math.round(place);
  return Math.abs(place - frame) < kExact ? frame : place;
}

/** The frame to show at a place, if it is one: the nearest, so that every frame is shown. */
export function nearestFrame(place) {
  return Math.floor(place + 0.5 + kExact);
}

/** When the frame of a step is exact, in intervals: the last of a turn of "repeat" at the same time
 * as the first of the next. */
export function timeOfStep(step, frames, loop) {
  return loop === "repeat" ? step - Math.floor(step / frames) : step;
}

/** When the nearest frame becomes the one of a step, in intervals. Steps count frames as they are
 * shown: all of them in each turn of "repeat"; forth and back without either end twice in
 * "pingpong". */
export function startOfStep(step, frames, loop) {
  const before = 0.5 + kExact;
  if (loop !== "repeat") return Math.max(0, step - before);
  const turn = Math.floor(step / frames);
  return Math.max(0, turn * (frames - 1) + Math.max(-kExact, step - turn * frames - before));
}
