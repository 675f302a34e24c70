// The page: a stream, a view of it, and the controls between them.
import { DecodingThread } from "./decoding_thread.js";
import { describedStream, takeBlob } from "./embedded.js";
import {
  digits, framesPerSecond, grouped, ofTime, roundedUp, showState, streamFacts,
} from "./facts.js";
import { FrameStates } from "./frame_states.js";
import { Playback } from "./playback.js";
import { Viewer, kRampCss } from "../viewer/viewer.js";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 4];
const kWireModes = ["off", "over", "alone"];
const kBytesAhead = 64e6;
const kCheckedAtOnce = 1e8; // vertices of all frames

const $ = (id) => document.getElementById(id);
// What the address asks for, as in player.html#frame=20&wire=over
const wanted = new URLSearchParams(location.hash.slice(1));

class Player {
  constructor() {
    this.wasm = takeBlob("#wasm");
    this.viewer = new Viewer($("view"));
    document.querySelector(".ramp").style.background = kRampCss;
    this.wire = 0;
    this.up = wanted.get("up") === "z" ? "z" : "y";
    this.flat = wanted.has("flat");
    this.addControls();
    this.resize();
  }

  /** Streams: blobs. */
  open(name, stream, referenceStream) {
    document.body.dataset.state = "loading";
    document.title = name;
    $("name").textContent = name;
    this.say("Decoding …");
    this.thread?.close();
    this.checker?.close();
    Object.assign(this, { playback: null, edgesRequested: false, errors: new Map(), checker: null });
    this.checkError = undefined;
    this.stream = stream;
    this.hasReference = referenceStream !== undefined;
    this.thread = new DecodingThread({
      opened: (reply) => this.opened(reply),
      frame: (reply) => this.frameArrived(reply),
      edges: ({ edges }) => this.edgesArrived(edges),
      failed: ({ error }) => this.fail(error.text),
    });
    this.thread.open(this.wasm, stream, referenceStream);
  }

  opened({ header, triangles }) {
    this.header = header;
    this.ms = { sum: 0, frames: 0 };
    this.largestDistance = 0;
    this.referenceDiffers = undefined; // what is said of it, once it is known
    this.paintsErrors = this.hasReference && wanted.get("errors") !== "off";
    this.viewer.setMesh(header.num_vertices, triangles);
    this.viewer.setUp(this.up);
    this.viewer.set({ flat: this.flat });
    this.states = new FrameStates(header.num_frames, $("strip"));
    this.showFacts();
    $("slider").max = header.num_frames - 1;
    $("slider").disabled = $("play").disabled = header.num_frames === 1;
    $("errors").hidden = !this.hasReference;
    this.playback = new Playback({
      numFrames: header.num_frames,
      framesPerSecond: framesPerSecond(header),
      framesAhead: Math.min(8, Math.max(1, Math.floor(kBytesAhead / (24 * header.num_vertices)))),
      request: (frame, order) =>
        this.thread.requestFrame({ frame, order, withNormals: !this.flat }),
      discard: (reply) => this.thread.recycle(reply),
    });
    this.playback.speed = Number($("speed").value);
    document.body.dataset.state = "ready"; // what is said ends with the first frame
    this.setWire(Math.max(0, kWireModes.indexOf(wanted.get("wire"))));
    this.showToggles();
    if (header.num_vertices * header.num_frames <= kCheckedAtOnce) this.checkAll();
    if (wanted.has("frame")) {
      this.seek(Number(wanted.get("frame")));
    } else {
      this.setPlaying(true);
    }
  }

  frameArrived(reply) {
    this.keepResult(reply);
    this.playback.receive(reply);
  }

  keepResult(reply) {
    this.states.receive(reply);
    if (reply.error) this.errors.set(reply.frame, reply.error);
    if (reply.ms === undefined) return;
    this.ms.sum += reply.ms;
    ++this.ms.frames;
  }

  edgesArrived(edges) {
    this.viewer.setEdges(edges);
  }

