#include "platform/lab/experiments/strokes_run.hpp"

#include <gtest/gtest.h>

namespace glint {
namespace {

// Two random seeds that the figures of the experiment do not use.
StrokeTally tally_of(const StrokeCase& stroke) {
  StrokeTally tally;
  for (const std::uint64_t seed : {901, 902}) tally.add(follow_stroke(stroke, seed));
  return tally;
}

double inside_percent(const StrokeErrors& errors) {
  return 100.0 * static_cast<double>(errors.position_inside) / static_cast<double>(errors.n);
}

TEST(StrokesExperiment, HindsightHasLessErrorThanThePrediction) {
  for (const bool slow : {false, true}) {
    const StrokeTally tally = tally_of({StrokeShape::hand, slow, true});
    EXPECT_EQ(tally.smoothed.n, tally.ticks);
    EXPECT_GT(tally.frames, slow ? 55 : 500);
    EXPECT_LT(tally.smoothed.position_rms_m(), (slow ? 0.2 : 0.7) * tally.live.position_rms_m());
    EXPECT_LT(tally.smoothed.position_rms_m(), slow ? 0.002 : 0.001);
    EXPECT_GE(inside_percent(tally.smoothed), 88);
    EXPECT_LT(tally.smoothed.position_sigma_m(), 2 * tally.smoothed.position_rms_m());
  }
}

// The headset's own error is common to all frames: it stays, and is stated.
TEST(StrokesExperiment, StatesTheHeadsetsErrorWithoutAReferenceBody) {
  const StrokeTally tally = tally_of({StrokeShape::hand, false, false});
  EXPECT_GT(tally.smoothed.position_rms_m(), 0.001);
  EXPECT_GE(inside_percent(tally.smoothed), 88);
}

TEST(StrokesExperiment, AnEdgeAndACircleAreDrawnWithinAMillimetre) {
  for (const StrokeShape shape : {StrokeShape::edge, StrokeShape::circle}) {
    const StrokeTally tally = tally_of({shape, false, true});
    EXPECT_LT(tally.smoothed.from_line_rms_m(), 0.001);
    EXPECT_GT(tally.smoothed.from_line_rms_m(), 0.0001);
  }
}

}  // namespace
}  // namespace glint
