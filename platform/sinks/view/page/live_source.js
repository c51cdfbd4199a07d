// Messages of the run: a client of the WebSocket that the page's own server offers.
import { FoxgloveClient } from "@foxglove/ws-protocol";

const RETRY_MS = 1000;
// Images of record level full, 45 a second: /glint/picture shows the same frames.
const LARGE_TOPICS = new Set(["/glint/reflectivity", "/glint/depth"]);

export class LiveSource {
  #address;
  #receiver;
  #client = null;
  #retry = 0;
  #closed = false;

  // receiver: { connected(), disconnected(), channel(channel), message(channel, time_ns, bytes) }.
  constructor(address, receiver) {
    this.#address = address;
    this.#receiver = receiver;
    this.#connect();
  }

  close() {
    this.#closed = true;
    clearTimeout(this.#retry);
    this.#client?.close();
  }

  #connect() {
    const socket = new WebSocket(this.#address, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
    const client = (this.#client = new FoxgloveClient({ ws: socket }));
    const channels = new Map();
    client.on("open", () => this.#receiver.connected());
    client.on("error", () => {}); // "close" follows
    client.on("advertise", (added) => {
      for (const channel of added) {
        if (LARGE_TOPICS.has(channel.topic)) continue;
        this.#receiver.channel(channel);
        channels.set(client.subscribe(channel.id), channel);
      }
    });
    client.on("message", ({ subscriptionId, timestamp, data }) => {
      const channel = channels.get(subscriptionId);
      if (channel === undefined || this.#closed) return;
      this.#receiver.message(
        channel,
        timestamp,
        new Uint8Array(data.buffer, data.byteOffset, data.byteLength),
      );
    });
    client.on("close", () => {
      if (this.#closed) return;
      this.#receiver.disconnected();
      this.#retry = setTimeout(() => this.#connect(), RETRY_MS);
    });
  }
}
