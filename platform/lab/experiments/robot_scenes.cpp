#include "platform/lab/experiments/robot_scenes.hpp"

#include <algorithm>
#include <numbers>

#include "kernels/angles.hpp"
#include "kernels/elementary.hpp"
#include "kernels/registration/render_depth.hpp"
#include "platform/formats/npy.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/random.hpp"
#include "platform/tools/reference/find_reference.hpp"

namespace glint {
namespace {

constexpr int k_scan_frames = 5;

// The published frame has x forward, y left, z up; a camera's optical frame z forward, x right, y
// down.
Pose published_pose(const std::string& path) {
  const NpyArray array = read_npy_float32(path);
  if (array.values.size() != 16) throw InputError(path + ": expected a 4 x 4 matrix");
  Matrix3 rotation, optical;
  Vector3 translation;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      rotation(r, c) = static_cast<double>(array.values[static_cast<std::size_t>(4 * r + c)]);
    translation(r) = static_cast<double>(array.values[static_cast<std::size_t>(4 * r + 3)]);
  }
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Pose T_base_camera{Quaternion(Matrix3(rotation * optical)).normalized(), translation};
  return T_base_camera.inverse();
}

void add_quad(PosedSurface& to, const Vector3& corner, const Vector3& along, const Vector3& up) {
  const auto first = static_cast<std::int32_t>(to.corners.size());
  for (const Vector3& p :
       {corner, Vector3(corner + along), Vector3(corner + along + up), Vector3(corner + up)}) {
    to.corners.push_back(p.cast<float>());
  }
  to.faces.push_back({first, first + 1, first + 2});
  to.faces.push_back({first, first + 2, first + 3});
}

// Split into parts, as the renderer omits triangles that reach behind the camera.
void add_wall(PosedSurface& to, const Vector3& corner, const Vector3& along, const Vector3& up) {
  constexpr int parts = 24;
  for (int i = 0; i < parts; ++i) {
    for (int j = 0; j < parts; ++j) {
      add_quad(to, corner + i * along / parts + j * up / parts, along / parts, up / parts);
    }
  }
}

// Returns T_camera_base of a camera at this azimuth and elevation that looks at the target.
Pose camera_at(const Vector3& target, double distance_m, double azimuth, double elevation) {
  const SineCosine a = sine_cosine(azimuth), e = sine_cosine(elevation);
  const Vector3 out(a.cosine * e.cosine, a.sine * e.cosine, e.sine);
  Matrix3 axes;  // of the camera, in the base's frame, as columns
  axes.col(2) = -out;
  axes.col(0) = Vector3(-a.sine, a.cosine, 0) * 1.0;
  axes.col(1) = axes.col(2).cross(axes.col(0));
  const Pose T_base_camera{Quaternion(axes).normalized(), target + distance_m * out};
  return T_base_camera.inverse();
}

struct DepthRender {
  std::vector<float> z;
  std::vector<std::int32_t> face;
};

DepthRender rendered(const PosedSurface& surface, const Pose& T_camera_base,
                     const Pinhole& camera) {
  const auto pixels = static_cast<std::size_t>(camera.width * camera.height);
  DepthRender picture{std::vector<float>(pixels), std::vector<std::int32_t>(pixels)};
  std::vector<ProjectedCorner> corners(surface.corners.size());
  (void)render_depth(surface.surface(), T_camera_base, camera, {picture.z, picture.face, corners});
  return picture;
}

// Adds a panel between camera and robot, over the left half of the robot's pixels.
void occlude_half(PosedSurface& world, const DepthRender& robot, const Pinhole& camera,
                  const Pose& T_camera_base, double distance_m) {
  std::vector<int> columns;
  for (std::size_t i = 0; i < robot.face.size(); ++i) {
    if (robot.face[i] >= 0) columns.push_back(static_cast<int>(i) % camera.width);
  }
  if (columns.empty()) return;
  std::sort(columns.begin(), columns.end());
  const double middle = columns[columns.size() / 2];
  const double z = 0.6 * distance_m;
  const double right = (middle - camera.cx) / camera.fx * z;
  const Pose T_base_camera = T_camera_base.inverse();
  const Vector3 corner = T_base_camera * Vector3(right - 0.5, -0.6, z);
  add_quad(world, corner, T_base_camera.rotation * Vector3(0.5, 0, 0),
           T_base_camera.rotation * Vector3(0, 1.2, 0.1));
}

}  // namespace

RobotScan read_robot_scan(const std::string& folder) {
  const std::string scans = folder + "/robot_scans/xarm7_realsense/";
  const std::string robots = folder + "/robots/xarm7/";
  RobotScan scan;
  scan.robot = load_robot({robots + "xarm7.urdf", {robots}, Geometry::collision});
  SceneFiles files{scans + "camera_info.yaml", {}, {}, {}};
  for (int i = 0; i < k_scan_frames; ++i) {
    const std::string number = std::to_string(i);
    files.depth.push_back(scans + "depth_" + number + ".npy");
    files.joints.push_back(scans + "joint_state_" + number + ".npy");
  }
  scan.frames = read_scene(files, scan.robot);
  scan.masked = scan.frames;
  for (int i = 0; i < k_scan_frames; ++i) {
    files.masks.push_back(scans + "mask_sam2_img_" + std::to_string(i) + ".png");
  }
  scan.masked = read_scene(files, scan.robot);
  scan.published = published_pose(scans + "HT_hydra_robust.npy");
  return scan;
}

