#include "platform/lab/experiments/field_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "platform/cells/calibration_files.hpp"
#include "platform/cells/cell_camera.hpp"
#include "platform/sources/scenario_of.hpp"
#include "platform/sources/simulated_source.hpp"
#include "platform/tools/calibrate/board.hpp"
#include "platform/tools/calibrate/depth.hpp"
#include "platform/tools/calibrate/headset.hpp"
#include "platform/tools/calibrate/noise.hpp"
#include "platform/tools/calibrate/pivot.hpp"
#include "platform/tools/calibrate/pose_series.hpp"
#include "platform/tools/calibrate/tool_geometry.hpp"

namespace glint {
namespace {

sim::Scenario task_of(const Cell& drawn, const char* scenario, double duration_s) {
  Cell asked = drawn;
  asked.simulator.scenario = scenario;
  asked.simulator.duration_s = duration_s;
  return scenario_of(asked);
}

// Frames of one task, through a cell as it is calibrated so far.
struct Recording {
  Recording(const Cell& drawn, const Cell& so_far, const char* scenario, double duration_s)
      : simulator(task_of(drawn, scenario, duration_s)),
        frames{scenario, so_far, std::make_unique<SimulatedSource>(simulator)} {}
  sim::Simulator simulator;
  RecordedFrames frames;
};

double longest_side(const Tool& tool) {
  double longest = 0;
  for (int a = 0; a < tool.marker_count; ++a)
    for (int b = 0; b < a; ++b)
      longest = std::max(longest, (tool.markers_m[static_cast<std::size_t>(a)] -
                                   tool.markers_m[static_cast<std::size_t>(b)])
                                      .norm());
  return longest;
}

void take_lens(const Cell& drawn, double seconds, Cell& cell) {
  Recording board(drawn, cell, "field_board", seconds);
  const CameraFit fit = calibrate_camera(*board.frames.source, "field_board", {});
  cell.camera.model = fit.model;
  cell.camera.uncertainty.principal_point_px = fit.principal_point_sigma_px;
  cell.camera.uncertainty.focal_scale = fit.focal_sigma;
  set_camera(cell, cell.camera);
}

void take_tool(const Cell& drawn, double seconds, Cell& cell) {
  Recording turned(drawn, cell, "field_turn", seconds);
  std::mt19937_64 random(drawn.simulator.seed);
  ToolGeometrySettings settings;
  settings.drawn = drawn.tools.items[0];
  settings.longest_side_m = longest_side(turned.simulator.scenario().tools[0].tool) +
                            std::normal_distribution<double>(0, k_calliper_sigma_m)(random);
  settings.longest_side_sigma_m = k_calliper_sigma_m;
  std::vector<std::string> failures;
  const std::vector<PointFrame> points =
      recorded_points(turned.frames, drawn.tools.items[0], failures);
  settings.correlated_range_m = slow_range_of_mean(points, cell.camera);
  const ToolGeometry found = calibrate_tool(points, settings, "field_turn");
  Tool& tool = cell.tools.items[0];
  double squares = 0;
  for (std::size_t i = 0; i < found.markers_m.size(); ++i) {
    tool.markers_m[i] = found.markers_m[i];
    squares += found.marker_sigma_m[i] * found.marker_sigma_m[i];
  }
  tool.marker_sigma_m = std::sqrt(squares / static_cast<double>(found.markers_m.size()));
  (void)prepare_tool(tool);
}

void take_ranges(const Cell& drawn, double seconds, Cell& cell) {
  Recording turned(drawn, cell, "field_turn", seconds);
  const BlobSeries series = recorded_blobs(turned.frames, "");
  DepthCalibrationSettings settings;
  settings.brightness = Brightness::left_out;
  const ObservationSeries seen = find_tool(series, *series.tool, {});
  const DepthCalibration found =
      calibrate_depth(seen.observations, *series.tool, settings, "field_turn");
  cell.camera.depth.bias = found.bias;
  state_range_uncertainty(std::sqrt(found.covariance(0, 0)), std::sqrt(found.covariance(1, 1)),
                          cell.camera.uncertainty);
}

void take_tip(const Cell& drawn, double seconds, Cell& cell) {
  Recording tilted(drawn, cell, "field_pivot", seconds);
  const PoseSeries series = recorded_poses(tilted.frames, 0, PoseFrame::camera);
  PivotSettings settings;
  settings.centre_m = series.tool->middle_m();
  settings.scale_sigma = series.scale_sigma;
  const PivotResult found = calibrate_pivot(series.poses, settings, "field_pivot");
  Tool& tool = cell.tools.items[0];
  tool.tip_m = found.tip_m;
  tool.tip_sigma_m = std::sqrt(found.tip_covariance_m2.trace() / 3);
  (void)prepare_tool(tool);
}

void take_noise(const Cell& drawn, double seconds, Cell& cell) {
  Recording resting(drawn, cell, "field_rest", seconds);
  const PoseSeries series = recorded_poses(resting.frames, 0, PoseFrame::camera);
  const NoiseCalibration found = calibrate_noise(series.poses, "field_rest");
  const CameraUncertainty slow = marker_errors_of(found, cell, cell.tools.items[0],
                                                  series.poses[series.poses.size() / 2].pose);
  CameraUncertainty& sigma = cell.camera.uncertainty;
  sigma.correlated_range_m = slow.correlated_range_m;
  sigma.correlated_centroid_px = slow.correlated_centroid_px;
  sigma.fast_share = slow.fast_share;
  cell.camera.correlation = found.correlation;
}

void take_drift(const Cell& drawn, double seconds, Cell& cell) {
  Recording looked(drawn, cell, "field_look", seconds);
  cell.head_noise = calibrate_headset(looked.frames, 0).noise;
}

}  // namespace

Cell calibrated_field_cell(const Cell& drawn, const CalibrationSeconds& seconds) {
  Cell cell = drawn;
  take_lens(drawn, seconds.board, cell);
  take_tool(drawn, seconds.turn, cell);
  take_ranges(drawn, seconds.turn, cell);
  take_tip(drawn, seconds.pivot, cell);
  take_noise(drawn, seconds.rest, cell);
  take_drift(drawn, seconds.look, cell);
  return cell;
}

}  // namespace glint
