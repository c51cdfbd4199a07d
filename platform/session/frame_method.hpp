// Another way from a frame to estimates, in the tracker's place: the caller hands it in, so that
// the groups need none of what it is built from.
#pragma once

#include "nodes/tokens.hpp"
#include "platform/session/frame_source.hpp"

namespace glint {

class FrameMethod {
 public:
  virtual ~FrameMethod() = default;
  // What is known after this frame; valid until the next call.
  [[nodiscard]] virtual const Estimates& process(const ArrivedFrame& arrived) = 0;
};

}  // namespace glint
