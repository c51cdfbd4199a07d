// Path files, read back by simple parsers of the two formats.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "kernels/motion/interpolate.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/programming/path_csv.hpp"
#include "platform/tools/programming/ur_script.hpp"
#include "tests/unit/platform/tools/programming/strokes.hpp"

namespace glint {
namespace {

// A waypoint, two curved strokes and two waypoints, with rotations by all angles up to pi.
DrawnPath sample_path() {
  PathCapture capture({});
  click(capture, 0, {0.3, -0.2, 0.4});
  test::Random random(7);
  for (const double begin : {1000.0, 4000.0}) {
    const Quaternion grip = random.rotation();
    capture.add(down(begin));
    for (double ms = 0; ms <= 2000; ms += 4) {
      const SineCosine s = sine_cosine(0.002 * ms);
      capture.add(tip_at(begin + ms, Vector3(0.05 * s.cosine, 0.05 * s.sine, 1e-5 * ms),
                         grip * from_rotation_vector(Vector3(0, 0, 1e-3 * ms))));
    }
    capture.add(up(begin + 2000));
  }
  click(capture, 8000, {0.1, 0, 0});
  draw(capture, 9000, 9100, [](double) { return Vector3(0.1, 0.1, 1e-9); });
  return capture.path();
}

std::vector<UncertainPose> points_of(const DrawnPath& path) {
  std::vector<UncertainPose> points;
  for (const PathElement& element : path) {
    points.insert(points.end(), element.points.begin(), element.points.end());
  }
  return points;
}

std::string script_of(const DrawnPath& path, const ProgramSettings& settings) {
  return ur_script(robot_program(path, settings));
}

struct Move {
  std::string name;
  Pose pose;
  double acceleration = 0, speed = 0, blend = 0;
};

// Parses the moves; fails on a line that is not a move, a comment or the program's frame.
std::vector<Move> moves_in(const std::string& script) {
  const std::string number = "(-?[0-9]+\\.[0-9]{6})";
  std::string pattern = "  (movel|movep)\\(p\\[";
  for (int i = 0; i < 6; ++i) pattern += (i == 0 ? "" : ", ") + number;
  const std::regex move(pattern + "\\], a=" + number + ", v=" + number + ", r=" + number + "\\)");
  std::istringstream lines(script);
  std::vector<Move> moves;
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(' ') == line.find('#')) continue;
    if (line == "def glint_path():" || line == "end" || line == "glint_path()") continue;
    std::smatch words;
    EXPECT_TRUE(std::regex_match(line, words, move)) << line;
    if (words.empty()) continue;
    std::vector<double> numbers;
    for (std::size_t i = 2; i < words.size(); ++i) numbers.push_back(std::stod(words[i]));
    moves.push_back({words[1],
                     {from_rotation_vector(Vector3(numbers[3], numbers[4], numbers[5])),
                      Vector3(numbers[0], numbers[1], numbers[2])},
                     numbers[6],
                     numbers[7],
                     numbers[8]});
  }
  return moves;
}

double turn_between(const Pose& a, const Pose& b) {
  return rotation_vector(a.rotation.conjugate() * b.rotation).norm();
}

double way(const Move& a, const Move& b) {
  return (a.pose.translation - b.pose.translation).norm();
}

TEST(UrScript, IsParsedBackToTheSamePoints) {
  const DrawnPath path = sample_path();
  ASSERT_EQ(path.size(), 5u);
  const std::string script = script_of(path, {});
  EXPECT_NE(script.find("# NOT CHECKED"), std::string::npos);
  EXPECT_EQ(script.rfind("# ", 0), 0u);
  const auto moves = moves_in(script);
  const auto points = points_of(path);
  ASSERT_EQ(moves.size(), points.size());
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Pose& pose = points[i].pose;
    EXPECT_LE((moves[i].pose.translation - pose.translation).cwiseAbs().maxCoeff(), 5.001e-7) << i;
    EXPECT_LE(turn_between(moves[i].pose, pose), 1e-6) << i;
  }
}

