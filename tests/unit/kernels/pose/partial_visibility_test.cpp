#include "kernels/pose/partial_visibility.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>

#include "kernels/pose/blob_size.hpp"
#include "kernels/pose/lever_arm.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::partial_visibility_test {
namespace {

constexpr double k_sigma_m = 0.001, k_turn_sigma = 0.01;

// One or two tools predicted at 0.5 m; tests add visible markers one by one.
class FewMarkersTest : public testing::Test {
 protected:
  FewMarkersTest() {
    for (int t = 0; t < 2; ++t) {
      Tool& tool = tools_[static_cast<std::size_t>(t)];
      tool.marker_count = 4;
      tool.markers_m[0] = {-0.05, 0, 0};
      tool.markers_m[1] = {0.05, 0, 0.01};
      tool.markers_m[2] = {0, 0.06, 0};
      tool.markers_m[3] = {0.01, -0.04, 0.02};
      tool.marker_radius_m = 0.005;
      EXPECT_EQ(prepare_tool(tool), Reason::none);
      PredictedTool& expected = expected_[static_cast<std::size_t>(t)];
      expected.tool = &tool;
      expected.T_camera_tool.translation = Vector3(0.3 * t, 0, 0.5);
      expected.predicted = expected.needs_labeling = t == 0;
      expect_within(t, k_sigma_m, k_turn_sigma);
    }
    noise_.focal_px = 250;
  }
  void expect_within(int tool, double sigma_m, double turn) {
    Matrix6& covariance = expected_[static_cast<std::size_t>(tool)].covariance;
    covariance.setZero();
    covariance.diagonal() << Vector3::Constant(sigma_m * sigma_m), Vector3::Constant(turn * turn);
  }
  [[nodiscard]] Vector3 place(int tool, int marker) const {
    const auto t = static_cast<std::size_t>(tool);
    return expected_[t].T_camera_tool * tools_[t].markers_m[static_cast<std::size_t>(marker)];
  }
  void show(const Vector3& centre, std::uint8_t flags = 0) {
    Marker& marker = markers_->items[static_cast<std::size_t>(markers_->count++)];
    marker = Marker{};
    marker.ray = centre.normalized();
    marker.surface_range_m = centre.norm() - tools_[0].marker_radius_m;
    marker.flags = flags;
  }
  const PartialMarkers& name() {
    work_ = identify_partial(expected_, *markers_, k_blobs_max, taken_, noise_, *scratch_, named_);
    return named_[0];
  }

