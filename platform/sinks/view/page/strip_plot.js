// One strip chart: a heading with the newest values, or those under the pointer, above the curves.
import uPlot from "uplot";

export const HEIGHT_PX = 150;

// names: of the values 0, 1, .., instead of a unit. series: as uPlot expects them.
export function stripPlot(host, { title, unit, names }, series, times) {
  const heading = document.createElement("h3");
  host.append(heading);
  const text = (value) => (names ? names[value] : `${value.toFixed(1)} ${unit}`);
  const showValues = (plot) => {
    heading.textContent = headingOf(plot, title, text);
  };
  const range = names ? [0, names.length - 1] : (_, low, high) => [0, Math.max(high * 1.1, 1)];
  const valueAxis = names
    ? { size: 96, splits: () => [...names.keys()], values: () => names }
    : { size: 64, values: (_, ticks) => ticks.map((tick) => `${tick} ${unit}`) };
  const options = {
    width: 300,
    height: HEIGHT_PX,
    legend: { show: false },
    cursor: { drag: { x: false, y: false }, sync: { key: "strips" } },
    hooks: { setCursor: [showValues], setData: [showValues] },
    scales: { x: { time: false }, y: { range } },
    series: [{}, ...series.map((one) => ({ ...one, points: { show: false }, spanGaps: false }))],
    axes: [{ size: 26, values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, valueAxis],
  };
  return new uPlot(options, [times, ...series.map(() => [])], host);
}

// The newest bin may still be without a value.
const NEWEST_BINS = 5;

function newest(values) {
  for (let i = values.length - 1; i >= values.length - NEWEST_BINS; --i) {
    if (values[i] !== null && values[i] !== undefined) return values[i];
  }
  return null;
}

function headingOf(plot, title, text) {
  const pointed = plot.cursor.idx ?? null;
  const when = pointed === null ? "" : ` at ${plot.data[0][pointed].toFixed(1)} s`;
  const parts = plot.series.slice(1).map(({ label }, i) => {
    const values = plot.data[i + 1];
    const value = pointed === null ? newest(values) : (values[pointed] ?? null);
    const name = plot.series.length > 2 ? `${label} ` : "";
    return value === null ? `${name}none` : name + text(value);
  });
  return `${title}${when}: ${parts.join(", ")}`;
}
