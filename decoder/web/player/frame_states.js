// State of each frame: whether it was decoded, and matches the hashes of the stream.

export const State = { open: 0, decoded: 1, agrees: 2, differs: 3, error: 4 };
export const kStateNames = ["open", "decoded", "agrees", "differs", "error"];
const kHashRule = "R-HSH-02"; // broken by a frame that does not match its hash
const kColours = ["#0000", "#6d7a8a", "#55c58a", "#ef6a5b", "#ef6a5b"];

export class FrameStates {
  constructor(numFrames, canvas) {
    this.states = new Uint8Array(numFrames);
    this.counts = [numFrames, 0, 0, 0, 0]; // number of frames in each state
    this.crcs = new Uint32Array(numFrames);
    this.canvas = canvas;
    this.isDrawn = false;
    this.isComplete = false; // whether every frame was decoded in order
  }

  /** Sets the state of frames first <= frame < end. */
  set(first, end, state) {
    for (let frame = first; frame < end; ++frame) {
      --this.counts[this.states[frame]];
      ++this.counts[state];
      this.states[frame] = state;
    }
  }

  /** Receives a frame that was decoded, perhaps with an error, or only its error. */
  receive(frame, { error, comparedFrames: compared, crc }) {
    this.isDrawn = false;
    const differs = error?.rule === kHashRule;
    if (crc === undefined) {
      this.set(frame, frame + 1, State.error);
      return;
    }
    this.crcs[frame] = crc;
    if (compared > 0) {
      this.set(frame + 1 - compared, frame + 1, differs ? State.differs : State.agrees);
    } else if (this.states[frame] === State.open) {
      this.set(frame, frame + 1, State.decoded);
    }
    if (error && !differs) this.set(frame, frame + 1, State.error); // error after the last frame
  }

  /** Draws a strip of `count` frames, as wide as the time line; a pixel shows the worst of its
   * frames. */
  draw(from, count) {
    const width = Math.round(this.canvas.clientWidth * devicePixelRatio);
    if (this.isDrawn && this.canvas.width === width) return;
    this.isDrawn = true;
    this.canvas.width = width;
    this.canvas.height = 1;
    const context = this.canvas.getContext("2d");
    const { states } = this;
    for (let x = 0; x < width; ++x) {
      const first = from + Math.floor((x * count) / width);
      const last = Math.max(first + 1, from + Math.floor(((x + 1) * count) / width));
      let min = State.error;
      let max = State.open;
      for (let f = first; f < last; ++f) {
        min = Math.min(min, states[f]);
        max = Math.max(max, states[f]);
      }
      context.fillStyle = kColours[max >= State.differs ? max : min];
      context.fillRect(x, 0, 1, 1);
    }
  }
}
