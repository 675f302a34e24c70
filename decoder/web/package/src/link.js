// Connection to the engine: each request has a promise.
import { aborted, closed, RlpcError, unpacked } from "./error.js";

export class Link {
  constructor() {
    this.requests = new Map();
    this.listeners = new Map(); // key: stream
    this.nextId = 0;
    this.nextStream = 0;
    this.numUsers = 0;
  }

  /** Connects to an engine in the worker that makeWorker() returns; without it, on the thread of
   * the caller. */
  static async create(makeWorker) {
    const link = new Link();
    if (makeWorker) {
      const worker = makeWorker();
      worker.onmessage = ({ data }) => link.receive(data);
      worker.onerror = (event) => link.fail(new RlpcError(
        `the worker has failed: ${event.message ?? "its script cannot be loaded"}`,
        { kind: "source" }));
      link.send = (message, transfer) => worker.postMessage(message, transfer);
      link.end = () => worker.terminate();
    } else {
      const { Engine } = await import("./engine.js");
      const engine = new Engine((message) => link.receive(message));
      link.send = (message) => engine.receive(message);
      link.end = () => {};
    }
    return link;
  }

  request(message, { signal, transfer = [] } = {}) {
    if (this.failure) return Promise.reject(this.failure);
    if (signal?.aborted) return Promise.reject(signal.reason);
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      const stop = () => {
        this.requests.delete(id);
        this.send({ cancel: id });
        reject(signal.reason ?? aborted());
      };
      signal?.addEventListener("abort", stop, { once: true });
      this.requests.set(id, {
        resolve, reject, done: () => signal?.removeEventListener("abort", stop) });
      try {
        this.send({ id, ...message }, transfer);
      } catch (error) { // an array that was transferred before
        this.requests.delete(id);
        signal?.removeEventListener("abort", stop);
        reject(error);
      }
    });
  }

  receive({ id, result, error, stream, loaded, size }) {
    if (id === undefined) {
      this.listeners.get(stream)?.({ loaded, total: size });
      return;
    }
    const request = this.requests.get(id);
    this.requests.delete(id);
    request?.done();
    if (error) request?.reject(unpacked(error));
    else request?.resolve(result);
  }

  /** Rejects all pending and later requests. */
  fail(error) {
    this.failure = error;
    for (const { reject, done } of this.requests.values()) {
      done();
      reject(error);
    }
    this.requests.clear();
  }

  /** Ends the worker with its last user. */
  release() {
    if (--this.numUsers > 0) return;
    this.end();
    this.fail(closed());
  }
}
