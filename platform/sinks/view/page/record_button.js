// The button that stores what the page receives, and offers the file for download.
import { StreamRecorder, STORED_BYTES_MAX } from "./stream_recorder.js";

export class RecordButton {
  #button = document.querySelector("#record");
  #recorder = null;
  #begin = 0;

  constructor() {
    this.#button.addEventListener("click", () =>
      this.#recorder === null ? this.#start() : this.stop(),
    );
    setInterval(() => this.#label(), 500);
  }

  set disabled(value) {
    this.#button.disabled = value;
  }

  message(channel, time, bytes) {
    this.#recorder?.add(channel, time, bytes);
  }

  async stop() {
    const recorder = this.#recorder;
    if (recorder === null) return;
    this.#recorder = null;
    this.#label();
    const link = document.createElement("a");
    link.href = URL.createObjectURL(await recorder.close());
    link.download = `glint-${new Date().toISOString().replace(/[:.]/g, "-")}.mcap`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
  }

  #start() {
    this.#recorder = new StreamRecorder();
    this.#begin = performance.now();
    this.#label();
  }

  #label() {
    const recorder = this.#recorder;
    this.#button.setAttribute("aria-pressed", String(recorder !== null));
    if (recorder === null) {
      this.#button.textContent = "Record";
    } else if (recorder.isFull) {
      this.#button.textContent = `Save: full at ${STORED_BYTES_MAX >> 20} MB, ${recorder.lost} messages lost`;
    } else {
      const seconds = (performance.now() - this.#begin) / 1000;
      this.#button.textContent = `Stop and save: ${seconds.toFixed(0)} s, ${recorder.messages} messages`;
    }
  }
}
