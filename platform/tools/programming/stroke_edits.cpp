#include "platform/tools/programming/stroke_edits.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "platform/input_error.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

constexpr double k_length_max_m = 10;

// Words of one edit, with errors that name it.
class EditText {
 public:
  explicit EditText(const std::string& edit) : edit_(edit), words_(edit) {}

  [[noreturn]] void fail(const std::string& found, const std::string& expected) const {
    throw InputError("--edit \"" + printable(edit_) + "\": " + found + "; expected " + expected);
  }
  std::string word(const char* what) {
    std::string next;
    if (!(words_ >> next)) fail(std::string("no ") + what, "one");
    return next;
  }
  void end() {
    std::string next;
    if (words_ >> next) fail("found \"" + printable(next) + "\"", "the end");
  }
  Vector3 vector(const std::string& text) const {
    Vector3 v = Vector3::Zero();
    const char* at = text.data();
    const char* const last = text.data() + text.size();
    for (int i = 0; i < 3; ++i) {
      const auto [next, error] = std::from_chars(at, last, v[i]);
      const bool right = error == std::errc() && std::isfinite(v[i]) &&
                         (i == 2 ? next == last : next != last && *next == ',');
      if (!right) fail("found \"" + printable(text) + "\"", "three numbers x,y,z");
      at = next + 1;
    }
    return v;
  }
  Vector3 direction(const std::string& text) const {
    const Vector3 v = vector(text);
    if (!(v.norm() > 1e-9)) fail("a direction of length 0", "another one");
    return v.normalized();
  }
  std::size_t number_from_1(const char* what, std::size_t most) {
    const std::string text = word(what);
    std::size_t number = 0;
    const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool right =
        error == std::errc() && next == text.data() + text.size() && number >= 1 && number <= most;
    if (!right) {
      fail("found \"" + printable(text) + "\"",
           most == 0 ? "--planes" : "a number from 1 to " + std::to_string(most));
    }
    return number;
  }
  double length_m() {
    const std::string text = word("length");
    double number = 0;
    const auto [next, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const std::string unit(next, text.data() + text.size());
    const double metres = number * (unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : 1.0);
    const bool right = error == std::errc() && (unit == "mm" || unit == "cm" || unit == "m") &&
                       std::abs(metres) <= k_length_max_m;
    if (!right) fail("found \"" + printable(text) + "\"", "a length up to 10 m: 2mm, 0.5cm, 0.01m");
    return metres;
  }

 private:
  std::string edit_;
  std::istringstream words_;
};

std::size_t index_of(const DrawnPath& path, const std::string& name, const EditText& text) {
  const auto at = std::find_if(path.begin(), path.end(),
                               [&](const PathElement& element) { return element.name == name; });
  if (at == path.end()) {
    std::string names;
    for (const PathElement& element : path) names += (names.empty() ? "" : ", ") + element.name;
    text.fail("no element \"" + printable(name) + "\"",
              names.empty() ? "none: the path is empty" : "one of " + names);
  }
  return static_cast<std::size_t>(at - path.begin());
}

std::vector<std::size_t> selected(const DrawnPath& path, const std::string& name,
                                  const EditText& text) {
  if (name != "*") return {index_of(path, name, text)};
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < path.size(); ++i) all.push_back(i);
  return all;
}

Vector3 tool_axis(const UncertainPose& point) { return point.pose.rotation * Vector3::UnitZ(); }

