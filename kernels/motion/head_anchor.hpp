// Holds the headset's world to a body that does not move: what the headset's own localisation is
// off by, from where it puts that body, and how sure that is.
//
// What:     the error e (a shift and a small rotation about the body's place) is the walk of
//           head_walk.hpp; each sight of the body measures it. Corrected poses are those relative
//           to the body, as long as it is in view; hidden, the correction fades and its covariance
//           grows to the headset's. One filter for each of k_drift_factors times the declared
//           deviations; the one under which the newest sights are likeliest is given. So a headset
//           that drifts more than is declared is held to the body all the same.
// Cost:     for each factor one 6x6 Cholesky factor and a few products: 27,000 to 32,000
//           instructions in all (schedules/boards).
// Worst:    the body in view, none is worse than another.
// Accuracy: the body's own, filtered as far as the headset's error allows. The body's first
//           k_anchor_frames sights define where it is; what they are off by moves the whole world.
// Source:   Bar-Shalom, Li and Kirubarajan 2001, section 5.2 (the update, in Joseph's form, whose
//           two terms are given apart) and 11.6.2 (models compared by their likelihoods).
#pragma once

#include <array>
#include <cstddef>

#include "kernels/motion/head_walk.hpp"
#include "kernels/motion/motion_state.hpp"
#include "kernels/nonblocking.hpp"
#include "kernels/pose/head_pose.hpp"

namespace glint {

inline constexpr int k_anchor_frames = 45;  // 1 s
// Chi square of 6 degrees of freedom, 1e-6: beyond it something else was taken for the body ..
inline constexpr double k_anchor_chi_square_max = 38.3;
// .. unless it goes on for 0.2 s: then the headset has lost its place and found another, and the
// body, which is declared not to move, is believed.
inline constexpr int k_anchor_refused_max = 9;
// None below 1: a drift that is stated too large costs little, one too small the body's hold.
inline constexpr std::array<double, 5> k_drift_factors{1, 3, 10, 30, 100};

// The head's pose of one frame, corrected, with what its error adds to every pose in the world.
struct AnchoredHead {
  HeadPose head;
  Vector3 pivot_m = Vector3::Zero();  // in the world: both covariances are about it
  Matrix6 fresh = Matrix6::Zero();    // new in this frame: noise among other noise
  Matrix6 lasting = Matrix6::Zero();  // kept from the frames before: shared by all of them
  Matrix6 stepped = Matrix6::Zero();  // of what came since the frame before; zero but in a gap
  Pose moved;                         // what moves poses of before along: after a gap
  bool corrected = false;             // by this frame's sight of the body
  bool moved_along = false;           // `moved` is not the identity
  // The body is hidden now or was in the frame before: against poses of before the head has moved
  // by an error of this covariance, which no sight of the body took away.
  bool in_gap = false;

  // Of a pose at `point_m`, about the world's axes.
  [[nodiscard]] Matrix6 fresh_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 lasting_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
  [[nodiscard]] Matrix6 stepped_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;
};

class HeadAnchor {
 public:
  // body: T_camera_body with its covariance about the camera's axes at the body's origin; null
  // where this frame does not show it, or no body is declared. Frames come in the order of time.
  [[nodiscard]] AnchoredHead update(const HeadPose& head, const UncertainPose* body,
                                    const HeadNoise& noise) noexcept GLINT_NONBLOCKING;
  // The head's pose as the correction of the frame before has it.
  [[nodiscard]] Pose corrected(const Pose& T_world_camera) const noexcept GLINT_NONBLOCKING;
  // Of the error that the headset is left with where no body is seen for long, at its speed now.
  [[nodiscard]] Matrix6 uncorrected_at(const Vector3& point_m) const noexcept GLINT_NONBLOCKING;

  [[nodiscard]] bool known() const { return sights_ > 0; }
  [[nodiscard]] const Pose& T_world_body() const { return T_world_body_; }  // once known()
  [[nodiscard]] int jumps() const { return jumps_; }  // of the headset, as the body shows
  // Of the declared deviations, that which holds now.
  [[nodiscard]] double drift_factor() const { return k_drift_factors[best_]; }
  // The stamps begin anew: the head's motion before does not count.
  void restart_clock() noexcept { walk_.restart_clock(); }

 private:
  // Under one factor.
  struct Held {
    Vector6 error = Vector6::Zero();  // of the head, about T_world_body_'s origin
    Matrix6 covariance = Matrix6::Zero();
    int refused = 0;            // in a row
    double log_likelihood = 0;  // of the newest sights
  };
  // What one sight left of a covariance: AnchoredHead.
  struct Corrected {
    Matrix6 fresh, lasting;
    bool accepted = false, jumped = false;
  };
  void walk_on(const HeadPose& head, const HeadNoise& noise);
  void define(const UncertainPose& T_world_body);
  [[nodiscard]] Corrected correct(const UncertainPose& T_world_body, Held& held) const;
  void correct_all(const UncertainPose& T_world_body, AnchoredHead& out);

  int sights_ = 0;  // that defined the body's place, up to k_anchor_frames
  int unseen_ = 0;  // frames in a row
  int jumps_ = 0;
  Pose T_world_body_;
  std::array<Held, k_drift_factors.size()> held_;
  std::size_t best_ = 0;
  WalkedError walked_;  // since the frame before, of factor 1
  HeadWalk walk_;
};

}  // namespace glint
