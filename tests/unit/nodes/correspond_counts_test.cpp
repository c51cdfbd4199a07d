// Inputs and loop counts that the correspondence nodes pass to and read from their kernels.
#include <gtest/gtest.h>

#include <memory>

#include "nodes/pose_nodes.hpp"
#include "nodes/predict_tracks.hpp"

namespace glint::correspond_counts_test {
namespace {

// Five tools of five markers. `show` makes a tool visible.
class CorrespondCounts : public testing::Test {
 protected:
  CorrespondCounts() {
    set_->count = 5;
    for (std::size_t t = 0; t < 5; ++t) {
      const double larger = 1 + 0.15 * static_cast<double>(t);
      Tool& tool = set_->items[t];
      tool.marker_count = 5;
      tool.markers_m = {Vector3(-0.05, 0, 0) * larger, Vector3(0.05, 0, 0) * larger,
                        Vector3(0, 0.06, 0) * larger, Vector3(0.02, 0.025, 0.04) * larger,
                        Vector3(-0.03, 0.01, 0.07) * larger};
      tool.marker_radius_m = 0.005;
      EXPECT_EQ(prepare_tool(tool), Reason::none);
    }
    node_->limits.tools = 5;
  }
  [[nodiscard]] static Pose place_of(std::size_t tool) {
    return {Quaternion::Identity(), Vector3(-0.4 + 0.2 * static_cast<double>(tool), 0, 0.7)};
  }
  void show(std::size_t tool) {
    for (std::size_t i = 0; i < 5; ++i) {
      const Vector3 seen = place_of(tool) * set_->items[tool].markers_m[i];
      Marker& marker = markers_->items[static_cast<std::size_t>(markers_->count++)];
      marker.ray = seen.normalized();
      marker.surface_range_m = seen.norm() - set_->items[tool].centre_offset_m();
    }
  }
  graph::LoopCounts run(graph::Partition partition) {
    tools_.set(*set_, ++version_, 0);
    (*node_)(verdict_, *markers_, tools_, *predictions_, partition, *labelings_);
    return node_->counts();
  }
  // Calls the kernel directly, with the settings that the prediction implies.
  CorrespondWork run_kernel(std::size_t tool, Labelings& out) {
    const Prediction& prediction = predictions_->tools[tool];
    CorrespondSettings gated = node_->settings;
    gated.markers_max = node_->limits.blobs;
    gated.search_steps_max = node_->limits.search_steps;
    gated.prior_gate_m = node_->settings.prior_gate_m + prediction.reach_m;
    gated.prior_sigma_m = prediction.reach_m / k_reach_sigmas;
    gated.only_near = prediction.within_reach_only;
    gated.partial_gate_m = prediction.reach_m + 3 * node_->settings.range_sigma_m;
    const Pose* prior = prediction.has_prior ? &prediction.T_camera_tool : nullptr;
    return propose_labelings(*markers_, set_->items[tool], gated, prior, *scratch_, out);
  }

  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  graph::Latest<ToolSet> tools_;
  std::uint64_t version_ = 0;
  FrameVerdict verdict_;
  std::unique_ptr<Markers> markers_ = std::make_unique<Markers>();
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
  std::unique_ptr<ToolLabelings> labelings_ = std::make_unique<ToolLabelings>();
  std::unique_ptr<CorrespondScratch> scratch_ = std::make_unique<CorrespondScratch>();
  std::unique_ptr<glint::Correspond> node_ = std::make_unique<glint::Correspond>();
};

// With a prediction that is offset from the ground truth, and without one.
TEST_F(CorrespondCounts, AreTheKernelsOwnAndSoAreTheLabelings) {
  show(1);
  show(2);
  for (const double reach_m : {-1.0, 0.0, 0.012, 0.04}) {
    Prediction& prediction = predictions_->tools[2];
    prediction.has_prior = reach_m >= 0;
    prediction.reach_m = std::max(reach_m, 0.0);
    prediction.T_camera_tool = place_of(2);
    prediction.T_camera_tool.translation.x() += 0.004;
    for (const bool only_near : {false, true}) {
      prediction.within_reach_only = only_near;
      auto expected = std::make_unique<Labelings>();
      const CorrespondWork work = run_kernel(2, *expected);
      const graph::LoopCounts counts = run({2, 4});
      EXPECT_EQ(counts, (graph::LoopCounts{{1, 1, work.markers, work.pairs.pairs, work.pairs.tests,
                                            work.pairs.words_written, work.search.steps,
                                            work.search.words_narrowed}}));
      EXPECT_GT(counts[7], 0);
      const Labelings& found = labelings_->tools[2];
      EXPECT_EQ(found.reason, Reason::none) << reach_m;
      ASSERT_EQ(found.count, expected->count);
      for (int i = 0; i < found.count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        EXPECT_EQ(found.items[at].marker, expected->items[at].marker);
        EXPECT_EQ(found.items[at].rms_m, expected->items[at].rms_m);
        EXPECT_EQ(found.items[at].log_prior_ratio_m2, expected->items[at].log_prior_ratio_m2);
      }
    }
  }
}

TEST_F(CorrespondCounts, AddUpOverTheToolsOfASlice) {
  show(1);
  show(3);
  graph::LoopCounts sum = {{1}};
  for (int t = 0; t < 5; ++t) {
    const graph::LoopCounts one = run({t, 5});
    EXPECT_EQ(one[0], 1);
    EXPECT_EQ(one[1], 1);
    for (std::size_t loop = 1; loop < glint::Correspond::k_loops.size(); ++loop)
      sum[loop] += one[loop];
  }
  EXPECT_EQ(run({0, 1}), sum);
  EXPECT_EQ(run({5, 6}), (graph::LoopCounts{{1}})) << "no tool";
  const graph::LoopCounts second = run({1, 2});
  EXPECT_EQ(second[1], 2) << "tools 1 and 3";
}

// One tool needs more than its share of the search steps. The steps that another tool leaves unused
// suffice in the first case, not in the second.
TEST_F(CorrespondCounts, OfStepsAreWhatTheToolsOfASliceMayShare) {
  show(1);
  const auto needed = static_cast<int>(run({1, 5})[6]);
  const auto idle = static_cast<int>(run({0, 5})[6]);
  ASSERT_GT(needed, 2 * idle + 4);
  node_->limits.search_steps = (needed + idle + 1) / 2;
  (void)run({1, 5});
  EXPECT_EQ(labelings_->tools[1].reason, Reason::search_full) << "alone";
  EXPECT_LE(node_->counts()[6], node_->limits.search_steps);
  (void)run({0, 1});
  EXPECT_EQ(labelings_->tools[1].reason, Reason::none) << "after a tool that is not in view";
  node_->limits.search_steps = (needed + idle) / 2 - 1;
  (void)run({0, 1});
  EXPECT_EQ(labelings_->tools[1].reason, Reason::search_full);
}

TEST_F(CorrespondCounts, OfATooLargeToolOrARefusedFrameAreNone) {
  show(1);
  ASSERT_GT(run({1, 5})[6], 0);
  ASSERT_GT(labelings_->tools[1].count, 0);
  node_->limits.markers_per_tool = 4;
  EXPECT_EQ(run({1, 5}), (graph::LoopCounts{{1}}));
  EXPECT_EQ(labelings_->tools[1].reason, Reason::out_of_range);
  EXPECT_EQ(labelings_->tools[1].count, 0) << "those of the frame before are gone";
  node_->limits.markers_per_tool = 5;
  ASSERT_GT(run({1, 5})[6], 0);
  verdict_.reason = Reason::frame_duplicate;
  EXPECT_EQ(run({1, 5}), (graph::LoopCounts{{1}}));
  EXPECT_EQ(labelings_->tools[1].reason, Reason::frame_duplicate);
  EXPECT_EQ(labelings_->tools[1].count, 0);
}

TEST_F(CorrespondCounts, OfNoToolBeyondTheCellsAreCounted) {
  node_->limits.tools = 3;
  EXPECT_EQ(run({0, 1})[1], 3);
  set_->count = 2;
  EXPECT_EQ(run({0, 1})[1], 2);
}

Labeling labeling_of(std::int16_t first, double rms_m, double turn) {
  Labeling out;
  out.marker.fill(-1);
  for (std::int16_t i = 0; i < 3; ++i) {
    out.marker[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(first + i);
  }
  out.count = 3;
  out.rms_m = rms_m;
  out.T_camera_tool.rotation = Quaternion(1, turn, 0, 0).normalized();
  return out;
}

class Assigned : public testing::Test {
 protected:
  Assigned() {
    set_->count = 3;
    node_->limits.tools = 3;
  }
  void run() {
    graph::Latest<ToolSet> tools;
    tools.set(*set_, 1, 0);
    (*node_)(verdict_, tools, *labelings_, *assignment_);
  }
  Labelings& of(int tool) {
    return (*labelings_)[tool % k_tool_partitions].tools[static_cast<std::size_t>(tool)];
  }
  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  std::unique_ptr<graph::Parts<ToolLabelings, k_tool_partitions>> labelings_ =
      std::make_unique<graph::Parts<ToolLabelings, k_tool_partitions>>();
  FrameVerdict verdict_;
  std::unique_ptr<Assignment> assignment_ = std::make_unique<Assignment>();
  std::unique_ptr<glint::AssignMarkers> node_ = std::make_unique<glint::AssignMarkers>();
};

// Tools compete for marker 0; the better fit wins it. Rounds: one for each tool that gets a
// labeling, and one that finds none. Tests, counted by hand: both tools in the first round, the
// loser again in the second. Alternative labelings need no test here.
TEST_F(Assigned, MarkersGoToOneToolAndTheOthersAreToldWhy) {
  of(0).items[0] = labeling_of(0, 0.002, 0);
  of(0).count = 1;
  of(1).items[0] = labeling_of(0, 0.001, 0);
  of(1).count = 1;
  of(2).reason = Reason::too_few_markers;
  run();
  EXPECT_EQ(assignment_->reason[0], Reason::markers_assigned_elsewhere);
  EXPECT_EQ(assignment_->reason[1], Reason::none);
  EXPECT_EQ(assignment_->reason[2], Reason::too_few_markers);
  EXPECT_EQ(assignment_->labeling[1].marker, of(1).items[0].marker);
  EXPECT_EQ(assignment_->labeling[1].rms_m, 0.001);
  std::array<Labelings, 3> per_tool = {of(0), of(1), of(2)};
  std::array<int, 3> chosen{};
  std::array<Reason, 3> reasons{};
  const AssignWork work = assign_markers(per_tool, chosen, reasons);
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1, 3, work.rounds, work.tests}}));
}

