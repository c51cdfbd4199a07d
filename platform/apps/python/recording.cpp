#include "platform/apps/python/recording.hpp"

#include "platform/apps/python/frame_tracker.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/recorded_cell.hpp"
#include "platform/sources/head_pose_check.hpp"
#include "platform/sources/recording_frames.hpp"

namespace glint::python {

Recording::Recording(std::string path, ReadTolerance tolerance)
    : path_(std::move(path)), tolerance_(tolerance) {
  const RecordingReader opened = reader();
  level_ = opened.level();
  nominal_tick_ = opened.nominal_tick();
  unix_offset_ = opened.unix_offset();
  facts_ = opened.facts();
  attachments_ = opened.attachment_names();
}

Cell Recording::cell() const {
  RecordingReader opened = reader();
  return recorded_cell(opened, path_);
}

std::uint8_t Recording::tool_index(const std::string& name) const {
  const ToolSet tools = cell().tools;
  std::string names;
  for (int t = 0; t < tools.count; ++t) {
    const char* const known = tools.items[static_cast<std::size_t>(t)].name.data();
    if (name == known) return static_cast<std::uint8_t>(t);
    names += std::string(t > 0 ? ", " : "") + known;
  }
  throw InputError("tool: \"" + name + "\"; expected one of " + names);
}

std::vector<FramePoseRow> Recording::frame_poses(PoseOrigin origin) const {
  RecordingFrames frames(path_, tolerance_);
  const Cell own = cell();
  require_lens(own);
  FrameTracker tracker(own, origin);
  std::vector<FramePoseRow> rows;
  ReadFrame read;
  while (frames.next(read)) {
    Frame frame = read.pixels.view(read.mid_exposure, read.arrival.value_or(read.mid_exposure),
                                   read.sequence.value_or(0));
    frame.stamp_sigma = read.stamp_sigma;
    check_head_pose(read.head);
    read.head.time = read.mid_exposure;
    const std::vector<FramePoseRow> found = tracker.track(frame, read.head);
    rows.insert(rows.end(), found.begin(), found.end());
  }
  return rows;
}

RecordingLosses Recording::losses() const {
  RecordingReader messages = reader();
  while (messages.next()) {
  }
  return messages.losses();
}

}  // namespace glint::python
