// Frames one after the other out of files: what each recorded format implements. FileSource
// (file_source.hpp) makes a source of it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "platform/cells/cell.hpp"
#include "platform/sensors/frame_buffer.hpp"

namespace glint {

// One frame by its own clock.
struct ReadFrame {
  FrameBuffer pixels;
  Time mid_exposure;
  Duration stamp_sigma;                   // of it, beside the cell's; 0: the format states none
  std::optional<Time> arrival;            // last byte in memory; nothing: as the camera declares
  std::optional<std::uint64_t> sequence;  // nothing: counted by the source
  HeadPose head;                          // not valid: the format has none for this frame
};

using ReaderCounts = std::vector<std::pair<std::string, std::uint64_t>>;  // by name

class FrameReader {
 public:
  virtual ~FrameReader() = default;

  // Overwrites all fields of `frame`; false: there are no more. Throws InputError for what ends the
  // reading. A frame that cannot be read is counted and skipped.
  [[nodiscard]] virtual bool next(ReadFrame& frame) = 0;

  // Frames skipped so far, and why the first of them was: path, place, found, expected.
  [[nodiscard]] virtual std::uint64_t unreadable() const { return 0; }
  [[nodiscard]] virtual std::string first_unreadable() const { return {}; }

  // What else was left out, of this format's own kinds.
  [[nodiscard]] virtual ReaderCounts counts() const { return {}; }

  // The lens that the frames came through, if it is recorded with them.
  [[nodiscard]] virtual std::optional<SourceLens> lens() const { return std::nullopt; }

  // What the file lacks, with its path; empty: nothing. After next() returned false.
  [[nodiscard]] virtual std::string missing() const { return {}; }

  // For the table: "recording out/run.mcap, level roi: ...".
  [[nodiscard]] virtual std::string text() const = 0;
  // Added to a stamp it gives Unix time; nothing: the stamps' clock has no known epoch.
  [[nodiscard]] virtual std::optional<Duration> unix_offset() const { return std::nullopt; }
};

}  // namespace glint
