// Incremental map of the scene: extends it by one slice of bounded work per activation.
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

// Depth image for the background group. Its spans and pointers are borrowed: they must remain valid
// until the group's progress reports `free`.
struct ShownDepth {
  // A downsampled copy of the same image for robot registration, at most k_scene_pixels_max pixels.
  struct Scene {
    Pinhole camera;
    std::span<const float> depth_m;  // along the optical axis; empty: no robot registration
  };

  // Poses of the robot's links. A new number means new poses. If `poses` is null, only the poses of
  // the last number are used.
  struct Links {
    const LinkPoses* poses = nullptr;
    std::uint64_t number = 0;
  };

  MapImage image;
  Scene scene;
  Links links;
  Time time;
  std::uint64_t number = 0;  // a new number means a new image; 0: none
};

struct MapProgress {
  bool free = true;  // nothing is borrowed; another image may be passed
  int steps = 0;     // of this slice
  MapTotals totals;
};

struct ExtendMap {
  MapSettings settings;
  int images_per_map = 10;
  std::span<std::byte> memory;  // of MapSlices::bytes(settings) bytes; empty: no map is made
  Limits limits;

  [[nodiscard]] Reason prepare() noexcept {
    if (memory.empty()) return Reason::none;
    Arena arena(memory);
    return map_.prepare(settings, images_per_map, arena);
  }
  void operator()(const ShownDepth& input, MapProgress& progress) noexcept {
    if (input.number != last_number_ && map_.look(input.image)) last_number_ = input.number;
    steps_ = map_.step(limits.background_steps);
    progress = {map_.idle(), steps_, map_.totals()};
  }

  // Call between activations. Starts a map of all voxels if images were added since the last map.
  void start_map() noexcept { map_.start_map(); }
  [[nodiscard]] const MapSlices& map() const noexcept { return map_; }

  // One step is about one point-to-point distance: kernels/slice_size.hpp.
  static constexpr std::array<std::string_view, 2> k_loops = {"call", "steps"};
  [[nodiscard]] static constexpr graph::LoopCounts worst(const Limits& limits) noexcept {
    return {{1, limits.background_steps + k_map_item_steps_max}};
  }
  [[nodiscard]] graph::LoopCounts counts() const noexcept { return {{1, steps_}}; }

 private:
  MapSlices map_;
  std::uint64_t last_number_ = 0;
  int steps_ = 0;
};
static_assert(graph::Budgeted<ExtendMap, Limits>);

}  // namespace glint
