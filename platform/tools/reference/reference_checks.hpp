// Acceptance tests and score of a converged pose in model registration.
#pragma once

#include <span>
#include <string>

#include "kernels/registration/judge_links.hpp"
#include "platform/tools/reference/find_reference.hpp"

namespace glint {

// Score, at most 1: share of the robot's surface explained by the scene, times the outline's
// factor. Parts occluded by the scene or outside the image count as unexplained.
[[nodiscard]] double pose_score(const Candidate& candidate, const FindReferenceSettings& settings);

// Returns whether another pose scores nearly as well as the one found.
[[nodiscard]] bool is_alternative(const Candidate& other, const Candidate& found,
                                  const FindReferenceSettings& settings);

// Returns why the pose is rejected; empty if it is accepted.
[[nodiscard]] std::string rejection_reason(const Candidate& candidate,
                                           const FindReferenceSettings& settings);

// The same for single links: wrong joint values or another robot leave some links unexplained.
[[nodiscard]] std::string link_rejection_reason(const LinkScores& links,
                                                const FindReferenceSettings& settings);

// The same for one of several images: each must agree with the joint pose.
[[nodiscard]] std::string image_rejection_reason(const std::string& name,
                                                 const AlignmentScore& picture,
                                                 const FindReferenceSettings& settings);

// Order of poses: accepted before rejected ones, then by score.
[[nodiscard]] bool better(const Candidate& a, const Candidate& b,
                          const FindReferenceSettings& settings);

}  // namespace glint
