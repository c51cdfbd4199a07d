// One sentence a situation, and which of two causes comes first.
#include "platform/tools/inspect/explanation.hpp"

#include <gtest/gtest.h>

namespace glint::explanation_test {
namespace {

// Frames arrive, and the newest one has no region at all.
ExplainedSituation lost() {
  ExplainedSituation now;
  now.state = TrackState::lost;
  now.reason = Reason::too_few_markers;
  now.markers = 5;
  now.unmeasured_for = milliseconds(700);
  now.ever_measured = true;
  now.any_frame = true;
  now.frame_gap = milliseconds(20);
  now.frame_gap_max = milliseconds(500);
  now.frame_age = milliseconds(10);
  now.lost_after = milliseconds(250);
  now.regions = ObservedRegions{1280, 5000, 0.001, {}, false};
  now.range_min_m = 0.15;
  now.range_max_m = 0.9;
  return now;
}

ExplainedSituation never_found() {
  ExplainedSituation now = lost();
  now.ever_measured = false;
  return now;
}

ExplainedSituation with_counts(ExplainedSituation now, RegionCounts counts) {
  now.regions->counts = counts;
  return now;
}

TEST(Explanation, OfATrackedToolNamesItsMarkers) {
  ExplainedSituation now = lost();
  now.state = TrackState::measured;
  now.reason = Reason::none;
  now.markers_used = 4;
  const Explanation explanation = explain(now);
  EXPECT_EQ(explanation.state, "measured");
  EXPECT_EQ(explanation.reason, "");
  EXPECT_EQ(explanation.text, "Tracked by 4 of 5 markers.");
}

TEST(Explanation, OfTwoMarkersAsksForMore) {
  ExplainedSituation now = lost();
  now.state = TrackState::measured;
  now.markers_used = 2;
  EXPECT_EQ(explain(now).text, "Tracked by 2 of 5 markers and its motion. Uncover the others.");
}

TEST(Explanation, OfAPredictionStatesItsAge) {
  ExplainedSituation now = lost();
  now.state = TrackState::predicted;
  now.unmeasured_for = milliseconds(120);
  const Explanation explanation = explain(now);
  EXPECT_EQ(explanation.state, "predicted");
  EXPECT_EQ(explanation.reason, "too_few_markers");
  EXPECT_EQ(explanation.text,
            "Predicted for 0.1 s, lost after 0.25 s: no marker is visible. Uncover the markers, or "
            "bring the tool into view and turn it to the camera.");
}

TEST(Explanation, OfAllMarkersHidden) {
  const Explanation explanation = explain(lost());
  EXPECT_EQ(explanation.state, "lost");
  EXPECT_EQ(explanation.text,
            "Not tracked: no marker is visible. Uncover the markers, or bring the tool into view "
            "and turn it to the camera.");
}

TEST(Explanation, OfSomeMarkersHidden) {
  EXPECT_EQ(explain(with_counts(lost(), {.candidates = 2})).text,
            "Not tracked: 2 spots of a marker's size are visible, a pose needs 3. Uncover the "
            "markers, or bring the tool into view and turn it to the camera.");
}

TEST(Explanation, OfHiddenMarkersAmongStrayReflections) {
  ExplainedSituation now = with_counts(lost(), {.candidates = 6});
  now.reason = Reason::no_labeling;
  EXPECT_EQ(explain(now).text,
            "Not tracked: its markers are not visible, none of the 6 spots in view belongs to it. "
            "Uncover the markers, or bring the tool into view and turn it to the camera.");
}

TEST(Explanation, OfAThresholdThatNoPixelExceeds) {
  ExplainedSituation now = never_found();
  now.regions->threshold = 60000;
  const Explanation explanation = explain(now);
  EXPECT_EQ(explanation.state, "never_found");
  EXPECT_EQ(explanation.text,
            "Not found: no pixel exceeds the threshold of 60000 counts, the brightest has 5000. "
            "Bring the tool into view; if it is, set [camera] threshold below 5000.");
}

TEST(Explanation, OfAThresholdThatHalfThePictureExceeds) {
  ExplainedSituation now = lost();
  now.regions->threshold = 40;
  now.regions->bright_share = 0.52;
  EXPECT_EQ(explain(now).text,
            "Not tracked: 52 % of the picture exceed the threshold of 40 counts. Set a higher "
            "[camera] threshold.");
}

TEST(Explanation, KeepsAThresholdThatTheToolWasTrackedWith) {
  ExplainedSituation now = lost();
  now.regions->brightest = 900;
  EXPECT_EQ(explain(now).text.find("threshold"), std::string::npos) << explain(now).text;
}

TEST(Explanation, OfSmallSpotsStatesTheirDistance) {
  EXPECT_EQ(explain(with_counts(lost(), {.too_small = 3, .too_small_range_m = 1.31})).text,
            "Not tracked: 3 spots are too small, at 1.31 m. Move closer than 0.90 m.");
  EXPECT_EQ(explain(with_counts(lost(), {.candidates = 2, .too_small = 1})).text,
            "Not tracked: 1 spot is too small. Move closer than 0.90 m.");
}

TEST(Explanation, OfLargeSpotsAsksForDistance) {
  EXPECT_EQ(explain(with_counts(lost(), {.too_large = 4})).text,
            "Not tracked: 4 spots are too large for a marker. Move farther than 0.15 m, or check "
            "radius_mm of the tool's file.");
}

TEST(Explanation, OfSpotsAtTheEdge) {
  EXPECT_EQ(explain(with_counts(lost(), {.candidates = 2, .touching_edge = 1})).text,
            "Not tracked: 1 spot is cut by the edge of the picture. Bring the tool to the middle "
            "of the picture.");
}

TEST(Explanation, OfSpotsWithoutDepth) {
  EXPECT_EQ(explain(with_counts(lost(), {.no_depth = 5})).text,
            "Not tracked: 5 spots have no depth. Hold the tool between 0.15 and 0.90 m.");
}

TEST(Explanation, OfAToolThatLeftThePicture) {
  ExplainedSituation now = lost();
  now.left_view = LeftView::left;
  EXPECT_EQ(explain(now).text,
            "Not tracked: the tool left the picture at its left edge. Turn the headset to the "
            "tool, or bring the tool back.");
}

TEST(Explanation, OfAToolThatMovedAway) {
  ExplainedSituation now = lost();
  now.left_view = LeftView::far;
  EXPECT_EQ(explain(now).text,
            "Not tracked: the tool moved farther away than 0.90 m. Move closer.");
}

TEST(Explanation, OfNoFrameAtAll) {
  ExplainedSituation now = never_found();
  now.state = TrackState::none;
  now.reason = Reason::no_frame_yet;
  now.any_frame = false;
  now.regions.reset();
  const Explanation explanation = explain(now);
  EXPECT_EQ(explanation.state, "never_found");
  EXPECT_EQ(explanation.reason, "no_frame_yet");
  EXPECT_EQ(explanation.text,
            "Not found: no frame has arrived. Check that the source of the frames runs and is "
            "connected.");
}

TEST(Explanation, OfASourceThatStopped) {
  ExplainedSituation now = lost();
  now.frame_gap = milliseconds(2300);
  EXPECT_EQ(
      explain(now).text,
      "Not tracked: no frame has arrived for 2.30 s. Check that the source of the frames runs "
      "and is connected.");
}

TEST(Explanation, OfFramesThatArriveTooOld) {
  ExplainedSituation now = lost();
  now.reason = Reason::too_old;
  now.frame_age = milliseconds(600);
  EXPECT_EQ(explain(now).text,
            "Not tracked: frames are 0.60 s old when they arrive, at most 0.25 s is used. Check "
            "the clock and the network of the source.");
}

TEST(Explanation, OfARefusedFrame) {
  ExplainedSituation now = lost();
  now.frame_refused = Reason::frame_late;
  EXPECT_EQ(explain(now).text,
            "Not tracked: the newest frame was refused (frame_late). Set increasing stamps at the "
            "source.");
}

TEST(Explanation, OfAMissedDeadline) {
  ExplainedSituation now = lost();
  now.reason = Reason::overrun_stopped;
  EXPECT_EQ(explain(now).text,
            "Not tracked: computing the frame missed its deadline. Lower [budget] blobs, or move "
            "other work off this computer.");
}

TEST(Explanation, OfAWrongToolRepeatsTheTrialThatFoundIt) {
  ExplainedSituation now = with_counts(never_found(), {.candidates = 5});
  now.reason = Reason::no_labeling;
  now.cause = CheckRow{"distances", false, "no three spots match; they fit the tool \"board\"",
                       "list the tool in view: tools = [\"board\"]"};
  EXPECT_EQ(explain(now).text,
            "Not found: no three spots match; they fit the tool \"board\". List the tool in view: "
            "tools = [\"board\"].");
}

TEST(Explanation, OfAPoseThatIsNotPublished) {
  ExplainedSituation now = with_counts(lost(), {.candidates = 5});
  now.reason = Reason::ambiguous;
  now.regions->finds_tool = true;
  EXPECT_EQ(explain(now).text,
            "Not tracked: the spots fit in two ways: a symmetric, flat or far tool. Turn the tool "
            "to the camera, or hold it closer.");
}

TEST(Explanation, OfARemovedTool) {
  ExplainedSituation now = lost();
  now.reason = Reason::tool_changed;
  EXPECT_EQ(explain(now).text,
            "Not tracked: the tool was removed or replaced. Add it to the tools in use.");
}

TEST(Explanation, WithoutRecordedFramesNamesTheReasonAlone) {
  ExplainedSituation now = lost();
  now.regions.reset();
  EXPECT_EQ(explain(now).text,
            "Not tracked: fewer than 3 markers were visible. Uncover the markers, or bring the "
            "tool into view and turn it to the camera.");
}

}  // namespace
}  // namespace glint::explanation_test
