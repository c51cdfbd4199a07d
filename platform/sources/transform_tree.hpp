// Transform tree of coordinate frames over time, as tf.
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

inline constexpr std::size_t k_transforms_max = 4'000'000;  // stored, 300 MB
// Limits of TransformHistory::newest: transforms per link (half a second at 1 kHz), and links.
inline constexpr std::size_t k_live_transforms = 1024, k_live_links = 256;
inline constexpr Duration k_transform_gap_max = milliseconds(500);  // interpolated over

enum class TransformHistory : std::uint8_t { full, newest };

class TransformTree {
 public:
  explicit TransformTree(TransformHistory history = TransformHistory::full) : history_(history) {}

  // Adds T_parent_child; times may be in any order. A frame keeps its first parent. Counts and
  // skips a transform that is not rigid or has another parent. With a full history throws
  // InputError beyond k_transforms_max. With the newest history, heap is allocated only by a link's
  // first transform and by one out of order; a link restarts if its clock is set back by more than
  // k_transform_gap_max.
  void add(std::string_view parent, std::string_view child, Time time, const Pose& pose,
           bool fixed);

  // Returns the root of this frame's tree; the frame itself if it has no parent.
  [[nodiscard]] std::string root_of(std::string_view frame) const;
  [[nodiscard]] bool has(std::string_view frame) const;
  // Returns T_to_from at this time, interpolated; empty without a chain or without transforms near
  // enough in time.
  [[nodiscard]] std::optional<Pose> at(std::string_view to, std::string_view from, Time time) const;
  // Latest time at which at() has all transforms of the chain; empty without a chain.
  [[nodiscard]] std::optional<Time> available_until(std::string_view to,
                                                    std::string_view from) const;
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
  // Chains from `frame` to its root: T_root_frame; empty if a link has no pose at this time.
  [[nodiscard]] std::optional<Pose> in_root(std::string_view frame, Time time) const;

  TransformHistory history_;
  std::map<std::string, Link, std::less<>> links_;  // by child
  std::size_t stored_ = 0, refused_ = 0;
};

}  // namespace glint
