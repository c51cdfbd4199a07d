// Drift correction of the headset's localisation by a static reference body (Kalman filter).
//
// What:     the localisation error e (a translation and a small rotation about the body's position)
//           follows the Gauss-Markov process of head_drift.hpp; each measurement of the body
//           observes it. While the body is visible, corrected poses are relative to the body; while
//           it is hidden, the correction decays and its covariance grows to the headset's. One
//           filter runs for each of k_drift_factors times the declared standard deviations; the
//           output is that of the filter whose newest measurements have the largest likelihood, so
//           that a headset that drifts more than declared is corrected too.
// Cost:     for each factor one 6x6 Cholesky factor and a few products: 27,000 to 32,000
//           instructions in all (schedules/boards).
// Worst:    the body visible; otherwise data independent.
// Accuracy: the body's own, filtered as far as the headset's error allows. The body's first
//           k_body_definition_frames measurements define its pose; their error moves the whole
//           world.
// Source:   Bar-Shalom, Li and Kirubarajan 2001, section 5.2 (the update in Joseph form, whose two
//           terms are returned separately) and 11.6.2 (models compared by their likelihoods).
#pragma once

#include <array>
#include <cstddef>

#include "kernels/motion/head_drift.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

inline constexpr int k_body_definition_frames = 45;  // 1 s
// Chi-square quantile, 6 degrees of freedom, significance level 1e-6: above it the measurement is
// rejected as not the body's ..
inline constexpr double k_body_chi_square_max = 38.3;
// .. unless rejections continue for 0.2 s: then the headset has relocalised (a jump), and the error
// is reset to the measurement of the body, which is declared static.
inline constexpr int k_body_rejected_max = 9;
// None is below 1: an overestimated drift costs little, an underestimated one loses the correction.
inline constexpr std::array<double, 5> k_drift_factors{1, 3, 10, 30, 100};

// Corrected head pose of one frame, with the covariance that its error adds to each world pose.
struct CorrectedHead {
  HeadPose head;
  Vector3 pivot_m = Vector3::Zero();          // in the world: reference point of the covariances
  Matrix6 independent = Matrix6::Zero();      // new in this frame: independent noise
  Matrix6 shared = Matrix6::Zero();           // from earlier frames: shared by all of them
  Matrix6 step_covariance = Matrix6::Zero();  // added since the previous frame; zero unless in_gap
  Pose gap_correction;                        // motion that corrects earlier poses after a gap
  bool corrected = false;                     // by this frame's measurement of the body
  bool moved_along = false;                   // `gap_correction` applies
  // The body is hidden now or was hidden in the previous frame. Relative to earlier poses the head
  // has an error of covariance `step_covariance`, which no measurement of the body removed.
  bool in_gap = false;

  // The covariances for a pose at `point_m`, along the world's axes.
  [[nodiscard]] Matrix6 independent_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 shared_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 step_covariance_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
};

class HeadDriftCorrection {
 public:
  // body: T_camera_body with its covariance along the camera's axes at the body's origin; null if
  // this frame does not show the body or none is declared. Requires frames in order of time.
  [[nodiscard]] CorrectedHead update(const HeadPose& head, const UncertainPose* body,
                                     const HeadNoise& noise) noexcept GLINT_NONBLOCKING;
  // Applies the correction of the last update() to a head pose.
  [[nodiscard]] Pose corrected(const Pose& T_world_camera) const noexcept GLINT_NONBLOCKING;
  // Covariance of the headset's error when the body is hidden for long, at the present speed.
  [[nodiscard]] Matrix6 uncorrected_covariance_at(const Vector3& point_m) const noexcept
      GLINT_NONBLOCKING;

  [[nodiscard]] bool known() const { return definition_count_ > 0; }
  [[nodiscard]] const Pose& T_world_body() const { return T_world_body_; }  // once known()
  [[nodiscard]] int jumps() const { return jumps_; }  // detected relocalisations of the headset
  // The selected factor on the declared standard deviations.
  [[nodiscard]] double drift_factor() const { return k_drift_factors[best_]; }
  // Time stamps restart: discards the previous head pose.
  void restart_clock() noexcept { error_process_.restart_clock(); }

 private:
  // Filter state for one factor.
  struct FactorFilter {
    Vector6 error = Vector6::Zero();  // of the head, about T_world_body_'s origin
    Matrix6 covariance = Matrix6::Zero();
    int refused = 0;            // consecutive rejections
    double log_likelihood = 0;  // of the newest measurements, exponentially weighted
  };
  // Covariance after one measurement, split as in CorrectedHead.
  struct MeasurementUpdate {
    Matrix6 independent, shared;
    bool accepted = false, jumped = false;
  };
  void propagate(const HeadPose& head, const HeadNoise& noise);
  void define_body_pose(const UncertainPose& T_world_body);
  [[nodiscard]] MeasurementUpdate correct(const UncertainPose& T_world_body,
                                          FactorFilter& filter) const;
  void correct_all(const UncertainPose& T_world_body, CorrectedHead& out);

  // Measurements that defined the body's pose, at most k_body_definition_frames.
  int definition_count_ = 0;
  int uncorrected_frames_ = 0;  // consecutive frames without a correction
  int jumps_ = 0;
  Pose T_world_body_;
  std::array<FactorFilter, k_drift_factors.size()> filters_;
  std::size_t best_ = 0;
  ErrorTransition transition_;  // since the previous frame, for factor 1
  HeadErrorProcess error_process_;
};

}  // namespace glint
