// Decodes on a thread of its own, one request after the other, and sends frames as typed arrays
// that move instead of being copied. Requests and replies are what decoding_thread.js says.
import { DecoderModule } from "./stream_decoder.js";

let decoder = null;
let reference = null;
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
  if (referenceStream) {
    reference = module.open(await bytesOf(referenceStream));
    reference.placeIn(decoder);
  }
  const triangles = decoder.triangles();
  postMessage({ type: "opened", header: decoder.header, triangles }, [triangles.buffer]);
}

/** The arrays of the frame that was just decoded. */
function drawn(request, reply) {
  const { coordinates, normals, distances } = request.spare ?? {};
  reply.coordinates = decoder.coordinates(coordinates);
  reply.box = decoder.box();
  if (request.withNormals) reply.normals = decoder.normals(normals);
  if (reference) {
    reference.decode(request.frame);
    Object.assign(reply, decoder.distances(reference, distances));
  }
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
