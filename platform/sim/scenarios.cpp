#include "platform/sim/scenarios.hpp"

#include "platform/cells/tool_file.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sim/placed_motion.hpp"
#include "platform/sim/scene.hpp"
#include "platform/sim/tool_body.hpp"

namespace glint::sim {
namespace {

// At arm's length ahead and below the eyes; world: x ahead, y left, z up, origin at the camera.
const Vector3 k_camera_m{0, 0, 0};
const Vector3 k_workplace_m{0.44, 0, -0.2};
const Vector3 k_table_m{0.52, 0.16, -0.34};
constexpr double k_tool_gap_m = 0.3;  // between several tools, side by side

Vector3 place_of(int tool) {
  const int step = (tool + 1) / 2;
  return k_workplace_m + Vector3(0, (tool % 2 == 1 ? 1 : -1) * step * k_tool_gap_m, 0);
}

std::vector<Tool> tools_or_pen(const std::vector<Tool>& tools) {
  return tools.empty() ? std::vector<Tool>{default_pen()} : tools;
}

void hold_still(Scenario& scenario, const std::vector<Tool>& tools) {
  scenario.head = fixed_motion(look_at(k_camera_m, k_workplace_m));
  scenario.tools.clear();
  for (const Tool& tool : tools) {
    const Grip grip = best_grip(tool);
    const Pose pose =
        grip_pose(grip, place_of(static_cast<int>(scenario.tools.size())), k_camera_m);
    scenario.tools.push_back(held_tool(tool, grip, scenario.signal, fixed_motion(pose)));
  }
}

void draw_by_hand(Scenario& scenario, const std::vector<Tool>& tools, HandSettings hand) {
  scenario.tools.clear();
  for (const Tool& tool : tools) {
    const int index = static_cast<int>(scenario.tools.size());
    const Grip grip = best_grip(tool);
    hand.T_world_tool = grip_pose(grip, place_of(index), k_camera_m);
    hand.grip_m = grip.centroid;
    scenario.tools.push_back(
        held_tool(tool, grip, scenario.signal,
                  hand_motion(hand, scenario.seed, static_cast<std::uint64_t>(index))));
  }
}

Duration frames_long(const Camera& camera, int frames) { return camera.period * frames; }

Interval seconds(int begin, int end) {
  return {Time{begin * 1'000'000'000LL}, Time{end * 1'000'000'000LL}};
}

Scenario hololens1(const std::vector<Tool>& tools) {
  Scenario scenario;
  scenario.camera = hololens1_short_throw();
  scenario.noise = hololens1_noise();
  scenario.signal = hololens1_signal();
  scenario.localisation = hololens1_localisation();
  scenario.room = furnished_room();
  // The external tracker has its own axes: the experiment must align them.
  scenario.reference.T_reference_world = {Quaternion(0.9, 0.1, -0.2, 0.3).normalized(),
                                          Vector3(1.2, -0.7, 0.9)};
  hold_still(scenario, tools_or_pen(tools));
  return scenario;
}

}  // namespace

Scenario still_run(const Camera& camera, const std::vector<Tool>& tools) {
  Scenario scenario;
  scenario.camera = camera;
  if (camera.reflectivity_bits == 8) {
    scenario.noise = hololens1_noise();
    scenario.signal = hololens1_signal();
    scenario.localisation = hololens1_localisation();
  }
  scenario.room = furnished_room();
  hold_still(scenario, tools_or_pen(tools));
  return scenario;
}

void lay_on_table(Scenario& scenario, std::size_t tool) {
  ToolBody& body = scenario.tools.at(tool);
  Matrix3 axes;  // of the tool, in the world: z up from the table, 30 degrees towards the camera
  axes.col(2) = Vector3(-0.5, 0, 0.8660254037844386);
  axes.col(0) = -Vector3::UnitY();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  const Quaternion rotation = Quaternion(axes).normalized();
  body.motion = fixed_motion({rotation, k_table_m - rotation * centroid_of(body.tool)});
  body.disc_normal = Vector3::UnitZ();
  body.parts.clear();
}

Scenario hand_held_run(const Camera& camera, const std::vector<Tool>& tools, std::uint64_t seed) {
  Scenario scenario = still_run(camera, tools);
  scenario.seed = seed;
  HeadSettings head;
  head.position_m = k_camera_m;
  head.target_m = k_workplace_m;
  scenario.head = head_motion(head, scenario.seed);
  draw_by_hand(scenario, tools_or_pen(tools), HandSettings{});
  // A saturating lamp on the cabinet, two strips of reflective tape, three spheres of a marker's
  // size.
  scenario.clutter.push_back({{0.85, 0.5, 0.02}, Vector3::Zero(), 0.05, 400'000});
  scenario.clutter.push_back({{0.79, -0.45, -0.25}, {-1, 0, 0}, 0.03, 9'000});
  scenario.clutter.push_back({{0.6, 0.3, -0.51}, {0, 0, 1}, 0.02, 9'000});
  scenario.clutter.push_back({{0.6, 0.22, -0.36}, Vector3::Zero(), 0.0055, 8'000});
  scenario.clutter.push_back({{0.7, -0.3, -0.05}, Vector3::Zero(), 0.0065, 8'000});
  scenario.clutter.push_back({{0.5, -0.33, -0.3}, Vector3::Zero(), 0.005, 8'000});
  return scenario;
}

Scenario default_run(const std::vector<Tool>& tools) {
  Scenario scenario = hand_held_run(hololens2_ahat(), tools, 1);
  scenario.duration = milliseconds(60'000);
  scenario.timing.slow.push_back(seconds(20, 24));
  scenario.occlusions.push_back({seconds(30, 31), 0, 0.09, 0.6});
  scenario.occlusions.push_back({seconds(50, 51), 0, 0.05, 0.45});
  scenario.absences.push_back({seconds(40, 42), 0, Vector3(0, 0, -1.2)});
  return scenario;
}

Scenario trajectory_run(const Camera& camera, const std::vector<Tool>& tools,
                        const Trajectory& head, const Trajectory& pen, double pen_scale) {
  Scenario scenario = still_run(camera, tools);
  scenario.duration = pen.length();
  const Pose T_world_camera = look_at(k_camera_m, k_workplace_m);
  scenario.head = placed_motion(head, {T_world_camera, 1.0, 1.0});
  // The pen rotates about the centroid of its markers, so that the centroid follows the recording.
  ToolBody& body = scenario.tools.front();
  const Pose to_middle{Quaternion::Identity(), centroid_of(body.tool)};
  const Pose T_camera_middle = T_world_camera.inverse() * body.motion->pose(Time{}) * to_middle;
  const MotionPointer middle = placed_motion(pen, {T_camera_middle, pen_scale, 1.0});
  body.motion =
      attached_motion(attached_motion(scenario.head, middle), fixed_motion(to_middle.inverse()));
  return scenario;
}

Scenario experiment_static(const std::vector<Tool>& tools) {
  Scenario scenario = hololens1(tools);
  scenario.duration = frames_long(scenario.camera, k_aligning_frames + k_static_frames);
  return scenario;
}

Scenario experiment_dynamic(int run, const std::vector<Tool>& tools) {
  Scenario scenario = hololens1(tools);
  scenario.seed = 100 + static_cast<std::uint64_t>(run);
  scenario.duration = frames_long(scenario.camera, k_aligning_frames + k_dynamic_frames);
  const double begin_s = frames_long(scenario.camera, k_aligning_frames).seconds();
  HeadSettings head;
  head.position_m = k_camera_m;
  head.target_m = k_workplace_m;
  head.begin_s = begin_s;
  head.sway_rms_m = 0.06;
  head.gaze_rms_rad = 0.1;
  scenario.head = head_motion(head, scenario.seed);
  HandSettings hand;
  hand.begin_s = begin_s;
  hand.rest_fraction = 0.05;
  draw_by_hand(scenario, tools_or_pen(tools), hand);
  return scenario;
}

NoiseSettings hololens1_noise() {
  NoiseSettings noise;
  noise.blob_pixel_sigma_px = 0.05;
  noise.blob_range_sigma_m = 0.0005;
  noise.read_sigma = 1.5;
  noise.shot_counts = 0.02;
  noise.depth_floor_m = 0.0005;
  noise.depth_at_100_counts_m = 0.002;
  noise.signal_min = 3;
  noise.depth_saturation = 4000;
  return noise;
}

SignalSettings hololens1_signal() {
  SignalSettings signal;
  signal.marker = 1200;
  signal.skin = 60;
  signal.pen_body = 20;
  signal.wall = 60;
  return signal;
}

// Determined once for both experiments, so that the baseline (Puljiz et al.) reproduces its
// published figures. motion_ and _per_ parameters act only while the head moves, rest_ parameters
// always.
LocalisationSettings hololens1_localisation() {
  LocalisationSettings localisation;
  localisation.rest_position_m = 0.00203;
  localisation.rest_angle_rad = 0.0058;
  localisation.rest_correlation_s = 3;
  localisation.position_per_speed_s = 0.245;
  localisation.position_per_angular_speed_m = 0.041;
  localisation.angle_per_speed_s_m = 0.62;
  localisation.angle_per_angular_speed_s = 0.25;
  localisation.motion_correlation_s = 0.6;
  localisation.motion_position_bias = Vector3(0.05, 0.05, 0.05);
  localisation.motion_angle_bias = Vector3(0.025, 0.025, 0.025);
  localisation.latency_s = 0.02;
  return localisation;
}

}  // namespace glint::sim
