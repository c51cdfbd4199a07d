// Validates camera frames: admits each frame once and in order. A late, doubled or invalid frame is
// counted and passed on as rejected, so that no later node uses it as a measurement.
//
// If the sensor's clock restarts, every new frame would be late. After k_resync_frames rejected
// frames with increasing time stamps, CheckFrame accepts the new clock.
#pragma once

#include <array>
#include <string_view>

#include "graph/loops.hpp"
#include "kernels/image/frame.hpp"
#include "kernels/limits.hpp"
#include "kernels/nonblocking.hpp"
#include "nodes/tokens.hpp"

namespace glint {

inline constexpr int k_resync_frames = 8;  // 0.2 s at 45 Hz: below lost_after, above any reordering

// Copies the metadata of a frame and checks its size against the camera's.
struct StampFrame {
  static constexpr std::array<std::string_view, 1> k_loops = {"call"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits&) noexcept { return {{1}}; }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1}}; }

  int width = 0;
  int height = 0;
  int reflectivity_bits = 16;

  void operator()(const Frame& frame, FrameStamp& stamp) const noexcept {
    stamp.mid_exposure = frame.mid_exposure;
    stamp.sigma = frame.stamp_sigma;
    stamp.arrival = frame.arrival;
    stamp.sequence = frame.sequence;
    const bool plane_there =
        reflectivity_bits == 8 ? !frame.reflectivity_8.empty() : !frame.reflectivity_16.empty();
    const bool depth_fits =
        !frame.depth.empty() && frame.depth.width == width && frame.depth.height == height;
    const bool fits =
        plane_there && depth_fits && frame.width() == width && frame.height() == height;
    stamp.reason = fits ? Reason::none : Reason::frame_invalid;
  }
};

struct CheckFrame {
  static constexpr std::array<std::string_view, 1> k_loops = {"call"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits&) noexcept { return {{1}}; }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1}}; }

  void operator()(const FrameStamp& stamp, FrameVerdict& verdict) noexcept GLINT_NONBLOCKING;

 private:
  Time newest_;  // of the accepted frames
  std::uint64_t sequence_ = 0;
  Time refused_newest_;  // of the consecutive rejected frames
  int refused_in_row_ = 0;
  FrameVerdict counts_;
};

static_assert(graph::Budgeted<StampFrame, Limits> && graph::Budgeted<CheckFrame, Limits>);

}  // namespace glint
