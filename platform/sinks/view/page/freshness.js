// Panels without new messages turn grey: within 0.5 s of the last one.
const LIMIT_MS = 400;
const CHECK_MS = 50;

// A picture is absent longer than the outputs: a camera sends 5 a second when no hand is in view.
const PANELS = [
  { id: "sentences", topics: ["/glint/output"] },
  { id: "picture", topics: ["/glint/picture"] },
  { id: "scene", topics: ["/glint/output"] },
  { id: "charts", topics: ["/glint/output"] },
];

export class Freshness {
  #newest = new Map();  // by topic: when it was received, ms
  #watches = true;

  constructor() { setInterval(() => this.#check(), CHECK_MS); }

  received(topic) { this.#newest.set(topic, performance.now()); }

  // false: a recording is shown, which does not become stale.
  watch(watches) {
    this.#watches = watches;
    this.#newest.clear();
    this.#check();
  }

  #check() {
    const now = performance.now();
    for (const { id, topics } of PANELS) {
      const newest = Math.max(...topics.map((topic) => this.#newest.get(topic) ?? -Infinity));
      document.getElementById(id).classList.toggle("stale", this.#watches && now - newest > LIMIT_MS);
    }
  }
}
