// Measurement inputs of AssignMarkers (labelings) and RefinePose (labelled markers).
#include <algorithm>

#include "kernels/pose/map_pose.hpp"
#include "nodes/pose_nodes.hpp"
#include "nodes/refine_pose.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"
#include "platform/budget/inputs/views.hpp"

namespace glint::inputs {
namespace {

class AssignKernel final : public NodeKernel<AssignMarkers> {
 public:
  AssignKernel() : NodeKernel("AssignMarkers") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    start_.limits = limits;
    set_.count = is_worst_case(kind) ? limits.tools : 1 + numbers.below(limits.tools);
    tools_.set(set_, 1, 0);
    for (int t = 0; t < set_.count; ++t) {
      Labelings& labelings = labelings_[t % k_tool_partitions].tools[t];
      labelings = {};
      const bool contested = is_worst_case(kind) && number % 4 != 3;
      labelings.count = contested ? k_labelings_max : numbers.below(k_labelings_max + 1);
      for (int k = 0; k < labelings.count; ++k) {
        Labeling& labeling = labelings.items[k];
        labeling.marker.fill(-1);
        labeling.count = 3 + numbers.below(limits.markers_per_tool - 2);
        labeling.rms_m = numbers.within(0, 0.004);
        // Of contested labelings only the last has another pose: all are tested before an
        // alternative is found.
        if (!contested || k + 1 == k_labelings_max)
          labeling.T_camera_tool.rotation = numbers.rotation();
        if (contested) {
          contest(t, k, numbers, labeling);
          continue;
        }
        for (int m = 0; m < labeling.count; ++m) {
          labeling.marker[m] = static_cast<std::int16_t>(numbers.below(limits.blobs));
        }
      }
    }
    rewind();
  }
  void run() noexcept override { node_(verdict_, tools_, labelings_, assignment_); }

 private:
  // All tools want marker 0; after its assignment, each finds only its last labeling free. The
  // markers of that labeling, and the order of the tools, differ between inputs.
  static void contest(int t, int k, Numbers& numbers, Labeling& labeling) {
    labeling.count = 3;
    labeling.rms_m = numbers.within(0, 0.004);
    labeling.marker[0] = static_cast<std::int16_t>(k + 1 < k_labelings_max ? 0 : 1 + t);
  }
  FrameVerdict verdict_ = accepted_verdict(1);
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  graph::Parts<ToolLabelings, k_tool_partitions> labelings_;
  Assignment assignment_;
};

// The node's settings for markers at their predicted positions.
constexpr RefineSettings k_predicted = {.markers_kept_min = k_predicted_markers_min};

WeightedMarker weighed(const Tool& tool, int m, const Marker& seen, const MarkerNoise& noise) {
  const double range_m = seen.surface_range_m + tool.centre_offset_m();
  const MarkerMeasurementModel sight = measurement_model(seen, range_m, noise);
  return whiten_marker(tool.markers_m[m], sight.rays, range_m, sight.variance).value;
}

// Number of marker steps in the fits of one tool, including the MAP pose from isolated markers near
// the prediction.
int marker_steps_of(const Tool& tool, const Marker* seen, const MarkerNoise& noise,
                    const Prediction& prediction) {
  std::array<WeightedMarker, k_markers_per_tool_max> markers;
  for (int m = 0; m < tool.marker_count; ++m) markers[m] = weighed(tool, m, seen[m], noise);
  const std::size_t count = static_cast<std::size_t>(tool.marker_count);
  const PredictedPose expected = {prediction.T_camera_tool, prediction.covariance, tool.middle_m()};
  const int steps = map_pose({markers.data(), count}, expected, k_predicted.steps_max).steps;
  return refine_pose({markers.data(), count}, tool.tip_m, nullptr, k_predicted).work.marker_steps +
         steps * tool.marker_count;
}

class RefineKernel final : public NodeKernel<RefinePose> {
 public:
  RefineKernel() : NodeKernel("RefinePose") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    const bool all = is_worst_case(kind);
    start_.limits = limits;
    start_.noise = all ? k_smallest_noise : MarkerNoise{};
    start_.noise.focal_px = 253;
    start_.correction = {};
    if (all || numbers.one_in(2)) {
      start_.correction = {CorrectionFrame::tool,
                           numbers.in_box(0.002),
                           numbers.in_box(0.01),
                           {0, 2},
                           {-1, 1},
                           {-1, 1}};
    }
    set_.count = all ? limits.tools : 1 + numbers.below(limits.tools);
    markers_.count = 0;
    for (int t = 0; t < set_.count; ++t) {
      assignment_.reason[t] =
          all || !numbers.one_in(5) ? Reason::none : Reason::markers_assigned_elsewhere;
      const int first = markers_.count;
      Prediction& prediction = predictions_.tools[t];
      prediction.follows_motion = all || numbers.one_in(2);
      prediction.T_camera_tool = any_view(numbers);
      // A covariance so large that no pose fails its test.
      prediction.covariance = (all ? 10 : 1e-4) * Matrix6::Identity();
      if (all) {
        set_.items[t] = add_hardest(limits.markers_per_tool, prediction, numbers);
      } else {
        set_.items[t] = any_tool(numbers, 3 + numbers.below(limits.markers_per_tool - 2));
        add_tool(markers_, set_.items[t], any_view(numbers), numbers.within(0, 0.005), numbers,
                 k_blobs_max);
      }
      Labeling& labeling = assignment_.labeling[t];
      labeling = {};
      labeling.marker.fill(-1);
      labeling.count = markers_.count - first;
      labeling.log_prior_ratio_m2 = all || numbers.one_in(2) ? 1e-5 : 0;
      for (int m = 0; m < labeling.count; ++m) {
        labeling.marker[m] = static_cast<std::int16_t>(first + m);
      }
      assignment_.alternative[t].count = 0;
      if (all || numbers.one_in(2))
        assignment_.alternative[t] = alternative_to(labeling, set_.items[t], numbers);
    }
    add_pixel_axes();
    tools_.set(set_, 1, 0);
    rewind();
  }
  void run() noexcept override {
    node_(verdict_, markers_, tools_, predictions_, assignment_,
          graph::Partition{0, k_tool_partitions}, fitted_);
  }

