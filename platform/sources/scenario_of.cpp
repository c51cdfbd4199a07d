#include "platform/sources/scenario_of.hpp"

#include <vector>

#include "platform/sensors/frame_files.hpp"
#include "platform/sim/field.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/touches.hpp"

namespace glint {

sim::Scenario scenario_of(const Cell& cell) {
  const SimulatorSettings& settings = cell.simulator;
  const std::vector<Tool> tools(cell.tools.items.begin(),
                                cell.tools.items.begin() + cell.tools.count);
  sim::Scenario scenario;
  if (settings.scenario == "trajectories") {
    scenario = sim::trajectory_run(cell.camera, tools, load_trajectory(settings.head_trajectory),
                                   load_trajectory(settings.pen_trajectory), settings.pen_scale);
  } else if (settings.scenario == "field") {
    const Cell shipped;
    scenario = sim::field_run(cell.camera, tools,
                              {cell.T_world_robot, shipped.robot_sigma_m, shipped.robot_sigma_rad},
                              settings.duration_s, settings.seed);
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
