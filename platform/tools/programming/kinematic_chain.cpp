#include "platform/tools/programming/kinematic_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "platform/input_error.hpp"
#include "platform/tools/robot/urdf_file.hpp"

namespace glint {
namespace {

KDL::Vector kdl_vector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

// Joints from the root to the link.
std::vector<urdf::JointConstSharedPtr> joints_to(const urdf::ModelInterface& model,
                                                 const std::string& urdf, const std::string& tip) {
  urdf::LinkConstSharedPtr link = model.getLink(tip);
  if (!link) {
    throw InputError(urdf + ": no link '" + tip + "'; expected the link at the pen's tip");
  }
  std::vector<urdf::JointConstSharedPtr> joints;
  for (; link->parent_joint; link = link->getParent()) joints.push_back(link->parent_joint);
  std::reverse(joints.begin(), joints.end());
  return joints;
}

class ChainBuilder {
 public:
  ChainBuilder(const std::string& urdf, KinematicChain& out) : urdf_(urdf), out_(out) {}

  void add(const urdf::Joint& joint) {
    const urdf::Pose& origin = joint.parent_to_joint_origin_transform;
    const urdf::Rotation& r = origin.rotation;
    const KDL::Frame frame(KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
                           kdl_vector(origin.position));
    out_.reach_m += frame.p.Norm();
    out_.chain.addSegment(KDL::Segment(joint.child_link_name, kdl_joint(joint, frame), frame));
  }

 private:
  // KDL's joint has its axis in the frame of the parent link.
  KDL::Joint kdl_joint(const urdf::Joint& joint, const KDL::Frame& frame) {
    if (joint.type == urdf::Joint::FIXED) return KDL::Joint(joint.name, KDL::Joint::Fixed);
    const bool revolute =
        joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS;
    if ((!revolute && joint.type != urdf::Joint::PRISMATIC) || joint.mimic) {
      throw InputError(urdf_ + ": joint '" + joint.name +
                       "' mimics another, is planar or floating; expected an independent "
                       "revolute, continuous or prismatic joint");
    }
    const KDL::Vector axis = frame.M * kdl_vector(joint.axis);
    if (!(axis.Norm() > 1e-6)) {
      throw InputError(urdf_ + ": joint '" + joint.name + "': its axis is zero");
    }
    add_limits(joint, revolute);
    return KDL::Joint(joint.name, frame.p, axis,
                      revolute ? KDL::Joint::RotAxis : KDL::Joint::TransAxis);
  }

  void add_limits(const urdf::Joint& joint, bool revolute) {
    constexpr double k_infinity = std::numeric_limits<double>::infinity();
    const bool continuous = joint.type == urdf::Joint::CONTINUOUS;
    const double lower = continuous ? -k_infinity : joint.limits ? joint.limits->lower : 0;
    const double upper = continuous ? k_infinity : joint.limits ? joint.limits->upper : 0;
    if (!(lower < upper)) {
      throw InputError(urdf_ + ": joint '" + joint.name + "': limits " + std::to_string(lower) +
                       " and " + std::to_string(upper) + "; expected lower < upper");
    }
    out_.joints.push_back(joint.name);
    out_.lower.push_back(lower);
    out_.upper.push_back(upper);
    out_.revolute.push_back(revolute);
    if (!revolute) out_.reach_m += std::max(std::abs(lower), std::abs(upper));
  }

  const std::string& urdf_;
  KinematicChain& out_;
};

}  // namespace

KinematicChain read_chain(const std::string& urdf, const std::string& tip) {
  const UrdfFile file = read_urdf(urdf);
  KinematicChain out;
  out.robot = file.model->getName();
  out.tip = tip;
  ChainBuilder builder(urdf, out);
  for (const auto& joint : joints_to(*file.model, urdf, tip)) builder.add(*joint);
  if (out.joints.empty()) {
    throw InputError(urdf + ": no joint moves link '" + tip + "'; expected one or more");
  }
  return out;
}

}  // namespace glint
