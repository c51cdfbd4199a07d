// Stores the messages that the page receives as an MCAP file, in the browser alone.
import { McapWriter } from "@mcap/core";

export const STORED_BYTES_MAX = 512 << 20;

class MemoryWritable {
  parts = [];
  #position = 0n;
  async write(bytes) {
    this.parts.push(bytes.slice());
    this.#position += BigInt(bytes.byteLength);
  }
  position() {
    return this.#position;
  }
}

export class StreamRecorder {
  #writable = new MemoryWritable();
  #writer = new McapWriter({ writable: this.#writable });
  #numbers = new Map(); // by channel
  #task;
  #bytes = 0;
  messages = 0;
  lost = 0; // beyond STORED_BYTES_MAX

  constructor() {
    this.#task = this.#writer.start({ profile: "ros2", library: "glint view" });
  }

  get isFull() {
    return this.lost > 0;
  }

  add(channel, time, bytes) {
    this.#bytes += bytes.byteLength;
    if (this.isFull || this.#bytes > STORED_BYTES_MAX) {
      ++this.lost;
      return;
    }
    const sequence = this.messages++;
    this.#task = this.#task.then(async () => {
      const channelId = this.#numbers.get(channel) ?? (await this.#register(channel));
      await this.#writer.addMessage({
        channelId,
        sequence,
        logTime: time,
        publishTime: time,
        data: bytes,
      });
    });
  }

  async #register(channel) {
    const schemaId = await this.#writer.registerSchema({
      name: channel.schemaName,
      encoding: "ros2msg",
      data: new TextEncoder().encode(channel.schema),
    });
    const number = await this.#writer.registerChannel({
      schemaId,
      topic: channel.topic,
      messageEncoding: channel.encoding,
      metadata: new Map([["offered_qos_profiles", ""]]),
    });
    this.#numbers.set(channel, number);
    return number;
  }

  // Returns the complete file.
  async close() {
    await this.#task;
    await this.#writer.end();
    return new Blob(this.#writable.parts, { type: "application/octet-stream" });
  }
}
