#include "platform/sim/simulator.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "platform/sim/room_drawer.hpp"
#include "platform/sim/scene.hpp"
#include "platform/sim/sensor.hpp"
#include "platform/sim/stray_light.hpp"
#include "platform/sim/visibility.hpp"

namespace glint::sim {

struct Simulator::Parts {
  explicit Parts(Scenario given)
      : scenario(std::move(given)),
        timings(frame_timings(scenario.camera, scenario.timing, scenario.duration, scenario.seed)),
        rays(scenario.camera.model),
        room(scenario.camera.model),
        sensor(scenario.camera, scenario.noise, scenario.seed),
        localisation(scenario.localisation, scenario.head, scenario.duration, scenario.seed) {
    if (scenario.calibration_target) target_drawer.emplace(scenario.camera.model, scenario.device);
  }

  void draw_background(const Pose& T_world_camera, Planes& planes) const {
    if (scenario.background.empty()) {
      room.draw(scenario.room, T_world_camera, scenario.signal.wall, planes);
      return;
    }
    std::copy(scenario.background.reflectivity.begin(), scenario.background.reflectivity.end(),
              planes.signal.begin());
    std::copy(scenario.background.range_m.begin(), scenario.background.range_m.end(),
              planes.range_m.begin());
  }

  Scenario scenario;
  std::vector<FrameTiming> timings;
  LensRays rays;
  RoomDrawer room;
  Sensor sensor;
  Localisation localisation;
  std::optional<ChessboardDrawer> target_drawer;
};

Simulator::Simulator(Scenario scenario) : parts_(std::make_unique<Parts>(std::move(scenario))) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

int Simulator::frame_count() const { return static_cast<int>(parts_->timings.size()); }

FrameTiming Simulator::timing(int i) const { return parts_->timings[static_cast<std::size_t>(i)]; }

Pose Simulator::truth_tool(int tool, Time time) const {
  return tool_pose(parts_->scenario, tool, time);
}

Pose Simulator::truth_camera(Time time) const { return parts_->scenario.head->pose(time); }

const Scenario& Simulator::scenario() const { return parts_->scenario; }

void Simulator::describe(int i, SimFrame& out) const {
  const FrameTiming when = timing(i);
  const Scenario& scenario = parts_->scenario;
  out.mid_exposure = when.mid_exposure;
  out.arrival = when.arrival;
  out.sequence = when.sequence;
  out.head = {when.mid_exposure, true, parts_->localisation.pose(when.mid_exposure)};
  out.truth.mid_exposure = when.exposed;
  out.truth.T_world_camera = truth_camera(when.exposed);
  const std::size_t tools = scenario.tools.size();
  out.truth.T_world_tool.resize(tools);
  out.truth.visible_mask.assign(tools, 0);
  out.reference.resize(tools);
  for (std::size_t k = 0; k < tools; ++k) {
    const int tool = static_cast<int>(k);
    out.truth.T_world_tool[k] = truth_tool(tool, when.exposed);
    out.reference[k] = reference_pose(scenario.reference, out.truth.T_world_tool[k], scenario.seed,
                                      tool, when.sequence);
  }
}

void Simulator::render(int i, SimFrame& out) const {
  describe(i, out);
  const Parts& parts = *parts_;
  const CameraModel& model = parts.scenario.camera.model;
  Planes& planes = out.scratch;
  planes.resize(model.width, model.height);
  parts.draw_background(out.truth.T_world_camera, planes);
  if (parts.target_drawer) {
    const Chessboard& target = *parts.scenario.calibration_target;
    const Pose T_world_target = target.motion->pose(out.truth.mid_exposure);
    parts.target_drawer->draw(target, out.truth.T_world_camera.inverse() * T_world_target, planes);
  }

  Scene scene;
  build_scene(parts.scenario, out.truth.mid_exposure, out.sequence, scene);
  const std::span<const Capsule> capsules(scene.capsules.items.data(),
                                          static_cast<std::size_t>(scene.capsules.count));
  for (const Capsule& capsule : capsules) draw(capsule, model, parts.rays, planes);
  RenderedReflectors drawn;
  for (int k = 0; k < scene.reflectors.count; ++k) {
    drawn[static_cast<std::size_t>(k)] =
        draw(scene.reflectors[k], model, parts.rays, capsules, planes);
  }
  find_visible(parts.scenario.camera, scene, drawn, out.truth.visible_mask);
  if (parts.scenario.device.exists) add_stray_light(parts.scenario.device, out.spread, planes);
  parts.sensor.expose(planes, parts.rays, out.sequence, out.pixels);
}

}  // namespace glint::sim
