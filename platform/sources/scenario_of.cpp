#include "platform/sources/scenario_of.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kernels/pose/rigid_fit.hpp"
#include "platform/formats/frame_files.hpp"
#include "platform/input_error.hpp"
#include "platform/sim/field.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/tool_body.hpp"
#include "platform/sim/touches.hpp"

namespace glint {
namespace {

std::optional<sim::FieldTask> field_task(const std::string& scenario) {
  using sim::FieldTask;
  if (scenario == "field") return FieldTask::work;
  if (scenario == "field_board") return FieldTask::target;
  if (scenario == "field_turn") return FieldTask::rotate;
  if (scenario == "field_pivot") return FieldTask::pivot;
  if (scenario == "field_rest") return FieldTask::still;
  if (scenario == "field_look") return FieldTask::move_head;
  return {};
}

}  // namespace

sim::Scenario scenario_of(const Cell& cell, const Cell& drawn) {
  Cell device = drawn;
  device.simulator = cell.simulator;
  device.simulator.ground_truth_cell.clear();
  sim::Scenario scenario = scenario_of(device);
  // A tool's axes are those of its file, aligned by a rigid fit of the markers.
  for (std::size_t i = 0; i < scenario.tools.size(); ++i) {
    const Tool& stated = cell.tools.items[i];
    sim::ToolBody& body = scenario.tools[i];
    const auto count = static_cast<std::size_t>(stated.marker_count);
    if (stated.marker_count != body.tool.marker_count) {
      throw InputError(cell.file + ": simulator.drawn: its tool \"" + body.tool.name.data() +
                       "\" has " + std::to_string(body.tool.marker_count) + " markers; expected " +
                       std::to_string(count) + ", as \"" + stated.name.data() + "\" in the cell");
    }
    const RigidFit fit = fit_rigid(std::span(stated.markers_m).first(count),
                                   std::span(body.tool.markers_m).first(count));
    sim::align_to_stated_frame(stated.tip_m, fit.transform.rotation, body);
  }
  return scenario;
}

sim::Scenario scenario_of(const Cell& cell) {
  const SimulatorSettings& settings = cell.simulator;
  if (!settings.ground_truth_cell.empty())
    return scenario_of(cell, load_cell(settings.ground_truth_cell));
  const std::vector<Tool> tools(cell.tools.items.begin(),
                                cell.tools.items.begin() + cell.tools.count);
  sim::Scenario scenario;
  if (settings.scenario == "trajectories") {
    scenario = sim::trajectory_run(cell.camera, tools, load_trajectory(settings.head_trajectory),
                                   load_trajectory(settings.pen_trajectory), settings.pen_scale);
  } else if (const auto task = field_task(settings.scenario)) {
    const Cell shipped;
    scenario = sim::field_run(cell.camera, tools,
                              {cell.T_world_robot, shipped.robot_sigma_m, shipped.robot_sigma_rad},
                              settings.duration_s, settings.seed, *task);
  } else if (settings.scenario == "still") {
    scenario = sim::still_run(cell.camera, tools);
  } else if (settings.scenario == "touches") {
    scenario = sim::still_run(cell.camera, tools);
    sim::touch_points({}, settings.seed, scenario);
  } else {
    scenario = sim::default_run(tools);
    const sim::Scenario sensor = sim::still_run(cell.camera, tools);
    scenario.camera = cell.camera;
    scenario.noise = sensor.noise;
    scenario.signal = sensor.signal;
    scenario.localisation = sensor.localisation;
  }
  sim::NoiseSettings& noise = scenario.noise;
  noise.blob_range_sigma_m = settings.marker_range_sigma_m.value_or(noise.blob_range_sigma_m);
  noise.blob_pixel_sigma_px = settings.marker_pixel_sigma_px.value_or(noise.blob_pixel_sigma_px);
  if (cell.reference >= 0) sim::lay_on_table(scenario, static_cast<std::size_t>(cell.reference));
  if (!settings.background.empty()) {
    const FrameBuffer frame =
        load_frame(settings.background, frame_file_layout_of(settings.background_layout));
    scenario.background = sim::background_from_frame(frame, cell.camera);
  }
  scenario.duration = {static_cast<std::int64_t>(settings.duration_s * 1e9)};
  scenario.seed = settings.seed;
  return scenario;
}

}  // namespace glint
