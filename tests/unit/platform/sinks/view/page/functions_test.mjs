// The page's functions that need no browser.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";

const load = (name) => import(join(process.env.PAGE_FOLDER, name));
const { eigenOfSymmetric, positionEllipsoid } = await load("ellipsoid.js");
const { CHECK_MS, isStale, LIMIT_MS } = await load("freshness.js");
const { Latency } = await load("latency.js");
const { BIN_S, binOf, Series } = await load("series.js");
const { countAbove } = await load("threshold.js");
const { blobClass, blobText, stateClass } = await load("words.js");

const close = (found, expected, what) =>
  assert.ok(
    Math.abs(found - expected) <= 1e-9 * Math.max(1, Math.abs(expected)),
    `${what}: ${found}, expected ${expected}`,
  );

test("the ellipsoid's axes satisfy A v = lambda v", () => {
  const matrix = [4, 1, -2, 1, 3, 0.5, -2, 0.5, 9];
  const { values, vectors } = eigenOfSymmetric(matrix);
  for (let k = 0; k < 3; ++k) {
    for (let row = 0; row < 3; ++row) {
      const product = [0, 1, 2].reduce((sum, i) => sum + matrix[3 * row + i] * vectors[i][k], 0);
      close(product, values[k] * vectors[row][k], `row ${row} of axis ${k}`);
    }
  }
});

test("95 % of a sphere's errors are within 2.7955 standard deviations", () => {
  const covariance = Array(36).fill(0);
  for (const i of [0, 7, 14]) covariance[i] = 4e-6;
  for (const axis of positionEllipsoid(covariance).axes)
    assert.ok(Math.abs(axis / 0.002 - 2.7955) < 1e-4, `${axis}`);
  assert.equal(positionEllipsoid(Array(36).fill(0)), null);
  covariance[7] = NaN;
  assert.equal(positionEllipsoid(covariance), null);
});

test("a panel is grey within 0.5 s, and not at 5 pictures a second", () => {
  assert.ok(LIMIT_MS + 2 * CHECK_MS <= 500);
  assert.equal(isStale(1000, [1000 - LIMIT_MS - 1]), true);
  assert.equal(isStale(1000, [800]), false);
  assert.equal(isStale(1000, [undefined]), false);
});

test("the stages are those of the first output that carries a frame", () => {
  const latency = new Latency();
  const output = { frame_sequence: 7, state: 2, tick_ns: 30_000_000n };
  assert.equal(latency.addOutput(1, output), null);
  latency.addFrame({ sequence: 7, mid_exposure_ns: 10_000_000n, arrival_ns: 18_000_000n });
  assert.deepEqual(latency.addOutput(1, output), [8, 12]);
  assert.equal(latency.addOutput(1.004, { ...output, tick_ns: 34_000_000n }), null);
  assert.deepEqual(latency.medians(), [8, 12]);
});

test("a series keeps 30 s, and a gap stays a gap", () => {
  const series = new Series("largest");
  for (let time = 0; time < 60; time += BIN_S / 2) series.add(time + BIN_S / 4, time);
  series.add(62, 5);
  series.add(62, 3);
  const values = series.values(binOf(62));
  assert.equal(values.length, 300);
  assert.equal(values.at(-1), 5);
  assert.equal(values.at(-2), null);
  assert.ok(values[0] >= 30, `${values[0]}`);
});

test("words and colours follow state and reason", () => {
  assert.equal(stateClass("never_found"), "never_found");
  assert.equal(stateClass("constructor"), "none");
  const blob = {
    x_px: 10,
    y_px: 20,
    area_px: 12,
    peak: 2000,
    reason: "too_small",
    marker: "",
    distance_m: 0.5,
  };
  assert.equal(blobClass(blob), "refused");
  assert.match(blobText(blob), /refused: too small.* 500 mm/);
  assert.equal(blobClass({ ...blob, reason: "", marker: "pen/1" }), "assigned");
  assert.equal(countAbove(Uint16Array.of(1, 5, 6, 5), 5), 1);
});
