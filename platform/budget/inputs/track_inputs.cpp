// Measurement inputs of the nodes for stamps, tracks and predictions from frame to frame.
#include <vector>

#include "nodes/check_frame.hpp"
#include "nodes/locate_rois.hpp"
#include "nodes/predict_tracks.hpp"
#include "nodes/track_tools.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"
#include "platform/budget/inputs/views.hpp"

namespace glint::inputs {
namespace {

class StampKernel final : public NodeKernel<StampFrame> {
 public:
  StampKernel() : NodeKernel("StampFrame"), pixel_(1) {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    start_.width = limits.width;
    start_.height = limits.height;
    start_.reflectivity_bits = 16;
    frame_ = {};
    frame_.sequence = static_cast<std::uint64_t>(number);
    frame_.mid_exposure = Time{static_cast<std::int64_t>(number) * 22'222'222};
    frame_.arrival = frame_.mid_exposure + milliseconds(9);
    const int width = numbers.one_in(9) ? 8 : limits.width;
    if (!numbers.one_in(9)) frame_.reflectivity_16 = {pixel_.data(), width, limits.height};
    frame_.depth = {pixel_.data(), limits.width, limits.height};
    rewind();
  }
  void run() noexcept override { node_(frame_, stamp_); }

 private:
  std::vector<std::uint16_t> pixel_;
  Frame frame_;
  FrameStamp stamp_;
};

// Several frames before the measured one: in order, duplicate, late, or after a restart of the
// clock.
class CheckKernel final : public NodeKernel<CheckFrame> {
 public:
  CheckKernel() : NodeKernel("CheckFrame") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits&) override {
    Numbers numbers(kind, number);
    start_ = {};
    const int before = is_worst_case(kind) ? 1 + static_cast<int>(number % 12) : numbers.below(12);
    for (int i = 0; i < before; ++i) {
      const bool back = is_worst_case(kind) ? i > 0 : numbers.one_in(3);
      start_(stamp_at(back ? i : 1000 + i, i), verdict_);
    }
    const bool back = is_worst_case(kind) || numbers.one_in(3);
    stamp_ = stamp_at(back ? before : 1000 + before, before);
    if (numbers.one_in(8)) stamp_.reason = Reason::frame_invalid;
    rewind();
  }
  void run() noexcept override { node_(stamp_, verdict_); }

 private:
  static FrameStamp stamp_at(int frame, int sequence) {
    FrameStamp stamp;
    stamp.mid_exposure = Time{} + milliseconds(22) * (frame + 1);
    stamp.arrival = stamp.mid_exposure + milliseconds(9);
    stamp.sequence = static_cast<std::uint64_t>(sequence);
    return stamp;
  }
  FrameStamp stamp_;
  FrameVerdict verdict_;
};

// Input of several nodes: moving tools and a moving head.
struct Tracked {
  FrameVerdict verdict = accepted_verdict(2);
  HeadPose head;
  ToolSet set;
  graph::Latest<ToolSet> tools;
  Estimates last;

  void fill(InputKind kind, Numbers& numbers, const Limits& limits) {
    const bool all = is_worst_case(kind);
    head.valid = all || !numbers.one_in(4);
    head.time = verdict.stamp.mid_exposure;
    head.T_world_camera = {numbers.rotation(), numbers.in_box(2)};
    set.count = all ? limits.tools : 1 + numbers.below(limits.tools);
    last.tool_count = set.count;
    for (int t = 0; t < set.count; ++t) {
      const int markers =
          all ? limits.markers_per_tool : 3 + numbers.below(limits.markers_per_tool - 2);
      set.items[t] = any_tool(numbers, markers);
      const Pose seen = any_view(numbers);
      const Pose before = displaced(seen, numbers);
      Track& track = last.tracks[t];
      track = {};
      track.alive = all || !numbers.one_in(4);
      track.measured_now = all || !numbers.one_in(4);
      track.has_previous = track.alive && (all || !numbers.one_in(4));
      track.base = head.valid ? ReferenceFrame::world : ReferenceFrame::camera;
      const Pose base = head.valid ? head.T_world_camera : Pose{};
      track.newest = {Time{} + milliseconds(44), base * seen};
      track.previous = {Time{} + milliseconds(22), base * before};
      track.T_camera_tool = seen;
      track.marker_mask = 31;
      track.identity = set.items[t].identity;
      follow(base * seen, numbers, set.items[t], track);
      track.head_covariance = Matrix6::Identity() * 1e-6;
    }
    tools.set(set, 1, 0);
  }

