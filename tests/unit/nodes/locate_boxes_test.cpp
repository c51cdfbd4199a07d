// Node LocateRois: predicted boxes of tools are rounded, clamped, merged and counted.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "nodes/locate_rois.hpp"
#include "tests/unit/kernels/motion/motion_scene.hpp"

namespace glint::locate_boxes_test {
namespace {

constexpr int k_width = 100, k_height = 80;

class LocateBoxes : public testing::Test {
 protected:
  LocateBoxes() {
    node_.camera.width = k_width;
    node_.camera.height = k_height;
  }
  Prediction& add(const Vector2& low, const Vector2& high) {
    const auto t = static_cast<std::size_t>(set_->count++);
    set_->items[t].marker_count = 3;
    Prediction& prediction = predictions_->tools[t];
    prediction.has_prior = prediction.in_view = true;
    prediction.low_px = low;
    prediction.high_px = high;
    return prediction;
  }
  void start_over() {
    set_->count = 0;
    predictions_->tools = {};
  }
  const Rois& run() {
    tools_.set(*set_, ++version_, 0);
    node_(verdict_, tools_, *predictions_, rois_);
    return rois_;
  }
  void expect_only(const Roi& expected) {
    const Rois& rois = run();
    ASSERT_EQ(rois.count, 1);
    EXPECT_EQ(rois.items[0].x0, expected.x0);
    EXPECT_EQ(rois.items[0].y0, expected.y0);
    EXPECT_EQ(rois.items[0].x1, expected.x1);
    EXPECT_EQ(rois.items[0].y1, expected.y1);
  }

  std::unique_ptr<ToolSet> set_ = std::make_unique<ToolSet>();
  graph::Latest<ToolSet> tools_;
  std::uint64_t version_ = 0;
  FrameVerdict verdict_;
  std::unique_ptr<Predictions> predictions_ = std::make_unique<Predictions>();
  Rois rois_;
  glint::LocateRois node_;
};

TEST_F(LocateBoxes, HoldEveryPixelThatTheToolTouchesWithinTheFrame) {
  Prediction& prediction = add({10.2, 20.9}, {30.1, 40.5});
  expect_only({10, 20, 31, 41});
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 1, 0}}));
  prediction.low_px = {-7.5, 60};
  prediction.high_px = {3, 200};
  expect_only({0, 60, 3, k_height});
  prediction.low_px = {99, -1e9};
  prediction.high_px = {1e9, 0.5};
  expect_only({99, 0, k_width, 1});
}

TEST_F(LocateBoxes, AreTheWholeFrameForAToolThatMayBeAnywhere) {
  const Roi whole{0, 0, k_width, k_height};
  add({50, 50}, {60, 60});
  Prediction& prediction = add({10, 20}, {30, 40});
  const Prediction seen = prediction;
  EXPECT_EQ(run().count, 2);
  prediction.has_prior = false;
  expect_only(whole);
  prediction = seen;
  prediction.undetected_last = true;
  expect_only(whole);
  prediction = seen;
  prediction.in_view = false;
  expect_only(whole);
  // Beyond each border: the clamped box has no column or no row.
  const Vector2 beyond[][2] = {{{-20, 20}, {0, 40}},
                               {{k_width, 20}, {k_width + 9, 40}},
                               {{10, -20}, {30, 0}},
                               {{10, k_height}, {30, k_height + 9}}};
  for (const auto& box : beyond) {
    prediction = seen;
    prediction.low_px = box[0];
    prediction.high_px = box[1];
    expect_only(whole);
  }
  set_->items[1].marker_count = 0;
  expect_only({50, 50, 60, 60});
  verdict_.reason = Reason::frame_late;
  EXPECT_EQ(run().count, 0);
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
}

// On each side of a box: one that only touches it, then one that shares a row or column.
TEST_F(LocateBoxes, StayApartWhereTheyOnlyTouch) {
  struct Case {
    double x, y;
  };
  for (const Case& c : {Case{20, 0}, Case{-20, 0}, Case{0, 20}, Case{0, -20}, Case{20, 20}}) {
    start_over();
    const Vector2 low(40, 30), size(20, 20), aside(c.x, c.y);
    add(low, low + size);
    Prediction& other = add(low + aside, low + aside + size);
    EXPECT_EQ(run().count, 2) << aside.transpose();
    EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 2, 1}}));
    const Vector2 closer = 0.95 * aside;
    other.low_px = low + closer;
    other.high_px = low + closer + size;
    expect_only({static_cast<int>(40 + std::min(closer.x(), 0.0)),
                 static_cast<int>(30 + std::min(closer.y(), 0.0)),
                 static_cast<int>(60 + std::max(closer.x(), 0.0)),
                 static_cast<int>(50 + std::max(closer.y(), 0.0))});
  }
}

// The last box overlaps the second. Their union overlaps the first, which was checked before.
TEST_F(LocateBoxes, AreJoinedWithThoseThatTheGrownBoxMeets) {
  add({0, 0}, {10, 10});
  add({5, 30}, {40, 40});
  add({30, 5}, {40, 35});
  expect_only({0, 0, 40, 40});
  // Overlap tests: second with first; last with first, second, and first again.
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, 3, 1 + 3}}));
}