// An alternative labeling counts as a test. Those of earlier frames are cleared.
TEST_F(Assigned, RivalsAreOfThisFrame) {
  of(1).items[0] = labeling_of(0, 0.001, 0);
  of(1).items[1] = labeling_of(0, 0.002, 1);
  std::swap(of(1).items[1].marker[0], of(1).items[1].marker[1]);
  of(1).count = 2;
  run();
  EXPECT_EQ(assignment_->alternative[1].count, 3);
  EXPECT_EQ(assignment_->alternative[1].marker, of(1).items[1].marker);
  const std::int64_t with_rival = node_->counts()[3];
  of(1).count = 1;
  run();
  EXPECT_EQ(assignment_->alternative[1].count, 0);
  EXPECT_EQ(node_->counts()[3], with_rival - 1);
  of(1).count = 2;
  run();
  ASSERT_EQ(assignment_->alternative[1].count, 3);
  of(1).count = 0;
  of(1).reason = Reason::no_labeling;
  run();
  EXPECT_EQ(assignment_->alternative[1].count, 0) << "a tool without a labeling has no rival";
}

// The alternative's first marker is number 0 of the frame, which another tool's labeling holds.
TEST_F(Assigned, RivalsTakeNoMarkerOfAnotherTool) {
  of(0).items[0] = labeling_of(0, 0.001, 0);
  of(0).count = 1;
  of(1).items[0] = labeling_of(3, 0.001, 0);
  of(1).items[1] = labeling_of(3, 0.002, 1);
  of(1).items[1].marker[0] = 0;
  of(1).count = 2;
  run();
  EXPECT_EQ(assignment_->alternative[1].count, 0);
  of(0).count = 0;
  of(0).reason = Reason::no_labeling;
  run();
  EXPECT_EQ(assignment_->alternative[1].count, 3) << "and in the next frame no tool holds it";
}

TEST_F(Assigned, NothingOfARefusedFrameIs) {
  of(0).items[0] = labeling_of(0, 0.001, 0);
  of(0).count = 1;
  verdict_.reason = Reason::frame_late;
  run();
  for (const Reason reason : assignment_->reason) EXPECT_EQ(reason, Reason::frame_late);
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1}}));
  verdict_ = {};
  node_->limits.tools = 0;
  run();
  EXPECT_EQ(node_->counts()[1], 0);
}

}  // namespace
}  // namespace glint::correspond_counts_test
