// Interface of a reader of recorded frames, implemented by each file format. FileSource
// (file_source.hpp) turns it into a source.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "platform/cells/cell.hpp"
#include "platform/formats/frame_buffer.hpp"

namespace glint {

// One frame, with times of the file's own clock.
struct ReadFrame {
  FrameBuffer pixels;
  Time mid_exposure;
  Duration stamp_sigma;                   // standard deviation, beside the cell's; 0: not stated
  std::optional<Time> arrival;            // last byte in memory; empty: as the camera declares
  std::optional<std::uint64_t> sequence;  // empty: counted by the source
  HeadPose head;                          // not valid: none for this frame
};

using ReaderCounts = std::vector<std::pair<std::string, std::uint64_t>>;  // by name

class FrameReader {
 public:
  virtual ~FrameReader() = default;

  // Overwrites all fields of `frame`; returns false at the end. Counts and skips a frame that
  // cannot be read. Throws InputError if reading cannot continue.
  [[nodiscard]] virtual bool next(ReadFrame& frame) = 0;

  // Number of skipped frames so far, and the cause of the first: path, position, found, expected.
  [[nodiscard]] virtual std::uint64_t unreadable() const { return 0; }
  [[nodiscard]] virtual std::string first_unreadable() const { return {}; }

  // Further counts of skipped data, with kinds of this format.
  [[nodiscard]] virtual ReaderCounts counts() const { return {}; }

  // The lens recorded with the frames, if any.
  [[nodiscard]] virtual std::optional<SourceLens> lens() const { return std::nullopt; }

  // Missing data of the file, with its path; empty: none. Valid after next() returned false.
  [[nodiscard]] virtual std::string missing() const { return {}; }

  // Text for the table: "recording out/run.mcap, level roi: ...".
  [[nodiscard]] virtual std::string text() const = 0;
  // Plus a stamp: Unix time. Empty: the stamps' clock has no known epoch.
  [[nodiscard]] virtual std::optional<Duration> unix_offset() const { return std::nullopt; }
};

}  // namespace glint