  // Track state as after the motion filter.
  static void follow(const Pose& T_base_tool, Numbers& numbers, const Tool& tool, Track& track) {
    MotionState& motion = track.motion;
    motion.time = track.newest.time;
    motion.pose = {T_base_tool.rotation, T_base_tool * tool.middle_m()};
    motion.velocity_m_s = numbers.in_box(1);
    motion.acceleration_m_s2 = numbers.in_box(1);
    motion.angular_velocity_rad_s = numbers.in_box(2);
    motion.covariance = MotionCovariance::Identity() * 1e-5;
  }
};

constexpr int k_table_side = 24;

class PredictTracksKernel final : public NodeKernel<PredictTracks> {
 public:
  PredictTracksKernel() : NodeKernel("PredictTracks"), rays_(k_table_side * k_table_side * 3) {
    for (int y = 0; y < k_table_side; ++y) {
      for (int x = 0; x < k_table_side; ++x) {
        const Vector3 ray = Vector3((x - 11.5) * 0.004, (y - 11.5) * 0.004, 1).normalized();
        float* at = &rays_[static_cast<std::size_t>(3 * (y * k_table_side + x))];
        for (int i = 0; i < 3; ++i) at[i] = static_cast<float>(ray(i));
      }
    }
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    start_.limits = limits;
    start_.camera = {};
    start_.camera.width = limits.width;
    start_.camera.height = limits.height;
    start_.camera.fx = start_.camera.fy = 250;
    start_.camera.cx = limits.width / 2.0;
    start_.camera.cy = limits.height / 2.0;
    start_.camera.lens = Lens::rational;
    start_.camera.distortion = {0.48, 0.19, 0.0008, -0.0001, 0.014, 0.82, 0.29, 0.062};
    tracked_.fill(kind, numbers, limits);
    if (limits.lens_steps > 0 && (is_worst_case(kind) || numbers.one_in(2))) use_narrow_table();
    rewind();
  }
  void run() noexcept override {
    node_(tracked_.verdict, tracked_.head, tracked_.tools, graph::Previous<Anchor>(anchor_),
          graph::Previous<Estimates>(tracked_.last), predictions_);
  }

 private:
  // A lens table so narrow that every marker is outside it: the pixel search never ends early.
  void use_narrow_table() {
    start_.camera.lens = Lens::lut;
    start_.camera.width = start_.camera.height = k_table_side;
    start_.camera.cx = start_.camera.cy = 0.5 * k_table_side;
    start_.camera.table = {k_table_side, k_table_side, rays_.data()};
    const Pose aside{Quaternion::Identity(), Vector3(2.0, 1.5, 2.0)};
    for (int t = 0; t < tracked_.set.count; ++t) {
      Track& track = tracked_.last.tracks[t];
      const Pose base = tracked_.head.valid ? tracked_.head.T_world_camera : Pose{};
      track.newest.pose = base * aside;
      track.motion.pose = base * aside;
      track.T_camera_tool = aside;
    }
  }
  std::vector<float> rays_;
  Tracked tracked_;
  Anchor anchor_;
  Predictions predictions_;
};

class LocateRoisKernel final : public NodeKernel<LocateRois> {
 public:
  LocateRoisKernel() : NodeKernel("LocateRois") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    start_.limits = limits;
    start_.camera.width = limits.width;
    start_.camera.height = limits.height;
    set_.count = is_worst_case(kind) ? limits.tools : 1 + numbers.below(limits.tools);
    predictions_.search_part_of_frame = !is_worst_case(kind) && numbers.one_in(4);
    predictions_.frame_number = static_cast<std::uint32_t>(number);
    for (int t = 0; t < set_.count; ++t) {
      set_.items[t].marker_count = limits.markers_per_tool;
      Prediction& prediction = predictions_.tools[t];
      prediction = {};
      prediction.has_prior = is_worst_case(kind) || !numbers.one_in(20);
      prediction.in_view = true;
      if (kind == InputKind::worst && number % 2 == 0) {
        chain_box(t, set_.count, prediction);
      } else {
        prediction.low_px = {numbers.within(0, limits.width - 40),
                             numbers.within(0, limits.height - 40)};
        prediction.high_px =
            prediction.low_px + Vector2(numbers.within(10, 90), numbers.within(10, 90));
      }
    }
    tools_.set(set_, 1, 0);
    rewind();
  }
  void run() noexcept override { node_(verdict_, tools_, predictions_, rois_); }

