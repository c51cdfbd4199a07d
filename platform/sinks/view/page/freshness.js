// Panels without new messages turn grey: within 0.5 s of the last one, with a margin for the check
// itself. A camera sends at least 5 frames a second.
export const LIMIT_MS = 400;
export const CHECK_MS = 50;

// received: times of the newest message of each topic. A panel that never received any shows that
// in its own words.
export function isStale(now_ms, received) {
  const newest = Math.max(...received.map((time) => time ?? -Infinity));
  return newest > -Infinity && now_ms - newest > LIMIT_MS;
}

const PANELS = [
  { id: "sentences", topics: ["/glint/output"] },
  { id: "picture", topics: ["/glint/picture"] },
  { id: "scene", topics: ["/glint/output"] },
  { id: "charts", topics: ["/glint/output"] },
];

export class Freshness {
  #newest = new Map(); // by topic: when it was received, ms
  #watches = true;

  constructor() {
    setInterval(() => this.#check(), CHECK_MS);
  }

  received(topic) {
    this.#newest.set(topic, performance.now());
  }

  // false: a recording is shown, which does not become stale.
  watch(watches) {
    this.#watches = watches;
    this.#newest.clear();
    this.#check();
  }

  #check() {
    const now = performance.now();
    for (const { id, topics } of PANELS) {
      const stale =
        this.#watches &&
        isStale(
          now,
          topics.map((topic) => this.#newest.get(topic)),
        );
      document.getElementById(id).classList.toggle("stale", stale);
    }
  }
}
