// Headset captures: tar archives, StreamRecorder's folders, hl2ss's files, matrices as poses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "platform/input_error.hpp"
#include "platform/sources/file_time.hpp"
#include "platform/sources/hl2ss_frames.hpp"
#include "platform/sources/hl2ss_wire.hpp"
#include "platform/sources/matrix_pose.hpp"
#include "platform/sources/stream_recorder_frames.hpp"
#include "platform/sources/tar_file.hpp"
#include "tests/unit/platform/formats/temporary_folder.hpp"

namespace glint {
namespace {

// One POSIX ustar header and the contents, padded to whole blocks.
std::string tar_of(const std::string& name, const std::string& contents, char type = '0') {
  std::string header(512, '\0');
  std::copy_n(name.begin(), std::min<std::size_t>(name.size(), 100), header.begin());
  char size[12];
  std::snprintf(size, sizeof size, "%011o", static_cast<unsigned>(contents.size()));
  std::memcpy(header.data() + 124, size, 12);
  header[156] = type;
  std::memcpy(header.data() + 257, "ustar\00000", 8);
  std::memset(header.data() + 148, ' ', 8);
  unsigned sum = 0;
  for (const char c : header) sum += static_cast<unsigned char>(c);
  char text[8];
  std::snprintf(text, sizeof text, "%06o", sum);
  std::memcpy(header.data() + 148, text, 7);
  return header + contents + std::string((512 - contents.size() % 512) % 512, '\0');
}
const std::string k_tar_end(1024, '\0');

struct Listed {
  std::vector<TarEntry> entries;
  std::uint64_t cut = 0;
};
Listed listed(const std::string& bytes) {
  const test::TemporaryFolder folder;
  const InputFile archive(folder.write("a.tar", bytes));
  Listed listed;
  listed.entries = tar_entries(archive, listed.cut);
  return listed;
}

TEST(TarFile, ListsRegularFilesWithLongNames) {
  const std::string long_name(150, 'n');
  const Listed all = listed(tar_of("folder/", "", '5') + tar_of("a", "12345") +
                            tar_of("././@LongLink", long_name + '\0', 'L') +
                            tar_of(long_name, "67") + k_tar_end + "behind the end");
  ASSERT_EQ(all.entries.size(), 2u);
  EXPECT_EQ(all.entries[0].name, "a");
  EXPECT_EQ(all.entries[0].offset, 1024u);
  EXPECT_EQ(all.entries[0].bytes, 5u);
  EXPECT_EQ(all.entries[1].name, long_name);
  EXPECT_EQ(all.entries[1].bytes, 2u);
  EXPECT_EQ(all.cut, 0u);
}

TEST(TarFile, EndsAtItsLastWholeFile) {
  const std::string whole = tar_of("a", "12345") + tar_of("b", std::string(600, 'x'));
  const Listed cut = listed(whole.substr(0, whole.size() - 500));
  ASSERT_EQ(cut.entries.size(), 1u);
  EXPECT_EQ(cut.cut, whole.size() - 500 - 1024);
  EXPECT_EQ(listed(whole.substr(0, 1024 + 512 + 600)).entries.size(), 2u);  // padding missing
  EXPECT_EQ(listed("").entries.size(), 0u);
}

TEST(TarFile, RefusesADamagedHeader) {
  for (const std::size_t at : {0u, 124u, 148u, 200u}) {
    std::string bytes = tar_of("a", "12345") + k_tar_end;
    bytes[at] = 'x';
    EXPECT_THROW((void)listed(bytes), InputError) << at;
  }
}

TEST(MatrixPose, TakesRigidTransformsAlone) {
  // A rotation of 90 degrees about z: x goes to y.
  MatrixNumbers m{0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1};
  const std::optional<Pose> pose = pose_of_matrix(m);
  ASSERT_TRUE(pose);
  EXPECT_TRUE((*pose * Vector3(1, 0, 0)).isApprox(Vector3(1, 3, 3), 1e-12));
  EXPECT_EQ(transposed(m)[12], 1);
  EXPECT_EQ(transposed(transposed(m)), m);
  for (const auto& [at, value] :
       {std::pair{15, 0.0}, {12, 1.0}, {0, 0.1}, {3, double{NAN}}, {10, -1.0}}) {
    MatrixNumbers wrong = m;
    wrong[static_cast<std::size_t>(at)] = value;
    EXPECT_FALSE(pose_of_matrix(wrong)) << at;
  }
}

TEST(FileTime, IsUnixTimeFrom1970On) {
  EXPECT_EQ(time_of_file_time(k_file_time_of_unix + 17).nanoseconds, 1700);
  EXPECT_EQ(time_of_file_time(17).nanoseconds, 1700);
  EXPECT_GT(time_of_file_time(UINT64_MAX).nanoseconds, 0);
}

Camera tiny_camera() {
  Camera camera = hololens2_ahat();
  camera.model.width = camera.model.height = 512;
  return camera;
}

std::string pgm(int side, char fill) {
  const std::string sides = std::to_string(side) + " " + std::to_string(side);
  return "P5 " + sides + " 65535\n" +
         std::string(2 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side), fill);
}

constexpr const char* k_identity = "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1";

class StreamRecorderTest : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& bytes) { folder_.write(name, bytes); }
  void write_unpacked() {
    std::filesystem::create_directory(folder_.path("Depth AHaT"));
    write("Depth AHaT/200.pgm", pgm(512, 1));
    write("Depth AHaT/200_ab.pgm", pgm(512, 2));
    write("Depth AHaT/100.pgm", pgm(512, 3));
    write("Depth AHaT/100_ab.pgm", pgm(512, 4));
    write("Depth AHaT/300.pgm", pgm(512, 5));
    write("Depth AHaT/notes.txt", "none");
  }
  test::TemporaryFolder folder_;
};

