// The frames that every row of the benchmark gets: consecutive ones of the simulator, to and fro,
// so that the pen never jumps and the stamps always rise.
#pragma once

#include <string>
#include <vector>

#include "kernels/pose/head_pose.hpp"
#include "kernels/pose/tool.hpp"
#include "platform/sim/simulator.hpp"

namespace glint::bench {

struct Sensor {
  std::string name;  // size and bits
  Camera camera;
  Tool tool;
  std::vector<sim::SimFrame> frames;
};

// HoloLens 1 short-throw, 448 x 450, 8 bit, and HoloLens 2 AHAT, 512 x 512, 16 bit, both with the
// pen moving in view.
[[nodiscard]] const Sensor& short_throw();
[[nodiscard]] const Sensor& ahat();

// Goes through the frames to and fro with its own clock.
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
