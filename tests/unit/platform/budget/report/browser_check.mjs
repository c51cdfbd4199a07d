// What a browser made of the report: browser_check.mjs dom FILE | requests NETLOG | picture PNG W H
import { readFileSync } from "node:fs";
import { inflateSync } from "node:zlib";

const [kind, file, width, height] = process.argv.slice(2);

function fail(message) {
  console.error(`${file}: ${message}`);
  process.exit(1);
}

// Every section that the report promises, as the browser understood it.
function checkDom(text) {
  const sections = ["verdict", "reading", "chains", "slack", "groups", "schedule", "nodes", "loops",
    "costs", "interference", "can", "estimates", "worst-frames", "footprint", "spoiled", "inputs"];
  for (const id of sections) {
    if (!text.includes(`id="${id}"`)) fail(`no section ${id}`);
  }
  const figures = (text.match(/<svg/g) ?? []).length;
  if (figures < 20) fail(`${figures} figures; expected at least 20`);
  console.log(`${sections.length} sections, ${figures} figures`);
}

// The page itself is a file; anything else that was asked for is one too many.
function checkRequests(text) {
  const log = JSON.parse(text.trimEnd().replace(/,\s*$/, "]}"));
  const start = log.constants.logEventTypes.URL_REQUEST_START_JOB;
  if (start === undefined) fail("a net log without URL_REQUEST_START_JOB; expected Chromium's");
  const urls = log.events.filter((e) => e.type === start && e.params?.url).map((e) => e.params.url);
  const outside = urls.filter((url) => /^(https?|wss?|ftp):/.test(url));
  if (outside.length > 0) fail(`asked for ${outside.join(" ")}`);
  console.log(`${log.events.length} events, 0 requests to a network`);
}

// Width, height and how many different colours a PNG of 8 bits a channel has.
function readPng(bytes) {
  const at = (offset) => bytes.readUInt32BE(offset);
  const channels = { 2: 3, 6: 4 }[bytes[25]];
  if (bytes[24] !== 8 || channels === undefined) fail("expected 8 bits of RGB or RGBA");
  const parts = [];
  for (let place = 8; place < bytes.length; place += 12 + at(place)) {
    if (bytes.toString("latin1", place + 4, place + 8) === "IDAT") {
      parts.push(bytes.subarray(place + 8, place + 8 + at(place)));
    }
  }
  const raw = inflateSync(Buffer.concat(parts));
  const size = { width: at(16), height: at(20) };
  const stride = size.width * channels;
  const colours = new Set();
  let inked = 0, before = Buffer.alloc(stride), background = null;
  for (let y = 0; y < size.height; y++) {
    const filter = raw[y * (stride + 1)];
    const row = Buffer.from(raw.subarray(y * (stride + 1) + 1, (y + 1) * (stride + 1)));
    for (let i = 0; i < stride; i++) {
      const left = i >= channels ? row[i - channels] : 0, up = before[i];
      const corner = i >= channels ? before[i - channels] : 0;
      const guess = left + up - corner;
      const dl = Math.abs(guess - left), du = Math.abs(guess - up), dc = Math.abs(guess - corner);
      const paeth = dl <= du && dl <= dc ? left : du <= dc ? up : corner;
      row[i] += [0, left, up, (left + up) >> 1, paeth][filter];
    }
    for (let i = 0; i < stride; i += channels) {
      const colour = (row[i] << 16) | (row[i + 1] << 8) | row[i + 2];
      background ??= colour;
      colours.add(colour);
      if (colour !== background) inked++;
    }
    before = row;
  }
  return { ...size, colours: colours.size, inked: inked / (size.width * size.height) };
}

function checkPicture(bytes) {
  const seen = readPng(bytes);
  if (seen.width !== Number(width) || seen.height !== Number(height)) {
    fail(`${seen.width} x ${seen.height}; expected ${width} x ${height}`);
  }
  if (seen.colours < 100 || seen.inked < 0.05) {
    fail(`${seen.colours} colours on ${(100 * seen.inked).toFixed(1)} %: looks empty`);
  }
  console.log(`${seen.colours} colours on ${(100 * seen.inked).toFixed(1)} % of the picture`);
}

if (kind === "dom") checkDom(readFileSync(file, "utf8"));
else if (kind === "requests") checkRequests(readFileSync(file, "utf8"));
else if (kind === "picture") checkPicture(readFileSync(file));
else fail(`unknown check ${kind}`);