TEST(UrScript, DrivesToWaypointsAndStrokesAndAlongStrokes) {
  const DrawnPath path = sample_path();
  const ProgramSettings settings{.travel_m_s = 0.3, .stroke_m_s = 0.02, .acceleration_m_s2 = 0.7};
  const auto moves = moves_in(script_of(path, settings));
  std::size_t i = 0;
  for (const PathElement& element : path) {
    for (std::size_t k = 0; k < element.points.size(); ++k, ++i) {
      const bool along = element.kind == PathKind::stroke && k > 0;
      EXPECT_EQ(moves.at(i).name, along ? "movep" : "movel") << i;
      EXPECT_EQ(moves[i].speed, along ? 0.02 : 0.3);
      EXPECT_EQ(moves[i].acceleration, 0.7);
    }
  }
}

TEST(UrScript, KeepsBlendsApartAndStopsAtTheEndsOfStrokesAndOfTheProgram) {
  for (const double most : {0.0, 0.0004, 0.005, 0.1}) {
    ProgramSettings settings;
    settings.blend_m = most;
    const auto moves = moves_in(script_of(sample_path(), settings));
    ASSERT_GT(moves.size(), 3u);
    EXPECT_EQ(moves.back().blend, 0);
    double largest = 0;
    for (std::size_t i = 0; i + 1 < moves.size(); ++i) {
      EXPECT_LE(moves[i].blend, most);
      EXPECT_LE(moves[i].blend + moves[i + 1].blend, way(moves[i], moves[i + 1])) << i;
      EXPECT_LE(moves[i].blend, 0.5 * way(moves[i], moves[i + 1])) << i;
      const bool ends = moves[i].name == "movep" && moves[i + 1].name == "movel";
      const bool begins = moves[i].name == "movel" && moves[i + 1].name == "movep";
      if (ends || begins) {
        EXPECT_EQ(moves[i].blend, 0) << i;
      }
      largest = std::max(largest, moves[i].blend);
    }
    EXPECT_GE(largest, 0.9 * std::min(most, 0.001));
  }
}

// Two points at one position, and three that differ by less than the output's rounding.
TEST(UrScript, HasNoBlendWhereThereIsNoWay) {
  DrawnPath path;
  for (const double x : {0.1, 0.1, 0.1000004, 0.1000008, 0.2}) {
    path.push_back(
        {PathKind::waypoint, {{Time{}, {Quaternion::Identity(), {x, 0, 0}}, Matrix6::Zero()}}});
  }
  for (const Move& move : moves_in(script_of(path, {}))) EXPECT_EQ(move.blend, 0);
}

TEST(UrScript, RefusesSettingsThatNoRobotCanRun) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ProgramSettings& wrong : std::vector<ProgramSettings>{{.travel_m_s = 0},
                                                                   {.stroke_m_s = -1},
                                                                   {.acceleration_m_s2 = nan},
                                                                   {.blend_m = -1e-9},
                                                                   {.name = ""},
                                                                   {.name = "1st"},
                                                                   {.name = "a b"},
                                                                   {.name = "x():\nhalt"}}) {
    EXPECT_THROW((void)script_of(sample_path(), wrong), InputError);
  }
}

TEST(PathCsv, IsReadBackToTheSameBits) {
  DrawnPath path = sample_path();
  path[1].points[3].covariance(2, 4) = 1.0 / 3e9;
  path[1].points[3].time = Time{-5};
  std::istringstream lines(path_csv(path));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line.rfind("element,kind,point,time_s,x_m,y_m,z_m,qx,qy,qz,qw,c11,c12", 0), 0u);
  std::size_t number = 0;
  for (const PathElement& element : path) {
    ++number;
    std::size_t place = 0;
    for (const UncertainPose& point : element.points) {
      ASSERT_TRUE(std::getline(lines, line));
      std::istringstream row(line);
      std::vector<std::string> cells;
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      ASSERT_EQ(cells.size(), 47u);
      EXPECT_EQ(cells[0], std::to_string(number));
      EXPECT_EQ(cells[1], element.kind == PathKind::stroke ? "stroke" : "waypoint");
      EXPECT_EQ(cells[2], std::to_string(++place));
      EXPECT_NEAR(std::stod(cells[3]), point.time.nanoseconds * 1e-9, 1e-12);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(std::stod(cells[4 + i]), point.pose.translation[static_cast<int>(i)]);
      }
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(std::stod(cells[7 + i]), point.pose.rotation.coeffs()[static_cast<int>(i)]);
      }
      for (std::size_t i = 0; i < 36; ++i) {
        EXPECT_EQ(std::stod(cells[11 + i]),
                  point.covariance(static_cast<int>(i / 6), static_cast<int>(i % 6)));
      }
    }
  }
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
}  // namespace glint
