// A server that stands in for a run: sends made-up messages of every topic that the page shows.
// Its messages are encoded by @foxglove/rosmsg2-serialization, not by Glint.
import { createServer } from "node:http";

import { parse } from "@foxglove/rosmsg";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { WebSocketServer } from "ws";

const TYPES = {
  "builtin_interfaces/Time": "int32 sec\nuint32 nanosec",
  "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id",
  "std_msgs/String": "string data",
  "std_msgs/ColorRGBA": "float32 r\nfloat32 g\nfloat32 b\nfloat32 a",
  "geometry_msgs/Point": "float64 x\nfloat64 y\nfloat64 z",
  "geometry_msgs/Vector3": "float64 x\nfloat64 y\nfloat64 z",
  "geometry_msgs/Quaternion": "float64 x\nfloat64 y\nfloat64 z\nfloat64 w",
  "geometry_msgs/Pose": "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation",
  "geometry_msgs/PoseWithCovariance": "geometry_msgs/Pose pose\nfloat64[36] covariance",
  "geometry_msgs/PoseWithCovarianceStamped": "std_msgs/Header header\ngeometry_msgs/PoseWithCovariance pose",
  "geometry_msgs/Transform": "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation",
  "geometry_msgs/TransformStamped": "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform",
  "tf2_msgs/TFMessage": "geometry_msgs/TransformStamped[] transforms",
  "sensor_msgs/Image": "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data",
  "visualization_msgs/Marker": "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\ngeometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\ngeometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring text\nstring mesh_resource\nbool mesh_use_embedded_materials",
  "builtin_interfaces/Duration": "int32 sec\nuint32 nanosec",
  "visualization_msgs/MarkerArray": "visualization_msgs/Marker[] markers",
  "glint_msgs/Explanation": "std_msgs/Header header\nstring tool\nstring state\nstring reason\nstring text",
  "glint_msgs/PixelRectangle": "uint16 x\nuint16 y\nuint16 width\nuint16 height\nuint8[] reflectivity\nuint8[] depth",
  "glint_msgs/Region": "float32 x_px\nfloat32 y_px\nuint32 area_px\nuint32 peak\nglint_msgs/PixelRectangle box\nstring reason\nstring marker\nfloat32 distance_m",
  "glint_msgs/Regions": "std_msgs/Header header\nuint32 threshold\nglint_msgs/PixelRectangle[] rois\nglint_msgs/Region[] blobs",
  "glint_msgs/Output": "std_msgs/Header header\nint64 tick_ns\nint64 measurement_ns\nuint32 tick_number\nuint32 frame_sequence\nuint8 tool\nuint8 state\nuint8 reason\nuint8 marker_mask\nfloat64 age_s\nfloat64 sigma_position_m\nfloat64 sigma_orientation_rad\nuint8[] record\nfloat64 age_sigma_s",
  "glint_msgs/FramePatch": "std_msgs/Header header\nint64 mid_exposure_ns\nint64 arrival_ns\nuint32 sequence",
};

function schemaOf(type, seen = new Set()) {
  const used = (text) => [...text.matchAll(/^(\w+\/\w+)/gm)].map(([, name]) => name);
  const collect = (name) => {
    for (const one of used(TYPES[name])) if (!seen.has(one)) { seen.add(one); collect(one); }
  };
  collect(type);
  return [TYPES[type], ...[...seen].map((name) => `${"=".repeat(80)}\nMSG: ${name}\n${TYPES[name]}`)].join("\n");
}

// page: the HTML. Returns { port, send(topic, type, message), close() }.
export async function standIn(page) {
  const http = createServer((request, response) => response.end(page));
  const sockets = new WebSocketServer({ server: http, handleProtocols: () => "foxglove.websocket.v1" });
  const channels = new Map(), subscriptions = new Map();
  const advertise = (socket, list) => socket.send(JSON.stringify({ op: "advertise", channels: list.map(({ writer, ...rest }) => rest) }));
  sockets.on("connection", (socket) => {
    subscriptions.set(socket, new Map());
    socket.send(JSON.stringify({ op: "serverInfo", name: "stand-in", capabilities: [] }));
    advertise(socket, [...channels.values()]);
    socket.on("message", (text) => {
      for (const { id, channelId } of JSON.parse(text).subscriptions ?? []) subscriptions.get(socket).set(channelId, id);
    });
    socket.on("close", () => subscriptions.delete(socket));
  });
  await new Promise((resolve) => http.listen(0, "127.0.0.1", resolve));
  return {
    port: http.address().port,
    send(topic, type, message, time_ns) {
      let channel = channels.get(topic);
      if (channel === undefined) {
        const schema = schemaOf(type);
        channel = { id: channels.size + 1, topic, encoding: "cdr", schemaName: type.replace("/", "/msg/"), schema,
          schemaEncoding: "ros2msg", writer: new MessageWriter(parse(schema, { ros2: true })) };
        channels.set(topic, channel);
        for (const socket of subscriptions.keys()) advertise(socket, [channel]);
      }
      const bytes = channel.writer.writeMessage(message);
      for (const [socket, ids] of subscriptions) {
        if (!ids.has(channel.id)) continue;
        const out = Buffer.alloc(13 + bytes.byteLength);
        out.writeUInt8(1, 0);
        out.writeUInt32LE(ids.get(channel.id), 1);
        out.writeBigUInt64LE(time_ns, 5);
        out.set(bytes, 13);
        socket.send(out);
      }
    },
    close() { sockets.close(); for (const socket of subscriptions.keys()) socket.terminate(); http.close(); },
  };
}
