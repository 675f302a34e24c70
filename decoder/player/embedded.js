// What rlpcdec put into the page.

/** Bytes of the base64 texts of some elements, which go: a long stream is in parts. */
export function takeBlob(selector) {
  const parts = [...document.querySelectorAll(selector)].map((element) => {
    const text = atob(element.textContent);
    element.remove();
    return Uint8Array.from(text, (character) => character.charCodeAt(0));
  });
  return new Blob(parts);
}

/** {"name": ...}, or null: then the page has no stream. */
export function describedStream() {
  const element = document.getElementById("stream-description");
  return element && JSON.parse(element.textContent);
}
