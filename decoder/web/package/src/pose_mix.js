// Frames that a mesh shows, and their weights, from actions of an AnimationMixer and from its own
// playback. A place between two frames shows both; missing frames are requested.
import { exactPlace, nearestFrame } from "./clip_time.js";

const kNothing = 1e-4; // weights below have no effect

/** Picture of one mesh. */
export class PoseMix {
  /** stream: a ShownStream; poses: ClipPose of each of its animations. */
  constructor(stream, poses) {
    Object.assign(this, { stream, poses });
    this.isComplete = true; // whether all wanted frames were ready, or cannot be decoded
    this.index = 0; // index of the frame with the largest weight
    this.interpolates = true;
    this.hasPoses = false; // whether actions have any weight
  }

  /** Fills a FrameMix, which stays empty if no frame is ready. base: the frame that the playback
   * shows, or undefined. */
  fill(mix, playback, base) {
    mix.clear();
    this.interpolates = playback.interpolates;
    this.isComplete = true;
    let sum = 0;
    let max = 0;
    for (let slot = 0; slot < this.poses.length; ++slot) {
      const pose = this.poses[slot];
      if (pose.weight < kNothing) {
        if (pose.isActive) this.end(pose);
        continue;
      }
      sum += pose.weight;
      const index = this.addPose(mix, pose, this.stream.slots[slot]);
      if (index === undefined || pose.weight <= max) continue;
      this.index = index;
      ({ weight: max } = pose);
    }
    this.hasPoses = sum > 0;
    const rest = 1 - sum;
    if (rest >= kNothing) {
      this.isComplete &&= playback.isReady;
      const index = base && this.addBase(mix, playback, base, rest);
      if (base && rest > max) this.index = index;
    }
    mix.normalise();
  }

  /** Adds the frames of the playback. Returns the index of the nearest one. */
  addBase(mix, playback, base, weight) {
    const { following, fraction } = playback;
    if (!following || fraction === 0) {
      mix.add(base, weight);
      return base.index;
    }
    mix.add(base, weight * (1 - fraction));
    mix.add(following, weight * fraction);
    return fraction < 0.5 ? base.index : following.index;
  }

  end(pose) {
    pose.isActive = false;
    pose.held = undefined;
    this.stream.frames.dismiss(pose);
  }

  /** Adds the frames of a pose. Returns the index of the nearest one; undefined if none. */
  addPose(mix, pose, { first, count }) {
    const { frames } = this.stream;
    const { weight } = pose;
    const place = exactPlace(Math.min(Math.max(pose.place, 0), count - 1));
    const at = this.interpolates ? Math.floor(place) : nearestFrame(place);
    const fraction = this.interpolates ? place - at : 0;
    const index = first + at;
    const before = frames.get(index);
    const after = fraction > 0 ? frames.get(index + 1) : undefined;
    this.ask(pose, { first, count }, at, before, fraction > 0 && !after);
    if (before) {
      mix.add(before, after ? weight * (1 - fraction) : weight);
      if (after) mix.add(after, weight * fraction);
      pose.held = index;
      return after && fraction >= 0.5 ? index + 1 : index;
    }
    const instead = after ?? (pose.held === undefined ? undefined : frames.get(pose.held));
    if (instead) mix.add(instead, weight);
    return instead?.index;
  }

  /** Requests the first missing frame or, if none is missing, the next ones. */
  ask(pose, { first, count }, at, before, needsNext) {
    const { frames, ahead } = this.stream;
    const backwards = pose.isActive && (pose.place < pose.before || pose.goesBack &&
      pose.place === pose.before);
    pose.goesBack = backwards;
    pose.before = pose.place;
    pose.isActive = true;
    if (!before && this.want(pose, first + at)) return;
    if (needsNext && this.want(pose, first + at + 1)) return;
    for (let i = 1; i <= Math.min(ahead, count - 1); ++i) {
      const index = first + (at + (backwards ? count - i : i + 1)) % count;
      if (frames.has(index)) continue;
      frames.want(pose, index);
      return;
    }
  }

  /** Requests a frame for this picture; returns false if it cannot be decoded. */
  want(pose, index) {
    const { frames } = this.stream;
    if (frames.hasFailed(index)) return false;
    this.isComplete = false;
    frames.want(pose, index);
    return true;
  }
}
