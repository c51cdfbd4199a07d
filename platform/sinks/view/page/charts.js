// Strip charts of the outputs: state, age, standard deviation, latency, frame rate; and the losses.
import { secondsOf } from "./decoding.js";
import { Latency, STAGES } from "./latency.js";
import { binOf, binTimes, BIN_S, Series } from "./series.js";
import { HEIGHT_PX, stripPlot } from "./strip_plot.js";
import { plain, reasonName, stateText } from "./words.js";

const TOOL_COLOURS = ["#1f5fbf", "#a56400", "#7b3fb5", "#1a7f4b", "#b3261e", "#5a6673"];
const STAGE_COLOURS = ["#5a7ea8", "#1f5fbf"];
const TOOLS_MAX = 16;
// The state's height in its chart, by its value in glint_msgs/Output.
const STATE_HEIGHTS = [0, 2, 3, 1];
const STATE_AT_HEIGHT = ["none", "lost", "predicted", "measured"];

const STRIPS = [
  {
    title: "State",
    names: STATE_AT_HEIGHT.map(stateText),
    reduction: "newest",
    value: (output) => STATE_HEIGHTS[output.state] ?? null,
  },
  {
    title: "Age of the measurement",
    unit: "ms",
    reduction: "largest",
    value: (output) => (hasPose(output) ? output.age_s * 1e3 : null),
  },
  {
    title: "Standard deviation of the position",
    unit: "mm",
    reduction: "largest",
    value: (output) => (hasPose(output) ? output.sigma_position_m * 1e3 : null),
  },
  {
    title: "Standard deviation of the rotation",
    unit: "deg",
    reduction: "largest",
    value: (output) => (hasPose(output) ? (output.sigma_orientation_rad * 180) / Math.PI : null),
  },
];
const hasPose = ({ state }) => state === 1 || state === 2;

export class Charts {
  topics = ["/glint/output", "/glint/frame", "/glint/blobs", "/glint/dropped", "/glint/choice"];
  #host = document.querySelector("#strips");
  #bar = document.querySelector("#latency-bar");
  #text = document.querySelector("#latency-text");
  #losses = document.querySelector("#losses");
  #times = binTimes();

  constructor() {
    this.reset();
    new ResizeObserver(() => this.#fit()).observe(this.#host);
  }

  reset() {
    this.tools = []; // by number: { name, series of each strip }
    this.latency = new Latency();
    this.stages = STAGES.map(() => new Series("largest"));
    this.frames = new Series("count");
    this.counts = { overruns: 0, "ticks absent": 0 };
    this.newest_s = -Infinity;
    this.lastTick = new Map();
    for (const plot of this.plots ?? []) plot.destroy();
    this.plots = [];
    this.#host.replaceChildren();
    this.#bar.replaceChildren();
    this.#text.textContent = "No frame yet.";
    this.#losses.textContent = "";
  }

  show(topic, message, tools) {
    const time_s = secondsOf(message.header.stamp);
    if (topic === "/glint/output") return this.#output(time_s, message, tools);
    if (topic === "/glint/dropped")
      return this.#count(`frames dropped, ${plain(reasonName(message.reason))}`);
    if (topic === "/glint/choice")
      return message.overrun === 0 ? undefined : this.#count("overruns");
    this.frames.add(time_s, 1);
    this.newest_s = Math.max(this.newest_s, time_s);
    this.latency.addFrame(message);
  }

  #count(name, by = 1) {
    this.counts[name] = (this.counts[name] ?? 0) + by;
  }