TEST_F(StreamRecorderTest, ReadsAnUnpackedCaptureInTheOrderOfItsStamps) {
  write_unpacked();
  write("Depth AHaT_extrinsics.txt", "1,0,0,5,0,1,0,0,0,0,1,0,0,0,0,1\n");
  write("Depth AHaT_rig2world.txt", "100,1,0,0,1,0,1,0,2,0,0,1,3,0,0,0,1\n\n200,0,0,0,0\nx\n");
  StreamRecorderFrames frames(folder_.path(""), tiny_camera());
  ReadFrame frame;
  ASSERT_TRUE(frames.next(frame));
  EXPECT_EQ(frame.mid_exposure.nanoseconds, 10'000);
  EXPECT_EQ(frame.pixels.depth[7], 0x0303);
  EXPECT_EQ(frame.pixels.reflectivity_16[7], 0x0404);
  ASSERT_TRUE(frame.head.valid);
  // The rig is at (1, 2, 3); the camera's origin is 5 to its left: rig to camera adds 5.
  EXPECT_TRUE(frame.head.T_world_camera.translation.isApprox(Vector3(-4, 2, 3), 1e-12));
  ASSERT_TRUE(frames.next(frame));
  EXPECT_EQ(frame.mid_exposure.nanoseconds, 20'000);
  EXPECT_FALSE(frame.head.valid);
  EXPECT_FALSE(frames.next(frame));
  EXPECT_EQ(frames.unreadable(), 1u);  // 300 has no reflectivity image
  EXPECT_NE(frames.first_unreadable().find("300.pgm has no _ab.pgm"), std::string::npos)
      << frames.first_unreadable();
  EXPECT_EQ(frames.counts()[0].second, 2u);
  EXPECT_FALSE(frames.lens());
  EXPECT_FALSE(frames.unix_offset());
}

TEST_F(StreamRecorderTest, StatesWhatACutArchiveLacks) {
  const std::string whole =
      tar_of("1.pgm", pgm(512, 1)) + tar_of("1_ab.pgm", pgm(512, 2)) + tar_of("2.pgm", pgm(512, 3));
  write("Depth AHaT.tar", whole.substr(0, whole.size() - 4096));
  StreamRecorderFrames frames(folder_.path(""), tiny_camera());
  ReadFrame frame;
  EXPECT_TRUE(frames.next(frame));
  EXPECT_FALSE(frames.next(frame));
  EXPECT_NE(frames.missing().find("truncated"), std::string::npos);
  EXPECT_NE(frames.text().find("no Depth AHaT_extrinsics.txt"), std::string::npos);
}

TEST_F(StreamRecorderTest, RefusesWhatIsNoCapture) {
  EXPECT_THROW(StreamRecorderFrames(folder_.path(""), tiny_camera()), InputError);
  write_unpacked();
  write("Depth AHaT_rig2world.txt", "");
  write("Depth AHaT_extrinsics.txt", "1,2,3");
  EXPECT_THROW(StreamRecorderFrames(folder_.path(""), tiny_camera()), InputError);
  Camera other = tiny_camera();
  other.model.width = 448;
  write("Depth AHaT_extrinsics.txt", k_identity);
  EXPECT_THROW(StreamRecorderFrames(folder_.path(""), other), InputError);
  EXPECT_NO_THROW(StreamRecorderFrames(folder_.path(""), tiny_camera()));
}

template <class Number>
std::string bytes_of_number(Number number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

std::string hl2ss_beginning(std::uint16_t port = 3804, char mode = 1, char profile_z = 0,
                            char profile_ab = '\xFF', char options = 0) {
  std::string bytes = "HL2SSV23" + bytes_of_number(port) + bytes_of_number(std::uint32_t{2}) + "me";
  bytes += mode;
  bytes += '\1';
  if (port == 3805) return bytes + bytes_of_number(std::uint32_t{0});
  return bytes + profile_z + profile_ab + '\xFF' + bytes_of_number(std::uint32_t{0}) + options +
         std::string(16 * static_cast<std::size_t>(options), 'o');
}

std::string packet(std::uint64_t stamp, std::uint32_t ab_bytes, float last = 1) {
  std::string payload = bytes_of_number(std::uint32_t{0}) + bytes_of_number(ab_bytes) +
                        std::string(ab_bytes / 2, 1) + std::string(ab_bytes / 2, 2) +
                        bytes_of_number(std::uint64_t{0});
  std::string pose;
  for (int i = 0; i < 16; ++i) {
    pose += bytes_of_number(i == 15 ? last : i % 5 == 0 ? 1.0f : i >= 12 ? 2.0f : 0.0f);
  }
  return bytes_of_number(stamp) + bytes_of_number(static_cast<std::uint32_t>(payload.size())) +
         payload + pose;
}

constexpr std::uint32_t k_ahat_planes = 4 * 512 * 512;

class Hl2ssTest : public ::testing::Test {
 protected:
  SourceSettings source(const std::string& bytes) {
    SourceSettings source;
    source.path = folder_.write("a.bin", bytes);
    return source;
  }
  std::string refusal(const std::string& bytes) {
    try {
      Hl2ssFrames frames(source(bytes), tiny_camera());
      return "none";
    } catch (const InputError& error) {
      return error.what();
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(Hl2ssTest, ReadsRawFramesAndSkipsEmptyPackets) {
  Hl2ssFrames frames(source(hl2ss_beginning(3804, 1, 0, '\xFF', 2) + packet(70, k_ahat_planes) +
                            packet(80, 0) + packet(90, 6) + packet(100, k_ahat_planes) + "tail"),
                     tiny_camera());
  ReadFrame frame;
  ASSERT_TRUE(frames.next(frame));
  EXPECT_EQ(frame.mid_exposure.nanoseconds, 7000);
  EXPECT_EQ(frame.pixels.depth[9], 0x0101);
  EXPECT_EQ(frame.pixels.reflectivity_16[9], 0x0202);
  EXPECT_FALSE(frame.head.valid);  // no extrinsics
  ASSERT_TRUE(frames.next(frame));
  EXPECT_EQ(frame.mid_exposure.nanoseconds, 10'000);
  EXPECT_FALSE(frames.next(frame));
  EXPECT_EQ(frames.counts()[0].second, 1u);
  EXPECT_EQ(frames.unreadable(), 1u);
  EXPECT_NE(frames.first_unreadable().find("a frame of 0 and 6 bytes"), std::string::npos);
  EXPECT_NE(frames.missing().find("4 bytes not read"), std::string::npos) << frames.missing();
  EXPECT_NE(frames.text().find("no head pose without"), std::string::npos);
}

TEST_F(Hl2ssTest, TakesLensAndExtrinsicsOfTheCalibration) {
  const std::size_t pixels = 512 * 512;
  std::vector<float> numbers(4 * pixels + 16 + 2 + 4);
  for (std::size_t i = 0; i < pixels; ++i) numbers[i] = 0.75f;
  numbers[5] = 0;  // no ray
  for (std::size_t i = 0; i < 4; ++i) numbers[2 * pixels + 5 * i] = 1;
  numbers[2 * pixels + 12] = 5;  // rig to camera: x + 5
  SourceSettings settings =
      source(hl2ss_beginning() + packet(70, k_ahat_planes) + packet(80, k_ahat_planes, 0));
  const std::string bytes(reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size());
  settings.calibration = folder_.write("c.bin", bytes);
  Hl2ssFrames frames(settings, tiny_camera());
  ReadFrame frame;
  ASSERT_TRUE(frames.next(frame));
  ASSERT_TRUE(frame.head.valid);
  EXPECT_TRUE(frame.head.T_world_camera.translation.isApprox(Vector3(-3, 2, 2), 1e-6));
  ASSERT_TRUE(frames.next(frame));
  EXPECT_FALSE(frame.head.valid);  // its last element is 0
  const SourceLens lens = *frames.lens();
  EXPECT_NEAR(lens.rays[0], 0.6f, 1e-6f);
  EXPECT_NEAR(lens.rays[2], 0.8f, 1e-6f);
  EXPECT_EQ(lens.rays[17], 0.0f);
  settings.calibration = folder_.write("c.bin", bytes.substr(4));
  EXPECT_THROW(Hl2ssFrames(settings, tiny_camera()), InputError);
}

TEST_F(Hl2ssTest, AcceptsNoTruncatedPayload) {
  constexpr std::size_t pixels = 6;
  const std::string wire = packet(70, 4 * pixels);
  const auto bytes = bytes_of(wire);
  const Hl2ssHeading heading = hl2ss_heading(bytes.first<k_hl2ss_heading_bytes>());
  EXPECT_EQ(heading.stamp, 70u);
  ASSERT_EQ(heading.payload_bytes, hl2ss_ahat_bytes(pixels));
  const auto payload = bytes.subspan(k_hl2ss_heading_bytes, heading.payload_bytes);
  for (std::size_t size = 0; size < payload.size(); ++size) {
    EXPECT_EQ(hl2ss_ahat(payload.first(size), pixels).contents, AhatContents::wrong_size) << size;
  }
  const AhatPayload whole = hl2ss_ahat(payload, pixels);
  ASSERT_EQ(whole.contents, AhatContents::frame);
  EXPECT_EQ(whole.depth.size(), 2 * pixels);
  EXPECT_EQ(whole.reflectivity.data(), payload.data() + 8 + 2 * pixels);
  EXPECT_EQ(whole.reflectivity[0], 2);
  EXPECT_EQ(hl2ss_ahat(payload, pixels + 1).contents, AhatContents::wrong_size);
  const std::string no_frame = packet(70, 0).substr(k_hl2ss_heading_bytes, 16);
  EXPECT_EQ(hl2ss_ahat(bytes_of(no_frame), pixels).contents, AhatContents::empty);
}

TEST_F(Hl2ssTest, RefusesOtherVersionsStreamsAndCompressedFrames) {
  EXPECT_NE(refusal("HL2SSV24" + hl2ss_beginning().substr(8)).find("begins with HL2SSV23"),
            std::string::npos);
  EXPECT_NE(refusal("HL2SS").find("begins with HL2SSV23"), std::string::npos);
  EXPECT_NE(refusal(hl2ss_beginning(3810)).find("port 3810"), std::string::npos);
  EXPECT_NE(refusal(hl2ss_beginning(3804, 2)).find("mode 2"), std::string::npos);
  EXPECT_NE(refusal(hl2ss_beginning(3804, 1, 0, 0)).find("compressed"), std::string::npos);
  EXPECT_NE(refusal(hl2ss_beginning(3804, 1, 1)).find("compressed"), std::string::npos);
  EXPECT_NE(refusal(hl2ss_beginning().substr(0, 17)).find("configuration"), std::string::npos);
  EXPECT_EQ(refusal(hl2ss_beginning(3805)), "none");
}

}  // namespace
}  // namespace glint
