#include "platform/record/trajectory_files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "platform/input_error.hpp"
#include "tests/unit/platform/record/recording_samples.hpp"

namespace glint {
namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(TumFile, HoldsTheTicksOfItsToolThatHaveAPose) {
  const TemporaryFolder folder;
  const std::string path = folder.file("pen.txt");
  TumFile file(path, 0);
  PoseSample sample = sample_output(250);
  sample.tick = {1'700'000'000'123'456'789};
  sample.pose.translation = {0.1, -0.25, 1e-7};
  file.write(sample);
  sample.tool = 1;
  file.write(sample);
  file.write(sample_output(251, TrackState::lost));
  PoseSample early = sample_output(0);
  early.tick = {-1};
  file.write(early);
  EXPECT_FALSE(std::filesystem::exists(path));
  ASSERT_TRUE(file.close());
  EXPECT_EQ(text_of(path),
            "1700000000.123456789 0.1 -0.25 1e-07 0.5 -0.5 0.5 0.5\n"
            "-0.000000001 0 -0.25 1.5 0.5 -0.5 0.5 0.5\n");
}

TEST(FramePoseLine, HasAValueUnderEveryHeadingOfAMeasuredTool) {
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  FramePose pose;
  pose.time = {1'700'000'000'123'456'789};
  pose.sequence = 7;
  pose.tool = "pen";
  pose.state = TrackState::measured;
  pose.frame = ReferenceFrame::world;
  pose.marker_mask = 31;
  pose.rms_m = 0.0005;
  pose.pose.translation = {0.1, -0.25, 1e-7};
  pose.covariance.diagonal() << 4, 9, 16, 0.25, 1, 0;
  EXPECT_EQ(frame_pose_line(pose),
            "1700000000.123456789,7,pen,measured,none,world,31,5e-04,0.1,-0.25,1e-07,0,0,0,1,"
            "2,3,4,0.5,1,0");
  EXPECT_EQ(commas(frame_pose_line(pose)), commas(frame_pose_heading()));
  pose.state = TrackState::lost;
  pose.reason = Reason::bad_fit;
  EXPECT_TRUE(frame_pose_line(pose).starts_with("1700000000.123456789,7,pen,lost,bad_fit,,"));
  EXPECT_EQ(commas(frame_pose_line(pose)), commas(frame_pose_heading()));
}

TEST(CsvFile, HasAValueUnderEveryHeading) {
  const TemporaryFolder folder;
  const std::string path = folder.file("out.csv");
  CsvFile file(path);
  file.write(sample_output(5));
  file.write(sample_output(6, TrackState::lost));
  ASSERT_TRUE(file.close());
  std::istringstream lines(text_of(path));
  std::string heading, with_pose, without_pose;
  std::getline(lines, heading);
  std::getline(lines, with_pose);
  std::getline(lines, without_pose);
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  EXPECT_EQ(commas(heading), 98);
  EXPECT_EQ(commas(with_pose), commas(heading));
  EXPECT_EQ(commas(without_pose), commas(heading));
  EXPECT_EQ(with_pose.find("0.020000000,0.009000000,5,1,0,measured,none,none,robot,47,0,0,0.005,"
                           "-0.25,1.5,0.5,-0.5,0.5,0.5,"),
            0U)
      << with_pose;
  EXPECT_EQ(without_pose.find("0.024000000,0.013000000,6,1,0,lost,none,none,robot,47,0,0,,,"), 0U)
      << without_pose;
}

TEST(TumFile, ThatCannotBeWrittenSaysSoAndGoesOn) {
  EXPECT_THROW(TumFile("/nowhere/at/all/pen.txt"), InputError);
  const TemporaryFolder folder;
  const std::string path = folder.file("pen.txt");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = 100'000;
  ::setrlimit(RLIMIT_FSIZE, &small);
  TumFile file(path);
  for (std::uint32_t i = 0; i < 5000; ++i) file.write(sample_output(i));
  const bool closed = file.close();
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(closed);
  EXPECT_TRUE(file.file().failed());
  EXPECT_NE(file.file().error().find("File too large"), std::string::npos) << file.file().error();
}

}  // namespace
}  // namespace glint