std::vector<SceneFrame> without_robot(const RobotScan& scan) {
  std::vector<SceneFrame> out = scan.frames;
  for (std::size_t pixel = 0; pixel < out[0].depth_m.size(); ++pixel) {
    float behind = 0;
    for (const SceneFrame& frame : scan.masked) {
      if (frame.mask[pixel] == 0) behind = std::max(behind, frame.depth_m[pixel]);
    }
    for (std::size_t f = 0; f < out.size(); ++f) {
      if (scan.masked[f].mask[pixel] != 0) out[f].depth_m[pixel] = behind;
    }
  }
  return out;
}

SimulatedScene simulate_scene(const RobotModel& robot, const SimulationSettings& settings,
                              std::uint64_t seed, std::uint64_t instance) {
  const sim::RandomKey key{seed, sim::Stream::points, instance};
  std::uint64_t drawn = 0;
  const auto draw = [&](double low, double high) {
    return low + (high - low) * sim::uniform(key, drawn++);
  };
  std::vector<double> positions;
  for (std::size_t i = 0; i < robot.inputs.size(); ++i) positions.push_back(draw(-1.3, 1.3));
  if (!settings.positions.empty()) positions = settings.positions;
  const PosedSurface model = posed_surface(robot, positions, "simulated");
  Vector3f low = model.corners[0], high = low;
  for (const Vector3f& corner : model.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Vector3 target = (0.5f * (low + high)).cast<double>();
  const Pinhole camera{320, 288, 252, 252, 160, 144};
  const double azimuth = draw(-std::numbers::pi, std::numbers::pi), elevation = draw(0.2, 0.8);

  const double bias = draw(-settings.depth_bias_m, settings.depth_bias_m);
  const double right = draw(-settings.depth_slope_m, settings.depth_slope_m);
  const double down = draw(-settings.depth_slope_m, settings.depth_slope_m);

  SimulatedScene scene;
  Pose T_base_first;
  for (int v = 0; v < settings.views; ++v) {
    const Pose T_camera_base = camera_at(target, settings.distance_m, azimuth + 0.5 * v, elevation);
    if (v == 0) T_base_first = T_camera_base.inverse();
    PosedSurface world = model;
    const auto robots_faces = static_cast<std::int32_t>(model.faces.size());
    const double floor = static_cast<double>(low.z()) - 0.01;
    add_wall(world, {-3, -3, floor}, {6, 0, 0}, {0, 6, 0});
    const Vector3 away = T_camera_base.inverse().rotation * Vector3(0, 0, 1);
    const Vector3 flat = Vector3(away.x(), away.y(), 0).normalized();
    const Vector3 side(-flat.y(), flat.x(), 0);
    add_wall(world, target + 0.9 * flat - 3 * side - Vector3(0, 0, 3), 6 * side, {0, 0, 6});
    if (settings.half_hidden) {
      occlude_half(world, rendered(model, T_camera_base, camera), camera, T_camera_base,
                   settings.distance_m);
    }
    const DepthRender picture = rendered(world, T_camera_base, camera);
    SceneFrame frame;
    frame.camera = camera;
    frame.model = model;
    frame.T_camera_world = T_camera_base * T_base_first;
    const sim::RandomKey noise{seed, sim::Stream::blob,
                               16 * instance + static_cast<std::uint64_t>(v)};
    for (std::size_t i = 0; i < picture.z.size(); ++i) {
      const double z = static_cast<double>(picture.z[i]);
      const int x = static_cast<int>(i) % camera.width, y = static_cast<int>(i) / camera.width;
      const double shared =
          bias + right * ((x + 0.5) / camera.cx - 1) + down * ((y + 0.5) / camera.cy - 1);
      frame.depth_m.push_back(static_cast<float>(
          z > 0 ? z * (1 + settings.noise * sim::gaussian(noise, i)) + shared : 0));
      const bool on = picture.face[i] >= 0 && picture.face[i] < robots_faces;
      if (settings.mask) frame.mask.push_back(on ? 1 : 0);
    }
    scene.frames.push_back(std::move(frame));
  }
  scene.T_world_base = T_base_first.inverse();
  scene.positions = positions;
  return scene;
}

Pose initial_pose_near(const Pose& truth, double shift_m, double degrees, std::uint64_t seed,
                       std::uint64_t number) {
  const sim::RandomKey key{seed, sim::Stream::reference, number};
  const auto draw = [&](std::uint64_t i) { return 2 * sim::uniform(key, i) - 1; };
  const double radians = degrees / k_degrees_per_radian;
  const Pose turn =
      pose_from_xyz_rpy({0, 0, 0, radians * draw(3), radians * draw(4), radians * draw(5)});
  return {(turn.rotation * truth.rotation).normalized(),
          truth.translation + shift_m * Vector3(draw(0), draw(1), draw(2))};
}

}  // namespace glint
