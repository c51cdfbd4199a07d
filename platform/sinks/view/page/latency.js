// Stages of a frame's latency that the messages state: those of frames and of outputs.
export const STAGES = ["transport", "computing and sampling"];
const FRAMES_MAX = 128; // that wait for the first output that carries them
const WINDOW_S = 2;

export class Latency {
  #frames = new Map(); // by sequence number
  #carried = new Set(); // frames whose first output was seen
  #samples = []; // [time_s, stage of STAGES in ms, ..]

  addFrame({ sequence, mid_exposure_ns, arrival_ns }) {
    this.#frames.set(sequence, { exposure: mid_exposure_ns, arrival: arrival_ns });
    if (this.#frames.size > FRAMES_MAX) this.#frames.delete(this.#frames.keys().next().value);
  }

  // Returns the stages in ms if the output is the first that carries its frame; else null.
  addOutput(time_s, { frame_sequence, state, tick_ns }) {
    const MEASURED = 2;
    const frame = this.#frames.get(frame_sequence);
    if (state !== MEASURED || frame === undefined || this.#carried.has(frame_sequence)) return null;
    this.#carried.add(frame_sequence);
    if (this.#carried.size > FRAMES_MAX) this.#carried.delete(this.#carried.values().next().value);
    const stages = [frame.arrival - frame.exposure, tick_ns - frame.arrival].map(
      (ns) => Number(ns) * 1e-6,
    );
    this.#samples.push([time_s, ...stages]);
    while (this.#samples[0][0] < time_s - WINDOW_S) this.#samples.shift();
    return stages;
  }

  // The median of each stage in ms over the last WINDOW_S; null without a frame.
  medians() {
    if (this.#samples.length === 0) return null;
    return STAGES.map((_, stage) => {
      const sorted = this.#samples.map((sample) => sample[stage + 1]).sort((a, b) => a - b);
      return sorted[sorted.length >> 1];
    });
  }
}
