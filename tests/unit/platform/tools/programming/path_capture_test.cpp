#include "platform/tools/programming/path_capture.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "kernels/motion/interpolate.hpp"
#include "platform/input_error.hpp"
#include "tests/unit/platform/tools/programming/strokes.hpp"

namespace glint {
namespace {

TEST(PathCapture, MakesAStrokeOfWhatIsDrawnWhileTheButtonIsHeld) {
  PathCapture capture({});
  capture.add(tip_at(0, {9, 9, 9}));
  draw_line(capture, 1000, 2000);
  capture.add(tip_at(2500, {9, 9, 9}));
  const DrawnPath path = capture.path();
  ASSERT_EQ(path.size(), 1u);
  EXPECT_EQ(path[0].kind, PathKind::stroke);
  ASSERT_EQ(path[0].points.size(), 51u);  // 100 mm, a point every 2 mm
  EXPECT_EQ(path[0].points.front().time, at_ms(1000));
  EXPECT_EQ(path[0].points.back().time, at_ms(2000));
  EXPECT_NEAR(path[0].points[10].pose.translation.x(), 0.02, 1e-12);
  EXPECT_EQ(capture.counts().poses, 251);
  EXPECT_EQ(capture.counts().poses_accepted, 251);
}

TEST(PathCapture, MakesAWaypointOfAClickWhereTheTipWasAsItBegan) {
  PathCapture capture({});
  // The press moves the pen by 3 mm.
  draw(capture, 1000, 1200, [](double ms) { return Vector3(0.1, 0.003 * (ms - 1000) / 200, 0); });
  const DrawnPath path = capture.path();
  ASSERT_EQ(path.size(), 1u);
  EXPECT_EQ(path[0].kind, PathKind::waypoint);
  ASSERT_EQ(path[0].points.size(), 1u);
  EXPECT_EQ(path[0].points[0].pose.translation, Vector3(0.1, 0, 0));
}

TEST(PathCapture, TellsAQuickDashFromAClickAndALongRestFromAStroke) {
  PathCapture capture({});
  draw_line(capture, 1000, 1200);  // 20 mm in 200 ms
  draw(capture, 3000, 5000, [](double) { return Vector3(0.1, 0, 0); });
  const DrawnPath path = capture.path();
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0].kind, PathKind::stroke);
  EXPECT_EQ(path[1].kind, PathKind::waypoint);
  EXPECT_EQ(path[1].points.size(), 1u);
}

TEST(PathCapture, TakesNoPoseThatIsNotMeasuredOrNotInTheRobotsFrameAndCountsIt) {
  PathCapture capture({});
  capture.add(down(0));
  for (int i = 0; i <= 100; ++i) {
    PoseSample sample = tip_at(4.0 * i, {0.001 * i, 0, 0});
    if (i % 5 == 1) sample.state = TrackState::predicted;
    if (i % 5 == 2) sample.frame = ReferenceFrame::world;
    if (i % 5 == 3) sample.pose.translation.x() = std::numeric_limits<double>::quiet_NaN();
    capture.add(sample);
  }
  capture.add(up(400));
  EXPECT_EQ(capture.counts().poses, 101);
  EXPECT_EQ(capture.counts().not_measured, 20);
  EXPECT_EQ(capture.counts().not_in_robot, 20);
  EXPECT_EQ(capture.counts().not_usable, 20);
  EXPECT_EQ(capture.counts().poses_accepted, 41);
  const DrawnPath path = capture.path();
  ASSERT_EQ(path.size(), 1u);
  for (const UncertainPose& point : path[0].points) {
    EXPECT_TRUE(point.pose.translation.allFinite());
  }
}

TEST(PathCapture, BeginsAnotherStrokeWhereThePenWasLost) {
  PathCapture capture({});
  capture.add(down(0));
  for (int i = 0; i <= 250; ++i) {
    PoseSample sample = tip_at(4.0 * i, {0.0005 * i, 0, 0});
    if (i > 100 && i < 150) sample.state = TrackState::lost;
    capture.add(sample);
  }
  capture.add(up(1000));
  EXPECT_EQ(capture.counts().gaps, 1);
  const DrawnPath path = capture.path();
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[0].points.back().time, at_ms(400));
  EXPECT_EQ(path[1].points.front().time, at_ms(600));
}

TEST(PathCapture, DeletesTheLastAndTakesChangesBack) {
  PathCapture capture({});
  click(capture, 0, {1, 0, 0});
  draw_line(capture, 1000, 2000);
  click(capture, 3000, {3, 0, 0});
  ASSERT_EQ(capture.path().size(), 3u);
  press(capture, 4000, Button::delete_last);  // the click at 3 s
  press(capture, 4100, Button::delete_last);  // the stroke
  ASSERT_EQ(capture.path().size(), 1u);
  press(capture, 4200, Button::undo);  // restores the stroke
  ASSERT_EQ(capture.path().size(), 2u);
  EXPECT_EQ(capture.path()[1].points.size(), 51u);
  click(capture, 5000, {5, 0, 0});
  press(capture, 6000, Button::undo);  // removes the click at 5 s
  press(capture, 6100, Button::undo);  // restores the click at 3 s
  ASSERT_EQ(capture.path().size(), 3u);
  EXPECT_EQ(capture.path()[2].points[0].pose.translation.x(), 3);
  for (int i = 0; i < 3; ++i) press(capture, 7000 + 100 * i, Button::undo);
  EXPECT_TRUE(capture.path().empty());
  EXPECT_EQ(capture.counts().presses_without_effect, 0);
  press(capture, 8000, Button::undo);
  press(capture, 8100, Button::delete_last);
  EXPECT_EQ(capture.counts().presses_without_effect, 2);
}

