#include "platform/tools/programming/recorded_path.hpp"

#include <gtest/gtest.h>

#include "platform/input_error.hpp"
#include "platform/sinks/record/recording_writer.hpp"
#include "tests/unit/platform/sinks/record/recording_samples.hpp"
#include "tests/unit/platform/tools/programming/strokes.hpp"

namespace glint {
namespace {

// Two tools for two seconds at 250 Hz, 1 m apart along y.
void write_run(const std::string& path, const std::vector<ButtonEvent>& events,
               ReferenceFrame frame = ReferenceFrame::robot) {
  RecordingWriter writer(path, sample_info(RecordingLevel::outputs));
  for (int tick = 0; tick < 500; ++tick) {
    for (std::uint8_t tool = 0; tool < 2; ++tool) {
      PoseSample sample = tip_at(4.0 * tick, Vector3(4e-4 * tick, tool, 0));
      sample.tool = tool;
      sample.frame = frame;
      writer.write_output(sample, record_of(sample));
    }
  }
  for (const ButtonEvent& event : events) writer.write_button(event);
}

std::string error_message(const std::string& recording, const RecordedPathOptions& options) {
  try {
    (void)recorded_path(recording, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no complaint";
}

// The events follow all poses in the file, and not in time order.
TEST(RecordedPath, PutsPosesAndButtonsInTheOrderOfTheirTime) {
  const TemporaryFolder folder;
  write_run(folder.file("run.mcap"), {up(1000), down(200), up(1201, Button::undo),
                                      down(1200, Button::delete_last), down(1300, Button::undo)});
  const RecordedPath drawn = recorded_path(folder.file("run.mcap"), {});
  EXPECT_EQ(drawn.tool, "pen");
  EXPECT_EQ(drawn.events, 5);
  EXPECT_EQ(drawn.unix_offset.nanoseconds, 1'700'000'000'000'000'123);
  ASSERT_EQ(drawn.path.size(), 1u);
  // The poses at the press and at the release are included: 0.02 to 0.1 m, a point every 2 mm.
  EXPECT_EQ(drawn.counts.poses_accepted, 201);
  ASSERT_EQ(drawn.path[0].points.size(), 41u);
  EXPECT_EQ(drawn.path[0].points.front().time, at_ms(200));
  EXPECT_EQ(drawn.path[0].points.back().time, at_ms(1000));
}

TEST(RecordedPath, IsOfTheToolThatIsNamed) {
  const TemporaryFolder folder;
  write_run(folder.file("run.mcap"), {});
  RecordedPathOptions options;
  options.tool = "second pen";
  options.presses = {down(200), up(1000)};
  EXPECT_EQ(
      recorded_path(folder.file("run.mcap"), options).path.at(0).points[0].pose.translation.y(), 1);
  options.tool = "third";
  EXPECT_NE(error_message(folder.file("run.mcap"), options)
                .find("no tool 'third'; expected one of: pen, second pen"),
            std::string::npos);
}

TEST(RecordedPath, TakesPressesWrittenByHandInPlaceOfTheRecordings) {
  const TemporaryFolder folder;
  write_run(folder.file("run.mcap"), {down(200), up(1000)});
  RecordedPathOptions options;
  options.presses = {down(400), up(600), down(1000), up(1500)};
  EXPECT_EQ(recorded_path(folder.file("run.mcap"), options).path.size(), 2u);
}

TEST(RecordedPath, SaysWhyThereIsNone) {
  const TemporaryFolder folder;
  write_run(folder.file("none.mcap"), {});
  EXPECT_NE(
      error_message(folder.file("none.mcap"), {}).find("no recorded button; expected --button"),
      std::string::npos);
  write_run(folder.file("world.mcap"), {down(200), up(1000)}, ReferenceFrame::world);
  EXPECT_NE(error_message(folder.file("world.mcap"), {})
                .find("of 201 poses while the button was held 0 were not measured and 201 not in "
                      "the robot's frame"),
            std::string::npos);
  EXPECT_NE(error_message(folder.file("absent.mcap"), {}), "no complaint");
}

}  // namespace
}  // namespace glint
