// Measurement inputs of the tick group's kernels: estimates of any age, and samples of any state.
#include <stdexcept>

#include "nodes/output.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"
#include "platform/budget/inputs/views.hpp"

namespace glint::inputs {
namespace {

class PredictToolsKernel final : public NodeKernel<PredictTools> {
 public:
  PredictToolsKernel() : NodeKernel("PredictTools") {
    if (node_.prepare() != Reason::none)
      throw std::runtime_error("PredictTools cannot be prepared: no memory");
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    const bool all = is_worst_case(kind);
    node_.limits = limits;
    now_ = {Time{} + milliseconds(1000), static_cast<std::uint64_t>(number),
            1'700'000'000'000'000'000};
    latest_estimates_.tool_count = all ? limits.tools : 1 + numbers.below(limits.tools);
    for (int t = 0; t < latest_estimates_.tool_count; ++t) {
      Track& track = latest_estimates_.tracks[t];
      track = {};
      track.alive = all || !numbers.one_in(5);
      track.base = all || !numbers.one_in(4) ? ReferenceFrame::world : ReferenceFrame::camera;
      track.reason = Reason::none;
      const Pose pose = any_view(numbers);
      const int age_ms = numbers.below(all ? 200 : 300);
      const Time seen = now_.tick - milliseconds(age_ms);
      track.newest = {seen, pose};
      track.motion.time = seen;
      track.motion.pose = pose;
      track.motion.velocity_m_s = numbers.in_box(2);
      track.motion.acceleration_m_s2 = numbers.in_box(10);
      track.motion.angular_velocity_rad_s = numbers.in_box(6);
      track.motion.angular_acceleration_rad_s2 = numbers.in_box(40);
      track.motion.covariance = MotionCovariance::Identity() * 1e-4;
      track.marker_mask = 31;
      latest_estimates_.tips[t] = {{0, 0, -0.12}, 3e-4};
    }
    estimates_.set(latest_estimates_, 1, 0);
    RobotFrame robot;
    robot.state = all || !numbers.one_in(4) ? RegistrationState::given : RegistrationState::none;
    robot.T_world_robot = {numbers.rotation(), numbers.in_box(2)};
    robot_.set(robot, 1, 0);
    buttons_.set({static_cast<std::uint8_t>(numbers.below(k_buttons_mask + 1))}, 1, 0);
    rewind();
  }
  void run() noexcept override { node_(now_, estimates_, robot_, buttons_, samples_); }

 private:
  Now now_;
  Estimates latest_estimates_;
  graph::Latest<Estimates> estimates_;
  graph::Latest<RobotFrame> robot_;
  graph::Latest<PenButtons> buttons_;
  PoseSamples samples_;
};

class PackCanKernel final : public NodeKernel<PackCan> {
 public:
  PackCanKernel() : NodeKernel("PackCan") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    const bool all = is_worst_case(kind);
    start_ = {};
    start_.limits = limits;
    start_.settings.format = number % 2 == 0 ? CanFormat::classic : CanFormat::fd;
    samples_.count = all ? limits.tools : 1 + numbers.below(limits.tools);
    // The tick before: some tools were lost (in the worst case all), and the periodic frames were
    // sent or not.
    for (int t = 0; t < samples_.count; ++t) {
      samples_.items[t] = {};
      samples_.items[t].tool = static_cast<std::uint8_t>(t);
      samples_.items[t].state = all || numbers.one_in(8) ? TrackState::lost : TrackState::measured;
    }
    const Time before = Time{} + milliseconds(4);
    start_({before, 1, k_unix_offset_ns}, samples_, frames_);
    const bool due = all || numbers.one_in(25);
    now_ = {before + milliseconds(due ? 1000 : 4), 2, k_unix_offset_ns};
    for (int t = 0; t < samples_.count; ++t) fill(t, numbers, all);
    rewind();
  }
  void run() noexcept override { node_(now_, samples_, frames_); }

 private:
  static constexpr std::int64_t k_unix_offset_ns = 1'700'000'000'000'000'000;

  void fill(int t, Numbers& numbers, bool all) {
    PoseSample& sample = samples_.items[t];
    sample = {};
    sample.tool = static_cast<std::uint8_t>(t);
    sample.tick = now_.tick;
    sample.tick_number = 2;
    sample.measurement = now_.tick - milliseconds(1 + numbers.below(60));
    sample.state = all || !numbers.one_in(8) ? TrackState::measured : TrackState::lost;
    sample.registration = RegistrationState::given;
    sample.reason = Reason::none;
    sample.buttons = PenButtons{k_buttons_mask}.of_tool(t);
    if (!sample.has_pose()) return;
    sample.pose = any_view(numbers);
    sample.velocity_m_s = numbers.in_box(2);
    sample.angular_velocity_rad_s = numbers.in_box(6);
    sample.sigma_position_m = numbers.within(0, 0.01);
    sample.sigma_orientation_rad = numbers.within(0, 0.02);
    sample.marker_mask = static_cast<std::uint8_t>(numbers.below(256));
  }

  Now now_;
  PoseSamples samples_;
  CanFrames frames_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> predict_tools_kernel() {
  return std::make_unique<PredictToolsKernel>();
}
std::unique_ptr<MeasuredKernel> pack_can_kernel() { return std::make_unique<PackCanKernel>(); }

}  // namespace glint::inputs
