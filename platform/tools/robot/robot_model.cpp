#include "platform/tools/robot/robot_model.hpp"

#include <array>
#include <cmath>
#include <map>

#include "kernels/robot/forward_kinematics.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/robot/mesh_file.hpp"
#include "platform/tools/robot/primitives.hpp"
#include "platform/tools/robot/urdf_file.hpp"

namespace glint {
namespace {

constexpr std::size_t k_triangles_max = 4'000'000;  // of a complete robot: 144 MB

Pose pose_of(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return {Quaternion(r.w, r.x, r.y, r.z).normalized(),
          {pose.position.x, pose.position.y, pose.position.z}};
}

// Builds the tree from the root down, in the order of the file.
class TreeBuilder {
 public:
  TreeBuilder(const UrdfFile& file, const std::string& path, RobotModel& robot)
      : file_(file), path_(path), robot_(robot) {}

  void build() {
    number_inputs();
    robot_.links.push_back(file_.model->getRoot()->name);
    link_[robot_.links[0]] = 0;
    // Each iteration adds at least one joint, since the joints form a tree.
    std::vector<std::string> left = file_.joints;
    while (!left.empty()) {
      std::vector<std::string> later;
      for (const std::string& name : left) {
        const urdf::Joint& joint = *file_.model->getJoint(name);
        if (link_.count(joint.parent_link_name) == 0)
          later.push_back(name);
        else
          add(joint);
      }
      if (later.size() == left.size()) {
        throw InputError(path_ + ": joint '" + left[0] + "' is not connected to the root link");
      }
      left = std::move(later);
    }
  }

 private:
  static bool moves(const urdf::Joint& joint) { return joint.type != urdf::Joint::FIXED; }

  void number_inputs() {
    for (const std::string& name : file_.joints) {
      const urdf::JointConstSharedPtr joint = file_.model->getJoint(name);
      if (!joint) throw InputError(path_ + ": joint '" + name + "' is a duplicate or invalid");
      if (!moves(*joint) || joint->mimic) continue;
      input_[name] = static_cast<int>(robot_.inputs.size());
      robot_.inputs.push_back(name);
    }
    robot_.tree.input_count = static_cast<int>(robot_.inputs.size());
  }

  void add(const urdf::Joint& joint) {
    TreeJoint& to = robot_.tree.joints[static_cast<std::size_t>(robot_.tree.joint_count++)];
    to.T_parent_joint = pose_of(joint.parent_to_joint_origin_transform);
    to.parent_link = link_[joint.parent_link_name];
    to.kind = kind_of(joint);
    if (!to.T_parent_joint.translation.allFinite() ||
        !to.T_parent_joint.rotation.coeffs().allFinite()) {
      throw InputError(path_ + ": joint '" + joint.name + "': its origin is not finite");
    }
    if (moves(joint)) {
      const Vector3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
      if (!(axis.norm() > 1e-6) || !axis.allFinite()) {
        throw InputError(path_ + ": joint '" + joint.name + "': its axis is zero");
      }
      to.axis = axis.normalized();
      resolve_mimic(joint, to);
    }
    link_[joint.child_link_name] = robot_.tree.joint_count;
    robot_.links.push_back(joint.child_link_name);
  }

  JointKind kind_of(const urdf::Joint& joint) const {
    switch (joint.type) {
      case urdf::Joint::FIXED:
        return JointKind::fixed;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        return JointKind::revolute;
      case urdf::Joint::PRISMATIC:
        return JointKind::prismatic;
      default:
        break;
    }
    throw InputError(path_ + ": joint '" + joint.name +
                     "' is planar or floating; expected revolute, continuous, prismatic or fixed");
  }

  // Resolves chains of mimic joints to the joint with its own value.
  void resolve_mimic(const urdf::Joint& joint, TreeJoint& to) const {
    const urdf::Joint* at = &joint;
    for (std::size_t steps = 0; at->mimic; ++steps) {
      const urdf::JointConstSharedPtr next = file_.model->getJoint(at->mimic->joint_name);
      if (!next || steps > file_.joints.size()) {
        throw InputError(path_ + ": joint '" + joint.name + "' mimics '" + at->mimic->joint_name +
                         (next ? "' in a cycle" : "', which is missing"));
      }
      if (!std::isfinite(at->mimic->multiplier) || !std::isfinite(at->mimic->offset)) {
        throw InputError(path_ + ": joint '" + at->name + "': its mimic is not finite");
      }
      to.offset += to.multiplier * at->mimic->offset;
      to.multiplier *= at->mimic->multiplier;
      at = next.get();
    }
    const auto found = input_.find(at->name);
    if (found == input_.end()) {
      throw InputError(path_ + ": joint '" + joint.name + "' mimics '" + at->name +
                       "', which is fixed");
    }
    to.input = found->second;
  }

  const UrdfFile& file_;
  const std::string& path_;
  RobotModel& robot_;
  std::map<std::string, int> link_, input_;
};

// Merges equal corners, so that a renderer transforms a sixth of them.
class Welder {
 public:
  explicit Welder(int link) { surface_.link = link; }
  [[nodiscard]] int link() const { return surface_.link; }
  void add(const Triangle& t) {
    surface_.faces.push_back({number_of(t.a), number_of(t.b), number_of(t.c)});
  }
  LinkSurface take() { return std::move(surface_); }

