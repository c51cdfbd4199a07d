// Frames and the transforms between them over time, as tf has them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/geometry.hpp"
#include "kernels/units.hpp"

namespace glint {

inline constexpr std::size_t k_transforms_max = 4'000'000;  // kept, 300 MB
// Of a tree that has no end: the newest of each link, half a second at 1 kHz, and so many links.
inline constexpr std::size_t k_live_transforms = 1024, k_live_links = 256;
inline constexpr Duration k_transform_gap_max = milliseconds(500);  // interpolated over

enum class TransformHistory : std::uint8_t { whole, newest };

class TransformTree {
 public:
  explicit TransformTree(TransformHistory history = TransformHistory::whole) : history_(history) {}

  // T_parent_child, in any order of their times. A frame keeps its first parent. What is no rigid
  // transform is counted and left out. Of a whole history throws InputError beyond
  // k_transforms_max; of the newest only a link's first transform, and one out of order, take heap,
  // and a link begins anew where its clock was set back by more than k_transform_gap_max.
  void add(std::string_view parent, std::string_view child, Time time, const Pose& pose,
           bool fixed);

  // The frame that stands above all others of this one; itself where it has no parent.
  [[nodiscard]] std::string root_of(std::string_view frame) const;
  [[nodiscard]] bool has(std::string_view frame) const;
  // T_to_from at this time, interpolated; nothing: no chain, or nothing near enough in time.
  [[nodiscard]] std::optional<Pose> at(std::string_view to, std::string_view from, Time time) const;
  // Up to when at() has all of their transforms; nothing: no chain.
  [[nodiscard]] std::optional<Time> known_until(std::string_view to, std::string_view from) const;
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
  static void sort(const Link& link);
  [[nodiscard]] static std::optional<Pose> pose_of(const Link& link, Time time);
  [[nodiscard]] std::string_view root(std::string_view frame) const;
  // From `frame` up: T_root_frame; nothing where a link has no pose then.
  [[nodiscard]] std::optional<Pose> in_root(std::string_view frame, Time time) const;

  TransformHistory history_;
  std::map<std::string, Link, std::less<>> links_;  // by child
  std::size_t kept_ = 0, refused_ = 0;
};

}  // namespace glint
