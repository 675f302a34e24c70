// Words and numbers on the page.
import { State, kStateNames } from "./frame_states.js";

const kSizes = [[1, "B"], [1e3, "kB"], [1e6, "MB"], [1e9, "GB"], [1e12, "TB"]];

export function grouped(number) {
  return Math.round(number).toLocaleString("en").replaceAll(",", "\u2009");
}

/** Formats a number with `count` significant digits: "0.0123", "1230", "12". */
export function digits(value, count = 3) {
  return String(Number(value.toPrecision(count)));
}

export function sizeText(bytes) {
  const rounded = Number(bytes.toPrecision(3)); // first: 999 600 bytes are 1 MB, not 1000 kB
  const step = kSizes.findLast(([size]) => rounded >= size) ?? kSizes[0];
  return `${digits(rounded / step[0])} ${step[1]}`;
}

export function timeText(ms) {
  return ms < 10 ? `${digits(ms, 2)} ms` : `${grouped(ms)} ms`;
}

/** Returns [name, value] of a stream, from the info of its decoder. */
export function streamFacts({
  vertices, triangles, frames, frameRate, duration, bytes, profile, level,
}) {
  const rate = (8 * bytes) / (vertices * frames);
  const perSecond = +frameRate.toFixed(2);
  return [
    ["Mesh", `${grouped(vertices)} vertices, ${grouped(triangles)} triangles`],
    ["Frames", `${grouped(frames)} at ${perSecond} per second, ${duration.toFixed(1)} s`],
    ["Size", `${sizeText(bytes)}, floats have ${sizeText(12 * vertices * frames)}`],
    ["Rate", `${digits(rate)} bits per vertex and frame`],
    ["Profile", `${profile}, level ${level}`],
    ["Decoding", ""],
  ];
}

const kStateTexts = {
  [State.open]: "decoding",
  [State.decoded]: "not checked yet",
  [State.agrees]: "bit-exact",
  [State.differs]: "hash mismatch",
  [State.error]: "cannot be decoded",
};

/** Sets the text of an element. An unchanged text needs no new layout. */
function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** Shows the state. error: of the frame, or undefined; checkError: error that stopped the check of
 * all frames, or undefined. */
export function showState(element, states, frame, { error, checkError }) {
  const state = states.states[frame];
  element.dataset.state = kStateNames[state];
  const crc = states.crcs[frame].toString(16).padStart(8, "0");
  const has = state !== State.open && (state !== State.error || states.crcs[frame] !== 0);
  const [title, detail, count] = element.children;
  const hasNone = state === State.decoded && states.isComplete;
  setText(title, hasNone ? "no hash to check" : kStateTexts[state]);
  setText(detail, error?.message ?? (has ? `frame ${frame}, CRC ${crc}` : `frame ${frame}`));
  const counts = [
    [State.differs, "do not fit their hash"],
    [State.error, "cannot be decoded"],
  ].map(([state, text]) => [states.counts[state], text]).filter(([number]) => number > 0);
  const agree = grouped(states.counts[State.agrees]);
  setText(count, [
    `${agree} of ${grouped(states.states.length)} frames equal to their hash`,
    ...counts.map(([number, text]) => `${grouped(number)} ${text}`),
    ...(checkError ? [`Not all are checked: ${checkError}`] : []),
  ].join("\n"));
}

/** Returns the smallest of 1, 2, 5 x 10^k that is at least `value`. */
export function roundedUp(value) {
  if (!(value > 0)) return 0;
  const power = 10 ** Math.floor(Math.log10(value));
  return power * [1, 2, 5, 10].find((digit) => digit * power >= value * 0.999999);
}
