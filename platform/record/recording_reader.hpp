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
  bool truncated = false;   // a file cut short is read up to its last whole chunk
  bool incomplete = false;  // a recording that dropped offers or ended early is read all the same
};

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

  // Throws InputError, which lists the names there are.
  [[nodiscard]] Attachment attachment(const std::string& name);
  [[nodiscard]] std::vector<std::string> attachment_names() const;

 private:
  struct Body;
  std::unique_ptr<Body> body_;
};

}  // namespace glint
