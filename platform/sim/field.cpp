#include "platform/sim/field.hpp"

#include "kernels/elementary.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/systematic_covariance.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/tool_body.hpp"

namespace glint::sim {
namespace {

// Errors that no setting states, each 1 sigma or an amplitude.
constexpr double k_lens_residual_px = 0.1;
constexpr double k_wiggle_m = 0.001;
constexpr double k_radius_sigma_m = 0.0001;
constexpr double k_dim_sigma_m = 0.002;                      // of a marker's range, at 1,000 counts
constexpr double k_spread_share = 0.14, k_halo_share = 0.2;  // of HoloLens 2: stray_light.hpp
constexpr double k_stray_share_max = 0.02, k_detour_min_m = 0.1, k_detour_max_m = 0.5;
constexpr double k_hot_pixels_max = 30;
constexpr double k_grip_shift_max_m = 0.05;  // along the shaft, from held_tool's grip
constexpr double k_head_sigma_s = 0.005;
constexpr std::uint64_t k_calibrating_hand = 1000;  // its motion is another than that of work
const Vector3 k_put_away_m{-2, 0, 0};               // behind the headset
constexpr double k_lay_down_s = 0.8;                // 2.8 m/s at most
constexpr double k_drift_factor_max = 3;            // and its inverse

// Draws one after the other.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : key_{seed, Stream::field} {}
  double normal() { return gaussian(key_, next_++); }
  double between(double low, double high) { return low + (high - low) * uniform(key_, next_++); }
  Vector3 vector() {
    const double x = normal(), y = normal();
    return {x, y, normal()};
  }

 private:
  RandomKey key_;
  std::uint64_t next_ = 0;
};

Duration seconds_long(double seconds) { return {static_cast<std::int64_t>(seconds * 1e9)}; }

Interval interval(double begin_s, double length_s) {
  const Time begin = Time{} + seconds_long(begin_s);
  return {begin, begin + seconds_long(length_s)};
}

DeviceErrors device(Draws& draws, std::uint64_t seed) {
  const CameraUncertainty shipped;
  DeviceErrors errors;
  errors.exists = true;
  const double right = draws.normal(), down = draws.normal();
  errors.principal_point_px = shipped.principal_point_px * Vector2(right, down);
  errors.focal_scale = shipped.focal_scale * draws.normal();
  errors.range_offset_m = shipped.range_offset_m * draws.normal();
  errors.range_scale = shipped.range_scale * draws.normal();
  errors.correlated_range_m = shipped.correlated_range_m;
  errors.correlated_centroid_px = shipped.correlated_centroid_px;
  errors.lens_residual_px = k_lens_residual_px;
  errors.range_wiggle_m = k_wiggle_m;
  errors.seed = seed;
  return errors;
}

// As made, beside as drawn.
void build_inexactly(Draws& draws, ToolBody& body) {
  Tool& tool = body.tool;
  const double sigma_m = Tool{}.marker_sigma_m;
  for (int i = 0; i < tool.marker_count; ++i)
    tool.markers_m[static_cast<std::size_t>(i)] += sigma_m * draws.vector();
  const Vector3 drawn_tip_m = tool.tip_m;
  tool.tip_m += Tool{}.tip_sigma_m * draws.vector();
  tool.marker_radius_m += k_radius_sigma_m * draws.normal();
  align_to_stated_frame(drawn_tip_m, Quaternion::Identity(), body);
}

void add_events(Draws& draws, double duration_s, Scenario& scenario) {
  const auto begin = [&](double length_s) { return draws.between(1, duration_s - length_s); };
  scenario.timing.slow.push_back(interval(begin(4), 4));
  scenario.occlusions.push_back({interval(begin(1), 1), 0, 0.09, 0.6});
  const double laid_down_s = begin(3);
  scenario.absences.push_back({interval(laid_down_s, 3), 0, Vector3(0, 0, -1.2), k_lay_down_s});
  // A HoloLens 2 that sees no hand gives 5 frames a second.
  scenario.timing.slow.push_back(interval(laid_down_s + k_lay_down_s, 3 - 2 * k_lay_down_s));
}

// Optical errors of this device.
void draw_light(Draws& draws, DeviceErrors& errors) {
  errors.dim_m = k_dim_sigma_m * draws.normal();
  errors.spread_share = k_spread_share;
  errors.halo_share = k_halo_share;
  errors.stray_share = draws.between(0, k_stray_share_max);
  errors.stray_detour_m = draws.between(k_detour_min_m, k_detour_max_m);
  errors.hot_pixels = static_cast<int>(draws.between(0, k_hot_pixels_max));
}

// Shifts the hand along the shaft, so that it occludes markers from some sides. Part 0 is the
// shaft, all others are the hand.
void shift_grip(double metres, ToolBody& body) {
  if (body.parts.size() < 2) return;
  const Capsule& shaft = body.parts.front();
  const Vector3 up = (shaft.b - shaft.a).normalized();
  for (std::size_t i = 1; i < body.parts.size(); ++i) {
    body.parts[i].a += metres * up;
    body.parts[i].b += metres * up;
  }
}

HandSettings calibrating_hand(FieldTask task) {
  HandSettings hand;
  hand.rest_fraction = 0.05;
  hand.slowest_hz = 0.05;
  hand.fastest_hz = 0.5;
  hand.rotation_rms_rad = 0.3;
  hand.stroke_rms_m = task == FieldTask::rotate ? 0.1 : 0;
  return hand;
}

// The device and the tool as they are; all else as the user prepares it.
void prepare(FieldTask task, std::uint64_t seed, Scenario& scenario) {
  const Time begin;
  scenario.clutter.clear();
  if (task != FieldTask::move_head) scenario.head = fixed_motion(scenario.head->pose(begin));
  ToolBody& body = scenario.tools.front();
  const Pose T_world_tool = body.motion->pose(begin);
  if (task == FieldTask::target) {
    body.motion = fixed_motion({T_world_tool.rotation, k_put_away_m});
    scenario.calibration_target = Chessboard{};
    scenario.calibration_target->motion =
        target_motion(scenario.head->pose(begin), *scenario.calibration_target, seed);
    return;
  }
  if (task == FieldTask::still || task == FieldTask::move_head) {
    body.motion = fixed_motion(T_world_tool);
    return;
  }
  HandSettings hand = calibrating_hand(task);
  hand.T_world_tool = T_world_tool;
  hand.grip_m = task == FieldTask::pivot ? body.tool.tip_m : body.tool.middle_m();
  body.motion = hand_motion(hand, seed, k_calibrating_hand);
}

}  // namespace

