// Measurement inputs of AnchorHead (head poses) and FollowMotion (tools that have long been static,
// move, or start).
#include <array>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "nodes/anchor_head.hpp"
#include "nodes/follow_motion.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"
#include "platform/budget/inputs/views.hpp"

namespace glint::inputs {
namespace {

constexpr double k_translation_sigma_m = 0.0005, k_rotation_sigma_rad = 0.004;
constexpr int k_frames_to_fill = k_static_frames_max + 2;
constexpr int k_static_windows = 4;  // full static windows from which the worst inputs start

// The partition with the most tools, and its next frame.
class FollowKernel final : public NodeKernel<FollowMotion> {
 public:
  FollowKernel() : NodeKernel("FollowMotion") {
    for (int i = 0; i < k_static_windows; ++i) {
      Numbers numbers(InputKind::worst, static_cast<std::uint64_t>(i));
      begin(numbers, k_tools_max, k_markers_per_tool_max);
      for (int frame = 0; frame < k_frames_to_fill; ++frame) follow(numbers, Vector3::Zero());
      static_windows_[i] = {start_, anchor_, set_, static_poses_, last_, frame_};
    }
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    if (kind == InputKind::worst || kind == InputKind::searched) {
      const StaticWindow& window = static_windows_[number % k_static_windows];
      start_ = window.node;
      anchor_ = window.anchor;
      set_ = window.set;
      static_poses_ = window.static_poses;
      last_ = window.last;
      frame_ = window.frame;
      set_.count = limits.tools;
      start_.limits = limits;
      measure(numbers, Vector3::Zero(), 0);
      anchor_.now.moved_along = anchor_.now.in_gap = true;
      anchor_.now.step_covariance = Matrix6::Identity() * 1e-9;
    } else {
      const int markers = 3 + numbers.below(limits.markers_per_tool - 2);
      begin(numbers, 1 + numbers.below(limits.tools), markers);
      start_.limits = limits;
      const Vector3 velocity = numbers.one_in(3) ? Vector3(Vector3::Zero()) : numbers.in_box(1);
      const int before = numbers.below(24);
      for (int frame = 0; frame < before; ++frame) follow(numbers, velocity);
      measure(numbers, velocity, 5);
    }
    tools_.set(set_, 1, 0);
    rewind();
  }
  // All slots were occupied before: each call includes the cost of clearing them.
  void rewind() override {
    NodeKernel::rewind();
    const int slots = tools_of(start_.limits, {0, k_tool_partitions});
    for (int slot = 0; slot < slots; ++slot) followed_.items[slot].in_use = true;
  }
  void run() noexcept override { call(node_, followed_); }

 private:
  using Followed = graph::Parts<FollowedTools, k_tool_partitions>;
  struct StaticWindow {
    FollowMotion node;
    Anchor anchor;
    ToolSet set;
    std::array<Pose, k_tools_max> static_poses;
    Followed last;
    int frame;
  };

