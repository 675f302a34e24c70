// The time of clips (7.3 and 7.15 of the specification). Frame k of a clip is its pose k / frameRate
// seconds after its start, as keys of glTF are: n frames take n - 1 intervals, the first pose is that
// of the start and the last one that of the end. Where a clip repeats, its end is the start of the
// next turn. A clip whose last pose is the first, as loops have it, thus never halts.
//
// Times here are in intervals, from one frame to the next; loop is "repeat", "once" or "pingpong".

/** The time from the first to the last of so many frames, in seconds. */
export function clipSeconds(frames, frameRate) {
  return (frames - 1) / frameRate;
}

/** Where a clip of so many frames is after `time` intervals of playing, time >= 0: a place from 0,
 * the first frame, to frames - 1, the last. Between frames, it has a fraction. */
export function placeAt(time, frames, loop) {
  const last = frames - 1;
  if (last === 0) return 0;
  if (loop === "once") return Math.min(time, last);
  if (loop === "repeat") return time % last;
  const place = time % (2 * last);
  return place > last ? 2 * last - place : place;
}

/** The frame to show at a place, if it is one: the nearest, so that every frame is shown. */
export function nearestFrame(place) {
  return Math.floor(place + 0.5);
}

/** When the frame of a step is exact, in intervals: the last of a turn of "repeat" at the same time as
 * the first of the next. */
export function timeOfStep(step, frames, loop) {
  return loop === "repeat" ? step - Math.floor(step / frames) : step;
}

/** When the nearest frame becomes the one of a step, in intervals. Steps count frames as they are
 * shown: all of them in each turn of "repeat"; forth and back without either end twice in
 * "pingpong". */
export function startOfStep(step, frames, loop) {
  if (loop !== "repeat") return Math.max(0, step - 0.5);
  const turn = Math.floor(step / frames);
  return turn * (frames - 1) + Math.max(0, step - turn * frames - 0.5);
}
