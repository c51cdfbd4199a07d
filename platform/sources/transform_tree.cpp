#include "platform/sources/transform_tree.hpp"

#include <algorithm>
#include <cmath>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_depth_max = 64;  // links from a frame to its root: a loop ends here

bool is_rigid(const Pose& pose) {
  return std::abs(pose.rotation.squaredNorm() - 1) < 1e-2 && pose.translation.allFinite();
}

}  // namespace

void TransformTree::add(const std::string& parent, const std::string& child, Time time,
                        const Pose& pose, bool fixed) {
  if (!is_rigid(pose) || parent == child) {
    ++refused_;
    return;
  }
  Link& link = links_[child];
  if (link.parent.empty()) {
    link.parent = parent;
    link.fixed = fixed;
  }
  if (link.parent != parent) {
    ++refused_;
    return;
  }
  if (++kept_ > k_transforms_max) {
    throw InputError("more than " + std::to_string(k_transforms_max) +
                     " transforms; expected a shorter recording");
  }
  if (!link.poses.empty() && time < link.poses.back().time) link.sorted = false;
  link.poses.push_back({time, {pose.rotation.normalized(), pose.translation}});
}

bool TransformTree::has(const std::string& frame) const {
  return links_.contains(frame) || std::any_of(links_.begin(), links_.end(), [&](const auto& link) {
           return link.second.parent == frame;
         });
}

std::string TransformTree::root_of(const std::string& frame) const {
  std::string root = frame;
  for (int i = 0; i < k_depth_max; ++i) {
    const auto link = links_.find(root);
    if (link == links_.end()) break;
    root = link->second.parent;
  }
  return root;
}

std::optional<Pose> TransformTree::pose_of(const Link& link, Time time) {
  const auto earlier = [](const Stamped& a, const Stamped& b) { return a.time < b.time; };
  if (!link.sorted) {
    std::stable_sort(link.poses.begin(), link.poses.end(), earlier);
    link.sorted = true;
  }
  if (link.fixed) return link.poses.back().pose;
  const auto after =
      std::lower_bound(link.poses.begin(), link.poses.end(), Stamped{time, {}}, earlier);
  if (after == link.poses.end()) return std::nullopt;
  if (after->time == time) return after->pose;
  if (after == link.poses.begin()) return std::nullopt;
  const auto before = after - 1;
  const Duration gap = after->time - before->time;
  if (gap > k_transform_gap_max) return std::nullopt;
  // Between neighbours the normalised mean is the geodesic to a third-order term of their angle,
  // and takes no function whose last bit differs between machines.
  const double part = (time - before->time).seconds() / gap.seconds();
  Pose pose;
  pose.translation =
      before->pose.translation + part * (after->pose.translation - before->pose.translation);
  const Eigen::Vector4d a = before->pose.rotation.coeffs();
  const Eigen::Vector4d b = after->pose.rotation.coeffs() *
                            (before->pose.rotation.dot(after->pose.rotation) < 0 ? -1.0 : 1.0);
  pose.rotation.coeffs() = a + part * (b - a);
  pose.rotation.normalize();
  return pose;
}

std::optional<Pose> TransformTree::in_root(const std::string& frame, Time time) const {
  Pose pose;
  std::string at = frame;
  for (int i = 0; i < k_depth_max; ++i) {
    const auto link = links_.find(at);
    if (link == links_.end()) return pose;
    const std::optional<Pose> up = pose_of(link->second, time);
    if (!up) return std::nullopt;
    pose = *up * pose;
    at = link->second.parent;
  }
  return std::nullopt;
}

std::optional<Pose> TransformTree::at(const std::string& to, const std::string& from,
                                      Time time) const {
  if (root_of(to) != root_of(from)) return std::nullopt;
  // A link above `to` cancels: where it has no pose at this time, its absence must not matter.
  std::string meets = from;
  Pose T_meets_from;
  for (int i = 0; i < k_depth_max && meets != to; ++i) {
    const auto link = links_.find(meets);
    if (link == links_.end()) break;
    const std::optional<Pose> up = pose_of(link->second, time);
    if (!up) return std::nullopt;
    T_meets_from = *up * T_meets_from;
    meets = link->second.parent;
  }
  if (meets == to) return T_meets_from;
  const std::optional<Pose> T_root_to = in_root(to, time);
  if (!T_root_to) return std::nullopt;
  return T_root_to->inverse() * T_meets_from;
}

}  // namespace glint
