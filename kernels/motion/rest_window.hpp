// Does the tool rest, since when, and where? The longest run of frames whose older and newer halves
// agree; at rest the weighted mean over them is the best estimate there is.
//
// What:     windows of the newest n, 3/4 n, 1/2 n, 3/8 n .. frames, from the shortest on; each
//           is cut into an older and a newer half whose means differ by d' (C1 + C2)^-1 d, C the
//           covariance of a half's mean, correlated errors included. The first that differs too
//           much ends the rest there. Frames count alike.
// Cost:     at most k_rest_levels tests of one 6x6 factor each, 0.4 us: 5 us.
// Worst:    a full window that passes all tests.
// Accuracy: the mean is exact for small rotations: a pose further than k_anchor_rad from the anchor
//           begins a new window. Its covariance is the mean's and a hand's tremor.
// Source:   two samples' means against each other by chi square, 6 degrees of freedom: Foerstner
//           and Wrobel 2016, Photogrammetric Computer Vision, section 3.2.
#pragma once

#include <array>

#include "kernels/motion/correlated_errors.hpp"
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
  CorrelationTimes correlation;
};

// What a window says of the tool: where it is, and how it may drift.
struct Rest {
  UncertainPose pose;
  Vector6 drift_per_s = Vector6::Zero();  // m/s and rad/s; zero unless the halves speak for one
  Matrix6 drift_covariance = Matrix6::Zero();
};

// Sums over frames since the window's anchor, one entry a frame: 45 KB.
class RestSums {
 public:
  struct Sum {
    Vector6 place = Vector6::Zero();  // from the anchor
    Matrix6 covariance = Matrix6::Zero();
    Time time;  // of the newest frame in it
  };
  [[nodiscard]] const Sum& operator[](int index) const { return items_[wrapped(index)]; }
  [[nodiscard]] Sum& operator[](int index) { return items_[wrapped(index)]; }

  // A full window's entries, one before it, and the three that one frame may write: they never lie
  // on entries that the window before that frame needs.
  static constexpr int k_size = k_rest_frames_max + 1 + 3;

 private:
  static std::size_t wrapped(int index) { return static_cast<std::size_t>(index % k_size); }
  std::array<Sum, k_size> items_;
};

// Where the window lies in the sums. A copy from before add() still holds after it, so that a frame
// can be undone; one window's sums serve no other.
class RestWindow {
 public:
  // `correlated`: of errors that successive poses have in common, not in the pose's covariance.
  // Returns how often it tested the halves.
  int add(const UncertainPose& measured, const CorrelatedErrors& correlated,
          const RestSettings& settings, RestSums& sums) noexcept GLINT_NONBLOCKING;
  void clear() noexcept { frames_ = kept_ = 0; }
  // All poses move by this little: the anchor does, from which the sums are counted. That their
  // axes turn too is left out, for what they hold is as small as the noise.
  void move(const Pose& moved) noexcept {
    anchor_ = {(moved.rotation * anchor_.rotation).normalized(), moved * anchor_.translation};
  }

  [[nodiscard]] bool rests() const { return frames_ >= frames_min_; }
  [[nodiscard]] int frames() const { return frames_; }
  // At the newest frame's time. Meaningless if frames() < 2.
  [[nodiscard]] Rest rest(const RestSums& sums) const noexcept GLINT_NONBLOCKING;
  // The correlated errors' covariance: of the mean at rest, else of the newest pose.
  [[nodiscard]] Matrix6 correlated(const RestSums& sums) const noexcept GLINT_NONBLOCKING;

 private:
  using Sum = RestSums::Sum;
  void restart(const UncertainPose& only, RestSums& sums);
  int push(Time time, const Sum& added, const RestSettings& settings, RestSums& sums);
  [[nodiscard]] const Sum& sum_before(int frames, const RestSums& sums) const;
  [[nodiscard]] Sum newest(int frames, const RestSums& sums) const;
  struct Halves {
    Vector6 difference;  // newer mean - older mean
    double chi_square;
  };
  [[nodiscard]] Halves halves(int frames, const RestSums& sums) const;
  [[nodiscard]] double seconds_of(int frames, const RestSums& sums) const;
  [[nodiscard]] Pose placed(const Vector6& place) const;

  Pose anchor_;
  Time time_;
  // Entry newest_ holds all frames, newest_ - n all but the newest n.
  int newest_ = 0;
  int kept_ = 0;    // frames that may belong to the rest
  int frames_ = 0;  // of them, those that do
  int frames_min_ = RestSettings{}.frames_min;
  double drift_chi_square_ = RestSettings{}.drift_chi_square;
  CorrelatedErrors correlated_;  // of the newest pose
  CorrelationTimes times_;
};

}  // namespace glint
