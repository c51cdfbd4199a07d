#include "kernels/pose/candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "kernels/pose/marker_range.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::candidates_test {
namespace {

using test::Random;

// For a disc the marker's centre is at its surface, so ranges are exact.
Tool disc_tool() {
  Tool tool = test::tool_of<4>({{0, 0, 0}, {60, 0, 0}, {0, 80, 0}, {50, 50, 30}});
  tool.shape = MarkerShape::disc;
  return tool;
}

Marker marker_at(const Vector3& ray, double range_m, std::uint32_t area_px = 0) {
  Marker marker;
  marker.ray = ray;
  marker.surface_range_m = range_m;
  marker.area_px = area_px;
  return marker;
}

struct Selection {
  std::unique_ptr<Markers> markers = std::make_unique<Markers>();
  std::unique_ptr<Candidates> candidates = std::make_unique<Candidates>();
  Tool tool = disc_tool();
  CorrespondSettings settings;

  void add(const Marker& marker) {
    markers->items[static_cast<std::size_t>(markers->count++)] = marker;
  }
  int select(const Pose* prior = nullptr) {
    return select_candidates(*markers, tool, settings, prior, *candidates);
  }
  bool takes(const Marker& marker) {
    markers->count = 0;
    add(marker);
    select();
    return candidates->count == 1;
  }
};

double beyond(double x) { return std::nextafter(x, 1e9); }
double before(double x) { return std::nextafter(x, -1e9); }

TEST(Candidates, TakeAMarkerAtEachEndOfTheRangesMarginAndNoneBeyond) {
  Selection s;
  s.settings.range_min_m = 0.5 * k_range_margin;
  s.settings.range_max_m = 1.0;
  const Vector3 ahead = Vector3::UnitZ();
  EXPECT_TRUE(s.takes(marker_at(ahead, 1.0 * k_range_margin)));
  EXPECT_FALSE(s.takes(marker_at(ahead, beyond(1.0 * k_range_margin))));
  EXPECT_TRUE(s.takes(marker_at(ahead, 0.5)));
  EXPECT_FALSE(s.takes(marker_at(ahead, before(0.4999999999999999))));
  s.settings.range_max_m = 0;
  EXPECT_TRUE(s.takes(marker_at(ahead, 0.01))) << "anywhere";
  EXPECT_TRUE(s.takes(marker_at(ahead, 50))) << "anywhere";
}

TEST(Candidates, TakeNoneWithoutAPlace) {
  Selection s;
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(s.takes(marker_at(Vector3::UnitZ(), 0.4)));
  EXPECT_FALSE(s.takes(marker_at(Vector3::UnitZ(), 0)));
  EXPECT_FALSE(s.takes(marker_at(Vector3::UnitZ(), -0.4)));
  EXPECT_FALSE(s.takes(marker_at(Vector3::UnitZ(), none)));
  EXPECT_FALSE(s.takes(marker_at(Vector3(0, none, 1), 0.4)));
  Marker marker = marker_at(Vector3::UnitZ(), 0.4);
  marker.flags = k_marker_no_depth;
  EXPECT_FALSE(s.takes(marker));
  marker.flags = k_marker_annulus_depth | k_marker_wrapped | k_marker_saturated;
  EXPECT_TRUE(s.takes(marker));
}

// Limits for a sphere: the image's area divided by the factor, and the area times the factor plus a
// few pixels. A tilt lowers the minimum of a disc.
TEST(Candidates, TakeEachAreaFromTheLeastToTheLargestAndNoneBeyond) {
  for (const MarkerShape shape : {MarkerShape::sphere, MarkerShape::disc}) {
    Selection s;
    s.tool.shape = shape;
    s.tool.marker_radius_m = 0.011;
    s.settings.focal_px = 253;
    s.settings.area_factor = 3;
    const double range = 0.5 + s.tool.centre_offset_m();
    const double image = std::numbers::pi * std::pow(253 * 0.011 / range, 2);
    const double part = shape == MarkerShape::disc ? 0.26 : 1.0;
    const auto least = static_cast<std::uint32_t>(std::ceil(image * part / 3));
    const auto most = static_cast<std::uint32_t>(image * 3 + k_area_slack_px);
    const auto takes = [&](std::uint32_t area_px, std::uint8_t flags) {
      Marker marker = marker_at(Vector3::UnitZ(), 0.5, area_px);
      marker.flags = flags;
      return s.takes(marker);
    };
    EXPECT_TRUE(takes(least, 0));
    EXPECT_FALSE(takes(least - 1, 0));
    EXPECT_TRUE(takes(least - 1, k_marker_touches_edge)) << "cut by the border";
    EXPECT_FALSE(takes(least - 1, k_marker_saturated));
    EXPECT_TRUE(takes(most, 0));
    EXPECT_FALSE(takes(most + 1, 0));
    EXPECT_FALSE(takes(most + 1, k_marker_touches_edge)) << "too large all the same";
    EXPECT_TRUE(takes(0, 0)) << "of a point without an image";
    s.settings.focal_px = 0;
    EXPECT_TRUE(takes(most + 1, 0)) << "no area is expected";
    s.settings.focal_px = 0.5;
    EXPECT_FALSE(takes(most + 1, 0)) << "hardly any is expected";
    s.settings.focal_px = 253;
    s.tool.marker_radius_m = 0;
    EXPECT_TRUE(takes(most + 1, 0)) << "no area is expected";
  }
}

// For a marker without a visible image only the slack remains, and it is inclusive.
TEST(Candidates, TakeJustTheSlackOfAMarkerWithoutAnImage) {
  Selection s;
  s.tool.marker_radius_m = 1e-20;
  s.settings.focal_px = 253;
  EXPECT_TRUE(s.takes(marker_at(Vector3::UnitZ(), 0.5, 8)));
  EXPECT_FALSE(s.takes(marker_at(Vector3::UnitZ(), 0.5, 9)));
}

TEST(Candidates, StateTheNoiseAcrossTheRayByTheFocalLengthOrTheRanges) {
  Selection s;
  s.settings.range_sigma_m = 0.003;
  s.settings.pixel_sigma_px = 0.2;
  s.add(marker_at(Vector3::UnitZ(), 0.8));
  s.select();
  EXPECT_DOUBLE_EQ(s.candidates->across_variance_m2[0], 0.003 * 0.003);
  s.settings.focal_px = 250;
  s.select();
  EXPECT_DOUBLE_EQ(s.candidates->across_variance_m2[0], std::pow(0.8 * 0.2 / 250, 2));
  s.settings.focal_px = 0.5;  // any positive focal length
  s.select();
  EXPECT_DOUBLE_EQ(s.candidates->across_variance_m2[0], std::pow(0.8 * 0.2 / 0.5, 2));
}

// At the gate's distance from the first marker's predicted position, and just beyond.
TEST(Candidates, AreNearAtEachGateAndNotBeyond) {
  Selection s;
  s.tool = test::tool_of<3>({{0, 0, 500}, {8000, 0, 500}, {0, 8000, 500}});
  s.tool.shape = MarkerShape::disc;
  s.settings.prior_gate_m = 0.25;
  const Pose prior;
  const auto near = [&](double range_m, double partial_gate_m) {
    s.settings.partial_gate_m = partial_gate_m;
    s.markers->count = 0;
    s.add(marker_at(Vector3::UnitZ(), range_m));
    s.select(&prior);
    const Candidates& c = *s.candidates;
    EXPECT_EQ(c.in_prior_gate[1].word[0], 0u);
    EXPECT_EQ(c.in_prior_gate[2].word[0], 0u);
    return std::pair<bool, bool>{c.in_prior_gate[0].word[0] == 1,
                                 c.in_partial_gate[0].word[0] == 1};
  };
  using Both = std::pair<bool, bool>;
  EXPECT_EQ(near(0.75, 0.125), Both(true, false));
  EXPECT_EQ(near(0.75 + 1e-15, 0.125), Both(false, false));
  EXPECT_EQ(near(0.25, 0.125), Both(true, false));
  EXPECT_EQ(near(0.25 - 1e-15, 0.125), Both(false, false));
  EXPECT_EQ(near(0.625, 0.125), Both(true, true));
  EXPECT_EQ(near(0.625 + 1e-15, 0.125), Both(true, false));
  EXPECT_EQ(near(0.75, 5), Both(true, true)) << "the other gate is the narrower one";
  EXPECT_EQ(near(0.75 + 1e-15, 5), Both(false, false));
}

bool holds(const CandidateSet& set, std::size_t a) {
  return (set.word[a / 64] >> (a % 64) & 1) != 0;
}

// Reference: one pass over all markers. Each marker that fits is listed once, those near a
// predicted position first. Each set contains just those near its own marker.
TEST(Candidates, AreThoseOfAPlainPassWithThoseNearThePredictionFirst) {
  Random random(1);
  Selection s;
  s.settings.focal_px = 253;
  s.settings.prior_gate_m = 0.1;
  s.settings.partial_gate_m = 0.06;
  s.settings.range_min_m = 0.3;
  s.settings.range_max_m = 0.8;
  for (int round = 0; round < 60; ++round) {
    s.tool = test::random_tool(random, 3 + round % 6);
    const Pose prior{random.rotation(), Vector3(0.02, -0.03, 0.5)};
    s.markers->count = 0;
    const int blobs = round % 2 == 0 ? 20 : k_blobs_max;
    while (s.markers->count < blobs) {
      const Vector3 centre = Vector3(0, 0, 0.55) + random.in_box(0.6);
      Marker marker = marker_at(centre.normalized(), centre.norm());
      if (random.below(4) == 0) marker.flags = k_marker_no_depth;
      s.add(marker);
    }
    s.settings.markers_max = round % 3 == 0 ? k_blobs_max : 15 + round;
    const bool predicted = round % 5 != 0;
    const int looked_at = s.select(predicted ? &prior : nullptr);
    EXPECT_EQ(looked_at, std::min(blobs, s.settings.markers_max));
    const Candidates& c = *s.candidates;
    std::vector<int> expected;
    for (int m = 0; m < looked_at; ++m) {
      const Marker& marker = s.markers->items[static_cast<std::size_t>(m)];
      const double range = centre_range_m(marker, s.tool);
      if ((marker.flags & k_marker_no_depth) == 0 && range * 1.1 >= 0.3 && range <= 0.8 * 1.1)
        expected.push_back(m);
    }
    std::vector<int> found;
    bool far = false;
    for (std::size_t a = 0; a < static_cast<std::size_t>(c.count); ++a) {
      found.push_back(c.marker[a]);
      const Marker& marker = s.markers->items[static_cast<std::size_t>(c.marker[a])];
      const double range = centre_range_m(marker, s.tool);
      EXPECT_EQ(c.ray[a], marker.ray);
      EXPECT_EQ(c.point_m[a], Vector3(marker.ray * range));
      EXPECT_DOUBLE_EQ(c.across_variance_m2[a], std::pow(range * 0.1 / 253, 2));
      bool any = false;
      for (std::size_t j = 0; j < k_markers_per_tool_max; ++j) {
        const bool has_place = predicted && j < static_cast<std::size_t>(s.tool.marker_count);
        const double off = has_place ? (c.point_m[a] - prior * s.tool.markers_m[j]).norm() : 1e9;
        EXPECT_EQ(holds(c.in_prior_gate[j], a), off <= 0.1) << off;
        EXPECT_EQ(holds(c.in_partial_gate[j], a), off <= 0.06) << off;
        any = any || off <= 0.1;
      }
      EXPECT_FALSE(any && far) << "behind one that is far";
      far = far || !any;
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected);
    EXPECT_EQ(c.words, (c.count + 63) / 64);
    ASSERT_FALSE(HasFailure()) << round;
  }
}

TEST(Candidates, AreNoneOfNoMarkersAndOfFewerThanNone) {
  Selection s;
  s.add(marker_at(Vector3::UnitZ(), 0.5));
  EXPECT_EQ(s.select(), 1);
  EXPECT_EQ(s.candidates->count, 1);
  for (const int count : {0, -2}) {
    s.markers->count = count;
    EXPECT_EQ(s.select(), 0);
    EXPECT_EQ(s.candidates->count, 0);
    EXPECT_EQ(s.candidates->words, 0);
  }
}

// The tool's own bias replaces the camera's; only for markers from an image.
TEST(MarkerRange, IsTheSurfaceLessTheToolsOwnBiasAndARadiusMore) {
  Tool tool = disc_tool();
  Marker marker = marker_at(Vector3::UnitZ(), 0.6);
  marker.bias_subtracted_m = 0.25F;
  marker.peak = 500;
  EXPECT_DOUBLE_EQ(centre_range_m(marker, tool), 0.6);
  tool.shape = MarkerShape::sphere;
  tool.marker_radius_m = 0.0625;
  EXPECT_DOUBLE_EQ(centre_range_m(marker, tool), 0.6625);
  tool.depth_bias = {0.004, 0.01, 0.002, 0.2, 2};
  // Raw 0.85 m, 0.35 m beyond the reference and half as bright: 0.004 + 0.0035 + 0.004.
  EXPECT_NEAR(centre_range_m(marker, tool), 0.85 - 0.0115 + 0.0625, 1e-12);
  marker.peak = 1;
  EXPECT_NEAR(centre_range_m(marker, tool), 0.85 - 2.0075 + 0.0625, 1e-12);
  marker.peak = 0;
  EXPECT_DOUBLE_EQ(centre_range_m(marker, tool), 0.6625) << "no image gave it";
}

}  // namespace
}  // namespace glint::candidates_test
