#include "platform/sim/touches.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "kernels/motion/interpolate.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sim/random.hpp"
#include "platform/sim/tool_body.hpp"

namespace glint::sim {
namespace {

constexpr double k_lift_m = 0.04;  // of the tool, between two touches

// Sequence of motions, with a smooth transition between two.
class MotionSequence final : public Motion {
 public:
  MotionSequence(std::vector<MotionPointer> stations, const TouchSettings& settings, double lift_m)
      : stations_(std::move(stations)), settings_(settings), lift_m_(lift_m) {}

  [[nodiscard]] Pose pose(Time time) const override {
    const double t = std::max(Duration{time.nanoseconds}.seconds(), 0.0);
    const double each = settings_.hold_s + settings_.move_s;
    const auto at = std::min(static_cast<std::size_t>(t / each), stations_.size() - 1);
    const Pose here = stations_[at]->pose(time);
    const double moved =
        smooth_step(t, static_cast<double>(at) * each + settings_.hold_s, settings_.move_s);
    if (moved == 0 || at + 1 == stations_.size()) return here;
    const Pose there = stations_[at + 1]->pose(time);
    const Vector3 lift = 4 * moved * (1 - moved) * lift_m_ * Vector3::UnitZ();
    return {slerp(here.rotation, there.rotation, moved),
            constant_velocity(here.translation, there.translation, moved) + lift};
  }

 private:
  std::vector<MotionPointer> stations_;
  TouchSettings settings_;
  double lift_m_;
};

// Sequence of uniform random numbers.
class UniformSequence {
 public:
  explicit UniformSequence(std::uint64_t seed) : key_{seed, Stream::touches} {}
  double between(double low, double high) { return low + (high - low) * uniform(key_, next_++); }

 private:
  RandomKey key_;
  std::uint64_t next_ = 0;
};

}  // namespace

Duration TouchSettings::duration() const {
  const double seconds = touches * (hold_s + move_s) + rest_s;
  return {static_cast<std::int64_t>(1e9 * seconds)};
}

void touch_points(const TouchSettings& settings, std::uint64_t seed, Scenario& scenario) {
  ToolBody& body = scenario.tools.front();
  const Grip grip = best_grip(body.tool);
  UniformSequence draws(seed);
  std::vector<MotionPointer> heads, tools;
  for (int i = 0; i <= settings.touches; ++i) {
    const bool second = i % 3 == 2 && i < settings.touches;
    const Vector3& point = second ? settings.second_m : settings.first_m;
    const Vector3 markers = point + (grip.centroid - body.tool.tip_m).norm() * Vector3::UnitZ();
    const double aside = draws.between(-settings.view_aside_rad, settings.view_aside_rad);
    const double up = draws.between(settings.view_up_rad[0], settings.view_up_rad[1]);
    const Vector3 back = from_rotation_vector(Vector3(0, 0, aside)) *
                         (from_rotation_vector(Vector3(0, up, 0)) * Vector3(-1, 0, 0));
    HeadSettings head;
    head.position_m = markers + draws.between(settings.view_m[0], settings.view_m[1]) * back;
    head.target_m = markers;
    head.begin_s = -10;
    head.sway_rms_m = settings.sway_rms_m;
    head.gaze_rms_rad = settings.gaze_rms_rad;
    heads.push_back(head_motion(head, seed));

    const double lean = settings.lean_rad * draws.between(0.4, 1),
                 side = draws.between(-3.15, 3.15);
    const Vector3 axis = from_rotation_vector(side * Vector3::UnitZ()) * Vector3::UnitX();
    HandSettings hand;
    hand.T_world_tool.rotation =
        (from_rotation_vector(lean * axis) * grip_pose(grip, markers, head.position_m).rotation)
            .normalized();
    hand.T_world_tool.translation = point - hand.T_world_tool.rotation * body.tool.tip_m;
    hand.grip_m = body.tool.tip_m;
    hand.rest_fraction = 1;
    tools.push_back(hand_motion(hand, seed, static_cast<std::uint64_t>(i)));
  }
  scenario.head = std::make_shared<MotionSequence>(std::move(heads), settings, 0);
  body.motion = std::make_shared<MotionSequence>(std::move(tools), settings, k_lift_m);
  scenario.duration = settings.duration();
}

}  // namespace glint::sim
