#include "platform/tools/robot/mesh_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "platform/tools/robot/primitives.hpp"
#include "tests/unit/platform/tools/calibrate/expect_message.hpp"
#include "tests/unit/platform/tools/robot/files.hpp"

namespace glint {
namespace {

using test::expect_input_error;
using test::Files;
using test::stl_bytes;

const Eigen::Vector3d k_one = Eigen::Vector3d::Ones();
const Eigen::Vector3d k_tenth = 0.1 * k_one;

// A triangle with corners at 1, 2 and 3 units on the three axes.
std::string collada(const std::string& unit, const std::string& up) {
  return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><unit name='u' meter='" +
         unit + "'/><up_axis>" + up +
         "</up_axis></asset><library_geometries><geometry id='g'><mesh><source id='s'>"
         "<float_array id='f' count='9'>1 0 0 0 2 0 0 0 3</float_array><technique_common>"
         "<accessor source='#f' count='3' stride='3'><param name='X' type='float'/>"
         "<param name='Y' type='float'/><param name='Z' type='float'/></accessor>"
         "</technique_common></source><vertices id='v'><input semantic='POSITION' source='#s'/>"
         "</vertices><triangles count='1'><input semantic='VERTEX' source='#v' offset='0'/>"
         "<p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>"
         "<visual_scene id='w'><node id='n'><instance_geometry url='#g'/></node></visual_scene>"
         "</library_visual_scenes><scene><instance_visual_scene url='#w'/></scene></COLLADA>";
}

TEST(MeshFile, ReadsStlAndObjAlike) {
  const Files files;
  const Mesh stl = read_mesh(files.write("a.STL", stl_bytes(box_surface({0.1, 0.2, 0.3}))), k_one);
  EXPECT_EQ(stl.triangles.size(), 12u);
  const Mesh obj =
      read_mesh(files.write("a.obj", "v 0 0 0\nv 100 0 0\nv 100 200 0\nv 0 200 0\nf 1 2 3 4\n"),
                {1e-3, 1e-3, 1e-3});
  ASSERT_EQ(obj.triangles.size(), 2u);  // a quadrilateral face
  float most = 0;
  for (const Triangle& t : obj.triangles) most = std::max({most, t.a.y(), t.b.y(), t.c.y()});
  EXPECT_FLOAT_EQ(most, 0.2f);
}

TEST(MeshFile, AppliesColladasUnitAndLeavesItsUpAxisToTheUrdf) {
  const Files files;
  for (const char* up : {"X_UP", "Y_UP", "Z_UP"}) {
    const Mesh mesh = read_mesh(files.write("a.dae", collada("0.001", up)), k_one);
    ASSERT_EQ(mesh.triangles.size(), 1u);
    Vector3f sum = mesh.triangles[0].a + mesh.triangles[0].b + mesh.triangles[0].c;
    EXPECT_LT((sum - Vector3f(0.001f, 0.002f, 0.003f)).norm(), 1e-8f) << up;
  }
}

TEST(MeshFile, NoticesMillimetresByTheirSize) {
  const Files files;
  const std::string path = files.write("mm.stl", stl_bytes(box_surface({100, 200, 300})));
  expect_input_error([&] { (void)read_mesh(path, k_one); }, {"mm.stl", "millimetres", "0.001"});
  EXPECT_EQ(read_mesh(path, {1e-3, 1e-3, 1e-3}).triangles.size(), 12u);
  const std::string tiny = files.write("tiny.stl", stl_bytes(box_surface({1e-4, 2e-4, 3e-4})));
  expect_input_error([&] { (void)read_mesh(tiny, {1, 1, 1}); }, {"tiny.stl", "double scaling"});
}

TEST(MeshFile, SkipsAndCountsTrianglesWithoutAnArea) {
  const Files files;
  std::vector<Triangle> triangles = box_surface({0.1, 0.2, 0.3});
  const Vector3f p(0.01f, 0, 0), q(0.02f, 0, 0), r(0.03f, 0, 0);
  triangles.push_back({p, p, p});
  triangles.push_back({p, q, r});
  triangles.push_back({p, q, Vector3f(0, std::numeric_limits<float>::quiet_NaN(), 0)});
  const Mesh mesh = read_mesh(files.write("a.stl", stl_bytes(triangles)), k_one);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.skipped, 3);
  expect_input_error(
      [&] {
        (void)read_mesh(files.write("flat.stl", stl_bytes({{p, p, p}, {p, q, r}})), k_one);
      },
      {"flat.stl", "area"});
}

TEST(MeshFile, RefusesFilesThatAreNotWhatTheySay) {
  const Files files;
  std::string malformed = stl_bytes(box_surface({0.1, 0.2, 0.3}));
  malformed[83] = '\x7f';  // about two thousand million triangles
  expect_input_error([&] { (void)read_mesh(files.write("lies.stl", malformed), k_one); },
                     {"lies.stl:byte 80"});
  expect_input_error([&] { (void)read_mesh(files.write("e.stl", ""), k_one); }, {"e.stl"});
  expect_input_error([&] { (void)read_mesh(files.write("e.obj", "v 1 2\nf 9 9 9\n"), k_one); },
                     {"e.obj"});
  expect_input_error([&] { (void)read_mesh(files.write("e.dae", "<COLLADA"), k_one); }, {"e.dae"});
  expect_input_error([&] { (void)read_mesh(files.write("e.step", "x"), k_one); },
                     {"e.step", ".stl"});
}

// Without this limit a robot description received over DDS could read any file.
TEST(FindMesh, StaysInThePackageFolders) {
  const Files files;
  const std::string secret = files.write("secret.stl", "x"), part = files.write("p/m/a.stl", "x");
  const std::string package = files.folder() + "/p";
  const RobotFiles robot{"/robot_description", {package}, Geometry::collision, "text"};
  const auto refused = [&](const std::string& name) {
    expect_input_error([&] { (void)find_mesh(name, robot); }, {"/robot_description", "mesh '"});
  };
  EXPECT_EQ(find_mesh("package://arm/m/a.stl", robot), part);
  EXPECT_EQ(find_mesh("file://" + part, robot), part);
  EXPECT_EQ(find_mesh("file://" + package + "/m/../m/./a.stl", robot), part);
  refused("file://");
  refused("package://x/" + std::string(300, 'a'));  // longer than a file name may be
  refused("package://x/../secret.stl");
  refused("package://../secret.stl");
  refused("package://x/m/../../secret.stl");
  refused("package://x/" + secret);  // two slashes
  refused("package://" + secret);
  refused("file://" + secret);
  refused("file://" + package + "/../secret.stl");
  refused("file://" + package + "x/../secret.stl");
  refused(secret);
  refused("../secret.stl");
  refused(package);  // a folder; found by fuzzing
  refused("//" + package);
  refused(package + "/");
  refused(package + "/m/b.stl");  // does not exist
}

TEST(FindMesh, OfAFileStaysInItsFolderAndThePackageFolders) {
  const Files files;
  const std::string urdf = files.write("u/arm.urdf", ""), beside = files.write("u/a.stl", "x");
  const std::string other = files.write("m/b.stl", "x");
  EXPECT_EQ(find_mesh("a.stl", {urdf, {}}), beside);
  expect_input_error(
      [&] {
        (void)find_mesh("../m/b.stl", {urdf, {}});
      },
      {"arm.urdf", "'../m/b.stl' lies outside", "--package-dir"});
  EXPECT_EQ(find_mesh("../m/b.stl", {urdf, {"arm=" + files.folder() + "/m/"}}), other);
}

// Reads the Collada file above with `from` replaced by `to`. assimp 5.2.5 crashed on the first two
// cases and exhausted the memory on the others.
void expect_refused_after_crash(const std::string& from, const std::string& to,
                                const char* message) {
  const Files files;
  std::string text = collada("0.001", "Z_UP");
  ASSERT_NE(text.find(from), std::string::npos) << from;
  text.replace(text.find(from), from.size(), to);
  const std::string path = files.write("damaged.dae", text);
  expect_input_error([&] { (void)read_mesh(path, k_one); }, {"damaged.dae", message});
}

TEST(MeshFile, OutlivesACrashOfTheLibrary) {
  expect_refused_after_crash("stride='3'", "stride='3' offset='99999999'", "cannot read it");
  expect_refused_after_crash("instance_geometry url='#g'", "instance_node url='#n'",
                             "cannot read it");
}

#ifndef GLINT_SANITIZED  // sanitizers reserve more address space than any limit
TEST(MeshFile, BoundsTheMemoryOfTheLibrary) {
  expect_refused_after_crash("count='9'", "count='4294967295'", "1024 MB of memory");
  expect_refused_after_crash("triangles count='1'", "triangles count='4294967295'",
                             "1024 MB of memory");
}
#endif

TEST(MeshFile, ReadsOrRefusesTheAwkwardOnes) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/hostile/assimp_stl/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  EXPECT_EQ(read_mesh(folder + "triangle.stl", k_one).triangles.size(), 1u);
  EXPECT_EQ(read_mesh(folder + "triangle_with_two_solids.stl", k_one).triangles.size(), 2u);
  EXPECT_EQ(read_mesh(folder + "Spider_ascii.stl", k_tenth).triangles.size(),
            read_mesh(folder + "Spider_binary.stl", k_tenth).triangles.size());
}

TEST(MeshFile, OfARealRobotTheColladaMeshLiesOverItsStl) {
  const char* data = std::getenv("GLINT_TEST_DATA");
  const std::string folder = std::string(data == nullptr ? "" : data) + "/robots/ur5/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  const auto box = [&](const std::string& path) {
    Eigen::AlignedBox3f around;
    for (const Triangle& t : read_mesh(path, k_one).triangles) {
      around.extend(t.a).extend(t.b).extend(t.c);
    }
    return around;
  };
  const auto visual = box(folder + "visual/base.dae"),
             collision = box(folder + "collision/base.stl");
  EXPECT_LT((visual.min() - collision.min()).norm(), 0.01f);
  EXPECT_LT((visual.max() - collision.max()).norm(), 0.01f);
}

}  // namespace
}  // namespace glint
