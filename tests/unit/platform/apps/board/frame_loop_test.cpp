#include "platform/apps/board/frame_loop.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "platform/input_error.hpp"

namespace glint::frame_loop_test {
namespace {

class FrameLoopFile : public testing::Test {
 protected:
  FrameLoopFile()
      : file_(std::filesystem::temp_directory_path() /
              ("glint_loop_" + std::to_string(::getpid()))) {}
  ~FrameLoopFile() override { std::filesystem::remove(file_); }

  static FrameLoopHeader header() {
    FrameLoopHeader header;
    header.width = 5;
    header.height = 3;
    header.has_depth = 1;
    header.frames = 3;
    header.period_ns = 22'222'222;
    return header;
  }

  // Frame i has reflectivity 100 i + pixel and depth 1000 i + pixel.
  static FrameBuffer pixels(int frame) {
    FrameBuffer buffer;
    buffer.width = 5;
    buffer.height = 3;
    for (int i = 0; i < 15; ++i) {
      buffer.reflectivity_16.push_back(static_cast<std::uint16_t>(100 * frame + i));
      buffer.depth.push_back(static_cast<std::uint16_t>(1000 * frame + i));
    }
    return buffer;
  }

  void write() const {
    FrameLoopWriter writer(file_, header());
    for (int i = 0; i < 3; ++i) {
      LoopFrame frame;
      frame.exposure_to_arrival_ns = 5'000'000 + i;
      frame.kind = i == 1 ? LoopFrameKind::worst : LoopFrameKind::rendered;
      frame.head_valid = 1;
      frame.position_m[2] = 0.5 + i;
      writer.add(frame, pixels(i));
    }
    writer.close();
  }

  // Message of the reader after the byte at `offset` was changed.
  [[nodiscard]] std::string refused_with(std::size_t offset, char value) const {
    write();
    std::fstream stream(file_, std::ios::in | std::ios::out | std::ios::binary);
    stream.seekp(static_cast<std::streamoff>(offset));
    stream.put(value);
    stream.close();
    try {
      const FrameLoop loop(file_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string file_;
};

TEST_F(FrameLoopFile, GivesBackWhatWasWritten) {
  write();
  const FrameLoop loop(file_);
  ASSERT_EQ(loop.header().frames, 3u);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Time arrival{1'000'000'000};
    const Frame frame = loop.view(i, arrival, 7);
    EXPECT_EQ(frame.sequence, 7u);
    EXPECT_EQ(frame.arrival, arrival);
    EXPECT_EQ((frame.arrival - frame.mid_exposure).nanoseconds, 5'000'000 + i);
    EXPECT_EQ(loop.entry(i).kind, i == 1 ? LoopFrameKind::worst : LoopFrameKind::rendered);
    for (int y = 0; y < 3; ++y) {
      for (int x = 0; x < 5; ++x) {
        EXPECT_EQ(frame.reflectivity_16.row(y)[x], 100 * i + static_cast<unsigned>(5 * y + x));
        EXPECT_EQ(frame.depth.row(y)[x], 1000 * i + static_cast<unsigned>(5 * y + x));
      }
    }
    const HeadPose head = loop.head(i, arrival);
    EXPECT_TRUE(head.valid);
    EXPECT_EQ(head.time, frame.mid_exposure);
    EXPECT_EQ(head.T_world_camera.translation.z(), 0.5 + i);
  }
}

TEST_F(FrameLoopFile, GoesToAndFroWithoutAJump) {
  write();
  const FrameLoop loop(file_);
  const std::uint32_t expected[] = {0, 1, 2, 1, 0, 1, 2, 1, 0};
  for (std::uint64_t shown = 0; shown < 9; ++shown) {
    EXPECT_EQ(loop.index_of(shown), expected[shown]) << shown;
  }
}

TEST_F(FrameLoopFile, NamesTheByteThatIsWrong) {
  EXPECT_EQ(refused_with(0, 'X'),
            file_ + ":byte 0: no loop of frames; expected GLNTLOOP, a file of glint_board_frames");
  EXPECT_EQ(refused_with(8, 2), file_ + ":byte 8: layout 2; expected 1");
  EXPECT_EQ(refused_with(13, 9), file_ + ":byte 12: width 2309; expected 1 to 1024");
  EXPECT_EQ(refused_with(20, 12), file_ + ":byte 20: bits 12; expected 8 or 16");
  EXPECT_NE(refused_with(28, 4).find("bytes for 4 frames"), std::string::npos);
}

TEST_F(FrameLoopFile, RefusesAFileThatWasCutShort) {
  write();
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) - 1);
  EXPECT_THROW(FrameLoop loop(file_), InputError);
  std::filesystem::resize_file(file_, 10);
  EXPECT_THROW(FrameLoop loop(file_), InputError);
  EXPECT_THROW(FrameLoop loop(file_ + ".not_there"), InputError);
}

TEST_F(FrameLoopFile, HasItsNameOnlyWhenItIsWhole) {
  {
    FrameLoopWriter writer(file_, header());
    writer.add({}, pixels(0));
    EXPECT_THROW(writer.close(), InputError);
  }
  EXPECT_FALSE(std::filesystem::exists(file_));
  EXPECT_FALSE(std::filesystem::exists(file_ + ".part"));
}

}  // namespace
}  // namespace glint::frame_loop_test
