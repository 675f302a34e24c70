// Page: a stream, its view, and controls.
import { Playback } from "../package/src/index.js";
import { Viewer, kRampCss } from "../viewer/viewer.js";
import { addControls, kWireModes, showClips, showToggles } from "./controls.js";
import { DeviationCard } from "./deviation_card.js";
import { embeddedDecoder, embeddedStream } from "./embedded.js";
import { grouped, sizeText, timeText, showState, streamFacts } from "./facts.js";
import { FrameStates } from "./frame_states.js";
import { StreamSession } from "./stream_session.js";

const kBytesAhead = 64e6;
const kCheckedAtOnce = 1e8; // vertices of all frames

const $ = (id) => document.getElementById(id);
// Request in the address, as in player.html?src=walk.rlpc#frame=20&wire=over
const wanted = new URLSearchParams(location.hash.slice(1));
const source = new URLSearchParams(location.search).get("src");

class Player {
  constructor() {
    this.decoderOptions = embeddedDecoder();
    this.viewer = new Viewer($("view"));
    document.querySelector(".ramp").style.background = kRampCss;
    this.wire = 0;
    this.up = wanted.get("up") === "z" ? "z" : "y";
    this.flat = this.wantsFlat = wanted.has("flat");
    this.viewer.set({ plain: wanted.has("plain") });
    addControls(this);
    this.resize();
  }

  /** Opens a stream. stream, reference: blobs or URLs. */
  async open(name, stream, reference) {
    document.body.dataset.state = "loading";
    document.title = name;
    $("name").textContent = name;
    this.say("Decoding …");
    this.showProgress();
    this.sayProblems([]);
    this.playback?.cancel();
    this.session?.close();
    Object.assign(this, { playback: null, session: null, edges: null, errors: new Map(),
      isChecking: false, checkError: undefined, shownFrame: undefined });
    const opening = (this.opening = {}); // replaced if another is opened meanwhile
    try {
      const options = { ...await this.decoderOptions(),
        onProgress: (progress) => opening === this.opening && this.showProgress(progress) };
      const session = await StreamSession.open(stream, reference, options);
      if (opening !== this.opening) return session.close();
      await this.opened(session);
    } catch (error) {
      if (opening === this.opening) this.fail(error.message);
    }
    return undefined;
  }

  async opened(session) {
    this.session = session;
    this.info = session.decoder.info;
    const { frames, frameRate } = this.info;
    this.ms = { sum: 0, frames: 0 };
    this.deviation = new DeviationCard(session.decoder);
    this.deviation.isShown = session.hasReference && wanted.get("errors") !== "off";
    this.states = new FrameStates(frames, $("strip"));
    this.viewer.setUp(this.up);
    this.showFacts();
    showClips(session.decoder.clips);
    $("errors").hidden = !session.hasReference;
    const first = Number(wanted.get("frame") ?? 0);
    await this.showCoarse(Number.isInteger(first) && first >= 0 && first < frames ? first : 0);
    if (session !== this.session) return;
    const mesh = await session.mesh();
    if (session !== this.session) return;
    this.prepare(mesh);
    this.playback = new Playback({
      frames, frameRate,
      ahead: Math.min(8, Math.max(1, Math.floor(kBytesAhead / (24 * mesh.numVertices)))),
      request: (index, signal) => this.request(index, signal),
      discard: (frame) => session.recycle(frame),
      failed: (error, index) => this.keepResult(index, { error }),
    });
    this.playback.setSpeed(Number($("speed").value));
    document.body.dataset.state = "ready"; // the message ends with the first frame
    this.setWire(Math.max(0, kWireModes.indexOf(wanted.get("wire"))));
    this.chooseClip(session.decoder.clips.find(({ name }) => name === wanted.get("clip")));
    this.showToggles();
    if (wanted.has("frame")) this.seek(first);
    else this.setPlaying(true);
    this.loadRest(session);
  }

  /** Shows a coarse mesh until the frame of the whole mesh arrives. */
  async showCoarse(index) {
    const { session } = this;
    const coarse = await session.coarseFrame(index);
    if (!coarse || this.session !== session) return; // another stream has taken its place
    this.viewer.setMesh(coarse.info.vertices, coarse.indices);
    const box = Object.values(session.boxOf(coarse.frame)).flat();
    this.viewer.showFrame({ ...coarse.frame, box });
    this.coarseVertices = coarse.info.vertices;
    this.say("");
  }

  /** Prepares the first frame of the whole mesh. */
  prepare(mesh) {
    this.mesh = mesh;
    this.isPrepared = true;
    this.flat = this.wantsFlat || Boolean(mesh.isFlat); // as meshes without normals in glTF
    this.viewer.set({ flat: this.flat });
    this.sayProblems(mesh.problems);
    $("plain").hidden = !mesh.look;
  }

  /** Loads what the first frames do not need, and checks all frames. */
  async loadRest(session) {
    try {
      await session.download();
    } catch (error) {
      if (session === this.session) this.say(error.message);
      return;
    }
    const { vertices, frames } = this.info;
    if (session === this.session && vertices * frames <= kCheckedAtOnce) this.checkAll();
  }

  async request(index, signal) {
    await undefined; // does not load what a seek replaces at once
    signal.throwIfAborted();
    const frame = await this.session.frame(index, { normals: !this.flat, signal });
    this.keepResult(index, frame);
    return frame;
  }

  keepResult(index, result) {
    this.states.receive(index, result);
    if (result.error) this.errors.set(index, result.error);
    if (result.milliseconds === undefined) return;
    this.ms.sum += result.milliseconds;
    ++this.ms.frames;
  }

