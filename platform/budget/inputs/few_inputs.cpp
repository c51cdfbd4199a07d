// Measurement inputs of NameFew: predicted tools without a labeling, with markers inside and
// outside their gates.
#include "nodes/name_few.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/pose_kernels.hpp"
#include "platform/budget/inputs/views.hpp"

namespace glint::inputs {
namespace {

class NameFewKernel final : public NodeKernel<NameFew> {
 public:
  NameFewKernel() : NodeKernel("NameFew") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    Numbers numbers(kind, number);
    const bool all = kind == InputKind::worst || kind == InputKind::searched;
    start_.limits = limits;
    start_.noise.focal_px = 250;
    set_.count = all ? limits.tools : 1 + numbers.below(limits.tools);
    markers_.count = 0;
    for (int t = 0; t < set_.count; ++t) {
      const int markers =
          all ? limits.markers_per_tool : 3 + numbers.below(limits.markers_per_tool - 2);
      set_.items[t] = any_tool(numbers, markers);
      Prediction& prediction = predictions_.tools[t];
      prediction = {};
      prediction.has_prior = prediction.follows_motion = all || !numbers.one_in(4);
      prediction.T_camera_tool = any_view(numbers);
      prediction.covariance.diagonal() << Vector3::Constant(4e-6), Vector3::Constant(1e-4);
      assignment_.reason[t] = all || !numbers.one_in(4) ? Reason::too_few_markers : Reason::none;
      assignment_.labeling[t].marker.fill(-1);
      if (markers_.count + markers <= limits.blobs)
        add_tool(markers_, set_.items[t], prediction.T_camera_tool, 0.001, numbers, limits.blobs);
    }
    const int strays = all ? limits.blobs - markers_.count : numbers.below(20);
    for (int s = 0; s < strays; ++s) {
      add_marker(markers_, Vector3(0, 0, 0.6) + numbers.in_box(0.5), set_.items[0], limits.blobs);
    }
    tools_.set(set_, 1, 0);
    rewind();
  }
  void run() noexcept override {
    node_(verdict_, markers_, tools_, predictions_, assignment_, seen_);
  }

 private:
  FrameVerdict verdict_ = accepted_verdict(1);
  Markers markers_;
  ToolSet set_;
  graph::Latest<ToolSet> tools_;
  Predictions predictions_;
  Assignment assignment_;
  SeenFew seen_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> name_few_kernel() { return std::make_unique<NameFewKernel>(); }

}  // namespace glint::inputs
