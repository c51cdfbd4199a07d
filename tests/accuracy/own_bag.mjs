// A ROS 2 bag of another program, of frames that it rendered itself, tracked by `glint track`.
//   node own_bag.mjs GLINT [RANDOM_SEED]
// Shares no code with Glint: @mcap/core and @foxglove/rosmsg2-serialization write the bag. A camera
// of 320 x 240 pixels at 30 Hz with a rational lens, whose CameraInfo alone Glint gets; depth along
// the optical axis as 32FC1 metres; head pose by tf, 50 Hz, between the frames' stamps. Five spheres,
// a bright plate, hot pixels. Bars: 99 % of the frames with three free markers give a pose, exit code
// 0, no image without a partner; the tip's error at the output is printed and bounded.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

import { ros2humble } from "@foxglove/rosmsg-msgs-common";
import { MessageWriter } from "@foxglove/rosmsg2-serialization";
import { McapWriter } from "@mcap/core";

const [glint, seedText] = process.argv.slice(2);
const WIDTH = 320, HEIGHT = 240, FRAMES = 120, PERIOD = 1 / 30, START_S = 1_717_171_717;
const FX = 262.4, FY = 261.7, CX = 155.3, CY = 121.8;  // pixel centres at whole numbers
const D = [0.42, 0.11, 0.0007, -0.0004, 0.01, 0.71, 0.21, 0.04];
const RADIUS = 0.0055, TIP = [-0.003, 0.002, -0.14], TIP_RMS_MM_MAX = 4;
const MARKERS = [[0, 0, 0], [0.052, 0.011, 0.003], [-0.018, 0.071, 0], [-0.049, -0.022, 0.017],
                 [0.017, -0.043, -0.02]];

// mulberry32
let state = Number(seedText ?? 1) >>> 0;
function uniform() {
  state = (state + 0x6d2b79f5) >>> 0;
  let t = Math.imul(state ^ (state >>> 15), 1 | state);
  t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
  return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
}
const normal = () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());

function distort(x, y) {
  const r2 = x * x + y * y, [k1, k2, p1, p2, k3, k4, k5, k6] = D;
  const f = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
  return [x * f + 2 * p1 * x * y + p2 * (r2 + 2 * x * x), y * f + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y];
}
function pixelOf([x, y, z]) {
  const [u, v] = distort(x / z, y / z);
  return [FX * u + CX, FY * v + CY];
}
// By fixed-point steps.
function rayOf(u, v) {
  const tx = (u - CX) / FX, ty = (v - CY) / FY;
  let x = tx, y = ty;
  for (let i = 0; i < 60; ++i) {
    const [dx, dy] = distort(x, y);
    x += tx - dx;
    y += ty - dy;
  }
  const n = Math.hypot(x, y, 1);
  return [x / n, y / n, 1 / n];
}

// Quaternions as [x, y, z, w]; transforms as {q, p}.
const axis = (i, a) => [0, 1, 2].map((k) => (k === i ? Math.sin(a / 2) : 0)).concat(Math.cos(a / 2));
function mul([ax, ay, az, aw], [bx, by, bz, bw]) {
  return [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
          aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz];
}
function turned(q, v) {
  const [x, y, z] = mul(mul(q, [...v, 0]), [-q[0], -q[1], -q[2], q[3]]);
  return [x, y, z];
}
const applied = (t, v) => turned(t.q, v).map((c, i) => c + t.p[i]);
const times = (a, b) => ({ q: mul(a.q, b.q), p: applied(a, b.p) });
function undone(t, v) {
  return turned([-t.q[0], -t.q[1], -t.q[2], t.q[3]], v.map((c, i) => c - t.p[i]));
}

const CAMERA_ON_HEADSET = { q: mul(axis(0, 0.3), axis(2, -0.1)), p: [0.02, 0.05, -0.03] };
const headsetAt = (t) => ({
  q: mul(axis(1, 0.08 * Math.sin(0.7 * t)), axis(0, 0.05 * Math.cos(0.9 * t))),
  p: [0.02 * Math.sin(0.8 * t), 1.5 + 0.01 * Math.sin(1.1 * t), 0.02 * Math.cos(0.5 * t)],
});
const cameraAt = (t) => times(headsetAt(t), CAMERA_ON_HEADSET);
// In front of where the camera looks on the whole, in the world.
const MIDDLE = applied(cameraAt(0), [0, 0, 0.45]);
const toolAt = (t) => ({
  q: mul(axis(0, 0.4 * Math.sin(1.2 * t)), mul(axis(1, 0.5 * Math.sin(1.6 * t)), axis(2, 0.7 * t))),
  p: MIDDLE.map((c, i) => c + [0.07 * Math.sin(1.3 * t), 0.05 * Math.sin(1.7 * t),
                               0.08 * Math.sin(0.6 * t)][i]),
});

