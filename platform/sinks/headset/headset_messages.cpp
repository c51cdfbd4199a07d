#include "platform/sinks/headset/headset_messages.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

namespace glint {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_robot_slot = k_tools_max, k_stroke_slot = k_robot_slot + 1;
// Radius of the 95 % ellipsoid in standard deviations: square root of the chi-square quantile with
// three degrees of freedom.
constexpr double k_radius_95 = 2.7954834829151074;

double rounded(double value) { return std::round(value * 1e6) * 1e-6; }

// Glint's frames are right-handed, Unity's are left-handed: z changes its sign.
Json vector_json(const Vector3& v) { return {rounded(v.x()), rounded(v.y()), rounded(-v.z())}; }
Json rotation_json(const Quaternion& q) {
  return {rounded(-q.x()), rounded(-q.y()), rounded(q.z()), rounded(q.w())};
}

double milliseconds_from(Duration duration) { return std::round(duration.seconds() * 1e4) * 0.1; }

bool knows_robot(const RobotFrame& robot) {
  return !robot.in_reference &&
         (robot.state == RegistrationState::given || robot.state == RegistrationState::accepted);
}

// T_world_tip; empty without a pose, or in a frame that has no place in the world.
std::optional<Pose> world_pose(const PoseSample& sample, const RobotFrame& robot) {
  if (!sample.has_pose()) return std::nullopt;
  if (sample.frame == ReferenceFrame::world) return sample.pose;
  if (sample.frame == ReferenceFrame::robot && knows_robot(robot)) {
    return robot.T_world_robot * sample.pose;
  }
  return std::nullopt;
}

std::string_view state_name(TrackState state) {
  constexpr std::array<std::string_view, 4> names{"none", "predicted", "measured", "lost"};
  return names[static_cast<std::size_t>(state)];
}

Json ellipsoid_json(const PoseSample& sample, const RobotFrame& robot) {
  Matrix3 covariance = sample.covariance.topLeftCorner<3, 3>();
  if (sample.frame == ReferenceFrame::robot) {
    const Matrix3 R = robot.T_world_robot.rotation.toRotationMatrix();
    covariance = R * covariance * R.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(covariance);
  Matrix3 axes = solver.eigenvectors();
  if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
  Json lengths = Json::array();
  for (int i = 0; i < 3; ++i) {
    lengths.push_back(rounded(k_radius_95 * std::sqrt(std::max(0.0, solver.eigenvalues()[i]))));
  }
  return {{"semi_axes_m", lengths}, {"rotation", rotation_json(Quaternion(axes))}};
}

Json buttons_json(std::uint8_t held) {
  constexpr std::array<std::string_view, 3> names{"draw", "delete_last", "undo"};
  Json json = Json::array();
  for (std::size_t bit = 0; bit < names.size(); ++bit) {
    if ((held >> bit & 1) != 0) json.push_back(names[bit]);
  }
  return json;
}

}  // namespace

HeadsetMessages::HeadsetMessages(std::vector<std::string> tool_names)
    : tool_names_(std::move(tool_names)), pens_(tool_names_.size()) {}

void HeadsetMessages::mark(std::size_t slot, Duration period, bool at_once) {
  Slot& to = slots_[slot];
  const bool is_first = to.version == 0 && !to.is_due;
  if (!is_first && !at_once && newest_ - to.due < period) return;
  to.is_due = true;
  to.due = newest_;
}

void HeadsetMessages::publish_due() {
  for (Slot& slot : slots_) {
    slot.version += slot.is_due ? 1 : 0;
    slot.is_due = false;
  }
}

void HeadsetMessages::add(const HeadsetSample& given) {
  const std::size_t tool = given.sample.tool;
  if (tool >= pens_.size()) return;
  newest_ = given.sample.tick;
  const bool changed = pens_[tool].sample.state != given.sample.state;
  pens_[tool] = given;
  mark(tool, k_pen_period, changed);
  if (tool != 0) return;  // draws, and states the robot for all
  add_robot(given.robot);
  add_to_stroke(given.sample);
}

void HeadsetMessages::add_robot(const RobotFrame& robot) {
  const Slot& slot = slots_[k_robot_slot];
  const bool is_first = slot.version == 0 && !slot.is_due;
  if (!knows_robot(robot) && is_first) return;
  const auto same = [](const Pose& a, const Pose& b) {
    return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
  };
  const bool changed =
      is_first || robot_.state != robot.state || !same(robot_.T_world_robot, robot.T_world_robot);
  if (changed) robot_changed_ = newest_;
  robot_ = robot;
  mark(k_robot_slot, changed ? k_pen_period : k_robot_period, false);
}

void HeadsetMessages::add_to_stroke(const PoseSample& sample) {
  const bool draws = (sample.buttons & 1) != 0;
  const bool begins = draws && !drawing_, ends = !draws && drawing_;
  drawing_ = draws;
  if (begins) ++strokes_begun_;
  if (strokes_begun_ == 0) return;
  const std::size_t index = (strokes_begun_ - 1) % k_strokes_max;
  Stroke& stroke = strokes_[index];
  if (begins) {
    stroke.points.clear();
    stroke = {strokes_begun_, false, k_point_gap_m, newest_, std::move(stroke.points)};
  }
  if (ends && !stroke.points.empty()) {
    stroke.done = true;
    mark(k_stroke_slot + index, k_stroke_period, true);
  }
  const auto pose = world_pose(sample, robot_);
  if (!draws || sample.state != TrackState::measured || !pose) return;
  if (!stroke.points.empty() && (pose->translation - stroke.points.back()).norm() < stroke.gap_m) {
    return;
  }
  if (stroke.points.size() == k_stroke_points_max) {
    for (std::size_t i = 0; 2 * i < stroke.points.size(); ++i)
      stroke.points[i] = stroke.points[2 * i];
    stroke.points.resize(k_stroke_points_max / 2);
    stroke.gap_m *= 2;
  }
  stroke.points.push_back(pose->translation);
  stroke.newest = sample.measurement;
  mark(k_stroke_slot + index, k_stroke_period, false);
}

std::string HeadsetMessages::text(std::size_t slot) const {
  if (slot < k_robot_slot) return pen_text(pens_[slot]);
  if (slot == k_robot_slot) return robot_text();
  return stroke_text(strokes_[slot - k_stroke_slot]);
}

std::string HeadsetMessages::pen_text(const HeadsetSample& pen) const {
  const PoseSample& sample = pen.sample;
  Json json = {{"type", "pen"},
               {"tool", tool_names_[sample.tool]},
               {"tick", sample.tick_number},
               {"unix_ms", (sample.tick + pen.unix_offset).nanoseconds / 1'000'000},
               {"state", state_name(sample.state)},
               {"reason", name_of(sample.reason)},
               {"age_ms", nullptr},
               {"tip_m", nullptr},
               {"direction", nullptr},
               {"rotation", nullptr},
               {"ellipsoid", nullptr},
               {"buttons", buttons_json(sample.buttons)}};
  if (sample.state != TrackState::none) {
    json["age_ms"] = milliseconds_from(newest_ - sample.measurement);
  }
  if (const auto pose = world_pose(sample, pen.robot)) {
    json["tip_m"] = vector_json(pose->translation);
    json["direction"] = vector_json(pose->rotation * Vector3::UnitZ());
    json["rotation"] = rotation_json(pose->rotation);
    json["ellipsoid"] = ellipsoid_json(sample, pen.robot);
  }
  return json.dump();
}

std::string HeadsetMessages::robot_text() const {
  Json json = {{"type", "robot"},
               {"age_ms", milliseconds_from(newest_ - robot_changed_)},
               {"position_m", nullptr},
               {"rotation", nullptr}};
  if (knows_robot(robot_)) {
    json["position_m"] = vector_json(robot_.T_world_robot.translation);
    json["rotation"] = rotation_json(robot_.T_world_robot.rotation);
  }
  return json.dump();
}

std::string HeadsetMessages::stroke_text(const Stroke& stroke) const {
  Json points = Json::array();
  for (const Vector3& point : stroke.points) points.push_back(vector_json(point));
  return Json{{"type", "stroke"},
              {"stroke", stroke.id},
              {"done", stroke.done},
              {"age_ms", milliseconds_from(newest_ - stroke.newest)},
              {"points_m", points}}
      .dump();
}

}  // namespace glint
