#include "platform/tools/reference/touched_points.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <optional>
#include <variant>

#include "kernels/pose/lever_arm.hpp"
#include "kernels/wire/output_record.hpp"
#include "platform/cells/toml_reader.hpp"
#include "platform/input_error.hpp"
#include "platform/runtime/session/recorded_cell.hpp"

namespace glint {
namespace {

constexpr double k_coordinate_max_mm = 1e5;
constexpr double k_touch_radius_m = 0.005;  // as of a click (platform/tools/programming)

std::optional<Vector3> point_of(TomlReader& reader, const char* key, const std::string& place) {
  const auto numbers = reader.reals(key, 3);
  if (!numbers) return std::nullopt;
  const Vector3 point((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  if (!(point.cwiseAbs().maxCoeff() <= k_coordinate_max_mm)) {
    throw InputError(place + ":" + std::to_string(reader.line_of(key)) + ": " + key +
                     " exceeds 100 m; expected millimetres");
  }
  return 1e-3 * point;
}

struct Press {
  Time from, to;
};

// The presses of draw that were not deleted.
std::vector<Press> presses_of(const std::vector<ButtonEvent>& events) {
  std::vector<Press> presses;
  std::optional<Time> held_from;
  for (const ButtonEvent& event : events) {
    if (event.button == Button::finish && event.pressed) break;
    if (event.button == Button::draw) {
      if (event.pressed && !held_from) held_from = event.time;
      if (event.pressed || !held_from) continue;
      presses.push_back({*held_from, event.time});
      held_from.reset();
    } else if (event.pressed && !presses.empty()) {
      presses.pop_back();
    }
  }
  return presses;
}

// Mean of the tips of one touch, and the mean of their covariances: the errors of neighbouring
// poses are too alike for the mean to have less.
struct Touch {
  Vector3 first = Vector3::Zero(), tip = Vector3::Zero();
  Matrix3 own_m2 = Matrix3::Zero(), shared_m2 = Matrix3::Zero();
  ReferenceFrame frame = ReferenceFrame::camera;
  double moved_m = 0;
  std::size_t samples = 0;

  void add(const PoseSample& sample) {
    if (samples == 0) {
      first = sample.pose.translation;
      frame = sample.frame;
    }
    ++samples;
    const double part = 1 / static_cast<double>(samples);
    const Matrix3 shared = sample.systematic.topLeftCorner<3, 3>();
    const Matrix3 own = sample.covariance.topLeftCorner<3, 3>() - shared;
    tip += part * (sample.pose.translation - tip);
    own_m2 += part * (own - own_m2);
    shared_m2 += part * (shared - shared_m2);
    moved_m = std::max(moved_m, (sample.pose.translation - first).norm());
  }
};

// From the frame of an earlier [robot] back to the frame that this pose is in. The earlier pose
// cancels, and so does its uncertainty.
void transform_back(Touch& touch, const Cell& cell) {
  Matrix6 robot = Matrix6::Zero();
  robot.diagonal() << Vector3::Constant(cell.robot_sigma_m * cell.robot_sigma_m),
      Vector3::Constant(cell.robot_sigma_rad * cell.robot_sigma_rad);
  touch.shared_m2 -= moved_covariance(robot, touch.tip).topLeftCorner<3, 3>();
  const Matrix3 rotation = cell.T_world_robot.rotation.toRotationMatrix();
  touch.tip = cell.T_world_robot * touch.tip;
  touch.own_m2 = rotation * touch.own_m2 * rotation.transpose();
  touch.shared_m2 = rotation * touch.shared_m2 * rotation.transpose();
}

std::string place_of(const std::string& recording, std::size_t number, const Press& press) {
  char text[64];
  std::snprintf(text, sizeof text, ": touch %zu at %.3f s: ", number + 1,
                static_cast<double>(press.from.nanoseconds) * 1e-9);
  return recording + text;
}

void check_touch(const Touch& touch, ReferenceFrame expected, const std::string& place) {
  if (touch.samples == 0) throw InputError(place + "no measured pose; expected the pen in view");
  if (touch.frame == ReferenceFrame::camera) {
    throw InputError(place + "a pose in the camera's frame; expected frames with a head pose");
  }
  if (touch.frame != expected) {
    throw InputError(place + "its pose is in another frame than the first touch's; expected one");
  }
  if (touch.moved_m <= k_touch_radius_m) return;
  char text[80];
  std::snprintf(text, sizeof text, "the tip moved by %.1f mm; expected it to rest within %.0f mm",
                1e3 * touch.moved_m, 1e3 * k_touch_radius_m);
  throw InputError(place + text);
}

std::uint8_t tool_number(const Cell& cell, const std::string& name, const std::string& recording) {
  std::string list;
  for (int i = 0; i < cell.tools.count; ++i) {
    const std::string tool = cell.tools.items[static_cast<std::size_t>(i)].name.data();
    if (name.empty() || tool == name) return static_cast<std::uint8_t>(i);
    list += (list.empty() ? "" : ", ") + tool;
  }
  throw InputError(recording + ": no tool '" + name + "'; expected one of: " + list);
}

}  // namespace

std::vector<TouchedPoint> read_touches(const std::string& file, const TouchOptions& options) {
  const toml::table root = parse_toml(read_text(file), file);
  TomlReader reader(root, file, "");
  std::vector<TouchedPoint> points;
  for (const toml::table* table : reader.tables("point")) {
    TomlReader row(*table, file, "point.");
    TouchedPoint point;
    point.name = row.text("name", "point " + std::to_string(points.size() + 1));
    const auto known = point_of(row, "position_mm", file), tip = point_of(row, "tip_mm", file);
    if (!known) {
      throw InputError(file + ":" + std::to_string(table->source().begin.line) +
                       ": point.position_mm is missing; expected [x, y, z] in the base's frame");
    }
    point.known_m = *known;
    point.tip_m = tip.value_or(Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    point.own_m2 = options.sigma_m * options.sigma_m * Matrix3::Identity();
    row.done();
    points.push_back(point);
  }
  reader.done();
  return points;
}

RecordedTouches set_tips(std::vector<TouchedPoint>& points, const std::string& recording,
                         const TouchOptions& options) {
  const std::vector<Press> presses = presses_of(
      options.presses.empty() ? recorded_buttons(recording, options.tolerance) : options.presses);
  if (presses.size() != points.size()) {
    throw InputError(recording + ": " + std::to_string(presses.size()) + " touches; expected " +
                     std::to_string(points.size()) + ", one for each point, in the same order");
  }
  RecordingReader reader(recording, options.tolerance);
  const Cell cell = recorded_cell(reader, recording);
  if (cell.mapping && !cell.mapping->model.empty()) {
    throw InputError(recording +
                     ": the run followed the robot in images, which moves its frame; "
                     "expected a cell without [mapping] model");
  }
  const std::uint8_t tool = tool_number(cell, options.tool, recording);
  std::vector<Touch> touches(presses.size());
  std::size_t current = 0;
  while (const auto message = reader.next()) {
    const auto* output = std::get_if<OutputMessage>(&*message);
    if (output == nullptr || output->tool != tool) continue;
    const Result<PoseSample> sample = decode(output->record);
    if (!sample) throw InputError(recording + ": an output record of an unknown layout");
    while (current < presses.size() && presses[current].to < sample.value.tick) ++current;
    if (current == presses.size()) break;
    if (sample.value.tick < presses[current].from) continue;
    if (sample.value.state == TrackState::measured) touches[current].add(sample.value);
  }
  for (std::size_t i = 0; i < touches.size(); ++i) {
    Touch& touch = touches[i];
    check_touch(touch, touches[0].frame, place_of(recording, i, presses[i]));
    if (touch.frame == ReferenceFrame::robot) transform_back(touch, cell);
    points[i].tip_m = touch.tip;
    points[i].own_m2 += touch.own_m2;
    points[i].shared_m2 = touch.shared_m2;
  }
  const bool in_robot = !touches.empty() && touches[0].frame == ReferenceFrame::robot;
  return {in_robot && cell.robot_in_reference, reader.losses()};
}

}  // namespace glint
