// Objects of visualization_msgs/MarkerArray in the scene.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  Color,
  CylinderGeometry,
  Group,
  InstancedMesh,
  Line,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshLambertMaterial,
  Points,
  PointsMaterial,
  SphereGeometry,
} from "three";

const MARKERS_MAX = 1024;
const POINTS_MAX = 200_000; // of one marker
const ADD = 0,
  DELETE = 2,
  DELETE_ALL = 3;
const ARROW = 0,
  CUBE = 1,
  SPHERE = 2,
  CYLINDER = 3,
  LINE_STRIP = 4,
  LINE_LIST = 5,
  CUBE_LIST = 6,
  SPHERE_LIST = 7,
  POINTS = 8,
  TRIANGLE_LIST = 11;

export class MarkerObjects {
  #frames;
  #objects = new Map(); // by namespace and number

  constructor(frames) {
    this.#frames = frames;
  }

  show({ markers }) {
    for (const marker of markers) {
      const key = `${marker.ns}\n${marker.id}`;
      if (marker.action === DELETE_ALL) for (const one of this.#objects.keys()) this.#remove(one);
      else this.#remove(key);
      if (marker.action !== ADD || this.#objects.size === MARKERS_MAX) continue;
      const object = objectOf(marker);
      if (object === null) continue;
      const { position: p, orientation: q } = marker.pose;
      object.position.set(p.x, p.y, p.z);
      if (q.x !== 0 || q.y !== 0 || q.z !== 0 || q.w !== 0)
        object.quaternion.set(q.x, q.y, q.z, q.w);
      this.#frames.of(marker.header.frame_id).add(object);
      this.#objects.set(key, object);
    }
  }

  #remove(key) {
    const object = this.#objects.get(key);
    if (object === undefined) return;
    object.removeFromParent();
    object.traverse((part) => {
      part.geometry?.dispose();
      part.dispose?.(); // of copies
      part.material?.dispose();
    });
    this.#objects.delete(key);
  }
}

function objectOf(marker) {
  const { scale } = marker;
  switch (marker.type) {
    case CUBE:
      return solid(marker, new BoxGeometry(scale.x, scale.y, scale.z));
    case SPHERE:
      return solid(marker, new SphereGeometry(0.5, 20, 14).scale(scale.x, scale.y, scale.z));
    // A cylinder of ROS has its axis along z.
    case CYLINDER:
      return solid(
        marker,
        new CylinderGeometry(0.5, 0.5, 1, 20).rotateX(Math.PI / 2).scale(scale.x, scale.y, scale.z),
      );
    case ARROW:
      return marker.points.length === 2
        ? new LineSegments(pointsOf(marker), lineMaterial(marker))
        : solid(
            marker,
            new CylinderGeometry(scale.y / 2, scale.y / 2, scale.x, 12)
              .rotateZ(-Math.PI / 2)
              .translate(scale.x / 2, 0, 0),
          );
    case LINE_STRIP:
      return new Line(pointsOf(marker), lineMaterial(marker));
    case LINE_LIST:
      return new LineSegments(pointsOf(marker), lineMaterial(marker));
    case CUBE_LIST:
      return copies(marker, new BoxGeometry(scale.x, scale.y, scale.z));
    case SPHERE_LIST:
      return copies(marker, new SphereGeometry(0.5, 14, 10).scale(scale.x, scale.y, scale.z));
    case POINTS:
      return new Points(
        pointsOf(marker),
        new PointsMaterial({ size: Math.max(scale.x, 0.002), ...paint(marker) }),
      );
    case TRIANGLE_LIST: {
      const geometry = pointsOf(marker);
      geometry.computeVertexNormals();
      return solid(marker, geometry);
    }
    default:
      return null; // texts and meshes
  }
}

const colourOf = ({ r, g, b }) => new Color(r, g, b);

function paint({ color, colors, points }) {
  const byPoint = colors.length > 0 && colors.length === points.length;
  return {
    color: byPoint ? "#ffffff" : colourOf(color),
    vertexColors: byPoint,
    transparent: color.a < 1,
    opacity: color.a > 0 ? color.a : 1,
  };
}

const lineMaterial = (marker) => new LineBasicMaterial(paint(marker));

function solid(marker, geometry) {
  const isTriangles = marker.type === TRIANGLE_LIST;
  const { vertexColors, ...rest } = paint(marker);
  return new Mesh(
    geometry,
    new MeshLambertMaterial({
      ...rest,
      vertexColors: isTriangles && vertexColors,
      side: isTriangles ? 2 : 0,
    }),
  );
}

function pointsOf({ points, colors }) {
  const count = Math.min(points.length, POINTS_MAX);
  const at = new Float32Array(3 * count);
  points.slice(0, count).forEach(({ x, y, z }, i) => at.set([x, y, z], 3 * i));
  const geometry = new BufferGeometry().setAttribute("position", new BufferAttribute(at, 3));
  if (colors.length > 0 && colors.length === points.length) {
    const shades = new Float32Array(3 * count);
    colors.slice(0, count).forEach(({ r, g, b }, i) => shades.set([r, g, b], 3 * i));
    geometry.setAttribute("color", new BufferAttribute(shades, 3));
  }
  return geometry;
}

function copies(marker, geometry) {
  const count = Math.min(marker.points.length, POINTS_MAX);
  if (count === 0) return new Group();
  const { vertexColors, ...rest } = paint(marker);
  const mesh = new InstancedMesh(geometry, new MeshLambertMaterial(rest), count);
  const matrix = new Matrix4();
  for (let i = 0; i < count; ++i) {
    const { x, y, z } = marker.points[i];
    mesh.setMatrixAt(i, matrix.makeTranslation(x, y, z));
    if (vertexColors) mesh.setColorAt(i, colourOf(marker.colors[i]));
  }
  mesh.frustumCulled = false;
  return mesh;
}
