// Opens the live view's page: runs in six situations, a recording, the record button, refusals.
//   node check_page.mjs GLINT OUT_FOLDER SAMPLES_FOLDER BROWSER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { request } from "node:http";
import { join } from "node:path";

import { McapStreamReader } from "@mcap/core";
import WebSocket from "ws";

import { openPage, sentenceIs, startBrowser } from "./browser.mjs";
import { runStarter } from "./start_run.mjs";

const [glint, folder, samples, program] = process.argv.slice(2);
const startRun = runStarter(glint, folder);
const file = (name) => join(folder, name);
const browser = await startBrowser(program);

const PAGE_SECONDS_MAX = "300";  // of a run: each is stopped as soon as the page shows its situation
const cell = (name, text) => {
  writeFileSync(file(`${name}.toml`), text);
  return ["--config", file(`${name}.toml`)];
};

// The status is 0 if the server disconnects without an answer, or before its answer is read: it does
// so on a request with a body, which it does not read.
const answer = (address, options) => new Promise((resolve) => {
  const { hostname, port } = new URL(address);
  const sent = request({ hostname, port, ...options }, (response) => {
    const parts = [];
    response.on("data", (part) => parts.push(part));
    response.on("end", () => resolve({ status: response.statusCode, headers: response.headers, body: Buffer.concat(parts).toString() }));
  });
  sent.on("error", () => resolve({ status: 0 }));
  sent.end(options.body);
});

// Starts a run, and checks what the page shows of it. Then the run is stopped.
async function situation(name, options, check) {
  const run = startRun("0", name, "--duration", PAGE_SECONDS_MAX, ...options);
  const address = await run.address;
  const opened = await openPage(browser, address, folder);
  try {
    await check(opened, run, address);
    await opened.page.screenshot({ path: file(`${name}.png`), fullPage: true });
    await opened.page.setViewport({ width: 390, height: 844, deviceScaleFactor: 2 });
    await opened.page.screenshot({ path: file(`${name}_phone.png`), fullPage: true });
    const { scroll, inner } = await opened.page.evaluate(() =>
      ({ scroll: document.documentElement.scrollWidth, inner: innerWidth }));
    assert.ok(scroll <= inner, `${name}: the page is ${scroll} px wide on a phone of ${inner} px`);
    await opened.close();
  } finally {
    run.process.stdin.write("\x03");  // of a terminal
    run.process.kill("SIGCONT");
    run.process.kill("SIGTERM");
    await run.ended;
  }
  console.log(`${name}: as expected`);
}

