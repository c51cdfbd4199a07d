// Writer of a recording: Glint's own messages for replay, ROS messages for other viewers.
//
// The file is PATH.part until it is closed, then it is renamed. A failed write (full disk) ends it
// at the last complete chunk, with index and statistics, and is reported in outcome(). Later calls
// do nothing, so that tracking continues.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/derived_messages.hpp"
#include "platform/sinks/record/frame_patch.hpp"
#include "platform/sinks/record/message_observer.hpp"
#include "platform/sinks/record/recording.hpp"

namespace glint {

struct RecordingSettings {
  std::size_t chunk_bytes = std::size_t{4} << 20;  // a chunk ends at this size ...
  Duration chunk_span = milliseconds(1000);        // ... or this span: the loss in a crash
  Duration sync_period = milliseconds(1000);       // additional loss in a power failure
  MessageObserver* observer = nullptr;             // of every message; outlives the writer
  DerivedMessages* derived = nullptr;              // further messages; outlives the writer
};

class RecordingWriter {
 public:
  // Throws InputError if the file cannot be created.
  RecordingWriter(const std::string& path, const RecordingInfo& info,
                  RecordingSettings settings = {});
  ~RecordingWriter();  // closes
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  // Call in the order of the replay. Messages excluded by the level are not written: frames only at
  // full and roi, markers only at blobs, inputs and choices not at outputs.
  void write_frame(const FramePatch& patch);
  void write_head_pose(const HeadPose& pose);
  void write_markers(const MarkerFrame& frame);
  void write_choice(const ChoiceRecord& choice);
  // Also writes /glint/pen_pose, /glint/pen_pose_cov and /tf if the sample has a pose.
  void write_output(const PoseSample& sample, std::span<const std::uint8_t> record);
  void write_dropped(const DroppedInput& input);
  void write_robot_frame(const RobotFrameRecord& frame);
  void write_pen_buttons(const PenButtonsRecord& buttons);
  void write_button(const ButtonEvent& event);  // at every level: paths are made of these

  // Number of offers dropped before this writer: the recording is then marked incomplete.
  void count_dropped_offers(std::uint64_t count);

  // Adds a fact that is available only at the end; written by close().
  void add_closing_fact(const std::string& name, const std::string& value);

  // Writes index, statistics and closing facts, then renames the file. Later calls do nothing.
  RecordingOutcome close();
  [[nodiscard]] const RecordingOutcome& outcome() const;
  // Messages lost by a failed write so far: those of its chunk and all later ones.
  [[nodiscard]] std::uint64_t messages_lost() const;

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
