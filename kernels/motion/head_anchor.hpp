// Drift correction of the headset's localisation by a static reference body (Kalman filter).
//
// What:     the localisation error e (a translation and a small rotation about the body's position)
//           follows the Gauss-Markov process of head_walk.hpp; each measurement of the body
//           observes it. While the body is visible, corrected poses are relative to the body; while
//           it is hidden, the correction decays and its covariance grows to the headset's. One
//           filter runs for each of k_drift_factors times the declared standard deviations; the
//           output is that of the filter whose newest measurements have the largest likelihood, so
//           that a headset that drifts more than declared is corrected too.
// Cost:     for each factor one 6x6 Cholesky factor and a few products: 27,000 to 32,000
//           instructions in all (schedules/boards).
// Worst:    the body visible; otherwise data independent.
// Accuracy: the body's own, filtered as far as the headset's error allows. The body's first
//           k_anchor_frames measurements define its pose; their error moves the whole world.
// Source:   Bar-Shalom, Li and Kirubarajan 2001, section 5.2 (the update in Joseph form, whose two
//           terms are returned separately) and 11.6.2 (models compared by their likelihoods).
#pragma once

#include <array>
#include <cstddef>

#include "kernels/motion/head_walk.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

inline constexpr int k_anchor_frames = 45;  // 1 s
// Chi-square quantile, 6 degrees of freedom, significance level 1e-6: above it the measurement is
// rejected as not the body's ..
inline constexpr double k_anchor_chi_square_max = 38.3;
// .. unless rejections continue for 0.2 s: then the headset has relocalised (a jump), and the error
// is reset to the measurement of the body, which is declared static.
inline constexpr int k_anchor_refused_max = 9;
// None is below 1: an overestimated drift costs little, an underestimated one loses the correction.
inline constexpr std::array<double, 5> k_drift_factors{1, 3, 10, 30, 100};

// Corrected head pose of one frame, with the covariance that its error adds to each world pose.
struct AnchoredHead {
  HeadPose head;
  Vector3 pivot_m = Vector3::Zero();  // in the world: reference point of the covariances
  Matrix6 fresh = Matrix6::Zero();    // new in this frame: independent noise
  Matrix6 lasting = Matrix6::Zero();  // from earlier frames: shared by all of them
  Matrix6 stepped = Matrix6::Zero();  // added since the previous frame; zero unless in_gap
  Pose moved;                         // motion that corrects earlier poses after a gap
  bool corrected = false;             // by this frame's measurement of the body
  bool moved_along = false;           // `moved` applies
  // The body is hidden now or was hidden in the previous frame. Relative to earlier poses the head
  // has an error of covariance `stepped`, which no measurement of the body removed.
  bool in_gap = false;

  // The covariances for a pose at `point_m`, along the world's axes.
  [[nodiscard]] Matrix6 fresh_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 lasting_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 stepped_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
};

class HeadAnchor {
 public:
  // body: T_camera_body with its covariance along the camera's axes at the body's origin; null if
  // this frame does not show the body or none is declared. Requires frames in order of time.
  [[nodiscard]] AnchoredHead update(const HeadPose& head, const UncertainPose* body,
                                    const HeadNoise& noise) noexcept GLINT_NONBLOCKING;
  // Applies the correction of the last update() to a head pose.
  [[nodiscard]] Pose corrected(const Pose& T_world_camera) const noexcept GLINT_NONBLOCKING;
  // Covariance of the headset's error when the body is hidden for long, at the present speed.
  [[nodiscard]] Matrix6 uncorrected_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;

  [[nodiscard]] bool known() const { return sights_ > 0; }
  [[nodiscard]] const Pose& T_world_body() const { return T_world_body_; }  // once known()
  [[nodiscard]] int jumps() const { return jumps_; }  // detected relocalisations of the headset
  // The selected factor on the declared standard deviations.
  [[nodiscard]] double drift_factor() const { return k_drift_factors[best_]; }
  // Time stamps restart: discards the previous head pose.
  void restart_clock() noexcept { walk_.restart_clock(); }

 private:
  // Filter state for one factor.
  struct Held {
    Vector6 error = Vector6::Zero();  // of the head, about T_world_body_'s origin
    Matrix6 covariance = Matrix6::Zero();
    int refused = 0;            // consecutive rejections
    double log_likelihood = 0;  // of the newest measurements, exponentially weighted
  };
  // Covariance after one measurement, split as in AnchoredHead.
  struct Corrected {
    Matrix6 fresh, lasting;
    bool accepted = false, jumped = false;
  };
  void walk_on(const HeadPose& head, const HeadNoise& noise);
  void define(const UncertainPose& T_world_body);
  [[nodiscard]] Corrected correct(const UncertainPose& T_world_body, Held& held) const;
  void correct_all(const UncertainPose& T_world_body, AnchoredHead& out);

  int sights_ = 0;  // measurements that defined the body's pose, up to k_anchor_frames
  int unseen_ = 0;  // consecutive frames without a correction
  int jumps_ = 0;
  Pose T_world_body_;
  std::array<Held, k_drift_factors.size()> held_;
  std::size_t best_ = 0;
  WalkedError walked_;  // since the previous frame, for factor 1
  HeadWalk walk_;
};

}  // namespace glint
