#include "platform/tools/mapping/cloud_files.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "temporary_folder.hpp"

namespace glint {
namespace {

HostCloud sample(bool normals) {
  HostCloud cloud;
  for (int i = 0; i < 257; ++i) {
    const auto f = static_cast<float>(i);
    cloud.points.push_back({0.1f * f, -f / 3, 1e-7f * f});
    if (normals) cloud.normals.push_back({0, 1, f});
  }
  return cloud;
}

TEST(CloudFiles, ComeBackAsTheyWereWritten) {
  const TemporaryFolder folder;
  for (const bool normals : {false, true}) {
    for (const std::string name : {"cloud.ply", "cloud.pcd"}) {
      const HostCloud cloud = sample(normals);
      write_cloud(folder.path(name), cloud);
      const HostCloud back = read_cloud(folder.path(name));
      EXPECT_EQ(back.points, cloud.points) << name;
      EXPECT_EQ(back.normals, cloud.normals) << name;
    }
  }
  write_cloud(folder.path("none.ply"), {});
  EXPECT_TRUE(read_cloud(folder.path("none.ply")).points.empty());
}

TEST(CloudFiles, AreReadAsTextWithOtherFieldsAndElementsAmongThem) {
  const TemporaryFolder folder;
  const std::string ply = folder.write(
      "a.ply",
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement vertex 2\r\n"
      "property uchar red\r\nproperty double x\r\nproperty float y\r\nproperty float32 z\r\n"
      "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n"
      "255 1 2.5 -3e-1\r\n0 4 5 nan\r\n3 0 1 0\r\n");
  const HostCloud from_ply = read_cloud(ply);
  ASSERT_EQ(from_ply.points.size(), 2u);
  EXPECT_EQ(from_ply.points[0], (std::array<float, 3>{1, 2.5f, -0.3f}));
  EXPECT_TRUE(std::isnan(from_ply.points[1][2]));
  const std::string pcd = folder.write(
      "a.pcd",
      "# .PCD v0.7\nVERSION 0.7\nFIELDS rgb normal_z x y z normal_x normal_y\n"
      "SIZE 4 4 4 4 4 4 4\nTYPE U F F F F F F\nCOUNT 2 1 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n7 8 0.5 1 2 3 0.25 0.75\n");
  const HostCloud from_pcd = read_cloud(pcd);
  EXPECT_EQ(from_pcd.points, (std::vector<std::array<float, 3>>{{1, 2, 3}}));
  EXPECT_EQ(from_pcd.normals, (std::vector<std::array<float, 3>>{{0.25f, 0.75f, 0.5f}}));
}

std::string error_message_for(const std::string& name, const std::string& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder.write(name, bytes);
  return error_message_of([&] { (void)read_cloud(path); });
}

void expect_error(const std::string& name, const std::string& bytes, const std::string& what) {
  const std::string message = error_message_for(name, bytes);
  EXPECT_NE(message.find(what), std::string::npos) << message << "\nexpected: " << what;
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_NE(message.find(name), std::string::npos) << message;
}

TEST(CloudFiles, RefuseBadPlyByFileAndLine) {
  const std::string head = "ply\nformat ascii 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  expect_error("a.ply", "", "line 0: no \"ply\"");
  expect_error("a.ply", "solid\n", "line 1: no \"ply\"");
  expect_error("a.ply", head + "element vertex 1\n" + xyz, "line 6: the file ends");
  expect_error("a.ply", "ply\nformat binary_big_endian 1.0\n", "line 2: format binary_big");
  expect_error("a.ply", "ply\nelement vertex 1\n" + xyz + "end_header\n1 2 3\n", "no format");
  expect_error("a.ply", head + "end_header\n", "no vertices");
  expect_error("a.ply", head + "element face 2\n", "line 3: another element before");
  expect_error("a.ply", head + "element vertex -1\n", "line 3: \"-1\"; expected a count");
  expect_error("a.ply", head + "element vertex 99999999999\n", "expected a count up to");
  expect_error("a.ply", head + "element vertex 1\nproperty list uchar int x\n",
               "line 4: a list in a vertex");
  expect_error("a.ply", head + "element vertex 1\nproperty real x\n", "line 4: type \"real\"");
  expect_error("a.ply", head + "element vertex 1\nproperty float x\nend_header\n1\n", "no field y");
  expect_error("a.ply", head + "element vertex 1\n" + xyz + "end_header\n1 2.0000\n",
               "line 8: 2 words; expected 3");
  expect_error("a.ply", head + "element vertex 1\n" + xyz + "end_header\n1 2 x3\n",
               "line 8: \"x3\"; expected a number");
  expect_error("a.ply", head + "\x01\x02 what\n", "line 3: \"??\"");
  // As many points as a map's capacity, in a file of a few bytes: the reader reserves no memory.
  expect_error("a.ply", head + "element vertex 16000000\n" + xyz + "end_header\n1 2 3\n",
               "16000000 points");
  expect_error("a.ply",
               "ply\nformat binary_little_endian 1.0\nelement vertex 16000000\n" + xyz +
                   "end_header\n0123456789",
               "10 bytes behind the header");
}

TEST(CloudFiles, RefuseBadPcdByFileAndLine) {
  const std::string head = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  expect_error("a.pcd", "", "the file ends; expected DATA");
  expect_error("a.pcd", head + "DATA ascii\n", "no POINTS");
  expect_error("a.pcd", head + "POINTS 1\nDATA binary_packed\n", "DATA binary_packed");
  expect_error("a.pcd", head + "POINTS 2\nDATA ascii\n1 2 3.0000000\n\n\n", "after 1 points");
  expect_error("a.pcd", head + "POINTS 2\nDATA binary\n01234567890123456789012", "23 bytes");
  expect_error("a.pcd", "FIELDS x y z\nSIZE 4 4\n", "line 2: 2 words behind SIZE");
  expect_error("a.pcd", "FIELDS x y z\nTYPE F F Q\n", "line 2: type \"Q\"");
  expect_error("a.pcd", "FIELDS x y z\nSIZE 4 4 3\nPOINTS 1\nDATA ascii\n", "of 3 bytes");
  expect_error("a.pcd", "FIELDS x y z\nCOUNT 1 1 2\nPOINTS 1\nDATA ascii\n1 2 3 4\n",
               "field z holds several");
  expect_error("a.pcd", "FIELDS x y z\nCOUNT 1 1 999999999\n", "expected a count up to 1024");
  expect_error("a.pcd", "nonsense\n", "line 1: \"nonsense\"");
}

TEST(CloudFiles, RefuseAnotherEndingAFolderAndWhatIsNotThere) {
  const TemporaryFolder folder;
  const auto error_message = [&](const std::string& name) {
    return error_message_of([&] { (void)read_cloud(folder.path(name)); });
  };
  EXPECT_NE(error_message("a.stl").find("expected .ply or .pcd"), std::string::npos);
  EXPECT_NE(error_message("a.ply").find("cannot be read"), std::string::npos);
  std::filesystem::create_directory(folder.path("b.ply"));
  EXPECT_NE(error_message("b.ply").find("is a folder"), std::string::npos);
  EXPECT_THROW(write_cloud(folder.path("no/such/folder.ply"), sample(false)), InputError);
  EXPECT_THROW(write_cloud(folder.path("a.txt"), sample(false)), InputError);
}

TEST(CloudFiles, ReadAMeshMakersVertices) {
  const char* const data = std::getenv("GLINT_TEST_DATA");
  const std::filesystem::path folder =
      std::filesystem::path(data != nullptr ? data : "") / "hostile" / "assimp_ply";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << folder << " is not there";
  for (const char* const name : {"cube.ply", "cube_binary.ply"}) {
    const HostCloud cube = read_cloud((folder / name).string());
    ASSERT_EQ(cube.points.size(), 8u) << name;
    for (const auto& point : cube.points) {
      for (const float side : point) EXPECT_LE(std::abs(side), 1.0f);
    }
  }
}

}  // namespace
}  // namespace glint
