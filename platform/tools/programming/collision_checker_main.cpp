// glint_collision_checker: tests a robot's links with an octomap and with each other by FCL, in a
// separate process with limits (collision_check.hpp).
//
//   glint_collision_checker REQUEST MEMORY_MB
// REQUEST is text, a line for each item; a POSE is x y z qw qx qy qz, lengths in metres:
//   link LINK                          a link with shapes, numbered
//   box LINK X Y Z POSE                sides; POSE in the link
//   cylinder LINK RADIUS LENGTH 0 POSE
//   sphere LINK RADIUS 0 0 POSE
//   mesh LINK CORNERS FACES X Y Z .. A B C ..
//   map POSE FILE                      the octomap's pose in the robot's frame
//   test_map LINK, test LINK LINK      what is tested at each sample
//   sample POSE ..                     the links' poses in the robot's frame, in their order
// Writes "SAMPLE LINK" or "SAMPLE LINK LINK" for each collision, then "end"; or "error TEXT".
#include <fcl/narrowphase/collision.h>
#include <octomap/octomap.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "platform/tools/robot/limit_memory.hpp"

namespace glint::collision {
namespace {

using Shape = std::shared_ptr<fcl::CollisionGeometryd>;

struct Part {
  Shape shape;
  fcl::Transform3d T_link_shape;
};

fcl::Transform3d read_pose(std::istream& in) {
  double x = 0, y = 0, z = 0, qw = 1, qx = 0, qy = 0, qz = 0;
  in >> x >> y >> z >> qw >> qx >> qy >> qz;
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation() = fcl::Vector3d(x, y, z);
  pose.linear() = fcl::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix();
  return pose;
}

class Checker {
 public:
  void read(const std::string& line) {
    std::istringstream in(line);
    std::string word;
    int link = 0;
    in >> word;
    if (word == "sample") return test(in);
    if (word == "map") return read_map(in);
    in >> link;
    if (word == "link") {
      links_.push_back(link);
    } else if (word == "test_map") {
      with_map_.push_back(link);
    } else if (word == "test") {
      int other = 0;
      in >> other;
      with_links_.emplace_back(link, other);
    } else if (word == "mesh") {
      parts_[link].push_back({read_mesh(in), fcl::Transform3d::Identity()});
    } else {
      parts_[link].push_back(read_solid(word, in));
    }
    if (!in) throw std::runtime_error("damaged request: " + word);
  }

 private:
  static Part read_solid(const std::string& word, std::istream& in) {
    double a = 0, b = 0, c = 0;
    in >> a >> b >> c;
    const fcl::Transform3d pose = read_pose(in);
    if (word == "box") return {std::make_shared<fcl::Boxd>(a, b, c), pose};
    if (word == "cylinder") return {std::make_shared<fcl::Cylinderd>(a, b), pose};
    if (word == "sphere") return {std::make_shared<fcl::Sphered>(a), pose};
    throw std::runtime_error("damaged request: " + word);
  }

  static Shape read_mesh(std::istream& in) {
    std::size_t corners = 0, faces = 0;
    in >> corners >> faces;
    std::vector<fcl::Vector3d> points(in ? corners : 0);
    for (fcl::Vector3d& p : points) in >> p[0] >> p[1] >> p[2];
    std::vector<fcl::Triangle> triangles;
    for (std::size_t i = 0; in && i < faces; ++i) {
      std::size_t a = 0, b = 0, c = 0;
      in >> a >> b >> c;
      triangles.emplace_back(a, b, c);
    }
    auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    mesh->beginModel();
    mesh->addSubModel(points, triangles);
    mesh->endModel();
    return mesh;
  }

  void read_map(std::istream& in) {
    T_robot_map_ = read_pose(in);
    std::string file;
    in.ignore(1);
    std::getline(in, file);
    const auto tree = std::make_shared<octomap::OcTree>(0.1);
    std::ifstream bytes(file, std::ios::binary);
    if (!bytes) throw std::runtime_error("cannot be opened; expected an octomap (.bt)");
    if (!tree->readBinary(bytes) || tree->getRoot() == nullptr)
      throw std::runtime_error("not a binary octomap; expected a .bt file with voxels");
    map_ = std::make_shared<fcl::OcTreed>(tree);
  }

  static bool collide(const fcl::CollisionGeometryd& a, const fcl::Transform3d& T_a,
                      const fcl::CollisionGeometryd& b, const fcl::Transform3d& T_b) {
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    return fcl::collide(&a, T_a, &b, T_b, request, result) > 0;
  }

  bool touches_map(int link) {
    for (const Part& part : parts_[link]) {
      if (collide(*map_, T_robot_map_, *part.shape, pose_[link] * part.T_link_shape)) return true;
    }
    return false;
  }

  bool touch(int a, int b) {
    for (const Part& one : parts_[a]) {
      for (const Part& other : parts_[b]) {
        if (collide(*one.shape, pose_[a] * one.T_link_shape, *other.shape,
                    pose_[b] * other.T_link_shape))
          return true;
      }
    }
    return false;
  }

  void test(std::istream& in) {
    for (const int link : links_) pose_[link] = read_pose(in);
    if (!in) throw std::runtime_error("damaged request: sample");
    for (const int link : with_map_)
      if (touches_map(link)) std::printf("%ld %d\n", sample_, link);
    for (const auto& [a, b] : with_links_)
      if (touch(a, b)) std::printf("%ld %d %d\n", sample_, a, b);
    ++sample_;
  }

  std::vector<int> links_, with_map_;
  std::vector<std::pair<int, int>> with_links_;
  std::map<int, std::vector<Part>> parts_;
  std::map<int, fcl::Transform3d> pose_;
  fcl::Transform3d T_robot_map_ = fcl::Transform3d::Identity();
  std::shared_ptr<fcl::OcTreed> map_;
  long sample_ = 0;
};

}  // namespace
}  // namespace glint::collision

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  glint::limit_memory(std::strtoull(argv[2], nullptr, 10) << 20);
  try {
    glint::collision::Checker checker;
    std::ifstream request(argv[1]);
    for (std::string line; std::getline(request, line);) checker.read(line);
    std::printf("end\n");
  } catch (const std::exception& error) {
    std::printf("error %s", error.what());
  }
  return std::fflush(stdout) == 0 ? 0 : 1;
}