  /** Shows the frame that Playback returns. */
  show({ index, frame }) {
    if (frame) {
      if (this.isPrepared) this.showMesh();
      this.viewer.showFrame(frame);
      if (this.session.hasReference) this.deviation.show(frame, this.viewer);
      this.session.recycle(frame);
    }
    this.say(frame ? "" : `Frame ${index} cannot be decoded`);
    $("view").toggleAttribute("data-stale", !frame);
    this.shownFrame = index;
  }

  showMesh() {
    const { numVertices, triangles, look, materials } = this.mesh;
    this.viewer.setMesh(numVertices, triangles, look);
    if (materials) this.viewer.setMaterials(materials);
    if (this.edges) this.viewer.setEdges(this.edges);
    this.isPrepared = false;
  }

  showFacts() {
    $("fact-list").replaceChildren(...streamFacts(this.info).flatMap(
      ([name, value]) => [["dt", name], ["dd", value]].map(([tag, text]) =>
        Object.assign(document.createElement(tag), { textContent: text }))));
  }

  /** Shows the progress of a stream from a server. */
  showProgress({ loaded = 0, total = loaded } = {}) {
    const isWhole = loaded >= total;
    $("progress").hidden = isWhole;
    $("progress").style.width = `${(100 * loaded) / Math.max(total, 1)}%`;
    if (!isWhole && document.body.dataset.state === "loading") {
      this.say(`Loading … ${sizeText(loaded)} of ${sizeText(total)}`);
    }
  }

  /** Shows the numbers of a frame; on the time line, the requested frame. */
  showNumbers() {
    const { frame, first, count, frameRate } = this.playback;
    const seconds = ((frame - first) / frameRate).toFixed(2);
    $("slider").value = frame;
    $("clock").innerHTML =
      `${grouped(frame - first)} <small>/ ${grouped(count - 1)}</small> · ${seconds} s`;
    this.states.draw(first, count);
    showState($("hash"), this.states, frame, {
      error: this.errors.get(frame), checkError: this.checkError,
    });
    const { sum, frames } = this.ms;
    $("fact-list").lastChild.textContent = frames > 0 ? `${timeText(sum / frames)} a frame` : "";
  }

  say(text) {
    $("message").textContent = text;
    $("message").hidden = text === "";
  }

  /** Lists the parts of the stream that are not shown. */
  sayProblems(problems) {
    $("problems").textContent = problems.join("\n");
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
    this.playback.seek(Number.isInteger(frame) ? frame : this.playback.first);
  }

  /** Plays a clip in a loop; undefined: all frames. */
  chooseClip(clip) {
    const { firstFrame: first, frames: count } =
      clip ?? { firstFrame: 0, frames: this.info.frames };
    $("clip").value = clip ? this.session.decoder.clips.indexOf(clip) : "";
    this.playback.setRange(first, count);
    Object.assign($("slider"), { min: first, max: first + count - 1 });
    $("slider").disabled = $("play").disabled = count === 1;
    this.states.isDrawn = false;
    this.setPlaying(this.playback.playing);
  }

  step(frames) {
    this.setPlaying(false);
    const { frame, first, count } = this.playback;
    this.seek(first + ((((frame - first + frames) % count) + count) % count));
  }

  async setWire(mode) {
    this.wire = mode;
    this.viewer.set({ wire: kWireModes[mode] });
    this.showToggles();
    const { session } = this;
    if (mode === 0 || this.edges) return;
    const edges = await session.edges();
    if (session !== this.session) return;
    this.edges = edges;
    if (!this.isPrepared) this.viewer.setEdges(edges);
  }

  setPlain(plain) {
    this.viewer.set({ plain });
    this.showToggles();
  }

  setFlat(flat) {
    this.flat = this.wantsFlat = flat;
    this.viewer.set({ flat });
    this.seek(this.playback.frame); // normals may have changed
    this.showToggles();
  }

  setUp(axis) {
    this.up = axis;
    this.viewer.setUp(axis);
    this.showToggles();
  }

  setPaintsErrors(paints) {
    this.deviation.isShown = paints && this.session.hasReference;
    this.seek(this.playback.frame);
    this.showToggles();
  }

  setSpeed(speed) {
    this.playback?.setSpeed(speed);
  }

  /** Checks all frames. Its errors do not stop playback. */
  async checkAll() {
    if (this.isChecking) return;
    const { session } = this;
    this.isChecking = true;
    this.checkError = undefined;
    this.showToggles();
    let error;
    try {
      const isWhole = await session.checkAll((index, result) => {
        if (session === this.session) this.keepResult(index, result);
      });
      if (session === this.session) this.states.isComplete ||= isWhole;
    } catch (failure) {
      error = failure.message;
    }
    if (session !== this.session) return;
    this.isChecking = false;
    this.checkError = error;
    this.showToggles();
  }

  showToggles() {
    showToggles(this);
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

/** Decodes a name, which may have a literal %. */
function decoded(name) {
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

function start() {
  const player = new Player();
  const embedded = embeddedStream();
  if (embedded) {
    player.open(embedded.name, embedded.stream, embedded.reference);
  } else if (source) {
    const name = decoded(new URL(source, location.href).pathname.split("/").at(-1));
    player.open(name || source, source, wanted.get("reference") ?? undefined);
  } else {
    document.body.dataset.state = "empty";
    player.say("Drop an .rlpc stream here");
  }
  let before = performance.now();
  const loop = (now) => {
    requestAnimationFrame(loop);
    player.tick(Math.min(Math.max(now - before, 0), 250) / 1000);
    before = now;
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
