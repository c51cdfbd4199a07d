// What the live view's server answers besides its page: refusals.
import assert from "node:assert/strict";
import { request } from "node:http";

import WebSocket from "ws";

// The status is 0 if the server disconnects without an answer, or before its answer is read: it
// does so on a request with a body, which it does not read.
const answer = (address, options) =>
  new Promise((resolve) => {
    const { hostname, port } = new URL(address);
    const sent = request({ hostname, port, ...options }, (response) => {
      const parts = [];
      response.on("data", (part) => parts.push(part));
      response.on("end", () =>
        resolve({
          status: response.statusCode,
          headers: response.headers,
          body: Buffer.concat(parts).toString(),
        }),
      );
    });
    sent.on("error", () => resolve({ status: 0 }));
    sent.end(options.body);
  });

// GET / returns the page, which may load nothing from elsewhere; anything else is refused. Returns
// the number of refusals.
export async function checkServer(address, html) {
  const page = await answer(address, { path: "/" });
  assert.equal(page.status, 200);
  assert.ok(page.body === html, "the page is the one that was bundled");
  assert.match(page.headers["content-type"], /^text\/html/);
  const policy = page.headers["content-security-policy"];
  assert.match(policy, /^default-src 'none'; script-src 'sha256-/);
  assert.doesNotMatch(policy, /https?:|\*|unsafe/);
  const refused = [
    [{ path: "/", method: "POST", body: "x" }, 0, 405],
    [{ path: "/", method: "HEAD" }, 405],
    [{ path: "/", method: "PUT", body: "x" }, 0, 405],
    [{ path: "/index.html" }, 404],
    [{ path: "/../etc/passwd" }, 404],
    [{ path: "/", headers: { "content-length": "1" }, body: "x" }, 0, 413],
    [{ path: "/", headers: { large: "x".repeat(20_000) } }, 0],
  ];
  for (const [options, ...expected] of refused) {
    const { status } = await answer(address, options);
    assert.ok(
      expected.includes(status),
      `${options.method ?? "GET"} ${options.path}: ${status}, expected ${expected}`,
    );
  }
  const hostile = new WebSocket(address, ["foxglove.websocket.v1"], {
    origin: "http://attacker.example",
  });
  await assert.rejects(
    new Promise((resolve, reject) => hostile.on("open", resolve).on("error", reject)),
  );
  // The owner of a name lets it lead here: the page has that origin, and the request that host.
  const { port } = new URL(address);
  const rebound = new WebSocket(address, ["foxglove.websocket.v1"], {
    origin: `http://attacker.example:${port}`,
    headers: { host: `attacker.example:${port}` },
  });
  await assert.rejects(
    new Promise((resolve, reject) => rebound.on("open", resolve).on("error", reject)),
  );
  return refused.length + 2;
}
