// The steps of a map in slices, beside those that its kernels take by themselves; its settings,
// its counts, and what it is when prepared anew.
#include "kernels/cloud/map_slices.hpp"

#include <map>
#include <memory>

#include "clouds.hpp"

namespace glint::map_slices_test {
namespace {

using Stage = MapSlices::Stage;
constexpr int k_never = 1'000'000;  // pictures: no map is made

MapSettings small_settings() {
  MapSettings settings;
  settings.voxels_max = 2'000;
  settings.planes.points_min = 100;
  settings.support.part_min = 1;
  return in_slices(settings);
}

struct TestMap {
  explicit TestMap(const MapSettings& settings = small_settings(), int pictures_a_map = k_never) {
    prepare(settings, pictures_a_map);
  }
  void prepare(const MapSettings& settings, int pictures_a_map) {
    memory.assign(MapSlices::bytes(settings), std::byte{0});
    Arena arena(memory);
    EXPECT_EQ(map.prepare(settings, pictures_a_map, arena), Reason::none);
  }
  void run(int steps = 50'000) {
    while (!map.idle()) (void)map.step(steps);
  }
  std::vector<std::byte> memory;
  MapSlices map;
};

struct Picture {
  int width, height;
  std::vector<float> depth_m;
  CameraModel camera;
  Pose T_world_camera;
  std::vector<LeftOut> left_out;

  Picture(int of_width, int of_height, float depth) : width(of_width), height(of_height) {
    depth_m.assign(static_cast<std::size_t>(width * height), depth);
    camera.width = width, camera.height = height;
    camera.fx = camera.fy = 100, camera.cx = 20, camera.cy = 15;
  }
  [[nodiscard]] MapPicture view() const {
    return {{width, height, depth_m}, camera, T_world_camera, left_out};
  }
};

// A wall, its right part 4 cm further away, and points that hang in the air before it.
Picture wall() {
  Picture picture(40, 30, 1.005f);
  for (int i = 0; i < 40 * 30; ++i) {
    float& depth = picture.depth_m[static_cast<std::size_t>(i)];
    if (i % 40 > 25) depth = 1.045f;
    if (i % 40 % 11 == 3 && i / 40 % 9 == 4) depth = 0.5f;
  }
  return picture;
}

// Steps of the slice that one row of pixels takes.
int steps_of_row(const Picture& picture) {
  TestMap test;
  EXPECT_TRUE(test.map.look(picture.view()));
  const int steps = test.map.step(1);
  EXPECT_EQ(test.map.idle(), picture.width <= k_map_pixels_at_once);
  return steps;
}
int steps_of_row(int width, float depth = 0, std::size_t left_out = 0, Lens lens = Lens::pinhole) {
  Picture picture(width, 1, depth);
  picture.camera.lens = lens;
  picture.left_out.assign(left_out, {Vector3(9, 9, 9), Vector3(9, 9, 9), 0.1});
  return steps_of_row(picture);
}
int pixel_steps(Lens lens = Lens::pinhole) {
  return steps_of_row(2, 0, 0, lens) - steps_of_row(1, 0, 0, lens);
}
int call_steps() { return steps_of_row(1) - pixel_steps(); }

TEST(MapSliceSteps, OfPixelsAddUpAndSoDoThoseOfWhatIsLeftOut) {
  const int call = call_steps(), pixel = pixel_steps();
  EXPECT_GT(call, 0);
  EXPECT_GT(pixel, 0);
  const int capsule = steps_of_row(1, 0, 1) - steps_of_row(1);
  EXPECT_GT(capsule, 0);
  for (const int width : {1, 3, 8, 9}) {
    const int looked_at = std::min(width, k_map_pixels_at_once);
    for (const int count : {0, 1, 5, k_left_out_max, k_left_out_max + 1}) {
      EXPECT_EQ(steps_of_row(width, 0, static_cast<std::size_t>(count)),
                call + looked_at * (pixel + std::min(count, k_left_out_max) * capsule))
          << width << ' ' << count;
    }
  }
}

// A table's ray is looked up once, that of a polynomial is found in as many steps as it may take.
TEST(MapSliceSteps, OfAPixelAreThoseOfItsLens) {
  const int plain = pixel_steps(), look_up = pixel_steps(Lens::lut) - plain;
  EXPECT_GT(look_up, 0);
  EXPECT_EQ(pixel_steps(Lens::brown) - plain, k_ray_steps_max * look_up);
  EXPECT_EQ(pixel_steps(Lens::rational) - plain, k_ray_steps_max * look_up);
}

// Beside those of a row without depth.
TEST(MapSliceSteps, OfVoxelsAreThoseOfTheSlotsLookedAt) {
  const int probe = steps_of_row(1, 1.005f) - steps_of_row(1);
  EXPECT_GT(probe, 0);
  for (const float depth : {0.3f, 1.005f, 3.0f}) {
    const Picture row(8, 1, depth);
    TestCloud cloud(8);
    int dropped = 0;
    (void)add_depth_points(row.view().picture, row.camera, {}, {}, 0, 8, cloud.points, dropped);
    TestMemory memory(VoxelGrid::bytes(small_settings().voxels_max));
    VoxelGrid voxels;
    ASSERT_EQ(voxels.prepare({}, small_settings().voxels_max, memory.arena()), Reason::none);
    voxels.add(cloud.points, 0, 8);
    EXPECT_EQ(steps_of_row(row) - steps_of_row(8), static_cast<int>(voxels.probes()) * probe);
    EXPECT_GE(voxels.probes(), depth > 0.5f ? 8 : 3);
  }
}

// What the kernels give and take by themselves, each step a slice of one.
struct ByThemselves {
  struct Taken {
    int calls = 0, steps = 0;
  };
  MapSettings settings = small_settings();
  TestMemory memory;
  TestCloud points, voxel_points, kept, smoothed;
  VoxelGrid voxels;
  RadiusOutlier outliers;
  MovingLeastSquares smoothing;
  PlaneSearch planes;
  PlaneSupport support;
  std::map<Stage, Taken> taken;

