// Reads every recording in FOLDER with @mcap/core, indexed and as a stream, checks every CRC,
// deserialises every payload and compares it with the JSON beside it.
//   node verify_mcap.mjs FOLDER
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";

import { crc32 } from "@foxglove/crc";
import { parse } from "@foxglove/rosmsg";
import { ros2humble, ros2jazzy } from "@foxglove/rosmsg-msgs-common";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";

const noDecompression = {};

// As the JSON holds values: integers of 64 bits as text, typed arrays as plain ones.
function plain(value) {
  if (typeof value === "bigint") return value.toString();
  if (ArrayBuffer.isView(value) || Array.isArray(value)) return Array.from(value, plain);
  if (value !== null && typeof value === "object")
    return Object.fromEntries(Object.entries(value).map(([name, v]) => [name, plain(v)]));
  return value;
}

// Our text of a standard type has the very fields of the distributions' own.
function checkStandardType(definition) {
  const fields = (list) =>
    list.map(({ name, type, isArray, arrayLength }) => ({
      name, isArray: isArray ?? false, arrayLength,
      type: type === "time" ? "builtin_interfaces/Time" : type,
    }));
  for (const distribution of [ros2humble, ros2jazzy]) {
    const known = distribution[definition.name];
    if (known) assert.deepEqual(fields(definition.definitions), fields(known.definitions));
  }
}

function decoderFor(schema, decoders) {
  if (!decoders.has(schema.id)) {
    assert.equal(schema.encoding, "ros2msg");
    const definitions = parse(new TextDecoder().decode(schema.data), { ros2: true });
    definitions[0].name = schema.name.replace("/msg/", "/");
    definitions.forEach(checkStandardType);
    decoders.set(schema.id, new MessageReader(definitions));
  }
  return decoders.get(schema.id);
}

function check(message, channel, schema, expected, decoders) {
  assert.equal(channel.messageEncoding, "cdr");
  assert.ok(channel.metadata.has("offered_qos_profiles"));
  assert.equal(channel.topic, expected.topic);
  assert.equal(message.logTime.toString(), expected.log_time);
  assert.deepEqual([...message.data.subarray(0, 4)], [0, 1, 0, 0]);
  const value = plain(decoderFor(schema, decoders).readMessage(message.data));
  assert.deepEqual(value, expected.value);
}

function checkStream(bytes, expected) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers: noDecompression });
  reader.append(bytes);
  const schemas = new Map(), channels = new Map(), decoders = new Map();
  let count = 0, dataEnd;
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") schemas.set(record.id, record);
    if (record.type === "Channel") channels.set(record.id, record);
    if (record.type === "DataEnd") dataEnd = record;
    if (record.type === "Message") {
      const channel = channels.get(record.channelId);
      check(record, channel, schemas.get(channel.schemaId), expected.messages[count], decoders);
      assert.equal(record.sequence, count++);
    }
  }
  assert.ok(reader.done());
  assert.equal(reader.bytesRemaining(), 0);
  assert.equal(count, expected.messages.length);
  return dataEnd.dataSectionCrc;
}

async function checkIndexed(bytes, expected, streamCrc) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.slice(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers: noDecompression });
  assert.equal(reader.header.profile, "ros2");
  assert.equal(reader.statistics.messageCount, BigInt(expected.messages.length));
  assert.equal(reader.dataSectionCrc, streamCrc);
  assert.equal(crc32(bytes.subarray(0, Number(reader.dataEndOffset))), streamCrc);

  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (const chunk of reader.chunkIndexes)
    for (const [channel, offset] of chunk.messageIndexOffsets) {
      assert.equal(bytes[Number(offset)], 7, "a message index record");
      assert.equal(view.getUint16(Number(offset) + 9, true), channel);
    }

  // By topic in the order of log times, as a viewer asks.
  const topics = new Map();
  for (const message of expected.messages) {
    if (!topics.has(message.topic)) topics.set(message.topic, []);
    topics.get(message.topic).push(message);
  }
  const decoders = new Map();
  let count = 0;
  for (const [topic, wanted] of topics) {
    wanted.sort((a, b) => (BigInt(a.log_time) < BigInt(b.log_time) ? -1 : 1) * (a.log_time !== b.log_time));
    let i = 0;
    for await (const message of reader.readMessages({ topics: [topic], validateCrcs: true })) {
      const channel = reader.channelsById.get(message.channelId);
      check(message, channel, reader.schemasById.get(channel.schemaId), wanted[i++], decoders);
    }
    assert.equal(i, wanted.length);
    count += i;
  }
  assert.equal(count, expected.messages.length);

  const attachments = [];
  for await (const { name, mediaType, data } of reader.readAttachments({ validateCrcs: true }))
    attachments.push({ name, media_type: mediaType, data: [...data] });
  assert.deepEqual(attachments, expected.attachments);

  const facts = new Map();
  for await (const { name, metadata } of reader.readMetadata())
    for (const [key, value] of metadata) facts.set(`${name}/${key}`, value);
  assert.equal(facts.get("glint/level"), expected.level);
  assert.equal(facts.get("glint_end/complete"), "true");
  assert.equal(facts.get("glint_end/output_sha256"), expected.output_sha256);
}

const folder = process.argv[2];
const recordings = readdirSync(folder).filter((name) => name.endsWith(".mcap")).sort();
assert.deepEqual(recordings, ["blobs.mcap", "full.mcap", "outputs.mcap", "roi.mcap"]);
for (const name of recordings) {
  const bytes = new Uint8Array(readFileSync(join(folder, name)));
  const expected = JSON.parse(readFileSync(join(folder, name.replace(".mcap", ".json")), "utf8"));
  await checkIndexed(bytes, expected, checkStream(bytes, expected));
  console.log(`${name}: ${expected.messages.length} messages, every value equal`);
}
