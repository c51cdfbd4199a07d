// The file of the record button against what the browser received.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";

import { McapStreamReader } from "@mcap/core";

// Stored by the record button, the messages are a part of those that the browser received.
export async function checkRecordButton({ page, frames, until }, folder) {
  await page.click("#record");
  await until("a second of messages", () =>
    /[1-9]\d* s, \d{3,} messages/.test(document.querySelector("#record").textContent),
  );
  await page.click("#record");
  let stored = [];
  const isStored = () =>
    (stored = readdirSync(folder).filter((name) => /^glint-.*\.mcap$/.test(name))).length > 0;
  while (!isStored()) await new Promise((resolve) => setTimeout(resolve, 50));
  const reader = new McapStreamReader();
  reader.append(readFileSync(join(folder, stored[0])));
  const messages = [];
  const HEAD_BYTES = 13;
  for (let record; (record = reader.nextRecord());)
    if (record.type === "Message") messages.push(record);
  assert.ok(reader.done(), "the file is complete");
  assert.ok(messages.length >= 100, `${messages.length} messages`);
  const isEqual = (message, received) =>
    received.readBigUInt64LE(5) === message.logTime &&
    received.subarray(HEAD_BYTES).equals(Buffer.from(message.data));
  const begin = frames.findIndex(
    (received, at) => isEqual(messages[0], received) && isEqual(messages[1], frames[at + 1]),
  );
  assert.ok(begin >= 0, "the first stored message was received");
  messages.forEach((message, i) =>
    assert.ok(isEqual(message, frames[begin + i]), `message ${i} of ${messages.length}`),
  );
  return messages.length;
}
