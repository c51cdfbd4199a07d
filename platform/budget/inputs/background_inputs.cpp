// Measurement inputs of ExtendMap at each stage. Scenes: a room, a clump, sparse points, and a
// shell of points just too far from each other.
#include <array>
#include <map>
#include <vector>

#include "kernels/elementary.hpp"
#include "nodes/mapper.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/numbers.hpp"

namespace glint {
namespace {

constexpr int k_side = 48, k_pictures = 2, k_voxels = 4096;
constexpr int k_scenes = 4, k_stages = 7;

// Expensive starts of a slice: at the beginning of a stage, or after a number of steps, when the
// points are sorted. The outlier filter leaves no points of the layers (scene 3).
using Stage = MapSlices::Stage;
struct SliceStart {
  int scene;
  Stage stage;
  int steps_after;
  auto operator<=>(const SliceStart&) const = default;
};
constexpr int k_sorted = (k_key_steps + 4 * k_sort_steps) * k_voxels + 5 * k_sort_pass_steps;
constexpr std::array<SliceStart, 20> k_worst{{{1, Stage::smoothing, k_sorted},
                                              {0, Stage::smoothing, k_sorted},
                                              {0, Stage::smoothing, 0},
                                              {0, Stage::points, 0},
                                              {1, Stage::points, 0},
                                              {2, Stage::points, 0},
                                              {3, Stage::points, 0},
                                              {0, Stage::voxels, 0},
                                              {0, Stage::outliers, 0},
                                              {0, Stage::outliers, k_sorted},
                                              {1, Stage::outliers, k_sorted},
                                              {2, Stage::outliers, k_sorted},
                                              {3, Stage::outliers, k_sorted},
                                              {0, Stage::planes, 0},
                                              {1, Stage::planes, 0},
                                              {0, Stage::planes, 50'000},
                                              {0, Stage::support, k_sorted},
                                              {1, Stage::support, k_sorted},
                                              {0, Stage::snap, 0},
                                              {1, Stage::snap, 0}}};

MapSettings measured_settings() {
  MapSettings settings;
  settings.voxels_max = k_voxels;
  settings.planes.points_min = 100;
  return limited_for_slices(settings);
}

// Depth image of each scene. The clump's voxels are so small that each cell is full of points.
struct MeasuredScene {
  std::vector<float> depth;
  std::vector<ExclusionCapsule> left_out;
  MapSettings settings = measured_settings();
  CameraModel camera;

  explicit MeasuredScene(int kind) {
    camera.width = camera.height = k_side;
    camera.fx = camera.fy = 40, camera.cx = camera.cy = 0.5 * k_side;
    inputs::Numbers numbers(InputKind::worst, static_cast<std::uint64_t>(kind));
    for (int i = 0; i < k_side * k_side; ++i) {
      const double x = (i % k_side + 0.5 - camera.cx) / camera.fx;
      const double y = (i / k_side + 0.5 - camera.cy) / camera.fy;
      double z = y > 0 ? std::min(1.4, 0.3 / y) : 1.4;                  // floor and wall
      if (kind == 1) z = 0.12;                                          // a clump
      if (kind == 2) z = numbers.within(0.2, 3.9);                      // far apart
      if (kind == 3) z = (0.1 + 0.05 * (i % 2)) / (1 + x * x + y * y);  // layers
      depth.push_back(static_cast<float>(z + 0.002 * numbers.normal()));
    }
    if (kind == 1 || kind == 3) settings.voxels.voxel_m = 0.002f;
    if (kind == 3) settings.outliers.neighbours_min = k_map_candidates_max;
    if (kind == 2)
      left_out.assign(k_exclusion_capsules_max, {Vector3(9, 9, 9), Vector3(9, 8, 9), 0.1});
    if (kind == 2) {
      camera.lens = Lens::brown;  // its rays need a search
      camera.distortion = {-0.28, 0.07, 1e-3, -1e-3, 0.0};
    }
  }
};

class MapKernel final : public inputs::NodeKernel<ExtendMap> {
 public:
  MapKernel() : NodeKernel("ExtendMap") {}
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    inputs::Numbers numbers(kind, number);
    // Worst input 0 smooths a clump: every candidate is a neighbour.
    const bool worst = is_worst_case(kind);
    const SliceStart drawn{numbers.below(k_scenes), static_cast<Stage>(1 + numbers.below(k_stages)),
                           numbers.one_in(2) ? k_sorted : 0};
    prepared_ = &prepared(worst ? k_worst[number % k_worst.size()] : drawn);
    start_ = prepared_->node;
    start_.limits = limits;
    if (!worst) start_.limits.background_steps = 1 + numbers.below(limits.background_steps);
    rewind();
  }
  void rewind() override {
    std::copy(prepared_->memory.begin(), prepared_->memory.end(), prepared_->node.memory.begin());
    NodeKernel::rewind();
  }
  void run() noexcept override { node_(prepared_->shown, progress_); }

 private:
  // A node and its memory at the beginning of a stage.
  struct PreparedNode {
    ExtendMap node;
    ShownDepth shown;
    std::vector<std::byte> memory;
  };

  const PreparedNode& prepared(SliceStart wanted) {
    const auto [scene, stage, steps_after] = wanted;
    PreparedNode& out = prepared_at_[wanted];
    if (out.shown.number > 0) return out;
    const MeasuredScene& of = scenes_.try_emplace(scene, scene).first->second;
    std::vector<std::byte>& memory = memory_[scene];
    memory.assign(MapSlices::bytes(of.settings), std::byte{});
    out.node.settings = of.settings;
    out.node.images_per_map = k_pictures;
    out.node.memory = memory;
    (void)out.node.prepare();
    out.node.limits.background_steps = 1;
    for (int p = 1; p <= k_pictures; ++p) {
      const Pose moved{Quaternion::Identity(), Vector3(0.05 * p, 0, 0)};
      out.shown = {{{k_side, k_side, of.depth}, of.camera, moved, of.left_out},
                   {},
                   {},
                   Time{},
                   static_cast<std::uint64_t>(p)};
      out.node(out.shown, progress_);
      while (!out.node.map().idle() && out.node.map().stage() < stage) {
        out.node(out.shown, progress_);
      }
      if (out.node.map().stage() == stage) break;
    }
    out.node.limits.background_steps = 1000;
    for (int gone = 0; gone < steps_after && out.node.map().stage() == stage;
         gone += static_cast<int>(out.node.counts()[1])) {
      out.node(out.shown, progress_);
    }
    out.memory = memory;
    return out;
  }

  std::map<int, MeasuredScene> scenes_;
  std::map<int, std::vector<std::byte>> memory_;  // shared by a scene's nodes, one at a time
  std::map<SliceStart, PreparedNode> prepared_at_;
  const PreparedNode* prepared_ = nullptr;
  MapProgress progress_;
};

}  // namespace

void add_background_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels) {
  kernels.push_back(std::make_unique<MapKernel>());
}

}  // namespace glint
