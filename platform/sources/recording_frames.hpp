// Reader of frames from Glint's own recordings (MCAP, levels full and roi).
#pragma once

#include "platform/sinks/record/recording_reader.hpp"
#include "platform/sources/frame_reader.hpp"

namespace glint {

class RecordingFrames final : public FrameReader {
 public:
  // Throws InputError if the file is no recording or has no frames (levels blobs and outputs).
  explicit RecordingFrames(const std::string& path, ReadTolerance tolerance = {});

  [[nodiscard]] bool next(ReadFrame& frame) override;
  [[nodiscard]] std::optional<SourceLens> lens() const override;
  [[nodiscard]] std::string text() const override;
  [[nodiscard]] std::optional<Duration> unix_offset() const override;
  [[nodiscard]] std::string missing() const override;

 private:
  std::string path_;
  mutable RecordingReader reader_;
  HeadPose head_;  // precedes its frame
};

}  // namespace glint
