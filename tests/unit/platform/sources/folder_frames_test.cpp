#include "platform/sources/folder_frames.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "platform/input_error.hpp"
#include "tests/unit/platform/runtime/session/short_run.hpp"

namespace glint {
namespace {

class FolderFramesTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) const {
    std::ofstream(std::filesystem::path(folder_.path()) / name, std::ios::binary) << bytes;
  }
  // Images of 2 x 1 pixels.
  void write_pictures() const {
    write("a.pgm", std::string("P5 2 1 65535\n\x01\x02\x03\x04", 17));
    write("d.pgm", std::string("P5 2 1 65535\n\x00\x05\x00\x06", 17));
  }
  [[nodiscard]] std::string refusal() const {
    try {
      FolderFrames frames(folder_.path(), camera_);
      ReadFrame frame;
      while (frames.next(frame)) {
      }
      return frames.first_unreadable();
    } catch (const InputError& error) {
      return error.what();
    }
  }
  void expect_refusal(const std::string& csv, const std::string& part) const {
    write("frames.csv", csv);
    EXPECT_NE(refusal().find(part), std::string::npos) << csv << "\n" << refusal();
  }

  TemporaryFolder folder_;
  Camera camera_ = hololens2_ahat();
};

constexpr const char* k_heading = "time_ns,reflectivity,depth\n";

TEST_F(FolderFramesTest, ReadsAllColumnsInAnyOrder) {
  write_pictures();
  write("frames.csv",
        "depth,reflectivity,qw,qx,qy,qz,x_m,y_m,z_m,sequence,arrival_ns,time_ns\r\n"
        "d.pgm, a.pgm ,0.5,0.5,-0.5,0.5,1,2,3,0,1700000000000000009,1700000000000000007\r\n"
        "\n"
        "d.pgm,a.pgm,,,,,,,,7,,1700000000000000008");
  FolderFrames frames(folder_.path(), camera_);
  ReadFrame frame;
  ASSERT_TRUE(frames.next(frame));
  EXPECT_EQ(frame.mid_exposure.nanoseconds, 1'700'000'000'000'000'007);
  EXPECT_EQ(frame.arrival->nanoseconds, 1'700'000'000'000'000'009);
  EXPECT_EQ(frame.sequence, 0u);
  EXPECT_EQ(frame.pixels.width, 2);
  EXPECT_EQ(frame.pixels.height, 1);
  EXPECT_EQ(frame.pixels.reflectivity_16, (std::vector<std::uint16_t>{0x0102, 0x0304}));
  EXPECT_EQ(frame.pixels.depth, (std::vector<std::uint16_t>{5, 6}));
  EXPECT_TRUE(frame.head.valid);
  EXPECT_EQ(frame.head.T_world_camera.translation, Vector3(1, 2, 3));
  EXPECT_EQ(frame.head.T_world_camera.rotation.coeffs(), Quaternion(0.5, 0.5, -0.5, 0.5).coeffs());
  ASSERT_TRUE(frames.next(frame));
  EXPECT_FALSE(frame.head.valid);
  EXPECT_FALSE(frame.arrival);
  EXPECT_EQ(frame.sequence, 7u);
  EXPECT_FALSE(frames.next(frame));
  EXPECT_EQ(frames.unreadable(), 0u);
}

// Floats are in metres, whatever the camera's depth unit; an invalid depth becomes 0.
TEST_F(FolderFramesTest, ReadsDepthInMetresFromAnArrayOfFloats) {
  write_pictures();
  const std::string heading = "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }";
  std::string npy("\x93NUMPY\x01\x00", 8);
  const std::string padded = heading + std::string(117 - heading.size(), ' ') + "\n";
  npy += std::string("\x76\x00", 2) + padded;
  const float values[] = {0.5f, NAN};
  npy.append(reinterpret_cast<const char*>(values), sizeof values);
  write("d.npy", npy);
  write("frames.csv", std::string(k_heading) + "1,a.pgm,d.npy\n");
  camera_.depth.unit_m = 0.00025;
  FolderFrames frames(folder_.path(), camera_);
  ReadFrame frame;
  ASSERT_TRUE(frames.next(frame)) << frames.first_unreadable();
  EXPECT_EQ(frame.pixels.depth, (std::vector<std::uint16_t>{2000, 0}));
}

TEST_F(FolderFramesTest, GivesEightBitsToACameraOfEight) {
  write_pictures();
  write("b.pgm", "P5 2 1 255\n\xF0\x02");
  write("frames.csv", std::string(k_heading) + "1,b.pgm,d.pgm\n2,a.pgm,d.pgm\n");
  FolderFrames frames(folder_.path(), hololens1_short_throw());
  ReadFrame frame;
  ASSERT_TRUE(frames.next(frame)) << frames.first_unreadable();
  EXPECT_EQ(frame.pixels.reflectivity_8, (std::vector<std::uint8_t>{0xF0, 2}));
  EXPECT_TRUE(frame.pixels.reflectivity_16.empty());
  EXPECT_FALSE(frames.next(frame));
  EXPECT_NE(frames.first_unreadable().find("expected at most 255"), std::string::npos);
}

TEST_F(FolderFramesTest, SkipsAndCountsRowsThatCannotBeRead) {
  write_pictures();
  write("frames.csv", std::string(k_heading) + "1,a.pgm,d.pgm\nx,a.pgm,d.pgm\n3,no.pgm,d.pgm\n" +
                          "4,a.pgm\n5,a.pgm,d.pgm\n");
  FolderFrames frames(folder_.path(), camera_);
  ReadFrame frame;
  std::vector<std::int64_t> read;
  while (frames.next(frame)) read.push_back(frame.mid_exposure.nanoseconds);
  EXPECT_EQ(read, (std::vector<std::int64_t>{1, 5}));
  EXPECT_EQ(frames.unreadable(), 3u);
  EXPECT_NE(frames.first_unreadable().find("frames.csv:3: time_ns is \"x\"; expected an integer"),
            std::string::npos)
      << frames.first_unreadable();
}

TEST_F(FolderFramesTest, NamesWhatIsWrong) {
  write_pictures();
  write("c.pgm", "P5 1 1 255\nx");
  expect_refusal("", "frames.csv:1: column \"\"");
  expect_refusal("time_ns,depth\n", "no column reflectivity");
  expect_refusal("time_ns,depth,depth,reflectivity\n", "column \"depth\" twice");
  expect_refusal("time_ns,reflectivity,depth,color\n", "column \"color\"");
  expect_refusal("time_ns,reflectivity,depth,x_m\n", "no column y_m; expected all seven");
  expect_refusal("time_ns,reflectivity,depth,y_m\n", "no column");
  expect_refusal(std::string(k_heading) + "1,a.pgm,\n", "depth is empty");
  expect_refusal(std::string(k_heading) + "1,a.pgm,c.pgm\n", "size differs");
  expect_refusal("time_ns,reflectivity,depth,x_m,y_m,z_m,qx,qy,qz,qw\n1,a.pgm,d.pgm,1,2,3,,,,\n",
                 "3 numbers of a pose");
  std::filesystem::remove(std::filesystem::path(folder_.path()) / "frames.csv");
  EXPECT_NE(refusal().find("expected a folder with frames.csv"), std::string::npos) << refusal();
}

}  // namespace
}  // namespace glint
