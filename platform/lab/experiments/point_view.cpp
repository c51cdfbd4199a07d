#include "platform/lab/experiments/point_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "kernels/motion/interpolate.hpp"
#include "platform/cells/cell.hpp"

namespace glint {
namespace {

constexpr double k_off_axis_rad = 25 * std::numbers::pi / 180;
constexpr double k_tip_beyond_m = 0.15;
constexpr double k_ndi_radius_m = 0.00575;

PointTool tool_of(std::string name, std::span<const Vector3> markers_mm, const Vector3& normal,
                  const Vector3& towards_tip) {
  PointTool out{std::move(name), {}, normal};
  for (const Vector3& marker : markers_mm) {
    out.tool.markers_m[static_cast<std::size_t>(out.tool.marker_count++)] = 1e-3 * marker;
  }
  out.tool.marker_radius_m = k_ndi_radius_m;
  if (prepare_tool(out.tool) != Reason::none) out.tool.marker_count = 0;
  out.tool.tip_m = marker_mean(out.tool) + k_tip_beyond_m * towards_tip;
  return out;
}

}  // namespace

PointTool ndi_8700339() {
  const Vector3 markers[] = {{0, 0, 0}, {0, 28.59, 41.02}, {0, 0, 88}, {0, -44.32, 40.45}};
  return tool_of("8700339", markers, Vector3::UnitX(), -Vector3::UnitZ());
}

PointTool sttar_pointer() {
  const Vector3 markers[] = {{-67.31, -11.72, 6.78},
                             {-20.54, 23.63, 21.43},
                             {20.49, -2.86, -6.55},
                             {67.36, -9.05, -21.66}};
  const Vector3 first = markers[1] - markers[0], second = markers[2] - markers[0];
  const Vector3 along = (markers[3] - markers[0]).normalized();
  return tool_of("STTAR_Pointer", markers, first.cross(second).normalized(), along);
}

PointTool five_marker_pen() {
  PointTool out{"pen", default_cell().tools.items[0], Vector3::UnitY()};
  out.tool.tip_m = marker_mean(out.tool) - k_tip_beyond_m * Vector3::UnitZ();
  return out;
}

Vector3 marker_mean(const Tool& tool) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < tool.marker_count; ++i) sum += tool.markers_m[static_cast<std::size_t>(i)];
  return sum / tool.marker_count;
}

Camera ahat_ray_table() {
  Camera camera = hololens2_ahat();
  const CameraModel lens = camera.model;
  auto rays = std::make_shared<std::vector<float>>();
  rays->reserve(static_cast<std::size_t>(lens.width * lens.height * 3));
  for (int y = 0; y < lens.height; ++y) {
    for (int x = 0; x < lens.width; ++x) {
      const Result<Vector3> ray = unproject(lens, {x + 0.5, y + 0.5});
      const Vector3 value = ray ? ray.value : Vector3::Zero();
      for (int i = 0; i < 3; ++i) rays->push_back(static_cast<float>(value(i)));
    }
  }
  camera.model.lens = Lens::lut;
  camera.model.table = {lens.width, lens.height, rays->data()};
  camera.table = std::move(rays);
  return camera;
}

MarkerVariance ObservationNoise::variance() const {
  const double pixel = pixel_px * pixel_px;
  const double range = std::max(range_m, k_range_sigma_min_m);
  return {pixel, 0, pixel, range * range};
}

Vector3 SampleNumbers::vector(double sigma) {
  const double x = normal(), y = normal(), z = normal();
  return sigma * Vector3(x, y, z);
}

int SampleNumbers::below(int n) { return std::min(static_cast<int>(within(0, n)), n - 1); }

DrawnPose draw_pose(const PointTool& tool, double range_m, double tilt_rad,
                    SampleNumbers& numbers) {
  const double full = 2 * std::numbers::pi;
  const double side = numbers.within(0, full), off = k_off_axis_rad * numbers.within(0, 1);
  const double tilt_axis = numbers.within(0, full), spin = numbers.within(0, full);
  const Vector3 sight =
      from_rotation_vector(off * Vector3(std::cos(side), std::sin(side), 0)) * Vector3::UnitZ();
  const Quaternion facing = rotation_between(tool.normal, -Vector3::UnitZ());
  const Quaternion turned = from_rotation_vector(Vector3(0, 0, spin)) * facing;
  const Quaternion towards = rotation_between(Vector3::UnitZ(), sight);
  const Vector3 mean = marker_mean(tool.tool);
  const auto tilted_by = [&](double tilt) {
    const Vector3 axis(std::cos(tilt_axis), std::sin(tilt_axis), 0);
    Pose pose;
    pose.rotation = (towards * from_rotation_vector(tilt * axis) * turned).normalized();
    pose.translation = range_m * sight - pose.rotation * mean;
    return pose;
  };
  return {tilted_by(tilt_rad), tilted_by(-tilt_rad)};
}

void PointView::clear() {
  markers.count = 0;
  truth.fill(-1);
}

bool PointView::add(const Camera& camera, const Tool& tool, const Vector3& centre, int label,
                    const ObservationNoise& noise, SampleNumbers& numbers) {
  const double right = numbers.normal(), down = numbers.normal(), away = numbers.normal();
  const Result<Vector2> pixel = project(camera.model, centre);
  if (!pixel || markers.count >= k_blobs_max) return false;
  const Vector2 seen = pixel.value + noise.pixel_px * Vector2(right, down);
  int lens_steps = 0;
  const Result<LocalRays> rays = local_rays(camera.model, seen, k_ray_steps_max, lens_steps);
  if (!rays) return false;
  const auto at = static_cast<std::size_t>(markers.count);
  Marker& marker = markers.items[at];
  marker = Marker{};
  marker.ray = rays.value.ray;
  marker.centroid_px = seen;
  marker.surface_range_m = centre.norm() + noise.range_m * away - tool.centre_offset_m();
  sights[at] = {rays.value, noise.variance()};
  if (label >= 0) truth[static_cast<std::size_t>(label)] = static_cast<std::int16_t>(at);
  ++markers.count;
  return true;
}

void PointView::shuffle(SampleNumbers& numbers) {
  for (int k = markers.count; k > 1; --k) {
    const auto a = static_cast<std::size_t>(k - 1);
    const auto b = static_cast<std::size_t>(numbers.below(k));
    std::swap(markers.items[a], markers.items[b]);
    std::swap(sights[a], sights[b]);
    for (std::int16_t& label : truth) {
      if (label == static_cast<std::int16_t>(a)) {
        label = static_cast<std::int16_t>(b);
      } else if (label == static_cast<std::int16_t>(b)) {
        label = static_cast<std::int16_t>(a);
      }
    }
  }
}

double rotation_between_rad(const Pose& a, const Pose& b) {
  return rotation_vector(a.rotation * b.rotation.conjugate()).norm();
}

}  // namespace glint
