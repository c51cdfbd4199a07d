#include "platform/lab/experiments/clutter_scene.hpp"

#include <memory>
#include <numbers>
#include <stdexcept>

#include "kernels/elementary.hpp"
#include "platform/cells/tool_distinction.hpp"
#include "platform/lab/experiments/point_view.hpp"
#include "platform/sim/crowded.hpp"
#include "platform/sim/hand_motion.hpp"
#include "platform/sim/random.hpp"
#include "platform/sim/scenarios.hpp"
#include "platform/sim/tool_body.hpp"

namespace glint {
namespace {

// World: x ahead, y left, z up, origin at the camera. At arm's length, ahead and below the eyes.
const Vector3 k_workplace_m{0.46, 0, -0.18};
constexpr double k_tool_gap_m = 0.17;
// Volume of the false markers: from in front of the hands to the table and the wall behind them.
const Vector3 k_stray_low_m{0.25, -0.5, -0.6}, k_stray_high_m{0.9, 0.5, 0.15};
constexpr double k_stray_radius_m = 0.0055;
constexpr double k_swing_m = 0.13, k_swing_s = 4.0;
constexpr double k_apart_m = 0.1;

// Sinusoidal motion along y.
class Swing final : public sim::Motion {
 public:
  explicit Swing(double amplitude_m) : amplitude_m_(amplitude_m) {}
  [[nodiscard]] Pose pose(Time time) const override {
    const double seconds = Duration{time.nanoseconds}.seconds();
    const double along =
        sine_cosine(2 * std::numbers::pi * seconds / k_swing_s + 0.25 * 2 * std::numbers::pi).sine;
    return {Quaternion::Identity(), Vector3(0, amplitude_m_ * along, 0)};
  }

 private:
  double amplitude_m_;
};

sim::Scenario empty_run(int frames, std::uint64_t seed) {
  sim::Scenario scenario = sim::still_run(hololens2_ahat());
  scenario.seed = seed;
  scenario.duration = scenario.camera.period * frames;
  sim::HeadSettings head;
  head.target_m = k_workplace_m;
  scenario.head = sim::head_motion(head, seed);
  scenario.tools.clear();
  return scenario;
}

// `moved_by` carries the hand; null: the hand stays at its workplace.
void add_hand(const Tool& tool, const Vector3& place, sim::MotionPointer moved_by,
              const sim::HandSettings& settings, sim::Scenario& scenario) {
  const sim::Grip grip = sim::best_grip(tool);
  sim::HandSettings hand = settings;
  hand.T_world_tool = sim::grip_pose(grip, place, Vector3::Zero());
  hand.grip_m = grip.centroid;
  sim::MotionPointer motion = sim::hand_motion(hand, scenario.seed, scenario.tools.size());
  if (moved_by) motion = sim::attached_motion(std::move(moved_by), std::move(motion));
  scenario.tools.push_back(sim::held_tool(tool, grip, scenario.signal, std::move(motion)));
}

sim::Clutter stray(int number, std::uint64_t seed, double signal) {
  const sim::RandomKey key{seed, sim::Stream::room, static_cast<std::uint64_t>(2000 + number)};
  sim::Clutter stray;
  for (int axis = 0; axis < 3; ++axis) {
    const double share = sim::uniform(key, static_cast<std::uint64_t>(axis));
    stray.position_m(axis) =
        k_stray_low_m(axis) + share * (k_stray_high_m(axis) - k_stray_low_m(axis));
  }
  stray.radius_m = k_stray_radius_m;
  stray.signal = signal;
  return stray;
}

void rename(Tool& tool, const std::string& name) {
  tool.name = {};
  name.copy(tool.name.data(), tool.name.size() - 1);
}

void prepare(Tool& tool) {
  if (prepare_tool(tool) != Reason::none) throw std::logic_error("clutter: invalid tool");
}

}  // namespace

ToolSet five_tools(std::uint64_t seed) {
  const ToolSet balls = sim::crowd_of_tools(2, seed);
  const PointTool ndi = ndi_8700339(), pointer = sttar_pointer();
  ToolSet tools;
  tools.count = 5;
  tools.items[0] = five_marker_pen().tool;
  tools.items[1] = ndi.tool;
  rename(tools.items[1], ndi.name);
  tools.items[2] = pointer.tool;
  rename(tools.items[2], pointer.name);
  tools.items[3] = balls.items[0];
  tools.items[4] = balls.items[1];
  return tools;
}

ToolSet mirror_twins(const Tool& tool) {
  ToolSet tools;
  tools.count = 2;
  tools.items[0] = tools.items[1] = tool;
  for (Vector3& marker : tools.items[1].markers_m) marker.x() = -marker.x();
  rename(tools.items[1], "mirrored");
  prepare(tools.items[1]);
  return tools;
}

ToolSet nearly_equal_tools(double sigmas) {
  constexpr int k_steps_max = 200;
  constexpr double k_move_m = 0.0001;
  const PointTool ndi = ndi_8700339();
  ToolSet tools;
  tools.count = 2;
  tools.items[0] = tools.items[1] = ndi.tool;
  rename(tools.items[0], ndi.name);
  rename(tools.items[1], "nearly equal");
  Vector3& moved = tools.items[1].markers_m[static_cast<std::size_t>(ndi.tool.marker_count - 1)];
  DistinctionSettings settings;
  settings.limit_sigmas = sigmas;
  for (int step = 0; step < k_steps_max; ++step) {
    moved.y() -= k_move_m;
    prepare(tools.items[1]);
    bool apart = true;
    for (const WrongLabeling& labeling : distinguish(tools, settings).wrong_labelings)
      apart = apart && labeling.seen == labeling.other;
    if (apart) return tools;
  }
  throw std::logic_error("clutter: no shift separates the two tools");
}

sim::Scenario cluttered_run(const ToolSet& tools, int strays, int frames, std::uint64_t seed) {
  sim::Scenario scenario = empty_run(frames, seed);
  for (int t = 0; t < tools.count; ++t) {
    const Vector3 aside(0, k_tool_gap_m * (t - 0.5 * (tools.count - 1)), 0);
    add_hand(tools.items[static_cast<std::size_t>(t)], k_workplace_m + aside, nullptr, {},
             scenario);
  }
  for (int i = 0; i < strays; ++i)
    scenario.clutter.push_back(stray(i, seed, scenario.signal.marker));
  return scenario;
}

sim::Scenario passing_run(const ToolSet& two_tools, Passing passing, int frames,
                          std::uint64_t seed) {
  sim::Scenario scenario = empty_run(frames, seed);
  const Vector3 away =
      passing == Passing::beside ? Vector3(0, 0, 0.5 * k_apart_m) : Vector3(-0.5 * k_apart_m, 0, 0);
  sim::HandSettings hand;
  hand.stroke_rms_m = 0.005;  // the swing moves the hand
  add_hand(two_tools.items[0], k_workplace_m + away, std::make_shared<Swing>(k_swing_m), hand,
           scenario);
  add_hand(two_tools.items[1], k_workplace_m - away, std::make_shared<Swing>(-k_swing_m), hand,
           scenario);
  return scenario;
}

}  // namespace glint
