// Messages of known values, encoded by another program, and damaged ones: what the page shows.
import { readFileSync } from "node:fs";

import { openPage, sentenceIs } from "./browser.mjs";
import { standIn } from "./stand_in.mjs";

const header = { stamp: { sec: 100, nanosec: 0 }, frame_id: "robot_base" };
const area = (x, y, width, height) => ({ x, y, width, height, reflectivity: [], depth: [] });

function addPicture(server) {
  const width = 64,
    height = 48;
  const data = new Uint8Array(2 * width * height);
  for (const [x, y] of [
    [20, 10],
    [21, 10],
    [40, 30],
  ]) {
    new DataView(data.buffer).setUint16(2 * (y * width + x), 2000, true);
  }
  const picture = {
    header,
    width,
    height,
    encoding: "mono16",
    is_bigendian: 0,
    step: 2 * width,
    data,
  };
  server.add("/glint/picture", "sensor_msgs/Image", picture);
  const blob = {
    x_px: 21,
    y_px: 10.5,
    area_px: 2,
    peak: 2000,
    box: area(20, 10, 2, 1),
    reason: "too_small",
    marker: "",
    distance_m: 0.75,
  };
  server.add("/glint/regions", "glint_msgs/Regions", {
    header,
    threshold: 1280,
    rois: [area(0, 0, 60, 40)],
    blobs: [blob],
  });
}

export async function checkMessages(browser, html, urdf, screenshot) {
  const server = await standIn(html);
  server.add("/glint/explanation", "glint_msgs/Explanation", {
    header,
    tool: "pen",
    state: "lost",
    reason: "too_few_markers",
    text: "Not tracked: <b>2</b> spots are too small.",
  });
  addPicture(server);
  const covariance = Array(36).fill(0);
  [covariance[0], covariance[7], covariance[14]] = [1e-6, 4e-6, 9e-6];
  const pose = { position: { x: 0.1, y: -0.2, z: 0.3 }, orientation: { x: 0, y: 0, z: 0, w: 1 } };
  server.add("/glint/pen_pose_cov", "geometry_msgs/PoseWithCovarianceStamped", {
    header,
    pose: { pose, covariance },
  });
  server.add("/robot_description", "std_msgs/String", { data: readFileSync(urdf, "utf8") });
  server.add("/joint_states", "sensor_msgs/JointState", {
    header,
    name: ["lift"],
    position: [0.5],
  });
  const damaged = Uint8Array.of(0, 1, 0, 0, 255, 255, 255, 255);
  server.add("/glint/output", "std_msgs/Header", damaged);
  server.add("/glint/scene", "unknown/Type", damaged, "no definition ((");

  const { page, until, close } = await openPage(browser, server.address);
  await until("the sentence as text", sentenceIs, "lost", "<b>2</b> spots");
  await until("the picture", () => document.querySelector("#picture.has-data") !== null);
  await page.focus("#picture-canvas");
  await page.keyboard.press("ArrowDown");
  await until(
    "why the blob is refused",
    () =>
      document.querySelector("#picture-blob").textContent ===
      "Blob: refused: too small; 2 px large, peak 2000 counts, 750 mm away, at (21.0, 10.5) px.",
  );
  await until(
    "the pixels above the threshold",
    () => document.querySelector("#threshold-value").textContent === "1280 counts: 3 px above",
  );
  // Half axes: 2.7955 times 3, 2 and 1 mm.
  await until("the ellipsoid", () =>
    document
      .querySelector("#scene-text")
      .textContent.includes(
        "tip at (100, -200, 300) mm, 95 % ellipsoid with half axes 8.4, 5.6, 2.8 mm",
      ),
  );
  await until("the robot", () =>
    document.querySelector("#scene-text").textContent.includes("Robot box_arm: 4 links."),
  );
  await page.screenshot({ path: screenshot, fullPage: true });
  await close();
  server.close();
}