  /** The reply of the frame to be shown now. */
  show(reply) {
    if (reply.coordinates) {
      this.viewer.showFrame(reply);
      if (this.hasReference) this.showDeviation(reply);
      this.thread.recycle(reply);
    }
    this.say(reply.coordinates ? "" : `Frame ${reply.frame} cannot be decoded`);
    $("view").toggleAttribute("data-stale", !reply.coordinates);
    this.shownFrame = reply.frame;
  }

  /** Of a frame without distances, the surface has its own colour. */
  showDeviation({ frame, distances, largest = 0, rms, referenceError }) {
    if (distances && referenceError) {
      this.referenceDiffers ??=
        `Frame ${frame} of the reference does not fit its hash: ${referenceError.text}`;
    }
    $("deviation").hidden = !this.paintsErrors;
    $("deviation").toggleAttribute("data-missing", !distances);
    $("deviation-error").textContent = distances
      ? this.referenceDiffers ?? ""
      : `The reference cannot be decoded: ${referenceError.text}`;
    this.largestDistance = Math.max(this.largestDistance, largest);
    const { position_bits: bits, grid_log2_step: step } = this.header;
    const unit = 2 ** (bits - 1 + step); // of the animation, in the cube where it is drawn
    const most = roundedUp(this.largestDistance * unit);
    this.viewer.set({ deviationScale: this.paintsErrors && distances ? most / unit : 0 });
    if (!distances) return;
    $("deviation-most").textContent = digits(most);
    $("deviation-frame").textContent =
      `largest ${digits(largest * unit)}, RMS ${digits(rms * unit)}`;
  }

  showFacts() {
    $("fact-list").replaceChildren(...streamFacts(this.header, this.stream.size).flatMap(
      ([name, value]) => [["dt", name], ["dd", value]].map(([tag, text]) =>
        Object.assign(document.createElement(tag), { textContent: text }))));
  }

  /** What changes from frame to frame; for the time line, the frame that is asked for. */
  showNumbers() {
    const { frame } = this.playback;
    const last = this.header.num_frames - 1;
    const seconds = frame / framesPerSecond(this.header);
    $("slider").value = frame;
    $("clock").innerHTML = `${grouped(frame)} <small>/ ${grouped(last)}</small> · ${seconds.toFixed(2)} s`;
    this.states.draw();
    showState($("hash"), this.states, frame, {
      error: this.errors.get(frame), checkError: this.checkError,
    });
    const ms = this.ms.sum / Math.max(this.ms.frames, 1);
    $("fact-list").lastChild.textContent = `${ofTime(ms)} a frame`;
  }

  say(text) {
    $("message").textContent = text;
    $("message").hidden = text === "";
  }

  fail(text) {
    document.body.dataset.state = "failed";
    this.say(text);
    this.playback = null;
  }

  setPlaying(plays) {
    if (plays) {
      this.playback.play();
    } else {
      this.playback.pause();
    }
    const { playing } = this.playback;
    $("play").toggleAttribute("data-playing", playing);
    $("play").setAttribute("aria-label", playing ? "Pause" : "Play");
  }

  seek(frame) {
    this.playback.seek(Number.isInteger(frame) ? frame : 0);
  }

  step(frames) {
    this.setPlaying(false);
    const { num_frames: numFrames } = this.header;
    this.seek((this.playback.frame + frames + numFrames) % numFrames);
  }

  setWire(mode) {
    this.wire = mode;
    if (mode > 0 && !this.edgesRequested) {
      this.edgesRequested = true;
      this.thread.requestEdges();
    }
    this.viewer.set({ wire: kWireModes[mode] });
    this.showToggles();
  }

  setFlat(flat) {
    this.flat = flat;
    this.viewer.set({ flat });
    this.seek(this.playback.frame); // with normals, or without
    this.showToggles();
  }

  setUp(axis) {
    this.up = axis;
    this.viewer.setUp(axis);
    this.showToggles();
  }

  setPaintsErrors(paints) {
    this.paintsErrors = paints && this.hasReference;
    this.seek(this.playback.frame);
    this.showToggles();
  }