  #output(time_s, output, tools) {
    if (output.tool >= TOOLS_MAX) return;
    if (this.tools[output.tool] === undefined) this.#addTool(output.tool);
    const entry = this.tools[output.tool];
    entry.name = tools.nameOf(output.tool);
    this.newest_s = Math.max(this.newest_s, time_s);
    STRIPS.forEach(({ value }, i) => entry.series[i].add(time_s, value(output)));
    const last = this.lastTick.get(output.tool);
    if (last !== undefined && output.tick_number > last + 1)
      this.#count("ticks absent", output.tick_number - last - 1);
    this.lastTick.set(output.tool, output.tick_number);
    const stages = output.tool === 0 ? this.latency.addOutput(time_s, output) : null;
    stages?.forEach((ms, i) => this.stages[i].add(time_s, ms));
  }

  #addTool(number) {
    for (let i = this.tools.length; i <= number; ++i) {
      this.tools.push({ name: "", series: STRIPS.map(({ reduction }) => new Series(reduction)) });
    }
    for (const plot of this.plots) plot.destroy(); // their number of series changes
    this.plots = [];
  }

  draw() {
    if (!Number.isFinite(this.newest_s)) return;
    if (this.plots.length === 0) this.#build();
    const last = binOf(this.newest_s);
    STRIPS.forEach((_, i) => {
      this.plots[i].setData([
        this.#times,
        ...this.tools.map(({ series }) => series[i].values(last)),
      ]);
    });
    const [transport, rest] = this.stages.map((stage) => stage.values(last));
    const total = transport.map((ms, i) => (ms === null ? null : ms + rest[i]));
    this.plots[STRIPS.length].setData([this.#times, total, transport]);
    this.plots[STRIPS.length + 1].setData([this.#times, rate(this.frames.values(last - 1))]);
    this.#drawLatency();
    this.#losses.textContent = `Losses seen in these messages: ${Object.entries(this.counts)
      .map(([name, count]) => `${name} ${count}`)
      .join(", ")}.`;
  }

  #drawLatency() {
    const medians = this.latency.medians();
    if (medians === null) return;
    const texts = medians.map((ms, i) => `${STAGES[i]} ${ms.toFixed(1)} ms`);
    this.#bar.replaceChildren(
      ...medians.map((ms, i) => {
        const part = document.createElement("div");
        part.style.flexGrow = String(Math.max(0, ms));
        part.style.background = STAGE_COLOURS[i];
        part.textContent = part.title = texts[i];
        return part;
      }),
    );
    const sum = medians.reduce((a, b) => a + b, 0);
    this.#bar.setAttribute("aria-label", `${texts.join(", ")}; sum ${sum.toFixed(1)} ms`);
    this.#text.textContent =
      `Mid-exposure to the tick that carries the frame first: ${sum.toFixed(1)} ms ` +
      `(${texts.join(", ")}). Sending, bus time and bus load are in no message: the run's table has them.`;
  }

  #build() {
    const toolSeries = this.tools.map(({ name }, i) => ({
      label: name || `tool ${i}`,
      stroke: TOOL_COLOURS[i % TOOL_COLOURS.length],
      width: 1.5,
    }));
    this.#host.replaceChildren();
    for (const strip of STRIPS) this.#plot(strip, toolSeries);
    // The sum is drawn first: what remains visible of it is the upper stage.
    this.#plot({ title: "Latency of frames", unit: "ms" }, [
      { label: "sum", stroke: STAGE_COLOURS[1], fill: STAGE_COLOURS[1] },
      { label: STAGES[0], stroke: STAGE_COLOURS[0], fill: STAGE_COLOURS[0] },
    ]);
    this.#plot({ title: "Frame rate", unit: "Hz" }, [
      { label: "frames", stroke: TOOL_COLOURS[0], width: 1.5 },
    ]);
    this.#fit();
  }

  #plot(strip, series) {
    const host = document.createElement("div");
    host.className = "strip";
    this.#host.append(host);
    this.plots.push(stripPlot(host, strip, series, this.#times));
  }

  #fit() {
    for (const plot of this.plots) {
      const width = plot.root.parentElement.clientWidth;
      if (width > 0 && width !== plot.width) plot.setSize({ width, height: HEIGHT_PX });
    }
  }
}

// Frames in each second, from the counts of the bins: a bin is too short for a rate.
function rate(counts) {
  const bins = Math.round(1 / BIN_S);
  let sum = 0;
  return counts.map((count, i) => {
    sum += (count ?? 0) - (i >= bins ? (counts[i - bins] ?? 0) : 0);
    return i >= bins - 1 && sum > 0 ? sum : null;
  });
}
