// Schedules frames. Every frame is decoded and shown: if decoding is too slow, time passes more
// slowly.
//
// Frames are counted in steps from the start of the range that is played, so that loops and
// backward playback need no special cases; clip_time.js defines when a step begins.
//
// If it interpolates, a step begins where its frame is exact; until the next one begins,
// `following` and `fraction` define the picture. Time then waits at a frame until the next is
// ready.
import {
  clipSeconds, exactPlace, kExact, nearestFrame, placeAt, startOfStep, timeOfStep,
} from "./clip_time.js";
import { aborted } from "./error.js";

const kInFlight = 2; // one is decoded while another is transferred
const kShortOf = 0.001; // intervals before a frame at which time waits
const kMinAhead = 2; // if it interpolates: the next frame, and the one after it

export const kLoops = ["repeat", "once", "pingpong"];

export class Playback {
  /** request(index, signal) returns a promise of a frame; peek(index) the frame, if it is ready;
   * discard(frame) takes frames that are no longer needed; failed(error, index) is called for
   * frames that fail, without which playback continues. */
  constructor({ frames, frameRate, ahead = 4, interpolates = false, request,
    peek = () => undefined, discard = () => {}, failed = () => {} }) {
    Object.assign(this, { frames, frameRate, ahead, interpolates, request, peek, discard, failed });
    this.speed = 1; // negative: backwards
    this.loop = "repeat";
    this.playing = false;
    this.finished = () => {}; // called at the end of a range that is played once
    this.looped = () => {}; // called where a range restarts or reverses
    this.arrived = () => {}; // called when a frame, or its error, arrives
    this.waiting = 0; // requests without a reply
    this.ready = new Map(); // { index, frame } by step
    this.setRange(0, frames);
  }

  /** Plays these frames; shows the first one, or the last one if it plays backwards. */
  setRange(first, count) {
    this.first = first;
    this.count = count;
    this.seek(this.speed < 0 ? first + count - 1 : first);
  }

  setSpeed(speed) {
    if (!Number.isFinite(speed)) throw new RangeError("the speed is a finite number");
    const turns = speed < 0 !== this.speed < 0;
    const { seconds } = this;
    this.speed = speed;
    if (turns) this.seekSeconds(seconds);
  }

  setLoop(loop) {
    if (!kLoops.includes(loop)) throw new RangeError(`loop is one of ${kLoops.join(", ")}`);
    const { seconds } = this;
    this.loop = loop;
    this.seekSeconds(seconds);
  }

  /** Sets whether `following` and `fraction` are used. */
  setInterpolates(interpolates) {
    if (interpolates === this.interpolates) return;
    const { seconds } = this;
    this.interpolates = interpolates;
    this.seekSeconds(seconds);
  }

  /** The frame that is shown, or will be as soon as it is decoded. */
  get frame() {
    return this.indexAt(this.current);
  }

  /** Seconds from the start of the range to its end. */
  get duration() {
    return clipSeconds(this.count, this.frameRate);
  }

  /** Seconds from the start of the range, also between frames. */
  get seconds() {
    const { count, current, loop, time } = this;
    // The end of a pass is the start of the next; the frame decides between them.
    const place = loop === "repeat" ? time - Math.floor(current / count) * (count - 1)
      : placeAt(time, count, loop);
    return (this.speed < 0 ? count - 1 - place : place) / this.frameRate;
  }

  /** Returns the index of the frame of a step. */
  indexAt(step) {
    const { count, loop } = this;
    let place = step;
    if (loop === "repeat") place = step % count;
    if (loop === "once") place = Math.min(step, count - 1);
    if (loop === "pingpong" && count > 1) {
      place = step % (2 * count - 2);
      if (place >= count) place = 2 * count - 2 - place;
    }
    if (count === 1) place = 0;
    return this.first + (this.speed < 0 ? count - 1 - place : place);
  }

  /** Whether the frames to show are ready, so that tick() need not wait. */
  get isReady() {
    return (this.isShown || this.ready.has(this.current)) &&
      (!this.needsNext || this.ready.has(this.current + 1));
  }

  /** Whether the time is between two frames, both of which are needed. */
  get needsNext() {
    return this.interpolates && !this.isAtEnd && this.passed > kExact;
  }

  /** Intervals since the step began. */
  get passed() {
    return this.time - timeOfStep(this.current, this.count, this.loop);
  }

  /** The frame after the one that is shown, if it interpolates and the frame is ready. */
  get following() {
    if (!this.interpolates || !this.isShown || this.isAtEnd) return undefined;
    return this.ready.get(this.current + 1)?.frame;
  }

  /** Position between the shown and the following frame, from 0 to 1. */
  get fraction() {
    return Math.min(Math.max(exactPlace(this.passed), 0), 1);
  }

  /** Whether the last frame is shown, and none follows. */
  get isAtEnd() {
    return this.loop === "once" && this.current >= this.count - 1;
  }

  get hasEnded() {
    return this.isAtEnd && exactPlace(this.time) >= this.count - 1;
  }

  /** Plays, unless the mesh is still. Restarts if it has ended. */
  play() {
    this.playing = this.count > 1;
    if (this.playing && this.hasEnded) this.setRange(this.first, this.count);
    this.pump();
  }

