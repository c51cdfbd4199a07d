// Measurement inputs of FollowRobot: a slice at the beginning of an image or a number of steps
// after it. In half of the images the links have moved: the points are transformed first, each with
// another link than the one before.
#include <algorithm>
#include <vector>

#include "nodes/follow_robot.hpp"
#include "platform/budget/inputs/node_kernel.hpp"
#include "platform/budget/inputs/numbers.hpp"

namespace glint {
namespace {

constexpr int k_view_side = 40, k_views = 5, k_slice_steps = 20'000;
constexpr int k_slices_max = 48;  // slices of the longest image of the small model
// The last view has more points than one slice transforms.
constexpr int k_small_side = 24, k_large_side = 48;
static_assert(k_large_side * k_large_side * k_posed_item_steps_max > k_background_steps_max);

// A curved surface with an edge, and its depth image in front of a wall.
struct SurfaceScene {
  std::vector<Vector3f> points, normals;
  std::vector<std::uint16_t> links;  // alternating
  float spacing_m;
  std::vector<float> depth;
  Pose T_camera_surface;

  explicit SurfaceScene(int kind) {
    inputs::Numbers numbers(InputKind::worst, static_cast<std::uint64_t>(kind) + 100);
    // The last two are so near that they fill the image.
    T_camera_surface.translation = Vector3(0, 0, kind >= k_views - 2 ? 0.25 : 0.6 + 0.1 * kind);
    const int side = kind == k_views - 1 ? k_large_side : k_small_side;
    const double spacing = 0.24 / side;
    spacing_m = static_cast<float>(spacing);
    for (int i = 0; i < side * side; ++i) {
      const double x = spacing * (i % side - side / 2);
      const double y = spacing * (i / side - side / 2);
      links.push_back(static_cast<std::uint16_t>(i % 2));
      points.push_back(Vector3(x, y, 2 * x * x - 3 * x * y).cast<float>());
      normals.push_back(Vector3(-4 * x + 3 * y, 3 * x, 1).normalized().cast<float>());
    }
    for (int i = 0; i < k_view_side * k_view_side; ++i) {
      const double x = (i % k_view_side + 0.5) / k_view_side - 0.5;
      const double y = (i / k_view_side + 0.5) / k_view_side - 0.5;
      const double z = T_camera_surface.translation.z();
      const bool on = std::abs(x * z) < 0.12 && std::abs(y * z) < 0.12;
      const double at = on ? z + (2 * x * x - 3 * x * y) * z * z : 1.9;
      depth.push_back(static_cast<float>(at + 0.003 * numbers.normal()));
    }
  }
};

class RobotKernel final : public inputs::NodeKernel<FollowRobot> {
 public:
  RobotKernel() : NodeKernel("FollowRobot") {
    for (int i = 0; i < k_views; ++i) scenes_.emplace_back(i);
    poses_.count = 2;
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    inputs::Numbers numbers(kind, number);
    const bool worst = is_worst_case(kind);
    const SurfaceScene& scene = scenes_[worst ? (number + k_views - 1) % k_views
                                              : static_cast<std::uint64_t>(numbers.below(k_views))];
    start_ = FollowRobot{};
    start_.model = {{scene.points, scene.normals, scene.spacing_m}, scene.links};
    start_.links = {&poses_, 0};
    start_.T_world_robot = scene.T_camera_surface;
    start_.T_world_robot.translation += numbers.in_box(0.006);
    start_.covariance = Matrix6::Identity() * 1e-4;
    start_.pixels_max = k_view_side * k_view_side;
    (void)start_.prepare();
    shown_.scene = {
        {k_view_side, k_view_side, k_view_side, k_view_side, 0.5 * k_view_side, 0.5 * k_view_side},
        scene.depth};
    shown_.time = Time{1'000'000'000};
    shown_.number = 1;
    const bool moved = worst ? number / k_views / k_slices_max % 2 == 0 : numbers.one_in(2);
    shown_.links = {&poses_, moved ? 1u : 0u};
    limits_ = limits;
    if (!worst && limits.tracking_steps > 0) {
      limits_.tracking_steps = 1 + numbers.below(limits.tracking_steps);
    }
    slices_before_ =
        worst ? static_cast<int>(number / k_views % k_slices_max) : numbers.below(k_slices_max);
    rewind();
  }
  // A slice in progress refers to the node's own memory, so the slices are run again.
  void rewind() override {
    NodeKernel::rewind();
    node_.limits = limits_;
    node_.limits.tracking_steps = k_slice_steps;
    for (int i = 0; i < slices_before_; ++i) node_(shown_, progress_);
    if (slices_before_ > 0 && progress_.free) NodeKernel::rewind();  // the image has fewer slices
    node_.limits = limits_;
  }
  void run() noexcept override { node_(shown_, progress_); }

 private:
  std::vector<SurfaceScene> scenes_;
  LinkPoses poses_;  // links at the base: their values do not affect the cost
  ShownDepth shown_;
  RobotProgress progress_;
  Limits limits_;
  int slices_before_ = 0;
};

}  // namespace

void add_following_kernels(std::vector<std::unique_ptr<MeasuredKernel>>& kernels) {
  kernels.push_back(std::make_unique<RobotKernel>());
}

}  // namespace glint
