#include "platform/tools/reference/reference_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "platform/dense.hpp"

namespace glint {
namespace {

std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * share);
  return text;
}

double outline_factor(const Candidate& candidate, const FindReferenceSettings& settings) {
  return std::min(1.0, candidate.judgement.outline_share() / settings.outline_share_full);
}

}  // namespace

double pose_score(const Candidate& candidate, const FindReferenceSettings& settings) {
  return candidate.surface_score * outline_factor(candidate, settings);
}

bool is_alternative(const Candidate& other, const Candidate& found,
                    const FindReferenceSettings& settings) {
  if (other.alignment.reason != Reason::none) return false;
  return other.surface_score_tolerant * outline_factor(other, settings) >=
         settings.alternative_share * pose_score(found, settings);
}

std::string rejection_reason(const Candidate& candidate, const FindReferenceSettings& settings) {
  const AlignmentScore& j = candidate.judgement;
  if (candidate.alignment.reason != Reason::none) {
    return "too little of the robot is visible to determine a pose";
  }
  if (j.visible_share() < settings.visible_share_min) {
    return "only " + percent(j.visible_share()) + " of the robot is visible; expected at least " +
           percent(settings.visible_share_min) +
           (settings.visible_share_min < settings.visible_share_min_one_position
                ? ""
                : " from one viewpoint without a mask");
  }
  if (j.inlier_share() < settings.inlier_share_min) {
    return "only " + percent(j.inlier_share()) +
           " of the robot lies on the scene; expected at least " +
           percent(settings.inlier_share_min);
  }
  if (j.unhidden_seen_through_share() > settings.seen_through_share_max) {
    return "free space at " + percent(j.unhidden_seen_through_share()) +
           " of the robot's unoccluded surface; expected at most " +
           percent(settings.seen_through_share_max);
  }
  if (j.outline_share() < settings.outline_share_min) {
    return "the scene continues beside " + percent(1 - j.outline_share()) +
           " of the robot's outline, as a flat object does; expected at most " +
           percent(1 - settings.outline_share_min);
  }
  const double score_min = settings.score_min * j.visible_share();
  if (pose_score(candidate, settings) < score_min) {
    return "the scene explains too little of the robot's surface, or continues beside its outline: "
           "score " +
           percent(pose_score(candidate, settings)) + "; expected at least " + percent(score_min);
  }
  if (j.mask_pixels > 0 && j.mask_share() < settings.mask_share_min) {
    return "the robot covers only " + percent(j.mask_share()) + " of the mask; expected at least " +
           percent(settings.mask_share_min);
  }
  const Matrix6& covariance = candidate.alignment.covariance;
  if (largest_sigma(covariance.topLeftCorner<3, 3>()) > settings.sigma_max_m ||
      largest_sigma(covariance.bottomRightCorner<3, 3>()) > settings.sigma_max_rad) {
    return "the scene does not determine the pose along one direction";
  }
  return "";
}

std::string link_rejection_reason(const LinkScores& links, const FindReferenceSettings& settings) {
  int all = 0;
  for (const LinkCounts& link : links.links) all += link.looked_at;
  for (std::size_t l = 0; l < links.links.size(); ++l) {
    const LinkCounts& link = links.links[l];
    if (link.looked_at == 0 || link.looked_at < settings.link_pixels_min * all) continue;
    const double explained = static_cast<double>(link.explained) / link.looked_at;
    const double through = static_cast<double>(link.free_space_violations) / link.looked_at;
    const std::string name = "link " + std::to_string(l) + " does not fit its joint values: ";
    if (explained < settings.link_explained_min) {
      return name + "only " + percent(explained) + " of it lies on the scene; expected at least " +
             percent(settings.link_explained_min);
    }
    if (through > settings.link_seen_through_max) {
      return name + "free space at " + percent(through) + " of it; expected at most " +
             percent(settings.link_seen_through_max);
    }
  }
  return "";
}

std::string image_rejection_reason(const std::string& name, const AlignmentScore& picture,
                                   const FindReferenceSettings& settings) {
  if (picture.inlier_share() >= settings.image_inlier_share_min &&
      picture.unhidden_seen_through_share() <= settings.image_seen_through_max) {
    return "";
  }
  return name + ": the common pose does not fit this image: " + percent(picture.inlier_share()) +
         " of the robot lies on the scene, free space at " +
         percent(picture.unhidden_seen_through_share()) + "; expected at least " +
         percent(settings.image_inlier_share_min) + " and at most " +
         percent(settings.image_seen_through_max);
}

bool better(const Candidate& a, const Candidate& b, const FindReferenceSettings& settings) {
  const bool a_good = rejection_reason(a, settings).empty(),
             b_good = rejection_reason(b, settings).empty();
  return a_good == b_good ? pose_score(a, settings) > pose_score(b, settings) : a_good;
}

}  // namespace glint
