// What rlpcdec and scripts/player put into the page.

/** Bytes of the base64 texts of some elements, which go: a long stream is in parts. */
function takeBlob(selector) {
  const parts = [...document.querySelectorAll(selector)].map((element) => {
    const text = atob(element.textContent);
    element.remove();
    return Uint8Array.from(text, (character) => character.charCodeAt(0));
  });
  return new Blob(parts);
}

/** { name, stream, reference }: blobs; or undefined: then the page has no stream. */
export function embeddedStream() {
  const description = document.getElementById("stream-description");
  if (!description) return undefined;
  const hasReference = document.querySelector(".reference") !== null;
  return {
    ...JSON.parse(description.textContent),
    stream: takeBlob(".stream"),
    reference: hasReference ? takeBlob(".reference") : undefined,
  };
}

// WebAssembly can address 4 GiB: enough for two decoders with this limit, and the data drawn.
const kMaxMemory = 3 * 2 ** 29;

/** Options of RlpcDecoder.open(): the page needs no other files. */
export function embeddedDecoder() {
  const module = takeBlob("#wasm").arrayBuffer().then((bytes) => WebAssembly.compile(bytes));
  let address; // of the worker's script: one for all workers of the page
  const worker = () => {
    if (!address) {
      const script = document.getElementById("worker").textContent;
      address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    }
    return new Worker(address);
  };
  return async () => ({ wasm: await module, worker, maxMemory: kMaxMemory });
}
