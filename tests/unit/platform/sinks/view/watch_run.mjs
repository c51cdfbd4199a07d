// Watches a live run with Foxglove's client, and compares what arrives with the run's recording.
//   node watch_run.mjs GLINT OUT_FOLDER DEFAULT_CELL
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import foxglove from "@foxglove/ws-protocol";
import { McapStreamReader } from "@mcap/core";
import WebSocket from "ws";

import { acceptable, runStarter } from "./start_run.mjs";

const [glint, folder, defaultCell] = process.argv.slice(2);
// With pictures in the recording, too, each message of the view is a recorded one.
mkdirSync(folder, { recursive: true });
const cell = join(folder, "pictures.toml");
writeFileSync(cell, readFileSync(defaultCell, "utf8").replace("[record]\n", "[record]\npictures = true\n"));
const { FoxgloveClient } = foxglove;
const protocol = FoxgloveClient.SUPPORTED_SUBPROTOCOL;
const startRun = runStarter(glint, folder, "--config", cell);

const viewFigures = (name) => JSON.parse(readFileSync(join(folder, `${name}.json`), "utf8")).view;

// Subscribes to every channel and stores what arrives until the server disconnects.
function watch(address) {
  const client = new FoxgloveClient({ ws: new WebSocket(address, [protocol]) });
  const channels = new Map(), messages = [];
  const closed = new Promise((resolve) => client.on("close", resolve));
  client.on("error", (error) => console.error("client:", error.message));
  client.on("advertise", (added) => {
    for (const channel of added) channels.set(client.subscribe(channel.id), channel);
  });
  client.on("message", ({ subscriptionId, timestamp, data }) => {
    messages.push({ channel: channels.get(subscriptionId), timestamp,
      data: Buffer.from(data.buffer, data.byteOffset, data.byteLength) });
  });
  return { client, channels, messages, closed };
}

// By topic: the recorded messages in the file's order, and the schema.
function recordedTopics(file) {
  const reader = new McapStreamReader();
  reader.append(readFileSync(file));
  const schemas = new Map(), topics = new Map(), channels = new Map();
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel" && !channels.has(record.id)) {
      const schema = schemas.get(record.schemaId);
      const topic = { name: schema.name, schema: new TextDecoder().decode(schema.data), messages: [] };
      channels.set(record.id, topic);
      topics.set(record.topic, topic);
    }
    if (record.type === "Message") {
      channels.get(record.channelId).messages.push({ time: record.logTime, data: Buffer.from(record.data) });
    }
  }
  return topics;
}

// Every message that arrived is a recorded one, in the order of the recording. The newest small
// message of a channel comes first; after it none is absent, unless the client may lose some.
function compare(watched, topics, mayLose) {
  let decoded = 0;
  assert.deepEqual([...watched.channels.values()].map(({ topic }) => topic).sort(),
    [...topics.keys()].sort());
  for (const channel of watched.channels.values()) {
    const recorded = topics.get(channel.topic);
    assert.equal(channel.encoding, "cdr");
    assert.equal(channel.schemaName, recorded.name);
    assert.equal(channel.schema, recorded.schema);
    const decoder = new MessageReader(parse(channel.schema, { ros2: true }));
    let at = -1;
    const arrived = watched.messages.filter((message) => message.channel === channel);
    for (const [number, { timestamp, data }] of arrived.entries()) {
      const next = recorded.messages.findIndex(
        (message, i) => i > at && message.time === timestamp && message.data.equals(data));
      assert.ok(next > at, `${channel.topic}: message ${number} is not in the recording`);
      assert.ok(mayLose || number <= 1 || next === at + 1, `${channel.topic}: ${next - at - 1} messages are absent`);
      at = next;
      assert.ok(Object.keys(decoder.readMessage(data)).length > 0);
      ++decoded;
    }
    if (recorded.messages.length > 0 && !mayLose) {
      assert.ok(arrived.length > 0, `${channel.topic}: nothing arrived`);
      assert.ok(recorded.messages.length - 1 - at <= 0, `${channel.topic}: the end is absent`);
    }
  }
  return decoded;
}

const refusal = (address, protocols, options) => new Promise((resolve) => {
  const socket = new WebSocket(address, protocols, options);
  socket.on("open", () => { socket.close(); resolve("accepted"); });
  socket.on("error", () => resolve("refused"));
});

// A run whose messages all fit into the queue: a slow client loses none of them.
{
  const { ended, address, output } = startRun("0", "run", "--duration", "3", "--record-level", "roi");
  const url = await address;
  const watched = watch(url);
  const second = startRun(new URL(url).port, "second", "--duration", "1");
  await assert.rejects(second.address, /ended with 3: .*cannot listen on 127.0.0.1 port/s);
  await watched.closed;
  assert.ok(acceptable(await ended, output()), output());
  const decoded = compare(watched, recordedTopics(join(folder, "run", "run.mcap")), false);
  assert.equal(viewFigures("run").dropped, 0);
  console.log(`${decoded} messages of ${watched.channels.size} channels decoded, all as recorded`);
}

// A run with images, a client that never reads, and clients that are refused or send nonsense.
{
  const { ended, address, output } = startRun("0", "run", "--duration", "5", "--record-level", "full");
  const url = await address;
  const watched = watch(url);
  const silent = new WebSocket(url, [protocol]);
  silent.on("message", (text) => {
    const { op, channels } = JSON.parse(text);
    if (op !== "advertise") return;
    silent.send(JSON.stringify({ op: "subscribe",
      subscriptions: channels.map(({ id }) => ({ id, channelId: id })) }));
    if (channels.some(({ topic }) => topic === "/glint/depth")) silent._socket.pause();
  });
  assert.equal(await refusal(url, [protocol], { origin: "https://example.org" }), "refused");
  assert.equal(await refusal(url, [protocol], { origin: "null" }), "refused");
  assert.equal(await refusal(url, [protocol], { origin: "http://localhost:8080" }), "accepted");
  assert.equal(await refusal(url, ["another.protocol"], {}), "refused");

  const rude = new WebSocket(url, [protocol]);
  const requests = ["{", "[]", '{"op":"subscribe"}', '{"op":"unsubscribe","subscriptionIds":["1"]}',
    '{"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]}',
    '{"op":"subscribe","subscriptions":[{"id":1,"channelId":60000}]}', "[".repeat(60_000)];
  let answers = 0;
  const answered = new Promise((resolve) => rude.on("message", (text, isBinary) => {
    if (!isBinary && JSON.parse(text).op === "status" && ++answers === requests.length) resolve();
  }));
  const disconnected = new Promise((resolve) => rude.on("close", resolve));
  rude.on("open", () => requests.forEach((request) => rude.send(request)));
  await answered;
  rude.send("x".repeat(300_000));
  await disconnected;
  await watched.closed;
  assert.ok(acceptable(await ended, output()), output());

  compare(watched, recordedTopics(join(folder, "run", "run.mcap")), true);
  const figures = viewFigures("run");
  assert.equal(figures.clients, 4);
  assert.ok(figures.refused >= 2, "two pages of other origins are refused");
  assert.equal(figures.invalid, requests.length);
  assert.ok(figures.dropped > 0, "the client that never reads loses messages");
  console.log(`${figures.dropped} messages left the queue before the client that never reads`);
}
