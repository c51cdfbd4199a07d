// The map of the place, extended by one slice of work at each activation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "graph/loops.hpp"
#include "kernels/cloud/map_slices.hpp"
#include "kernels/limits.hpp"
#include "kernels/registration/scene_view.hpp"
#include "kernels/robot/forward_kinematics.hpp"
#include "kernels/units.hpp"

namespace glint {

// The depth picture that the background group looks at. What it borrows must stay until the
// group's progress says that it is done with it.
struct ShownDepth {
  // Pixels of the same picture, few enough to find a robot in (k_scene_pixels_max).
  struct Scene {
    Pinhole camera;
    std::span<const float> depth_m;  // along the axis; none: no robot is looked for
  };

  // Where the robot's links were: other poses have another number. Without poses a robot is looked
  // for only by those of the last number.
  struct Links {
    const LinkPoses* poses = nullptr;
    std::uint64_t number = 0;
  };

  MapPicture picture;
  Scene scene;
  Links links;
  Time time;
  std::uint64_t number = 0;  // another number is another picture; 0: there is none
};

struct MapProgress {
  bool free = true;  // nothing is borrowed, and another picture may be shown
  int steps = 0;     // of this slice
  MapTotals totals;
};

struct ExtendMap {
  MapSettings settings;
  int pictures_a_map = 10;
  std::span<std::byte> memory;  // MapSlices::bytes(settings); none: no map is made
  Limits limits;

  [[nodiscard]] Reason prepare() noexcept {
    if (memory.empty()) return Reason::none;
    Arena arena(memory);
    return map_.prepare(settings, pictures_a_map, arena);
  }
  void operator()(const ShownDepth& shown, MapProgress& progress) noexcept {
    if (shown.number != looked_at_ && map_.look(shown.picture)) looked_at_ = shown.number;
    steps_ = map_.step(limits.background_steps);
    progress = {map_.idle(), steps_, map_.totals()};
  }

  // Between activations: begins a map of all there is, if that is more than the one that is out.
  void make_map() noexcept { map_.make_map(); }
  [[nodiscard]] const MapSlices& map() const noexcept { return map_; }

  // A step is about a distance between two points: kernels/slice_size.hpp.
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.background_steps + k_map_item_steps_max}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, steps_}}; }

 private:
  MapSlices map_;
  std::uint64_t looked_at_ = 0;
  int steps_ = 0;
};
static_assert(graph::Budgeted<ExtendMap, Limits>);

}  // namespace glint