  void begin(Numbers& numbers, int tools, int markers) {
    start_ = {};
    last_ = {};
    frame_ = 0;
    set_.count = tools;
    for (int t = 0; t < tools; ++t) {
      set_.items[t] = any_tool(numbers, markers);
      static_poses_[t] = any_view(numbers);
    }
    anchor_.now = {};
    anchor_.now.head.valid = true;
    anchor_.now.head.T_world_camera = {numbers.rotation(), numbers.in_box(2)};
    anchor_.now.independent = Matrix6::Identity() * 1e-9;
    tools_.set(set_, 1, 0);
  }
  // Misses one in `missed` tools; none for 0.
  void measure(Numbers& numbers, const Vector3& velocity, int missed) {
    verdict_ = accepted_verdict(static_cast<std::uint64_t>(++frame_));
    anchor_.now.head.time = verdict_.stamp.mid_exposure;
    for (int t = 0; t < set_.count; t += k_tool_partitions) {
      FittedTool& tool = fitted_[0].tools[t];
      const bool found = missed == 0 || !numbers.one_in(missed);
      tool.reason = found ? Reason::none : Reason::no_labeling;
      show_few(t, found ? 0 : numbers.below(k_partial_markers_max + 1));
      const Vector3 noise = 1.7 * k_translation_sigma_m * numbers.in_box(2);
      const Vector3 rotation = 1.7 * k_rotation_sigma_rad * numbers.in_box(2);
      tool.T_camera_tool.rotation =
          (from_rotation_vector(rotation) * static_poses_[t].rotation).normalized();
      tool.T_camera_tool.translation =
          static_poses_[t].translation + noise + velocity * (0.022 * frame_);
      tool.covariance = Matrix6::Zero();
      tool.covariance.diagonal() << Vector3::Constant(k_translation_sigma_m *
                                                      k_translation_sigma_m),
          Vector3::Constant(k_rotation_sigma_rad * k_rotation_sigma_rad);
      const Vector3 arm = set_.items[t].tip_m - set_.items[t].middle_m();
      tool.covariance = moved_covariance(tool.covariance, tool.T_camera_tool.rotation * arm);
    }
  }
  // Sets `count` visible markers of a tool at its static pose.
  void show_few(int t, int count) {
    PartialMarkers& few = few_.tools[t];
    few.count = count;
    for (int m = 0; m < count; ++m) {
      few.items[m] = {m, static_poses_[t] * set_.items[t].markers_m[m], Matrix3::Identity() * 1e-6};
    }
  }
  void follow(Numbers& numbers, const Vector3& velocity) {
    measure(numbers, velocity, 0);
    call(start_, followed_);
    last_[0] = followed_;
  }
  void call(FollowMotion& node, FollowedTools& followed) noexcept {
    node(verdict_, anchor_, tools_, fitted_, few_, graph::Previous<Followed>(last_),
         graph::Partition{0, k_tool_partitions}, followed);
  }

  std::array<StaticWindow, k_static_windows> static_windows_;
  std::array<Pose, k_tools_max> static_poses_;
  int frame_ = 0;
  FrameVerdict verdict_;
  Anchor anchor_;
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  graph::Parts<FittedTools, k_tool_partitions> fitted_;
  SeenFew few_;
  Followed last_;
  FollowedTools followed_;
};

// A headset with drift in front of a fixed reference body, or without one.
class AnchorKernel final : public NodeKernel<AnchorHead> {
 public:
  AnchorKernel() : NodeKernel("AnchorHead") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    const bool all = kind == InputKind::worst || kind == InputKind::searched;
    start_.limits = limits;
    start_.reference = all || !numbers.one_in(3) ? 0 : -1;
    set_.count = 1;
    set_.items[0] = any_tool(numbers, limits.markers_per_tool);
    tools_.set(set_, 1, 0);
    last_ = {};
    const Pose T_world_camera{numbers.rotation(), numbers.in_box(2)};
    const Pose T_camera_body = any_view(numbers);
    const int before = k_body_definition_frames + numbers.below(20);
    for (int frame = 0; frame <= before; ++frame) {
      verdict_ = accepted_verdict(static_cast<std::uint64_t>(frame));
      const bool last = frame == before;
      head_.valid = all || !last || !numbers.one_in(4);
      head_.time = verdict_.stamp.mid_exposure;
      head_.T_world_camera = {T_world_camera.rotation,
                              T_world_camera.translation + 0.001 * numbers.in_box(1)};
      FittedTool& body = fitted_[0].tools[0];
      // Occluded in the frame before the last: poses then follow the head.
      const bool seen = all ? frame != before - 1 : !numbers.one_in(4);
      body.reason = seen ? Reason::none : Reason::no_labeling;
      body.T_camera_tool = {T_camera_body.rotation,
                            T_camera_body.translation + 0.0003 * numbers.in_box(1)};
      body.covariance = Matrix6::Identity() * 1e-7;
      if (last) break;
      start_(verdict_, head_, tools_, fitted_, graph::Previous<Anchor>(last_), anchor_);
      last_ = anchor_;
    }
    rewind();
  }
  void run() noexcept override {
    node_(verdict_, head_, tools_, fitted_, graph::Previous<Anchor>(last_), anchor_);
  }

 private:
  FrameVerdict verdict_;
  HeadPose head_;
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  graph::Parts<FittedTools, k_tool_partitions> fitted_;
  Anchor last_, anchor_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> anchor_head_kernel() { return std::make_unique<AnchorKernel>(); }
std::unique_ptr<MeasuredKernel> follow_motion_kernel() { return std::make_unique<FollowKernel>(); }

}  // namespace glint::inputs
