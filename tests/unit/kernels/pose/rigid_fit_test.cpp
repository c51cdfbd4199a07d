#include "kernels/pose/rigid_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/unit/kernels/pose/scene.hpp"

namespace glint {
namespace {

std::vector<Vector3> moved(const Pose& pose, const std::vector<Vector3>& points) {
  std::vector<Vector3> result;
  for (const Vector3& point : points) result.push_back(pose * point);
  return result;
}

const std::vector<Vector3> k_square = {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0}};

TEST(RigidFit, FindsAQuarterTurnAndAShift) {
  const std::vector<Vector3> model = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.3}};
  const std::vector<Vector3> measured = {{1, 2, 3}, {1, 2.1, 3}, {0.8, 2, 3}, {1, 2, 3.3}};
  const RigidFit fit = fit_rigid(model, measured);
  ASSERT_EQ(fit.reason, Reason::none);
  EXPECT_LT((fit.transform.translation - Vector3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((fit.transform.rotation * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-15);
  EXPECT_LT(fit.rms_m, 1e-15);
}

TEST(RigidFit, RecoversAnyPoseOfAnyTool) {
  test::Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const int n = 3 + random.below(6);
    const Tool tool = test::random_tool(random, n);
    const std::vector<Vector3> model(tool.markers_m.begin(), tool.markers_m.begin() + n);
    const Pose truth{random.rotation(), random.vector(1.0)};
    const RigidFit fit = fit_rigid(model, moved(truth, model));
    ASSERT_EQ(fit.reason, Reason::none);
    EXPECT_LT(test::angle_between(fit.transform.rotation, truth.rotation), 1e-12);
    EXPECT_LT((fit.transform.translation - truth.translation).norm(), 1e-13);
  }
}

double rms_of(const Pose& pose, const std::vector<Vector3>& model,
              const std::vector<Vector3>& measured) {
  double squares = 0;
  for (std::size_t i = 0; i < model.size(); ++i) {
    squares += (measured[i] - pose * model[i]).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(model.size()));
}

// No small step in any of the six directions lowers the residual.
void expect_minimum(const RigidFit& fit, const std::vector<Vector3>& model,
                    const std::vector<Vector3>& measured) {
  ASSERT_EQ(fit.reason, Reason::none);
  EXPECT_NEAR(rms_of(fit.transform, model, measured), fit.rms_m, 1e-12);
  for (int step = 0; step < 12; ++step) {
    Vector3 turn = Vector3::Zero(), shift = Vector3::Zero();
    (step < 6 ? turn : shift)(step % 3) = (step % 6 < 3 ? 1e-4 : -1e-4);
    const Pose other{from_rotation_vector(turn) * fit.transform.rotation,
                     fit.transform.translation + shift};
    EXPECT_GT(rms_of(other, model, measured), fit.rms_m) << step;
  }
}

TEST(RigidFit, LeavesNoSmallerResidualInAnyDirection) {
  test::Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Tool tool = test::random_tool(random, 5);
    const std::vector<Vector3> model(tool.markers_m.begin(), tool.markers_m.begin() + 5);
    std::vector<Vector3> measured = moved({random.rotation(), random.vector(0.5)}, model);
    for (Vector3& point : measured) point += random.vector(0.003);
    expect_minimum(fit_rigid(model, measured), model, measured);
  }
}

TEST(RigidFit, NeverMirrorsWhatOnlyAMirrorWouldFit) {
  test::Random random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Tool tool = test::random_tool(random, 5);
    const std::vector<Vector3> model(tool.markers_m.begin(), tool.markers_m.begin() + 5);
    std::vector<Vector3> mirrored;
    for (const Vector3& point : model) mirrored.emplace_back(-point.x(), point.y(), point.z());
    const RigidFit fit = fit_rigid(model, mirrored);
    EXPECT_NEAR(fit.transform.rotation.toRotationMatrix().determinant(), 1.0, 1e-12);
    expect_minimum(fit, model, mirrored);
  }
}

TEST(RigidFit, TakesCoplanarMarkersInAnyPose) {
  test::Random random(4);
  for (int trial = 0; trial < 500; ++trial) {
    const Pose truth{random.rotation(), random.vector(1.0)};
    const RigidFit fit = fit_rigid(k_square, moved(truth, k_square));
    ASSERT_EQ(fit.reason, Reason::none);
    EXPECT_LT(test::angle_between(fit.transform.rotation, truth.rotation), 1e-12);
  }
}