const cosineOf = new Float64Array(WIDTH * HEIGHT);
for (let y = 0; y < HEIGHT; ++y)
  for (let x = 0; x < WIDTH; ++x) cosineOf[y * WIDTH + x] = rayOf(x, y)[2];

function drawSphere(bright, depth, c) {
  const square = c[0] ** 2 + c[1] ** 2 + c[2] ** 2;
  const [u0, v0] = pixelOf(c);
  const reach = Math.ceil((FX * RADIUS) / c[2]) + 3;
  for (let y = Math.max(0, Math.floor(v0) - reach); y <= Math.min(HEIGHT - 1, v0 + reach); ++y)
    for (let x = Math.max(0, Math.floor(u0) - reach); x <= Math.min(WIDTH - 1, u0 + reach); ++x) {
      let inside = 0, ranges = 0;
      for (let i = 0; i < 25; ++i) {
        const ray = rayOf(x - 0.4 + 0.2 * (i % 5), y - 0.4 + 0.2 * Math.floor(i / 5));
        const along = ray[0] * c[0] + ray[1] * c[1] + ray[2] * c[2];
        const under = along * along - square + RADIUS * RADIUS;
        if (under <= 0) continue;
        ++inside;
        ranges += along - Math.sqrt(under);
      }
      if (inside === 0) continue;
      const at = y * WIDTH + x;
      bright[at] = Math.max(bright[at], Math.round((5200 * inside) / 25 + 8 * normal()));
      if (inside > 12) depth[at] = cosineOf[at] * (ranges / inside + 0.002 * normal());
    }
}
function render(centres) {
  const bright = new Uint16Array(WIDTH * HEIGHT), depth = new Float32Array(WIDTH * HEIGHT);
  for (let i = 0; i < bright.length; ++i) bright[i] = Math.max(0, Math.round(20 + 4 * normal()));
  for (let y = 4; y < 24; ++y)
    for (let x = 40; x < 120; ++x) {
      bright[y * WIDTH + x] = 2500;
      depth[y * WIDTH + x] = 1.2;
    }
  for (let i = 0; i < 5; ++i) bright[Math.floor(uniform() * bright.length)] = 4000;
  for (const c of centres) drawSphere(bright, depth, c);
  return { bright, depth };
}
// Inside the picture, apart from each other and from the plate.
function isTrackable(centres) {
  const spots = centres.map((c) => [...pixelOf(c), (FX * RADIUS) / c[2]]);
  const free = spots.filter(([u, v, r], i) =>
    u > r + 2 && u < WIDTH - r - 3 && v > 26 + r && v < HEIGHT - r - 3 &&
    spots.every(([a, b, s], k) => k === i || Math.hypot(u - a, v - b) > r + s + 2));
  return free.length >= 3;
}

class Bytes {
  parts = [];
  size = 0n;
  position() { return this.size; }
  async write(part) { this.parts.push(part.slice()); this.size += BigInt(part.length); }
}
async function writeBag(path) {
  const bytes = new Bytes(), bag = new McapWriter({ writable: bytes });
  await bag.start({ profile: "ros2", library: "own_bag" });
  const writers = new Map();
  const stampOf = (t) => ({ sec: START_S + Math.floor(t), nanosec: Math.round((t % 1) * 1e9) });
  async function put(topic, type, t, delay, message) {
    if (!writers.has(topic)) {
      const schemaId = await bag.registerSchema({
        name: type, encoding: "ros2msg", data: new Uint8Array() });
      const definition = ros2humble[type.replace("/msg/", "/")];
      const all = [definition, ...Object.values(ros2humble).filter((d) => d !== definition)];
      writers.set(topic, {
        serialise: new MessageWriter(all),
        id: await bag.registerChannel({ schemaId, topic, messageEncoding: "cdr",
                                        metadata: new Map([["offered_qos_profiles", ""]]) }) });
    }
    const { serialise, id } = writers.get(topic);
    const time = BigInt(START_S) * 1_000_000_000n + BigInt(Math.round((t + delay) * 1e9));
    await bag.addMessage({ channelId: id, sequence: 0, logTime: time, publishTime: time,
                           data: serialise.writeMessage(message) });
  }
  const transform = (t, parent, child, { q, p }) => ({
    header: { stamp: stampOf(t), frame_id: parent }, child_frame_id: child,
    transform: { translation: { x: p[0], y: p[1], z: p[2] },
                 rotation: { x: q[0], y: q[1], z: q[2], w: q[3] } } });
  const tf = (topic, t, item) => put(topic, "tf2_msgs/msg/TFMessage", t, 0.001, { transforms: [item] });
  const image = (t, encoding, step, values) => ({
    header: { stamp: stampOf(t), frame_id: "ir_optical" }, height: HEIGHT, width: WIDTH, encoding,
    is_bigendian: 0, step, data: new Uint8Array(values.buffer) });

  await tf("/tf_static", 0, transform(0, "headset", "ir_optical", CAMERA_ON_HEADSET));
  let trackable = 0, next = 0;
  for (let i = 0; i < FRAMES; ++i) {
    const t = 0.2 + i * PERIOD;
    for (; next * 0.02 <= t + 0.02; ++next)
      await tf("/tf", next * 0.02, transform(next * 0.02, "map", "headset", headsetAt(next * 0.02)));
    const camera = cameraAt(t), tool = toolAt(t);
    const centres = MARKERS.map((m) => undone(camera, applied(tool, m)));
    trackable += isTrackable(centres);
    const { bright, depth } = render(centres);
    await put("/cam/ir/image_raw", "sensor_msgs/msg/Image", t, 0.012, image(t, "mono16", 2 * WIDTH, bright));
    await put("/cam/depth/image_raw", "sensor_msgs/msg/Image", t, 0.013, image(t, "32FC1", 4 * WIDTH, depth));
    if (i === 0)
      await put("/cam/ir/camera_info", "sensor_msgs/msg/CameraInfo", t, 0.012, {
        header: { stamp: stampOf(t), frame_id: "ir_optical" }, height: HEIGHT, width: WIDTH,
        distortion_model: "rational_polynomial", d: D, k: [FX, 0, CX, 0, FY, CY, 0, 0, 1],
        r: [1, 0, 0, 0, 1, 0, 0, 0, 1], p: [FX, 0, CX, 0, 0, FY, CY, 0, 0, 0, 1, 0], binning_x: 0,
        binning_y: 0,
        roi: { x_offset: 0, y_offset: 0, height: 0, width: 0, do_rectify: false } });
  }
  await bag.end();
  writeFileSync(path, Buffer.concat(bytes.parts));
  return trackable;
}

