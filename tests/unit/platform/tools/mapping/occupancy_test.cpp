#include "platform/tools/mapping/occupancy.hpp"

#include <gtest/gtest.h>
#include <octomap/octomap.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "platform/tools/mapping/host_cloud.hpp"
#include "temporary_folder.hpp"

namespace glint {
namespace {

CameraModel small_camera() {
  CameraModel camera;
  camera.width = 120, camera.height = 90;
  camera.fx = camera.fy = 90, camera.cx = 60, camera.cy = 45;
  return camera;
}

// A wall 1 m in front of a camera away from the world's origin, with depth noise of 1 cm. Its right
// half is 0.5 m further away. The map's points are on the true walls.
struct Corner {
  Pose T_world_camera{Quaternion::Identity(), Vector3(0.3, -0.2, 0.1)};
  std::vector<float> depth = std::vector<float>(120 * 90);
  OwnedCloud map{1 << 14};

  Corner() {
    const CameraModel camera = small_camera();
    for (int v = 0; v < 90; ++v) {
      for (int u = 0; u < 120; ++u) {
        const double wall = u < 60 ? 1.0 : 1.5;
        const int i = v * 120 + u;
        depth[static_cast<std::size_t>(i)] =
            static_cast<float>(wall + 0.01 * (i * 7919 % 21 - 10) / 10);
        const Vector3 point =
            T_world_camera * Vector3((u + 0.5 - camera.cx) / camera.fx * wall,
                                     (v + 0.5 - camera.cy) / camera.fy * wall, wall);
        (void)map.points().add(static_cast<float>(point.x()), static_cast<float>(point.y()),
                               static_cast<float>(point.z()));
      }
    }
  }
  [[nodiscard]] DepthImageView picture() const { return {120, 90, depth}; }
  void add_to(Occupancy& occupancy) const {
    occupancy.add_view(picture(), small_camera(), T_world_camera, {});
    occupancy.add_surface(map.points());
  }
};

// Fraction of points at this depth behind the near wall's inner part with the wanted state.
double state_fraction(const Occupancy& occupancy, const Corner& corner, double behind_m,
                      Occupied wanted) {
  int found = 0, all = 0;
  for (double x = -0.5; x <= -0.1; x += 0.013) {
    for (double y = -0.4; y <= 0.4; y += 0.013) {
      // Along the line of sight, so that every depth uses the same pixels.
      const Vector3 place = corner.T_world_camera * (Vector3(x, y, 1) * (1 + behind_m));
      found += occupancy.at(place) == wanted ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(found) / all;
}

TEST(Occupancy, IsOccupiedAtTheSurfaceFreeInFrontAndUnknownBehind) {
  const Corner corner;
  Occupancy occupancy({.resolution_m = 0.02});
  corner.add_to(occupancy);
  EXPECT_GT(state_fraction(occupancy, corner, 0, Occupied::yes), 0.99);
  for (const double before : {-0.05, -0.1, -0.3, -0.6, -0.9}) {
    EXPECT_GT(state_fraction(occupancy, corner, before, Occupied::no), 0.99) << before;
  }
  for (const double behind : {0.03, 0.06, 0.2, 0.4}) {
    EXPECT_EQ(state_fraction(occupancy, corner, behind, Occupied::unknown), 1) << behind;
  }
  EXPECT_GT(occupancy.counts().rays, 1000);
  EXPECT_EQ(occupancy.counts().out_of_range, 0);
}

TEST(Occupancy, IsReadBackByOctomapFromItsFileAndItsMessage) {
  const TemporaryFolder folder;
  const Corner corner;
  Occupancy occupancy({.resolution_m = 0.02});
  corner.add_to(occupancy);
  folder.write("map.bt", occupancy.file_bytes());
  octomap::OcTree from_file(0.1);
  ASSERT_TRUE(from_file.readBinary(folder.path("map.bt")));
  EXPECT_EQ(from_file.getResolution(), 0.02);
  const std::vector<std::int8_t> data = occupancy.message_bytes();
  std::stringstream stream(std::string(data.begin(), data.end()));
  octomap::OcTree from_message(0.02);
  from_message.readBinaryData(stream);
  EXPECT_EQ(from_message.size(), from_file.size());
  int occupied = 0, compared = 0;
  for (double x = -0.6; x <= 1.2; x += 0.0371) {
    for (double z = 0.11; z <= 1.9; z += 0.0371) {
      const octomap::OcTreeNode* node = from_file.search(x, -0.19, z);
      const Occupied read = node == nullptr                  ? Occupied::unknown
                            : from_file.isNodeOccupied(node) ? Occupied::yes
                                                             : Occupied::no;
      EXPECT_EQ(read, occupancy.at({x, -0.19, z})) << x << " " << z;
      EXPECT_EQ(from_message.search(x, -0.19, z) == nullptr, node == nullptr);
      occupied += read == Occupied::yes ? 1 : 0;
      ++compared;
    }
  }
  EXPECT_GT(occupied, 10);
  EXPECT_GT(compared, 2000);
}

// Rays at grazing incidence do not clear the surface: the map's points stay occupied.
TEST(Occupancy, KeepsASurfaceThatRaysGraze) {
  const Corner corner;
  Occupancy occupancy({.resolution_m = 0.02});
  for (int i = 0; i < 2; ++i) corner.add_to(occupancy);
  Pose close = corner.T_world_camera;
  close.translation.z() += 0.97;  // 3 cm from the wall, parallel to it
  close.rotation = Quaternion(Eigen::AngleAxisd(-1.5, Vector3::UnitY()));
  occupancy.add_view({120, 90, std::vector<float>(120 * 90, 0.5f)}, small_camera(), close, {});
  occupancy.add_surface(corner.map.points());
  EXPECT_GT(state_fraction(occupancy, corner, 0, Occupied::yes), 0.99);
}

TEST(Occupancy, CountsWhatDoesNotFitAndWhatIsNoPlace) {
  const Corner corner;
  Occupancy occupancy({.resolution_m = 0.02, .nodes_max = 500});
  corner.add_to(occupancy);
  EXPECT_GT(occupancy.counts().rays_left_out, 1000);
  EXPECT_GT(occupancy.counts().points_left_out, 1000);
  OwnedCloud odd(2);
  (void)odd.points().add(1e9f, 0, 0);
  (void)odd.points().add(std::numeric_limits<float>::quiet_NaN(), 0, 0);
  occupancy.add_surface(odd.points());
  EXPECT_EQ(occupancy.counts().out_of_range, 2);
}

TEST(Occupancy, GivesTheSameBytesEachTime) {
  const Corner corner;
  Occupancy first({}), second({});
  corner.add_to(first);
  corner.add_to(second);
  EXPECT_EQ(first.file_bytes(), second.file_bytes());
}

TEST(Occupancy, RefusesSettingsOutOfRange) {
  for (const double wrong : {0.0, -1.0, 0.001, 2.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(Occupancy({.resolution_m = wrong}), InputError);
  }
  EXPECT_THROW(Occupancy({.stop_short_voxels = -1}), InputError);
  EXPECT_THROW(Occupancy({.nodes_max = 0}), InputError);
}

}  // namespace
}  // namespace glint