TEST(RigidFit, SaysWhyPointsFixNoPose) {
  const std::vector<Vector3> line = {{0, 0, 0}, {0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}};
  const std::vector<Vector3> one_place(4, Vector3(0.1, 0.2, 0.3));
  const std::vector<Vector3> two = {{0, 0, 0}, {0.1, 0, 0}};
  std::vector<Vector3> broken = k_square;
  broken[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fit_rigid(line, line).reason, Reason::collinear);
  EXPECT_EQ(fit_rigid(one_place, one_place).reason, Reason::degenerate);
  EXPECT_EQ(fit_rigid(two, two).reason, Reason::too_few_markers);
  EXPECT_EQ(fit_rigid(k_square, two).reason, Reason::too_few_markers);
  EXPECT_EQ(fit_rigid(broken, k_square).reason, Reason::out_of_range);
  EXPECT_EQ(fit_rigid(k_square, broken).reason, Reason::out_of_range);
  const std::vector<Vector3> flat(4, Vector3(0, 0, 1));
  EXPECT_EQ(fit_rigid(k_square, flat).reason, Reason::collinear);
  const std::vector<Vector3> measured_line = {{0, 0, 1}, {0.1, 0, 1}, {0.2, 0, 1}, {0.3, 0, 1}};
  EXPECT_EQ(fit_rigid(k_square, measured_line).reason, Reason::collinear);
}

TEST(RigidFit, DrawsTheLineAtAThousandthOfTheLength) {
  const auto bent = [](double height) {
    return std::vector<Vector3>{{0, 0, 0}, {0.05, height, 0}, {0.1, 0, 0}};
  };
  EXPECT_EQ(rotation_is_fixed_by(bent(0.00008)), Reason::collinear);
  EXPECT_EQ(rotation_is_fixed_by(bent(0.0002)), Reason::none);
}

TEST(RigidFit, GivesTheSameBitsEverywhere) {
  test::Random random(5);
  test::BitHash hash;
  for (int trial = 0; trial < 2000; ++trial) {
    const Tool tool = test::random_tool(random, 4);
    const std::vector<Vector3> model(tool.markers_m.begin(), tool.markers_m.begin() + 4);
    std::vector<Vector3> measured = moved({random.rotation(), random.vector(0.5)}, model);
    for (Vector3& point : measured) point += random.vector(0.002);
    const RigidFit fit = fit_rigid(model, measured);
    hash.add(fit.transform);
    hash.add(fit.rms_m);
  }
  EXPECT_EQ(hash.value(), 17456183959077900624u);
}

TEST(Tool, LearnsItsDistancesWhenItIsPrepared) {
  const Tool tool = test::tool_of<3>({{0, 0, 0}, {30, 0, 0}, {0, 40, 0}});
  EXPECT_NEAR(tool.distance_m[1][2], 0.05, 1e-15);
  EXPECT_EQ(tool.distance_m[1][2], tool.distance_m[2][1]);
  EXPECT_EQ(tool.distance_m[2][2], 0.0);
}

