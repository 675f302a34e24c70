// Shows distances from a reference: as colours on the mesh, and in numbers.
import { digits, roundedUp } from "./facts.js";

const $ = (id) => document.getElementById(id);

export class DeviationCard {
  constructor({ info, gridStep }) {
    this.unit = 2 ** (info.positionBits - 1) * gridStep; // half the side of the drawn cube
    this.largest = 0;
    this.difference = undefined; // message on a reference that does not match its hash
    this.isShown = false;
  }

  /** Shows a frame. Without distances, the surface has its own colour. */
  show({ index, distances, largest = 0, rms, referenceError }, viewer) {
    if (distances && referenceError) {
      this.difference ??=
        `Frame ${index} of the reference does not fit its hash: ${referenceError.message}`;
    }
    $("deviation").hidden = !this.isShown;
    $("deviation").toggleAttribute("data-missing", !distances);
    $("deviation-error").textContent = distances
      ? this.difference ?? ""
      : `The reference cannot be decoded: ${referenceError.message}`;
    this.largest = Math.max(this.largest, largest);
    const max = roundedUp(this.largest * this.unit);
    viewer.set({ deviationScale: this.isShown && distances ? max / this.unit : 0 });
    if (!distances) return;
    $("deviation-most").textContent = digits(max);
    $("deviation-frame").textContent =
      `largest ${digits(largest * this.unit)}, RMS ${digits(rms * this.unit)}`;
  }
}
