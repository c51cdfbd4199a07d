// Step counts of the sliced mapping pipeline, compared with those of its kernels run separately.
#include "kernels/cloud/map_slices.hpp"

#include <map>
#include <memory>

#include "mapped_wall.hpp"

namespace glint::map_slices_test {
namespace {

using mapped_wall::Picture;
using mapped_wall::SeparateKernels;
using mapped_wall::small_settings;
using mapped_wall::TestMap;
using mapped_wall::wall;
using Stage = MapSlices::Stage;

// Steps of the slice that processes one row of pixels.
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
    for (const int count : {0, 1, 5, k_exclusion_capsules_max, k_exclusion_capsules_max + 1}) {
      EXPECT_EQ(steps_of_row(width, 0, static_cast<std::size_t>(count)),
                call + looked_at * (pixel + std::min(count, k_exclusion_capsules_max) * capsule))
          << width << ' ' << count;
    }
  }
}

// A lookup table is read once a ray; a polynomial lens counts its maximum number of iterations.
TEST(MapSliceSteps, OfAPixelAreThoseOfItsLens) {
  const int plain = pixel_steps(), look_up = pixel_steps(Lens::lut) - plain;
  EXPECT_GT(look_up, 0);
  EXPECT_EQ(pixel_steps(Lens::brown) - plain, k_ray_steps_max * look_up);
  EXPECT_EQ(pixel_steps(Lens::rational) - plain, k_ray_steps_max * look_up);
}

// The difference to a row without depth.
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

TEST(MapSliceSteps, OfEachStageAreItsKernelsOfEachCallAndOfBeginningTheNext) {
  const int call = call_steps();
  const SeparateKernels alone(wall());
  TestMap test(small_settings(), 1);
  const Picture picture = wall();
  ASSERT_TRUE(test.map.look(picture.view()));
  std::map<Stage, SeparateKernels::StageCost> cost_of_stage;
  while (!test.map.idle()) {
    SeparateKernels::StageCost& of_stage = cost_of_stage[test.map.stage()];
    of_stage.steps += test.map.step(1);
    ++of_stage.calls;
  }
  const int begin = cost_of_stage[Stage::outliers].steps -
                    alone.cost_of_stage.at(Stage::outliers).steps -
                    cost_of_stage[Stage::outliers].calls * call;
  EXPECT_GT(begin, 0);
  for (const auto& [stage, kernel] : alone.cost_of_stage) {
    EXPECT_EQ(cost_of_stage[stage].calls, kernel.calls) << static_cast<int>(stage);
    EXPECT_EQ(cost_of_stage[stage].steps, kernel.steps + kernel.calls * call + begin)
        << static_cast<int>(stage);
  }
  const int pixels = 40 * 30, probe = steps_of_row(1, 1.005f) - steps_of_row(1);
  EXPECT_EQ(cost_of_stage[Stage::points].calls, pixels / k_map_pixels_at_once);
  EXPECT_EQ(cost_of_stage[Stage::points].steps,
            cost_of_stage[Stage::points].calls * call + pixels * pixel_steps() +
                static_cast<int>(alone.voxels.probes()) * probe);
  // Each call processes one voxel or point; all calls take the same number of steps.
  EXPECT_EQ(cost_of_stage[Stage::voxels].calls, alone.voxels.count());
  EXPECT_EQ(cost_of_stage[Stage::voxels].steps % alone.voxels.count(), 0);
  EXPECT_EQ(cost_of_stage[Stage::snap].calls, alone.smoothed.points.count);
  EXPECT_EQ(cost_of_stage[Stage::snap].steps % alone.smoothed.points.count, 0);
}

// A slice processes as many items as its steps allow; one more voxel needs its full step count.
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
    // The overhead of a call counts too: it ends the slice although the items leave a few steps.
    for (const int items : {1, 2, 7, 100}) {
      EXPECT_EQ(at_stage(stage)->map.step(items * each), call + items * each);
      EXPECT_EQ(at_stage(stage)->map.step(items * each + each - 1), call + items * each);
    }
    const SeparateKernels alone(picture);
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

}  // namespace
}  // namespace glint::map_slices_test
