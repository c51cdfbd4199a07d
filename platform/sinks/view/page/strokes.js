// Strokes of the first tool while its button is held, and a short trail of its tip otherwise.
import { BufferAttribute, BufferGeometry, Line, LineBasicMaterial } from "three";

const POINTS_MAX = 5000; // of all strokes
const SPACING_M = 0.001;
const TRAIL_POINTS_MAX = 200; // of the tip's path without a held button

export class StrokeLines {
  #frames;
  #lines = [];
  #current = null;
  count = 0;

  constructor(frames) {
    this.#frames = frames;
  }

  add(frame, { x, y, z }, isDrawn) {
    if (this.#current?.frame !== frame || this.#current.isDrawn !== isDrawn)
      this.#begin(frame, isDrawn);
    const { points } = this.#current,
      last = points.at(-1);
    if (last !== undefined && Math.hypot(x - last[0], y - last[1], z - last[2]) < SPACING_M) return;
    if (isDrawn && this.count === POINTS_MAX) return;
    if (isDrawn) ++this.count;
    points.push([x, y, z]);
    if (!isDrawn && points.length > TRAIL_POINTS_MAX) points.shift();
    this.#current.changed = true;
  }

  interrupt() {
    if (this.#current !== null) this.#begin(this.#current.frame, this.#current.isDrawn);
  }

  #begin(frame, isDrawn) {
    if (this.#current !== null && (!this.#current.isDrawn || this.#current.points.length === 0))
      this.#remove();
    const line = new Line(
      new BufferGeometry(),
      new LineBasicMaterial({ color: isDrawn ? "#ffd400" : "#7d8a97" }),
    );
    line.frustumCulled = false;
    this.#frames.of(frame).add(line);
    this.#current = { frame, isDrawn, line, points: [], changed: false };
    this.#lines.push(this.#current);
  }

  #remove() {
    const { line } = this.#lines.pop();
    line.removeFromParent();
    line.geometry.dispose();
  }

  draw() {
    for (const entry of this.#lines) {
      if (!entry.changed) continue;
      entry.changed = false;
      entry.line.geometry.dispose();
      entry.line.geometry = new BufferGeometry().setAttribute(
        "position",
        new BufferAttribute(new Float32Array(entry.points.flat()), 3),
      );
    }
  }
}
