// Frames for all rows of the benchmark: consecutive simulated frames, played forwards and
// backwards, so that the pen never jumps and the time stamps always increase.
#pragma once

#include <string>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/sim/simulator.hpp"

namespace glint::bench {

struct Sensor {
  std::string name;  // image size and bit depth
  Camera camera;
  Tool tool;
  std::vector<sim::SimFrame> frames;
};

// HoloLens 1 short-throw, 448 x 450, 8 bit, and HoloLens 2 AHAT, 512 x 512, 16 bit. The pen moves
// in view of both.
// pen moving in view.
[[nodiscard]] const Sensor& short_throw();
[[nodiscard]] const Sensor& ahat();

// Plays the frames forwards and backwards with its own clock.
class Player {
 public:
  explicit Player(const Sensor& sensor) : sensor_(&sensor) {}
  void next();
  [[nodiscard]] const Frame& frame() const { return frame_; }
  [[nodiscard]] const HeadPose& head() const { return head_; }

 private:
  const Sensor* sensor_;
  std::size_t at_ = 0;
  bool back_ = false;
  std::uint32_t sequence_ = 0;
  Frame frame_;
  HeadPose head_;
};

}  // namespace glint::bench