  std::array<Tool, 2> tools_;
  std::array<PredictedTool, 2> expected_;
  std::unique_ptr<Markers> markers_ = std::make_unique<Markers>();
  TakenMarkers taken_;
  MarkerNoise noise_;
  std::unique_ptr<PartialScratch> scratch_ = std::make_unique<PartialScratch>();
  std::array<PartialMarkers, 2> named_;
  PartialWork work_;
};

TEST_F(FewMarkersTest, NamesOneAndTwoWhereTheyWerePredicted) {
  show(place(0, 2) + Vector3(0.001, -0.001, 0.002));
  show(Vector3(0.2, 0.2, 0.7));
  const PartialMarkers& one = name();
  ASSERT_EQ(one.count, 1);
  EXPECT_EQ(one.items[0].of_tool, 2);
  EXPECT_LT((one.items[0].centre_m - place(0, 2)).norm(), 0.003);
  show(place(0, 0));
  const PartialMarkers& two = name();
  ASSERT_EQ(two.count, 2);
  EXPECT_EQ(two.items[0].of_tool, 0);
  EXPECT_EQ(two.items[1].of_tool, 2);
}

TEST_F(FewMarkersTest, StatesTheMeasurementsOwnCovarianceAlongAndAcrossTheRay) {
  show(place(0, 2));
  const IdentifiedMarker& named = name().items[0];
  const Vector3 ray = named.centre_m.normalized(), side = ray.unitOrthogonal();
  EXPECT_NEAR(std::sqrt(ray.dot(named.covariance_m2 * ray)), 0.0015, 1e-6);
  EXPECT_NEAR(std::sqrt(side.dot(named.covariance_m2 * side)), 0.1 / 250 * named.centre_m.norm(),
              1e-6);
}

TEST_F(FewMarkersTest, NamesNoneOfThreeForOfThoseAPoseShouldHaveCome) {
  for (int m = 0; m < 3; ++m) show(place(0, m));
  EXPECT_EQ(name().count, 0);
}

TEST_F(FewMarkersTest, NamesNoneWhereTwoLieInOneGate) {
  show(place(0, 2));
  show(place(0, 2) + Vector3(0.002, 0, 0));
  EXPECT_EQ(name().count, 0);
  show(place(0, 0));
  ASSERT_EQ(name().count, 1) << "another gate's marker is still identified";
  EXPECT_EQ(named_[0].items[0].of_tool, 0);
}

TEST_F(FewMarkersTest, NamesNoneThatAnotherToolMayClaimWhetherItIsFoundOrNot) {
  expected_[1].T_camera_tool.translation = place(0, 2) - tools_[1].markers_m[1];
  expected_[1].predicted = true;
  show(place(0, 2));
  for (const bool wanted : {false, true}) {
    expected_[1].needs_labeling = wanted;
    EXPECT_EQ(name().count, 0);
    EXPECT_EQ(named_[1].count, 0);
  }
  expected_[1].T_camera_tool.translation.x() += 0.02;
  EXPECT_EQ(name().count, 1);
}

TEST_F(FewMarkersTest, NamesNoneThatALabelingHas) {
  show(place(0, 2));
  taken_[0] = true;
  EXPECT_EQ(name().count, 0);
}

TEST_F(FewMarkersTest, NamesNoneWhereTheToolsOwnGatesMeet) {
  show(place(0, 2));
  expect_within(0, 0.003, k_turn_sigma);
  EXPECT_EQ(name().count, 1);
  expect_within(0, 0.012, k_turn_sigma);
  EXPECT_EQ(name().count, 0);
}

TEST_F(FewMarkersTest, NamesNoneBeyondItsGateOrHalfHidden) {
  show(place(0, 2) + Vector3(0.012, 0, 0));
  EXPECT_EQ(name().count, 0);
  show(place(0, 0), k_marker_not_isolated);
  EXPECT_EQ(name().count, 0);
  show(place(0, 1), k_marker_touches_edge);
  EXPECT_EQ(name().count, 0);
}

TEST_F(FewMarkersTest, RefusesTwoThatAreNotAsFarApartAsTheyShouldBe) {
  show(place(0, 0));
  show(place(0, 1) + Vector3(0.0035, 0, 0));
  EXPECT_EQ(name().count, 0);
  markers_->count = 1;
  show(place(0, 1) + Vector3(0, 0.0035, 0));
  EXPECT_EQ(name().count, 2) << "beside it, where the tool may have turned";
}

TEST_F(FewMarkersTest, LosesOneInTenThousandOfThoseThatTheCovarianceTells) {
  test::Random random(7);
  int named = 0;
  constexpr int k_draws = 20000;
  for (int i = 0; i < k_draws; ++i) {
    markers_->count = 0;
    const Vector3 shift = random.vector(k_sigma_m);
    const Quaternion turn = from_rotation_vector(random.vector(k_turn_sigma));
    const Pose& predicted = expected_[0].T_camera_tool;
    const Vector3 lever = predicted.rotation * (tools_[0].markers_m[2] - tools_[0].middle_m());
    const Vector3 centre = predicted * tools_[0].middle_m() + shift + turn * lever;
    const Vector3 ray = centre.normalized();
    const double across = 0.1 / 250 * centre.norm();
    const Vector3 side = random.vector(across);
    show(centre + side - ray * ray.dot(side) + ray * 0.0015 * random.normal());
    named += name().count;
  }
  EXPECT_GE(named, k_draws - 12);
  EXPECT_LT(named, k_draws) << "a gate that loses none is too wide";
}

TEST_F(FewMarkersTest, TestsEachMarkerAgainstEachGateOfAPredictedTool) {
  for (int m = 0; m < 10; ++m) show(Vector3(0.1 * m, 0, 1));
  (void)name();
  EXPECT_EQ(work_.gates, 4);
  EXPECT_EQ(work_.tests, 50) << "and its range once";
}

TEST_F(FewMarkersTest, CountsTheGatesOfPredictedToolsAndTheMarkersLookedAt) {
  for (int m = 0; m < 10; ++m) show(Vector3(0.1 * m, 0, 1));
  expected_[1].predicted = true;
  (void)name();
  EXPECT_EQ(work_.gates, 8) << "also of a tool that is not wanted";
  EXPECT_EQ(work_.tests, 100);
  const auto work_of = [&](std::span<const PredictedTool> tools, int markers_max,
                           std::span<PartialMarkers> named) {
    return identify_partial(tools, *markers_, markers_max, taken_, noise_, *scratch_, named);
  };
  EXPECT_EQ(work_of(expected_, 3, named_).tests, 2 * 3 * 5);
  EXPECT_EQ(work_of(expected_, 0, named_).tests, 0);
  EXPECT_EQ(work_of(expected_, 0, named_).gates, 8);
  EXPECT_EQ(work_of(expected_, 10, std::span(named_).first(1)).gates, 4);
  EXPECT_EQ(work_of(std::span(expected_).first(1), 10, named_).gates, 4);
  EXPECT_EQ(work_of({}, 10, named_).gates, 0);
  markers_->count = -3;
  EXPECT_EQ(work_of(expected_, 10, named_).tests, 0);
}

TEST_F(FewMarkersTest, NamesNoneOfAToolThatIsNotPredictedOrNotWanted) {
  show(place(0, 2));
  for (const bool predicted : {false, true}) {
    for (const bool wanted : {false, true}) {
      expected_[0].predicted = predicted;
      expected_[0].needs_labeling = wanted;
      EXPECT_EQ(name().count, predicted && wanted ? 1 : 0);
    }
  }
}

TEST_F(FewMarkersTest, SaysNothingOfAFrameBefore) {
  show(place(0, 2));
  EXPECT_EQ(name().count, 1);
  EXPECT_EQ(name().count, 1) << "no claim is left";
  markers_->count = 0;
  EXPECT_EQ(name().count, 0);
}

TEST_F(FewMarkersTest, NamesNoneWithoutDepth) {
  show(place(0, 2), k_marker_no_depth);
  EXPECT_EQ(name().count, 0);
  show(place(0, 0), k_marker_annulus_depth | k_marker_saturated | k_marker_has_neighbour);
  EXPECT_EQ(name().count, 1);
  EXPECT_EQ(named_[0].items[0].of_tool, 0);
}

// Markers beyond markers_max are neither identified nor claimed by a gate.
TEST_F(FewMarkersTest, LooksAtTheFirstMarkersAlone) {
  show(Vector3(0.3, 0.3, 0.9));
  show(place(0, 2));
  EXPECT_EQ(name().count, 1);
  identify_partial(expected_, *markers_, 1, taken_, noise_, *scratch_, named_);
  EXPECT_EQ(named_[0].count, 0);
}

// At the gate's limit along the line of sight the range noise counts, too.
TEST_F(FewMarkersTest, HoldsAMarkerWithinThePredictionsAndTheMeasurementsNoise) {
  expect_within(0, k_sigma_m, 0);
  const Vector3 ahead = place(0, 2).normalized(), side = ahead.unitOrthogonal();
  const double across = 0.1 / 250 * place(0, 2).norm();
  const auto named_at = [&](const Vector3& off) {
    markers_->count = 0;
    show(place(0, 2) + off);
    return name().count;
  };
  const double limit = std::sqrt(21.1075);  // chi-square limit of three degrees of freedom
  const double along_m = limit * std::hypot(k_sigma_m, 0.0015);
  const double across_m = limit * std::hypot(k_sigma_m, across);
  EXPECT_EQ(named_at(0.99 * along_m * ahead), 1);
  EXPECT_EQ(named_at(-0.99 * along_m * ahead), 1);
  EXPECT_EQ(named_at(1.01 * along_m * ahead), 0);
  EXPECT_EQ(named_at(0.99 * across_m * side), 1);
  EXPECT_EQ(named_at(1.01 * across_m * side), 0);
  EXPECT_EQ(named_at(0.99 * across_m * ahead.cross(side)), 1);
  EXPECT_EQ(named_at(1.01 * across_m * ahead.cross(side)), 0);
}

// Rotation is about the centre of the tool's markers, not about its origin.
TEST_F(FewMarkersTest, WidensAGateByTheTurnAboutTheMiddle) {
  expect_within(0, 1e-5, 0.05);
  noise_ = {1e-4, 0.01, 250};
  const Vector3 lever = tools_[0].markers_m[2] - tools_[0].middle_m();
  const Vector3 across = Vector3::UnitZ().cross(lever).normalized();
  const double reach = std::sqrt(21.1075) * 0.05 * lever.norm();
  for (const double part : {0.97, 1.03}) {
    markers_->count = 0;
    show(place(0, 2) + part * reach * across);
    EXPECT_EQ(name().count, part < 1 ? 1 : 0);
  }
}

// A marker predicted at the camera's own position has no valid gate. The tool's other gates count
// as overlapping it.
TEST_F(FewMarkersTest, NamesNoneOfAToolWithAMarkerAtTheCamera) {
  show(place(0, 2));
  EXPECT_EQ(name().count, 1);
  expected_[0].T_camera_tool.translation = -tools_[0].markers_m[0];
  markers_->count = 0;
  show(place(0, 2) + Vector3(0, 0, 1e-9));
  EXPECT_EQ(name().count, 0);
  // Its gate does not claim another tool's marker.
  expected_[1].predicted = expected_[1].needs_labeling = true;
  markers_->count = 0;
  show(place(1, 2));
  EXPECT_EQ(name().count, 0);
  EXPECT_EQ(named_[1].count, 1);
  // The same holds for an invalid covariance.
  expected_[0].T_camera_tool.translation = Vector3(0, 0, 0.5);
  expected_[0].covariance(1, 1) = -1;
  markers_->count = 0;
  show(place(0, 2));
  EXPECT_EQ(name().count, 0);
}

// A blob larger than the marker's image may contain light of another marker.
TEST_F(FewMarkersTest, WidensWhatAnImageShowsTooLarge) {
  show(place(0, 2));
  Marker& marker = markers_->items[0];
  const Vector3 side = marker.ray.unitOrthogonal();
  marker.along_x = side / 250;
  marker.along_y = marker.ray.cross(side) / 250;
  const double range = place(0, 2).norm(), radius_px = 250 * 0.005 / range;
  const double pi = 3.14159265358979323846;
  const auto covariance_of = [&](double area_px) {
    marker.area_px = static_cast<std::uint32_t>(area_px);
    EXPECT_EQ(name().count, 1);
    return named_[0].items[0].covariance_m2;
  };
  const Matrix3 whole = covariance_of(pi * (radius_px + 0.3) * (radius_px + 0.3));
  EXPECT_NEAR(std::sqrt(side.dot(whole * side)), 0.1 / 250 * range, 1e-9);
  const Matrix3 large = covariance_of(3 * pi * radius_px * radius_px);
  MarkerVariance variance{0.01, 0, 0.01, 0.0015 * 0.0015};
  LocalRays rays{marker.centroid_px, marker.ray, marker.along_x, marker.along_y};
  inflate(variance, rim_offset_px(marker, rays, tools_[0], range));
  ASSERT_GT(variance.xx_px2, 0.1);
  EXPECT_NEAR(side.dot(large * side) / (variance.xx_px2 * std::pow(range / 250, 2)), 1, 1e-9);
  EXPECT_NEAR(marker.ray.dot(large * marker.ray) / variance.range_m2, 1, 1e-9);
}

}  // namespace
}  // namespace glint::partial_visibility_test
