#include "platform/tools/reference/touched_base.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "kernels/pose/lever_arm.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "platform/tools/reference/touched_points.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/platform/tools/programming/strokes.hpp"

namespace glint {
namespace {

using Random = std::mt19937_64;

Vector3 normal_vector(Random& random, double sigma) {
  std::normal_distribution<double> normal(0, sigma);
  const double x = normal(random), y = normal(random);
  return {x, y, normal(random)};
}

Quaternion any_rotation(Random& random) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random);
  return Quaternion(w, x, y, normal(random)).normalized();
}

Pose any_pose(Random& random) { return {any_rotation(random), normal_vector(random, 1)}; }

// Points in a box of 0.6 m, at least 0.2 m from a common line.
std::vector<TouchedPoint> any_points(Random& random, int count) {
  std::uniform_real_distribution<double> side(-0.3, 0.3);
  std::vector<TouchedPoint> points(static_cast<std::size_t>(count));
  do {
    for (TouchedPoint& point : points) {
      const double x = side(random), y = side(random);
      point.known_m = {x, y, side(random)};
      point.own_m2 = 1e-6 * Matrix3::Identity();
    }
  } while (
      (points[1].known_m - points[0].known_m).cross(points[2].known_m - points[0].known_m).norm() <
      0.04);
  return points;
}

void touch(std::vector<TouchedPoint>& points, const Pose& truth, Random& random, double sigma_m) {
  for (TouchedPoint& point : points) {
    point.tip_m = truth * point.known_m + normal_vector(random, sigma_m);
  }
}

// Squared error in its covariance: chi-square of six degrees of freedom if the covariance is true.
double squared_error(const TouchedBase& found, const Pose& truth) {
  const Eigen::AngleAxisd turn(found.T_frame_base.rotation * truth.rotation.conjugate());
  Eigen::Matrix<double, 6, 1> error;
  error << found.T_frame_base.translation - truth.translation, turn.angle() * turn.axis();
  return error.dot(found.covariance.inverse() * error);
}

constexpr double k_chi_square_95 = 12.592;  // of six degrees of freedom

