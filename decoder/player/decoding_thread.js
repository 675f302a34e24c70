// The worker, as the page sees it.
//
//   request                                     reply
//   open  wasm, stream, referenceStream         opened  header, triangles; or failed  error
//   frame frame, order, withNormals, checkOnly  frame   frame, order, checkOnly; crc, compared,
//                                                       differs, ms, and unless checkOnly box,
//                                                       centre, arrays and referenceError; error
//   edges                                       edges   edges

let address; // of the worker's script: one for all threads of the page

function workerAddress() {
  if (!address) {
    const source = document.getElementById("worker").textContent;
    address = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
  }
  return address;
}

export class DecodingThread {
  /** on: functions by type of reply. */
  constructor(on) {
    this.worker = new Worker(workerAddress());
    this.spare = [];
    this.worker.onmessage = ({ data }) => on[data.type](data);
    this.worker.onerror = (event) => on.failed({ error: { text: event.message } });
  }

  /** Streams: blobs, which are not copied on their way. */
  open(wasm, stream, referenceStream) {
    this.worker.postMessage({ type: "open", wasm, stream, referenceStream });
  }

  requestFrame(request) {
    const spare = request.checkOnly ? undefined : this.spare.pop();
    const arrays = Object.values(spare ?? {}).filter(Boolean);
    this.worker.postMessage({ type: "frame", ...request, spare },
      arrays.map((array) => array.buffer));
  }

  requestEdges() {
    this.worker.postMessage({ type: "edges" });
  }

  /** Arrays of a frame that is not shown any more, to be filled again. */
  recycle({ coordinates, normals, distances }) {
    if (coordinates && this.spare.length < 4) this.spare.push({ coordinates, normals, distances });
  }

  close() {
    this.worker.terminate();
  }
}
