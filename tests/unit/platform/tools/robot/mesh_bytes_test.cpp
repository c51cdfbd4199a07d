#include "platform/tools/robot/mesh_bytes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/unit/platform/tools/calibrate/expect_message.hpp"

namespace glint {
namespace {

using test::expect_input_error;

Mesh two_triangles() {
  const Vector3f a(1, 2, 3), b(4, 5, 6), c(7, 8, 10);
  return {{{a, b, c}, {c, a, b}}, 5};
}

TEST(MeshBytes, ComeBackAsTheyWere) {
  const Mesh mesh = mesh_of_bytes(mesh_bytes(two_triangles()), "a.dae");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.skipped, 5);
  EXPECT_EQ(mesh.triangles[1].a, two_triangles().triangles[1].a);
}

TEST(MeshBytes, CarryTheReasonOfAFailure) {
  expect_input_error([] { (void)mesh_of_bytes(mesh_error_bytes("not a mesh: \x1B[2J"), "a.dae"); },
                     {"a.dae: not a mesh: ?[2J"});
}

TEST(MeshBytes, AreRefusedWhereTheyAreNoMesh) {
  const std::string whole = mesh_bytes(two_triangles());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    expect_input_error([&] { (void)mesh_of_bytes(whole.substr(0, size), "a.dae"); },
                       {"invalid mesh"});
  }
  expect_input_error([&] { (void)mesh_of_bytes(whole + "x", "a.dae"); }, {"invalid mesh"});
  std::string many = whole;
  many.replace(5, 4, "\xFF\xFF\xFF\x7F");
  expect_input_error([&] { (void)mesh_of_bytes(many, "a.dae"); }, {"invalid mesh"});
  Mesh endless = two_triangles();
  endless.triangles[1].b.y() = std::numeric_limits<float>::infinity();
  expect_input_error([&] { (void)mesh_of_bytes(mesh_bytes(endless), "a.dae"); },
                     {"triangle 1", "finite"});
}

}  // namespace
}  // namespace glint
