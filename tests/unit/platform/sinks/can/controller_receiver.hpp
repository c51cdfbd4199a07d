// Receives the encoder's frames by the controller's C decoder.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "kernels/wire/can_frames.hpp"
#include "platform/sinks/can/controller/glint_controller.h"

namespace glint::controller_test {

inline constexpr std::uint64_t k_cycle_us = 4000;

inline glint_settings settings_of(CanFormat format) {
  return {.base = k_can_base_default,
          .fd = format == CanFormat::fd,
          .cycle_us = k_cycle_us,
          .speed_max = 2000,
          .age_max = 1000,
          .measured_max = 100'000,
          .heartbeat = 0x720};
}

inline std::vector<CanFrame> frames_of(const PoseSample& sample, CanFormat format) {
  CanFrames frames;
  add_pose_frames(sample, {format, k_can_base_default}, frames);
  return {frames.frames().begin(), frames.frames().end()};
}

inline glint_frame c_frame(const CanFrame& frame) {
  return {frame.identifier, frame.fd, frame.length, frame.data.data()};
}

// A pen on a circle of 100 mm, one turn in 4 s, measured 8 ms before the tick.
inline PoseSample circle(std::uint64_t tick) {
  const double angle = 2 * std::numbers::pi * static_cast<double>(tick) / 1000;
  PoseSample sample;
  sample.tick_number = tick;
  sample.tick = {static_cast<std::int64_t>(tick) * 4'000'000};
  sample.measurement = sample.tick - microseconds(8000);
  sample.state = TrackState::measured;
  sample.pose.translation = {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.5};
  sample.sigma_position_m = 1e-3;
  sample.sigma_orientation_rad = 1e-3;
  return sample;
}

class Receiver {
 public:
  explicit Receiver(CanFormat format) : format_(format) {
    const glint_settings settings = settings_of(format);
    glint_init(&controller, &settings);
  }
  glint_verdict send(const PoseSample& sample, std::uint64_t now_us) {
    glint_verdict verdict = GLINT_IGNORED;
    for (const CanFrame& frame : frames_of(sample, format_)) verdict = send(frame, now_us);
    return verdict;
  }
  glint_verdict send(const CanFrame& frame, std::uint64_t now_us) {
    const glint_frame received = c_frame(frame);
    return glint_receive(&controller, &received, now_us);
  }
  // Sends ticks [0, ticks), and enables: the next tick's time is ticks * k_cycle_us.
  void start(std::uint64_t ticks) {
    for (std::uint64_t tick = 0; tick < ticks; ++tick) send(circle(tick), tick * k_cycle_us);
    ASSERT_TRUE(glint_enable(&controller, (ticks - 1) * k_cycle_us));
  }
  glint_controller controller{};

 private:
  CanFormat format_;
};

class ControllerOf : public testing::TestWithParam<CanFormat> {};

}  // namespace glint::controller_test
