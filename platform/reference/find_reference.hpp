// Where the robot is: from a rough pose to one with its covariance and a verdict.
//
// The model is aligned from the pose given and from others about it (turned about the base's
// upright axis, which is how a robot is most alike, and shifted). Wherever those end elsewhere than
// the first, they are rivals: one that explains the scene nearly as well makes the result
// ambiguous, a better one takes its place.
#pragma once

#include <string>
#include <vector>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/judge_alignment.hpp"
#include "platform/reference/scene.hpp"

namespace glint {

enum class ReferenceVerdict { accepted, ambiguous, refused };
[[nodiscard]] std::string name_of(ReferenceVerdict verdict);

struct FindReferenceSettings {
  AlignmentSettings alignment;
  JudgeSettings judge;
  double inlier_share_min = 0.85;
  double seen_through_share_max = 0.08;
  // Less of the model in view says nothing about the rest.
  double visible_share_min = 0.4;
  // From one place of the camera without a mask: what hides the robot may as well be taken for it.
  double visible_share_min_alone = 0.75;
  // Flat things explain a robot that lies down on them, but do not end where it does: twice the
  // most that any such pose had in simulated scenes, of an xArm7 and, from one place, a Panda, too.
  double outline_share_min = 0.25;
  double outline_share_min_alone = 0.34;
  double mask_share_min = 0.7;  // of the mask's pixels that the model covers
  double sigma_max_m = 0.02;    // of the base's position, along the axis that is known worst
  double sigma_max_rad = 0.035;
  // A rival that nothing speaks against and that is worth this part of the first is nearly as good.
  double rival_share = 0.95;
  double elsewhere_m = 0.04, elsewhere_rad = 0.07;  // nearer than both is the same end
  bool other_starts = true;
};

struct Candidate {
  ModelAlignment alignment;
  Judgement judgement;
};

struct Reference {
  Candidate found;
  ReferenceVerdict verdict = ReferenceVerdict::refused;
  std::string why;                // of a verdict that is not "accepted"
  std::vector<Candidate> rivals;  // ends elsewhere that explain the scene nearly as well
  int starts = 0;
};

// seed: T_camera_base. Deterministic: the same frames and seed give the same bits.
[[nodiscard]] Reference find_reference(const std::vector<SceneFrame>& frames, const Pose& seed,
                                       const FindReferenceSettings& settings);

// x, y, z, roll, pitch, yaw: metres and radians, about fixed axes, as a URDF has it.
[[nodiscard]] Pose pose_of_seed(const std::vector<double>& seed);

}  // namespace glint
