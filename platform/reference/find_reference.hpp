// Where the robot is: from a rough pose to one with its covariance and a verdict.
//
// The model is aligned from the pose given and from the best poses of a declared range about it
// (coarse_search.hpp), and from turns about the base's upright axis, about which a robot is most
// alike. The best end is accepted if nothing speaks against it (reference_checks.hpp) and no other
// end explains the scene nearly as well: such a rival makes the result ambiguous.
#pragma once

#include <string>
#include <vector>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/judge_alignment.hpp"
#include "kernels/registration/shared_errors.hpp"
#include "platform/reference/coarse_search.hpp"
#include "platform/reference/scene.hpp"

namespace glint {

enum class ReferenceVerdict { accepted, ambiguous, refused };
[[nodiscard]] std::string name_of(ReferenceVerdict verdict);

struct FindReferenceSettings {
  AlignmentSettings alignment;
  JudgeSettings judge;
  SharedErrors shared_errors;
  double inlier_share_min = 0.85;
  double seen_through_share_max = 0.08;
  // Less of the model in view says nothing about the rest.
  double visible_share_min = 0.4;
  // From one place of the camera without a mask: what hides the robot may as well be taken for it.
  double visible_share_min_alone = 0.75;
  // Of worth(), which weighs the outline, a visible share: wrong ends of simulated scenes reach
  // 0.14, right ones 0.19.
  double worth_min = 0.15;
  // Flat things explain a robot that lies down on them, but do not end where it does. An outline
  // that falls away beside this share of it is not worth more than another: twice the most that
  // any such pose had in simulated scenes.
  double outline_share_enough = 0.34;
  double outline_share_min = 0.12;  // what lies flat altogether has less
  double mask_share_min = 0.7;      // of the mask's pixels that the model covers
  double sigma_max_m = 0.02;        // of the base's position, along the axis that is known worst
  double sigma_max_rad = 0.035;
  // A link of this part of the robot's pixels is judged by itself: other joint values move it.
  double link_pixels_min = 0.04;
  double link_explained_min = 0.5;
  double link_seen_through_max = 0.35;
  // Of each of several pictures by itself.
  double picture_inlier_share_min = 0.7;
  double picture_seen_through_max = 0.16;
  // A rival that is worth this part of the first is nearly as good. It is granted twice the depth
  // error that a whole picture shares.
  double rival_share = 0.7;
  double elsewhere_m = 0.04;  // root mean square over the robot's surface: nearer is the same end
  SearchRange range;          // about the rough pose
  bool other_starts = true;
};

struct Candidate {
  ModelAlignment alignment;
  Judgement judgement;
  // Of CoarseSearch: as it is, and with shared depth errors granted.
  double surface_score = 0, surface_score_granted = 0;
};

struct Reference {
  Candidate found;
  ReferenceVerdict verdict = ReferenceVerdict::refused;
  std::string why;                // of a verdict that is not "accepted"
  std::vector<Candidate> rivals;  // ends elsewhere that explain the scene nearly as well
  int starts = 0;                 // that were aligned
};

// seed: T_camera_base. Deterministic: the same frames and seed give the same bits.
[[nodiscard]] Reference find_reference(const std::vector<SceneFrame>& frames, const Pose& seed,
                                       const FindReferenceSettings& settings);

// x, y, z, roll, pitch, yaw: metres and radians, about fixed axes, as a URDF has it.
[[nodiscard]] Pose pose_of_seed(const std::vector<double>& seed);

}  // namespace glint
