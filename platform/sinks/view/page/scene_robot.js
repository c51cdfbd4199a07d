// The robot by its URDF. Meshes of other files are not loaded: their links show a frame only.
import { AxesHelper, Object3D } from "three";
import URDFLoader from "urdf-loader";

export class Robot {
  #frames;
  #robot = null;
  #description = "";
  #joints = null;
  text = "";

  constructor(frames) {
    this.#frames = frames;
  }

  describe(urdf) {
    if (urdf === this.#description) return;
    this.#description = urdf;
    this.#robot?.removeFromParent();
    this.#robot = null;
    let left = 0;
    const loader = new URDFLoader();
    loader.parseVisual = /<visual[\s>]/.test(urdf);
    loader.parseCollision = !loader.parseVisual;
    loader.loadMeshCb = (path, manager, material, done) => {
      ++left;
      done(new Object3D());
    };
    try {
      this.#robot = loader.parse(urdf);
    } catch (error) {
      this.text = `/robot_description: ${error.message}; expected a URDF.`;
      return;
    }
    // The pen may be behind the robot, or inside the boxes that bound it.
    this.#robot.traverse(({ material }) => {
      if (material)
        Object.assign(material, { transparent: true, opacity: 0.45, depthWrite: false });
    });
    for (const link of Object.values(this.#robot.links)) link.add(new AxesHelper(0.04));
    this.#frames.of("robot_base").add(this.#robot);
    this.text =
      `Robot ${this.#robot.robotName}: ${Object.keys(this.#robot.links).length} links` +
      (left > 0 ? `, ${left} meshes not loaded.` : ".");
    if (this.#joints !== null) this.setJoints(this.#joints);
  }

  // sensor_msgs/JointState
  setJoints(message) {
    this.#joints = message;
    if (this.#robot === null) return;
    message.name.forEach((name, i) => this.#robot.setJointValue(name, message.position[i]));
  }
}