std::string message_of(const std::vector<TouchedPoint>& points) {
  try {
    (void)touched_base(points, "points.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(TouchedBase, FindsThePoseOfExactTouches) {
  Random random(71);
  for (int i = 0; i < 50; ++i) {
    const Pose truth = any_pose(random);
    std::vector<TouchedPoint> points = any_points(random, 3 + i % 5);
    touch(points, truth, random, 0);
    const TouchedBase found = touched_base(points, "points.toml");
    EXPECT_LT((found.T_frame_base.translation - truth.translation).norm(), 1e-12);
    EXPECT_LT(found.T_frame_base.rotation.angularDistance(truth.rotation), 1e-7);
    EXPECT_TRUE(found.reason.empty()) << found.reason;
  }
}

class TouchedBaseOf : public testing::TestWithParam<int> {};

TEST_P(TouchedBaseOf, ErrsWithinItsEllipsoidAndIsSeldomRefused) {
  Random random(static_cast<std::uint64_t>(8000 + GetParam()));
  int inside = 0, refused = 0;
  for (int run = 0; run < 1000; ++run) {
    const Pose truth = any_pose(random);
    std::vector<TouchedPoint> points = any_points(random, GetParam());
    touch(points, truth, random, 1e-3);
    const TouchedBase found = touched_base(points, "points.toml");
    inside += squared_error(found, truth) <= k_chi_square_95 ? 1 : 0;
    refused += found.reason.empty() ? 0 : 1;
  }
  RecordProperty("inside_per_mille", inside);
  EXPECT_GE(inside, 920);
  EXPECT_LE(inside, 980);
  EXPECT_LE(refused, 8);  // 1 in 1000 by its limit; more than 8 once in a million
}

INSTANTIATE_TEST_SUITE_P(Points, TouchedBaseOf, testing::Values(3, 6));

// A touch along a ray errs most in depth; the tracker's systematic error shifts all of them.
TEST(TouchedBase, StatesUnequalAndSharedErrors) {
  Random random(72);
  int inside = 0;
  for (int run = 0; run < 1000; ++run) {
    const Pose truth = any_pose(random);
    std::vector<TouchedPoint> points = any_points(random, 4);
    const Vector3 shared = normal_vector(random, 2e-3);
    for (TouchedPoint& point : points) {
      const Matrix3 axes = any_rotation(random).toRotationMatrix();
      const Vector3 sigma(5e-4, 5e-4, 4e-3);
      point.own_m2 = axes * sigma.cwiseAbs2().asDiagonal() * axes.transpose();
      point.shared_m2 = 4e-6 * Matrix3::Identity();
      point.tip_m =
          truth * point.known_m + shared + axes * sigma.cwiseProduct(normal_vector(random, 1));
    }
    inside += squared_error(touched_base(points, "points.toml"), truth) <= k_chi_square_95 ? 1 : 0;
  }
  EXPECT_GE(inside, 930);
  EXPECT_LE(inside, 970);
}

TEST(TouchedBase, RefusesAnotherOrderAndNamesAPoint) {
  Random random(73);
  std::vector<TouchedPoint> points = any_points(random, 4);
  for (std::size_t i = 0; i < points.size(); ++i) points[i].name = "bolt " + std::to_string(i + 1);
  touch(points, any_pose(random), random, 1e-3);
  std::swap(points[0].tip_m, points[1].tip_m);
  const TouchedBase found = touched_base(points, "points.toml");
  EXPECT_NE(found.reason.find("the touches do not fit the known points: bolt "), std::string::npos);
  EXPECT_NE(found.reason.find("in the order of the touches"), std::string::npos);
}

// Errors of three times their stated standard deviation: chi-square is 108 on average, and 33 the
// limit.
TEST(TouchedBase, RefusesTouchesThatErrMoreThanStated) {
  Random random(77);
  int refused = 0;
  for (int run = 0; run < 200; ++run) {
    std::vector<TouchedPoint> points = any_points(random, 6);
    touch(points, any_pose(random), random, 3e-3);
    refused += touched_base(points, "points.toml").reason.empty() ? 0 : 1;
  }
  EXPECT_GE(refused, 190);
}

TEST(TouchedBase, RefusesAPoseThatTheTouchesLeaveUncertain) {
  Random random(74);
  std::vector<TouchedPoint> points = any_points(random, 3);
  for (TouchedPoint& point : points) {
    point.known_m *= 0.05;  // some 20 mm apart
    point.own_m2 *= 4;
  }
  touch(points, any_pose(random), random, 1e-4);
  EXPECT_NE(touched_base(points, "points.toml").reason.find("farther apart"), std::string::npos);
}

TEST(TouchedBase, NamesWhatTheFileLacks) {
  Random random(75);
  std::vector<TouchedPoint> points = any_points(random, 3);
  touch(points, any_pose(random), random, 0);
  std::vector<TouchedPoint> two(points.begin(), points.begin() + 2);
  EXPECT_EQ(message_of(two), "points.toml: 2 points; expected 3 to 1000");
  std::vector<TouchedPoint> line = points;
  line[2].known_m = 0.5 * (line[0].known_m + line[1].known_m);
  line[2].tip_m = 0.5 * (line[0].tip_m + line[1].tip_m);
  EXPECT_NE(message_of(line).find("the points lie on a line"), std::string::npos);
  points[1].tip_m.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of(points).find("not finite"), std::string::npos);
}

// A recording of three touches by the cell's first tool; its tips err by 0.1 mm within a touch.
class TouchRecording : public testing::Test {
 protected:
  void write(const std::vector<ButtonEvent>& events, ReferenceFrame frame = ReferenceFrame::robot,
             TrackState state = TrackState::measured, double slide_m = 0) {
    RecordingInfo info = sample_info(RecordingLevel::outputs);
    info.attachments = attachments_of(cell_);
    RecordingWriter writer(file_, info);
    Matrix6 robot = Matrix6::Zero();
    robot.diagonal() << Vector3::Constant(cell_.robot_sigma_m * cell_.robot_sigma_m),
        Vector3::Constant(cell_.robot_sigma_rad * cell_.robot_sigma_rad);
    for (int tick = 0; tick < 750; ++tick) {
      const TouchedPoint& point = points_[static_cast<std::size_t>(tick / 250)];
      Vector3 tip = truth_ * point.known_m + 1e-4 * Vector3(tick % 2 == 0 ? 1 : -1, 0, 0) +
                    slide_m / 250 * (tick % 250) * Vector3::UnitZ();
      if (frame == ReferenceFrame::robot) tip = cell_.T_world_robot.inverse() * tip;
      PoseSample sample = tip_at(4.0 * tick, tip);
      sample.frame = frame;
      sample.state = state;
      sample.systematic.setZero();
      sample.systematic.topLeftCorner<3, 3>() = 4e-6 * Matrix3::Identity();
      if (frame == ReferenceFrame::robot) sample.systematic += moved_covariance(robot, tip);
      sample.covariance = sample.systematic + 9e-8 * Matrix6::Identity();
      writer.write_output(sample, record_of(sample));
    }
    for (const ButtonEvent& event : events) writer.write_button(event);
  }

  std::string message() {
    try {
      std::vector<TouchedPoint> points = points_;
      (void)set_tips(points, file_, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }

  void expect_tips(double rotated_m2) {
    std::vector<TouchedPoint> points = points_;
    const RecordedTouches recorded = set_tips(points, file_, {});
    EXPECT_FALSE(recorded.in_reference);
    for (const TouchedPoint& point : points) {
      EXPECT_LT((point.tip_m - truth_ * point.known_m).norm(), 2e-5);
      EXPECT_LT((point.own_m2 - (1e-6 + 9e-8) * Matrix3::Identity()).norm(), 1e-12);
      EXPECT_LT((point.shared_m2 - rotated_m2 * Matrix3::Identity()).norm(), 1e-9);
    }
  }

  Random random_{76};
  Cell cell_ = default_cell();
  Pose truth_ = any_pose(random_);
  std::vector<TouchedPoint> points_ = any_points(random_, 3);
  TemporaryFolder folder_;
  std::string file_ = folder_.file("run.mcap");
  const std::vector<ButtonEvent> presses_ = {down(200), up(800),    down(1200),
                                             up(1800),  down(2100), up(2350)};
};

TEST_F(TouchRecording, GivesTheTipsInTheWorldWithoutTheEarlierRobotPose) {
  write(presses_);
  expect_tips(4e-6);
  write(presses_, ReferenceFrame::world);
  expect_tips(4e-6);
}

TEST_F(TouchRecording, LeavesOutTouchesThatWereDeleted) {
  std::vector<ButtonEvent> events = presses_;
  events.insert(events.begin() + 2,
                {down(850), up(900), down(910, Button::delete_last), up(920, Button::delete_last)});
  write(events);
  expect_tips(4e-6);
}

TEST_F(TouchRecording, NamesTheTouchThatIsMissingOrMoved) {
  write({down(200), up(800), down(1200), up(1800)});
  EXPECT_NE(message().find(": 2 touches; expected 3"), std::string::npos);
  write(presses_, ReferenceFrame::robot, TrackState::predicted);
  EXPECT_NE(message().find("touch 1 at 0.200 s: no measured pose"), std::string::npos);
  write(presses_, ReferenceFrame::camera);
  EXPECT_NE(message().find("touch 1 at 0.200 s: a pose in the camera's frame"), std::string::npos);
  write(presses_, ReferenceFrame::robot, TrackState::measured, 0.02);
  EXPECT_NE(message().find("touch 1 at 0.200 s: the tip moved by"), std::string::npos);
}

}  // namespace
}  // namespace glint
