// Steps of the weighted fit against a reference of its rules, and its normal equations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kernels/pose/normal_equations.hpp"
#include "kernels/pose/pose_prior.hpp"
#include "kernels/pose/weighted_fit.hpp"
#include "platform/dense.hpp"
#include "tests/unit/kernels/pose/weighted_scene.hpp"

namespace glint::fit_steps_test {
namespace {

using test::Random;

const Vector3 k_place(0.08, -0.05, 0.5);
const MarkerVariance k_usual{0.01, 0.004, 0.0064, 0.002 * 0.002};

struct ReferenceFit {
  Pose pose;
  double chi_square = 0;
  int steps = 1, undone = 0;
  Reason reason = Reason::none;
};

bool equations(const std::vector<WeightedMarker>& markers, const Vector3& mean, const Pose& pose,
               NormalEquations& normal) {
  normal = {};
  return add_markers(markers, pose, mean, normal);
}

// Reference: Gauss-Newton with Levenberg-Marquardt damping. A step that does not lower chi-square
// is undone and repeated with a hundredth of the diagonal added, then ten times as much. A
// successful step divides the damping by ten; below 1e-4 it becomes zero. The fit ends with a step
// that lowers chi-square by less than 1e-4, or after which the next would.
ReferenceFit reference_fit(const std::vector<WeightedMarker>& markers, const Vector3& mean,
                           const Pose& start, int steps_max, double chi_square_stop) {
  ReferenceFit out;
  out.pose = start;
  NormalEquations here;
  if (!equations(markers, mean, start, here)) return {start, 0, 1, 0, Reason::degenerate};
  double damping = 0, before = 0;
  while (true) {
    Matrix6 matrix = here.matrix.selfadjointView<Eigen::Lower>();
    matrix.diagonal() *= 1 + damping;
    const Vector6 step = -solve_symmetric(matrix, here.gradient);
    Pose there;
    const double length = step.tail<3>().norm();
    const Vector3 axis = step.tail<3>() / length;
    there.rotation =
        (Quaternion(Eigen::AngleAxisd(2 * std::atan(0.5 * length), axis)) * out.pose.rotation)
            .normalized();
    there.translation = out.pose * mean + step.head<3>() - there.rotation * mean;
    const double decrease = -step.dot(here.gradient);
    double next = decrease;
    if (decrease < 0.01 && decrease < before) next = decrease * decrease / before;
    if (next < 1e-4) {
      out.pose = there;
      out.chi_square = std::max(here.chi_square - decrease, 0.0);
      return out;
    }
    if (out.steps >= steps_max) break;
    if (out.steps == 3 && here.chi_square > chi_square_stop) {
      out.reason = Reason::bad_fit;
      return out;
    }
    NormalEquations tried;
    ++out.steps;
    if (equations(markers, mean, there, tried) && tried.chi_square <= here.chi_square) {
      out.pose = there;
      here = tried;
      before = damping > 0 ? 0 : decrease;
      damping = damping > 1e-4 ? damping / 10 : 0;
    } else {
      ++out.undone;
      damping = std::max(0.01, damping * 10);
    }
  }
  out.chi_square = here.chi_square;
  return out;
}

// From any rotation, with ranges of low weight against the pixels: many steps are undone.
TEST(FitSteps, AreThoseOfThePlainRules) {
  Random random(1);
  const MarkerVariance precise_pixels{1e-4, 0, 1e-4, 0.03 * 0.03};
  int undone = 0, repeatedly = 0, aborted = 0, degenerate = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const Tool tool = trial % 2 == 0 ? test::flat_tool() : test::five_marker_pen();
    const Pose truth = test::tilted_pose(tool, random.within(0, 1.2), k_place, random);
    auto markers =
        test::weighted_view(tool, truth, trial % 5 == 0 ? k_usual : precise_pixels, 2, random);
    if (trial % 3 == 0) markers.resize(3);
    const Vector3 mean = mean_of(markers);
    Pose start{random.rotation(), Vector3::Zero()};
    const double behind_m = trial % 50 == 49 ? 1 : 0;
    start.translation =
        truth * mean + random.vector(0.05) - start.rotation * mean - Vector3(0, 0, behind_m);
    const int steps_max = trial % 4 == 0 ? 1 + trial / 4 % 12 : 12;
    const double chi_square_stop = trial % 7 == 0 ? 1e5 : std::numeric_limits<double>::infinity();
    const ReferenceFit reference = reference_fit(markers, mean, start, steps_max, chi_square_stop);
    const WeightedFit fit = fit_weighted(markers, mean, start, nullptr, steps_max, chi_square_stop);
    ASSERT_EQ(fit.reason, reference.reason) << trial;
    ASSERT_EQ(fit.steps, reference.steps) << trial;
    EXPECT_LT((fit.T_camera_tool * mean - reference.pose * mean).norm(), 1e-7) << trial;
    EXPECT_LT(test::angle_between(fit.T_camera_tool.rotation, reference.pose.rotation), 1e-6)
        << trial;
    if (reference.reason == Reason::none) {
      EXPECT_NEAR(fit.chi_square, reference.chi_square, 1e-6 * (1 + reference.chi_square)) << trial;
    }
    undone += reference.undone;
    repeatedly += reference.undone > 2 ? 1 : 0;
    aborted += reference.reason == Reason::bad_fit ? 1 : 0;
    degenerate += reference.reason == Reason::degenerate ? 1 : 0;
  }
  EXPECT_GT(undone, 400);
  EXPECT_GT(repeatedly, 50);
  EXPECT_GT(aborted, 10);
  EXPECT_GT(degenerate, 5);
}

// A point ahead of the camera along its ray by a tenth of the measured range, and by less.
TEST(NormalEquations, HaveAPixelFromATenthOfTheRangeOn) {
  const CameraModel camera = test::pinhole();
  int steps = 0;
  const LocalRays rays = local_rays(camera, {256, 256}, k_ray_steps_max, steps).value;
  const std::vector<WeightedMarker> one{whiten_marker(Vector3::Zero(), rays, 1.0, k_usual).value};
  const auto has_pixel = [&](double range_m) {
    NormalEquations normal;
    return add_markers(one, {Quaternion::Identity(), Vector3(0, 0, range_m)}, Vector3::Zero(),
                       normal);
  };
  EXPECT_TRUE(has_pixel(0.101));
  EXPECT_FALSE(has_pixel(0.099));
  EXPECT_FALSE(has_pixel(-1));
}

TEST(NormalEquations, AddToWhatIsThere) {
  Random random(2);
  const Tool tool = test::five_marker_pen();
  const Vector3 mean = test::mean_of_markers(tool);
  const Pose pose = test::tilted_pose(tool, 0.5, k_place, random);
  const auto markers = test::weighted_view(tool, pose, k_usual, 1, random);
  NormalEquations once, twice;
  ASSERT_TRUE(add_markers(markers, pose, mean, once));
  twice = once;
  ASSERT_TRUE(add_markers(markers, pose, mean, twice));
  EXPECT_TRUE(twice.matrix.isApprox(2 * once.matrix));
  EXPECT_TRUE(twice.gradient.isApprox(2 * once.gradient));
  EXPECT_DOUBLE_EQ(twice.chi_square, 2 * once.chi_square);
}

// Half a radian from the prediction, where the second order of the rotation matters.
TEST(PosePrior, SlopeIsHalfTheGradientFarFromThePrediction) {
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Vector3 mean(0.01, -0.02, 0.03);
    PosePrior prior;
    prior.T_camera_tool = {random.rotation(), random.vector(0.3)};
    prior.reference_m = Vector3(0.05, 0.1, -0.1);
    Matrix6 root;
    for (int i = 0; i < 36; ++i) root(i) = random.normal();
    prior.information = root * root.transpose();
    const Pose pose{
        (from_rotation_vector(0.5 * random.vector(1).normalized()) * prior.T_camera_tool.rotation)
            .normalized(),
        prior.T_camera_tool.translation + random.vector(0.2)};
    const auto at = [&](int parameter, double by) {
      Vector3 turn = Vector3::Zero(), shift = Vector3::Zero();
      (parameter < 3 ? shift : turn)(parameter % 3) = by;
      Pose moved;
      moved.rotation = from_rotation_vector(turn) * pose.rotation;
      moved.translation = pose * mean + shift - moved.rotation * mean;
      NormalEquations normal;
      add_prior(prior, moved, mean, normal);
      return normal.chi_square;
    };
    NormalEquations normal;
    add_prior(prior, pose, mean, normal);
    EXPECT_TRUE(normal.matrix.isApprox(normal.matrix.transpose(), 1e-9));
    for (int i = 0; i < 6; ++i) {
      const double slope = (at(i, 1e-5) - at(i, -1e-5)) / 4e-5;
      const double scale = std::sqrt(normal.matrix(i, i) * normal.chi_square);
      EXPECT_NEAR(normal.gradient(i), slope, 2e-4 * scale) << i;
    }
  }
}

}  // namespace
}  // namespace glint::fit_steps_test
