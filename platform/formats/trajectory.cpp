#include "platform/formats/trajectory.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr const char* k_tum = "t x y z qx qy qz qw, separated by blanks";
constexpr const char* k_euroc = "ns,px,py,pz,qw,qx,qy,qz, separated by commas";

// Parser of one line of numbers; throws InputError with file:line.
class Line {
 public:
  Line(std::string_view text, const std::string& where, bool commas)
      : rest_(text), where_(where), commas_(commas) {}

  [[noreturn]] void fail(const std::string& found) const {
    throw InputError(where_ + ": " + found + "; expected " + (commas_ ? k_euroc : k_tum));
  }

  [[nodiscard]] std::string_view word() {
    const std::string_view blanks = " \t\r";
    rest_.remove_prefix(std::min(rest_.find_first_not_of(blanks), rest_.size()));
    ++column_;
    if (rest_.empty()) fail("ends before column " + std::to_string(column_));
    const std::size_t end = std::min(rest_.find_first_of(commas_ ? "," : " \t\r"), rest_.size());
    std::string_view word = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    word = word.substr(0, word.find_last_not_of(blanks) + 1);
    return word;
  }

  [[nodiscard]] double number() {
    const std::string_view text = word();
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
      fail("column " + std::to_string(column_) + " holds '" + std::string(text.substr(0, 40)) +
           "', not a finite number");
    }
    return value;
  }

  // Seconds as text, or integer nanoseconds.
  [[nodiscard]] std::int64_t stamp() {
    if (!commas_) {
      const double seconds = number();
      // Half of the range of int64 nanoseconds: the difference of two stamps fits.
      if (!(std::abs(seconds) < 4e9)) fail("a time stamp beyond 4e9 s");
      return static_cast<std::int64_t>(std::floor(seconds * 1e9 + 0.5));
    }
    const std::string_view text = word();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() ||
        value > 4'000'000'000'000'000'000 || value < -4'000'000'000'000'000'000) {
      fail("column 1 holds '" + std::string(text.substr(0, 40)) +
           "', not a whole number of nanoseconds");
    }
    return value;
  }

 private:
  std::string_view rest_;
  const std::string& where_;
  bool commas_ = false;
  int column_ = 0;
};

TimedPose parse(std::string_view text, const std::string& where, bool commas) {
  Line line(text, where, commas);
  TimedPose sample;
  sample.time = Time{line.stamp()};
  for (int axis = 0; axis < 3; ++axis) {
    sample.pose.translation[axis] = line.number();
    if (std::abs(sample.pose.translation[axis]) > 1e6) line.fail("a position beyond 1000 km");
  }
  std::array<double, 4> q{};
  for (double& value : q) value = line.number();
  const Quaternion rotation =
      commas ? Quaternion(q[0], q[1], q[2], q[3]) : Quaternion(q[3], q[0], q[1], q[2]);
  if (!(std::abs(rotation.norm() - 1) < 0.01)) line.fail("a quaternion of a length other than 1");
  sample.pose.rotation = rotation.normalized();
  return sample;
}

constexpr Duration k_gap = milliseconds(100);

// Maps time into the recording: forward, then backward, then forward again.
Time mirrored(Time time, Duration length) {
  const std::int64_t period = 2 * length.nanoseconds;
  std::int64_t inside = time.nanoseconds % period;
  if (inside < 0) inside += period;
  return Time{inside <= length.nanoseconds ? inside : period - inside};
}

// Slope at `here` of the parabola through three samples.
Vector3 slope(const TimedPose& before, const TimedPose& here, const TimedPose& after) {
  const double left = (here.time - before.time).seconds();
  const double right = (after.time - here.time).seconds();
  const Vector3 first = (here.pose.translation - before.pose.translation) / left;
  const Vector3 second = (after.pose.translation - here.pose.translation) / right;
  return (right * first + left * second) / (left + right);
}

}  // namespace

Trajectory trajectory_from_text(const std::string& text, const std::string& name) {
  Trajectory trajectory;
  trajectory.name = name;
  std::size_t number = 0, begin = 0;
  bool commas = false;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    ++number;
    const std::size_t content = line.find_first_not_of(" \t\r");
    if (content == std::string_view::npos || line[content] == '#') continue;
    const std::string where = name + ":" + std::to_string(number);
    if (trajectory.samples.empty()) commas = line.find(',') != std::string_view::npos;
    TimedPose sample = parse(line, where, commas);
    if (trajectory.samples.empty()) trajectory.begin = sample.time;
    sample.time.nanoseconds -= trajectory.begin.nanoseconds;
    if (!trajectory.samples.empty() && sample.time <= trajectory.samples.back().time) {
      throw InputError(where +
                       ": its stamp is not after the previous one; expected increasing stamps");
    }
    trajectory.samples.push_back(sample);
  }
  if (trajectory.samples.size() < 2) {
    throw InputError(name + ":" + std::to_string(number) + ": " +
                     std::to_string(trajectory.samples.size()) +
                     " samples; expected 2 or more lines of " + k_tum + ", or " + k_euroc);
  }
  return trajectory;
}

Trajectory load_trajectory(const std::string& path) {
  std::string expected = "a trajectory, ";
  expected += k_tum;
  return trajectory_from_text(read_file(path, k_data_bytes_max, expected), path);
}

Pose interpolated(const Trajectory& trajectory, Time time) {
  const std::vector<TimedPose>& samples = trajectory.samples;
  const Time inside = mirrored(time, trajectory.length());
  std::size_t low = 0, high = samples.size() - 1;  // samples[low] <= inside <= samples[high]
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (samples[middle].time <= inside ? low : high) = middle;
  }
  const TimedPose& a = samples[low];
  const TimedPose& b = samples[high];
  const Duration span = b.time - a.time;
  Pose pose = interpolate(a, b, inside);
  if (span > k_gap || low == 0 || high + 1 == samples.size()) return pose;
  // Cubic Hermite interpolation with the slopes at both ends.
  const double h = span.seconds();
  const double u = (inside - a.time).seconds() / h;
  const Vector3 out = h * slope(samples[low - 1], a, b);
  const Vector3 in = h * slope(a, b, samples[high + 1]);
  const Vector3 whole = b.pose.translation - a.pose.translation;
  pose.translation = a.pose.translation +
                     u * (out + u * ((3 * whole - 2 * out - in) + u * (out + in - 2 * whole)));
  return pose;
}

}  // namespace glint
