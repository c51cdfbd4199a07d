#include "platform/runtime/session/output_figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernels/angles.hpp"
#include "kernels/motion/interpolate.hpp"

namespace glint {
namespace {

constexpr Duration k_period = milliseconds(20);

Cell judged_cell() {
  Cell cell = default_cell();
  cell.camera.period = k_period;
  cell.actuation_delay = milliseconds(7);
  return cell;
}

Time ms_after_start(std::int64_t ms) { return Time{} + milliseconds(ms); }

// Ground truth: the tool's axes are the world's; its tip moves at 1 m/s along x.
std::optional<Pose> moving_tool(const Cell& cell, Time time) {
  Pose pose;
  pose.translation = Vector3((time - Time{}).seconds(), 0, 0) - cell.tools.items[0].tip_m;
  return pose;
}

PoseSample sample_at(Time tick, TrackState state, const Vector3& error, double sigma_m) {
  PoseSample sample;
  sample.tick = tick;
  sample.measurement = tick - milliseconds(11);
  sample.state = state;
  sample.frame = ReferenceFrame::world;
  sample.pose.translation = Vector3((tick + milliseconds(7) - Time{}).seconds(), 0, 0) + error;
  sample.covariance = Matrix6::Identity() * (sigma_m * sigma_m);
  return sample;
}

// Frame rate from the interval of the two newest frames, or from the newest frame's age.
TEST(OutputFigures, SortTicksByTheFramesRate) {
  const Cell cell = judged_cell();
  OutputStatistics figures(cell, {});
  const auto add = [&](std::int64_t tick_ms, std::optional<Time> newest) {
    figures.add(sample_at(ms_after_start(tick_ms), TrackState::lost, Vector3::Zero(), 1), newest);
  };
  add(5, std::nullopt);           // nominal: no frame yet
  add(20, ms_after_start(20));    // nominal
  add(41, ms_after_start(40));    // nominal: 20 ms apart
  add(69, ms_after_start(40));    // nominal: 29 ms ago
  add(70, ms_after_start(40));    // reduced: 30 ms ago
  add(130, ms_after_start(40));   // low: 90 ms ago
  add(140, ms_after_start(139));  // low: 99 ms apart
  add(170, ms_after_start(169));  // reduced: 30 ms apart
  add(190, ms_after_start(189));  // nominal
  const auto& rates = figures.figures();
  EXPECT_EQ(rates.tools[0][0].ticks, 5u);
  EXPECT_EQ(rates.tools[0][1].ticks, 2u);
  EXPECT_EQ(rates.tools[0][2].ticks, 2u);
  EXPECT_EQ(rates.gaps[0], 2u);
  EXPECT_EQ(rates.gaps[1], 1u);
  EXPECT_EQ(rates.gaps[2], 1u);
  EXPECT_NEAR(rates.seconds[2], 0.099, 1e-12);
  EXPECT_EQ(rates.tools[0][0].measured + rates.tools[0][0].predicted, 0u);
  EXPECT_EQ(rates.tools[0][0].of_measured.count, 0u);
}

TEST(OutputFigures, JudgePosesAtTheTimeThatTheyAreFor) {
  const Cell cell = judged_cell();
  OutputStatistics figures(cell, [&](int, Time time) { return moving_tool(cell, time); });
  const std::vector<Vector3> errors{{0.003, 0, 0}, {0, -0.004, 0}, {0, 0, 0.0027}};
  // Standard deviation 1 mm on each axis: the 95 % ellipsoid has a radius of 2.795 mm.
  for (const Vector3& error : errors) {
    figures.add(sample_at(ms_after_start(10), TrackState::measured, error, 0.001),
                ms_after_start(9));
  }
  figures.add(sample_at(ms_after_start(10), TrackState::predicted, Vector3(0.03, 0, 0), 0.02),
              ms_after_start(9));
  PoseSample in_camera =
      sample_at(ms_after_start(10), TrackState::measured, Vector3(1, 1, 1), 0.001);
  in_camera.frame = ReferenceFrame::camera;
  figures.add(in_camera, ms_after_start(9));
  const RateStatistics& rate = figures.figures().tools[0][0];
  EXPECT_EQ(rate.measured, 4u);
  EXPECT_EQ(rate.predicted, 1u);
  EXPECT_NEAR(quantile(rate.ages, 0.5), 11.5, 1e-12);
  const OutputErrors& measured = rate.of_measured;
  EXPECT_EQ(measured.count, 3u);
  EXPECT_EQ(measured.inside_position, 1u);
  EXPECT_EQ(measured.inside_rotation, 3u);
  EXPECT_NEAR(measured.square_m2, 9e-6 + 16e-6 + 7.29e-6, 1e-12);
  EXPECT_NEAR(measured.stated_m2, 3 * 3e-6, 1e-15);
  EXPECT_NEAR(measured.largest_m, 0.004, 1e-12);
  EXPECT_EQ(measured.gross, 0u);
  EXPECT_EQ(rate.of_predicted.count, 1u);
  EXPECT_EQ(rate.of_predicted.inside_position, 1u);
  EXPECT_EQ(rate.of_predicted.gross, 0u);  // 30 mm, but the stated standard deviation is 35 mm
}

// Gross: more than 15 degrees, or more than both 20 mm and three stated standard deviations.
TEST(OutputFigures, CountGrossPoses) {
  const Cell cell = judged_cell();
  OutputStatistics figures(cell, [&](int, Time time) { return moving_tool(cell, time); });
  const auto add = [&](double off_m, double sigma_m, double turned_deg) {
    PoseSample sample = sample_at(ms_after_start(10), TrackState::measured, {off_m, 0, 0}, sigma_m);
    sample.pose.rotation = from_rotation_vector(Vector3(0, turned_deg * k_radians_per_degree, 0));
    figures.add(sample, ms_after_start(9));
    return figures.figures().tools[0][0].of_measured.gross;
  };
  EXPECT_EQ(add(0.0195, 0.001, 0), 0u);
  EXPECT_EQ(add(0.0205, 0.001, 0), 1u);
  EXPECT_EQ(add(0.0205, 0.004, 0), 1u);  // three standard deviations of all axes: 20.8 mm
  EXPECT_EQ(add(0, 0.001, 14.5), 1u);
  EXPECT_EQ(add(0, 0.001, 15.5), 2u);
}

TEST(OutputFigures, JudgeInTheRobotsFrameAndRotations) {
  Cell cell = judged_cell();
  cell.T_world_robot = {from_rotation_vector(Vector3(0, 0, 1)), Vector3(1, 2, 3)};
  OutputStatistics figures(cell, [&](int, Time time) { return moving_tool(cell, time); });
  PoseSample sample = sample_at(ms_after_start(10), TrackState::measured, Vector3::Zero(), 0.01);
  sample.frame = ReferenceFrame::robot;
  const Pose turned{from_rotation_vector(Vector3(0.03, 0, 0)), Vector3::Zero()};
  const Pose in_robot = cell.T_world_robot.inverse() * sample.pose;
  sample.pose = {turned.rotation * in_robot.rotation, in_robot.translation};
  figures.add(sample, ms_after_start(9));
  const OutputErrors& errors = figures.figures().tools[0][0].of_measured;
  EXPECT_NEAR(errors.square_m2, 0, 1e-20);
  EXPECT_NEAR(std::sqrt(errors.square_rad2), 0.03, 1e-9);
  EXPECT_EQ(errors.inside_rotation, 0u);  // 3 sigma
}

TEST(Quantile, IsTheBinThatHoldsTheShare) {
  const std::vector<std::uint64_t> counts{0, 5, 0, 4, 1};
  EXPECT_EQ(quantile(counts, 0.5), 1.5);
  EXPECT_EQ(quantile(counts, 0.51), 3.5);
  EXPECT_EQ(quantile(counts, 0.9), 3.5);
  EXPECT_EQ(quantile(counts, 1), 4.5);
  EXPECT_EQ(quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace glint
