// What the groups of a run give to DDS. The groups depend on this alone, so that a replay links no
// DDS.
#pragma once

#include <cstdint>

#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/dds/frame_transforms.hpp"

namespace glint {

class PoseOutput {
 public:
  virtual ~PoseOutput() = default;

  // Call from one thread only. Returns false if the sample was dropped and counted. The ticks of a
  // tool must increase.
  virtual bool offer(const PoseSample& sample) noexcept = 0;

  // Call from one other thread only: the transforms of a frame. Returns false, and counts the loss,
  // if there is no room.
  virtual bool offer_frame(const FrameTransforms& frame) noexcept = 0;

  // Samples, poses and transforms lost so far. Thread-safe.
  [[nodiscard]] virtual std::uint64_t lost() const noexcept = 0;
};

}  // namespace glint
