// What the tick group gives to a headset's display. The group depends on this alone, so that a
// companion computer links no WebSocket.
#pragma once

#include <cstdint>

#include "kernels/wire/pose_sample.hpp"
#include "nodes/tokens.hpp"

namespace glint {

struct HeadsetSample {
  PoseSample sample;
  RobotFrame robot;
  Duration unix_offset;  // from session time to Unix time
};

struct HeadsetCounts {
  std::uint64_t clients = 0;     // accepted so far
  std::uint64_t refused = 0;     // too many, another protocol, or a page of a browser
  std::uint64_t messages = 0;    // sent, over all clients
  std::uint64_t not_taken = 0;   // replaced by newer ones: a connected client read too slowly
  std::uint64_t queue_full = 0;  // samples that the queue rejected
};

class HeadsetOutput {
 public:
  virtual ~HeadsetOutput() = default;
  // Call from the tick thread only. Copies; no heap, no lock.
  virtual void offer(const HeadsetSample& sample) noexcept = 0;
};

}  // namespace glint
