#include "platform/sources/transform_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_depth_max = 64;  // links from a frame to its root; bounds a loop

bool is_rigid(const Pose& pose) {
  return std::abs(pose.rotation.squaredNorm() - 1) < 1e-2 && pose.translation.allFinite();
}

}  // namespace

void TransformTree::add(std::string_view parent, std::string_view child, Time time,
                        const Pose& pose, bool fixed) {
  auto found = links_.find(child);
  const bool is_new = found == links_.end();
  const bool newest = history_ == TransformHistory::newest;
  if (!is_rigid(pose) || parent == child || (is_new && newest && links_.size() == k_live_links) ||
      (!is_new && found->second.parent != parent)) {
    ++refused_;
    return;
  }
  if (is_new) {
    found = links_.emplace(std::string(child), Link{}).first;
    found->second.parent = parent;
    found->second.fixed = fixed;
    if (newest && !fixed) found->second.poses.reserve(k_live_transforms);
  }
  Link& link = found->second;
  if (newest) {
    const bool was_set_back =
        !link.poses.empty() && time + k_transform_gap_max < link.poses.back().time;
    if (link.fixed || was_set_back) link.poses.clear();
    if (link.poses.size() == k_live_transforms) {
      sort(link);
      link.poses.erase(link.poses.begin(), link.poses.begin() + k_live_transforms / 2);
    }
  } else if (++stored_ > k_transforms_max) {
    throw InputError("more than " + std::to_string(k_transforms_max) +
                     " transforms; expected a shorter recording");
  }
  if (!link.poses.empty() && time < link.poses.back().time) link.sorted = false;
  link.poses.push_back({time, {pose.rotation.normalized(), pose.translation}});
}

bool TransformTree::has(std::string_view frame) const {
  return links_.contains(frame) || std::any_of(links_.begin(), links_.end(), [&](const auto& link) {
           return link.second.parent == frame;
         });
}

std::string_view TransformTree::root(std::string_view frame) const {
  for (int i = 0; i < k_depth_max; ++i) {
    const auto link = links_.find(frame);
    if (link == links_.end()) break;
    frame = link->second.parent;
  }
  return frame;
}

std::string TransformTree::root_of(std::string_view frame) const {
  return std::string(root(frame));
}

void TransformTree::sort(const Link& link) {
  if (link.sorted) return;
  std::stable_sort(link.poses.begin(), link.poses.end(),
                   [](const Stamped& a, const Stamped& b) { return a.time < b.time; });
  link.sorted = true;
}

std::optional<Pose> TransformTree::pose_of(const Link& link, Time time) {
  const auto earlier = [](const Stamped& a, const Stamped& b) { return a.time < b.time; };
  sort(link);
  if (link.fixed) return link.poses.back().pose;
  const auto after =
      std::lower_bound(link.poses.begin(), link.poses.end(), Stamped{time, {}}, earlier);
  if (after == link.poses.end()) return std::nullopt;
  if (after->time == time) return after->pose;
  if (after == link.poses.begin()) return std::nullopt;
  const auto before = after - 1;
  const Duration gap = after->time - before->time;
  if (gap > k_transform_gap_max) return std::nullopt;
  // Between neighbours the normalised linear mean equals SLERP up to a third-order term of their
  // angle. It uses no function whose last bit differs between machines.
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

std::optional<Pose> TransformTree::in_root(std::string_view frame, Time time) const {
  Pose pose;
  std::string_view at = frame;
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

std::optional<Pose> TransformTree::at(std::string_view to, std::string_view from, Time time) const {
  if (root(to) != root(from)) return std::nullopt;
  // Links above `to` cancel, so a missing pose in them has no effect.
  std::string_view meets = from;
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

std::optional<Time> TransformTree::available_until(std::string_view to,
                                                   std::string_view from) const {
  if (root(to) != root(from)) return std::nullopt;
  Time until{INT64_MAX};
  const auto climb = [&](std::string_view frame, std::string_view end) {
    for (int i = 0; i < k_depth_max && frame != end; ++i) {
      const auto link = links_.find(frame);
      if (link == links_.end()) return false;
      sort(link->second);
      if (!link->second.fixed) until = std::min(until, link->second.poses.back().time);
      frame = link->second.parent;
    }
    return frame == end;
  };
  if (!climb(from, to)) (void)climb(to, root(to));
  return until;
}

}  // namespace glint
