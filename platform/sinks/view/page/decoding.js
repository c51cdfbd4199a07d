// Decodes messages by the schema that their channel delivers.
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

export class Decoder {
  #readers = new Map();

  // channel: { topic, encoding, schemaName, schema }. Returns the message, or null if that is
  // not CDR of a ROS 2 definition or the bytes do not fit it.
  decode(channel, bytes) {
    if (channel.encoding !== "cdr") return null;
    const key = `${channel.schemaName}\n${channel.schema}`;
    let reader = this.#readers.get(key);
    if (reader === undefined) {
      reader = readerOf(channel.schema);
      this.#readers.set(key, reader);
    }
    try {
      return reader === null ? null : reader.readMessage(bytes);
    } catch {
      return null;
    }
  }
}

function readerOf(schema) {
  try {
    return new MessageReader(parse(schema, { ros2: true }));
  } catch {
    return null;
  }
}

export const secondsOf = ({ sec, nanosec }) => sec + nanosec * 1e-9;

// Gray values of a picture, one number a pixel; null for an encoding that the page does not read.
export function pixelsOf({ width, height, encoding, is_bigendian, step, data }) {
  const bytes = { mono8: 1, "8UC1": 1, mono16: 2, "16UC1": 2 }[encoding];
  if (
    bytes === undefined ||
    step < width * bytes ||
    data.length < step * (height - 1) + width * bytes
  ) {
    return null;
  }
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const values = new Uint16Array(width * height);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const at = y * step + x * bytes;
      values[y * width + x] = bytes === 1 ? data[at] : view.getUint16(at, !is_bigendian);
    }
  }
  return values;
}
