#include "nodes/pose_nodes.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace glint {
namespace {

// One tool of three markers; none is visible.
class Correspond : public testing::Test {
 protected:
  Correspond() {
    set_->count = 1;
    Tool& tool = set_->items[0];
    tool.marker_count = 3;
    tool.markers_m = {Vector3(-0.05, 0, 0), Vector3(0.05, 0, 0), Vector3(0, 0.06, 0)};
    tool.marker_radius_m = 0.005;
    EXPECT_EQ(prepare_tool(tool), Reason::none);
    tools_.set(*set_, 1, 0);
  }
  Reason reason(Reason incomplete) {
    markers_->incomplete = incomplete;
    (*node_)(FrameVerdict{}, *markers_, tools_, *predictions_, {0, 1}, *labelings_);
    return labelings_->tools[0].reason;
  }

  // The tool's markers at 0.5 m, scaled by `factor`.
  void show_scaled_by(double factor) {
    const Tool& tool = set_->items[0];
    for (std::size_t i = 0; i < 3; ++i) {
      const Vector3 seen = tool.markers_m[i] * factor + Vector3(0, 0, 0.5);
      markers_->items[i].ray = seen.normalized();
      markers_->items[i].surface_range_m = seen.norm() - tool.centre_offset_m();
    }
    markers_->count = 3;
  }

