// Tracking of a robot's pose at run time: a first-order low-pass follows slow drift; a jump is
// rejected and reported.
//
// What:     aligns the model to one depth image at a time, from the last accepted reference, and
//           evaluates the result. If the robot is found, near and with sufficient certainty, the
//           pose moves by the fraction 1 - exp(-dt / time_constant) of the difference. Otherwise
//           the pose stays, and the report states the reason.
// Cost:     slices_max() slices an image: renderings of the model, Gauss-Newton steps, and one
//           evaluation, the largest: a rendering, a grid of the image and a search a pixel. With a
//           limit of steps (slice_size.hpp) as many slices as needed: the same bits.
// Worst:    a model that fills the image and does not converge.
// Accuracy: lags drift by drift * time_constant. The covariance contains the filtered noise of the
//           images and the declared drift since the last update.
// Source:   a first-order low-pass, e.g. Gelb 1974, example 4.2-4; the noise of its mean follows
//           from its gain.
#pragma once

#include <cstdint>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/judge_alignment.hpp"
#include "kernels/units.hpp"

namespace glint {

// Gates near the reference only: 6 cm suffices to detect a jump.
[[nodiscard]] constexpr AlignmentSettings near_alignment() {
  AlignmentSettings settings;
  settings.gates[0] = {0.06, Matching::projective, 2, 6, true};
  settings.gates[1] = {0.035, Matching::projective, 1, 8, true};
  settings.gate_count = 2;
  return settings;
}

struct FollowSettings {
  double time_constant_s = 2;
  // Largest drift rate to follow: that of a headset that tracks its room well.
  double drift_m_s = 1e-3;
  double drift_rad_s = 1e-3;
  // A larger difference between an image's pose and the reference is a jump, not drift. Measured at
  // the centroid of the visible points. Poses from single images of a real robot differ by 5 to 11
  // mm.
  double jump_m = 0.02;
  double jump_rad = 0.035;
  // As in the initial search.
  double visible_share_min = 0.4;
  double inlier_share_min = 0.85;
  double seen_through_share_max = 0.08;
  AlignmentSettings alignment = near_alignment();
  ScoreSettings judge;
};

// Excess of a slice: a nearest-point search with all points in one cell, and the fixed work of a
// slice. The end of an alignment and one splatted point take less.
inline constexpr int k_follow_item_steps_max = k_nearest_steps_max + k_score_steps + 512;
static_assert(k_follow_item_steps_max > k_solve_steps + k_pair_steps &&
              k_follow_item_steps_max > k_splat_item_steps_max);

enum class FollowOutcome : std::uint8_t {
  followed,
  no_reference,  // begin() was not called
  late,          // not newer than the last image
  hidden,        // too little of the robot is visible
  unexplained,   // the scene does not explain the visible model at its pose
  unsure,        // noise too large to detect a jump
  jumped,        // the robot is found, but beyond the jump limits
};
[[nodiscard]] const char* name_of(FollowOutcome outcome) noexcept;

struct FollowedReference {
  Pose T_world_base;
  Matrix6 covariance = Matrix6::Zero();  // translation, rotation at the base's origin, world axes
  Time measured;                         // of the last image that was followed
};

// Result of the last image.
struct FollowReport {
  FollowOutcome outcome = FollowOutcome::no_reference;
  Time time;
  double shift_m = 0, turn_rad = 0;  // from the reference to the measured pose
  int jumps = 0;                     // consecutive images with outcome jumped
  ModelAlignment seen;
  AlignmentScore judgement;
};

class RobotPoseTracker {
 public:
  FollowSettings settings;

  // Allocates memory for images of `pixels` pixels and models of `corners` corners or points.
  // Reason::out_of_range: a size out of range, or a time constant or limit that is not positive.
  [[nodiscard]] Reason prepare(int pixels, int corners);

  // Sets the reference accepted at `time`.
  void begin(const Pose& T_world_base, const Matrix6& covariance, Time time) noexcept;

  // Starts an image; the view's memory must not change until step() returns false. Returns false
  // without a reference or if the image is late; the report states the reason.
  [[nodiscard]] bool look(const SceneView& view, Time time) noexcept;
  // Runs one slice; returns true while the image has more.
  [[nodiscard]] bool step() noexcept GLINT_NONBLOCKING;
  [[nodiscard]] int slices_max() const noexcept;
  // Runs one slice of about most_steps steps, for a point cloud model. Returns the steps taken: 0
  // if no image is pending, else at most most_steps + k_follow_item_steps_max.
  int step(int most_steps) noexcept GLINT_NONBLOCKING;
  // Returns true if no image is pending: borrowed data may be released.
  [[nodiscard]] bool idle() const noexcept { return phase_ == Phase::idle; }

  [[nodiscard]] const FollowReport& report() const noexcept { return report_; }
  // Reference with its covariance at `now`: includes the declared drift since the last update.
  [[nodiscard]] FollowedReference reference(Time now) const noexcept;

 private:
  enum class Phase : std::uint8_t { idle, align, judge };

  [[nodiscard]] bool step(StepBudget& budget) noexcept;
  void begin_judging() noexcept;
  void decide() noexcept;
  [[nodiscard]] FollowOutcome outcome() const noexcept;

  AlignmentScratch scratch_;
  AlignmentRun run_;
  AlignmentScoring judge_;
  SceneView view_;
  FollowReport report_;
  FollowedReference reference_;  // without drift
  Time newest_;
  Phase phase_ = Phase::idle;
  bool has_reference_ = false;
};

}  // namespace glint
