#include "platform/formats/trajectory.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "platform/input_error.hpp"

namespace glint {
namespace {

std::string message_of(const std::string& text) {
  try {
    (void)trajectory_from_text(text, "pen.txt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

void expect_refused(const std::string& text, const std::string& place, const std::string& found) {
  const std::string message = message_of(text);
  EXPECT_EQ(message.rfind(place, 0), 0u) << message;
  EXPECT_NE(message.find(found), std::string::npos) << message;
  EXPECT_NE(message.find("expected"), std::string::npos) << message;
}

TEST(TrajectoryFile, ReadsTumText) {
  const Trajectory read = trajectory_from_text(
      "# timestamp tx ty tz qx qy qz qw\n10.5 1 2 3 0 0 0 1\n\n10.75 -1 2e-1 3 1 0 0 0\r\n", "a");
  ASSERT_EQ(read.samples.size(), 2u);
  EXPECT_EQ(read.samples[0].time.nanoseconds, 0);
  EXPECT_EQ(read.samples[1].time.nanoseconds, 250'000'000);
  EXPECT_EQ(read.samples[1].pose.translation, Vector3(-1, 0.2, 3));
  EXPECT_EQ(read.samples[1].pose.rotation.x(), 1);
  EXPECT_EQ(read.samples[1].pose.rotation.w(), 0);
}

TEST(TrajectoryFile, ReadsEurocCsvWithItsOtherOrderAndFurtherColumns) {
  const Trajectory read = trajectory_from_text(
      "#timestamp, p_x\n1403715888379057920,1,2,3,0,0,0,1,9,9\n"
      "1403715888384058112, 1, 2, 4, 0, 0, 0, 1, 9, 9\n",
      "a");
  ASSERT_EQ(read.samples.size(), 2u);
  EXPECT_EQ(read.samples[1].time.nanoseconds, 5'000'192);
  EXPECT_EQ(read.samples[1].pose.translation.z(), 4);
  EXPECT_EQ(read.samples[0].pose.rotation.z(), 1);
  EXPECT_EQ(read.samples[0].pose.rotation.w(), 0);
}

TEST(TrajectoryFile, RefusesTextWithItsLine) {
  expect_refused("0 1 2 3 0 0 0 1\n1 1 2 three 0 0 0 1\n", "pen.txt:2:", "'three'");
}

TEST(TrajectoryFile, RefusesNan) {
  expect_refused("# head\n0 1 nan 3 0 0 0 1\n1 1 2 3 0 0 0 1\n", "pen.txt:2:", "'nan'");
  expect_refused("0 1 inf 3 0 0 0 1\n1 1 2 3 0 0 0 1\n", "pen.txt:1:", "'inf'");
}

TEST(TrajectoryFile, RefusesBackwardAndEqualStamps) {
  expect_refused("1 1 2 3 0 0 0 1\n0.5 1 2 3 0 0 0 1\n", "pen.txt:2:", "stamp");
  expect_refused("1 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n", "pen.txt:2:", "stamp");
}

TEST(TrajectoryFile, RefusesStampsWhoseDifferenceOverflows) {
  expect_refused("-8e9 1 2 3 0 0 0 1\n8e9 1 2 3 0 0 0 1\n", "pen.txt:1:", "stamp");
}

TEST(TrajectoryFile, RefusesMissingColumns) {
  expect_refused("0 1 2 3 0 0 0\n1 1 2 3 0 0 0 1\n", "pen.txt:1:", "column 8");
  expect_refused("0,1,2,3,1,0,0\n", "pen.txt:1:", "column 8");
}

TEST(TrajectoryFile, RefusesAQuaternionThatIsNone) {
  expect_refused("0 1 2 3 0 0 0 0.5\n1 1 2 3 0 0 0 1\n", "pen.txt:1:", "quaternion");
}

TEST(TrajectoryFile, RefusesAnEmptyFileAndASingleSample) {
  expect_refused("", "pen.txt:0:", "0 samples");
  expect_refused("0 1 2 3 0 0 0 1\n", "pen.txt:1:", "1 samples");
}

TEST(TrajectoryFile, RefusesOneThatIsNotThere) {
  EXPECT_THROW((void)load_trajectory("/nowhere/pen.txt"), InputError);
}

Trajectory parabola() {
  Trajectory path;
  for (int i = 0; i <= 10; ++i) {
    const std::int64_t ns = i * 50'000'000LL + (i % 2) * 15'000'000LL;  // irregular steps
    const double t = static_cast<double>(ns) * 1e-9;
    path.samples.push_back({Time{ns}, {from_rotation_vector({0, 0, t}), Vector3(t, t * t, 1)}});
  }
  return path;
}

TEST(Trajectory, FollowsAParabolaBetweenItsSamples) {
  const Trajectory path = parabola();
  for (int i = 0; i < 40; ++i) {
    const double t = 0.07 + 0.009 * i;
    const Pose pose = interpolated(path, Time{70'000'000 + i * 9'000'000LL});
    EXPECT_NEAR(pose.translation.x(), t, 1e-12);
    EXPECT_NEAR(pose.translation.y(), t * t, 1e-12);
    EXPECT_NEAR(rotation_vector(pose.rotation).z(), t, 1e-12);
  }
}

TEST(Trajectory, RunsBackFromItsEndWithoutAJump) {
  const Trajectory path = parabola();
  for (const std::int64_t beyond : {1'000'000LL, 37'000'000LL, 420'000'000LL}) {
    const Pose after = interpolated(path, Time{500'000'000 + beyond});
    const Pose before = interpolated(path, Time{500'000'000 - beyond});
    EXPECT_EQ(after.translation, before.translation);
    EXPECT_EQ(interpolated(path, Time{-beyond}).translation,
              interpolated(path, Time{beyond}).translation);
  }
}

TEST(Trajectory, ReadsTheRealRecordings) {
  const char* folder = std::getenv("GLINT_TEST_DATA");
  const std::string path = std::string(folder ? folder : "") + "/trajectories/";
  if (!folder || !std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  for (const char* name : {"euroc_V1_03_difficult.csv", "rpng_table_01.csv",
                           "tum_fr1_xyz_groundtruth.txt", "tumvi_room1.csv"}) {
    const Trajectory read = load_trajectory(path + name);
    EXPECT_GT(read.samples.size(), 1000u) << name;
    EXPECT_GT(read.length(), milliseconds(20'000)) << name;
  }
}

}  // namespace
}  // namespace glint