 private:
  // Boxes below each other, each overlapping two columns of the next. The last box, as high as all
  // of them, meets one box, and only after merging with it the next.
  static void chain_box(int t, int count, Prediction& prediction) {
    const bool last = t == count - 1;
    const int from_right = count - 1 - t;
    const double left = last ? 4.0 : 4.0 + 24.0 * from_right - 14.0;
    prediction.low_px = {left, last ? 4.0 : 10.0 + 12.0 * t};
    prediction.high_px = {left + (last ? 12.0 : 26.0), last ? 250.0 : 18.0 + 12.0 * t};
  }
  FrameVerdict verdict_ = accepted_verdict(2);
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  Predictions predictions_;
  Rois rois_;
};

class TrackToolsKernel final : public NodeKernel<TrackTools> {
 public:
  TrackToolsKernel() : NodeKernel("TrackTools") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    start_.limits = limits;
    tracked_.fill(kind, numbers, limits);
    for (int t = 0; t < tracked_.set.count; ++t) {
      FittedTool& tool = fitted_[t % k_tool_partitions].tools[t];
      tool.reason = is_worst_case(kind) || !numbers.one_in(4) ? Reason::none : Reason::no_labeling;
      tool.T_camera_tool = any_view(numbers);
      followed_[t % k_tool_partitions].items[t / k_tool_partitions].reason = tool.reason;
      followed_[t % k_tool_partitions].items[t / k_tool_partitions].is_publishable = true;
    }
    anchor_.now.head = tracked_.head;
    anchor_.now.shared = Matrix6::Identity() * 1e-6;
    anchor_.now.moved_along = is_worst_case(kind) || numbers.one_in(20);
    rewind();
  }
  // All slots were occupied before: each call includes the cost of clearing them.
  void rewind() override {
    NodeKernel::rewind();
    estimates_.tool_count = start_.limits.tools;
  }
  void run() noexcept override {
    node_(tracked_.verdict, anchor_, tracked_.tools, fitted_, followed_,
          graph::Previous<Estimates>(tracked_.last), estimates_);
  }

 private:
  Tracked tracked_;
  graph::Parts<FittedTools, k_tool_partitions> fitted_;
  graph::Parts<FollowedTools, k_tool_partitions> followed_;
  Anchor anchor_;
  Estimates estimates_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> stamp_frame_kernel() { return std::make_unique<StampKernel>(); }
std::unique_ptr<MeasuredKernel> check_frame_kernel() { return std::make_unique<CheckKernel>(); }
std::unique_ptr<MeasuredKernel> predict_tracks_kernel() {
  return std::make_unique<PredictTracksKernel>();
}
std::unique_ptr<MeasuredKernel> locate_rois_kernel() {
  return std::make_unique<LocateRoisKernel>();
}
std::unique_ptr<MeasuredKernel> track_tools_kernel() {
  return std::make_unique<TrackToolsKernel>();
}

}  // namespace glint::inputs
