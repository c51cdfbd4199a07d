// A robot's pose kept up while running: slow drift is followed, a jump is refused and told.
//
// What:     from the last accepted reference, one depth picture at a time: the model is aligned
//           from where it is taken to be and judged; if it is there, near, and surely so, the pose
//           goes the part 1 - exp(-dt / time_constant) of the way. Else it stays, with the reason.
// Cost:     slices_max() slices a picture: renderings of the model, steps of Gauss-Newton, and one
//           judgement, the largest: a rendering, a grid of the picture and a search a pixel. Or as
//           many as it takes, each of so many steps (slice_size.hpp): the same bits.
// Worst:    a model that fills the picture and does not come to rest.
// Accuracy: drift is followed drift * time_constant late; what it says of itself is the filtered
//           noise of the pictures and what the declared drift may have done since.
// Source:   a first-order low-pass, e.g. Gelb 1974, example 4.2-4; the noise of its mean follows
//           from its gain.
#pragma once

#include <cstdint>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/judge_alignment.hpp"
#include "kernels/units.hpp"

namespace glint {

// From where the robot is taken to be, and only near it: 6 cm shows a jump as such.
[[nodiscard]] constexpr AlignmentSettings near_alignment() {
  AlignmentSettings settings;
  settings.gates[0] = {0.06, Matching::projective, 2, 6, true};
  settings.gates[1] = {0.035, Matching::projective, 1, 8, true};
  settings.gate_count = 2;
  return settings;
}

struct FollowSettings {
  double time_constant_s = 2;
  // The fastest drift that is to be followed: of a headset that tracks its room well.
  double drift_m_s = 1e-3;
  double drift_rad_s = 1e-3;
  // What moves farther from one picture to the next than this did not drift. Measured at the middle
  // of what is seen. Single pictures of a real robot lie 5 to 11 mm from each other.
  double jump_m = 0.02;
  double jump_rad = 0.035;
  // As in a first search.
  double visible_share_min = 0.4;
  double inlier_share_min = 0.85;
  double seen_through_share_max = 0.08;
  AlignmentSettings alignment = near_alignment();
  JudgeSettings judge;
};

// A look for the nearest point where all points crowd into one cell; the end of an alignment; a
// slice begins with no more of what a budget does not know.
inline constexpr int k_follow_item_steps_max = k_nearest_steps_max + k_judged_steps + 512;
static_assert(k_follow_item_steps_max > k_solve_steps + k_pair_steps &&
              k_follow_item_steps_max > k_splat_item_steps_max);

enum class FollowOutcome : std::uint8_t {
  followed,
  no_reference,  // begin() was not called
  late,          // not newer than the last picture
  hidden,        // too little of the robot is seen
  unexplained,   // what is seen is not the robot, here or near by
  unsure,        // a jump could not be told from noise
  jumped,        // the robot is found, but beyond what drifts
};
[[nodiscard]] const char* name_of(FollowOutcome outcome) noexcept;

struct FollowedReference {
  Pose T_world_base;
  Matrix6 covariance = Matrix6::Zero();  // of shift and turn about the base's origin, world axes
  Time measured;                         // of the last picture that was followed
};

// What the last picture said.
struct FollowReport {
  FollowOutcome outcome = FollowOutcome::no_reference;
  Time time;
  double shift_m = 0, turn_rad = 0;  // from where the robot was taken to be to where it was seen
  int jumps = 0;                     // pictures one after the other that jumped
  ModelAlignment seen;
  Judgement judgement;
};

class ReferenceFollower {
 public:
  FollowSettings settings;

  // Allocates, for pictures of so many pixels and models of so many corners or points.
  // Reason::out_of_range: a size that is none, or a time constant or limit that is not positive.
  [[nodiscard]] Reason prepare(int pixels, int corners);

  // A reference that was accepted at this time.
  void begin(const Pose& T_world_base, const Matrix6& covariance, Time time) noexcept;

  // Takes up a picture; the view's memory must stay until step() says false. False, and the report
  // says why: there is no reference, or the picture is late.
  [[nodiscard]] bool look(const SceneView& view, Time time) noexcept;
  // One slice; true while the picture has more.
  [[nodiscard]] bool step() noexcept GLINT_NONBLOCKING;
  [[nodiscard]] int slices_max() const noexcept;
  // One slice of so many steps, for a model of points; gives the steps that it took: 0 if there is
  // no picture under way, else at most most_steps + k_follow_item_steps_max.
  int step(int most_steps) noexcept GLINT_NONBLOCKING;
  // Whether no picture is under way: what the last one borrowed may go.
  [[nodiscard]] bool idle() const noexcept { return phase_ == Phase::idle; }

  [[nodiscard]] const FollowReport& report() const noexcept { return report_; }
  // Its covariance holds what the declared drift may have done until then.
  [[nodiscard]] FollowedReference reference(Time now) const noexcept;

 private:
  enum class Phase : std::uint8_t { idle, align, judge };

  [[nodiscard]] bool step(StepBudget& budget) noexcept;
  void begin_judging() noexcept;
  void decide() noexcept;
  [[nodiscard]] FollowOutcome outcome() const noexcept;

  AlignmentScratch scratch_;
  AlignmentRun run_;
  JudgeRun judge_;
  SceneView view_;
  FollowReport report_;
  FollowedReference reference_;  // without drift
  Time newest_;
  Phase phase_ = Phase::idle;
  bool known_ = false;
};

}  // namespace glint
