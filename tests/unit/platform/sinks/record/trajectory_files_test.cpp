#include "platform/sinks/record/trajectory_files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "platform/input_error.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"

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

// Each field has a different value and must be under its own heading.
TEST(CsvFile, HasEachFieldUnderItsName) {
  PoseSample sample = sample_output(9, TrackState::predicted);
  sample.frame_sequence = 101;
  sample.tool = 3;
  sample.registration = RegistrationState::refused;
  sample.buttons = 6;
  sample.reason = Reason::imprecise;
  sample.registration_rms_m = 0.125;
  sample.velocity_m_s = {11, 12, 13};
  sample.angular_velocity_rad_s = {14, 15, 16};
  for (int i = 0; i < 36; ++i) sample.systematic(i / 6, i % 6) = 1000 + i;
  const TemporaryFolder folder;
  CsvFile file(folder.file("out.csv"));
  file.write(sample);
  ASSERT_TRUE(file.close());
  std::istringstream lines(text_of(folder.file("out.csv")));
  std::string names, values;
  std::getline(lines, names);
  std::getline(lines, values);
  std::istringstream name_list(names), value_list(values);
  std::map<std::string, std::string> row;
  for (std::string name, value; std::getline(name_list, name, ',');) {
    ASSERT_TRUE(std::getline(value_list, value, ',')) << name;
    EXPECT_TRUE(row.emplace(name, value).second) << name;
  }
  EXPECT_EQ(row.at("tick_s"), "0.036000000");
  EXPECT_EQ(row.at("measurement_s"), "0.025000000");
  EXPECT_EQ(row.at("tick_number"), "9");
  EXPECT_EQ(row.at("frame_sequence"), "101");
  EXPECT_EQ(row.at("tool"), "3");
  EXPECT_EQ(row.at("state"), "predicted");
  EXPECT_EQ(row.at("reason"), "imprecise");
  EXPECT_EQ(row.at("registration"), "refused");
  EXPECT_EQ(row.at("frame"), "robot");
  EXPECT_EQ(row.at("marker_mask"), "47");
  EXPECT_EQ(row.at("buttons"), "6");
  const auto number = [&row](const std::string& name) { return std::stod(row.at(name)); };
  EXPECT_EQ(number("registration_rms_m"), 0.125);
  EXPECT_EQ(number("sigma_position_m"), sample.sigma_position_m);
  EXPECT_EQ(number("sigma_orientation_rad"), sample.sigma_orientation_rad);
  for (int axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    EXPECT_EQ(number(letter + "_m"), sample.pose.translation[axis]);
    EXPECT_EQ(number("v" + letter + "_m_s"), sample.velocity_m_s[axis]);
    EXPECT_EQ(number("w" + letter + "_rad_s"), sample.angular_velocity_rad_s[axis]);
  }
  for (int part = 0; part < 4; ++part)
    EXPECT_EQ(number("q" + std::string(1, "xyzw"[part])), sample.pose.rotation.coeffs()[part]);
  for (int i = 0; i < 36; ++i) {
    const std::string place = "c" + std::to_string(i / 6 + 1) + std::to_string(i % 6 + 1);
    EXPECT_EQ(number(place), sample.covariance(i / 6, i % 6)) << place;
    EXPECT_EQ(number("systematic_" + place), sample.systematic(i / 6, i % 6)) << place;
  }
}

TEST(CsvFile, NamesEveryStateAndNoValueThatIsNone) {
  const TemporaryFolder folder;
  CsvFile file(folder.file("out.csv"));
  for (int i = 0; i < 5; ++i) {
    PoseSample sample;
    sample.state = static_cast<TrackState>(i);
    sample.registration = static_cast<RegistrationState>(i);
    sample.frame = static_cast<ReferenceFrame>(i);
    file.write(sample);
  }
  ASSERT_TRUE(file.close());
  const std::string text = text_of(folder.file("out.csv"));
  for (const char* row :
       {",none,no_frame_yet,none,camera,", ",predicted,no_frame_yet,given,world,",
        ",measured,no_frame_yet,accepted,robot,", ",lost,no_frame_yet,refused,unknown,",
        ",unknown,no_frame_yet,unknown,unknown,"}) {
    EXPECT_NE(text.find(row), std::string::npos) << row;
  }
}

TEST(FramePoseLine, HasNoStandardDeviationBelowZero) {
  FramePose pose;
  pose.state = TrackState::measured;
  pose.covariance.diagonal() << -1, 4, -1e-20, 9, -4, 16;
  EXPECT_TRUE(frame_pose_line(pose).ends_with(",0,0,0,1,0,2,0,3,0,4")) << frame_pose_line(pose);
}

TEST(TumLine, HoldsEveryTimeThatAnInt64Does) {
  const std::string pose = " 0 0 0 0 0 0 1";
  EXPECT_EQ(tum_line(Time{INT64_MIN}, {}), "-9223372036.854775808" + pose);
  EXPECT_EQ(tum_line(Time{INT64_MAX}, {}), "9223372036.854775807" + pose);
  EXPECT_EQ(tum_line(Time{0}, {}), "0.000000000" + pose);
  EXPECT_EQ(tum_line(Time{-1'000'000'000}, {}), "-1.000000000" + pose);
  EXPECT_EQ(points_line(Time{1'000'000'010}, {-1.5, 2, 1e-9}), "1.000000010,-1.5,2,1e-09");
}

// Lines are buffered up to 64 KiB, each with its newline.
TEST(TrajectoryLines, GoToTheDiskInPiecesAndAfterTheCloseNowhere) {
  const TemporaryFolder folder;
  const std::string path = folder.file("lines.txt");
  TrajectoryLines lines(path);
  const auto on_disk = [&] { return std::filesystem::file_size(path + ".part"); };
  for (int i = 0; i < 1023; ++i) lines.add(std::string(63, 'x'));
  EXPECT_EQ(on_disk(), 0u);
  lines.add(std::string(62, 'x'));
  EXPECT_EQ(on_disk(), 0u) << "a byte is missing";
  lines.add("");
  EXPECT_EQ(on_disk(), 65'536u);
  lines.add("last");
  EXPECT_FALSE(lines.failed());
  EXPECT_TRUE(lines.close());
  EXPECT_EQ(std::filesystem::file_size(path), 65'541u);
  lines.add("too late");
  EXPECT_TRUE(lines.close());
  EXPECT_EQ(lines.lines_lost(), 0u);
  EXPECT_EQ(lines.error(), "");
  EXPECT_EQ(std::filesystem::file_size(path), 65'541u);
}

TEST(TrajectoryLines, ThatGotNoNameFailedForGood) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("in"));
  TrajectoryLines lines(folder.file("in/lines.txt"));
  lines.add("one");
  std::filesystem::remove_all(folder.file("in"));
  EXPECT_FALSE(lines.close());
  EXPECT_TRUE(lines.failed());
  EXPECT_FALSE(lines.close()) << "again";
  EXPECT_NE(lines.error().find("rename"), std::string::npos) << lines.error();
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