TEST(Tool, IsRefusedWhenItsMarkersFixNoPose) {
  Tool tool = test::five_marker_pen();
  tool.marker_count = 2;
  EXPECT_EQ(prepare_tool(tool), Reason::too_few_markers);
  tool.marker_count = 9;
  EXPECT_EQ(prepare_tool(tool), Reason::out_of_range);
  tool.marker_count = 5;
  tool.markers_m[4] = tool.markers_m[3];
  EXPECT_EQ(prepare_tool(tool), Reason::degenerate);
  for (int i = 0; i < 5; ++i) tool.markers_m[static_cast<std::size_t>(i)] = Vector3(0.01 * i, 0, 0);
  EXPECT_EQ(prepare_tool(tool), Reason::collinear);
  tool.markers_m[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(prepare_tool(tool), Reason::out_of_range);
}

// Values chosen so that their FNV-1a hash is zero.
TEST(Tool, WhoseHashIsZeroStillHasAnIdentity) {
  Tool tool;
  tool.marker_count = 3;
  tool.markers_m[0] = Vector3(0, 0, 0);
  tool.markers_m[1] = Vector3(0.125, 0, 0);
  tool.markers_m[2] = Vector3(0, 0.25, 0);
  tool.marker_radius_m = 0.0078125;
  tool.tip_m = Vector3(0, 0, 0x1.d51607cdp-8);
  ASSERT_EQ(prepare_tool(tool), Reason::none);
  EXPECT_EQ(tool.identity, 1u);
}

Tool small_tool() {
  Tool tool = test::tool_of<4>({{0, 0, 0}, {30, 0, 0}, {0, 40, 0}, {10, 20, 30}});
  tool.tip_m = Vector3(0.01, 0.02, -0.1);
  tool.depth_bias = {0.001, 0.002, 0.003, 0.2, 0.9};
  return tool;
}

// Each part of the body alone changes the identity. Name, sigmas and unused elements of markers_m
// do not.
TEST(Tool, HasAnotherIdentityWhereAnyPartOfItsBodyDiffers) {
  const auto identity = [](auto&& change) {
    Tool tool = small_tool();
    change(tool);
    EXPECT_EQ(prepare_tool(tool), Reason::none);
    return tool.identity;
  };
  const std::uint32_t own = identity([](Tool&) {});
  EXPECT_NE(own, 0U);
  EXPECT_EQ(own, identity([](Tool& t) { t.name[0] = 'x'; }));
  EXPECT_EQ(own, identity([](Tool& t) { t.marker_sigma_m = t.tip_sigma_m = 0.001; }));
  EXPECT_EQ(own, identity([](Tool& t) { t.markers_m[4] = Vector3(1, 2, 3); }));
  std::vector<std::uint32_t> others{own};
  for (std::size_t marker = 0; marker < 4; ++marker)
    for (int axis = 0; axis < 3; ++axis)
      others.push_back(identity([&](Tool& t) { t.markers_m[marker](axis) += 1e-9; }));
  for (int axis = 0; axis < 3; ++axis)
    others.push_back(identity([&](Tool& t) { t.tip_m(axis) += 1e-9; }));
  others.push_back(identity([](Tool& t) { t.marker_count = 3; }));
  others.push_back(identity([](Tool& t) { t.marker_radius_m += 1e-9; }));
  others.push_back(identity([](Tool& t) { t.shape = MarkerShape::disc; }));
  for (double DepthBias::*const part :
       {&DepthBias::offset_m, &DepthBias::per_metre, &DepthBias::low_signal_m,
        &DepthBias::range_min_m, &DepthBias::range_max_m})
    others.push_back(identity([&](Tool& t) { t.depth_bias.*part += 1e-9; }));
  others.push_back(identity([](Tool& t) { t.depth_bias.range_max_m = 0; }));
  std::sort(others.begin(), others.end());
  EXPECT_EQ(std::unique(others.begin(), others.end()), others.end());
  const auto unmeasured = [&](double offset_m) {
    return identity([&](Tool& t) { t.depth_bias = {offset_m, 0, 0, 0, 0}; });
  };
  EXPECT_EQ(unmeasured(0), unmeasured(0.5)) << "a bias that was not measured is none";
}

TEST(Tool, IsPreparedWithThreeToEightMarkersAMillimetreApart) {
  test::Random random(6);
  for (int count = -1; count <= k_markers_per_tool_max + 1; ++count) {
    Tool tool = test::random_tool(random, k_markers_per_tool_max);
    tool.marker_count = count;
    const Reason expected = count > k_markers_per_tool_max ? Reason::out_of_range
                            : count < 3                    ? Reason::too_few_markers
                                                           : Reason::none;
    EXPECT_EQ(prepare_tool(tool), expected) << count;
    EXPECT_EQ(tool.identity == 0, expected != Reason::none) << "refused ones have none";
    for (std::size_t i = 0; i < k_markers_per_tool_max; ++i) {
      for (std::size_t j = 0; j < k_markers_per_tool_max; ++j) {
        const bool both = expected == Reason::none && std::max(i, j) < std::size_t(count);
        const double apart = (tool.markers_m[i] - tool.markers_m[j]).norm();
        EXPECT_DOUBLE_EQ(tool.distance_m[i][j], both ? apart : 0);
      }
    }
    EXPECT_EQ(tool.present(), count > 0);
  }
  Tool tool = small_tool();
  tool.markers_m[1] = Vector3(k_marker_distance_min_m, 0, 0);
  EXPECT_EQ(prepare_tool(tool), Reason::none);
  tool.markers_m[1] = Vector3(0.999 * k_marker_distance_min_m, 0, 0);
  EXPECT_EQ(prepare_tool(tool), Reason::degenerate);
}

TEST(Tool, HasItsMarkersMeanAsItsMiddleAndASpheresRadiusBehindItsSurface) {
  Tool tool = small_tool();
  EXPECT_LT((tool.middle_m() - Vector3(0.01, 0.015, 0.0075)).norm(), 1e-15);
  EXPECT_EQ(tool.centre_offset_m(), tool.marker_radius_m);
  tool.shape = MarkerShape::disc;
  EXPECT_EQ(tool.centre_offset_m(), 0);
  tool.marker_count = 1;
  EXPECT_EQ(tool.middle_m(), tool.markers_m[0]);
  tool.marker_count = 0;
  EXPECT_EQ(tool.middle_m(), Vector3(0, 0, 0));
  EXPECT_FALSE(tool.present());
}

// Points within a micrometre of their mean, and slightly further apart.
TEST(RigidFit, CallsPointsWithinAMicrometreOnePlace) {
  const auto square = [](double side) {
    return std::vector<Vector3>{{side, 0, 0}, {0, side, 0}, {-side, 0, 0}, {0, -side, 0}};
  };
  EXPECT_EQ(rotation_is_fixed_by(square(0.99e-6)), Reason::degenerate);
  EXPECT_EQ(rotation_is_fixed_by(square(1.01e-6)), Reason::none);
}

}  // namespace
}  // namespace glint
