#include "platform/sinks/record/trajectory_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "platform/sinks/record/bytes.hpp"

namespace glint {
namespace {

constexpr std::size_t k_flush_bytes = std::size_t{64} << 10;

constexpr std::array<std::string_view, 4> k_state_names{"none", "predicted", "measured", "lost"};
constexpr std::array<std::string_view, 4> k_registration_names{"none", "given", "accepted",
                                                               "refused"};
constexpr std::array<std::string_view, 3> k_frame_names{"camera", "world", "robot"};

template <std::size_t N, class Enum>
std::string_view name_in(const std::array<std::string_view, N>& names, Enum value) {
  const auto i = static_cast<std::size_t>(value);
  return i < N ? names[i] : "unknown";
}

// Shortest text that parses to the same number, independent of the locale.
void put(std::string& line, double number) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  line.append(text.data(), end);
}

// Seconds with all nanoseconds: a double since 1970 would lose precision.
void put(std::string& line, Time time) {
  constexpr std::uint64_t k_second = 1'000'000'000;
  const bool negative = time.nanoseconds < 0;
  const auto count = static_cast<std::uint64_t>(time.nanoseconds);
  const std::uint64_t size = negative ? ~count + 1 : count;
  const std::string fraction = std::to_string(size % k_second);
  line += negative ? "-" : "";
  line += std::to_string(size / k_second) + ".";
  line.append(9 - fraction.size(), '0') += fraction;
}

class Row {
 public:
  explicit Row(std::string& line) : line_(line) {}
  Row& operator<<(Time time) { return put(next(), time), *this; }
  Row& operator<<(double number) { return put(next(), number), *this; }
  Row& operator<<(std::uint64_t number) { return next() += std::to_string(number), *this; }
  Row& operator<<(std::string_view text) { return next() += text, *this; }

 private:
  std::string& next() {
    if (!line_.empty()) line_ += ',';
    return line_;
  }
  std::string& line_;
};

constexpr int k_pose_fields = 3 + 4 + 3 + 3 + 36 + 2 + 36;

std::string csv_heading() {
  std::string line =
      "tick_s,measurement_s,tick_number,frame_sequence,tool,state,reason,registration,frame,"
      "marker_mask,buttons,registration_rms_m,x_m,y_m,z_m,qx,qy,qz,qw,vx_m_s,vy_m_s,vz_m_s,"
      "wx_rad_s,wy_rad_s,wz_rad_s";
  const auto matrix = [&](const char* name) {
    for (int row = 1; row <= 6; ++row)
      for (int column = 1; column <= 6; ++column)
        line += name + std::to_string(row) + std::to_string(column);
  };
  matrix(",c");
  line += ",sigma_position_m,sigma_orientation_rad";
  matrix(",systematic_c");
  return line;
}

void put_pose_fields(Row& row, const PoseSample& sample) {
  for (int i = 0; i < 3; ++i) row << sample.pose.translation[i];
  for (int i = 0; i < 4; ++i) row << sample.pose.rotation.coeffs()[i];  // x,y,z,w
  for (int i = 0; i < 3; ++i) row << sample.velocity_m_s[i];
  for (int i = 0; i < 3; ++i) row << sample.angular_velocity_rad_s[i];
  const auto matrix = [&](const Matrix6& covariance) {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) row << covariance(i, j);
  };
  matrix(sample.covariance);
  row << sample.sigma_position_m << sample.sigma_orientation_rad;
  matrix(sample.systematic);
}

}  // namespace

std::string tum_line(Time time, const Pose& pose) {
  std::string line;
  put(line, time);
  for (int i = 0; i < 3; ++i) put(line += ' ', pose.translation[i]);
  for (int i = 0; i < 4; ++i) put(line += ' ', pose.rotation.coeffs()[i]);  // x,y,z,w
  return line;
}

std::string points_line(Time time, const Vector3& point_m) {
  std::string line;
  Row row(line);
  row << time;
  for (int i = 0; i < 3; ++i) row << point_m[i];
  return line;
}

std::string frame_pose_heading() {
  return "time_s,sequence,tool,state,reason,frame,marker_mask,rms_m,x_m,y_m,z_m,qx,qy,qz,qw,"
         "sigma_x_m,sigma_y_m,sigma_z_m,sigma_rx_rad,sigma_ry_rad,sigma_rz_rad";
}

std::string frame_pose_line(const FramePose& pose) {
  std::string line;
  Row row(line);
  row << pose.time << pose.sequence << pose.tool << name_in(k_state_names, pose.state)
      << name_of(pose.reason);
  if (pose.state != TrackState::measured) {
    constexpr std::size_t k_fields = 1 + 1 + 1 + 3 + 4 + 6;
    return line.append(k_fields, ',');
  }
  row << name_in(k_frame_names, pose.frame) << std::uint64_t{pose.marker_mask} << pose.rms_m;
  for (int i = 0; i < 3; ++i) row << pose.pose.translation[i];
  for (int i = 0; i < 4; ++i) row << pose.pose.rotation.coeffs()[i];  // x,y,z,w
  for (int i = 0; i < 6; ++i) row << std::sqrt(std::max(0.0, pose.covariance(i, i)));
  return line;
}

void TrajectoryLines::flush() {
  failed_ = failed_ || !file_.append({bytes_of(buffered_)});
  if (failed_) lines_lost_ += lines_buffered_;
  buffered_.clear();
  lines_buffered_ = 0;
}

void TrajectoryLines::add(std::string_view line) {
  if (closed_) return;
  ++lines_buffered_;
  if (failed_) return flush();
  buffered_.append(line) += '\n';
  if (buffered_.size() >= k_flush_bytes) flush();
}

bool TrajectoryLines::close() {
  if (closed_) return !failed_;
  closed_ = true;
  flush();
  const bool named = file_.finish();
  failed_ = failed_ || !named;
  return !failed_;
}

TumFile::TumFile(const std::string& path, std::uint8_t tool) : file_(path), tool_(tool) {}

void TumFile::write(const PoseSample& sample) {
  if (sample.tool != tool_ || !sample.has_pose()) return;
  file_.add(tum_line(sample.tick, sample.pose));
}

CsvFile::CsvFile(const std::string& path) : file_(path) { file_.add(csv_heading()); }

void CsvFile::write(const PoseSample& sample) {
  std::string line;
  Row row(line);
  row << sample.tick << sample.measurement << sample.tick_number << sample.frame_sequence
      << std::uint64_t{sample.tool} << name_in(k_state_names, sample.state)
      << name_of(sample.reason) << name_in(k_registration_names, sample.registration)
      << name_in(k_frame_names, sample.frame) << std::uint64_t{sample.marker_mask}
      << std::uint64_t{sample.buttons} << sample.registration_rms_m;
  if (sample.has_pose())
    put_pose_fields(row, sample);
  else
    line.append(k_pose_fields, ',');
  file_.add(line);
}

}  // namespace glint
