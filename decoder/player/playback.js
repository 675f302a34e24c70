// Which frame is shown when. Every frame is decoded and none is left out: if decoding is too
// slow, time passes more slowly.

const kInFlight = 2; // one is decoded while another travels

export class Playback {
  /** request(frame, order) asks for a frame, which receive() gets; discard(reply) takes those
   * that are not wanted any more. */
  constructor({ numFrames, framesPerSecond, framesAhead, request, discard }) {
    Object.assign(this, { numFrames, framesPerSecond, request, discard });
    // Of a short animation, each other frame once: then the one that is shown comes again.
    this.framesAhead = Math.max(1, Math.min(framesAhead, numFrames - 1));
    this.speed = 1;
    this.playing = false;
    this.waiting = 0; // requests without a reply
    this.order = 0; // grows with each jump; older replies are out of date
    this.ready = new Map();
    this.seek(0);
  }

  /** The frame that is shown, or will be as soon as it is decoded. */
  get frame() {
    return this.current;
  }

  /** A still mesh does not play. */
  play() {
    this.playing = this.numFrames > 1;
    this.pump();
  }

  pause() {
    this.playing = false;
    this.time = this.current;
  }

  seek(frame) {
    this.current = Math.min(Math.max(frame, 0), this.numFrames - 1);
    this.time = this.current;
    this.isShown = false;
    this.next = this.current;
    ++this.order;
    for (const reply of this.ready.values()) this.discard(reply);
    this.ready.clear();
    this.pump();
  }

  /** Asks for frames: those to come, or only the one that is to be shown. */
  pump() {
    const ahead = this.playing ? this.framesAhead : this.isShown || this.next !== this.current ? 0 : 1;
    while (this.waiting < Math.min(kInFlight, ahead) && this.ready.size + this.waiting < ahead) {
      ++this.waiting;
      this.request(this.next, this.order);
      this.next = (this.next + 1) % this.numFrames;
    }
  }

  receive(reply) {
    --this.waiting;
    if (reply.order === this.order) {
      this.ready.set(reply.frame, reply);
    } else {
      this.discard(reply);
    }
    this.pump();
  }

  /** Lets time pass. Returns the reply to show now, if there is a new one. */
  tick(seconds) {
    let shown = this.isShown ? undefined : this.take(this.current);
    if (!this.isShown) return undefined;
    if (!this.playing) return shown;
    this.time += seconds * this.framesPerSecond * this.speed;
    while (Math.floor(this.time) > this.current) {
      const following = (this.current + 1) % this.numFrames;
      if (!this.ready.has(following)) {
        this.time = this.current + 0.999;
        break;
      }
      if (shown) this.discard(shown);
      shown = this.take(following);
      if (following < this.current) this.time -= this.numFrames;
      this.current = following;
    }
    this.pump();
    return shown;
  }

  take(frame) {
    const reply = this.ready.get(frame);
    this.ready.delete(frame);
    this.isShown = reply !== undefined;
    return reply;
  }
}
