// Reads a recording back, message by message, in the order in which it was offered.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "platform/record/recording.hpp"

namespace glint {

struct ReadTolerance {
  bool truncated = false;   // a file cut short or damaged is read but for what is not whole
  bool incomplete = false;  // a recording that dropped offers or ended early is read all the same
};

// What of the file is not read; all of it once next() returned nothing.
struct RecordingLosses {
  std::int64_t frames = 0;    // at level outputs: none
  std::int64_t messages = 0;  // of every kind, the frames' own among them
  std::int64_t chunks = 0;    // damaged ones
  std::uint64_t bytes = 0;
  bool at_least = false;  // the file does not tell how many frames and messages it had
  [[nodiscard]] bool any() const { return bytes > 0 || messages > 0; }
};
// "at least 3 frames (12 messages), 4096 bytes, 1 damaged chunk".
[[nodiscard]] std::string text_of(const RecordingLosses& losses);

class RecordingReader {
 public:
  // Throws InputError: path, byte and what was expected; for a recording that is cut short or
  // incomplete also what to do about it.
  explicit RecordingReader(const std::string& path, ReadTolerance tolerance = {});
  ~RecordingReader();
  RecordingReader(RecordingReader&&) noexcept;
  RecordingReader& operator=(RecordingReader&&) noexcept;

  [[nodiscard]] RecordingLevel level() const;
  [[nodiscard]] Duration nominal_tick() const;
  [[nodiscard]] Duration unix_offset() const;
  // Facts of the beginning and of the end together; among them "complete" and "output_sha256".
  [[nodiscard]] const std::map<std::string, std::string>& facts() const;

  // The next of Glint's own messages; nothing at the end. Throws InputError.
  [[nodiscard]] std::optional<RecordedMessage> next();
  // Each damaged chunk leaves one gap in the order of the messages.
  [[nodiscard]] std::uint64_t gaps() const;
  [[nodiscard]] RecordingLosses losses() const;

  // Throws InputError, which lists the names there are.
  [[nodiscard]] Attachment attachment(const std::string& name);
  [[nodiscard]] std::vector<std::string> attachment_names() const;

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
