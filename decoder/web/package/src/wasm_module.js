// The compiled WebAssembly module, once for all decoders.
import { isFile, urlOf } from "./address.js";
import { RlpcError } from "./error.js";

const modules = new Map(); // promises by address

async function compile(url) {
  if (isFile(url)) {
    const { readFile } = process.getBuiltinModule("node:fs/promises");
    return WebAssembly.compile(await readFile(url));
  }
  const response = await fetch(url);
  if (!response.ok) {
    throw new RlpcError(`${url}: the server answers ${response.status}`, { kind: "network" });
  }
  const type = response.headers.get("content-type") ?? "";
  if (type.startsWith("text/html")) { // development servers send one instead of an error
    throw new RlpcError(`${url}: the server sends a page instead of the WebAssembly module; ` +
      'with Vite, set optimizeDeps: { exclude: ["rlpc"] }', { kind: "network" });
  }
  return type.startsWith("application/wasm")
    ? WebAssembly.compileStreaming(response)
    : WebAssembly.compile(await response.arrayBuffer());
}

/** Returns the compiled module. wasm: a module, its bytes, its URL, or undefined for the file of
 * this package. */
export function compiledModule(wasm = new URL("./rlpc.wasm", import.meta.url)) {
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm)) return WebAssembly.compile(wasm);
  const url = urlOf(wasm);
  if (!modules.has(url.href)) {
    modules.set(url.href, compile(url).catch((error) => {
      modules.delete(url.href); // the next decoder tries again
      throw error;
    }));
  }
  return modules.get(url.href);
}
