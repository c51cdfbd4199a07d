#include "platform/lab/experiments/painted_spots.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/elementary.hpp"
#include "kernels/pose/camera_model.hpp"

namespace glint {
namespace {

constexpr double k_gap_px = 3;  // from a marker's rim to a spot's

// The C++ standard specifies mt19937's numbers, but not the output of its distributions.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(static_cast<std::uint32_t>(seed * 2654435761u + 1)) {}
  double operator()(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_()) / 4294967296.0);
  }
  std::uint16_t whole(int low, int high) {
    return static_cast<std::uint16_t>((*this)(low, high + 1));
  }

 private:
  std::mt19937 random_;
};

struct Disc {
  Vector2 middle_px = Vector2::Zero();
  double radius_px = 0;
};

std::vector<Disc> markers_in(const Camera& camera, const ToolSet& tools,
                             const FrameGroundTruth& truth) {
  std::vector<Disc> discs;
  const Pose T_camera_world = truth.T_world_camera.inverse();
  int lens_steps = 0;
  for (int t = 0; t < tools.count; ++t) {
    const auto i = static_cast<std::size_t>(t);
    const Tool& tool = tools.items[i];
    for (int m = 0; m < tool.marker_count; ++m) {
      const Vector3 point =
          T_camera_world * truth.T_world_tool[i] * tool.markers_m[static_cast<std::size_t>(m)];
      const Result<Vector2> pixel = project(camera.model, point, lens_steps);
      if (!pixel) continue;
      discs.push_back({pixel.value, camera.model.fx * tool.marker_radius_m / point.norm()});
    }
  }
  return discs;
}

double wrapped(double value, double length) { return value - length * std::floor(value / length); }

}  // namespace

PaintedSpots::PaintedSpots(const SpotSettings& settings, const Camera& camera, std::uint64_t seed)
    : settings_(settings), camera_(camera), seed_(seed) {
  Draw draw(seed);
  const double width = camera.model.width, height = camera.model.height;
  std::vector<Vector2> clusters;
  for (int i = 0; i < settings.clusters; ++i) {
    const double x = draw(0.2 * width, 0.8 * width);
    clusters.push_back({x, draw(0.2 * height, 0.8 * height)});
  }
  for (int i = 0; i < settings.count; ++i) {
    Spot spot;
    if (clusters.empty()) {
      spot.place_px.x() = draw(0, width);
      spot.place_px.y() = draw(0, height);
    } else {
      spot.place_px = clusters[static_cast<std::size_t>(i) % clusters.size()];
      spot.place_px.x() += draw(-settings.cluster_px, settings.cluster_px);
      spot.place_px.y() += draw(-settings.cluster_px, settings.cluster_px);
    }
    const SineCosine way = sine_cosine(draw(0, 6.28));
    spot.velocity_px_s = settings.speed_px_s * Vector2(way.cosine, way.sine);
    spot.radius_px = draw(settings.radius_min_px, settings.radius_max_px);
    spot.level = draw.whole(settings.level_min, settings.level_max);
    spot.depth = draw.whole(settings.depth_min_mm, settings.depth_max_mm);
    spots_.push_back(spot);
  }
}

int PaintedSpots::paint(const ToolSet& tools, sim::SimFrame& frame) const {
  FrameBuffer& pixels = frame.pixels;
  const std::vector<Disc> markers = markers_in(camera_, tools, frame.truth);
  const double seconds = Duration{frame.truth.mid_exposure.nanoseconds}.seconds();
  Draw flicker(seed_ + 7919 * (frame.sequence + std::uint64_t{1}));
  int painted = 0;
  for (const Spot& spot : spots_) {
    if (flicker(0, 1) < settings_.flicker_share) continue;
    const double x = wrapped(spot.place_px.x() + seconds * spot.velocity_px_s.x(), pixels.width);
    const double y = wrapped(spot.place_px.y() + seconds * spot.velocity_px_s.y(), pixels.height);
    const bool single = spot.radius_px <= 0;
    const bool touches = std::any_of(markers.begin(), markers.end(), [&](const Disc& marker) {
      const double apart_px = (marker.middle_px - Vector2(x, y)).norm();
      return apart_px < marker.radius_px + spot.radius_px + k_gap_px;
    });
    if (touches && !single) continue;
    ++painted;
    const int reach = static_cast<int>(spot.radius_px) + 1;
    const int middle_x = static_cast<int>(x), middle_y = static_cast<int>(y);
    for (int row = std::max(middle_y - reach, 0);
         row <= std::min(middle_y + reach, pixels.height - 1); ++row) {
      for (int column = std::max(middle_x - reach, 0);
           column <= std::min(middle_x + reach, pixels.width - 1); ++column) {
        const double dx = column + 0.5 - x, dy = row + 0.5 - y;
        const bool is_centre = column == middle_x && row == middle_y;
        if (single ? !is_centre : dx * dx + dy * dy > spot.radius_px * spot.radius_px) continue;
        const auto at = static_cast<std::size_t>(row * pixels.width + column);
        pixels.reflectivity_16[at] = spot.level;
        if (!single) pixels.depth[at] = spot.depth;
      }
    }
  }
  return painted;
}

}  // namespace glint