 private:
  // The smaller the markers' noise, the more steps every fit takes.
  static constexpr MarkerNoise k_smallest_noise = {k_range_sigma_min_m, k_pixel_sigma_min_px, 0};
  static constexpr int k_tries = 200;

  // Pinhole geometry with the declared focal length: residuals need an image.
  void add_pixel_axes() {
    for (int m = 0; m < markers_.count; ++m) {
      Marker& marker = markers_.items[static_cast<std::size_t>(m)];
      marker.along_x = marker.ray.unitOrthogonal() / start_.noise.focal_px;
      marker.along_y = marker.ray.cross(marker.along_x);
    }
  }

  // Returns the most expensive of several tools. Its markers are at positions that fit no pose,
  // with all or without any one of them, so that fits use their maximum number of steps.
  Tool add_hardest(int count, const Prediction& prediction, Numbers& numbers) {
    const int first = markers_.count;
    const int most =
        refine_work_max(count, k_predicted).marker_steps + k_predicted.steps_max * count;
    Tool hardest;
    std::array<Marker, k_markers_per_tool_max> seen;
    for (int reached = -1, tried = 0; reached < most && tried < k_tries; ++tried) {
      const Tool tool = any_tool(numbers, count);
      const Pose view = any_view(numbers);
      markers_.count = first;
      for (int m = 0; m < count; ++m) {
        const bool astray = m < 2 || count < 5;
        const Vector3 off = astray ? numbers.in_box(0.3) : Vector3(Vector3::Zero());
        add_marker(markers_, view * tool.markers_m[m] + off, tool, k_blobs_max);
        markers_.items[first + m].flags |= k_marker_not_isolated;
      }
      const int steps = marker_steps_of(tool, &markers_.items[first], start_.noise, prediction);
      if (steps <= reached) continue;
      reached = steps;
      hardest = tool;
      std::copy_n(&markers_.items[first], count, seen.begin());
    }
    std::copy_n(seen.begin(), count, &markers_.items[first]);
    return hardest;
  }

  // Permutes the markers' labels; returns the permutation whose fits take the most steps.
  Labeling alternative_to(const Labeling& labeling, const Tool& tool, Numbers& numbers) {
    constexpr RefineSettings k_all_markers = {.rejected_max = 0};
    const int most = refine_work_max(labeling.count, k_all_markers).marker_steps;
    Labeling hardest = labeling, tried = labeling;
    for (int reached = -1, tries = 0; reached < most && tries < k_tries; ++tries) {
      for (int m = labeling.count - 1; m > 0; --m)
        std::swap(tried.marker[m], tried.marker[numbers.below(m + 1)]);
      std::array<WeightedMarker, k_markers_per_tool_max> seen;
      for (int m = 0; m < labeling.count; ++m)
        seen[m] = weighed(tool, m, markers_.items[tried.marker[m]], start_.noise);
      const std::size_t count = static_cast<std::size_t>(labeling.count);
      const int steps =
          refine_pose({seen.data(), count}, tool.tip_m, nullptr, k_all_markers).work.marker_steps;
      if (steps <= reached) continue;
      reached = steps;
      hardest = tried;
    }
    return hardest;
  }

  FrameVerdict verdict_ = accepted_verdict(1);
  Markers markers_;
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  Predictions predictions_;
  Assignment assignment_;
  FittedTools fitted_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> assign_markers_kernel() { return std::make_unique<AssignKernel>(); }
std::unique_ptr<MeasuredKernel> refine_pose_kernel() { return std::make_unique<RefineKernel>(); }

}  // namespace glint::inputs
