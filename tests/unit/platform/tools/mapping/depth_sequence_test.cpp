#include "platform/tools/mapping/depth_sequence.hpp"

#include "platform/formats/npy.hpp"
#include "platform/tools/mapping/depth_png.hpp"
#include "platform/tools/mapping/map_chain.hpp"
#include "temporary_folder.hpp"

namespace glint {
namespace {

const std::string k_pinhole = "60 0 32\n0 60 24\n0 0 1\n";
const std::string k_pose = "1 0 0 0.5\n0 1 0 0\n0 0 1 -1\n0 0 0 1\n";

std::string flat_picture(std::size_t width, std::size_t height, float depth) {
  return npy_float32_bytes({{height, width}, std::vector<float>(width * height, depth)});
}

std::string error_message_for(const TemporaryFolder& folder) {
  return error_message_of([&] { (void)load_depth_sequence(folder.path("")); });
}

TEST(DepthSequence, IsReadByNameWithItsPosesAndItsCamera) {
  const TemporaryFolder folder;
  folder.write("camera-intrinsics.txt", k_pinhole);
  folder.write("b.depth.npy", flat_picture(64, 48, 2));
  folder.write("b.pose.txt", "0 -1 0 1\n1 0 0 2\n0 0 1 3\n0 0 0 1\n");
  folder.write("a.depth.npy", flat_picture(64, 48, 1));
  folder.write("a.pose.txt", k_pose);
  const DepthSequence sequence = load_depth_sequence(folder.path(""));
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.camera.cx, 32.5);
  EXPECT_EQ(sequence.camera.width, 64);
  EXPECT_EQ(sequence.frames[0].depth_m[5], 1.0f);
  EXPECT_LT((sequence.frames[0].T_world_camera.translation - Vector3(0.5, 0, -1)).norm(), 1e-12);
  EXPECT_LT((sequence.frames[1].T_world_camera * Vector3::UnitX() - Vector3(1, 3, 3)).norm(),
            1e-12);
}

TEST(DepthSequence, RefusesWhatIsMissingOrWrongByNameAndPlace) {
  const auto expect_one = [](const std::string& camera, const std::string& pose,
                             const std::string& picture, const std::string& what) {
    const TemporaryFolder folder;
    folder.write("camera-intrinsics.txt", camera);
    folder.write("a.depth.npy", flat_picture(8, 8, 1));
    folder.write("a.pose.txt", k_pose);
    folder.write("b.depth.npy", picture);
    folder.write("b.pose.txt", pose);
    const std::string message = error_message_for(folder);
    EXPECT_NE(message.find(what), std::string::npos) << message << "\nexpected: " << what;
  };
  const std::string good = flat_picture(8, 8, 1);
  expect_one("60 0 32", k_pose, good, "intrinsics.txt:line 1: 3 numbers; expected 9");
  expect_one("0 0 32\n0 60 24\n0 0 1\n", k_pose, good, "intrinsics.txt:line 3: another matrix");
  expect_one(k_pinhole, "1 0 0", good, "b.pose.txt:line 1: 3 numbers; expected 16");
  expect_one(k_pinhole, "1 0 0 nan\n", good, "b.pose.txt:line 1: a number that is not finite");
  expect_one(k_pinhole, "1 0 0 0\n0 2 0 0\n0 0 1 0\n0 0 0 1\n", good, "orthonormality error");
  expect_one(k_pinhole, "-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n", good, "orthonormality error");
  expect_one(k_pinhole, "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 1 1\n", good, "another last row");
  expect_one(k_pinhole, k_pose, flat_picture(9, 8, 1), "b.depth.npy: 9 x 8 pixels; expected");
  expect_one(k_pinhole, k_pose, "rubbish", "no NumPy magic");
}

TEST(DepthSequence, RefusesAFolderWithoutPicturesOrAPictureWithoutPose) {
  const TemporaryFolder folder;
  EXPECT_NE(error_message_for(folder).find("camera-intrinsics.txt: cannot be read"),
            std::string::npos);
  folder.write("camera-intrinsics.txt", k_pinhole);
  EXPECT_NE(error_message_for(folder).find("0 depth images"), std::string::npos);
  folder.write("a.depth.png", "no picture");
  EXPECT_NE(error_message_for(folder).find("expected a PNG with one plane of 16 bits"),
            std::string::npos);
  std::filesystem::remove(folder.path("a.depth.png"));
  folder.write("a.depth.npy", flat_picture(8, 8, 1));
  EXPECT_NE(error_message_for(folder).find("a.pose.txt: cannot be read"), std::string::npos);
}

// A wall at one metre, in two depth images, one of them oblique.
TEST(MapChain, MakesAWallFlatAndSaysWhatItDid) {
  CameraModel camera;
  camera.width = 200, camera.height = 150;
  camera.fx = camera.fy = 150, camera.cx = 100, camera.cy = 75;
  std::vector<float> depth(200 * 150);
  for (std::size_t i = 0; i < depth.size(); ++i) {
    depth[i] = 1.0f + 0.004f * static_cast<float>(static_cast<int>(i * 7919 % 11) - 5) / 5;
  }
  MapSettings settings;
  settings.voxels_max = 1 << 16;
  MapChain chain(settings);
  Pose aside;
  aside.translation = Vector3(0.05, 0.02, 0);
  for (const Pose& pose : {Pose{}, aside}) chain.add_frame({200, 150, depth}, camera, pose);
  chain.finish();
  ASSERT_EQ(chain.planes().count(), 1);
  EXPECT_EQ(chain.counts().measured, 2 * 200 * 150);
  EXPECT_GT(chain.counts().on_planes, chain.counts().smoothed * 9 / 10);
  EXPECT_LT(chain.planes().plane(0).rms_m, 0.0015);
  EXPECT_NEAR(std::abs(chain.planes().plane(0).offset_m), 1, 0.001);
  EXPECT_TRUE(chain.counts().notices.empty());
  chain.project_onto_planes();
  for (int i = 0; i < chain.map().count; ++i) {
    if (chain.planes().plane_of(i) == 0) {
      ASSERT_NEAR(chain.map().z[i], chain.map().z[0], 0.02);
    }
  }
}

TEST(DepthSequence, ReadsWhatIsLeftOutAndRefusesAWrongLine) {
  const auto read = [](const std::string& lines) {
    const TemporaryFolder folder;
    folder.write("camera-intrinsics.txt", k_pinhole);
    folder.write("a.depth.npy", flat_picture(8, 8, 1));
    folder.write("a.pose.txt", k_pose);
    folder.write("a.left_out.txt", lines);
    return load_depth_sequence(folder.path("")).frames[0].left_out;
  };
  const auto left_out = read("0 0 1  0 0.2 1  0.03\n\n1 2 3 1 2 3 0.1\n");
  ASSERT_EQ(left_out.size(), 2u);
  EXPECT_EQ(left_out[0].to, Vector3(0, 0.2, 1));
  EXPECT_EQ(left_out[1].radius_m, 0.1);
  std::string many;
  for (int i = 0; i < 65; ++i) many += "0 0 0 0 0 0 1\n";
  for (const auto& [lines, what] :
       {std::pair<std::string, std::string>{"0 0 1 0", "line 1: 4 numbers"},
        {"0 0 0 0 0 0 1\n0 0 0 0 0 0 0", "line 2: no radius"},
        {"0 0 nan 0 0 0 1", "line 1: a number that is not finite"},
        {many, "line 65: one more"}}) {
    const std::string message = error_message_of([&, &text = lines] { (void)read(text); });
    EXPECT_NE(message.find(what), std::string::npos) << message;
  }
}

// A pen in front of a wall: its capsule removes it from the map, and the wall is complete.
TEST(MapChain, LeavesOutThePen) {
  CameraModel camera;
  camera.width = 200, camera.height = 150;
  camera.fx = camera.fy = 150, camera.cx = 100, camera.cy = 75;
  std::vector<float> depth(200 * 150, 1.0f);
  for (std::size_t y = 60; y < 90; ++y) {
    for (std::size_t x = 80; x < 120; ++x) depth[y * 200 + x] = 0.6f;
  }
  const std::vector<ExclusionCapsule> pen = {{{-0.08, 0, 0.6}, {0.08, 0, 0.6}, 0.07}};
  MapSettings settings;
  settings.voxels_max = 1 << 16;
  for (const bool with_capsules : {false, true}) {
    MapChain chain(settings);
    chain.add_frame({200, 150, depth}, camera, Pose{},
                    with_capsules ? pen : std::vector<ExclusionCapsule>{});
    chain.finish();
    int near = 0, far = 0;
    for (int i = 0; i < chain.map().count; ++i) ++(chain.map().z[i] < 0.8f ? near : far);
    EXPECT_EQ(near == 0, with_capsules);
    EXPECT_GT(far, 5000);
    EXPECT_EQ(chain.counts().left_out, with_capsules ? 30 * 40 : 0);
  }
}

TEST(MapChain, SaysWhatWasLeftOutAndRefusesSettingsOutOfRange) {
  CameraModel camera;
  camera.width = 64, camera.height = 48;
  camera.fx = camera.fy = 60, camera.cx = 32, camera.cy = 24;
  MapSettings settings;
  settings.voxels_max = 100;
  MapChain chain(settings);
  chain.add_frame({64, 48, std::vector<float>(64 * 48, 1.0f)}, camera, Pose{});
  chain.finish();
  ASSERT_EQ(chain.counts().notices.size(), 1u);
  EXPECT_NE(chain.counts().notices[0].find("more voxels"), std::string::npos);
  settings.voxels.voxel_m = 0;
  EXPECT_THROW(MapChain{settings}, InputError);
  settings = {};
  settings.depth.stride = 0;
  EXPECT_THROW(MapChain{settings}, InputError);
}

}  // namespace
}  // namespace glint
