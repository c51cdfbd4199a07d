// Names of the tools by their number, from the channels: /glint/NAME/pose of tool 1 and later, and
// the child frame glint_NAME_tip in /tf of tool 0.
export class Tools {
  #first = null;
  #others = [];

  channel({ topic }) {
    const found = topic.match(/^\/glint\/(\w+)\/pose$/);
    if (found && !this.#others.includes(found[1])) this.#others.push(found[1]);
  }

  transform({ child_frame_id }) {
    const name = child_frame_id.match(/^glint_(\w+)_tip$/)?.[1];
    if (name !== undefined && !this.#others.includes(name)) this.#first = name;
  }

  nameOf(number) {
    return (number === 0 ? this.#first : this.#others[number - 1]) ?? `tool ${number}`;
  }

  // Number of the tool of a topic of poses with covariance; -1: none.
  poseTool(topic) {
    if (topic === "/glint/pen_pose_cov") return 0;
    const name = topic.match(/^\/glint\/(\w+)\/pose_cov$/)?.[1];
    return name === undefined ? -1 : this.#others.indexOf(name) + 1;
  }
}
