// Trajectory text files: TUM format (evo and similar tools), and CSV with every field.
//
// Both are PATH.part until closed, then renamed. A failed write ends the file at its last complete
// line; failed(), error() and lines_lost() report it, and later lines are only counted.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "kernels/wire/pose_sample.hpp"
#include "platform/sinks/record/growing_file.hpp"

namespace glint {

// `t x y z qx qy qz qw` in TUM format, without a newline; seconds and metres.
[[nodiscard]] std::string tum_line(Time time, const Pose& pose);

// A marker position in the format of points_csv.hpp.
inline constexpr std::string_view k_points_heading = "time_s,x_m,y_m,z_m";
[[nodiscard]] std::string points_line(Time time, const Vector3& point_m);

// Result of the frame group for one tool in one frame.
struct FramePose {
  Time time;  // mid-exposure
  std::uint64_t sequence = 0;
  std::string_view tool;
  TrackState state = TrackState::none;
  Reason reason = Reason::none;  // reason for a missing pose
  // For a measured tool only; otherwise these fields are empty.
  ReferenceFrame frame = ReferenceFrame::camera;
  std::uint8_t marker_mask = 0;
  double rms_m = 0;  // of the fit
  Pose pose;
  Matrix6 covariance = Matrix6::Zero();  // of the pose's origin and rotation, about `frame`'s axes
};
[[nodiscard]] std::string frame_pose_heading();
[[nodiscard]] std::string frame_pose_line(const FramePose& pose);

// Buffered writer of text lines to a file.
class TrajectoryLines {
 public:
  // Throws InputError if the file cannot be created.
  explicit TrajectoryLines(const std::string& path) : file_(path) {}

  void add(std::string_view line);
  // Returns false if a write failed.
  bool close();
  [[nodiscard]] bool failed() const { return failed_; }
  [[nodiscard]] const std::string& error() const { return file_.error(); }
  // Lines lost by a failed write so far.
  [[nodiscard]] std::uint64_t lines_lost() const { return lines_lost_; }

 private:
  void flush();
  GrowingFile file_;
  std::string buffered_;
  std::uint64_t lines_buffered_ = 0, lines_lost_ = 0;
  bool failed_ = false;
  bool closed_ = false;
};

// `t x y z qx qy qz qw` of one tool's tip at each tick with a pose; seconds and metres.
class TumFile {
 public:
  explicit TumFile(const std::string& path, std::uint8_t tool = 0);
  void write(const PoseSample& sample);
  bool close() { return file_.close(); }
  [[nodiscard]] const TrajectoryLines& file() const { return file_; }

 private:
  TrajectoryLines file_;
  std::uint8_t tool_;
};

// Every sample of every tool with all fields; states, frames and reasons by name. The pose fields
// are empty without a pose.
class CsvFile {
 public:
  explicit CsvFile(const std::string& path);
  void write(const PoseSample& sample);
  bool close() { return file_.close(); }
  [[nodiscard]] const TrajectoryLines& file() const { return file_; }

 private:
  TrajectoryLines file_;
};

}  // namespace glint
