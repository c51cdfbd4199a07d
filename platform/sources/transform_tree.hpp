// Frames and the transforms between them over time, as tf has them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

inline constexpr std::size_t k_transforms_max = 4'000'000;          // kept, 300 MB
inline constexpr Duration k_transform_gap_max = milliseconds(500);  // interpolated over

class TransformTree {
 public:
  // T_parent_child, in any order of their times. A frame keeps its first parent. What is no rigid
  // transform is counted and left out; throws InputError beyond k_transforms_max.
  void add(const std::string& parent, const std::string& child, Time time, const Pose& pose,
           bool fixed);

  // The frame that stands above all others of this one; itself where it has no parent.
  [[nodiscard]] std::string root_of(const std::string& frame) const;
  [[nodiscard]] bool has(const std::string& frame) const;
  // T_to_from at this time, interpolated; nothing: no chain, or nothing near enough in time.
  [[nodiscard]] std::optional<Pose> at(const std::string& to, const std::string& from,
                                       Time time) const;
  [[nodiscard]] std::size_t refused() const { return refused_; }

 private:
  struct Stamped {
    Time time;
    Pose pose;
  };
  struct Link {
    std::string parent;
    bool fixed = false;
    mutable bool sorted = true;
    mutable std::vector<Stamped> poses;
  };
  [[nodiscard]] static std::optional<Pose> pose_of(const Link& link, Time time);
  // From `frame` up: T_root_frame; nothing where a link has no pose then.
  [[nodiscard]] std::optional<Pose> in_root(const std::string& frame, Time time) const;

  std::map<std::string, Link> links_;  // by child
  std::size_t kept_ = 0, refused_ = 0;
};

}  // namespace glint
