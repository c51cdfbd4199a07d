// Messages derived from those of a recording, for its viewers. Replay does not read them.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/frame_patch.hpp"
#include "platform/sinks/record/recording.hpp"

namespace glint {

enum class Destination : std::uint8_t { file_and_observer, observer };

class DerivedOutput {
 public:
  virtual ~DerivedOutput() = default;
  // Returns the number for write(). The topic may be one of the recording's own.
  virtual std::uint16_t add_channel(std::string_view topic, std::string_view type,
                                    Destination to) = 0;
  // time: monotonic. cdr: with its encapsulation.
  virtual void write(std::uint16_t channel, Time time, std::span<const std::uint8_t> cdr) = 0;
};

// Called by the thread that writes the recording, never by a frame or tick thread; after the
// message itself is written, in the order of the offers. A message excluded by the recording's
// level is not passed on.
class DerivedMessages {
 public:
  virtual ~DerivedMessages() = default;
  // First call; `output` outlives the calls below.
  virtual void open(DerivedOutput& output, Duration unix_offset) = 0;
  virtual void add(const FramePatch& patch) = 0;
  virtual void add(const HeadPose& head) = 0;
  virtual void add(const DroppedInput& input) = 0;
  virtual void add(const RobotFrameRecord& robot) = 0;
  virtual void add(const ButtonEvent& event) = 0;
  virtual void add(const PoseSample& sample) = 0;
};

}  // namespace glint
