// A recording by its path. Each method reads the file anew, so that a Recording has no position.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "platform/apps/python/recorded_rows.hpp"
#include "platform/cells/cell.hpp"
#include "platform/runtime/session/frame_pose.hpp"
#include "platform/sinks/record/recording_reader.hpp"

namespace glint::python {

class Recording {
 public:
  // Throws InputError as the commands do for a truncated, damaged or foreign file.
  Recording(std::string path, ReadTolerance tolerance);

  [[nodiscard]] RecordingReader reader() const { return RecordingReader(path_, tolerance_); }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const ReadTolerance& tolerance() const { return tolerance_; }
  [[nodiscard]] RecordingLevel level() const { return level_; }
  [[nodiscard]] Duration nominal_tick() const { return nominal_tick_; }
  [[nodiscard]] Duration unix_offset() const { return unix_offset_; }
  [[nodiscard]] const std::map<std::string, std::string>& facts() const { return facts_; }
  [[nodiscard]] const std::vector<std::string>& attachments() const { return attachments_; }
  // Throws InputError if the recording lacks its cell.
  [[nodiscard]] Cell cell() const;
  // Index of the tool with this name. Throws InputError, which lists the names.
  [[nodiscard]] std::uint8_t tool_index(const std::string& name) const;

  // Rows of the messages of one type. `add(message, rows)` appends those of a message.
  template <class Message, class Row, class Add>
  [[nodiscard]] std::vector<Row> rows(const Add& add) const {
    std::vector<Row> rows;
    RecordingReader messages = reader();
    while (const auto message = messages.next())
      if (const auto* item = std::get_if<Message>(&*message)) add(*item, rows);
    return rows;
  }

  // Tracks the recorded frames anew: the rows of `glint export csv`. Throws InputError if the
  // recording has no frames.
  [[nodiscard]] std::vector<FramePoseRow> frame_poses(PoseOrigin origin) const;
  // Messages and bytes that were skipped; reads the whole file.
  [[nodiscard]] RecordingLosses losses() const;

 private:
  std::string path_;
  ReadTolerance tolerance_;
  RecordingLevel level_;
  Duration nominal_tick_, unix_offset_;
  std::map<std::string, std::string> facts_;
  std::vector<std::string> attachments_;
};

}  // namespace glint::python
