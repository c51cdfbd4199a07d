// Labelings to share out, and labelled markers to fit.
#include "nodes/pose_nodes.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"
#include "platform/budget/inputs/views.hpp"

namespace glint::inputs {
namespace {

bool at_its_worst(InputKind kind) {
  return kind == InputKind::worst || kind == InputKind::searched;
}

class AssignKernel final : public NodeKernel<AssignMarkers> {
 public:
  AssignKernel() : NodeKernel("AssignMarkers") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    start_.limits = limits;
    set_.count = at_its_worst(kind) ? limits.tools : 1 + numbers.below(limits.tools);
    tools_.set(set_, 1, 0);
    for (int t = 0; t < set_.count; ++t) {
      Labelings& labelings = labelings_[t % k_tool_slices].tools[t];
      labelings = {};
      const bool contested = at_its_worst(kind) && number % 4 != 3;
      labelings.count = contested ? k_labelings_max : numbers.below(k_labelings_max + 1);
      for (int k = 0; k < labelings.count; ++k) {
        Labeling& labeling = labelings.items[k];
        labeling.marker.fill(-1);
        labeling.count = 3 + numbers.below(limits.markers_per_tool - 2);
        labeling.rms_m = numbers.within(0, 0.004);
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
  // All want marker 0; once it is given away, each finds its last labeling free. Which markers
  // those have, and which tool is served first, differ from input to input.
  static void contest(int t, int k, Numbers& numbers, Labeling& labeling) {
    labeling.count = 3;
    labeling.rms_m = numbers.within(0, 0.004);
    labeling.marker[0] = static_cast<std::int16_t>(k + 1 < k_labelings_max ? 0 : 1 + t);
  }
  FrameVerdict verdict_ = admitted(1);
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  graph::Parts<ToolLabelings, k_tool_slices> labelings_;
  Assignment assignment_;
};

class FitKernel final : public NodeKernel<FitRigid> {
 public:
  FitKernel() : NodeKernel("FitRigid") { start_.noise.focal_px = 253; }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    start_.limits = limits;
    const bool all = at_its_worst(kind);
    set_.count = all ? limits.tools : 1 + numbers.below(limits.tools);
    markers_.count = 0;
    for (int t = 0; t < set_.count; ++t) {
      set_.items[t] = any_tool(
          numbers, all ? limits.markers_per_tool : 3 + numbers.below(limits.markers_per_tool - 2));
      assignment_.reason[t] = all || !numbers.one_in(5) ? Reason::none : Reason::taken_by_other;
      Labeling& labeling = assignment_.labeling[t];
      labeling = {};
      labeling.marker.fill(-1);
      const int first = markers_.count;
      add_tool(markers_, set_.items[t], any_view(numbers), numbers.within(0, 0.005), numbers,
               k_blobs_max);
      labeling.count = markers_.count - first;
      for (int m = 0; m < labeling.count; ++m) {
        labeling.marker[m] = static_cast<std::int16_t>(first + m);
      }
    }
    tools_.set(set_, 1, 0);
    rewind();
  }
  void run() noexcept override {
    node_(verdict_, markers_, tools_, assignment_, graph::Slice{0, k_tool_slices}, fitted_);
  }

 private:
  FrameVerdict verdict_ = admitted(1);
  Markers markers_;
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  Assignment assignment_;
  FittedTools fitted_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> assign_markers_kernel() { return std::make_unique<AssignKernel>(); }
std::unique_ptr<MeasuredKernel> fit_rigid_kernel() { return std::make_unique<FitKernel>(); }

}  // namespace glint::inputs