// Normal of the plane with the least squared distances, on the side of the tool.
Vector3 fitted_normal(const PathElement& element, const EditText& text) {
  constexpr double k_width_min = 0.02;  // of the stroke's length
  Vector3 mean = Vector3::Zero(), tool = Vector3::Zero();
  const double count = static_cast<double>(element.points.size());
  for (const UncertainPose& point : element.points) {
    mean += point.pose.translation / count;
    tool += tool_axis(point);
  }
  Matrix3 spread = Matrix3::Zero();
  for (const UncertainPose& point : element.points) {
    const Vector3 off = point.pose.translation - mean;
    spread += off * off.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(spread);
  const Vector3 sizes = axes.eigenvalues().cwiseMax(0).cwiseSqrt();
  if (!(sizes[1] > k_width_min * sizes[2]))
    text.fail("element \"" + element.name + "\" is straight and has no normal",
              "tool or a direction x,y,z");
  const Vector3 normal = axes.eigenvectors().col(0);
  return normal.dot(tool) < 0 ? Vector3(-normal) : normal;
}

void move_along_tool(UncertainPose& point, double length_m) {
  const Vector3 lever = length_m * tool_axis(point);
  point.pose.translation += lever;
  Matrix6 moved = Matrix6::Identity();  // p -> p + w x lever
  moved.topRightCorner<3, 3>() = -cross_matrix(lever);
  point.covariance = (moved * point.covariance * moved.transpose()).eval();
}

void shift(PathElement& element, const std::string& direction, double length_m,
           const EditText& text) {
  if (direction == "tool") {
    for (UncertainPose& point : element.points) move_along_tool(point, length_m);
    return;
  }
  const Vector3 along =
      direction == "normal" ? fitted_normal(element, text) : text.direction(direction);
  for (UncertainPose& point : element.points) point.pose.translation += length_m * along;
}

void mirror(UncertainPose& point, const Vector3& on_plane, const Vector3& normal) {
  const Matrix3 mirrored = Matrix3::Identity() - 2 * normal * normal.transpose();
  point.pose.translation += -2 * normal.dot(point.pose.translation - on_plane) * normal;
  const Matrix3 turn =
      mirrored * point.pose.rotation.toRotationMatrix() * Vector3(1, -1, 1).asDiagonal();
  point.pose.rotation = Quaternion(turn).normalized();
  Matrix6 errors = Matrix6::Zero();  // a mirrored rotation turns the other way
  errors.topLeftCorner<3, 3>() = mirrored;
  errors.bottomRightCorner<3, 3>() = -mirrored;
  point.covariance = (errors * point.covariance * errors.transpose()).eval();
}

void project(UncertainPose& point, const MappedPlane& plane) {
  const Matrix3 onto = Matrix3::Identity() - plane.normal * plane.normal.transpose();
  point.pose.translation = plane.point + onto * (point.pose.translation - plane.point);
  Matrix6 errors = Matrix6::Identity();
  errors.topLeftCorner<3, 3>() = onto;
  point.covariance = (errors * point.covariance * errors.transpose()).eval();
  point.covariance.topLeftCorner<3, 3>() +=
      plane.sigma_m * plane.sigma_m * plane.normal * plane.normal.transpose();
}

// Waypoints at a distance from the element's first and last point.
void add_approach(DrawnPath& path, const std::string& name, const std::string& direction,
                  double length_m, const EditText& text) {
  const std::size_t at = index_of(path, name, text);
  PathElement moved = path[at];
  shift(moved, direction, length_m, text);
  const PathElement before{PathKind::waypoint, {moved.points.front()}, name + ".approach"};
  const PathElement after{PathKind::waypoint, {moved.points.back()}, name + ".retract"};
  for (const PathElement& element : path) {
    if (element.name == before.name || element.name == after.name)
      text.fail("the name \"" + element.name + "\" exists", "an element without approach");
  }
  if (!is_stroke_name(before.name))
    text.fail("the name \"" + before.name + "\"", "at most 64 characters");
  const auto place = path.begin() + static_cast<std::ptrdiff_t>(at);
  path.insert(path.insert(place, before) + 2, after);
}

DrawnPath edited_once(DrawnPath path, const std::string& edit,
                      const std::vector<MappedPlane>& planes) {
  EditText text(edit);
  const std::string verb = text.word("verb");
  const bool known = verb == "delete" || verb == "rename" || verb == "replace" ||
                     verb == "offset" || verb == "mirror" || verb == "project" ||
                     verb == "approach";
  if (!known)
    text.fail("found \"" + printable(verb) + "\"",
              "delete, rename, replace, offset, mirror, project or approach");
  const std::string name = text.word("name");
  if (verb == "delete") {
    text.end();
    if (name == "*") return {};
    path.erase(path.begin() + static_cast<std::ptrdiff_t>(index_of(path, name, text)));
  } else if (verb == "rename") {
    const std::string renamed = text.word("new name");
    text.end();
    const std::size_t at = index_of(path, name, text);
    const bool taken = std::any_of(path.begin(), path.end(), [&](const PathElement& element) {
      return element.name == renamed && name != renamed;
    });
    if (!is_stroke_name(renamed) || taken)
      text.fail("the name \"" + printable(renamed) + "\"",
                "a new one of at most 64 letters, digits, '_', '-' and '.'");
    path[at].name = renamed;
  } else if (verb == "replace") {
    const std::size_t newer = index_of(path, text.word("name of the newer element"), text);
    text.end();
    const std::size_t at = index_of(path, name, text);
    if (at == newer) text.fail("an element replaces itself", "two elements");
    path[at] = path[newer];
    path[at].name = name;
    path.erase(path.begin() + static_cast<std::ptrdiff_t>(newer));
  } else if (verb == "offset") {
    const std::string direction = text.word("direction");
    const double length = text.length_m();
    text.end();
    for (const std::size_t i : selected(path, name, text)) shift(path[i], direction, length, text);
  } else if (verb == "approach") {
    const std::string direction = text.word("direction");
    const double length = text.length_m();
    text.end();
    add_approach(path, name, direction, length, text);
  } else if (verb == "project") {
    const MappedPlane& plane = planes[text.number_from_1("number of a plane", planes.size()) - 1];
    text.end();
    for (const std::size_t i : selected(path, name, text))
      for (UncertainPose& point : path[i].points) project(point, plane);
  } else {
    const Vector3 on_plane = text.vector(text.word("point"));
    const Vector3 normal = text.direction(text.word("normal"));
    text.end();
    for (const std::size_t i : selected(path, name, text))
      for (UncertainPose& point : path[i].points) mirror(point, on_plane, normal);
  }
  return path;
}

}  // namespace

bool is_stroke_name(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == '.';
  };
  return !name.empty() && name.size() <= k_stroke_name_max &&
         std::all_of(name.begin(), name.end(), allowed);
}

DrawnPath named(DrawnPath path) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    std::string& name = path[i].name;
    if (name.empty()) name = std::string(name_of(path[i].kind)) + '_' + std::to_string(i + 1);
    const auto taken = [&](const PathElement& earlier) { return earlier.name == name; };
    while (std::any_of(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(i), taken))
      name += '_';
  }
  return path;
}

DrawnPath edited(DrawnPath path, const std::vector<std::string>& edits,
                 const std::vector<MappedPlane>& planes) {
  if (edits.size() > k_stroke_edits_max) {
    throw InputError("--edit: " + std::to_string(edits.size()) + " edits; expected at most " +
                     std::to_string(k_stroke_edits_max));
  }
  for (const std::string& edit : edits) path = edited_once(std::move(path), edit, planes);
  return path;
}

}  // namespace glint
