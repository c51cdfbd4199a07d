// Measurement inputs of BackProject: a frame with depth, its blobs, and the lens.
#include <algorithm>
#include <cmath>

#include "nodes/image_nodes.hpp"
#include "platform/budget/inputs/image_inputs.hpp"
#include "platform/formats/camera.hpp"

namespace glint {
namespace {

// Area of a blob with a saturated centre. With it the inner square has 8 x 8 pixels. The annulus
// samples every second pixel in both directions, also 8 x 8, of which 24 are in the annulus.
constexpr std::uint32_t k_blind_area_px = 143;

// Distorted lens for which the ray search needs `steps` at a pixel far from the principal point.
CameraModel wide_lens(const Vector2& pixel, int steps) {
  CameraModel camera;
  camera.lens = Lens::rational;
  camera.width = k_width_max;
  camera.height = k_height_max;
  camera.fx = camera.fy = 250;
  camera.cy = pixel.y();
  camera.distortion = {0, 0, 0, 0, 0, 0.002, 0, 0};
  for (int i = 0; i < 3000; ++i) {
    camera.cx = pixel.x() - i;
    int taken = 0;
    if (unproject_with_jacobian(camera, pixel, steps, taken) && taken == steps) break;
  }
  return camera;
}

class MeasuredBackProject final : public MeasuredKernel {
 public:
  [[nodiscard]] std::string_view name() const override { return "BackProject"; }
  [[nodiscard]] std::span<const std::string_view> loops() const override {
    return BackProject::k_loops;
  }
  [[nodiscard]] graph::LoopCounts worst(const Limits& limits) const override {
    return BackProject::worst(limits);
  }
  void set_input(InputKind kind, std::uint64_t number, const Limits& limits) override {
    CounterRandom random(3, kind, number);
    node_->limits = limits;
    const Camera camera = number % 4 == 3 ? hololens1_short_throw() : hololens2_ahat();
    node_->camera = camera.model;
    node_->depth = camera.depth;
    if (limits.reflectivity_bytes == 1) node_->depth.saturated_from = 255;
    node_->nominal = {};
    drawn_.clear(limits);
    switch (kind) {
      case InputKind::typical:
        drawn_.scene(random);
        find_blobs_in_frame();
        break;
      case InputKind::recorded:
        drawn_.recorded(random);
        find_blobs_in_frame();
        break;
      case InputKind::worst:
        draw_saturated(worst_saturated(number, limits));
        break;
      case InputKind::searched:
        search(random, limits);
        break;
    }
    frame_ = drawn_.view();
    (void)node_->prepare();
  }
  void run() noexcept override { (*node_)(frame_, *blobs_, *markers_); }
  [[nodiscard]] graph::LoopCounts counts() const override { return node_->counts(); }

 private:
  // Identical blobs whose centres are saturated out to saturated_px.
  struct SaturatedBlobs {
    int blobs = 1;
    std::uint32_t area_px = k_blind_area_px;
    double saturated_px = 3.7;
    int lens_steps = k_ray_steps_max;
    DepthKind kind = DepthKind::z;
    double nominal_radius_m = 0.05;
    double off_px = 0;  // offset of the centre from a corner of four pixels
  };

  // Variant 0 drives every loop to its maximum.
  static SaturatedBlobs worst_saturated(std::uint64_t variant, const Limits& limits) {
    SaturatedBlobs saturated;
    saturated.blobs = limits.blobs;
    saturated.lens_steps = limits.ray_steps;
    switch (variant % 6) {
      case 1:
        saturated.saturated_px = 0;
        break;
      case 2:
        saturated.area_px = 1200;
        break;
      case 3:
        saturated.kind = DepthKind::radial;
        break;
      case 4:
        saturated.blobs = std::max(limits.blobs * limits.range_samples_per_blob / 64, 1);
        break;
      case 5:
        saturated.off_px = 0.5;
        break;
      default:
        break;
    }
    return saturated;
  }

  void draw_saturated(const SaturatedBlobs& input) {
    drawn_.clear(node_->limits);
    const Vector2 middle{drawn_.width() / 2 + input.off_px, drawn_.height() / 2 + input.off_px};
    drawn_.disc(middle.x(), middle.y(), 45, k_drawn_bright);
    drawn_.depth_disc(middle.x(), middle.y(), 45, 200);
    if (input.saturated_px > 0) drawn_.disc(middle.x(), middle.y(), input.saturated_px, 0xFFFF);
    node_->camera = wide_lens(middle, input.lens_steps);
    node_->depth.kind = input.kind;
    node_->depth.saturated_from = node_->limits.reflectivity_bytes == 1 ? 255 : 0xFFFF;
    node_->depth.wrap_range_m = 1;
    node_->nominal.radius_m = input.nominal_radius_m;
    Blob blob;
    blob.centroid_px = middle;
    blob.area_px = input.area_px;
    blob.peak = k_drawn_bright;
    blobs_->count = input.blobs;
    std::fill_n(blobs_->items.begin(), input.blobs, blob);
  }

  void find_blobs_in_frame() {
    frame_ = drawn_.view();
    const std::uint16_t threshold = drawn_threshold(node_->limits);
    threshold_runs(frame_, whole_frame(frame_), threshold, {0, 1}, *runs_);
    const Runs* const bands[] = {runs_.get()};
    find_blobs(frame_, bands, {2, 600, threshold, node_->depth.saturated_from}, {}, *scratch_,
               *blobs_, node_->limits);
  }

  void search(CounterRandom& random, const Limits& limits) {
    const auto change = [&](SaturatedBlobs input) {
      switch (random.below(6)) {
        case 0:
          input.blobs = random.between(1, limits.blobs);
          break;
        case 1:
          input.area_px = static_cast<std::uint32_t>(random.between(20, 1500));
          break;
        case 2:
          input.saturated_px = random.below(9);
          break;
        case 3:
          input.lens_steps = random.between(3, limits.ray_steps);
          break;
        case 4:
          input.nominal_radius_m = 0.002 * random.between(1, 50);
          break;
        default:
          input.off_px = random.uniform();
          break;
      }
      return input;
    };
    SaturatedBlobs first;
    first.lens_steps = limits.ray_steps;
    for (int i = 0; i < 6; ++i) first = change(first);
    draw_saturated(climb(first, change, [&](const SaturatedBlobs& input) {
      draw_saturated(input);
      frame_ = drawn_.view();
      (void)node_->prepare();
      run();
      const graph::LoopCounts n = counts();
      return 200 * n[1] + 60 * n[2] + 10 * n[3] + 120 * n[4] + 90 * n[5];
    }));
  }

  std::unique_ptr<BackProject> node_ = std::make_unique<BackProject>();
  std::unique_ptr<Runs> runs_ = std::make_unique<Runs>();
  std::unique_ptr<BlobScratch> scratch_ = std::make_unique<BlobScratch>();
  std::unique_ptr<Blobs> blobs_ = std::make_unique<Blobs>();
  std::unique_ptr<Markers> markers_ = std::make_unique<Markers>();
  DrawnFrame drawn_;
  Frame frame_;
};

}  // namespace

std::unique_ptr<MeasuredKernel> measured_back_project() {
  return std::make_unique<MeasuredBackProject>();
}

}  // namespace glint