// Anything but GET / is refused, and the page may load nothing from elsewhere.
async function checkServer(address) {
  const page = await answer(address, { path: "/" });
  assert.equal(page.status, 200);
  assert.match(page.headers["content-type"], /^text\/html/);
  const policy = page.headers["content-security-policy"];
  assert.match(policy, /^default-src 'none'; script-src 'sha256-/);
  assert.doesNotMatch(policy, /https?:|\*|unsafe/);
  const refused = [[{ path: "/", method: "POST", body: "x" }, 0, 405], [{ path: "/", method: "HEAD" }, 405],
    [{ path: "/", method: "PUT", body: "x" }, 0, 405], [{ path: "/index.html" }, 404],
    [{ path: "/../etc/passwd" }, 404], [{ path: "/", headers: { "content-length": "1" }, body: "x" }, 0, 413],
    [{ path: "/", headers: { large: "x".repeat(20_000) } }, 0]];
  for (const [options, ...expected] of refused) {
    const { status } = await answer(address, options);
    assert.ok(expected.includes(status), `${options.method ?? "GET"} ${options.path}: ${status}, expected ${expected}`);
  }
  const hostile = new WebSocket(address, ["foxglove.websocket.v1"], { origin: "http://attacker.example" });
  await assert.rejects(new Promise((resolve, reject) => hostile.on("open", resolve).on("error", reject)));
  // The owner of a name lets it lead here: the page has that origin, and the request that host.
  const { port } = new URL(address);
  const rebound = new WebSocket(address, ["foxglove.websocket.v1"],
    { origin: `http://attacker.example:${port}`, headers: { host: `attacker.example:${port}` } });
  await assert.rejects(new Promise((resolve, reject) => rebound.on("open", resolve).on("error", reject)));
  return refused.length + 2;
}

// Stored by the record button, the messages are a part of those that the browser received.
async function checkRecordButton({ page, frames, until }) {
  await page.click("#record");
  await until("a second of messages", () => /[1-9]\d* s, \d{3,} messages/.test(document.querySelector("#record").textContent));
  await page.click("#record");
  let stored = [];
  const isStored = () => (stored = readdirSync(folder).filter((name) => /^glint-.*\.mcap$/.test(name))).length > 0;
  while (!isStored()) await new Promise((resolve) => setTimeout(resolve, 50));
  const reader = new McapStreamReader();
  reader.append(readFileSync(file(stored[0])));
  const messages = [];
  const HEAD_BYTES = 13;
  for (let record; (record = reader.nextRecord()); ) if (record.type === "Message") messages.push(record);
  assert.ok(reader.done(), "the file is complete");
  assert.ok(messages.length >= 100, `${messages.length} messages`);
  const isEqual = (message, received) => received.readBigUInt64LE(5) === message.logTime &&
    received.subarray(HEAD_BYTES).equals(Buffer.from(message.data));
  const begin = frames.findIndex((received, at) => isEqual(messages[0], received) && isEqual(messages[1], frames[at + 1]));
  assert.ok(begin >= 0, "the first stored message was received");
  messages.forEach((message, i) => assert.ok(isEqual(message, frames[begin + i]), `message ${i} of ${messages.length}`));
  return messages.length;
}

let refused = 0;
await situation("tracked", [], async (opened, run, address) => {
  const { page, until } = opened;
  await until("tracked", sentenceIs, "measured", "pen.*tracked");
  await until("a picture with the pen's markers", () => document.querySelector("#picture.has-data") !== null);
  await page.focus("#picture-canvas");
  await until("a blob that is explained", () => {
    const canvas = document.querySelector("#picture-canvas");
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
    return /marker pen.* px large/.test(document.querySelector("#picture-blob").textContent);
  });
  await page.focus("#threshold-slider");
  await page.keyboard.press("ArrowLeft");
  await until("the cell's line", () => /^\[camera\] threshold = \d+$/.test(document.querySelector("#threshold-line").textContent) &&
    /px above, the run uses \d+/.test(document.querySelector("#threshold-value").textContent));
  await until("the pen in space", () => /95 % ellipsoid with half axes [\d.]+/.test(document.querySelector("#scene-text").textContent));
  await until("the latency's stages", () => document.querySelectorAll("#latency-bar div").length === 2);
  console.log(`record button: ${await checkRecordButton(opened)} messages, as received`);
  refused = await checkServer(address);
  await page.screenshot({ path: file("tracked_live.png") });
  run.process.kill("SIGSTOP");
  await until("stale panels in grey", () => ["sentences", "picture", "scene", "charts"].every((id) =>
    document.getElementById(id).classList.contains("stale")));
  assert.match(await page.$eval("#sentences", (element) => getComputedStyle(element).filter), /grayscale\(1\)/);
});
const figures = JSON.parse(readFileSync(file("tracked.json"), "utf8")).view;
assert.ok(figures.refused >= refused, `${figures.refused} refusals counted, expected at least ${refused}`);

await situation("wrong_threshold", cell("threshold", '[camera]\nmodel = "hololens2_ahat"\nthreshold = 60000\n'),
  ({ until }) => until("the threshold in the sentence", sentenceIs, "never_found", "threshold"));

await situation("no_frames", cell("no_frames", `[source]\nkind = "shm"\npath = "${file("frames.sock")}"\n`),
  ({ until }) => until("no frame", () => /no frame/.test(document.querySelector("#sentences").textContent)));

execFileSync(glint, ["simulate", "--duration", "3", "--out", file("pen")]);
await situation("wrong_tool", cell("wrong_tool", `tools = ["board"]\n[source]\nkind = "recording"\npath = "${file("pen/frames.mcap")}"\n`),
  ({ until }) => until("the other tool", sentenceIs, "never_found", "board.*tool"));

await situation("stroke", ["--keys"], async ({ until }, run) => {
  await until("tracked", sentenceIs, "measured", "pen");
  run.process.stdin.write(" ");
  await until("a stroke", () => /\d+ points of strokes/.test(document.querySelector("#scene-text").textContent));
});

// A recorded run in which a hand hides the pen, scrubbed to that time.
execFileSync(glint, ["run", "--fast", "--duration", "31.5", "--out", file("hidden"),
  ...cell("hidden", '[record]\npictures = true\n')]);
await situation("hidden_by_a_hand", [], async ({ page, until, text }) => {
  await until("live", sentenceIs, "measured", "pen");
  await (await page.$("#file")).uploadFile(file("hidden/run.mcap"));
  await until("the recording", () => /Recording run.mcap/.test(document.querySelector("#source").textContent));
  await page.click("#play");
  const scrubTo = (share) => page.$eval("#scrub", (bar, value) => {
    bar.value = String(value);
    bar.dispatchEvent(new Event("input"));
  }, Math.round(1000 * share));
  const HIDDEN_S = 30.7, TRACKED_S = 12, LENGTH_S = 31.5;
  await scrubTo(HIDDEN_S / LENGTH_S);
  await until("hidden", sentenceIs, "lost", "not tracked");
  await page.screenshot({ path: file("hidden_scrubbed.png"), fullPage: true });
  await scrubTo(TRACKED_S / LENGTH_S);
  await until("tracked before", sentenceIs, "measured", "tracked");
  assert.match(await text("#scrub-time"), /^1[12]\.\d s of 31\.\d s$/);
  await scrubTo(HIDDEN_S / LENGTH_S);
  await until("hidden again", sentenceIs, "lost", "not tracked");
  assert.equal(await page.$eval("#sentences", (element) => element.classList.contains("stale")), false);
});

await browser.close();
