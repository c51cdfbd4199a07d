// Static detector (zero-velocity update, ZUPT) of a tool, with the mean pose of the static window.
//
// What:     windows of the newest n, 3/4 n, 1/2 n, 3/8 n .. frames, the shortest first. Each is
//           split into an older and a newer half, whose means differ by d; the test statistic is
//           d' (C1 + C2)^-1 d, C the covariance of a half's mean, correlated errors included. The
//           static window is the longest window before the first failure. Frames have equal weight.
// Cost:     at most k_static_window_levels tests of one 6x6 factor each, 0.4 us: 5 us.
// Worst:    a full window that passes all tests.
// Accuracy: the mean is exact for small rotations: a pose further than k_window_rotation_max_rad
// from the anchor
//           starts a new window. Its covariance is the mean's plus that of a hand's tremor.
// Source:   chi-square test of two samples' means, 6 degrees of freedom: Foerstner and Wrobel 2016,
//           Photogrammetric Computer Vision, section 3.2.
#pragma once

#include <array>

#include "kernels/motion/correlated_errors.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"

namespace glint {

inline constexpr int k_static_frames_max = 128;    // 2.8 s at 45 Hz
inline constexpr int k_static_window_levels = 13;  // 2 .. 128 frames
inline constexpr double k_window_rotation_max_rad = 0.35;
inline constexpr double k_window_translation_max_m = 0.2;

struct StaticDetectorSettings {
  // Quantiles for 6 degrees of freedom. Short windows are tested with every new frame: significance
  // level 1e-5. Long ones share most of their frames with the windows before: 1e-3.
  double short_chi_square_max = 33.0;
  double long_chi_square_max = 22.5;
  double drift_chi_square = 12.6;        // 6 degrees of freedom, 5 %: above it is a drift
  int frames_min = 8;                    // shortest static window
  Duration gap_max = milliseconds(250);  // a longer gap ends the static window
  CorrelationTimes correlation;
};

// Estimate of a static tool: pose and drift, with covariances.
struct StaticEstimate {
  UncertainPose pose;
  Vector6 drift_per_s = Vector6::Zero();  // m/s and rad/s; zero unless significant (5 %)
  Matrix6 drift_covariance = Matrix6::Zero();
};

// Ring buffer of prefix sums over frames since the window's anchor, one entry a frame: 45 KB.
class StaticWindowSums {
 public:
  struct Sum {
    Vector6 place = Vector6::Zero();  // pose differences from the anchor
    Matrix6 covariance = Matrix6::Zero();
    Time time;  // of the newest frame in it
  };
  [[nodiscard]] const Sum& operator[](int index) const { return items_[wrapped(index)]; }
  [[nodiscard]] Sum& operator[](int index) { return items_[wrapped(index)]; }

  // A full window's entries, one before it, and the three that one frame may write: these never
  // overwrite entries of the window before that frame.
  static constexpr int k_size = k_static_frames_max + 1 + 3;

 private:
  static std::size_t wrapped(int index) { return static_cast<std::size_t>(index % k_size); }
  std::array<Sum, k_size> items_;
};

// Position of the static window in its StaticWindowSums. A copy from before add() stays valid after
// it, so that a frame can be undone. Each window needs its own sums.
class StaticDetector {
 public:
  // `correlated`: covariances of errors that successive poses share, not in the pose's covariance.
  // Returns the number of tests of the halves.
  int add(const UncertainPose& measured, const CorrelatedErrors& correlated,
          const StaticDetectorSettings& settings,
          StaticWindowSums& sums) noexcept GLINT_NONBLOCKING;
  void clear() noexcept { frames_ = kept_ = 0; }
  // Moves all poses by a small motion: moves the anchor, which the sums refer to. The rotation of
  // the sums' axes is neglected, because the summed differences are as small as the noise.
  void move(const Pose& moved) noexcept {
    anchor_ = {(moved.rotation * anchor_.rotation).normalized(), moved * anchor_.translation};
  }

  [[nodiscard]] bool is_static() const { return frames_ >= frames_min_; }
  [[nodiscard]] int frames() const { return frames_; }
  // Estimate at the newest frame's time. Requires frames() >= 2.
  [[nodiscard]] StaticEstimate rest(const StaticWindowSums& sums) const noexcept GLINT_NONBLOCKING;
  // Covariance of the correlated errors: of the mean if static, otherwise of the newest pose.
  [[nodiscard]] Matrix6 correlated(const StaticWindowSums& sums) const noexcept GLINT_NONBLOCKING;

 private:
  using Sum = StaticWindowSums::Sum;
  void restart(const UncertainPose& only, StaticWindowSums& sums);
  int push(Time time, const Sum& added, const StaticDetectorSettings& settings,
           StaticWindowSums& sums);
  [[nodiscard]] const Sum& sum_before(int frames, const StaticWindowSums& sums) const;
  [[nodiscard]] Sum newest(int frames, const StaticWindowSums& sums) const;
  struct Halves {
    Vector6 difference;  // newer mean - older mean
    double chi_square;
  };
  [[nodiscard]] Halves halves(int frames, const StaticWindowSums& sums) const;
  [[nodiscard]] double seconds_of(int frames, const StaticWindowSums& sums) const;
  [[nodiscard]] Pose placed(const Vector6& place) const;

  Pose anchor_;
  Time time_;
  // Entry newest_ sums all frames, newest_ - n all but the newest n.
  int newest_ = 0;
  int kept_ = 0;    // candidate frames for the static window
  int frames_ = 0;  // frames in the static window
  int frames_min_ = StaticDetectorSettings{}.frames_min;
  double drift_chi_square_ = StaticDetectorSettings{}.drift_chi_square;
  CorrelatedErrors correlated_;  // of the newest pose
  CorrelationTimes times_;
};

}  // namespace glint
