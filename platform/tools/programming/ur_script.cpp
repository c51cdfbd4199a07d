#include "platform/tools/programming/ur_script.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr int k_digits = 6;  // micrometres, microradians: far below a pose's standard deviation
constexpr double k_step = 1e-6;

struct Move {
  const UncertainPose* to = nullptr;
  bool along_stroke = false;  // movep
  bool stops = false;
};

std::string fixed(double number) {
  std::array<char, 64> text;
  const double clean = std::abs(number) < 0.5 * k_step ? 0.0 : number;  // no "-0.000000"
  const auto end = std::to_chars(text.data(), text.data() + text.size(), clean,
                                 std::chars_format::fixed, k_digits)
                       .ptr;
  return {text.data(), end};
}

std::string pose_text(const Pose& pose) {
  const Vector3 turn = rotation_vector(pose.rotation);
  std::string text = "p[";
  for (int i = 0; i < 6; ++i) {
    text += (i == 0 ? "" : ", ") + fixed(i < 3 ? pose.translation[i] : turn[i - 3]);
  }
  return text + ']';
}

void check_script(bool right, const std::string& what) {
  if (!right) throw InputError("urscript: " + what);
}

void check(const UrScriptSettings& settings) {
  const auto above_0 = [](double number) { return std::isfinite(number) && number > 0; };
  check_script(above_0(settings.travel_m_s), "travel speed; expected a number above 0");
  check_script(above_0(settings.stroke_m_s), "stroke speed; expected a number above 0");
  check_script(above_0(settings.acceleration_m_s2), "acceleration; expected a number above 0");
  check_script(std::isfinite(settings.blend_m) && settings.blend_m >= 0,
               "blend; expected 0 or more");
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto word = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; };
  check_script(!settings.name.empty() && letter(settings.name.front()) &&
                   std::all_of(settings.name.begin(), settings.name.end(), word),
               "name \"" + settings.name + "\"; expected a letter, then letters, digits or _");
}

std::vector<Move> moves_of(const DrawnPath& path) {
  std::vector<Move> moves;
  for (const PathElement& element : path) {
    const bool stroke = element.kind == PathKind::stroke;
    for (const UncertainPose& point : element.points) {
      const bool first = &point == &element.points.front();
      const bool last = &point == &element.points.back();
      moves.push_back({&point, stroke && !first, stroke && (first || last)});
    }
  }
  if (!moves.empty()) moves.back().stops = true;
  return moves;
}

double distance_between(const Move& a, const Move& b) {
  return (a.to->pose.translation - b.to->pose.translation).norm();
}

// Rounded down, so that the rounding of two blends cannot make them overlap. Positions are rounded
// too, by up to 1.5 steps along the path.
double blend_at(const std::vector<Move>& moves, std::size_t i, double most) {
  if (moves[i].stops || i == 0 || i + 1 == moves.size()) return 0;
  const double half = 0.5 * std::min(distance_between(moves[i - 1], moves[i]),
                                     distance_between(moves[i], moves[i + 1]));
  return std::max(0.0, std::floor(std::min(most, half - k_step) / k_step) * k_step);
}

}  // namespace

std::string ur_script(const DrawnPath& path, const UrScriptSettings& settings) {
  check(settings);
  const std::vector<Move> moves = moves_of(path);
  std::string text = "# Drawn with a tracked pen: " + std::to_string(path.size()) + " elements, " +
                     std::to_string(moves.size()) +
                     " points, the tip in the robot's base frame, metres and rotation vectors.\n"
                     "# NOT CHECKED: reachability, joint limits, singularities, collisions.\n"
                     "# Set the tool centre point first; test slowly and in simulation.\n"
                     "def " +
                     settings.name + "():\n";
  int element = 0;
  std::size_t next_begin = 0;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (i == next_begin) {
      const PathElement& one = path[static_cast<std::size_t>(element++)];
      next_begin += one.points.size();
      text += "  # " + std::to_string(element) +
              (one.kind == PathKind::waypoint
                   ? ": waypoint\n"
                   : ": stroke of " + std::to_string(one.points.size()) + " points\n");
    }
    const Move& move = moves[i];
    text += std::string("  ") + (move.along_stroke ? "movep(" : "movel(") +
            pose_text(move.to->pose) + ", a=" + fixed(settings.acceleration_m_s2) +
            ", v=" + fixed(move.along_stroke ? settings.stroke_m_s : settings.travel_m_s) +
            ", r=" + fixed(blend_at(moves, i, settings.blend_m)) + ")\n";
  }
  return text + "end\n" + settings.name + "()\n";
}

}  // namespace glint
