// What the scene draws by itself: headset, tool and covariance ellipsoid.
import {
  AxesHelper,
  BufferAttribute,
  BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  SphereGeometry,
} from "three";

import { positionEllipsoid } from "./ellipsoid.js";

const LENGTH_M = 0.16; // of the drawn stick: the messages do not state the tool's shape

// The camera's pyramid of view, 75 degrees wide as that of an AHAT lens is drawn here: z forward.
export function headsetObject() {
  const group = new Group(),
    depth = 0.12,
    half = depth * Math.tan((37.5 * Math.PI) / 180);
  const corners = [
    [-half, -half],
    [half, -half],
    [half, half],
    [-half, half],
  ].map(([x, y]) => [x, y, depth]);
  const points = corners.flatMap((corner, i) => [
    0,
    0,
    0,
    ...corner,
    ...corner,
    ...corners[(i + 1) % 4],
  ]);
  const geometry = new BufferGeometry().setAttribute(
    "position",
    new BufferAttribute(new Float32Array(points), 3),
  );
  group.add(
    new LineSegments(geometry, new LineBasicMaterial({ color: "#5aa9ff" })),
    new AxesHelper(0.04),
  );
  return group;
}

// A stick whose tip is the origin, z from the tip up the stick.
export function toolObject() {
  const group = new Group(),
    pen = new Group();
  const material = new MeshLambertMaterial({ color: "#d9dee4" });
  const cone = new Mesh(new ConeGeometry(0.004, 0.02, 16), material);
  cone.rotation.x = -Math.PI / 2;
  cone.position.z = 0.01;
  const stick = new Mesh(new CylinderGeometry(0.004, 0.004, LENGTH_M - 0.02, 16), material);
  stick.rotation.x = Math.PI / 2;
  stick.position.z = 0.02 + (LENGTH_M - 0.02) / 2;
  pen.add(cone, stick, new AxesHelper(0.05));
  const ellipsoid = new Mesh(
    new SphereGeometry(1, 32, 20),
    new MeshBasicMaterial({ color: "#e35bd8", transparent: true, opacity: 0.4, depthWrite: false }),
  );
  ellipsoid.matrixAutoUpdate = false;
  group.add(pen, ellipsoid);
  return { group, pen, ellipsoid, name: "", axes: null };
}

// Returns the half axes in metres, the largest first; null for no covariance.
export function setEllipsoid(mesh, covariance) {
  const found = positionEllipsoid(covariance);
  mesh.visible = found !== null;
  if (found === null) return null;
  const { axes, directions: d } = found;
  mesh.matrix = new Matrix4().set(
    d[0][0] * axes[0],
    d[0][1] * axes[1],
    d[0][2] * axes[2],
    0,
    d[1][0] * axes[0],
    d[1][1] * axes[1],
    d[1][2] * axes[2],
    0,
    d[2][0] * axes[0],
    d[2][1] * axes[1],
    d[2][2] * axes[2],
    0,
    0,
    0,
    0,
    1,
  );
  mesh.matrixWorldNeedsUpdate = true;
  return [...axes].sort((a, b) => b - a);
}