  // Largest relative scale error of the markers that is still accepted, by bisection. The noise is
  // given in multiples of the declared noise.
  double largest_scale(double range_noises, double pixel_noises) {
    predictions_->noise.has_residuals = true;
    predictions_->noise.range_sigma_m = range_noises * node_->settings.range_sigma_m;
    predictions_->noise.pixel_sigma_px = pixel_noises * node_->settings.pixel_sigma_px;
    double fits = 1, fails = 1.5;
    for (int i = 0; i < 20; ++i) {
      const double between = 0.5 * (fits + fails);
      show_scaled_by(between);
      (reason(Reason::none) == Reason::none ? fits : fails) = between;
    }
    return fits - 1;
  }

  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  graph::Latest<ToolSet> tools_;
  std::unique_ptr<Markers> markers_ = std::make_unique<Markers>();
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
  std::unique_ptr<ToolLabelings> labelings_ = std::make_unique<ToolLabelings>();
  std::unique_ptr<glint::Correspond> node_ = std::make_unique<glint::Correspond>();
};

TEST_F(Correspond, NamesTheBudgetWhereItLeftOutSpotsOfAToolThatWasNotFound) {
  EXPECT_EQ(reason(Reason::none), Reason::too_few_markers);
  EXPECT_EQ(reason(Reason::blobs_full), Reason::blobs_full);
  EXPECT_EQ(reason(Reason::runs_full), Reason::runs_full);
  predictions_->search_part_of_frame = true;
  EXPECT_EQ(reason(Reason::none), Reason::runs_full) << "a part of the frame was searched";
}

// The search keeps blobs near a prediction under any budget, but not runs.
TEST_F(Correspond, BlamesABlobBudgetForNoToolThatWasPredicted) {
  predictions_->tools[0].has_prior = true;
  EXPECT_EQ(reason(Reason::blobs_full), Reason::too_few_markers);
  EXPECT_EQ(reason(Reason::runs_full), Reason::runs_full);
}

// The error of the markers' distances exceeds the declared noise.
TEST_F(Correspond, OpensItsGatesWithTheNoiseThatWasSeenAndNeverClosesThem) {
  show_scaled_by(1.2);
  EXPECT_NE(reason(Reason::none), Reason::none);
  predictions_->noise.has_residuals = true;
  predictions_->noise.range_sigma_m = 0.01;
  predictions_->noise.pixel_sigma_px = 0.1;
  EXPECT_EQ(reason(Reason::none), Reason::none);
  show_scaled_by(1.02);
  for (const double sigma_m : {0.01, 0.0001}) {
    predictions_->noise.range_sigma_m = sigma_m;
    EXPECT_EQ(reason(Reason::none), Reason::none) << sigma_m;
  }
}

TEST_F(Correspond, OpensItsGatesAlsoByLittleMoreNoise) {
  const double as_declared = largest_scale(1, 1);
  EXPECT_GT(as_declared, 0.01);
  EXPECT_EQ(largest_scale(0.5, 1), as_declared);
  EXPECT_GT(largest_scale(1.2, 1), 1.1 * as_declared);
  EXPECT_GT(largest_scale(1.8, 1), 1.5 * as_declared);
}

// Across the ray, pixel noise opens the gate as range noise does along it.
TEST_F(Correspond, OpensItsGatesWithThePixelsNoiseToo) {
  node_->settings.focal_px = 250;
  node_->settings.pixel_sigma_px = 0.1;
  node_->settings.max_rms_m = 1;
  const double as_declared = largest_scale(1, 1);
  EXPECT_EQ(largest_scale(1, 0.1), as_declared);
  EXPECT_GT(largest_scale(1, 40), 1.1 * as_declared);
}

// Three markers are accepted only within the prediction's reach plus three standard deviations of
// their ranges.
TEST_F(Correspond, BelievesFewMarkersOnlyNearAPrediction) {
  Tool& tool = set_->items[0];
  tool.marker_count = 4;
  tool.markers_m[3] = Vector3(0.03, 0.02, 0.04);
  ASSERT_EQ(prepare_tool(tool), Reason::none);
  tools_.set(*set_, 2, 0);
  Prediction& prediction = predictions_->tools[0];
  prediction.has_prior = true;
  prediction.reach_m = 0.008;
  const double gate_m = prediction.reach_m + 3 * node_->settings.range_sigma_m;
  ASSERT_LT(1.1 * gate_m, node_->settings.prior_gate_m);
  show_scaled_by(1);
  for (const double share : {0.9, 1.1}) {
    prediction.T_camera_tool = {Quaternion::Identity(), Vector3(share * gate_m, 0, 0.5)};
    EXPECT_EQ(reason(Reason::none) == Reason::none, share < 1) << share;
  }
}

// RefinePose may choose any labeling: a false marker in two of them would be assigned twice.
TEST(AssignMarkers, GivesNoMarkerToTheLabelingsOfTwoTools) {
  const auto labeling = [](std::int16_t a, std::int16_t b, std::int16_t c, double turn) {
    Labeling out;
    out.marker.fill(-1);
    out.marker[0] = a;
    out.marker[1] = b;
    out.marker[2] = c;
    out.count = 3;
    out.rms_m = 0.001 + 0.001 * turn;
    out.T_camera_tool.rotation = Quaternion(1, turn, 0, 0).normalized();
    return out;
  };
  auto set = std::make_unique<ToolSet>();
  set->count = 2;
  graph::Latest<ToolSet> tools;
  tools.set(*set, 1, 0);
  auto labelings = std::make_unique<graph::Parts<ToolLabelings, k_tool_partitions>>();
  for (std::int16_t t = 0; t < 2; ++t) {
    Labelings& own = (*labelings)[t % k_tool_partitions].tools[static_cast<std::size_t>(t)];
    const auto first = static_cast<std::int16_t>(3 * t);
    own.items[0] = labeling(first, static_cast<std::int16_t>(first + 1),
                            static_cast<std::int16_t>(first + 2), 0);
    own.items[1] = labeling(first, static_cast<std::int16_t>(first + 1), 6, 1);  // 6: false marker
    own.count = 2;
  }
  auto node = std::make_unique<AssignMarkers>();
  auto assignment = std::make_unique<Assignment>();
  (*node)(FrameVerdict{}, tools, *labelings, *assignment);
  EXPECT_EQ(assignment->labeling[1].marker[0], 3);
  EXPECT_EQ(assignment->alternative[0].count, 3);
  EXPECT_EQ(assignment->alternative[0].marker[2], 6);
  EXPECT_EQ(assignment->alternative[1].count, 0);
}

}  // namespace
}  // namespace glint
