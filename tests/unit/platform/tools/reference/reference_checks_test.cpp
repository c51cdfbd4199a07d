#include "platform/tools/reference/reference_checks.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

LinkJudgement three_links(const LinkCounts& last) {
  LinkJudgement links;
  links.links[0] = {1000, 950, 10};
  links.links[1] = {1000, 940, 20};
  links.links[2] = last;
  return links;
}

TEST(ReferenceChecks, NamesALinkThatTheSceneDoesNotExplain) {
  EXPECT_EQ(link_objection(three_links({300, 280, 5}), {}), "");
  const std::string unexplained = link_objection(three_links({300, 90, 5}), {});
  EXPECT_NE(unexplained.find("link 2"), std::string::npos) << unexplained;
  EXPECT_NE(unexplained.find("30.0 % of it lies at the scene"), std::string::npos) << unexplained;
  const std::string through = link_objection(three_links({300, 180, 120}), {});
  EXPECT_NE(through.find("seen through 40.0 %"), std::string::npos) << through;
}

TEST(ReferenceChecks, JudgesNoLinkOfWhichLittleIsSeen) {
  EXPECT_EQ(link_objection(three_links({60, 0, 60}), {}), "");
  EXPECT_NE(link_objection(three_links({100, 0, 100}), {}), "");
}

// A candidate that is fully visible and all inliers, with these outline and surface scores.
Candidate end_of(double surface_score, double granted, int falls, int goes_on) {
  Candidate end;
  end.alignment.covariance = 1e-6 * Matrix6::Identity();
  end.judgement.rendered = end.judgement.measured = end.judgement.inliers = 1000;
  end.judgement.outline = {falls, goes_on};
  end.surface_score = surface_score;
  end.surface_score_granted = granted;
  return end;
}

TEST(ReferenceChecks, AcceptsARightEndWhoseOutlineContinuesInPart) {
  const FindReferenceSettings settings;
  EXPECT_EQ(objection(end_of(0.36, 0.36, 100, 500), settings), "");
  EXPECT_NE(objection(end_of(0.2, 0.2, 100, 500), settings).find("outline"), std::string::npos);
  EXPECT_NE(objection(end_of(0.1, 0.1, 500, 0), settings).find("surface"), std::string::npos);
}

TEST(ReferenceChecks, WeighsAnOutlineThatFallsAwayFarEnoughAsAnyOther) {
  const FindReferenceSettings settings;
  EXPECT_EQ(worth(end_of(0.3, 0.3, 400, 500), settings), 0.3);
  EXPECT_LT(worth(end_of(0.3, 0.3, 100, 900), settings), 0.15);
}

TEST(ReferenceChecks, GrantsARivalTheErrorsThatAPictureShares) {
  const FindReferenceSettings settings;
  const Candidate found = end_of(0.4, 0.4, 900, 0);
  EXPECT_TRUE(rivals(end_of(0.2, 0.3, 900, 0), found, settings));
  EXPECT_FALSE(rivals(end_of(0.2, 0.27, 900, 0), found, settings));
  EXPECT_FALSE(rivals(end_of(0.2, 0.3, 100, 900), found, settings));
  Candidate open = end_of(0.4, 0.4, 900, 0);
  open.alignment.reason = Reason::degenerate;
  EXPECT_FALSE(rivals(open, found, settings));
}

TEST(ReferenceChecks, NamesAPictureThatDisagreesWithTheOthers) {
  Judgement picture;
  picture.rendered = picture.measured = 1000;
  picture.inliers = 900;
  EXPECT_EQ(picture_objection("a.npy", picture, {}), "");
  picture.inliers = 600;
  EXPECT_EQ(picture_objection("a.npy", picture, {}).rfind("a.npy: ", 0), 0u);
  picture.inliers = 800;
  picture.seen_through = 200;
  EXPECT_NE(picture_objection("a.npy", picture, {}).find("20.0 %"), std::string::npos);
}

}  // namespace
}  // namespace glint
