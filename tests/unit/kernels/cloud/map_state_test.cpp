// Sliced mapping pipeline: its counters, its state after prepare(), and the limits of its settings.
#include "mapped_wall.hpp"

namespace glint::map_state_test {
namespace {

using mapped_wall::Picture;
using mapped_wall::SeparateKernels;
using mapped_wall::small_settings;
using mapped_wall::TestMap;
using mapped_wall::wall;

TEST(MapTotals, AreThoseOfTheKernelsByThemselves) {
  const Picture picture = wall();
  const SeparateKernels alone(picture);
  TestMap test(small_settings(), 1);
  ASSERT_TRUE(test.map.look(picture.view()));
  test.run();
  const MapTotals& totals = test.map.totals();
  EXPECT_EQ(totals.pictures, 1);
  EXPECT_EQ(totals.maps, 1);
  EXPECT_EQ(totals.measured, alone.points.points.count);
  EXPECT_EQ(totals.left_out, 0);
  EXPECT_EQ(totals.dropped, 0);
  EXPECT_EQ(totals.out_of_range, 0);
  EXPECT_EQ(totals.voxels, alone.voxels.count());
  EXPECT_EQ(totals.kept, alone.kept.points.count);
  EXPECT_EQ(totals.smoothed, alone.smoothed.points.count);
  EXPECT_EQ(totals.planes, 2);
  int on_planes = 0, found = 0;
  for (int i = 0; i < totals.smoothed; ++i) {
    on_planes += alone.support.plane_of(i) != PlaneSearch::k_no_plane ? 1 : 0;
    found += alone.planes.plane_of(i) != PlaneSearch::k_no_plane ? 1 : 0;
  }
  EXPECT_EQ(totals.on_planes, on_planes);
  EXPECT_LT(on_planes, found) << "some stand where the two meet";
  EXPECT_LT(totals.kept, totals.voxels);
}

// Every second pixel of every second row, within the depth limits.
TEST(MapTotals, CountThePixelsThatItsSettingsTake) {
  MapSettings settings = small_settings();
  settings.depth.stride = 2;
  settings.depth.depth_max_m = 1.02f;
  TestMap test(settings);
  const Picture picture = wall();
  int expected = 0;
  for (int i = 0; i < 40 * 30; ++i) {
    if (i % 40 % 2 != 0 || i / 40 % 2 != 0) continue;
    expected += picture.depth_m[static_cast<std::size_t>(i)] <= 1.02f ? 1 : 0;
  }
  ASSERT_TRUE(test.map.look(picture.view()));
  test.run();
  EXPECT_EQ(test.map.totals().measured, expected);
  EXPECT_LT(expected, 300);
}

// Points far away are outside the filters' grids; the outlier grid is smaller than the voxel grid.
TEST(MapTotals, CountWhatIsBeyondEitherGridAndWhatHasNoVoxelLeft) {
  MapSettings settings = small_settings();
  settings.voxels_max = 60;
  TestMap test(settings, 3);
  for (const double away : {0.0, 100.0, 20'000.0}) {
    Picture row(10, 2, 3.0f);
    row.T_world_camera.translation.x() = away;
    ASSERT_TRUE(test.map.look(row.view()));
    test.run();
  }
  EXPECT_EQ(test.map.totals().maps, 1);
  EXPECT_EQ(test.map.totals().measured, 60);
  EXPECT_EQ(test.map.totals().voxels, 40);
  EXPECT_EQ(test.map.totals().out_of_range, 20 + 20);
  settings.voxels_max = 17;
  TestMap few(settings, 1);
  const Picture row(10, 2, 3.0f);
  ASSERT_TRUE(few.map.look(row.view()));
  few.run();
  EXPECT_EQ(few.map.totals().voxels, 17);
  EXPECT_EQ(few.map.totals().dropped, 3);
}

TEST(MapTotals, CountWhatIsLeftOutByTheFirstCapsulesAlone) {
  for (const int before : {0, k_exclusion_capsules_max - 1, k_exclusion_capsules_max}) {
    TestMap test;
    Picture row(10, 1, 1.0f);
    row.left_out.assign(static_cast<std::size_t>(before),
                        {Vector3(9, 9, 9), Vector3(9, 9, 9), 0.1});
    row.left_out.push_back({Vector3(-9, 0, 1), Vector3(-0.15, 0, 1), 0.147});  // most of the row
    ASSERT_TRUE(test.map.look(row.view()));
    test.run();
    const bool counts = before < k_exclusion_capsules_max;
    EXPECT_EQ(test.map.totals().measured + test.map.totals().left_out, 10);
    EXPECT_EQ(test.map.totals().left_out > 0, counts) << before;
    EXPECT_LT(test.map.totals().left_out, 10);
  }
}

TEST(MapState, PreparedAnewIsThatOfANewMap) {
  const Picture picture = wall();
  for (const int steps : {100, 5'000, 100'000, 1 << 29}) {  // interrupted, and complete
    TestMap used(small_settings(), 2), fresh(small_settings(), 2);
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(used.map.look(picture.view()));
      used.run();
    }
    EXPECT_EQ(used.map.totals().maps, 1);
    EXPECT_GT(used.map.map().count, 0);
    used.map.start_map();
    (void)used.map.step(steps);
    used.prepare(small_settings(), 2);
    EXPECT_TRUE(used.map.idle());
    EXPECT_EQ(used.map.map().count, 0);
    EXPECT_EQ(used.map.totals().maps, 0);
    EXPECT_EQ(used.map.totals().pictures, 0);
    EXPECT_EQ(used.map.totals().measured, 0);
    used.map.start_map();
    EXPECT_TRUE(used.map.idle()) << "there is no picture yet";
    for (TestMap* test : {&used, &fresh}) {
      for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(test->map.map().count, 0);
        ASSERT_TRUE(test->map.look(picture.view()));
        test->run();
      }
    }
    const PointCloud &a = used.map.map(), &b = fresh.map.map();
    ASSERT_EQ(a.count, b.count);
    for (int i = 0; i < a.count; ++i) {
      ASSERT_EQ(a.x[i], b.x[i]);
      ASSERT_EQ(a.z[i], b.z[i]);
      ASSERT_EQ(a.normal_y[i], b.normal_y[i]);
      ASSERT_EQ(a.weight[i], b.weight[i]);
    }
    EXPECT_EQ(used.map.totals().maps, 1);
    EXPECT_EQ(used.map.totals().voxels, fresh.map.totals().voxels);
    EXPECT_EQ(used.map.totals().measured, fresh.map.totals().measured);
    EXPECT_EQ(used.map.totals().on_planes, fresh.map.totals().on_planes);
  }
}

// The same image adds no voxel: each map is as large as the first and replaces it completely.
TEST(MapState, MakesEachMapAnew) {
  const Picture picture = wall();
  TestMap test(small_settings(), 1);
  MapTotals first;
  for (int maps = 1; maps <= 4; ++maps) {
    ASSERT_TRUE(test.map.look(picture.view()));
    test.run();
    const MapTotals& totals = test.map.totals();
    if (maps == 1) first = totals;
    EXPECT_EQ(totals.maps, maps);
    EXPECT_EQ(totals.pictures, maps);
    EXPECT_EQ(totals.measured, maps * first.measured);
    EXPECT_EQ(totals.voxels, first.voxels);
    EXPECT_EQ(totals.kept, first.kept);
    EXPECT_EQ(totals.smoothed, first.smoothed);
    EXPECT_EQ(test.map.map().count, first.smoothed);
    EXPECT_EQ(test.map.map().weight[0], static_cast<float>(maps));
  }
}

TEST(MapState, TakesUpWholePicturesAlone) {
  const std::vector<float> depth(6, 0.0f);
  const auto takes = [&](int width, int height, std::size_t pixels) {
    TestMap test;
    MapImage picture;
    picture.picture = {width, height, std::span(depth).first(pixels)};
    const bool taken = test.map.look(picture);
    EXPECT_EQ(test.map.idle(), !taken);
    return taken;
  };
  EXPECT_TRUE(takes(1, 1, 1));
  EXPECT_TRUE(takes(3, 2, 6));
  EXPECT_FALSE(takes(3, 2, 5));
  EXPECT_FALSE(takes(2, 2, 6));
  EXPECT_FALSE(takes(0, 5, 0));
  EXPECT_FALSE(takes(5, 0, 0));
  EXPECT_FALSE(takes(-1, -1, 1));
  MapSlices unprepared;
  MapImage picture;
  picture.picture = {3, 2, depth};
  EXPECT_FALSE(unprepared.look(picture));
}

TEST(MapState, AnswersTheSettingsByTheirLimits) {
  const auto bytes_of = [](auto change) {
    MapSettings settings = small_settings();
    change(settings);
    return MapSlices::bytes(settings);
  };
  using S = MapSettings;
  const std::size_t whole = bytes_of([](S&) {});
  EXPECT_GT(whole, 0u);
  EXPECT_EQ(bytes_of([](S& s) { s.voxels_max = 0; }), 0u);
  EXPECT_GT(bytes_of([](S& s) { s.voxels_max = k_cloud_points_max; }), whole);
  EXPECT_EQ(bytes_of([](S& s) { s.voxels_max = k_cloud_points_max + 1; }), 0u);
  EXPECT_EQ(bytes_of([](S& s) { s.depth.stride = 0; }), 0u);
  EXPECT_EQ(bytes_of([](S& s) { s.depth.stride = 2; }), whole);
  EXPECT_EQ(bytes_of([](S& s) { s.smoothing.candidates_max = 0; }), 0u);
  EXPECT_GT(bytes_of([](S& s) { s.smoothing.candidates_max = 1; }), 0u);
  EXPECT_EQ(bytes_of([](S& s) { s.smoothing.candidates_max = k_map_smoothing_candidates_max + 1; }),
            0u);
  EXPECT_EQ(bytes_of([](S& s) { s.outliers.candidates_max = k_map_candidates_max + 1; }), 0u);
  EXPECT_EQ(bytes_of([](S& s) { s.support.candidates_max = k_map_candidates_max + 1; }), 0u);
}

// 100 voxels: where points fill whole cache lines, the grids request one line too many.
TEST(MapState, TakesTheMemoryThatItStatesAndRefusesLess) {
  MapSettings settings = small_settings();
  settings.voxels_max = 100;
  const std::size_t bytes = MapSlices::bytes(settings) - Arena::k_alignment;
  ExactMemory enough(bytes), less(bytes - 1);
  MapSlices map;
  EXPECT_EQ(map.prepare(settings, 1, enough.arena()), Reason::none);
  EXPECT_EQ(map.prepare(settings, 1, less.arena()), Reason::not_prepared);
  EXPECT_EQ(map.prepare(settings, 0, enough.arena()), Reason::out_of_range);
}

TEST(MapState, InSlicesHasNoMoreCandidatesThanASliceMayLookAt) {
  MapSettings settings;
  settings.outliers.candidates_max = k_map_candidates_max - 1;
  settings.smoothing.candidates_max = k_map_smoothing_candidates_max - 2;
  settings.support.candidates_max = k_map_candidates_max - 3;
  const MapSettings fewer = limited_for_slices(settings);
  EXPECT_EQ(fewer.outliers.candidates_max, k_map_candidates_max - 1);
  EXPECT_EQ(fewer.smoothing.candidates_max, k_map_smoothing_candidates_max - 2);
  EXPECT_EQ(fewer.support.candidates_max, k_map_candidates_max - 3);
  settings.outliers.candidates_max = k_map_candidates_max + 1;
  settings.smoothing.candidates_max = k_map_smoothing_candidates_max + 1;
  settings.support.candidates_max = k_map_candidates_max + 1;
  const MapSettings most = limited_for_slices(settings);
  EXPECT_EQ(most.outliers.candidates_max, k_map_candidates_max);
  EXPECT_EQ(most.smoothing.candidates_max, k_map_smoothing_candidates_max);
  EXPECT_EQ(most.support.candidates_max, k_map_candidates_max);
}

}  // namespace
}  // namespace glint::map_state_test