let failed = false;
function judge(what, found, holds, bar) {
  console.log(`${what}: ${found} (bar: ${bar})${holds ? "" : "  FAILED"}`);
  failed ||= !holds;
}

const work = mkdtempSync(join(tmpdir(), "own_bag_"));
try {
  const mm = (v) => `[${v.map((c) => (1000 * c).toFixed(3)).join(", ")}]`;
  writeFileSync(join(work, "probe.toml"),
    `name = "probe"\nmarkers_mm = [${MARKERS.map(mm).join(", ")}]\nradius_mm = ${1000 * RADIUS}\n` +
    `tip_mm = ${mm(TIP)}\nshape = "sphere"\n`);
  writeFileSync(join(work, "cell.toml"),
    `tools = ["probe.toml"]\n[camera]\nmodel = "generic"\nwidth = ${WIDTH}\nheight = ${HEIGHT}\n` +
    `depth = "z"\ndepth_unit_mm = 0.1\nthreshold = 900\nperiod_ms = 33.333\n` +
    `[files]\ncsv = "samples.csv"\n`);
  const trackable = await writeBag(join(work, "bag.mcap"));
  const ran = spawnSync(glint, ["track", join(work, "bag.mcap"), "--config", join(work, "cell.toml"),
                                "--out", join(work, "out"), "--json", join(work, "out.json")],
                        { encoding: "utf8" });
  judge("exit code", `${ran.status} ${ran.stderr}`.trim(), ran.status === 0, 0);
  if (ran.status === 0) {
    const summary = JSON.parse(readFileSync(join(work, "out.json")));
    console.log(summary.source.text.replace(`${work}/`, ""));
    judge("frames with a pose / trackable", `${summary.frames_tracked} / ${trackable}`,
          summary.frames_tracked >= 0.99 * trackable && trackable > 100, "99 %");
    for (const kind of ["images_unpaired", "transforms_refused", "frames_without_head_pose"])
      judge(kind, summary.source.counts[kind], summary.source.counts[kind] === 0, 0);
    const [heading, ...rows] = readFileSync(join(work, "out", "samples.csv"), "utf8").trim()
      .split("\n").map((line) => line.split(","));
    const samples = rows.map((row) => Object.fromEntries(heading.map((name, i) => [name, row[i]])));
    const first = Number(samples.find((s) => s.frame_sequence === "0").measurement_s);
    const squares = samples.filter((s) => s.state === "measured" && s.frame === "world").map((s) => {
      const truth = applied(toolAt(Number(s.tick_s) - first + 0.2), TIP);
      return ["x_m", "y_m", "z_m"].reduce((sum, k, i) => sum + (Number(s[k]) - truth[i]) ** 2, 0);
    });
    const rms = 1000 * Math.sqrt(squares.reduce((a, b) => a + b, 0) / squares.length);
    judge(`tip at the output, ${squares.length} measured ticks: rms, mm`, rms.toFixed(2),
          squares.length > 500 && rms <= TIP_RMS_MM_MAX, TIP_RMS_MM_MAX);
  }
} finally {
  rmSync(work, { recursive: true });
}
process.exit(failed ? 1 : 0);