TEST_F(LocateBoxes, AreDisjointAndHoldEveryTool) {
  test::Random random(3);
  for (int trial = 0; trial < 300; ++trial) {
    start_over();
    const int tools = 1 + trial % k_tools_max;
    for (int t = 0; t < tools; ++t) {
      const Vector2 low(std::floor(random.within(0, 80)), std::floor(random.within(0, 60)));
      add(low, low + Vector2(1 + std::floor(random.within(0, 18)),
                             1 + std::floor(random.within(0, 18))));
    }
    const Rois& rois = run();
    EXPECT_LE(rois.count, tools);
    for (int t = 0; t < tools; ++t) {
      const Prediction& box = predictions_->tools[static_cast<std::size_t>(t)];
      int holders = 0;
      for (int i = 0; i < rois.count; ++i) {
        const Roi& roi = rois.items[static_cast<std::size_t>(i)];
        holders += roi.x0 <= box.low_px.x() && box.high_px.x() <= roi.x1 &&
                           roi.y0 <= box.low_px.y() && box.high_px.y() <= roi.y1
                       ? 1
                       : 0;
      }
      EXPECT_EQ(holders, 1) << trial << ", tool " << t;
    }
    for (int a = 0; a < rois.count; ++a) {
      for (int b = 0; b < a; ++b) {
        const Roi &p = rois.items[std::size_t(a)], &q = rois.items[std::size_t(b)];
        EXPECT_TRUE(p.x1 <= q.x0 || q.x1 <= p.x0 || p.y1 <= q.y0 || q.y1 <= p.y0) << trial;
      }
    }
    EXPECT_TRUE(graph::within(node_.counts(), glint::LocateRois::worst(node_.limits)));
  }
}

// A partial frame, and one box fewer than tools: tracked tools come first.
TEST_F(LocateBoxes, BesideAPartOfTheFrameAreThoseOfTrackedToolsFirst) {
  predictions_->search_part_of_frame = true;
  predictions_->frame_number = 4;
  const auto holds = [&](double x, double y) {
    for (int i = 0; i < rois_.count; ++i) {
      const Roi& roi = rois_.items[static_cast<std::size_t>(i)];
      if (roi.x0 <= x && x < roi.x1 && roi.y0 <= y && y < roi.y1) return true;
    }
    return false;
  };
  run();
  ASSERT_EQ(rois_.count, 1);
  const Roi part = rois_.items[0];
  EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1}}));
  // Positions in a row outside the searched part.
  const double y = part.y0 > 20 ? 5 : 70;
  add({5, y}, {10, y + 5}).undetected_last = true;
  add({25, y}, {30, y + 5});
  add({45, y}, {50, y + 5}).has_prior = false;
  add({65, y}, {70, y + 5});
  add({85, y}, {90, y + 5}).in_view = false;
  for (const int tools : {5, 4, 3, 2}) {
    node_.limits.tools = tools;
    run();
    EXPECT_TRUE(holds(part.x0, part.y0));
    EXPECT_TRUE(holds(25, y)) << tools;
    EXPECT_EQ(holds(65, y), tools >= 4) << "beyond the cell's tools";
    EXPECT_EQ(holds(5, y), tools >= 3) << "a missed one after the tracked ones";
    EXPECT_FALSE(holds(45, y) || holds(85, y));
    const std::int64_t boxes = tools >= 4 ? 3 : tools - 1;
    EXPECT_EQ(rois_.count, 1 + boxes);
    EXPECT_EQ(node_.counts(), (graph::LoopCounts{{1, boxes, boxes * (boxes + 1) / 2}}));
  }
}

// Half or a quarter of the columns. The centre follows the multiples of the golden ratio.
TEST_F(LocateBoxes, OfTheFrameArePartsThatTheGoldenRatioPlaces) {
  predictions_->search_part_of_frame = true;
  for (std::uint32_t turn = 1; turn <= 64; ++turn) {
    predictions_->frame_number = turn;
    const Rois& rois = run();
    ASSERT_EQ(rois.count, 1);
    const Roi& part = rois.items[0];
    const int width = turn % 2 == 0 ? k_width / 4 : k_width / 2;
    const double golden = (std::sqrt(5.0) - 1) / 2;
    const double middle = k_width * (turn * golden - std::floor(turn * golden));
    EXPECT_NEAR(part.x0, std::max(0.0, std::floor(middle) - width / 2), 1) << turn;
    EXPECT_NEAR(part.x1, std::min<double>(k_width, std::floor(middle) - width / 2 + width), 1);
    if (turn % 4 != 0) {
      EXPECT_EQ(part.y0, 0);
      EXPECT_EQ(part.y1, k_height);
    } else {
      EXPECT_GE(part.y0, 0);
      EXPECT_LE(part.y1, k_height);
      EXPECT_LE(part.y1 - part.y0, k_height / 4);
      EXPECT_GE(part.y1 - part.y0, k_height / 8);
      const bool clipped = part.y0 == 0 || part.y1 == k_height;
      EXPECT_TRUE(clipped || part.y1 - part.y0 == k_height / 4);
    }
  }
}

}  // namespace
}  // namespace glint::locate_boxes_test
