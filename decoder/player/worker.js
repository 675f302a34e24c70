// Decodes on a thread of its own, one request after the other, and sends frames as typed arrays
// that move instead of being copied. Requests and replies are what decoding_thread.js says.
import { DecoderModule } from "./stream_decoder.js";

let decoder = null;
let reference = null;
let referenceError; // why it cannot be opened
let endIsChecked = false;

/** As a message, which loses the class of an error. */
function told(error) {
  return { text: error.message, code: error.code ?? 1, rule: error.rule ?? "" };
}

async function bytesOf(blob) {
  return new Uint8Array(await blob.arrayBuffer());
}

async function open({ wasm, stream, referenceStream }) {
  const module = await DecoderModule.create(await wasm.arrayBuffer());
  decoder = module.open(await bytesOf(stream));
  if (referenceStream) await openReference(module, referenceStream);
  const triangles = decoder.triangles();
  postMessage({ type: "opened", header: decoder.header, triangles }, [triangles.buffer]);
}

/** Without it, the stream is played all the same. */
async function openReference(module, stream) {
  try {
    const opened = module.open(await bytesOf(stream));
    opened.placeIn(decoder);
    reference = opened;
  } catch (error) {
    referenceError = told(error);
  }
}

/** Distances of the frame that was just decoded; what is wrong with the reference is no fault
 * of the stream. */
function compared(request, reply) {
  reply.referenceError = referenceError;
  if (!reference) return;
  try {
    reference.decode(request.frame);
    if (reference.hashDiffers()) reply.referenceError = told(reference.error());
    Object.assign(reply, decoder.distances(reference, request.spare?.distances));
  } catch (error) {
    reply.referenceError = told(error);
  }
}

/** The arrays of the frame that was just decoded. */
function drawn(request, reply) {
  const { coordinates, normals } = request.spare ?? {};
  reply.coordinates = decoder.coordinates(coordinates);
  reply.box = decoder.box();
  reply.centre = decoder.centre();
  if (request.withNormals) reply.normals = decoder.normals(normals);
  compared(request, reply);
}

function decodeFrame(request) {
  const { frame, order, checkOnly } = request;
  const reply = { type: "frame", frame, order, checkOnly };
  const start = performance.now();
  try {
    decoder.decode(frame);
    reply.ms = performance.now() - start;
    reply.differs = decoder.hashDiffers();
    reply.compared = decoder.comparedFrames();
    reply.crc = decoder.frameCrc();
    if (!checkOnly) drawn(request, reply);
    if (frame + 1 === decoder.header.num_frames && !endIsChecked && !reply.differs) {
      decoder.finish();
      endIsChecked = true;
    }
  } catch (error) {
    reply.error = told(error);
  }
  const arrays = [reply.coordinates, reply.normals, reply.distances];
  postMessage(reply, arrays.filter(Boolean).map((array) => array.buffer));
}

function sendEdges() {
  const edges = decoder.edges();
  postMessage({ type: "edges", edges }, [edges.buffer]);
}

onmessage = async ({ data }) => {
  try {
    if (data.type === "open") await open(data);
    if (data.type === "frame") decodeFrame(data);
    if (data.type === "edges") sendEdges();
  } catch (error) {
    postMessage({ type: "failed", error: told(error) });
  }
};
