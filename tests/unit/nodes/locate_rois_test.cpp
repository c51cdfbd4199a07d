#include "nodes/locate_rois.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "nodes/predict_tracks.hpp"

namespace glint {
namespace {

class LocateRois : public testing::Test {
 protected:
  LocateRois() {
    camera_.width = camera_.height = 512;
    camera_.fx = camera_.fy = 250;
    camera_.cx = camera_.cy = 256;
    predict_.camera = locate_.camera = camera_;
    tools_->count = 2;
    for (int t = 0; t < 2; ++t) {
      Tool& tool = tools_->items[static_cast<std::size_t>(t)];
      tool.marker_count = 3;
      tool.markers_m[0] = Vector3(0, 0, 0);
      tool.markers_m[1] = Vector3(0.05, 0, 0);
      tool.markers_m[2] = Vector3(0, 0.05, 0);
      tool.marker_radius_m = 0.005;
    }
  }

  void track(int tool, const Vector3& position, bool seen = true) {
    Track& track = last_->tracks[static_cast<std::size_t>(tool)];
    track.alive = true;
    track.measured_now = seen;
    track.newest.time = Time{} + milliseconds(1000);
    track.newest.pose.translation = position;
    track.T_camera_tool = track.newest.pose;
    track.motion.time = track.newest.time;
    track.motion.pose.translation =
        position + tools_->items[static_cast<std::size_t>(tool)].middle_m();
  }

  Rois locate(std::int64_t gap_ms = 22, std::uint32_t turn = 1) {
    graph::Latest<ToolSet> tools;
    tools.set(*tools_, 1, 0);
    FrameVerdict verdict;
    verdict.accepted = turn;
    verdict.stamp.mid_exposure = Time{} + milliseconds(1000 + gap_ms);
    Rois rois;
    predict_(verdict, HeadPose{}, tools, graph::Previous<Anchor>(anchor_),
             graph::Previous<Estimates>(*last_), *predictions_);
    locate_(verdict, tools, *predictions_, rois);
    return rois;
  }

  CameraModel camera_;
  std::unique_ptr<ToolSet> tools_ = std::make_unique<ToolSet>();
  Anchor anchor_;
  std::unique_ptr<Estimates> last_ = std::make_unique<Estimates>();
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
  glint::PredictTracks predict_;
  glint::LocateRois locate_;
};

TEST_F(LocateRois, SearchesTheWholeFrameForALostTool) {
  track(0, Vector3(0, 0, 0.5));
  const Rois rois = locate();
  ASSERT_EQ(rois.count, 1);
  EXPECT_EQ(rois.items[0].x1 - rois.items[0].x0, 512);
}

TEST_F(LocateRois, SearchesTheWholeFrameAfterAMiss) {
  track(0, Vector3(0, 0, 0.5));
  track(1, Vector3(0.1, 0, 0.5), false);
  EXPECT_EQ(locate().items[0].x1, 512);
}

bool holds(const Rois& rois, int x, int y) {
  for (int i = 0; i < rois.count; ++i) {
    const Roi& roi = rois.items[static_cast<std::size_t>(i)];
    if (roi.x0 <= x && x < roi.x1 && roi.y0 <= y && y < roi.y1) return true;
  }
  return false;
}

// After too many runs the node searches the frame in parts, and the tracked tool in every frame.
TEST_F(LocateRois, SearchesAllPartsOfAFrameThatHadTooManyRunsWithin45Frames) {
  track(0, Vector3(0, 0, 0.5));
  last_->tracks[1].reason = Reason::runs_full;
  locate_.limits.tools = 2;
  std::array<std::array<bool, 8>, 8> covered{};  // squares of 64 pixels
  for (std::uint32_t turn = 1; turn <= 45; ++turn) {
    const Rois rois = locate(22, turn);
    ASSERT_GE(rois.count, 1);
    ASSERT_LE(rois.count, 2) << "no more ROIs than tools";
    EXPECT_TRUE(holds(rois, 256, 256)) << "the tracked tool";
    EXPECT_EQ(turn % 16 == 0, holds(rois, 0, 0) && holds(rois, 511, 511)) << turn;
    if (turn % 16 == 0) continue;
    for (int y = 0; y < 8; ++y) {
      for (int x = 0; x < 8; ++x)
        covered[y][x] |= holds(rois, 64 * x, 64 * y) && holds(rois, 64 * x + 63, 64 * y + 63);
    }
  }
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) EXPECT_TRUE(covered[y][x]) << x << ", " << y;
  }
  EXPECT_LE(locate_.counts()[2], glint::LocateRois::worst(locate_.limits)[2]);
}

TEST_F(LocateRois, BoxesEachToolThatIsFollowed) {
  track(0, Vector3(-0.2, 0, 0.5));
  track(1, Vector3(0.2, 0, 0.5));
  const Rois rois = locate();
  ASSERT_EQ(rois.count, 2);
  // Marker 0 of tool 0 projects to x = 256 - 100, y = 256.
  EXPECT_LE(rois.items[0].x0, 156 - 10);
  EXPECT_GE(rois.items[0].x1, 156 + 25 + 10);
  EXPECT_LE(rois.items[0].x1 - rois.items[0].x0, 120);
}

TEST_F(LocateRois, JoinsBoxesThatMeetIntoDisjointOnes) {
  track(0, Vector3(0, 0, 0.5));
  track(1, Vector3(0.02, 0.02, 0.5));
  EXPECT_EQ(locate().count, 1);
}

TEST_F(LocateRois, WidensTheBoxWithTheGapBetweenFrames) {
  track(0, Vector3(-0.2, 0, 0.5));
  track(1, Vector3(0.2, 0, 0.5));
  const Rois brief = locate(22);
  const Rois later = locate(60);
  EXPECT_GT(later.items[0].y1 - later.items[0].y0, brief.items[0].y1 - brief.items[0].y0 + 20);
}

TEST_F(LocateRois, LooksForNoToolWhereTheSlotIsEmpty) {
  track(0, Vector3(-0.2, 0, 0.5));
  tools_->items[1].marker_count = 0;
  const Rois rois = locate();
  ASSERT_EQ(rois.count, 1);
  EXPECT_LT(rois.items[0].x1, 250);
  tools_->items[0].marker_count = 0;
  EXPECT_EQ(locate().count, 0);
}

}  // namespace
}  // namespace glint
