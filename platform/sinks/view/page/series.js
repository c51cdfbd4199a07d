// Values over time for a strip chart: bins of fixed length, a fixed number of them.
export const BIN_S = 0.1;
export const SPAN_S = 30;
const BINS_MAX = SPAN_S / BIN_S;

// How the values of a bin become one. A gap in the messages is a gap in the chart.
const REDUCTIONS = {
  largest: (before, value) => (before === null ? value : Math.max(before, value)),
  newest: (before, value) => value,
  count: (before) => (before ?? 0) + 1,
};

export class Series {
  #reduce;
  #bins = new Map(); // by number of the bin
  #last = -Infinity;

  constructor(reduction) {
    this.#reduce = REDUCTIONS[reduction];
  }

  add(time_s, value) {
    const bin = Math.floor(time_s / BIN_S);
    this.#last = Math.max(this.#last, bin);
    this.#bins.set(bin, this.#reduce(this.#bins.get(bin) ?? null, value));
    if (this.#bins.size <= BINS_MAX) return;
    for (const old of this.#bins.keys()) if (old <= this.#last - BINS_MAX) this.#bins.delete(old);
  }

  // The values of all bins that end at the given bin; null where there is none.
  values(last) {
    const out = [];
    for (let bin = last - BINS_MAX + 1; bin <= last; ++bin) out.push(this.#bins.get(bin) ?? null);
    return out;
  }
}

// Times of those bins, in seconds before the newest.
export const binTimes = () =>
  Array.from({ length: BINS_MAX }, (_, i) => (i - BINS_MAX + 1) * BIN_S);

export const binOf = (time_s) => Math.floor(time_s / BIN_S);
