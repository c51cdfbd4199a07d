// Reads the messages of a recording in the order of the offers.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "platform/sinks/record/recording.hpp"

namespace glint {

struct ReadTolerance {
  bool truncated = false;   // reads the intact part of a truncated or damaged file
  bool incomplete = false;  // reads a recording with dropped offers or an early end
};

// Data of the file that was skipped; final once next() returned nothing.
struct RecordingLosses {
  std::int64_t frames = 0;    // 0 at level outputs
  std::int64_t messages = 0;  // of every kind, including the frames' own
  std::int64_t chunks = 0;    // damaged chunks
  std::uint64_t bytes = 0;
  bool at_least = false;  // lower bound: the file does not state its numbers of frames and messages
  [[nodiscard]] bool any() const { return bytes > 0 || messages > 0; }
};
// "at least 3 frames (12 messages), 4096 bytes, 1 damaged chunk".
[[nodiscard]] std::string text_of(const RecordingLosses& losses);

// Returns a recording's button events in the order of their time. Throws InputError: as the reader,
// or for more than a million events.
[[nodiscard]] std::vector<ButtonEvent> recorded_buttons(const std::string& path,
                                                        ReadTolerance tolerance);

class RecordingReader {
 public:
  // Throws InputError: path, byte and expected value; for a truncated or incomplete recording also
  // the remedy.
  explicit RecordingReader(const std::string& path, ReadTolerance tolerance = {});
  ~RecordingReader();
  RecordingReader(RecordingReader&&) noexcept;
  RecordingReader& operator=(RecordingReader&&) noexcept;

  [[nodiscard]] RecordingLevel level() const;
  [[nodiscard]] Duration nominal_tick() const;
  [[nodiscard]] Duration unix_offset() const;
  // Opening and closing facts together, including "complete" and "output_sha256".
  [[nodiscard]] const std::map<std::string, std::string>& facts() const;

  // The next of Glint's own messages; nothing at the end. Throws InputError.
  [[nodiscard]] std::optional<RecordedMessage> next();
  // Number of gaps in the message order: one for each damaged chunk.
  [[nodiscard]] std::uint64_t gaps() const;
  [[nodiscard]] RecordingLosses losses() const;

  // Throws InputError, which lists the existing names.
  [[nodiscard]] Attachment attachment(const std::string& name);
  [[nodiscard]] std::vector<std::string> attachment_names() const;

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
