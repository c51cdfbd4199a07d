// Opens the live view's page: runs in six situations, a recording, the record button, refusals.
//   node check_page.mjs GLINT OUT_FOLDER SAMPLES_FOLDER BUNDLED_PAGE BROWSER
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { openPage, sentenceIs, startBrowser } from "./browser.mjs";
import { checkMessages } from "./check_messages.mjs";
import { checkRecordButton } from "./check_record_button.mjs";
import { checkServer } from "./check_server.mjs";
import { runStarter, startView } from "./start_run.mjs";

const [glint, folder, samples, bundled, program] = process.argv.slice(2);
const startRun = runStarter(glint, folder);
const file = (name) => join(folder, name);
const browser = await startBrowser(program);

const PAGE_SECONDS_MAX = "300"; // of a run: each is stopped as soon as the page shows its situation
const cell = (name, text) => {
  writeFileSync(file(`${name}.toml`), text);
  return ["--config", file(`${name}.toml`)];
};

// Starts a run, and checks what the page shows of it. Then the run is stopped.
const situation = (name, options, check) =>
  shows(name, startRun("0", name, "--duration", PAGE_SECONDS_MAX, ...options), check);

async function shows(name, run, check) {
  const address = await run.address;
  const opened = await openPage(browser, address, folder);
  try {
    await check(opened, run, address);
    await opened.page.screenshot({ path: file(`${name}.png`), fullPage: true });
    await opened.page.setViewport({ width: 390, height: 844, deviceScaleFactor: 2 });
    await opened.page.screenshot({ path: file(`${name}_phone.png`), fullPage: true });
    const { scroll, inner } = await opened.page.evaluate(() => ({
      scroll: document.documentElement.scrollWidth,
      inner: innerWidth,
    }));
    assert.ok(scroll <= inner, `${name}: the page is ${scroll} px wide on a phone of ${inner} px`);
    await opened.close();
  } finally {
    run.process.stdin.write("\x03"); // of a terminal
    run.process.kill("SIGCONT");
    run.process.kill("SIGTERM");
    await run.ended;
  }
  console.log(`${name}: as expected`);
}

let refused = 0;
await situation("tracked", [], async (opened, run, address) => {
  const { page, until } = opened;
  await until("tracked", sentenceIs, "measured", "pen.*tracked");
  await until(
    "a picture with the pen's markers",
    () => document.querySelector("#picture.has-data") !== null,
  );
  await page.focus("#picture-canvas");
  await until("a blob that is explained", () => {
    const canvas = document.querySelector("#picture-canvas");
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight" }));
    return /marker pen.* px large/.test(document.querySelector("#picture-blob").textContent);
  });
  await page.focus("#threshold-slider");
  await page.keyboard.press("ArrowLeft");
  await until(
    "the cell's line",
    () =>
      /^threshold = \d+$/.test(document.querySelector("#threshold-line").textContent) &&
      /px above, the run uses \d+/.test(document.querySelector("#threshold-value").textContent),
  );
  await until("the pen in space", () =>
    /95 % ellipsoid with half axes [\d.]+/.test(document.querySelector("#scene-text").textContent),
  );
  await until(
    "the latency's stages",
    () => document.querySelectorAll("#latency-bar div").length === 2,
  );
  console.log(`record button: ${await checkRecordButton(opened, folder)} messages, as received`);
  refused = await checkServer(address, readFileSync(bundled, "utf8"));
  await page.screenshot({ path: file("tracked_live.png") });
  run.process.kill("SIGSTOP");
  await until("panels in grey", () =>
    ["sentences", "picture", "scene", "charts"].every((id) =>
      getComputedStyle(document.getElementById(id)).filter.includes("grayscale(1)"),
    ),
  );
});
const figures = JSON.parse(readFileSync(file("tracked.json"), "utf8")).view;
assert.ok(
  figures.refused >= refused,
  `${figures.refused} refusals counted, expected at least ${refused}`,
);

await situation(
  "wrong_threshold",
  cell("threshold", '[camera]\nmodel = "hololens2_ahat"\nthreshold = 60000\n'),
  ({ until }) => until("the threshold in the sentence", sentenceIs, "never_found", "threshold"),
);

await situation(
  "no_frames",
  cell("no_frames", `[source]\nkind = "shm"\npath = "${file("frames.sock")}"\n`),
  ({ until }) =>
    until("no frame", () => /no frame/.test(document.querySelector("#sentences").textContent)),
);

// A recorded run in which a hand hides the pen.
execFileSync(glint, [
  "run",
  "--fast",
  "--duration",
  "31.5",
  "--out",
  file("hidden"),
  ...cell("hidden", "[record]\npictures = true\n"),
]);
await situation(
  "wrong_tool",
  cell(
    "wrong_tool",
    `tools = ["board"]\n[source]\nkind = "recording"\npath = "${file("hidden/run.mcap")}"\n`,
  ),
  ({ until }) => until("the other tool", sentenceIs, "never_found", "board.*tool"),
);

await situation("stroke", ["--keys"], async ({ until }, run) => {
  await until("tracked", sentenceIs, "measured", "pen");
  run.process.stdin.write(" ");
  await until("a stroke", () =>
    /Strokes: \d{2,} points/.test(document.querySelector("#scene-text").textContent),
  );
});

await situation("hidden_by_a_hand", [], async ({ page, until, text }) => {
  await until("live", sentenceIs, "measured", "pen");
  await (await page.$("#file")).uploadFile(file("hidden/run.mcap"));
  await until("the recording", () =>
    /Recording run.mcap/.test(document.querySelector("#source").textContent),
  );
  await page.click("#play");
  const scrubTo = (share) =>
    page.$eval(
      "#scrub",
      (bar, value) => {
        bar.value = String(value);
        bar.dispatchEvent(new Event("input"));
      },
      Math.round(1000 * share),
    );
  const HIDDEN_S = 30.7,
    TRACKED_S = 12,
    LENGTH_S = 31.5;
  await scrubTo(HIDDEN_S / LENGTH_S);
  await until("hidden", sentenceIs, "lost", "not tracked");
  await page.screenshot({ path: file("hidden_scrubbed.png"), fullPage: true });
  await scrubTo(TRACKED_S / LENGTH_S);
  await until("tracked before", sentenceIs, "measured", "tracked");
  assert.match(await text("#scrub-time"), /^1[12]\.\d s of 31\.\d s$/);
  await scrubTo(HIDDEN_S / LENGTH_S);
  await until("hidden again", sentenceIs, "lost", "not tracked");
  assert.equal(
    await page.$eval("#sentences", (element) => element.classList.contains("stale")),
    false,
  );
});

await shows(
  "replayed",
  startView(glint, "replay", file("hidden/run.mcap"), "--view", "0", "--speed", "2"),
  ({ until }) => until("tracked", sentenceIs, "measured", "pen.*tracked"),
);

await checkMessages(
  browser,
  readFileSync(bundled),
  join(samples, "arm.urdf"),
  file("messages.png"),
);
console.log("messages: as expected");
await browser.close();
