#include "platform/sim/scene.hpp"

#include <algorithm>

#include "kernels/pose/depth_bias.hpp"
#include "platform/sim/capsule.hpp"
#include "platform/sim/random.hpp"

namespace glint::sim {
namespace {

constexpr double k_transition_s = 0.25;  // how long something takes to come or go

double presence(const Interval& during, Time time, double transition_s = k_transition_s) {
  const double t = Duration{time.nanoseconds}.seconds();
  const double begin = Duration{during.begin.nanoseconds}.seconds();
  const double end = Duration{during.end.nanoseconds}.seconds();
  return smooth_step(t, begin, transition_s) *
         (1 - smooth_step(t, end - transition_s, transition_s));
}

// Moves the image by the blob's pixel error at unchanged range, and sets its range error.
void disturb(const Scenario& scenario, std::uint64_t sequence, Time time, Reflector& reflector) {
  const NoiseSettings& noise = scenario.noise;
  const auto number =
      static_cast<std::uint64_t>(reflector.tool * k_markers_per_tool_max + reflector.marker);
  const RandomKey key{scenario.seed, Stream::blob, number};
  const Vector3 normal = gaussian_vector(key, sequence);
  const double range = reflector.centre.norm();
  reflector.range_error_m = noise.blob_range_sigma_m * (range / 0.5) * normal.z();
  if (noise.blob_pixel_sigma_px == 0 && !scenario.device.exists) return;
  const CameraModel& model = scenario.camera.model;
  const Result<Vector2> pixel = project(model, reflector.centre);
  if (!pixel) return;
  Vector2 moved = pixel.value + noise.blob_pixel_sigma_px * Vector2(normal.x(), normal.y());
  if (scenario.device.exists) {
    const MarkerError error =
        marker_error(scenario.device, pixel.value, {model.cx, model.cy}, range, number, time);
    moved += error.shift_px;
    const double counts = reflector.signal * (0.25 / (range * range));
    reflector.range_error_m +=
        error.range_m + scenario.device.dim_m * (DepthBias::k_reference_counts / counts);
  }
  const Result<Vector3> ray = unproject(scenario.camera.model, moved);
  if (ray) reflector.centre = range * ray.value.normalized();
}

struct Moments {
  Pose before, middle, after;  // begin, middle and end of the exposure
};

void add_tool(const Scenario& scenario, int index, std::uint64_t sequence, Time time,
              const Moments& seen, Scene& out) {
  const ToolBody& body = scenario.tools[static_cast<std::size_t>(index)];
  for (int i = 0; i < body.tool.marker_count; ++i) {
    const Vector3& marker = body.tool.markers_m[static_cast<std::size_t>(i)];
    Reflector reflector;
    reflector.centre = seen.middle * marker;
    reflector.travel = seen.after * marker - seen.before * marker;
    if (body.tool.shape == MarkerShape::disc) {
      reflector.normal = (seen.middle.rotation * body.disc_normal).normalized();
    }
    reflector.radius_m = body.tool.marker_radius_m;
    reflector.signal = scenario.signal.marker;
    reflector.limb = scenario.signal.sphere_limb;
    reflector.tool = index;
    reflector.marker = i;
    disturb(scenario, sequence, time, reflector);
    out.reflectors.push(reflector);
  }
  for (const Capsule& part : body.parts) out.capsules.push(transformed(seen.middle, part));
}

void add_clutter(const Scenario& scenario, const Moments& camera_world, Scene& out) {
  for (const Clutter& item : scenario.clutter) {
    Reflector reflector;
    reflector.centre = camera_world.middle * item.position_m;
    reflector.travel = camera_world.after * item.position_m - camera_world.before * item.position_m;
    if (item.normal.squaredNorm() > 0) {
      reflector.normal = (camera_world.middle.rotation * item.normal).normalized();
    }
    reflector.radius_m = item.radius_m;
    reflector.signal = item.signal;
    reflector.limb = scenario.signal.sphere_limb;
    out.reflectors.push(reflector);
  }
}

void add_occlusions(const Scenario& scenario, const Pose& T_camera_world, Time time, Scene& out) {
  for (const OcclusionEvent& event : scenario.occlusions) {
    if (!event.during.contains(time)) continue;
    if (event.tool < 0 || event.tool >= static_cast<int>(scenario.tools.size())) continue;
    const Tool& tool = scenario.tools[static_cast<std::size_t>(event.tool)].tool;
    const Vector3 target =
        T_camera_world * (tool_pose(scenario, event.tool, time) * centroid_of(tool));
    const double aside = 0.4 * (1 - presence(event.during, time));
    const Vector3 place = event.range_fraction * target + Vector3(aside, 0.5 * aside, 0);
    out.capsules.push({place, place, event.radius_m, scenario.signal.skin});
  }
}

}  // namespace

Pose tool_pose(const Scenario& scenario, int tool, Time time) {
  Pose pose = scenario.tools[static_cast<std::size_t>(tool)].motion->pose(time);
  for (const AbsenceEvent& event : scenario.absences) {
    if (event.tool == tool)
      pose.translation += presence(event.during, time, event.transition_s) * event.away_m;
  }
  return pose;
}

Vector3 centroid_of(const Tool& tool) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < tool.marker_count; ++i) sum += tool.markers_m[static_cast<std::size_t>(i)];
  return tool.marker_count > 0 ? Vector3(sum / tool.marker_count) : sum;
}

void build_scene(const Scenario& scenario, Time mid_exposure, std::uint64_t sequence, Scene& out) {
  const Duration half{scenario.camera.exposure.nanoseconds / 2};
  const Time times[3] = {mid_exposure - half, mid_exposure, mid_exposure + half};
  out.T_world_camera = scenario.head->pose(mid_exposure);
  const Moments camera_world{scenario.head->pose(times[0]).inverse(), out.T_world_camera.inverse(),
                             scenario.head->pose(times[2]).inverse()};
  out.reflectors.count = 0;
  out.capsules.count = 0;
  for (int tool = 0; tool < static_cast<int>(scenario.tools.size()); ++tool) {
    const Moments seen{camera_world.before * tool_pose(scenario, tool, times[0]),
                       camera_world.middle * tool_pose(scenario, tool, times[1]),
                       camera_world.after * tool_pose(scenario, tool, times[2])};
    add_tool(scenario, tool, sequence, mid_exposure, seen, out);
  }
  add_clutter(scenario, camera_world, out);
  add_occlusions(scenario, camera_world.middle, mid_exposure, out);
  // A total order, as a stable sort would allocate.
  for (int i = 0; i < out.reflectors.count; ++i) out.reflectors[i].index = i;
  std::sort(out.reflectors.items.begin(), out.reflectors.items.begin() + out.reflectors.count,
            [](const Reflector& a, const Reflector& b) {
              const double far_a = a.centre.squaredNorm(), far_b = b.centre.squaredNorm();
              return far_a != far_b ? far_a > far_b : a.index < b.index;
            });
}

}  // namespace glint::sim
