#include "platform/tools/programming/path_csv.hpp"

#include <array>
#include <charconv>

namespace glint {
namespace {

// Shortest text that reads back as the same number, independent of the locale.
void put(std::string& line, double number) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  line += ',';
  line.append(text.data(), end);
}

void put(std::string& line, Time time) {
  constexpr std::int64_t k_second = 1'000'000'000;
  const bool negative = time.nanoseconds < 0;
  const std::int64_t size = negative ? -time.nanoseconds : time.nanoseconds;
  const std::string fraction = std::to_string(size % k_second);
  line += negative ? ",-" : ",";
  line += std::to_string(size / k_second) + '.' + std::string(9 - fraction.size(), '0') + fraction;
}

std::string heading() {
  std::string line = "element,kind,point,time_s,x_m,y_m,z_m,qx,qy,qz,qw";
  for (int row = 1; row <= 6; ++row) {
    for (int column = 1; column <= 6; ++column) {
      line += ",c" + std::to_string(row) + std::to_string(column);
    }
  }
  return line + '\n';
}

}  // namespace

std::string path_csv(const DrawnPath& path) {
  std::string text = heading();
  int number = 0;
  for (const PathElement& element : path) {
    ++number;
    int point = 0;
    for (const UncertainPose& one : element.points) {
      text += std::to_string(number) +
              (element.kind == PathKind::waypoint ? ",waypoint," : ",stroke,") +
              std::to_string(++point);
      put(text, one.time);
      for (int i = 0; i < 3; ++i) put(text, one.pose.translation[i]);
      for (int i = 0; i < 4; ++i) put(text, one.pose.rotation.coeffs()[i]);  // x, y, z, w
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) put(text, one.covariance(i, j));
      }
      text += '\n';
    }
  }
  return text;
}

}  // namespace glint
