// Writes a recording: Glint's own messages for replay, ROS messages for everybody else's viewers.
//
// The file grows as PATH.part and gets its name when it is closed. A write that fails (full disk)
// ends it at the last whole chunk, with index and statistics, and is said in outcome(); calls after
// that do nothing, so that tracking goes on.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "kernels/wire/pose_sample.hpp"
#include "platform/record/frame_patch.hpp"
#include "platform/record/recording.hpp"

namespace glint {

struct RecordingSettings {
  std::size_t chunk_bytes = std::size_t{4} << 20;  // a chunk ends at this size ...
  Duration chunk_span = milliseconds(1000);        // ... or when it spans this: what a crash costs
  Duration sync_period = milliseconds(1000);       // what a power failure costs beside that
};

class RecordingWriter {
 public:
  // Throws InputError where the file cannot be made.
  RecordingWriter(const std::string& path, const RecordingInfo& info,
                  RecordingSettings settings = {});
  ~RecordingWriter();  // closes
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // In the order in which a replay shall meet them. What the level leaves out is not written:
  // frames only at full and roi, markers only at blobs, inputs and choices not at outputs.
  void write_frame(const FramePatch& patch);
  void write_head_pose(const HeadPose& pose);
  void write_markers(const MarkerFrame& frame);
  void write_choice(const ChoiceRecord& choice);
  // Also writes /glint/pen_pose, /glint/pen_pose_cov and /tf where the sample has a pose.
  void write_output(const PoseSample& sample, std::span<const std::uint8_t> record);
  void write_dropped(const DroppedInput& input);
  void write_robot_frame(const RobotFrameRecord& frame);
  void write_pen_buttons(const PenButtonsRecord& buttons);
  void write_button(const ButtonEvent& event);  // at every level: a path is made of these

  // Offers that never arrived here: the recording is then marked incomplete.
  void count_dropped_offers(std::uint64_t count);

  // A fact known only at the end; written at close.
  void add_closing_fact(const std::string& name, const std::string& value);

  // Index, statistics and closing facts; then the file gets its name. Again: does nothing.
  RecordingOutcome close();
  [[nodiscard]] const RecordingOutcome& outcome() const;
  // Messages that a failed write cost so far: those of its chunk and all since.
  [[nodiscard]] std::uint64_t messages_lost() const;

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
