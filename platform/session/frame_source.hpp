// Where frames come from, as the frame group sees it: it waits for the next one, and gives its
// pixels back when it is done with them.
#pragma once

#include "kernels/image/frame.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

struct ArrivedFrame {
  Frame frame;  // its pixels stay valid until give_back()
  HeadPose head;
  int slot = -1;  // the source's own number for the pixels' place
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // Blocks until a frame has arrived; false: there are no more. The only blocking call of the
  // frame group.
  [[nodiscard]] virtual bool wait(ArrivedFrame& arrived) = 0;
  virtual void give_back(const ArrivedFrame& arrived) noexcept = 0;
  // Whether the newest frame that is due at this time came late, or has not come yet. From any
  // thread.
  [[nodiscard]] virtual bool late(Time /*now*/) const noexcept { return false; }
};

}  // namespace glint
