#include "platform/tools/reference/reference_checks.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

LinkScores three_links(const LinkCounts& last) {
  LinkScores links;
  links.links[0] = {1000, 950, 10};
  links.links[1] = {1000, 940, 20};
  links.links[2] = last;
  return links;
}

TEST(ReferenceChecks, NamesALinkThatTheSceneDoesNotExplain) {
  EXPECT_EQ(link_rejection_reason(three_links({300, 280, 5}), {}), "");
  const std::string unexplained = link_rejection_reason(three_links({300, 90, 5}), {});
  EXPECT_NE(unexplained.find("link 2"), std::string::npos) << unexplained;
  EXPECT_NE(unexplained.find("30.0 % of it lies on the scene"), std::string::npos) << unexplained;
  const std::string through = link_rejection_reason(three_links({300, 180, 120}), {});
  EXPECT_NE(through.find("free space at 40.0 %"), std::string::npos) << through;
}

TEST(ReferenceChecks, JudgesNoLinkOfWhichLittleIsSeen) {
  EXPECT_EQ(link_rejection_reason(three_links({60, 0, 60}), {}), "");
  EXPECT_NE(link_rejection_reason(three_links({100, 0, 100}), {}), "");
}

// A candidate that is fully visible and all inliers, with these outline and surface scores.
Candidate end_of(double surface_score, double tolerant, int falls, int goes_on) {
  Candidate end;
  end.alignment.covariance = 1e-6 * Matrix6::Identity();
  end.judgement.rendered = end.judgement.measured = end.judgement.inliers = 1000;
  end.judgement.outline = {falls, goes_on};
  end.surface_score = surface_score;
  end.surface_score_tolerant = tolerant;
  return end;
}

TEST(ReferenceChecks, AcceptsARightEndWhoseOutlineContinuesInPart) {
  const FindReferenceSettings settings;
  EXPECT_EQ(rejection_reason(end_of(0.36, 0.36, 100, 500), settings), "");
  EXPECT_NE(rejection_reason(end_of(0.2, 0.2, 100, 500), settings).find("outline"),
            std::string::npos);
  EXPECT_NE(rejection_reason(end_of(0.1, 0.1, 500, 0), settings).find("surface"),
            std::string::npos);
}

TEST(ReferenceChecks, WeighsAnOutlineThatFallsAwayFarEnoughAsAnyOther) {
  const FindReferenceSettings settings;
  EXPECT_EQ(pose_score(end_of(0.3, 0.3, 400, 500), settings), 0.3);
  EXPECT_LT(pose_score(end_of(0.3, 0.3, 100, 900), settings), 0.15);
}

TEST(ReferenceChecks, GrantsARivalTheErrorsThatAPictureShares) {
  const FindReferenceSettings settings;
  const Candidate found = end_of(0.4, 0.4, 900, 0);
  EXPECT_TRUE(is_alternative(end_of(0.2, 0.3, 900, 0), found, settings));
  EXPECT_FALSE(is_alternative(end_of(0.2, 0.27, 900, 0), found, settings));
  EXPECT_FALSE(is_alternative(end_of(0.2, 0.3, 100, 900), found, settings));
  Candidate open = end_of(0.4, 0.4, 900, 0);
  open.alignment.reason = Reason::degenerate;
  EXPECT_FALSE(is_alternative(open, found, settings));
}

TEST(ReferenceChecks, NamesAPictureThatDisagreesWithTheOthers) {
  AlignmentScore picture;
  picture.rendered = picture.measured = 1000;
  picture.inliers = 900;
  EXPECT_EQ(image_rejection_reason("a.npy", picture, {}), "");
  picture.inliers = 600;
  EXPECT_EQ(image_rejection_reason("a.npy", picture, {}).rfind("a.npy: ", 0), 0u);
  picture.inliers = 800;
  picture.free_space_violations = 200;
  EXPECT_NE(image_rejection_reason("a.npy", picture, {}).find("20.0 %"), std::string::npos);
}

}  // namespace
}  // namespace glint
