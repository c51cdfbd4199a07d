#include "kernels/pose/correspond.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include "tests/unit/kernels/pose/correspond_view.hpp"
#include "tests/unit/kernels/pose/scene.hpp"

namespace glint::correspond_test {
namespace {

using test::ahat;
using test::centres;
using test::labelings_of;
using test::Random;
using test::Scene;
using test::SceneSettings;

TEST(Correspond, NamesTheMarkersOfAPenAmongStrays) {
  const Tool pen = test::five_marker_pen();
  const Vector3 ahead(0, 0, 0.4);
  const auto& m = pen.markers_m;
  const Markers markers =
      centres(pen, {m[3] + ahead, Vector3(0.2, 0.1, 0.5), m[0] + ahead, m[4] + ahead, m[1] + ahead,
                    Vector3(-0.1, 0, 0.5), m[2] + ahead});
  const Labelings found = labelings_of(markers, pen, ahat());
  ASSERT_GE(found.count, 1);
  EXPECT_EQ(found.reason, Reason::none);
  const std::array<std::int16_t, 8> expected = {2, 4, 6, 0, 3, -1, -1, -1};
  EXPECT_EQ(found.items[0].marker, expected);
  EXPECT_EQ(found.items[0].count, 5);
  EXPECT_LT(found.items[0].rms_m, 1e-12);
  EXPECT_LT((found.items[0].T_camera_tool.translation - ahead).norm(), 1e-12);
}

struct Tally {
  int found = 0;
  int exact = 0;
  int gross_errors = 0;  // error above 10 mm or 10 degrees
  std::uint32_t hypotheses_max = 0;
};

template <class ToolSource>
Tally tally_of(ToolSource&& next_tool, SceneSettings scene_settings, int frames, bool with_prior,
               std::uint64_t seed) {
  Tally tally;
  Random random(seed);
  for (int frame = 0; frame < frames; ++frame) {
    const Tool tool = next_tool(random);
    scene_settings.strays = frame % 21;
    const Scene scene = test::scene_of(tool, scene_settings, random);
    Pose prior = scene.T_camera_tool;
    prior.translation += random.vector(0.01);
    const Labelings labelings =
        labelings_of(scene.markers, tool, ahat(), with_prior ? &prior : nullptr);
    tally.hypotheses_max = std::max(tally.hypotheses_max, labelings.hypotheses);
    if (labelings.count == 0) continue;
    ++tally.found;
    const Labeling& best = labelings.items[0];
    if (best.marker == scene.truth) ++tally.exact;
    const Vector3& place = tool.markers_m[0];
    const double off = (best.T_camera_tool * place - scene.T_camera_tool * place).norm();
    const double turned =
        test::angle_between(best.T_camera_tool.rotation, scene.T_camera_tool.rotation);
    if (off > 0.01 || turned > 0.1745) ++tally.gross_errors;
  }
  std::printf("  %d frames, 0 to 20 strays: found %d, exact %d, gross %d, hypotheses at most %u\n",
              frames, tally.found, tally.exact, tally.gross_errors, tally.hypotheses_max);
  return tally;
}

TEST(Correspond, FindsThePenInEveryFrameWithAndWithoutAMissingMarker) {
  const auto pen = [](Random&) { return test::five_marker_pen(); };
  for (const int missing : {0, 1}) {
    SceneSettings settings;
    settings.missing = missing;
    const Tally tally = tally_of(pen, settings, 4200, false, 1);
    EXPECT_GE(tally.found, 4196);
    EXPECT_GE(tally.exact, 4190);
    EXPECT_EQ(tally.gross_errors, 0);
  }
}

TEST(Correspond, FindsRandomToolsOfFourToEightMarkers) {
  const auto any = [](Random& random) { return test::random_tool(random, 4 + random.below(5)); };
  const Tally alone = tally_of(any, {}, 4200, false, 2);
  EXPECT_GE(alone.found, 4196);
  EXPECT_LE(alone.gross_errors, 8);  // some tools of four random markers are nearly symmetric
  const Tally predicted = tally_of(any, {}, 4200, true, 3);
  EXPECT_GE(predicted.found, 4196);
  EXPECT_LE(predicted.gross_errors, 1);
}

TEST(Correspond, FindsThreeMarkersWhereTheyArePredictedAndOnlyThere) {
  const auto pen = [](Random&) { return test::five_marker_pen(); };
  SceneSettings settings;
  settings.missing = 2;
  settings.stray_box_m = 1.0;
  const Tally predicted = tally_of(pen, settings, 2100, true, 4);
  EXPECT_GE(predicted.found, 2098);
  EXPECT_LE(predicted.gross_errors, 2);
  const Tally alone = tally_of(pen, settings, 2100, false, 4);
  EXPECT_LE(alone.found, 2);
}

TEST(Correspond, DoesNotCallStraysATool) {
  const auto pen = [](Random&) { return test::five_marker_pen(); };
  SceneSettings settings;
  settings.missing = 5;
  EXPECT_LE(tally_of(pen, settings, 4200, false, 5).found, 1);
}

TEST(Correspond, TheSmallestResidualOfAllLabelingsDecidesForANearlySymmetricGrid) {
  const Tool probe = test::tool_of<6>({{2.12, -15.83, 86.43},
                                       {2.12, 15.85, 86.43},
                                       {2.06, 16.01, 130.94},
                                       {2.12, 16.12, 175.44},
                                       {1.71, -15.58, 175.38},
                                       {1.78, -15.61, 130.89}});
  CorrespondSettings settings;
  settings.range_sigma_m = 0.0001;
  settings.delta_min_m = 0.002;
  settings.max_rms_m = 0.001;
  Random random(6);
  SceneSettings scene_settings;
  scene_settings.range_sigma_m = 0.00002;
  scene_settings.pixel_sigma_rad = 0.00002;
  int several = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const Scene scene = test::scene_of(probe, scene_settings, random);
    const Labelings found = labelings_of(scene.markers, probe, settings);
    ASSERT_GE(found.count, 1);
    EXPECT_EQ(found.items[0].marker, scene.truth);
    if (found.count > 1 && found.items[1].count == 6) ++several;
    for (int k = 1; k < found.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      EXPECT_TRUE(found.items[at].count < found.items[at - 1].count ||
                  found.items[at].rms_m >= found.items[at - 1].rms_m);
    }
  }
  EXPECT_EQ(several, 300);  // otherwise the test has no effect
}

TEST(Correspond, KeepsShortSidesAcrossTheRayWhoseErrorIsOfSecondOrder) {
  const Tool small = test::tool_of<4>({{0, 0, 0}, {40, 0, 0}, {47, 33, 0}, {-5, 50, 0}});
  CorrespondSettings settings = ahat();
  settings.range_sigma_m = 0.005;
  settings.max_rms_m = 0.015;
  Random random(14);
  int found = 0;
  for (int frame = 0; frame < 2000; ++frame) {
    Markers markers;
    const Quaternion tilt = from_rotation_vector(random.vector(0.3));
    for (std::size_t i = 0; i < 4; ++i) {
      const Vector3 point = tilt * small.markers_m[i] + Vector3(0, 0, 0.5);
      test::add_marker(markers, small, point + point.normalized() * (0.005 * random.normal()));
    }
    if (labelings_of(markers, small, settings).count > 0) ++found;
  }
  EXPECT_GE(found, 1998);  // 1,970 with the first order alone
}

TEST(Correspond, RejectsTheMirrorImageThatHasTheSameDistances) {
  const Tool pen = test::five_marker_pen();
  std::vector<Vector3> mirrored;
  for (std::size_t i = 0; i < 5; ++i) {
    const Vector3& m = pen.markers_m[i];
    mirrored.emplace_back(-m.x(), m.y(), m.z() + 0.4);
  }
  CorrespondSettings settings = ahat();
  settings.min_markers_without_prior = 5;
  const Labelings found = labelings_of(centres(pen, mirrored), pen, settings);
  EXPECT_EQ(found.count, 0);
  EXPECT_EQ(found.reason, Reason::bad_fit);
}

TEST(Correspond, GivesTheSamePoseForTheSameMarkersInAnyOrder) {
  const Tool pen = test::five_marker_pen();
  Random random(8);
  SceneSettings settings;
  settings.strays = 8;
  for (int trial = 0; trial < 50; ++trial) {
    const Scene scene = test::scene_of(pen, settings, random);
    Markers shuffled = scene.markers;
    for (int k = shuffled.count; k > 1; --k) {
      std::swap(shuffled.items[static_cast<std::size_t>(k - 1)],
                shuffled.items[static_cast<std::size_t>(random.below(k))]);
    }
    const Labelings a = labelings_of(scene.markers, pen, ahat());
    const Labelings b = labelings_of(shuffled, pen, ahat());
    ASSERT_EQ(a.count, b.count);
    EXPECT_EQ(a.items[0].T_camera_tool.translation, b.items[0].T_camera_tool.translation);
    EXPECT_EQ(a.items[0].T_camera_tool.rotation.coeffs(),
              b.items[0].T_camera_tool.rotation.coeffs());
  }
}

// 256 candidates as dense as the tool itself.
Markers dense_candidates(const Tool& tool, std::uint64_t seed) {
  Random random(seed);
  Markers markers;
  while (markers.count < k_blobs_max) {
    test::add_marker(markers, tool, random.in_box(0.1) + Vector3(0, 0, 0.5));
  }
  return markers;
}

TEST(Correspond, EndsAtItsBudgetInASwarmAndSaysSo) {
  Random random(9);
  const Tool tool = test::random_tool(random, 8);
  CorrespondSettings settings = ahat();
  settings.search_steps_max = 5000;
  const Labelings found = labelings_of(dense_candidates(tool, 1), tool, settings);
  EXPECT_EQ(found.reason, Reason::search_full);
  EXPECT_LE(found.hypotheses, 5000u);
  EXPECT_LE(found.count, k_labelings_max);
}

TEST(Correspond, KeepsThePredictedToolWhenASwarmFillsTheBudget) {
  const Tool pen = test::five_marker_pen();
  Random random(10);
  const Scene scene = test::scene_of(pen, {}, random);
  Markers markers = dense_candidates(pen, 2);
  Random spread(11);
  for (Marker& marker : markers.items) {
    const Vector3 point = Vector3(0.4, 0, 0.5) + spread.in_box(0.1);
    marker.ray = point.normalized();
    marker.surface_range_m = point.norm();
  }
  for (int i = 0; i < 5; ++i) {
    markers.items[static_cast<std::size_t>(251 + i)] =
        scene.markers.items[static_cast<std::size_t>(i)];
  }
  CorrespondSettings settings = ahat();
  settings.search_steps_max = 200;
  const Labelings found = labelings_of(markers, pen, settings, &scene.T_camera_tool);
  EXPECT_EQ(found.reason, Reason::search_full);
  ASSERT_GE(found.count, 1);
  EXPECT_LT((found.items[0].T_camera_tool.translation - scene.T_camera_tool.translation).norm(),
            0.01);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(found.items[0].marker[i], 251 + scene.truth[i]);
}

TEST(Correspond, SaysWhyThereIsNone) {
  const Tool pen = test::five_marker_pen();
  Tool unprepared;
  unprepared.marker_count = 4;
  EXPECT_EQ(labelings_of({}, unprepared, ahat()).reason, Reason::not_prepared);
  EXPECT_EQ(labelings_of({}, pen, ahat()).reason, Reason::too_few_markers);
  const Markers line = centres(pen, {{0, 0, 0.4}, {0, 0, 0.5}, {0, 0, 0.6}, {0, 0, 0.7}});
  EXPECT_EQ(labelings_of(line, pen, ahat()).reason, Reason::no_labeling);
}

TEST(Correspond, LeavesOutMarkersWithoutDepthOrOfAnImpossibleSize) {
  const Tool pen = test::five_marker_pen();
  Random random(12);
  const Scene scene = test::scene_of(pen, {}, random);
  Markers no_depth = scene.markers;
  no_depth.items[0].flags = k_marker_no_depth;
  EXPECT_EQ(labelings_of(no_depth, pen, ahat()).items[0].count, 4);
  Markers broken = scene.markers;
  broken.items[0].surface_range_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(labelings_of(broken, pen, ahat()).items[0].count, 4);
  broken = scene.markers;
  broken.items[0].ray.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(labelings_of(broken, pen, ahat()).items[0].count, 4);
  for (Marker& marker : broken.items) marker.ray.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(labelings_of(broken, pen, ahat()).reason, Reason::too_few_markers);
  Markers large = scene.markers;
  for (int i = 0; i < 5; ++i) large.items[static_cast<std::size_t>(i)].area_px = 24;  // as expected
  EXPECT_EQ(labelings_of(large, pen, ahat()).items[0].count, 5);
  large.items[0].area_px = 400;
  EXPECT_EQ(labelings_of(large, pen, ahat()).items[0].count, 4);
  large.items[0].area_px = 2;
  EXPECT_EQ(labelings_of(large, pen, ahat()).items[0].count, 4);
  large.items[0].flags = k_marker_touches_edge;
  EXPECT_EQ(labelings_of(large, pen, ahat()).items[0].count, 5) << "the border cuts it";
}

// A small specular reflection on a hand at 0.26 m is as large as a marker one wrap distance behind
// it.
TEST(Correspond, LeavesOutMarkersBeyondTheExpectedRange) {
  const Tool pen = test::five_marker_pen();
  CorrespondSettings settings = ahat();
  settings.range_min_m = 0.15;
  settings.range_max_m = 1.0;
  const auto found_at = [&](double range_m) {
    std::vector<Vector3> points;
    for (int i = 0; i < pen.marker_count; ++i)
      points.push_back(pen.markers_m[static_cast<std::size_t>(i)] + Vector3(0, 0, range_m));
    return labelings_of(centres(pen, points), pen, settings);
  };
  EXPECT_EQ(found_at(0.6).reason, Reason::none);
  EXPECT_EQ(found_at(1.31).reason, Reason::too_few_markers);
  settings.range_max_m = 1.5;
  EXPECT_EQ(found_at(1.31).reason, Reason::none);
  settings.range_min_m = 0.8;
  EXPECT_EQ(found_at(0.3).reason, Reason::too_few_markers);
}

TEST(Correspond, GivesTheSameBitsEverywhere) {
  Random random(13);
  test::BitHash hash;
  SceneSettings settings;
  settings.strays = 10;
  for (int trial = 0; trial < 300; ++trial) {
    const Tool tool = test::random_tool(random, 3 + random.below(6));
    const Scene scene = test::scene_of(tool, settings, random);
    const Labelings found = labelings_of(scene.markers, tool, ahat(), &scene.T_camera_tool);
    hash.add(found.hypotheses);
    for (int k = 0; k < found.count; ++k) {
      const Labeling& labeling = found.items[static_cast<std::size_t>(k)];
      hash.add(labeling.rms_m);
      hash.add(labeling.T_camera_tool);
      for (const std::int16_t marker : labeling.marker) hash.add(marker);
    }
  }
  EXPECT_EQ(hash.value(), 4722902164890294372u);
}

}  // namespace
}  // namespace glint::correspond_test
