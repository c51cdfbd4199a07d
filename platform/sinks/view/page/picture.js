// The camera's frame: /glint/picture with the searched regions and blobs of /glint/regions.
import { pixelsOf, secondsOf } from "./decoding.js";
import { Threshold } from "./threshold.js";
import { blobClass, blobText } from "./words.js";

const COLOURS = {
  accepted: "#4cc38a",
  assigned: "#e35bd8",
  refused: "#f0883e",
  roi: "#5aa9ff",
  chosen: "#ffffff",
};
const REACH_PX = 6; // of the pointer, in the frame's pixels

export class Picture {
  topics = ["/glint/picture", "/glint/regions"];
  #panel = document.querySelector("#picture");
  #frame = document.querySelector("#picture-frame");
  #canvas = document.querySelector("#picture-canvas");
  #text = document.querySelector("#picture-blob");
  #hint = document.querySelector("#picture-blob").textContent;
  #pixels = document.createElement("canvas");
  #image = null; // the newest message
  #values = null; // its pixels
  #regions = null;
  #chosen = null; // { x, y } in the frame's pixels: the blob next to it is explained
  #changed = false;
  #threshold = new Threshold(() => (this.#changed = true));

  constructor() {
    this.#canvas.addEventListener("pointermove", (event) => this.#choose(this.#toFrame(event)));
    this.#canvas.addEventListener("pointerdown", (event) => this.#choose(this.#toFrame(event)));
    this.#canvas.addEventListener("pointerleave", () => this.#choose(null));
    this.#canvas.addEventListener("keydown", (event) => this.#step(event));
    new ResizeObserver(() => (this.#changed = true)).observe(this.#frame);
  }

  reset() {
    this.#image = this.#values = this.#regions = this.#chosen = null;
    this.#threshold.reset();
    this.#panel.classList.remove("has-data");
    this.#canvas.width = this.#canvas.height = 1;
    this.#text.textContent = this.#hint;
  }

  show(topic, message) {
    if (topic === "/glint/regions") this.#regions = message;
    else this.#image = message;
    this.#changed = true;
  }

  draw() {
    if (!this.#changed || this.#image === null) return;
    this.#changed = false;
    this.#values = pixelsOf(this.#image);
    if (this.#values === null) {
      this.#text.textContent = `A picture of encoding ${this.#image.encoding}; expected mono8 or mono16.`;
      return;
    }
    this.#panel.classList.add("has-data");
    const used = this.#regions?.threshold ?? 0;
    this.#threshold.show(this.#values, used);
    this.#drawPixels(used);
    this.#drawOverlay();
    this.#explain();
  }

  // Dark pixels are raised: else only reflectors are visible. Yellow: above the slider's threshold.
  #drawPixels(used) {
    const { width, height } = this.#image;
    const shades = new ImageData(width, height),
      out = new Uint32Array(shades.data.buffer);
    const white =
      used > 0 ? 2 * used : this.#values.reduce((most, value) => Math.max(most, value), 1);
    const moved = this.#threshold.moved;
    this.#values.forEach((value, i) => {
      const gray = Math.min(255, 255 * Math.sqrt(value / white));
      out[i] =
        moved !== null && value > moved
          ? 0xff00d4ff
          : 0xff000000 | (gray << 16) | (gray << 8) | gray;
    });
    this.#pixels.width = width;
    this.#pixels.height = height;
    this.#pixels.getContext("2d").putImageData(shades, 0, 0);
  }

  #drawOverlay() {
    const { width, height } = this.#image;
    this.#frame.style.aspectRatio = `${width} / ${height}`;
    const scale = Math.max(1, (this.#frame.clientWidth * devicePixelRatio) / width);
    this.#canvas.width = Math.round(width * scale);
    this.#canvas.height = Math.round(height * scale);
    const to = this.#canvas.getContext("2d");
    to.imageSmoothingEnabled = false;
    to.drawImage(this.#pixels, 0, 0, this.#canvas.width, this.#canvas.height);
    if (this.#regions === null || !this.#isOfImage()) return;
    to.scale(scale, scale);
    const line = (1.5 * devicePixelRatio) / scale;
    to.lineWidth = line;
    to.setLineDash([4 * line, 3 * line]);
    to.strokeStyle = COLOURS.roi;
    for (const { x, y, width: w, height: h } of this.#regions.rois) to.strokeRect(x, y, w, h);
    to.setLineDash([]);
    to.font = `${(12 * devicePixelRatio) / scale}px system-ui, sans-serif`;
    for (const blob of this.#regions.blobs) {
      const { x, y, width: w, height: h } = blob.box;
      to.strokeStyle = to.fillStyle = COLOURS[blobClass(blob)];
      to.strokeRect(x - 2, y - 2, w + 4, h + 4);
      if (blob.marker !== "") to.fillText(blob.marker, x + w + 4, y);
    }
    const chosen = this.#nearest();
    if (chosen === null) return;
    to.strokeStyle = COLOURS.chosen;
    to.strokeRect(
      chosen.box.x - 5,
      chosen.box.y - 5,
      chosen.box.width + 10,
      chosen.box.height + 10,
    );
  }

  #isOfImage() {
    return secondsOf(this.#regions.header.stamp) === secondsOf(this.#image.header.stamp);
  }

  // Of an event's position, in the frame's pixels: object-fit may leave a border.
  #toFrame({ offsetX, offsetY }) {
    if (this.#image === null) return null;
    const { clientWidth: w, clientHeight: h } = this.#canvas,
      { width, height } = this.#image;
    const scale = Math.min(w / width, h / height);
    return {
      x: (offsetX - (w - width * scale) / 2) / scale,
      y: (offsetY - (h - height * scale) / 2) / scale,
    };
  }

  #choose(position) {
    this.#chosen = position;
    if (this.#image === null) return;
    this.#changed = true;
  }

  // Arrow keys select the next or the previous blob.
  #step(event) {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const blobs = this.#regions?.blobs ?? [];
    if (step === undefined || blobs.length === 0) return;
    event.preventDefault();
    const at = blobs.indexOf(this.#nearest());
    const next = blobs[(at + (at < 0 && step < 0 ? 0 : step) + blobs.length) % blobs.length];
    this.#choose({ x: next.x_px, y: next.y_px });
  }

  // The blob at the chosen position, or null.
  #nearest() {
    if (this.#chosen === null || this.#regions === null) return null;
    const { x, y } = this.#chosen;
    let nearest = null,
      least = REACH_PX;
    for (const blob of this.#regions.blobs) {
      const { x: left, y: top, width, height } = blob.box;
      const off = Math.hypot(
        Math.max(left - x, 0, x - left - width),
        Math.max(top - y, 0, y - top - height),
      );
      if (off < least) [nearest, least] = [blob, off];
    }
    return nearest;
  }

  #explain() {
    const blob = this.#nearest();
    const text = blob === null ? this.#hint : `Blob: ${blobText(blob)}.`;
    if (this.#text.textContent !== text) this.#text.textContent = text;
  }
}
