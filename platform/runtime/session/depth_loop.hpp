// Simulated mapping camera: repeats stored depth images forward and backward at a fixed rate.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/units.hpp"
#include "nodes/extend_map.hpp"
#include "platform/tools/mapping/depth_sequence.hpp"

namespace glint {

class DepthLoop {
 public:
  // Without images: newest() returns 0.
  DepthLoop() = default;
  DepthLoop(DepthSequence sequence, Duration period)
      : sequence_(std::move(sequence)), period_(period) {
    const CameraModel& camera = sequence_.camera;
    while (camera.width / stride_ * (camera.height / stride_) > k_scene_pixels_max) ++stride_;
    for (const DepthFrame& frame : sequence_.frames) scenes_.push_back(subsampled(frame));
    scene_camera_ = {camera.width / stride_, camera.height / stride_, camera.fx / stride_,
                     camera.fy / stride_,    subsampled(camera.cx),   subsampled(camera.cy)};
  }

  // Number of the newest image taken by `now`, from 1; 0: none.
  [[nodiscard]] std::int64_t newest(Time now) const noexcept {
    if (sequence_.frames.empty() || now < Time{}) return 0;
    return now.nanoseconds / period_.nanoseconds + 1;
  }
  [[nodiscard]] Time time_of(std::int64_t number) const noexcept {
    return Time{} + period_ * (number - 1);
  }
  // Plays forward, then backward, so that the camera's pose never jumps.
  [[nodiscard]] const DepthFrame& image(std::int64_t number) const noexcept {
    return sequence_.frames[index_of(number)];
  }
  // The same image, subsampled to at most k_scene_pixels_max pixels for the robot search.
  [[nodiscard]] ShownDepth::Scene scene(std::int64_t number) const noexcept {
    return {scene_camera_, scenes_[index_of(number)]};
  }
  [[nodiscard]] const CameraModel& camera() const noexcept { return sequence_.camera; }

 private:
  [[nodiscard]] std::size_t index_of(std::int64_t number) const noexcept {
    const auto last = static_cast<std::int64_t>(sequence_.frames.size()) - 1;
    const std::int64_t turn = last > 0 ? (number - 1) % (2 * last) : 0;
    return static_cast<std::size_t>(turn <= last ? turn : 2 * last - turn);
  }
  [[nodiscard]] std::vector<float> subsampled(const DepthFrame& frame) const {
    std::vector<float> out;
    for (int y = 0; y < frame.height / stride_; ++y) {
      for (int x = 0; x < frame.width / stride_; ++x) {
        const int pixel = (y * stride_ + stride_ / 2) * frame.width + x * stride_ + stride_ / 2;
        out.push_back(frame.depth_m[static_cast<std::size_t>(pixel)]);
      }
    }
    return out;
  }
  // Pixel x of the subsampled image is pixel stride x + stride / 2; pixel centres are at + 0.5.
  [[nodiscard]] double subsampled(double centre) const {
    return (centre - stride_ / 2 - 0.5) / stride_ + 0.5;
  }

  int stride_ = 1;
  Pinhole scene_camera_;
  std::vector<std::vector<float>> scenes_;
  DepthSequence sequence_;
  Duration period_ = milliseconds(200);
};

}  // namespace glint
