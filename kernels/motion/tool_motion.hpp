// Motion estimate of one tool for use outside a graph: motion_track.hpp with the static window's
// sums in one object, some 50 KB.
#pragma once

#include <span>

#include "kernels/motion/motion_track.hpp"

namespace glint {

class ToolMotion {
 public:
  ToolMotionSettings settings;

  // Contracts: see MotionTrack.
  Reason update(const UncertainPose& measured,
                const CorrelatedErrors& correlated = {}) noexcept GLINT_NONBLOCKING {
    return track_.update(measured, correlated, settings, sums_).reason;
  }
  Reason update(Time time, std::span<const MeasuredPoint> points) noexcept GLINT_NONBLOCKING {
    return track_.update(time, points, settings, sums_);
  }
  void reset() noexcept { track_.reset(); }

  [[nodiscard]] bool known() const { return track_.known(); }
  [[nodiscard]] bool is_static() const { return track_.is_static(); }
  [[nodiscard]] const NoiseScale& noise_scale() const { return track_.noise_scale(); }
  [[nodiscard]] MotionState estimate() const noexcept GLINT_NONBLOCKING {
    return track_.estimate(sums_);
  }
  [[nodiscard]] Matrix6 correlated_covariance() const noexcept GLINT_NONBLOCKING {
    return track_.correlated_covariance(sums_);
  }
  [[nodiscard]] const Correction& last_correction() const { return track_.last_correction(); }

 private:
  MotionTrack track_;
  StaticWindowSums sums_;
};

}  // namespace glint
