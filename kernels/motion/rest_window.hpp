// Does the tool rest, since when, and where? The longest run of frames whose older and newer halves
// agree; at rest the weighted mean over them is the best estimate there is.
//
// What:     windows of the newest n, 3/4 n, 1/2 n, 3/8 n .. frames, from the shortest on; each
//           is cut into an older and a newer half whose means differ by d' (C1 + C2)^-1 d, C the
//           covariance of a half's mean. The first that differs too much ends the rest there.
//           Frames count alike.
// Cost:     at most k_rest_levels tests of one 6x6 factor each, 0.4 us: 5 us.
// Worst:    a full window that passes all tests.
// Accuracy: the mean is exact for small rotations: a pose further than k_anchor_rad from the anchor
//           begins a new window.
// Source:   two samples' means against each other by chi square, 6 degrees of freedom: Foerstner
//           and Wrobel 2016, Photogrammetric Computer Vision, section 3.2.
#pragma once

#include <array>

#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_rest_frames_max = 128;  // 2.8 s at 45 Hz
inline constexpr int k_rest_levels = 13;       // 2 .. 128 frames
inline constexpr double k_anchor_rad = 0.35;
inline constexpr double k_anchor_m = 0.2;

struct RestSettings {
  // Short windows are tested anew with every frame, so they may hardly ever fail by chance (6
  // degrees of freedom: 1e-5); long ones share most of their frames with those before (1e-3).
  double short_chi_square_max = 33.0;
  double long_chi_square_max = 22.5;
  double drift_chi_square = 12.6;        // 6 degrees of freedom, 5 %: what exceeds it is a drift
  int frames_min = 8;                    // fewer are no rest yet
  Duration gap_max = milliseconds(250);  // a longer silence ends a rest
};

// What a window says of the tool: where it is, and how it may drift.
struct Rest {
  UncertainPose pose;
  Vector6 drift_per_s = Vector6::Zero();  // m/s and rad/s; zero unless the halves speak for one
  Matrix6 drift_covariance = Matrix6::Zero();
};

class RestWindow {
 public:
  RestSettings settings;

  void add(const UncertainPose& measured) noexcept GLINT_NONBLOCKING;
  void clear() noexcept { frames_ = kept_ = 0; }

  [[nodiscard]] bool rests() const { return frames_ >= settings.frames_min; }
  [[nodiscard]] int frames() const { return frames_; }
  // At the newest frame's time. Meaningless if frames() < 2.
  [[nodiscard]] Rest rest() const noexcept GLINT_NONBLOCKING;

 private:
  struct Sum {
    Vector6 place = Vector6::Zero();  // from the anchor
    Matrix6 covariance = Matrix6::Zero();
    Time time;  // of the newest frame in it
  };
  void restart(const UncertainPose& only);
  [[nodiscard]] Duration length() const;
  void push(Time time, const Sum& added);
  [[nodiscard]] const Sum& sum_before(int frames) const;
  [[nodiscard]] Sum newest(int frames) const;
  struct Halves {
    Vector6 difference;  // newer mean - older mean
    double chi_square;
  };
  [[nodiscard]] Halves halves(int frames) const;
  [[nodiscard]] Pose placed(const Vector6& place) const;

  // Sums since the anchor; entry next_ - 1 holds all frames, next_ - 1 - n all but the newest n.
  std::array<Sum, k_rest_frames_max + 1> sums_;
  Pose anchor_;
  Time time_;
  int newest_ = 0;
  int kept_ = 0;    // frames that may belong to the rest
  int frames_ = 0;  // of them, those that do
};

}  // namespace glint
