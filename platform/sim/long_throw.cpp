#include "platform/sim/long_throw.hpp"

#include <cstdint>
#include <memory>
#include <utility>

#include "kernels/registration/render_depth.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/random.hpp"
#include "platform/sim/reflector.hpp"
#include "platform/sim/scene.hpp"

namespace glint {
namespace {

CameraModel camera_model() {
  CameraModel model;
  model.width = k_long_throw.width;
  model.height = k_long_throw.height;
  model.fx = k_long_throw.fx, model.fy = k_long_throw.fy;
  model.cx = k_long_throw.cx, model.cy = k_long_throw.cy;
  return model;
}

std::vector<float> robot_depth(const PosedSurface& robot, const Pose& T_camera_robot) {
  std::vector<float> z(static_cast<std::size_t>(k_long_throw.width * k_long_throw.height));
  std::vector<std::int32_t> triangle(z.size());
  std::vector<ProjectedCorner> corners(robot.corners.size());
  if (render_depth(robot.surface(), T_camera_robot, k_long_throw, {z, triangle, corners}) !=
      Reason::none) {
    throw InputError("the robot cannot be drawn; expected fewer or smaller triangles");
  }
  return z;
}

}  // namespace

MappingCamera::MappingCamera(const sim::Simulator& simulator, PosedSurface robot,
                             const Pose& T_world_robot)
    : simulator_(simulator),
      robot_(std::move(robot)),
      T_world_robot_(T_world_robot),
      rays_(camera_model()),
      room_(camera_model()) {}

void MappingCamera::draw_room(const sim::SimFrame& frame, sim::Planes& planes) const {
  const sim::Scenario& scenario = simulator_.scenario();
  planes.resize(k_long_throw.width, k_long_throw.height);
  room_.draw(scenario.room, frame.truth.T_world_camera, scenario.signal.wall, planes);
  const auto scene = std::make_unique<sim::Scene>();
  sim::build_scene(scenario, frame.truth.mid_exposure, frame.sequence, *scene);
  for (int c = 0; c < scene->capsules.count; ++c) {
    sim::draw(scene->capsules[c], camera_model(), rays_, planes);
  }
}

std::vector<float> MappingCamera::depth(int i, sim::SimFrame& frame) {
  simulator_.describe(i, frame);
  sim::Planes planes;
  draw_room(frame, planes);
  std::vector<float> z = robot_depth(robot_, frame.truth.T_world_camera.inverse() * T_world_robot_);
  const sim::RandomKey noise{simulator_.scenario().seed, sim::Stream::long_throw, frame.sequence};
  for (int y = 0; y < planes.height; ++y) {
    for (int x = 0; x < planes.width; ++x) {
      const std::size_t at = planes.at(x, y);
      const float behind = planes.range_m[at] * rays_.z_row(y)[x];
      if (z[at] == 0 || behind < z[at]) z[at] = behind;
      z[at] += static_cast<float>(k_long_throw_sigma_m * sim::gaussian(noise, at));
    }
  }
  return z;
}

}  // namespace glint