Scenario field_run(const Camera& camera, const std::vector<Tool>& tools,
                   const RobotPlacement& robot, double duration_s, std::uint64_t seed,
                   FieldTask task) {
  Draws draws(seed);
  Scenario scenario = hand_held_run(camera, tools, seed);
  scenario.device = device(draws, seed);
  for (ToolBody& body : scenario.tools) build_inexactly(draws, body);
  const double drift = exponential(draws.between(-1, 1) * logarithm(k_drift_factor_max));
  LocalisationSettings& head = scenario.localisation;
  for (double* part : {&head.rest_position_m, &head.rest_angle_rad, &head.position_per_speed_s,
                       &head.position_per_angular_speed_m, &head.angle_per_speed_s_m,
                       &head.angle_per_angular_speed_s}) {
    *part *= drift;
  }
  head.latency_s = k_head_sigma_s * draws.normal();
  scenario.timing.stamp_offset = seconds_long(CameraUncertainty{}.time_stamp_s * draws.normal());
  // The robot stands where the cell states; the headset's world lies beside that.
  const Vector3 turn = robot.sigma_rad * draws.vector();
  const Pose off{from_rotation_vector(turn), robot.sigma_m * draws.vector()};
  head.T_stated_world = robot.T_world_robot * off * robot.T_world_robot.inverse();
  draw_light(draws, scenario.device);
  for (ToolBody& body : scenario.tools) shift_grip(draws.between(0, k_grip_shift_max_m), body);
  if (task == FieldTask::work) {
    add_events(draws, duration_s, scenario);
  } else {
    prepare(task, seed, scenario);
  }
  return scenario;
}

}  // namespace glint::sim
