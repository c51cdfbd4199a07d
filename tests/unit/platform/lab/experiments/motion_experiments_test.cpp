#include "platform/lab/experiments/motion_experiments.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_filter.hpp"
#include "platform/input_error.hpp"
#include "platform/lab/experiments/baselines.hpp"
#include "platform/lab/experiments/glint_predictor.hpp"
#include "platform/lab/experiments/point_run.hpp"
#include "platform/lab/experiments/prediction_run.hpp"

namespace glint {
namespace {

// Feeds half a second of constant linear and angular velocity, without noise.
void feed_steady(Predictor& predictor, const Vector3& velocity, const Vector3& turn) {
  for (int frame = 0; frame <= 200; ++frame) {
    UncertainPose measured;
    measured.time = frame_time(frame);
    const double t = (measured.time - Time{}).seconds();
    measured.pose = {from_rotation_vector(t * turn), t * velocity};
    measured.covariance = 1e-6 * Matrix6::Identity();
    predictor.update(measured);
  }
}

TEST(Baselines, ForetellSteadyMotionExactlyButForTheOneThatHolds) {
  const Vector3 velocity(0.2, -0.1, 0.3), turn(0, 0.4, 0);
  const Time ahead = frame_time(200) + milliseconds(50);
  const double t = (ahead - Time{}).seconds();
  const Pose truth{from_rotation_vector(t * turn), t * velocity};
  const auto error = [&](PredictorPointer predictor) {
    feed_steady(*predictor, velocity, turn);
    return pose_difference(predictor->predict(ahead), truth).norm();
  };
  EXPECT_LT(error(make_linear_slerp()), 1e-9);
  EXPECT_LT(error(make_constant_velocity()), 1e-6);
  EXPECT_LT(error(make_double_exponential()), 1e-3);
  EXPECT_LT(error(make_one_euro()), 1e-2);
  EXPECT_LT(error(std::make_unique<GlintPredictor>()), 1e-5);
  EXPECT_NEAR(error(make_last_value()), 0.05 * std::hypot(velocity.norm(), turn.norm()), 1e-6);
}

TEST(PointFit, IsAsGoodAsItsCovarianceSays) {
  const PointCamera camera;
  const std::vector<Vector3> model = tool_8700339();
  double sum = 0;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const PointNoise noise{1, 3, static_cast<std::uint64_t>(i)};
    const Pose truth = held_pose(0.5, noise.seed, noise.run);
    const Result<UncertainPose> fit = measure(camera, model, truth, noise, 0);
    ASSERT_TRUE(fit);
    const Cholesky<6> factor(fit.value.covariance);
    sum += factor.squared_length(pose_difference(fit.value.pose, truth)) / 6;
  }
  EXPECT_NEAR(sum / n, 1, 0.06);
}

TEST(PointFit, OfExactPointsIsExact) {
  const Pose truth = held_pose(0.3, 1, 1);
  const Result<UncertainPose> fit = measure({}, tool_8700339(), truth, {0, 1, 1}, 0);
  ASSERT_TRUE(fit);
  EXPECT_LT(pose_difference(fit.value.pose, truth).norm(), 1e-9);
}

TEST(PredictionRun, JudgesNothingWithinASecondOfAGap) {
  EvaluationWindow is_evaluated(milliseconds(1000));
  EXPECT_FALSE(is_evaluated(frame_time(44)));
  EXPECT_FALSE(is_evaluated(frame_time(89)));  // the last second has no frames
  for (int frame = 90; frame < 135; ++frame) EXPECT_FALSE(is_evaluated(frame_time(frame))) << frame;
  EXPECT_TRUE(is_evaluated(frame_time(135)));
}

TEST(MotionExperiments, MeetTheirBarsInAQuickRun) {
  const CaseOptions options{true, 1, ".", "", {}, 0, {}};
  for (const CaseList& list : {run_lag(options), run_sine(options)}) {
    EXPECT_FALSE(list.cases.empty());
    EXPECT_EQ(missed_bars(list), 0) << case_table(list);
  }
}

TEST(MotionExperiments, GiveTheSameFiguresAgain) {
  const CaseOptions options{true, 5, ".", "", {}, 0, {}};
  EXPECT_EQ(case_table(run_static_tool(options)), case_table(run_static_tool(options)));
}

TEST(MotionExperiments, NameARecordingThatIsMissing) {
  CaseOptions options;
  options.data = "/nowhere";
  for (const auto run : {run_prediction, run_occlusion}) {
    try {
      (void)run(options);
      FAIL() << "no recording, no error";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("/nowhere/tum_fr1_xyz_groundtruth.txt"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(MotionExperiments, ForetellTheRealRecordingsAndReturnToThem) {
  const char* folder = std::getenv("GLINT_TEST_DATA");
  const std::string path = std::string(folder ? folder : "") + "/trajectories";
  if (!folder || !std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  CaseOptions options;
  options.data = path;
  for (const CaseList& list : {run_prediction(options), run_occlusion(options)})
    EXPECT_EQ(missed_bars(list), 0) << case_table(list);
}

TEST(MotionExperiments, StateTheErrorsOfRealToolsAtRest) {
  const char* folder = std::getenv("GLINT_TEST_DATA");
  const std::string path = std::string(folder ? folder : "") + "/hl2_real";
  if (!folder || !std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  CaseOptions options;
  options.quick = true;
  options.data = folder;
  const CaseList list = run_correlated(options);
  EXPECT_EQ(missed_bars(list), 0) << case_table(list);
}

}  // namespace
}  // namespace glint
