// Coordinate frames of the messages as nested groups. A frame without a parent is at the root.
import { Group, Quaternion, Vector3 } from "three";

const FRAMES_MAX = 64;

export function inverseOf({ position: p, orientation: q }) {
  const orientation = new Quaternion(q.x, q.y, q.z, q.w).invert();
  return {
    position: new Vector3(p.x, p.y, p.z).negate().applyQuaternion(orientation),
    orientation,
  };
}

export class Frames {
  #root;
  #groups = new Map();

  constructor(root) {
    this.#root = root;
  }

  // The group of that frame.
  of(name) {
    let group = this.#groups.get(name);
    if (group !== undefined) return group;
    if (this.#groups.size === FRAMES_MAX) return this.#root;
    group = new Group();
    group.name = name;
    this.#groups.set(name, group);
    this.#root.add(group);
    return group;
  }

  // pose: of the child in the parent; null: unknown, the child stays where it is.
  set(parent, child, pose) {
    if (pose === null || parent === child) return;
    const to = this.of(parent),
      group = this.of(child);
    if (group === this.#root || this.#isAbove(group, to)) return;
    if (group.parent !== to) to.add(group);
    const { position: p, orientation: q } = pose;
    if (q.x === 0 && q.y === 0 && q.z === 0 && q.w === 0) return;
    group.position.set(p.x, p.y, p.z);
    group.quaternion.set(q.x, q.y, q.z, q.w);
  }

  // Hides the frames without a known relation to that group; null: none. Returns whether none is.
  showConnected(group) {
    const trees = this.#root.children.filter((child) => this.#groups.get(child.name) === child);
    for (const tree of trees) tree.visible = group === null || this.#isAbove(tree, group);
    return trees.every(({ visible }) => visible);
  }

  #isAbove(group, other) {
    for (let one = other; one; one = one.parent) if (one === group) return true;
    return false;
  }
}
