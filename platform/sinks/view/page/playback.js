// Playback of an opened recording: play, pause and the scrub bar.
const STEP_MS = 50;
const WINDOW_NS = 5_000_000_000n; // what a jump reads before its target, so that charts have a past
const STEPS = 1000; // of the scrub bar, as index.html states it

export class Playback {
  #element = document.querySelector("#playback");
  #button = document.querySelector("#play");
  #bar = document.querySelector("#scrub");
  #label = document.querySelector("#scrub-time");
  #file = null;
  #receiver = null;
  #time = 0n;
  #playing = false;
  #task = Promise.resolve(); // reads, one after the other
  #jumps = 0; // requested and not yet read

  constructor() {
    this.#button.addEventListener("click", () => this.#setPlaying(!this.#playing));
    this.#bar.addEventListener("input", () => this.#jump(this.#timeOfBar()));
    setInterval(() => this.#step(), STEP_MS);
  }

  // receiver: { reset(), message(channel, time_ns, bytes), drawn() }.
  open(file, receiver) {
    this.#file = file;
    this.#receiver = receiver;
    this.#element.hidden = false;
    this.#setPlaying(false);
    this.#jump(file.start);
    this.#setPlaying(true);
  }

  close() {
    this.#file = null;
    this.#element.hidden = true;
    this.#setPlaying(false);
  }

  #setPlaying(playing) {
    if (playing && this.#file !== null && this.#time >= this.#file.end)
      this.#jump(this.#file.start);
    this.#playing = playing;
    this.#button.textContent = playing ? "Pause" : "Play";
  }

  #timeOfBar() {
    const { start, end } = this.#file;
    return start + ((end - start) * BigInt(this.#bar.value)) / BigInt(STEPS);
  }

  #jump(time) {
    this.#time = time;
    this.#showTime();
    if (++this.#jumps > 1) return; // the read that waits goes to the newest target
    const file = this.#file;
    this.#task = this.#task.then(async () => {
      while (this.#jumps > 0 && file === this.#file) {
        this.#jumps = 1;
        const target = this.#time;
        this.#receiver.reset();
        const from = target - WINDOW_NS > file.start ? target - WINDOW_NS : file.start;
        await file.read(from, target, (...message) => this.#receiver.message(...message));
        --this.#jumps;
      }
      this.#jumps = 0;
      this.#receiver.drawn(this.#time);
    });
  }

  // Reads the next messages in real time; a slow computer plays more slowly.
  #step() {
    if (!this.#playing || this.#jumps > 0 || this.#reading) return;
    const file = this.#file,
      from = this.#time + 1n;
    let to = this.#time + BigInt(STEP_MS) * 1_000_000n;
    if (to >= file.end) to = file.end;
    this.#reading = true;
    this.#task = this.#task.then(async () => {
      await file.read(from, to, (...message) => {
        if (file === this.#file && this.#jumps === 0) this.#receiver.message(...message);
      });
      this.#reading = false;
      if (file !== this.#file || this.#jumps > 0) return;
      this.#time = to;
      this.#showTime();
      this.#receiver.drawn(to);
      if (to === file.end) this.#setPlaying(false);
    });
  }
  #reading = false;

  #showTime() {
    const { start, end } = this.#file;
    const length = Number(end - start),
      at = Number(this.#time - start);
    this.#bar.value = String(length > 0 ? Math.round((at / length) * STEPS) : 0);
    this.#label.textContent = `${(at * 1e-9).toFixed(1)} s of ${(length * 1e-9).toFixed(1)} s`;
  }
}
