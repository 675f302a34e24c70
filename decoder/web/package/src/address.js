// Addresses from callers: URLs, or in node paths of files.

const kScheme = /^[a-z][a-z\d+.-]+:/i; // longer than the letter of a drive

function isNode() {
  return !globalThis.document && typeof globalThis.process?.getBuiltinModule === "function";
}

/** Returns the URL of an address, relative to the page or the worker; in node, of a path relative
 * to the working directory. */
export function urlOf(address) {
  if (address instanceof URL) return address;
  if (isNode() && !kScheme.test(address)) {
    return process.getBuiltinModule("node:url").pathToFileURL(address);
  }
  return new URL(address, globalThis.document?.baseURI ?? globalThis.location?.href);
}

/** Returns whether a URL names a file, and files can be read. */
export function isFile(url) {
  return url.protocol === "file:" && isNode();
}
