#include "platform/boards/board_run.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "platform/boards/frame_loop.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

TEST(BoardRun, RefusesACellWhoseBackgroundItWouldNotRun) {
  const std::string file = testing::TempDir() + "glint_loop_of_one_pixel";
  FrameLoopHeader header;
  header.width = header.height = 1;
  header.frames = 1;
  header.period_ns = 1'000'000;
  FrameLoopWriter writer(file, header);
  FrameBuffer pixels;
  pixels.width = pixels.height = 1;
  pixels.reflectivity_16 = {0};
  writer.add({}, pixels);
  writer.close();
  const FrameLoop loop(file);

  Cell cell = cell_from_text("[background]\n", "cell.toml");
  cell.camera.model.width = cell.camera.model.height = 1;
  cell.camera.reflectivity_bits = loop.header().reflectivity_bits;
  try {
    (void)run_board(cell, loop, {});
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "cell.toml: has a [background]; expected none, for a board runs the frame and "
                 "tick groups only");
  }
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace glint
