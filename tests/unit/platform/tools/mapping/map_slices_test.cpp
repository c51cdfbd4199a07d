// A map made in slices, compared with the plain chain over the same depth images.
#include "kernels/cloud/map_slices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <vector>

#include "platform/tools/mapping/map_chain.hpp"
#include "tests/unit/heap_count.hpp"

namespace glint {
namespace {

constexpr int k_width = 64, k_height = 48;

MapSettings small_settings() {
  MapSettings settings;
  settings.voxels_max = 20'000;
  settings.planes.points_min = 100;
  return limited_for_slices(settings);
}

// Depth images of a room's corner with a disc in front of it, from six positions; a few stray
// points.
struct CornerOfARoom {
  CameraModel camera;
  std::vector<std::vector<float>> depth;
  std::vector<Pose> poses;
  std::vector<ExclusionCapsule> left_out{{Vector3(0, 0, 0.2), Vector3(0, 0, 3), 0.05}};

  CornerOfARoom() {
    camera.width = k_width, camera.height = k_height;
    camera.fx = camera.fy = 60, camera.cx = 32, camera.cy = 24;
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise(0, 0.003);
    for (int p = 0; p < 6; ++p) {
      poses.push_back({Quaternion::Identity(), Vector3(0.03 * p, -0.02 * p, 0.01 * p)});
      auto& picture = depth.emplace_back();
      for (int i = 0; i < k_width * k_height; ++i) {
        const Vector3 ray((i % k_width + 0.5 - camera.cx) / camera.fx,
                          (i / k_width + 0.5 - camera.cy) / camera.fy, 1);
        const Vector3 at = poses.back().translation;
        double z = 1.2 - at.z();                                     // a wall
        if (ray.y() > 0) z = std::min(z, (0.4 - at.y()) / ray.y());  // a floor
        if (i % 97 == 0) z *= 0.6;                                   // strays
        const Vector3 to_ball = Vector3(-0.2, 0.1, 0.8) - at;
        if ((to_ball.z() * ray - to_ball).norm() < 0.12) z = to_ball.z();  // a disc
        picture.push_back(i % 31 == 0 ? 0.0f : static_cast<float>(z + noise(random)));
      }
    }
  }
  [[nodiscard]] MapImage picture(std::size_t i) const {
    return {{k_width, k_height, depth[i]}, camera, poses[i], left_out};
  }
};

struct Sliced {
  std::vector<std::byte> memory;
  MapSlices map;
  int steps_max = 0;
  std::map<MapSlices::Stage, std::pair<int, int>> taken_by;  // slices and steps

