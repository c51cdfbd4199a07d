// Messages of a recording (MCAP), read from the file by its index: a file may exceed the memory.
import { McapIndexedReader } from "@mcap/core";

class BlobReadable {
  constructor(blob) {
    this.blob = blob;
  }
  async size() {
    return BigInt(this.blob.size);
  }
  async read(offset, length) {
    const part = this.blob.slice(Number(offset), Number(offset + length));
    return new Uint8Array(await part.arrayBuffer());
  }
}

export class RecordingFile {
  // Throws with a text for the user if the file is no readable recording.
  static async open(file) {
    let reader;
    try {
      reader = await McapIndexedReader.Initialize({ readable: new BlobReadable(file) });
    } catch (error) {
      throw new Error(
        `${file.name}: no complete MCAP recording (${error.message}); expected a file that a run closed`,
      );
    }
    if (reader.chunkIndexes.length === 0)
      throw new Error(`${file.name}: no messages; expected a recording with chunks`);
    return new RecordingFile(file.name, reader);
  }

  constructor(name, reader) {
    this.name = name;
    this.reader = reader;
    const least = (a, b) => (a < b ? a : b),
      largest = (a, b) => (a > b ? a : b);
    this.start = reader.chunkIndexes.map((chunk) => chunk.messageStartTime).reduce(least);
    this.end = reader.chunkIndexes.map((chunk) => chunk.messageEndTime).reduce(largest);
    const text = new TextDecoder();
    this.channels = new Map();
    for (const channel of reader.channelsById.values()) {
      const schema = reader.schemasById.get(channel.schemaId);
      this.channels.set(channel.id, {
        id: channel.id,
        topic: channel.topic,
        encoding: channel.messageEncoding,
        schemaName: schema?.name ?? "",
        schema: schema ? text.decode(schema.data) : "",
      });
    }
  }

  // Calls receive(channel, time_ns, bytes) in the order of time, for start <= time <= end.
  async read(startTime, endTime, receive) {
    for await (const message of this.reader.readMessages({ startTime, endTime })) {
      receive(this.channels.get(message.channelId), message.logTime, message.data);
    }
  }
}