  changeSpeed(by) {
    const { options, selectedIndex } = $("speed");
    $("speed").selectedIndex = Math.min(Math.max(selectedIndex + by, 0), options.length - 1);
    this.playback.speed = Number($("speed").value);
  }

  /** Decodes all frames in order with a decoder of its own, so that playing goes on. */
  checkAll() {
    if (this.checker) return;
    this.checker = new DecodingThread({
      opened: () => this.checkFrom(0),
      frame: (reply) => {
        this.keepResult(reply);
        this.checkFrom(reply.frame + 1);
      },
      failed: ({ error }) => this.endCheck(error.text),
    });
    this.checkError = undefined;
    this.checker.open(this.wasm, this.stream);
    this.showToggles();
  }

  checkFrom(frame) {
    if (frame < this.header.num_frames) {
      this.checker.requestFrame({ frame, checkOnly: true });
    } else {
      this.states.isComplete = true;
      this.endCheck();
    }
  }

  /** error: what has stopped it, which need not stop playing. */
  endCheck(error) {
    this.checker.close();
    this.checker = null;
    this.checkError = error;
    this.showToggles();
  }

  showToggles() {
    $("wire").setAttribute("aria-pressed", this.wire > 0);
    $("flat").setAttribute("aria-pressed", this.flat);
    $("errors").setAttribute("aria-pressed", Boolean(this.paintsErrors));
    $("check").setAttribute("aria-pressed", Boolean(this.checker));
    $("up").textContent = `${this.up.toUpperCase()} up`;
  }

  addControls() {
    const actions = {
      play: () => this.setPlaying(!this.playback.playing),
      wire: () => this.setWire((this.wire + 1) % kWireModes.length),
      flat: () => this.setFlat(!this.flat),
      errors: () => this.setPaintsErrors(!this.paintsErrors),
      up: () => this.setUp(this.up === "y" ? "z" : "y"),
      home: () => this.viewer.lookAtAll(),
      check: () => this.checkAll(),
    };
    for (const [id, action] of Object.entries(actions)) $(id).onclick = action;
    $("speed").append(...kSpeeds.map((speed) => new Option(`${speed}×`, speed, speed === 1, speed === 1)));
    $("speed").onchange = () => this.changeSpeed(0);
    $("slider").oninput = () => this.seek(Number($("slider").value));
    const keys = {
      " ": actions.play, k: actions.play, w: actions.wire, n: actions.flat, e: actions.errors,
      u: actions.up, h: actions.home, c: actions.check,
      ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1),
      ArrowDown: () => this.step(-10), ArrowUp: () => this.step(10),
      Home: () => this.seek(0), End: () => this.seek(this.header.num_frames - 1),
      "[": () => this.changeSpeed(-1), "]": () => this.changeSpeed(1),
    };
    onkeydown = (event) => {
      const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
      if (!action || !this.playback || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      action();
    };
    onresize = () => this.resize();
    ondragover = (event) => event.preventDefault();
    ondrop = (event) => {
      event.preventDefault();
      const [file] = event.dataTransfer.files;
      if (file) this.open(file.name, file);
    };
  }

  resize() {
    this.viewer.resize();
    if (this.states) this.states.isDrawn = false;
  }

  tick(seconds) {
    if (this.playback) {
      const reply = this.playback.tick(seconds);
      if (reply) this.show(reply);
      this.showNumbers();
    }
    this.viewer.draw();
  }
}

function start() {
  const player = new Player();
  const description = describedStream();
  if (description) {
    const reference = document.querySelector(".reference") ? takeBlob(".reference") : undefined;
    player.open(description.name, takeBlob(".stream"), reference);
  } else {
    document.body.dataset.state = "empty";
    player.say("Drop an .rlpc stream here");
  }
  let before = performance.now();
  const loop = (now) => {
    player.tick(Math.min(Math.max(now - before, 0), 250) / 1000);
    before = now;
    requestAnimationFrame(loop);
  };
  requestAnimationFrame(loop);
  return player;
}

try {
  globalThis.player = start();
} catch (error) {
  document.body.dataset.state = "failed";
  $("message").textContent = `This browser cannot show the page: ${error.message}`;
  $("message").hidden = false;
}
