// Node NameFew (partial visibility): the tools that it searches for, and the candidate markers.
#include "nodes/name_few.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace glint::name_few_test {
namespace {

// Two tools of three markers side by side, predicted at their true poses. The first has no labeling
// and two visible markers: markers 1 and 2 of the frame are its markers 0 and 2.
class NameFewTest : public testing::Test {
 protected:
  NameFewTest() {
    set_->count = 2;
    for (std::size_t t = 0; t < 2; ++t) {
      Tool& tool = set_->items[t];
      tool.marker_count = 3;
      tool.markers_m = {Vector3(-0.05, 0, 0), Vector3(0.05, 0, 0), Vector3(0, 0.06, 0)};
      tool.marker_radius_m = 0.005;
      EXPECT_EQ(prepare_tool(tool), Reason::none);
      Prediction& prediction = predictions_->tools[t];
      prediction.follows_motion = true;
      prediction.T_camera_tool.translation = {t == 0 ? -0.2 : 0.2, 0, 0.5};
      prediction.covariance.diagonal() << Vector3::Constant(1e-6), Vector3::Constant(1e-6);
    }
    assignment_->reason.fill(Reason::no_labeling);
    assignment_->reason[1] = Reason::none;
    for (Labeling& labeling : assignment_->labeling) labeling.marker.fill(-1);
    for (Labeling& labeling : assignment_->alternative) labeling.marker.fill(-1);
    markers_->count = 3;
    show(0, Vector3(0, 0.3, 0.5));  // false marker
    show(1, place_of(0, 0));
    show(2, place_of(0, 2));
  }
  [[nodiscard]] Vector3 place_of(std::size_t tool, std::size_t marker) const {
    return predictions_->tools[tool].T_camera_tool * set_->items[tool].markers_m[marker];
  }
  void show(std::size_t marker, const Vector3& centre) {
    markers_->items[marker].ray = centre.normalized();
    markers_->items[marker].surface_range_m = centre.norm() - set_->items[0].centre_offset_m();
  }
  // Number of the first tool's markers that the node assigns.
  int assigned_count() {
    tools_.set(*set_, ++version_, 0);
    node_->operator()(verdict_, *markers_, tools_, *predictions_, *assignment_, seen_);
    EXPECT_EQ(seen_.tools[1].count, 0) << "it has a labeling, or is not predicted";
    return seen_.tools[0].count;
  }

  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  graph::Latest<ToolSet> tools_;
  std::uint64_t version_ = 0;
  std::unique_ptr<Markers> markers_ = std::make_unique<Markers>();
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
  std::unique_ptr<Assignment> assignment_ = std::make_unique<Assignment>();
  FrameVerdict verdict_;
  SeenFew seen_;
  std::unique_ptr<glint::NameFew> node_ = std::make_unique<glint::NameFew>();
};

TEST_F(NameFewTest, NamesTheMarkersOfAToolWithoutALabeling) {
  ASSERT_EQ(assigned_count(), 2);
  const PartialMarkers& few = seen_.tools[0];
  EXPECT_EQ(few.items[0].of_tool, 0);
  EXPECT_EQ(few.items[1].of_tool, 2);
  EXPECT_LT((few.items[0].centre_m - place_of(0, 0)).norm(), 1e-12);
  EXPECT_LT((few.items[1].centre_m - place_of(0, 2)).norm(), 1e-12);
  // For two predicted tools each gate tests each marker; a marker's range counts once a tool.
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1, 2, 6, 2 * (1 + 3) * 3}}));
}

TEST_F(NameFewTest, LooksForNothingWhereEveryForetoldToolHasALabeling) {
  ASSERT_EQ(assigned_count(), 2);
  assignment_->reason[0] = Reason::none;
  EXPECT_EQ(assigned_count(), 0) << "what the frame before named is gone";
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1}}));
  assignment_->reason[0] = Reason::no_labeling;
  predictions_->tools[0].follows_motion = false;
  EXPECT_EQ(assigned_count(), 0);
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1}}));
}

TEST_F(NameFewTest, LooksForNothingInARefusedFrame) {
  ASSERT_EQ(assigned_count(), 2);
  verdict_.reason = Reason::frame_late;
  EXPECT_EQ(assigned_count(), 0);
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1}}));
}

TEST_F(NameFewTest, LooksForNoToolOfMoreMarkersThanTheCellHas) {
  node_->limits.markers_per_tool = 3;
  EXPECT_EQ(assigned_count(), 2);
  node_->limits.markers_per_tool = 2;
  EXPECT_EQ(assigned_count(), 0);
}

TEST_F(NameFewTest, LooksForNoMoreToolsThanTheCellHas) {
  node_->limits.tools = 1;
  EXPECT_EQ(assigned_count(), 2);
  EXPECT_EQ(node_->counts(), (graph::LoopCounts{{1, 1, 3, (1 + 3) * 3}}));
}

TEST_F(NameFewTest, LooksAtNoMoreMarkersThanTheCellHas) {
  node_->limits.blobs = 2;
  EXPECT_EQ(assigned_count(), 1) << "the third is not looked at";
}

// Both the other tool's labeling and its alternative keep their markers: either may be chosen.
TEST_F(NameFewTest, TakesNoMarkerThatAnotherToolsLabelingHolds) {
  for (const bool use_alternative : {false, true}) {
    for (const int lowest : {1, 0}) {
      Labeling& labeling = use_alternative ? assignment_->alternative[1] : assignment_->labeling[1];
      if (lowest == 0) show(0, place_of(0, 1));  // marker 0 of the frame is one of the tool's, too
      if (lowest == 0) show(1, Vector3(0, 0.3, 0.5));
      labeling.marker[4] = static_cast<std::int16_t>(lowest);
      labeling.count = 3;
      EXPECT_EQ(assigned_count(), 1) << use_alternative << lowest;
      EXPECT_EQ(seen_.tools[0].items[0].of_tool, 2);
      labeling.count = 0;
      EXPECT_EQ(assigned_count(), 2) << "an old frame's";
      labeling.marker[4] = -1;
      show(0, Vector3(0, 0.3, 0.5));
      show(1, place_of(0, 0));
    }
  }
}

TEST_F(NameFewTest, TakesMarkersOfALabelingThatDoesNotHold) {
  assignment_->labeling[0].marker[0] = 1;
  assignment_->labeling[0].count = 3;
  EXPECT_EQ(assigned_count(), 2) << "its own, which was refused";
}

// The gate accepts an offset marker only if the estimated noise is large enough.
TEST_F(NameFewTest, OpensItsGatesByTheNoiseThatWasSeen) {
  show(1, place_of(0, 0) + Vector3(0, 0, 0.02));
  EXPECT_EQ(assigned_count(), 1);
  predictions_->noise.has_residuals = true;
  predictions_->noise.range_sigma_m = 0.008;
  predictions_->noise.pixel_sigma_px = 0.1;
  EXPECT_EQ(assigned_count(), 2);
}

}  // namespace
}  // namespace glint::name_few_test
