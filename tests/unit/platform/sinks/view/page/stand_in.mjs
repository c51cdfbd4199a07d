// A server that stands in for a run: sends made-up messages of every topic that the page shows.
// Its messages are encoded by @foxglove/rosmsg2-serialization, not by Glint.
import { createServer } from "node:http";

import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { WebSocketServer } from "ws";

// A line a type; a line that begins with a space continues the one before.
const TYPES = new Map(
  `
builtin_interfaces/Time: int32 sec; uint32 nanosec
std_msgs/Header: builtin_interfaces/Time stamp; string frame_id
std_msgs/String: string data
geometry_msgs/Point: float64 x; float64 y; float64 z
geometry_msgs/Quaternion: float64 x; float64 y; float64 z; float64 w
geometry_msgs/Pose: geometry_msgs/Point position; geometry_msgs/Quaternion orientation
geometry_msgs/PoseWithCovariance: geometry_msgs/Pose pose; float64[36] covariance
geometry_msgs/PoseWithCovarianceStamped: std_msgs/Header header;
 geometry_msgs/PoseWithCovariance pose
sensor_msgs/JointState: std_msgs/Header header; string[] name; float64[] position
sensor_msgs/Image: std_msgs/Header header; uint32 height; uint32 width; string encoding;
 uint8 is_bigendian; uint32 step; uint8[] data
glint_msgs/Explanation: std_msgs/Header header; string tool; string state; string reason;
 string text
glint_msgs/PixelRectangle: uint16 x; uint16 y; uint16 width; uint16 height; uint8[] reflectivity;
 uint8[] depth
glint_msgs/Region: float32 x_px; float32 y_px; uint32 area_px; uint32 peak;
 glint_msgs/PixelRectangle box; string reason; string marker; float32 distance_m
glint_msgs/Regions: std_msgs/Header header; uint32 threshold; glint_msgs/PixelRectangle[] rois;
 glint_msgs/Region[] blobs
`
    .trim()
    .replaceAll(/\n /g, " ")
    .split("\n")
    .map((line) => line.split(": ")),
);

const fieldsOf = (type) => TYPES.get(type).replaceAll("; ", "\n");

// The definition with those of the types in it, as rosbag2 stores them.
function schemaOf(type) {
  const used = new Set();
  const collect = (fields) => {
    for (const [, name] of fields.matchAll(/^(\w+\/\w+)/gm)) {
      if (used.has(name)) continue;
      used.add(name);
      collect(fieldsOf(name));
    }
  };
  collect(fieldsOf(type));
  const parts = [...used].map((name) => `${"=".repeat(80)}\nMSG: ${name}\n${fieldsOf(name)}`);
  return [fieldsOf(type), ...parts].join("\n");
}

// page: the HTML that it answers. A client receives the newest message of each topic.
export async function standIn(page) {
  const http = createServer((request, response) => response.end(page));
  const sockets = new WebSocketServer({ server: http });
  const channels = new Map();
  const sendTo = (socket, id, { bytes }) => {
    const head = Buffer.alloc(13);
    head.writeUInt8(1, 0);
    head.writeUInt32LE(id, 1);
    socket.send(Buffer.concat([head, bytes]));
  };
  sockets.on("connection", (socket) => {
    const list = [...channels.values()].map(({ bytes, ...channel }) => channel);
    socket.send(JSON.stringify({ op: "advertise", channels: list }));
    socket.on("message", (text) => {
      for (const { id, channelId } of JSON.parse(text).subscriptions) {
        sendTo(socket, id, [...channels.values()][channelId]);
      }
    });
  });
  await new Promise((resolve) => http.listen(0, "127.0.0.1", resolve));
  return {
    address: `ws://127.0.0.1:${http.address().port}`,
    // Call before a client connects. message: its fields, or the bytes of a damaged one.
    add(topic, type, message, schema = schemaOf(type)) {
      const isBytes = message instanceof Uint8Array;
      const bytes = isBytes
        ? message
        : new MessageWriter(parse(schema, { ros2: true })).writeMessage(message);
      channels.set(topic, {
        id: channels.size,
        topic,
        encoding: "cdr",
        schemaName: type.replace("/", "/msg/"),
        schema,
        bytes,
      });
    },
    close() {
      for (const socket of sockets.clients) socket.terminate();
      http.close();
    },
  };
}
