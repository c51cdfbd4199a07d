// A headless browser that opens the page of a live view, and what the page asked the network for.
import assert from "node:assert/strict";

import puppeteer from "puppeteer-core";

const LIMIT_MS = 120_000; // of any condition: a busy machine is slow

export const startBrowser = (program) =>
  puppeteer.launch({
    executablePath: program,
    args: ["--no-sandbox", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage"],
    protocolTimeout: 2 * LIMIT_MS,
  });

// Opens the page of ws://HOST:PORT. A request to another origin is aborted and makes close() fail.
export async function openPage(browser, address, downloads) {
  const { host } = new URL(address);
  const page = await browser.newPage();
  const outside = [],
    errors = [],
    frames = [];
  await page.setViewport({ width: 1280, height: 800 });
  page.on("pageerror", (error) => errors.push(error.stack ?? error.message));
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  await page.setRequestInterception(true);
  page.on("request", (request) => {
    const url = new URL(request.url());
    if (url.host === host || url.protocol === "data:" || url.protocol === "blob:")
      return request.continue();
    outside.push(request.url());
    return request.abort();
  });
  const session = await page.createCDPSession();
  await session.send("Network.enable");
  session.on("Network.webSocketCreated", ({ url }) => {
    if (new URL(url).host !== host) outside.push(url);
  });
  const BINARY = 2;
  session.on("Network.webSocketFrameReceived", ({ response: { opcode, payloadData } }) => {
    if (opcode === BINARY) frames.push(Buffer.from(payloadData, "base64"));
  });
  if (downloads) {
    await session.send("Browser.setDownloadBehavior", {
      behavior: "allow",
      downloadPath: downloads,
    });
  }
  await page.goto(`http://${host}/`);
  return {
    page,
    frames,
    text: (selector) => page.$eval(selector, (element) => element.textContent),
    // Waits until condition(...values) holds in the page; fails with the page's text.
    async until(what, condition, ...values) {
      try {
        await page.waitForFunction(condition, { timeout: LIMIT_MS, polling: 50 }, ...values);
      } catch {
        const shown = await page.$eval("body", (body) => body.innerText);
        assert.fail(`not seen: ${what}; the page shows: ${shown}`);
      }
    },
    async close() {
      assert.deepEqual(outside, [], "the page asks no other host");
      assert.deepEqual(errors, [], "no error in the page");
      await page.close();
    },
  };
}

// The condition of a tool's sentence, for until().
export const sentenceIs = (state, words) => {
  const sentence = document.querySelector(`#sentences .sentence.${state}`);
  return sentence !== null && new RegExp(words, "i").test(sentence.textContent);
};