  Sliced(const MapSettings& settings, int images_per_map) : memory(MapSlices::bytes(settings)) {
    Arena arena(memory);
    EXPECT_EQ(map.prepare(settings, images_per_map, arena), Reason::none);
  }
  void run(int steps) {
    while (!map.idle()) {
      const MapSlices::Stage stage = map.stage();
      const auto before = static_cast<int>(stage);
      const int taken = map.step(steps);
      ++taken_by[stage].first;
      taken_by[stage].second += taken;
      // A call with one step completes one item, whatever step count it returns.
      if (steps == 1 && !map.idle()) {
        ASSERT_LE(static_cast<int>(map.stage()), before + 1);
      }
      ASSERT_GT(taken, 0);
      ASSERT_LE(taken, steps + k_map_item_steps_max);
      steps_max = std::max(steps_max, taken);
    }
  }
};

std::vector<float> bits_of(const PointCloud& cloud) {
  std::vector<float> out;
  for (const Column<float>* column : {&cloud.x, &cloud.y, &cloud.z, &cloud.normal_x,
                                      &cloud.normal_y, &cloud.normal_z, &cloud.weight}) {
    if (cloud.count > 0) out.insert(out.end(), column->data(), column->data() + cloud.count);
  }
  return out;
}

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

class OfAnySize : public testing::TestWithParam<int> {};

TEST_P(OfAnySize, SlicesGiveTheChainsBits) {
  const CornerOfARoom corner;
  const MapSettings settings = small_settings();
  Sliced sliced(settings, 3);
  MapChain chain(settings);
  for (std::size_t i = 0; i < 6; ++i) {
    ASSERT_TRUE(sliced.map.look(corner.picture(i)));
    sliced.run(GetParam());
    chain.add_frame({k_width, k_height, corner.depth[i]}, corner.camera, corner.poses[i],
                    corner.left_out);
    EXPECT_EQ(sliced.map.totals().pictures, static_cast<std::int64_t>(i) + 1);
    EXPECT_EQ(sliced.map.totals().maps, static_cast<std::int64_t>(i + 1) / 3);
    if (i % 3 != 2) continue;
    chain.finish();
    chain.project_onto_planes();
    EXPECT_TRUE(same_bits(bits_of(sliced.map.map()), bits_of(chain.map())));
    const MapTotals& totals = sliced.map.totals();
    EXPECT_EQ(totals.measured, chain.counts().measured);
    EXPECT_EQ(totals.left_out, chain.counts().left_out);
    EXPECT_EQ(totals.voxels, chain.counts().voxels);
    EXPECT_EQ(totals.kept, chain.counts().kept);
    EXPECT_EQ(totals.smoothed, chain.counts().smoothed);
    EXPECT_EQ(totals.on_planes, chain.counts().on_planes);
    EXPECT_EQ(totals.planes, chain.planes().count());
    EXPECT_GE(totals.planes, 2);
    EXPECT_GT(totals.left_out, 0);
    EXPECT_LT(totals.kept, totals.voxels);
  }
}

INSTANTIATE_TEST_SUITE_P(MapSlices, OfAnySize, testing::Values(1, 137, 5'000, 50'000, 1 << 29));

// More slices take no fewer steps: each call of a stage adds a fixed number of steps.
TEST(MapSlices, CountTheStepsOfEachCall) {
  const CornerOfARoom corner;
  Sliced few(small_settings(), 1), many(small_settings(), 1);
  for (const auto& [sliced, steps] : {std::pair{&few, 300}, std::pair{&many, 1}}) {
    ASSERT_TRUE(sliced->map.look(corner.picture(0)));
    sliced->run(steps);
  }
  ASSERT_EQ(many.taken_by.size(), 7u);
  for (const auto& [stage, took] : many.taken_by) {
    if (stage == MapSlices::Stage::points) continue;  // its slices always have eight pixels
    const auto [slices, steps] = few.taken_by[stage];
    EXPECT_GT(took.first, slices) << static_cast<int>(stage);
    EXPECT_GE(took.second - steps, 16 * (took.first - slices)) << static_cast<int>(stage);
  }
}

TEST(MapSlices, KeepWhatIsOutWholeWhileTheNextIsMade) {
  const CornerOfARoom corner;
  Sliced sliced(small_settings(), 1);
  EXPECT_EQ(sliced.map.map().count, 0);
  ASSERT_TRUE(sliced.map.look(corner.picture(0)));
  sliced.run(10'000);
  const std::vector<float> first = bits_of(sliced.map.map());
  ASSERT_GT(first.size(), 0u);
  ASSERT_TRUE(sliced.map.look(corner.picture(1)));
  int slices = 0;
  for (; sliced.map.totals().maps == 1; ++slices) {
    EXPECT_TRUE(same_bits(bits_of(sliced.map.map()), first));
    EXPECT_FALSE(sliced.map.look(corner.picture(2)));  // a map is in progress
    (void)sliced.map.step(10'000);
  }
  EXPECT_GT(slices, 10);
  EXPECT_FALSE(same_bits(bits_of(sliced.map.map()), first));
}

TEST(MapSlices, MakeAMapOfWhatThereIsWhenAsked) {
  const CornerOfARoom corner;
  const MapSettings settings = small_settings();
  Sliced sliced(settings, 1'000);
  sliced.map.start_map();  // no points: no map
  EXPECT_TRUE(sliced.map.idle());
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(sliced.map.look(corner.picture(i)));
    sliced.run(50'000);
  }
  EXPECT_EQ(sliced.map.map().count, 0);
  sliced.map.start_map();
  sliced.run(50'000);
  EXPECT_EQ(sliced.map.totals().maps, 1);
  EXPECT_GT(sliced.map.map().count, 0);
  sliced.map.start_map();  // no new depth image
  EXPECT_TRUE(sliced.map.idle());
}

TEST(MapSlices, RefuseWhatWouldMakeASliceLonger) {
  const auto refusal = [](MapSettings settings, int images_per_map) {
    std::vector<std::byte> memory(std::size_t{1} << 26);
    Arena arena(memory);
    MapSlices map;
    const Reason reason = map.prepare(settings, images_per_map, arena);
    EXPECT_EQ(map.step(100), 0);
    return reason;
  };
  EXPECT_EQ(refusal(small_settings(), 1), Reason::none);
  EXPECT_EQ(refusal(small_settings(), 0), Reason::out_of_range);
  MapSettings settings = small_settings();
  settings.smoothing.candidates_max = k_map_smoothing_candidates_max + 1;
  EXPECT_EQ(refusal(settings, 1), Reason::out_of_range);
  EXPECT_EQ(MapSlices::bytes(settings), 0u);
  settings = small_settings();
  settings.voxels_max = 1 << 22;
  EXPECT_EQ(refusal(settings, 1), Reason::not_prepared);
  settings = small_settings();
  settings.voxels.voxel_m = 0;
  EXPECT_EQ(refusal(settings, 1), Reason::out_of_range);
}

TEST(MapSlices, RefuseAnyLessMemoryThanTheyAskFor) {
  MapSettings settings = small_settings();
  settings.voxels_max = 100;
  const std::size_t whole = MapSlices::bytes(settings);
  for (std::size_t part = 0; part < 200; ++part) {
    std::vector<std::byte> memory((whole - Arena::k_alignment) * part / 200);
    Arena arena(memory);
    MapSlices map;
    EXPECT_EQ(map.prepare(settings, 1, arena), Reason::not_prepared) << part;
  }
}

TEST(MapSlices, TakeTheMostCandidatesAndRefuseOneMore) {
  const auto reason_of = [](const MapSettings& settings) {
    std::vector<std::byte> memory(std::size_t{1} << 26);
    Arena arena(memory);
    MapSlices map;
    return map.prepare(settings, 1, arena);
  };
  for (const int more : {0, 1}) {
    const Reason expected = more == 0 ? Reason::none : Reason::out_of_range;
    MapSettings settings = small_settings();
    settings.outliers.candidates_max = k_map_candidates_max + more;
    EXPECT_EQ(reason_of(settings), expected) << "outliers, " << more;
    settings = small_settings();
    settings.smoothing.candidates_max = k_map_smoothing_candidates_max + more;
    EXPECT_EQ(reason_of(settings), expected) << "smoothing, " << more;
    settings = small_settings();
    settings.support.candidates_max = k_map_candidates_max + more;
    EXPECT_EQ(reason_of(settings), expected) << "support, " << more;
    settings = small_settings();
    settings.voxels_max = more == 0 ? 1 : 0;
    EXPECT_EQ(reason_of(settings), expected) << "voxels, " << more;
  }
}

TEST(MapSlices, RefuseAPictureThatIsNotWhole) {
  const CornerOfARoom corner;
  Sliced sliced(small_settings(), 1);
  MapImage picture = corner.picture(0);
  picture.picture.height += 1;
  EXPECT_FALSE(sliced.map.look(picture));
  EXPECT_TRUE(sliced.map.idle());
}

TEST(MapSlices, TakeNothingFromTheHeap) {
  const CornerOfARoom corner;
  Sliced sliced(small_settings(), 1);
  const HeapCount heap;
  ASSERT_TRUE(sliced.map.look(corner.picture(0)));
  while (!sliced.map.idle()) (void)sliced.map.step(50'000);
  EXPECT_EQ(heap.count(), 0u);
}

}  // namespace
}  // namespace glint
