#include "platform/apps/glint/reference_touch.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "kernels/angles.hpp"
#include "platform/apps/glint/losses_json.hpp"
#include "platform/apps/glint/output_file.hpp"
#include "platform/cells/cell.hpp"
#include "platform/in_range.hpp"
#include "platform/input_error.hpp"
#include "platform/printable.hpp"
#include "platform/tools/programming/press_times.hpp"
#include "platform/tools/reference/touched_points.hpp"

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

Json numbers(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

// Standard deviation an axis of three components of the covariance, from `first` on.
double axis_sigma_of(const Matrix6& covariance, int first) {
  return std::sqrt(covariance.diagonal().segment<3>(first).sum() / 3);
}

std::string robot_table(const TouchedBase& base, bool in_reference) {
  const Vector3 position = 1e3 * base.T_frame_base.translation;
  const Vector3 rotation = fixed_axes_deg(base.T_frame_base.rotation);
  char text[400];
  std::snprintf(text, sizeof text,
                "[robot]\n%sposition_mm = [%.3f, %.3f, %.3f]\nrotation_deg = [%.4f, %.4f, %.4f]\n"
                "position_sigma_mm = %.3f\nrotation_sigma_deg = %.4f\n",
                in_reference ? "frame = \"reference\"\n" : "", position.x(), position.y(),
                position.z(), rotation.x(), rotation.y(), rotation.z(),
                1e3 * axis_sigma_of(base.covariance, 0),
                k_degrees_per_radian * axis_sigma_of(base.covariance, 3));
  return text;
}

Json figures(const TouchedBase& base, std::span<const TouchedPoint> points,
             const RecordedTouches& recorded) {
  Json touches = Json::array(), covariance = Json::array();
  for (std::size_t i = 0; i < points.size(); ++i) {
    touches.push_back({{"name", points[i].name},
                       {"position_mm", numbers(1e3 * points[i].known_m)},
                       {"tip_mm", numbers(1e3 * points[i].tip_m)},
                       {"distance_mm", 1e3 * base.distances_m[i]}});
  }
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c) covariance.push_back(base.covariance(r, c));
  }
  const Quaternion& q = base.T_frame_base.rotation;
  return {
      {"verdict", base.reason.empty() ? "accepted" : "refused"},
      {"why", base.reason},
      {"frame", recorded.in_reference ? "reference" : "world"},
      {"position_mm", numbers(1e3 * base.T_frame_base.translation)},
      {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}},
      {"rotation_deg", numbers(fixed_axes_deg(q))},
      {"covariance", covariance},  // translation in metres, rotation in radians, axes of `frame`
      {"position_sigma_mm", 1e3 * axis_sigma_of(base.covariance, 0)},
      {"rotation_sigma_deg", k_degrees_per_radian * axis_sigma_of(base.covariance, 3)},
      {"chi_square", base.chi_square},
      {"chi_square_max", base.chi_square_max},
      {"touches", touches},
      {"missing", losses_json(recorded.losses)}};
}

}  // namespace

void add_touch_options(CLI::App& command, TouchArguments& touch) {
  auto* const points = command.add_option(
      "--touch", touch.points,
      "TOML file of known points instead of images: [[point]] with name, position_mm (base's "
      "frame) and, without --tips, tip_mm");
  command
      .add_option("--tips", touch.tips,
                  "recording in which the pen's button was held at each point, in the file's order")
      ->needs(points);
  command.add_option("--tool", touch.tool, "name of the pen; default: the first tool")
      ->needs(points);
  command
      .add_option(
          "--button", touch.button,
          "intervals of the touches, FROM..TO in seconds, separated by commas; default: the "
          "recorded ones")
      ->needs(points);
  command
      .add_option("--touch-sigma-mm", touch.sigma_mm,
                  "standard deviation of one touch, an axis: tip, known point and hand")
      ->needs(points)
      ->check(in_range(0.001, 100.0))
      ->capture_default_str();
}

int run_touch(const TouchArguments& touch, const std::string& json) {
  TouchOptions options;
  options.sigma_m = 1e-3 * touch.sigma_mm;
  options.tool = touch.tool;
  if (!touch.button.empty()) options.presses = press_times(touch.button);
  std::vector<TouchedPoint> points = read_touches(touch.points, options);
  RecordedTouches recorded;
  if (!touch.tips.empty()) recorded = set_tips(points, touch.tips, options);
  for (const TouchedPoint& point : points) {
    if (point.tip_m.allFinite()) continue;
    throw InputError(touch.points + ": " + point.name +
                     " has no tip_mm; expected it, or --tips RECORDING");
  }
  const TouchedBase base = touched_base(points, touch.points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::printf("touch      %s: %.2f mm from its known point\n", printable(points[i].name).c_str(),
                1e3 * base.distances_m[i]);
  }
  std::printf("%sverdict    %s%s%s\n", robot_table(base, recorded.in_reference).c_str(),
              base.reason.empty() ? "accepted" : "refused", base.reason.empty() ? "" : ": ",
              printable(base.reason).c_str());
  if (recorded.losses.any()) {
    std::printf("notice     the recording lacks %s\n", text_of(recorded.losses).c_str());
  }
  write_json(json, figures(base, points, recorded));
  return base.reason.empty() && !recorded.losses.any() ? 0 : 1;
}

}  // namespace glint
