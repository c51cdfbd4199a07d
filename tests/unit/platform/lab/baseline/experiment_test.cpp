#include "platform/lab/experiments/experiment.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "painted_frame.hpp"
#include "platform/lab/experiments/declared.hpp"
#include "platform/lab/experiments/experiment_report.hpp"
#include "platform/lab/experiments/method_record.hpp"
#include "platform/sim/scenarios.hpp"

namespace glint {
namespace {

sim::SimFrame frame_with(const Pose& T_reference_tool) {
  sim::SimFrame frame;
  frame.head.valid = true;
  frame.reference = {T_reference_tool};
  return frame;
}

// The tip's pose as a method without a covariance returns it.
Result<UncertainPose> tip_result(const Pose& T_world_tool, Reason reason = Reason::none) {
  const Pose T_tool_tip{Quaternion::Identity(), small_tool().tip_m};
  return {{{}, T_world_tool * T_tool_tip, Matrix6::Zero()}, reason};
}

Result<UncertainPose> shifted(const Pose& pose, const Vector3& by) {
  return tip_result({pose.rotation, pose.translation + by});
}

const Pose k_pose = turned(0.1, 0.2, 0.3, {0.1, 0.2, 0.5});

TEST(MethodRecord, JudgesAgainstWhatTheRestAligned) {
  MethodRecord record(small_tool(), {0, 0, {}});
  const Vector3 offset(0.01, 0, 0);  // offset between the world frames: no error
  for (int i = 0; i < 20; ++i)
    record.take_aligning(frame_with(k_pose), shifted(k_pose, offset), 0.5);
  for (int i = 0; i < 10; ++i)
    record.add_evaluated(frame_with(k_pose), shifted(k_pose, offset + Vector3(0, 0.003, 0)), 1.5);
  const MethodFigures figures = record.samples().figures("any");
  EXPECT_EQ(figures.samples, 10);
  EXPECT_EQ(figures.position_mm.summary.count, 30u);  // x, y and z pooled
  EXPECT_NEAR(figures.position_mm.summary.mean_abs, 1.0, 1e-9);
  EXPECT_NEAR(figures.position_mm.norm_mean, 3.0, 1e-9);
  EXPECT_NEAR(figures.angle_deg.norm_mean, 0.0, 1e-5);
  EXPECT_NEAR(figures.frames_per_s, 30 / 25.0, 1e-9);
}

TEST(MethodRecord, CountsAFrameWithoutAPoseAsNoSample) {
  MethodRecord record(small_tool(), {0, 0, {}});
  record.take_aligning(frame_with(k_pose), tip_result(k_pose), 1);
  record.add_evaluated(frame_with(k_pose), tip_result(k_pose, Reason::no_labeling), 1);
  sim::SimFrame no_head = frame_with(k_pose);
  no_head.head.valid = false;
  record.add_evaluated(no_head, tip_result(k_pose), 1);
  record.add_evaluated(frame_with(k_pose), tip_result(k_pose), 1);
  EXPECT_EQ(record.samples().figures("any").frames, 3);
  EXPECT_EQ(record.samples().figures("any").samples, 1);
  ASSERT_EQ(record.samples().path_m.size(), 3u);  // a gap for each frame without a pose
  EXPECT_FALSE(record.samples().path_m[1].allFinite());
  EXPECT_TRUE(record.samples().path_m[2].allFinite());
}

TEST(MethodRecord, CountsHowOftenTheStatedEllipsoidHoldsTheTip) {
  MethodRecord record(small_tool(), {0, 0, {}});
  for (int i = 0; i < 5; ++i) record.take_aligning(frame_with(k_pose), tip_result(k_pose), 1);
  Result<UncertainPose> answer = shifted(k_pose, {0, 0.001, 0});
  record.add_evaluated(frame_with(k_pose), answer, 1);
  EXPECT_FALSE(record.samples().figures("any").covered.has_value()) << "it stated none";
  answer.value.covariance = Matrix6::Identity() * 1e-6;
  record.add_evaluated(frame_with(k_pose), answer, 1);
  answer.value.covariance *= 0.1;
  record.add_evaluated(frame_with(k_pose), answer, 1);
  EXPECT_EQ(record.samples().figures("any").covered, 0.5);
}

TEST(MethodRecord, AlignsEachRunAnew) {
  MethodSamples samples;
  for (const double offset : {0.01, -0.02}) {
    MethodRecord record(small_tool(), {0, 0, {}});
    const Result<UncertainPose> answer = shifted(k_pose, Vector3(offset, 0, 0));
    for (int i = 0; i < 5; ++i) record.take_aligning(frame_with(k_pose), answer, 1);
    for (int i = 0; i < 5; ++i) record.add_evaluated(frame_with(k_pose), answer, 1);
    samples.add_run(record.samples());
  }
  EXPECT_EQ(samples.samples, 10);
  EXPECT_LT(samples.figures("any").position_mm.summary.mean_abs, 1e-6);
}

ExperimentRun short_run() {
  ExperimentRun run;
  run.scenario = sim::experiment_dynamic(0);
  run.skipped = sim::k_aligning_frames - 12;
  run.aligning = 12;
  run.judged = 12;
  return run;
}

TEST(Experiment, GivesBothMethodsTheSameFramesAndTheSameFiguresAgain) {
  std::vector<int> progress;
  ExperimentOptions options;
  options.progress = [&](int done, int total) {
    progress.push_back(done);
    EXPECT_EQ(total, 24);
  };
  const ExperimentResult a = run_experiment(ExperimentKind::moving, {short_run()}, options);
  const ExperimentResult b = run_experiment(ExperimentKind::moving, {short_run()}, {});
  EXPECT_EQ(progress.back(), 24);
  for (const auto& [first, second] :
       {std::pair(&a.baseline, &b.baseline), std::pair(&a.glint, &b.glint),
        std::pair(&a.glint_held, &b.glint_held)}) {
    EXPECT_EQ(first->frames, 12);
    EXPECT_GE(first->samples, 10);
    EXPECT_LT(first->position_mm.norm_mean, 100);  // the tool was tracked, whatever the drift
    EXPECT_EQ(first->position_mm.summary.mean_abs, second->position_mm.summary.mean_abs);
    EXPECT_EQ(first->angle_deg.summary.sd, second->angle_deg.summary.sd);
  }
  EXPECT_EQ(a.path.reference_m.size(), 12u);
  EXPECT_EQ(a.config_hash, b.config_hash);
}

TEST(Experiment, NamesItsParametersByAHashThatMovesWithThem) {
  EXPECT_EQ(fnv1a_text(""), "cbf29ce484222325");
  EXPECT_EQ(fnv1a_text("a"), "af63dc4c8601ec8c");  // test vector of the FNV authors
  ExperimentRun other = short_run();
  const std::string before = declared_parameters({other});
  other.scenario.localisation.rest_angle_rad *= 1.0001;
  EXPECT_NE(before, declared_parameters({other}));
}

TEST(Experiment, WritesPublishedSeedAndGlintSideBySide) {
  ExperimentResult result;
  result.declared = declared_parameters({short_run()});
  const std::vector<double> errors = {-1, 2, 3}, lengths = {4};
  result.baseline.position_mm = make_error_column(errors, lengths);
  result.baseline.samples = 5000;
  const auto json = nlohmann::json::parse(experiment_json(result));
  for (const char* row : {"published", "baseline", "glint"}) {
    for (const char* key : {"position_mean_abs_mm", "angle_mean_abs_deg", "position_sd_mm",
                            "angle_sd_deg", "frames_per_s", "samples"}) {
      EXPECT_TRUE(json.at(row).contains(key)) << row << ' ' << key;
    }
  }
  EXPECT_EQ(json["published"]["position_mean_abs_mm"], 1.9);
  EXPECT_TRUE(json["published"]["position_sd_mm"].is_null());  // not published (static)
  EXPECT_EQ(json["baseline"]["position_mean_abs_mm"], 2.0);
  EXPECT_EQ(json["baseline"]["position_mm"]["norm_mean"], 4.0);
  result.kind = ExperimentKind::moving;
  const std::string table = experiment_table(result);
  for (const char* words :
       {"22.10", "30.70", "5.39", "-0.10", "0.22", "baseline", "Glint", "with body"})
    EXPECT_NE(table.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace glint
