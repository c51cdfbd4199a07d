// The scene in space: headset, tools with their 95 % ellipsoids, strokes, robot, and the markers
// of /glint/scene, each in its own frame.
import {
  AxesHelper,
  Color,
  GridHelper,
  Group,
  HemisphereLight,
  PerspectiveCamera,
  Scene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { Frames, inverseOf } from "./frames.js";
import { MarkerObjects } from "./scene_markers.js";
import { headsetObject, setEllipsoid, toolObject } from "./scene_objects.js";
import { Robot } from "./scene_robot.js";
import { StrokeLines } from "./strokes.js";

const NO_WEBGL = "This browser offers no WebGL: the scene in space is not drawn.";
const DRAW = 1; // glint_msgs/PenButtons
const ROBOT_POSES = ["", "given", "accepted", "refused"]; // glint_msgs/RobotFrame

export class SceneView {
  #panel = document.querySelector("#scene");
  #host = document.querySelector("#scene-frame");
  #text = document.querySelector("#scene-text");
  #canvas = document.querySelector("#scene-canvas");
  #renderer = null;
  #scene = new Scene();
  #camera = new PerspectiveCamera(45, 1, 0.01, 50);
  #controls = null;
  #changed = true;

  constructor() {
    try {
      this.#renderer = new WebGLRenderer({ canvas: this.#canvas, antialias: true });
    } catch {
      this.#host.querySelector(".empty").textContent = NO_WEBGL;
    }
    this.#scene.background = new Color("#12171d");
    this.#scene.add(new HemisphereLight("#ffffff", "#667788", 2.5));
    this.#camera.up.set(0, 0, 1);
    this.#camera.position.set(-0.9, -1.1, 0.8);
    this.#controls = new OrbitControls(this.#camera, this.#canvas);
    this.#controls.addEventListener("change", () => (this.#changed = true));
    this.#canvas.addEventListener("keydown", (event) => this.#key(event));
    new ResizeObserver(() => (this.#changed = true)).observe(this.#host);
    this.reset();
  }

  wants(topic, tools) {
    return (
      [
        "/tf",
        "/tf_static",
        "/glint/head_pose",
        "/glint/robot_frame",
        "/glint/pen_buttons",
        "/glint/output",
        "/glint/scene",
        "/robot_description",
        "/joint_states",
      ].includes(topic) || tools.poseTool(topic) >= 0
    );
  }

  // The next pose is put into the middle, as the first one is.
  aimAgain() {
    this.#aimed = false;
  }

  reset() {
    this.#root?.removeFromParent();
    this.#root = new Group();
    this.#scene.add(this.#root);
    const grid = new GridHelper(2, 20, "#4a5664", "#2a323b").rotateX(Math.PI / 2);
    this.#root.add(grid, new AxesHelper(0.1));
    this.frames = new Frames(this.#root);
    this.tools = new Map();
    this.markers = new MarkerObjects(this.frames);
    this.robot = new Robot(this.frames);
    this.strokes = new StrokeLines(this.frames);
    this.#headset = null;
    this.#robotPose = "";
    this.#draws = false;
    this.#panel.classList.remove("has-data");
    this.#text.textContent = "";
    this.#changed = true;
  }
  #root = null;
  #headset = null;
  #robotPose = "";
  #draws = false;
  #aimed = false;

  show(topic, message, tools) {
    this.#changed = true;
    if (topic === "/glint/head_pose") {
      if (message.valid) this.#place("hmd_world", "hmd_tof_optical", message.pose);
    } else if (topic === "/glint/robot_frame") this.#robotFrame(message);
    else if (topic === "/tf" || topic === "/tf_static") this.#transforms(message);
    else if (topic === "/glint/pen_buttons") this.#draws = (message.held & DRAW) !== 0;
    else if (topic === "/glint/scene") this.markers.show(message);
    else if (topic === "/robot_description") this.robot.describe(message.data);
    else if (topic === "/joint_states") this.robot.setJoints(message);
    else if (topic === "/glint/output") this.#output(message, tools);
    else this.#pose(tools.nameOf(tools.poseTool(topic)), tools.poseTool(topic), message);
  }

  #robotFrame({ state, in_reference, pose }) {
    this.#robotPose = ROBOT_POSES[state] ?? "";
    if (this.#robotPose !== "" && !in_reference) this.#place("hmd_world", "robot_base", pose);
  }

  // The robot's base stays at the root, also when the headset finds it elsewhere.
  #place(parent, child, pose) {
    if (child === "robot_base") this.frames.set(child, parent, inverseOf(pose));
    else this.frames.set(parent, child, pose);
    if (child !== "hmd_tof_optical" || this.#headset !== null) return;
    this.#headset = headsetObject();
    this.#panel.classList.add("has-data");
    this.frames.of("hmd_tof_optical").add(this.#headset);
  }

  // The tools' tips are drawn by their poses.
  #transforms({ transforms }) {
    for (const { header, child_frame_id, transform } of transforms) {
      if (/^glint_\w+_tip$/.test(child_frame_id)) continue;
      const { translation: position, rotation: orientation } = transform;
      this.#place(header.frame_id, child_frame_id, { position, orientation });
    }
  }

  #pose(name, number, { header, pose: { pose, covariance } }) {
    let tool = this.tools.get(number);
    if (tool === undefined) {
      tool = toolObject();
      this.tools.set(number, tool);
    }
    this.frames.of(header.frame_id).add(tool.group);
    const { x, y, z } = pose.position,
      q = pose.orientation;
    tool.group.position.set(x, y, z);
    tool.pen.quaternion.set(q.x, q.y, q.z, q.w);
    tool.group.visible = true;
    tool.name = name;
    tool.axes = setEllipsoid(tool.ellipsoid, covariance);
    if (number === 0) this.strokes.add(header.frame_id, pose.position, this.#draws);
    if (!this.#panel.classList.contains("has-data")) this.#panel.classList.add("has-data");
    if (!this.#aimed) this.#aim(tool.group);
  }

  #output({ tool, state }) {
    const HAS_POSE = [1, 2];
    const entry = this.tools.get(tool);
    if (entry !== undefined && !HAS_POSE.includes(state)) entry.group.visible = false;
    if (!HAS_POSE.includes(state) && tool === 0) this.strokes.interrupt();
  }

  // The first pose is put into the middle.
  #aim(object) {
    this.#aimed = true;
    this.#scene.updateMatrixWorld(true);
    const target = object.getWorldPosition(new Vector3());
    this.#controls.target.copy(target);
    this.#camera.position.copy(target).add(new Vector3(-0.8, -0.9, 0.5));
    this.#controls.update();
  }

  #key(event) {
    const TURN = 0.12,
      ZOOM = 1.15;
    const offset = this.#camera.position.clone().sub(this.#controls.target);
    const side = new Vector3().crossVectors(offset, this.#camera.up).normalize();
    if (event.key === "ArrowLeft") offset.applyAxisAngle(this.#camera.up, -TURN);
    else if (event.key === "ArrowRight") offset.applyAxisAngle(this.#camera.up, TURN);
    else if (event.key === "ArrowUp") offset.applyAxisAngle(side, TURN);
    else if (event.key === "ArrowDown") offset.applyAxisAngle(side, -TURN);
    else if (event.key === "+") offset.divideScalar(ZOOM);
    else if (event.key === "-") offset.multiplyScalar(ZOOM);
    else return;
    event.preventDefault();
    this.#camera.position.copy(this.#controls.target).add(offset);
    this.#controls.update();
  }

  draw() {
    if (!this.#changed || this.#renderer === null) return;
    this.#changed = false;
    this.strokes.draw();
    const areConnected = this.frames.showConnected(this.tools.get(0)?.group.parent ?? null);
    const { clientWidth: width, clientHeight: height } = this.#host;
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#renderer.render(this.#scene, this.#camera);
    this.#describe(areConnected);
  }

  #describe(areConnected) {
    const parts = ["Grid: 100 mm."];
    if (!areConnected) parts.push("Not drawn: frames without a transform to the pen's.");
    for (const { group, name, axes } of this.tools.values()) {
      if (!group.visible) continue;
      const millimetres = axes?.map((axis) => (axis * 1e3).toFixed(1)).join(", ");
      const half = axes ? `95 % ellipsoid with half axes ${millimetres} mm` : "no covariance";
      parts.push(
        `${name}: tip at (${group.position
          .toArray()
          .map((m) => (m * 1e3).toFixed(0))
          .join(", ")}) mm, ${half}.`,
      );
    }
    if (this.#robotPose !== "") parts.push(`Robot's pose: ${this.#robotPose}.`);
    if (this.robot.text !== "") parts.push(this.robot.text);
    if (this.strokes.count > 0) parts.push(`Strokes: ${this.strokes.count} points.`);
    this.#text.textContent = parts.join(" ");
  }
}
