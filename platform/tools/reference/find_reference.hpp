// Registration of a robot model to depth images: from a rough pose to T_camera_base with covariance
// and verdict.
//
// Aligns the model from the given pose and from the best poses of a declared range about it
// (coarse_search.hpp). Also aligns rotations of it about the base's upright axis, about which a
// robot is nearly symmetric. Accepts the best converged pose if no check rejects it
// (reference_checks.hpp) and no other pose explains the scene nearly as well. Such an alternative
// makes the result ambiguous.
#pragma once

#include <string>
#include <vector>

#include "kernels/registration/align_model.hpp"
#include "kernels/registration/judge_alignment.hpp"
#include "kernels/registration/shared_errors.hpp"
#include "platform/tools/reference/coarse_search.hpp"
#include "platform/tools/reference/scene.hpp"

namespace glint {

enum class ReferenceVerdict { accepted, ambiguous, refused };
[[nodiscard]] std::string name_of(ReferenceVerdict verdict);

struct FindReferenceSettings {
  AlignmentSettings alignment;
  ScoreSettings judge;
  SystematicErrors shared_errors;
  double inlier_share_min = 0.85;
  double seen_through_share_max = 0.08;
  // A smaller visible share does not constrain the rest of the robot.
  double visible_share_min = 0.4;
  // For one camera position without a mask: an occluder may be mistaken for the robot.
  double visible_share_min_one_position = 0.75;
  // Of pose_score() (with the outline's factor), per visible share: wrong poses of simulated scenes
  // reach 0.14, right ones 0.19.
  double score_min = 0.15;
  // Flat objects explain a robot that lies on them, but extend beyond its outline. Above this
  // outline share the outline's factor is 1: twice the maximum of any such pose in simulated
  // scenes.
  double outline_share_full = 0.34;
  double outline_share_min = 0.12;  // flat objects have less
  double mask_share_min = 0.7;      // share of the mask's pixels that the model covers
  double sigma_max_m = 0.02;        // of the base's position, least certain axis
  double sigma_max_rad = 0.035;
  // A link with at least this share of the robot's pixels is checked by itself: other joint values
  // move it.
  double link_pixels_min = 0.04;
  double link_explained_min = 0.5;
  double link_seen_through_max = 0.35;
  // For each of several images by itself.
  double image_inlier_share_min = 0.7;
  double image_seen_through_max = 0.16;
  // An alternative pose with this share of the best score makes the result ambiguous. Its score
  // includes an allowance of twice the depth error shared by a whole image.
  double alternative_share = 0.7;
  double distinct_min_m = 0.04;  // rms over the robot's surface; nearer poses are the same
  SearchRange range;             // about the rough pose
  bool search_alternatives = true;
};

struct Candidate {
  ModelAlignment alignment;
  AlignmentScore judgement;
  // CoarseSearch::score, and the same with the allowance for shared depth errors.
  double surface_score = 0, surface_score_tolerant = 0;
};

struct Reference {
  Candidate found;
  ReferenceVerdict verdict = ReferenceVerdict::refused;
  std::string reason;                   // reason of a verdict other than "accepted"
  std::vector<Candidate> alternatives;  // alternative poses that explain the scene nearly as well
  int starts = 0;                       // number of alignments
};

// initial_guess: of T_camera_base. Deterministic: equal frames and guess give equal bits.
[[nodiscard]] Reference find_reference(const std::vector<SceneFrame>& frames,
                                       const Pose& initial_guess,
                                       const FindReferenceSettings& settings);

// Input: x, y, z, roll, pitch, yaw in metres and radians, about fixed axes, as in URDF.
[[nodiscard]] Pose pose_from_xyz_rpy(const std::vector<double>& xyz_rpy);

}  // namespace glint
