// Camera that turns about a mesh of size 1, fits it into view and follows it.
import { dot, perspective, viewAxes, viewMatrix } from "./matrices.js";

const kTan = Math.tan(16 * Math.PI / 180); // half the vertical field of view
const kMargin = 1.12;
const kSlack = 0.05; // part of the size of the frame by which it may move before the camera follows
const kFirstView = { yaw: 0.5, pitch: 0.3 };

export class Camera {
  constructor() {
    this.listeners = [];
    this.aspect = 1;
    this.look({ centre: [0, 0, 0], halfSize: [0, 0, 0] }, [[-0.5, 0, 0], [0.5, 0, 0]]);
  }

  /** Adds a listener, which is called whenever the view changes. */
  addListener(listener) {
    this.listeners.push(listener);
  }

  changed() {
    for (const listener of this.listeners) listener();
  }

  /** Returns to the first view, with a mesh in its middle, as large as fits. box: of the mesh, in
   * the world; points: its vertices, [x, y, z]. */
  look(box, points) {
    Object.assign(this, kFirstView, { target: [...box.centre], offset: [0, 0, 0], pan: [0, 0, 0] });
    this.points = points;
    const [right, up] = viewAxes(this.yaw, this.pitch);
    for (let i = 0; i < 4; ++i) { // the perspective depends on the distance
      this.fitted = this.fittingDistance(points);
      const [x, y] = this.middle(points);
      this.offset = this.offset.map((value, c) => value + x * right[c] + y * up[c]);
    }
    this.fitted = this.fittingDistance(points);
    this.distance = this.fitted;
    this.changed();
  }

  /** Returns points in the axes of the first view: right, up and towards the viewer. */
  firstView(points) {
    const axes = viewAxes(kFirstView.yaw, kFirstView.pitch);
    const middle = this.target.map((value, i) => value + this.offset[i]);
    return points.map((point) => axes.map((axis) => dot(axis, point) - dot(axis, middle)));
  }

  /** Returns the distance from which all points are in the first view, with a margin. */
  fittingDistance(points) {
    return this.firstView(points).reduce((distance, [x, y, z]) => Math.max(distance,
      z + Math.max(Math.abs(x) / this.aspect, Math.abs(y)) * kMargin / kTan), 1e-3);
  }

  /** Returns the middle of the picture, from the middle of the first view. */
  middle(points) {
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (const [x, y, z] of this.firstView(points)) {
      const size = this.fitted / (this.fitted - z);
      low[0] = Math.min(low[0], x * size);
      low[1] = Math.min(low[1], y * size);
      high[0] = Math.max(high[0], x * size);
      high[1] = Math.max(high[1], y * size);
    }
    return [0, 1].map((i) => (low[i] + high[i]) / 2);
  }

  /** Keeps the mesh in the middle, and moves back if it grows. */
  follow(box, points) {
    const away = box.centre.map((value, i) => value - this.target[i]);
    const slack = kSlack * Math.hypot(...box.halfSize);
    const far = Math.hypot(...away);
    if (far > slack) {
      this.target = this.target.map((value, i) => value + away[i] * (1 - slack / far));
    }
    this.points = points;
    this.fit(Math.max(this.fitted, this.fittingDistance(points)));
  }

  /** Fits a distance, and keeps the zoom of the user. */
  fit(distance) {
    this.distance *= distance / this.fitted;
    this.fitted = distance;
  }

  setAspect(aspect) {
    this.aspect = aspect;
    this.fit(this.fittingDistance(this.points));
  }

  /** Returns { view, projection, eye }. */
  matrices() {
    const axes = viewAxes(this.yaw, this.pitch);
    const eye = this.target.map((value, i) =>
      value + this.offset[i] + this.pan[i] + this.distance * axes[2][i]);
    const near = 0.02 * this.distance;
    return { eye, view: viewMatrix(axes, eye),
      projection: perspective(kTan, this.aspect, near, 2 * this.distance + 10) };
  }

  turn(x, y) {
    this.yaw -= 0.008 * x;
    this.pitch = Math.max(-1.55, Math.min(1.55, this.pitch + 0.008 * y));
  }

  /** Moves by pixels of a canvas with a height. */
  move(x, y, height) {
    const [right, up] = viewAxes(this.yaw, this.pitch);
    const pixel = 2 * kTan * this.distance / height;
    this.pan = this.pan.map((value, i) => value + pixel * (y * up[i] - x * right[i]));
  }

  zoom(factor) {
    const [min, max] = [0.05 * this.fitted, 20 * this.fitted];
    this.distance = Math.max(min, Math.min(max, this.distance * factor));
  }

  /** Handles input: drag to turn, shift or the right button to move, wheel to zoom; two fingers
   * move and zoom. */
  attach(canvas) {
    const held = new Map();
    const spread = () => {
      const [a, b] = held.values();
      return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      held.set(event.pointerId, event);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => held.delete(event.pointerId));
    }
    canvas.addEventListener("pointermove", (event) => {
      const before = held.get(event.pointerId);
      if (!before) return;
      const [x, y] = [event.clientX - before.clientX, event.clientY - before.clientY];
      if (held.size === 2) {
        const spreadBefore = spread();
        held.set(event.pointerId, event);
        this.zoom(spreadBefore / Math.max(spread(), 1));
        this.move(x / 2, y / 2, canvas.clientHeight);
      } else if (event.shiftKey || event.buttons === 2) {
        this.move(x, y, canvas.clientHeight);
      } else {
        this.turn(x, y);
      }
      held.set(event.pointerId, event);
      this.changed();
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.001 * event.deltaY));
      this.changed();
    }, { passive: false });
  }
}