TEST(PathCapture, ChangesNothingBehindAStrokeThatIsUnderWay) {
  PathCapture capture({});
  click(capture, 0, {1, 0, 0});
  capture.add(down(1000));
  capture.add(tip_at(1000, {0, 0, 0}));
  press(capture, 1001, Button::delete_last);
  press(capture, 1002, Button::undo);
  EXPECT_EQ(capture.path().size(), 1u);
  EXPECT_EQ(capture.counts().presses_without_effect, 2);
}

TEST(PathCapture, EndsAtFinishWithTheStrokeThatIsHeld) {
  PathCapture capture({});
  capture.add(down(0));
  for (int i = 0; i <= 100; ++i) capture.add(tip_at(4.0 * i, {0.0005 * i, 0, 0}));
  press(capture, 400, Button::finish);
  EXPECT_TRUE(capture.finished());
  ASSERT_EQ(capture.path().size(), 1u);
  const std::int64_t after = capture.counts().inputs_after_finish;
  draw_line(capture, 1000, 2000);
  EXPECT_EQ(capture.path().size(), 1u);
  EXPECT_EQ(capture.counts().inputs_after_finish, after + 253);
}

TEST(PathCapture, CountsWhatDoesNotFit) {
  CaptureSettings settings;
  settings.points_max = 60;
  settings.elements_max = 2;
  PathCapture capture(settings);
  draw_line(capture, 0, 1000);
  draw_line(capture, 2000, 3000);
  click(capture, 4000, {1, 0, 0});
  EXPECT_EQ(capture.counts().points_over_capacity, 51 - 9 + 1);  // no capacity for the click either
  const DrawnPath path = capture.path();
  ASSERT_EQ(path.size(), 2u);
  EXPECT_EQ(path[1].points.size(), 9u);
  CaptureSettings few;
  few.elements_max = 1;
  PathCapture small(few);
  click(small, 0, {1, 0, 0});
  click(small, 1000, {2, 0, 0});
  EXPECT_EQ(small.counts().strokes_over_capacity, 1);
  ASSERT_EQ(small.path().size(), 1u);
  EXPECT_EQ(small.path()[0].points[0].pose.translation.x(), 1);
}

TEST(PathCapture, CountsAPressWithoutAPose) {
  PathCapture capture({});
  capture.add(down(0));
  capture.add(up(1));
  capture.add(up(2));  // already released
  EXPECT_EQ(capture.counts().presses_without_effect, 1);
  EXPECT_TRUE(capture.path().empty());
}

TEST(PathCapture, RefusesSettingsByName) {
  for (const auto& change : {+[](CaptureSettings& s) { s.stroke.spacing_m = 0; },
                             +[](CaptureSettings& s) { s.click_radius_m = -1; },
                             +[](CaptureSettings& s) { s.points_max = 0; },
                             +[](CaptureSettings& s) { s.elements_max = 1 << 30; }}) {
    CaptureSettings settings;
    change(settings);
    EXPECT_THROW(PathCapture{settings}, InputError);
  }
}

// An arc drawn with the tracker's noise as its covariance states it.
TEST(PathCapture, GivesAStrokeBackWithinItsCovariance) {
  test::Random random(11);
  double sum = 0;
  std::size_t points = 0;
  const auto truth = [](double ms) {
    const SineCosine s = sine_cosine(0.003 * ms);
    return Pose{from_rotation_vector(Vector3(0.4 * s.sine, 0.2, 0.3 * s.cosine)),
                Vector3(0.05 * s.cosine, 0.05 * s.sine, 0.01 * s.sine)};
  };
  for (int stroke = 0; stroke < 60; ++stroke) {
    PathCapture capture({});
    capture.add(down(0));
    const Vector3 off = random.vector(4e-4), turn = random.vector(4e-3);  // correlated error
    for (double ms = 0; ms <= 1500; ms += 4) {
      PoseSample sample = tip_at(ms, truth(ms).translation + off + random.vector(2e-4));
      sample.pose.rotation =
          (from_rotation_vector(turn + random.vector(2e-3)) * truth(ms).rotation).normalized();
      sample.covariance.setZero();
      for (int i = 0; i < 6; ++i) sample.covariance(i, i) = i < 3 ? 2e-7 : 2e-5;
      capture.add(sample);
    }
    capture.add(up(1500));
    const DrawnPath path = capture.path();
    for (const UncertainPose& point : path.at(0).points) {
      const Pose there = truth(static_cast<double>(point.time.nanoseconds) * 1e-6);
      Eigen::Matrix<double, 6, 1> error;
      error << point.pose.translation - there.translation,
          rotation_vector(point.pose.rotation * there.rotation.conjugate());
      sum += error.dot(point.covariance.llt().solve(error));
      ++points;
    }
  }
  // 6 would be the NEES of the raw covariance. A fifth of the variance is white; interpolation
  // between two samples leaves two thirds of it: 5.6. The correlated part leaves 60 strokes with
  // 360 independent squares.
  EXPECT_NEAR(sum / static_cast<double>(points), 5.6, 1.2);
}

}  // namespace
}  // namespace glint
