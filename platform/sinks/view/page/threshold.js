// The threshold slider: which pixels exceed a threshold, and the cell's line that sets it.

// Number of pixels above the threshold. A cell's threshold is exceeded, not met.
export function countAbove(values, threshold) {
  let count = 0;
  for (const value of values) if (value > threshold) ++count;
  return count;
}

export const cellLine = (threshold) => `threshold = ${threshold}`;

export class Threshold {
  #slider = document.querySelector("#threshold-slider");
  #value = document.querySelector("#threshold-value");
  #line = document.querySelector("#threshold-line");
  #copy = document.querySelector("#threshold-copy");
  #moved = false;
  #changed;

  // changed() is called when the user moves the slider.
  constructor(changed) {
    this.#changed = changed;
    this.#slider.addEventListener("input", () => {
      this.#moved = true;
      this.#changed();
    });
    this.#copy.addEventListener("click", async () => {
      try {
        await navigator.clipboard.writeText(this.#line.textContent);
        this.#copy.textContent = "Copied";
      } catch {
        getSelection().selectAllChildren(this.#line); // the clipboard is refused: ready to copy
        this.#copy.textContent = "Selected";
      }
      setTimeout(() => (this.#copy.textContent = "Copy"), 1500);
    });
  }

  reset() {
    this.#moved = false;
    this.#slider.disabled = this.#copy.disabled = true;
    this.#value.textContent = this.#line.textContent = "";
  }

  // Of the slider; null while it is where the run's threshold is.
  get moved() {
    return this.#moved ? Number(this.#slider.value) : null;
  }

  // values: of the newest picture; used: the threshold of its frame, or 0.
  show(values, used) {
    const top = Math.max(4095, 2 * used);
    if (Number(this.#slider.max) !== top) this.#slider.max = String(top);
    this.#slider.disabled = this.#copy.disabled = false;
    if (!this.#moved) this.#slider.value = String(used);
    const at = Number(this.#slider.value);
    const count = countAbove(values, at);
    const now = at === used ? "" : `, the run uses ${used}`;
    this.#value.textContent = `${at} counts: ${count} px above${now}`;
    this.#line.textContent = cellLine(at);
  }
}