  explicit ByThemselves(const Picture& picture)
      : memory(MapSlices::bytes(settings)),
        points(2'000),
        voxel_points(2'000),
        kept(2'000),
        smoothed(2'000) {
    const int most = settings.voxels_max;
    EXPECT_EQ(voxels.prepare(settings.voxels, most, memory.arena()), Reason::none);
    EXPECT_EQ(outliers.prepare(settings.outliers, most, memory.arena()), Reason::none);
    EXPECT_EQ(smoothing.prepare(settings.smoothing, most, memory.arena()), Reason::none);
    EXPECT_EQ(planes.prepare(settings.planes, most, memory.arena()), Reason::none);
    EXPECT_EQ(support.prepare(settings.support, most, memory.arena()), Reason::none);
    int dropped = 0;
    (void)add_depth_points(picture.view().picture, picture.camera, picture.T_world_camera, {}, 0,
                           2'000, points.points, dropped);
    for (int at = 0; at < points.points.count;) {
      at = voxels.add(points.points, at, k_map_pixels_at_once);
    }
    voxels.write(0, most, voxel_points.points);
    const SliceSize one(k_cloud_points_max, 1);
    outliers.begin(voxel_points.points);
    run(
        Stage::outliers, [&] { return outliers.step(one, kept.points); }, outliers);
    smoothing.begin(kept.points);
    run(
        Stage::smoothing, [&] { return smoothing.step(one, smoothed.points); }, smoothing);
    planes.begin(smoothed.points);
    run(
        Stage::planes, [&] { return planes.step(one); }, planes);
    support.begin(smoothed.points, planes);
    run(
        Stage::support, [&] { return support.step(one); }, support);
  }
  template <class Step, class Kernel>
  void run(Stage stage, Step step, const Kernel& kernel) {
    Taken& of_stage = taken[stage];
    for (bool done = false; !done; ++of_stage.calls) {
      done = step();
      of_stage.steps += kernel.steps();
    }
  }
};

TEST(MapSliceSteps, OfEachStageAreItsKernelsOfEachCallAndOfBeginningTheNext) {
  const int call = call_steps();
  const ByThemselves alone(wall());
  TestMap test(small_settings(), 1);
  const Picture picture = wall();
  ASSERT_TRUE(test.map.look(picture.view()));
  std::map<Stage, ByThemselves::Taken> taken;
  while (!test.map.idle()) {
    ByThemselves::Taken& of_stage = taken[test.map.stage()];
    of_stage.steps += test.map.step(1);
    ++of_stage.calls;
  }
  const int begin = taken[Stage::outliers].steps - alone.taken.at(Stage::outliers).steps -
                    taken[Stage::outliers].calls * call;
  EXPECT_GT(begin, 0);
  for (const auto& [stage, kernel] : alone.taken) {
    EXPECT_EQ(taken[stage].calls, kernel.calls) << static_cast<int>(stage);
    EXPECT_EQ(taken[stage].steps, kernel.steps + kernel.calls * call + begin)
        << static_cast<int>(stage);
  }
  const int pixels = 40 * 30, probe = steps_of_row(1, 1.005f) - steps_of_row(1);
  EXPECT_EQ(taken[Stage::points].calls, pixels / k_map_pixels_at_once);
  EXPECT_EQ(taken[Stage::points].steps, taken[Stage::points].calls * call + pixels * pixel_steps() +
                                            static_cast<int>(alone.voxels.probes()) * probe);
  // One voxel, one point a call, each for the same steps.
  EXPECT_EQ(taken[Stage::voxels].calls, alone.voxels.count());
  EXPECT_EQ(taken[Stage::voxels].steps % alone.voxels.count(), 0);
  EXPECT_EQ(taken[Stage::snap].calls, alone.smoothed.points.count);
  EXPECT_EQ(taken[Stage::snap].steps % alone.smoothed.points.count, 0);
}

// So many as the steps suffice for; one voxel more for each of its steps.
TEST(MapSliceSteps, OfVoxelsAndPointsSufficeForAsMany) {
  const int call = call_steps();
  const Picture picture = wall();
  const auto at_stage = [&](Stage stage) {
    auto test = std::make_unique<TestMap>(small_settings(), 1);
    EXPECT_TRUE(test->map.look(picture.view()));
    while (test->map.stage() != stage) (void)test->map.step(1);
    return test;
  };
  for (const Stage stage : {Stage::voxels, Stage::snap}) {
    const int each = at_stage(stage)->map.step(1) - call;
    EXPECT_GT(each, 0);
    // A call takes steps of its own: fewer items than the slice suffices for end it.
    for (const int items : {1, 2, 7, 100}) {
      EXPECT_EQ(at_stage(stage)->map.step(items * each), call + items * each);
      EXPECT_EQ(at_stage(stage)->map.step(items * each + each - 1), call + items * each);
    }
    const ByThemselves alone(picture);
    const int all = stage == Stage::voxels ? alone.voxels.count() : alone.smoothed.points.count;
    const auto test = at_stage(stage);
    EXPECT_EQ(test->map.step(all * each), call + all * each);
    EXPECT_EQ(test->map.stage(), stage == Stage::voxels ? Stage::outliers : Stage::idle);
    const auto short_of_one = at_stage(stage);
    EXPECT_EQ(short_of_one->map.step(all * each - 1), call + (all - 1) * each);
    EXPECT_EQ(short_of_one->map.stage(), stage);
  }
}

TEST(MapSliceSteps, AreAtLeastThoseOfOneCall) {
  const Picture row(8, 1, 0);
  for (const int steps : {0, -7}) {
    TestMap test;
    EXPECT_EQ(test.map.step(steps), 0) << "nothing is under way";
    ASSERT_TRUE(test.map.look(row.view()));
    EXPECT_EQ(test.map.step(steps), steps_of_row(8));
    EXPECT_TRUE(test.map.idle());
  }
}

TEST(MapTotals, AreThoseOfTheKernelsByThemselves) {
  const Picture picture = wall();
  const ByThemselves alone(picture);
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

// Far away the filters' grids end: that of outliers before that of voxels.
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
  for (const int before : {0, k_left_out_max - 1, k_left_out_max}) {
    TestMap test;
    Picture row(10, 1, 1.0f);
    row.left_out.assign(static_cast<std::size_t>(before),
                        {Vector3(9, 9, 9), Vector3(9, 9, 9), 0.1});
    row.left_out.push_back({Vector3(-9, 0, 1), Vector3(-0.15, 0, 1), 0.147});  // most of the row
    ASSERT_TRUE(test.map.look(row.view()));
    test.run();
    const bool counts = before < k_left_out_max;
    EXPECT_EQ(test.map.totals().measured + test.map.totals().left_out, 10);
    EXPECT_EQ(test.map.totals().left_out > 0, counts) << before;
    EXPECT_LT(test.map.totals().left_out, 10);
  }
}

TEST(MapState, PreparedAnewIsThatOfANewMap) {
  const Picture picture = wall();
  for (const int steps : {100, 5'000, 100'000, 1 << 29}) {  // left in its midst, and ended
    TestMap used(small_settings(), 2), fresh(small_settings(), 2);
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(used.map.look(picture.view()));
      used.run();
    }
    EXPECT_EQ(used.map.totals().maps, 1);
    EXPECT_GT(used.map.map().count, 0);
    used.map.make_map();
    (void)used.map.step(steps);
    used.prepare(small_settings(), 2);
    EXPECT_TRUE(used.map.idle());
    EXPECT_EQ(used.map.map().count, 0);
    EXPECT_EQ(used.map.totals().maps, 0);
    EXPECT_EQ(used.map.totals().pictures, 0);
    EXPECT_EQ(used.map.totals().measured, 0);
    used.map.make_map();
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

TEST(MapState, TakesUpWholePicturesAlone) {
  const std::vector<float> depth(6, 0.0f);
  const auto takes = [&](int width, int height, std::size_t pixels) {
    TestMap test;
    MapPicture picture;
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
  MapPicture picture;
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
  EXPECT_EQ(bytes_of([](S& s) { s.smoothing.candidates_max = k_map_smoothed_over_max + 1; }), 0u);
  EXPECT_EQ(bytes_of([](S& s) { s.outliers.candidates_max = k_map_candidates_max + 1; }), 0u);
  EXPECT_EQ(bytes_of([](S& s) { s.support.candidates_max = k_map_candidates_max + 1; }), 0u);
}

// 100 voxels: where points fill whole lines the grids state a line too many.
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
  settings.smoothing.candidates_max = k_map_smoothed_over_max - 2;
  settings.support.candidates_max = k_map_candidates_max - 3;
  const MapSettings fewer = in_slices(settings);
  EXPECT_EQ(fewer.outliers.candidates_max, k_map_candidates_max - 1);
  EXPECT_EQ(fewer.smoothing.candidates_max, k_map_smoothed_over_max - 2);
  EXPECT_EQ(fewer.support.candidates_max, k_map_candidates_max - 3);
  settings.outliers.candidates_max = k_map_candidates_max + 1;
  settings.smoothing.candidates_max = k_map_smoothed_over_max + 1;
  settings.support.candidates_max = k_map_candidates_max + 1;
  const MapSettings most = in_slices(settings);
  EXPECT_EQ(most.outliers.candidates_max, k_map_candidates_max);
  EXPECT_EQ(most.smoothing.candidates_max, k_map_smoothed_over_max);
  EXPECT_EQ(most.support.candidates_max, k_map_candidates_max);
}

}  // namespace
}  // namespace glint::map_slices_test
