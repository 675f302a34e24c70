// Clips as AnimationClips of three.js, for its AnimationMixer.
//
// A track has two numbers: the place in the clip, in frames, and 1. The mixer blends them with the
// state of the mesh without actions, 0 and 0: for the weight w of the action, it sets w * place and
// w, from which the mesh computes both. Each clip is a separate property, so that the places of two
// clips are never blended; the mesh blends their positions.
import { AnimationClip, LinearInterpolant, VectorKeyframeTrack } from "three";

const kEqualRates = 1e-4; // relative: times of keys are 32-bit floats

/** Place of one mesh in a clip, as AnimationMixer sets it. */
export class ClipPose {
  constructor() {
    this.weighted = 0; // weight * place
    this.weight = 0; // 0 to 1
    this.failed = () => {};
  }

  /** Place in frames from the start of the clip. */
  get place() {
    return this.weighted / this.weight;
  }

  /** Returns the state without actions to AnimationMixer. */
  toArray(array, offset) {
    array[offset] = 0;
    array[offset + 1] = 0;
  }

  fromArray(array, offset) {
    this.weighted = array[offset];
    this.weight = array[offset + 1];
  }
}

/** Returns the name of the property of a mesh for an animation. */
export function poseName(slot) {
  return `rlpcPose${slot}`;
}

/** Interpolates places without the rounding of times, which are 32-bit floats. */
class PlaceInterpolant extends LinearInterpolant {
  constructor(times, values, result, frameRate) {
    super(times, values, 2, result ?? undefined);
    this.frameRate = frameRate;
  }

  evaluate(time) {
    const { parameterPositions: times, sampleValues: values, resultBuffer } = this;
    const last = times.length - 1;
    const [first] = values;
    const end = values[2 * last];
    const rate = last > 0 ? (end - first) / (times[last] - times[0]) : this.frameRate;
    const isOurs = Math.abs(rate / this.frameRate - 1) < kEqualRates; // not stretched
    const place = first + (time - times[0]) * (isOurs ? this.frameRate : rate);
    resultBuffer[0] = Math.min(Math.max(place, first), end);
    resultBuffer[1] = 1;
    return resultBuffer;
  }
}

const number = new Float32Array(1);
const bits = new Uint32Array(number.buffer);

/** Returns the time of a key: the first 32-bit float not before it, for callers that multiply it by
 * the frame rate, as AnimationUtils.subclip() does. */
function timeOfKey(seconds) {
  number[0] = seconds;
  if (number[0] < seconds) ++bits[0];
  return number[0];
}

/** Makes an AnimationClip. clip: { name, frames }; duration: seconds. */
export function clipAnimation(clip, slot, frameRate, duration) {
  const { name, frames } = clip;
  const times = Float32Array.from({ length: frames }, (_, i) => timeOfKey(i / frameRate));
  const values = Float32Array.from({ length: 2 * frames }, (_, i) => (i % 2 === 0 ? i / 2 : 1));
  const track = new VectorKeyframeTrack(`.${poseName(slot)}`, times, values);
  track.createInterpolant = function createInterpolant(result) {
    return new PlaceInterpolant(this.times, this.values, result, frameRate);
  };
  return new AnimationClip(name, duration, [track]);
}
