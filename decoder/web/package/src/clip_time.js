// Clip time (7.3 and 7.15 of the specification). Frame k of a clip is due k / frameRate seconds
// after its start, like keys of glTF: a clip of n frames lasts n - 1 intervals, with the first pose
// at its start and the last one at its end. When a clip repeats, its end is the start of the next
// pass. A loop whose last pose equals its first thus never pauses.
//
// Times here are in intervals, from one frame to the next; loop is "repeat", "once" or "pingpong".
// Times within kExact of a frame, or of the middle between two frames, are rounded to it.
// common/files/clip_time.h has the same rules.

/** Tolerance in intervals. */
export const kExact = 1e-6;

/** Returns the seconds from the first to the last of `frames` frames. */
export function clipSeconds(frames, frameRate) {
  return (frames - 1) / frameRate;
}

/** Returns the place in a clip after `time` intervals: from 0, the first frame, to frames - 1, the
 * last; with a fraction between frames. Negative times count as 0. */
export function placeAt(time, frames, loop) {
  const last = frames - 1;
  if (!(time > 0) || last === 0) return 0;
  if (loop === "once") return exactPlace(Math.min(time, last));
  if (loop === "repeat") return exactPlace(time % last) % last;
  const place = exactPlace(time % (2 * last));
  return place > last ? 2 * last - place : place;
}

/** Returns a place, or the frame within kExact of it. */
export function exactPlace(place) {
  const frame = Math.round(place);
  return Math.abs(place - frame) < kExact ? frame : place;
}

/** Returns the nearest frame to a place, which is shown without interpolation. */
export function nearestFrame(place) {
  return Math.floor(place + 0.5 + kExact);
}

/** Returns the time at which the frame of a step is exact, in intervals. With "repeat", the last
 * frame of a pass has the time of the first frame of the next. */
export function timeOfStep(step, frames, loop) {
  return loop === "repeat" ? step - Math.floor(step / frames) : step;
}

/** Returns the time at which the frame of a step becomes the nearest, in intervals. Steps count
 * frames as they are shown: all of them in each pass of "repeat"; back and forth, each end once, in
 * "pingpong". */
export function startOfStep(step, frames, loop) {
  const before = 0.5 + kExact;
  if (loop !== "repeat") return Math.max(0, step - before);
  const turn = Math.floor(step / frames);
  return Math.max(0, turn * (frames - 1) + Math.max(-kExact, step - turn * frames - before));
}
