// Decodes in a worker.
import { Engine } from "./engine.js";

const engine = new Engine((message, transfer) => postMessage(message, transfer));
onmessage = ({ data }) => engine.receive(data);