 private:
  std::int32_t number_of(const Vector3f& p) {
    const auto [at, fresh] = number_.emplace(std::array{p.x(), p.y(), p.z()},
                                             static_cast<std::int32_t>(surface_.corners.size()));
    if (fresh) surface_.corners.push_back(p);
    return at->second;
  }

  LinkSurface surface_;
  std::map<std::array<float, 3>, std::int32_t> number_;
};

void add_geometry(const urdf::Geometry& geometry, const urdf::Pose& origin, const RobotFiles& files,
                  Welder& surface, RobotModel& robot) {
  std::vector<Triangle> triangles;
  const Pose pose = pose_of(origin);
  const auto add_solid = [&](SolidShape shape, const Vector3& size_m) {
    robot.solids.push_back({surface.link(), shape, size_m, pose});
  };
  if (geometry.type == urdf::Geometry::MESH) {
    const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
    Mesh read =
        read_mesh(find_mesh(mesh.filename, files), {mesh.scale.x, mesh.scale.y, mesh.scale.z});
    robot.triangles_skipped += read.skipped;
    triangles = std::move(read.triangles);
  } else if (geometry.type == urdf::Geometry::BOX) {
    const urdf::Vector3& dim = static_cast<const urdf::Box&>(geometry).dim;
    triangles = box_surface({dim.x, dim.y, dim.z});
    add_solid(SolidShape::box, {dim.x, dim.y, dim.z});
  } else if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
    triangles = cylinder_surface(cylinder.radius, cylinder.length);
    add_solid(SolidShape::cylinder, {cylinder.radius, cylinder.length, 0});
  } else {
    const double radius_m = static_cast<const urdf::Sphere&>(geometry).radius;
    triangles = sphere_surface(radius_m);
    add_solid(SolidShape::sphere, {radius_m, 0, 0});
  }
  const Eigen::Matrix3f rotation = pose.rotation.toRotationMatrix().cast<float>();
  const Vector3f translation = pose.translation.cast<float>();
  for (const Triangle& t : triangles) {
    surface.add(
        {rotation * t.a + translation, rotation * t.b + translation, rotation * t.c + translation});
  }
}

template <class Array>
void add_all(const Array& items, const RobotFiles& files, Welder& surface, RobotModel& robot) {
  for (const auto& item : items) {
    if (item && item->geometry) {
      add_geometry(*item->geometry, item->origin, files, surface, robot);
    }
  }
}

void add_surface(int number, const urdf::Link& link, const RobotFiles& files, RobotModel& robot) {
  Welder surface(number);
  const bool collision = files.geometry == Geometry::collision ? !link.collision_array.empty()
                                                               : link.visual_array.empty();
  if (collision)
    add_all(link.collision_array, files, surface, robot);
  else
    add_all(link.visual_array, files, surface, robot);
  LinkSurface welded = surface.take();
  if (!welded.faces.empty()) robot.surfaces.push_back(std::move(welded));
}

}  // namespace

RobotModel load_robot(const RobotFiles& files) {
  const UrdfFile file =
      files.text.empty() ? read_urdf(files.urdf) : read_urdf_text(files.text, files.urdf);
  RobotModel robot;
  robot.name = file.model->getName();
  TreeBuilder(file, files.urdf, robot).build();
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const urdf::LinkConstSharedPtr link = file.model->getLink(robot.links[i]);
    const std::size_t before = robot.surfaces.size();
    add_surface(static_cast<int>(i), *link, files, robot);
    if (robot.surfaces.size() > before) triangles += robot.surfaces.back().faces.size();
    if (triangles > k_triangles_max) {
      throw InputError(files.urdf + ": its meshes have more than " +
                       std::to_string(k_triangles_max) + " triangles");
    }
  }
  if (robot.surfaces.empty()) {
    throw InputError(files.urdf + ": no link has a surface; expected meshes or shapes");
  }
  return robot;
}

PosedSurface posed_surface(const RobotModel& robot, std::span<const double> positions,
                           const std::string& what) {
  LinkPoses poses;
  if (forward_kinematics(robot.tree, positions, poses) != Reason::none) {
    throw InputError(what + ": " + std::to_string(positions.size()) +
                     " positions, or a non-finite one; expected " +
                     std::to_string(robot.inputs.size()) + " in radians and metres");
  }
  PosedSurface out;
  for (const LinkSurface& surface : robot.surfaces) {
    const Pose& pose = poses.T_root_link[static_cast<std::size_t>(surface.link)];
    const Eigen::Matrix3f rotation = pose.rotation.toRotationMatrix().cast<float>();
    const Vector3f translation = pose.translation.cast<float>();
    const auto first = static_cast<std::int32_t>(out.corners.size());
    for (const Vector3f& corner : surface.corners) {
      out.corners.push_back(rotation * corner + translation);
    }
    for (const Face& f : surface.faces) {
      out.faces.push_back({first + f.a, first + f.b, first + f.c});
    }
    out.face_links.resize(out.faces.size(), static_cast<std::uint16_t>(surface.link));
  }
  return out;
}

}  // namespace glint