  pause() {
    this.playing = false;
  }

  /** Seeks to a frame of the sequence, or the nearest one in the range. */
  seek(index) {
    this.goTo(index - this.first);
  }

  /** Seeks to a time from the start of the range, or the nearest one within it. */
  seekSeconds(seconds) {
    this.goTo(seconds * this.frameRate);
  }

  goTo(wanted) {
    if (Number.isNaN(wanted)) throw new RangeError("a time is a number");
    const last = this.count - 1;
    const place = Math.min(Math.max(wanted, 0), last);
    this.time = exactPlace(this.speed < 0 ? last - place : place); // in intervals
    this.current = this.interpolates // the step
      ? Math.floor(this.time + kExact) : nearestFrame(this.time);
    this.next = this.current; // next step to request
    this.isShown = false;
    this.cancel();
    this.pump();
  }

  /** Ends all requests. */
  cancel() {
    this.controller?.abort(aborted());
    this.controller = new AbortController();
    for (const { frame } of this.ready.values()) if (frame) this.discard(frame);
    this.ready.clear();
    this.waiting = 0;
  }

  /** Number of frames to hold, including requested ones. A short animation needs each other frame
   * once, before the shown one recurs. */
  get wanted() {
    if (!this.playing) return (this.isShown ? 0 : 1) + (this.needsNext ? 1 : 0);
    const ahead = this.interpolates ? Math.max(kMinAhead, this.ahead) + this.turnsWithin(this.ahead)
      : Math.max(1, Math.min(this.ahead, this.count - 1));
    if (this.loop !== "once") return ahead;
    return Math.min(ahead, this.ready.size + this.waiting + this.count - this.next);
  }

  /** Returns 1 if a pass of "repeat" ends within `steps` steps: two steps then begin together. */
  turnsWithin(steps) {
    const { count, current, loop } = this;
    return loop === "repeat" && current % count + Math.max(kMinAhead, steps) >= count ? 1 : 0;
  }

  pump() {
    const { wanted } = this;
    while (this.waiting < Math.min(kInFlight, wanted) &&
           this.ready.size + this.waiting < wanted) {
      this.ask(this.next++);
    }
  }

  ask(step) {
    const index = this.indexAt(step);
    const frame = this.peek(index);
    if (frame) this.ready.set(step, { index, frame });
    else this.wait(step, index);
  }

  async wait(step, index) {
    ++this.waiting;
    const { controller } = this;
    let frame;
    try {
      frame = await this.request(index, controller.signal);
    } catch (error) {
      if (controller === this.controller) this.failed(error, index);
    }
    if (controller !== this.controller) { // out of date
      if (frame) this.discard(frame);
      return;
    }
    --this.waiting;
    this.ready.set(step, { index, frame });
    this.arrived();
    this.pump();
  }

  /** Advances time; not for negative seconds. Returns { index, frame } to show now, if it is new;
   * without a frame if it cannot be decoded. */
  tick(seconds) {
    if (!Number.isFinite(seconds)) {
      throw new RangeError("the time that has passed is a finite number");
    }
    let shown;
    if (!this.isShown) {
      if (!this.playing && !this.isReady) return undefined;
      shown = this.take(this.current);
      this.pump();
      return shown;
    }
    if (!this.playing) return undefined;
    this.time += this.intervalsIn(Math.max(0, seconds));
    while (!this.isAtEnd) {
      const next = this.startOf(this.current + 1);
      if (next > this.time) break;
      this.pump();
      if (!this.ready.has(this.current + 1)) {
        this.time = next - kShortOf;
        break;
      }
      if (shown?.frame) this.discard(shown.frame);
      shown = this.take(++this.current);
      if (this.isAtTurn) this.looped();
    }
    this.pump();
    const waits = this.interpolates && !this.isAtEnd && !this.ready.has(this.current + 1);
    if (waits) this.time = Math.min(this.time, timeOfStep(this.current, this.count, this.loop));
    if (this.hasEnded) {
      this.time = this.count - 1;
      this.pause();
      this.finished();
    }
    return shown;
  }

  /** Returns the intervals to play in `seconds` seconds. After a long pause, as of a hidden page,
   * only the last pass is played. */
  intervalsIn(seconds) {
    const { count, frameRate, loop, speed } = this;
    const intervals = Math.min(seconds * frameRate * Math.abs(speed), Number.MAX_SAFE_INTEGER);
    if (loop === "once") return intervals;
    const turn = (loop === "repeat" ? 1 : 2) * (count - 1);
    return intervals < 2 * turn ? intervals : turn + intervals % turn;
  }

  startOf(step) {
    return this.interpolates ? timeOfStep(step, this.count, this.loop) - kExact
      : startOfStep(step, this.count, this.loop);
  }

  /** Whether the step is the first one of another pass. */
  get isAtTurn() {
    if (this.loop === "once") return false;
    return this.current % (this.loop === "repeat" ? this.count : this.count - 1) === 0;
  }

  take(step) {
    const reply = this.ready.get(step);
    this.ready.delete(step);
    this.isShown = reply !== undefined;
    return reply;
  }
}
