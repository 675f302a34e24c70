// Contents that rlpcdec and scripts/player put into the page.

/** Takes the bytes of the base64 texts of elements, and removes these: a long stream is in parts.
 * */
function takeBlob(selector) {
  const parts = [...document.querySelectorAll(selector)].map((element) => {
    const text = atob(element.textContent);
    element.remove();
    return Uint8Array.from(text, (character) => character.charCodeAt(0));
  });
  return new Blob(parts);
}

/** Returns { name, stream, reference }, blobs; undefined if the page has no stream. */
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

/** Returns options of RlpcDecoder.open() with which the page needs no other files. */
export function embeddedDecoder() {
  const module = takeBlob("#wasm").arrayBuffer().then((bytes) => WebAssembly.compile(bytes));
  let address; // script of the worker, one for all workers of the page
  const worker = () => {
    if (!address) {
      const script = document.getElementById("worker").textContent;
      address = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
    }
    return new Worker(address);
  };
  return async () => ({ wasm: await module, worker, maxMemory: kMaxMemory });
}
