#include "platform/tools/calibrate/tool_geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "platform/dense.hpp"
#include "platform/input_error.hpp"
#include "platform/tools/calibrate/figure_text.hpp"
#include "platform/tools/calibrate/frame_labels.hpp"
#include "platform/tools/calibrate/rotation_spread.hpp"
#include "platform/tools/calibrate/tool_frame.hpp"
#include "platform/tools/calibrate/tool_round.hpp"

namespace glint {
namespace {

constexpr int k_initial_frames_max = 5;
constexpr double k_noise_share_max = 0.1;  // of the tool's size
constexpr double k_labelled_share_min = 0.5;
constexpr std::size_t k_sigma_parts = 8;
constexpr double k_line_noises = 5;  // nearer to a line, the rotation about it is open
constexpr const char* k_on_a_line =
    ": the recurring points are fewer than 3 or collinear; expected 3 or more markers, not "
    "collinear";

Tool tool_of(const std::vector<Vector3>& markers_m) {
  Tool tool;
  for (const Vector3& marker : markers_m) {
    tool.markers_m[static_cast<std::size_t>(tool.marker_count++)] = marker;
  }
  if (prepare_tool(tool) != Reason::none) tool.marker_count = 0;
  return tool;
}

// Largest point count that occurs in at least a tenth of the frames.
std::size_t common_point_count(std::span<const PointFrame> frames, const std::string& what) {
  std::map<std::size_t, int> counts;
  for (const PointFrame& frame : frames) ++counts[frame.points_m.size()];
  std::size_t largest = 0;
  for (const auto& [points, count] : counts) {
    if (points <= static_cast<std::size_t>(k_markers_per_tool_max) &&
        10 * count >= static_cast<int>(frames.size()))
      largest = points;
  }
  if (largest >= 3) return largest;
  throw InputError(what + ": too few frames have 3 to " + std::to_string(k_markers_per_tool_max) +
                   " points; expected a tool's markers: show all of them, cover other reflectors");
}

int markers_in(const std::vector<Labeling>& labels) {
  int sum = 0;
  for (const Labeling& label : labels) sum += label.count;
  return sum;
}

// Initial tool: the points of the frame that, taken as the tool, label most markers in the segment.
LabelledFrames initial_labels(std::span<const PointFrame> frames, const Segment& segment,
                              std::size_t points, double noise_m) {
  std::vector<std::size_t> initial_frames;
  for (std::size_t f = segment.begin; f < segment.end; ++f) {
    if (frames[f].points_m.size() == points) initial_frames.push_back(f);
  }
  LabelledFrames best;
  const std::size_t step = initial_frames.size() / k_initial_frames_max + 1;
  for (std::size_t i = 0; i < initial_frames.size(); i += step) {
    const Tool tool = tool_of(frames[initial_frames[i]].points_m);
    if (tool.marker_count == 0) continue;
    std::vector<Labeling> labels = label_segment(frames, segment, tool, noise_m);
    if (markers_in(labels) > markers_in(best.labels)) best = {tool, std::move(labels)};
  }
  return best;
}

// Returns whether the second principal spread of the markers is within k_line_noises of their
// noise.
bool on_a_line(const std::vector<Vector3>& markers, double noise_m) {
  const Vector3 centroid = centroid_of(markers);
  Matrix3 spread = Matrix3::Zero();
  for (const Vector3& m : markers) spread += (m - centroid) * (m - centroid).transpose();
  return symmetric_eigen(spread / static_cast<double>(markers.size())).values[1] <
         k_line_noises * k_line_noises * noise_m * noise_m;
}

void check_enough(const ToolIteration& round, std::size_t frames, const std::string& what) {
  const auto used = static_cast<double>(round.frames.size());
  if (!round.points.empty() && used >= k_labelled_share_min * static_cast<double>(frames) &&
      round.noise_m <= k_noise_share_max * longest_side(round.bundle.markers_m))
    return;
  throw InputError(what + ": the points of " + std::to_string(round.frames.size()) + " of " +
                   std::to_string(frames) + " frames fit one rigid tool, within " +
                   format_mm(round.noise_m) + "; expected at least half of them: one tool, " +
                   "3 or more of its markers in most frames");
}

// Effect of slow errors on each marker's position, per axis: from the spread of its mean residuals
// over k_sigma_parts parts of the recording. correlated_range_m covers still slower errors.
void count_slow_errors(const ToolIteration& round, double correlated_range_m,
                       ToolGeometry& geometry) {
  for (std::size_t marker = 0; marker < geometry.marker_sigma_m.size(); ++marker) {
    std::array<Vector3, k_sigma_parts> sums;
    std::array<int, k_sigma_parts> counts{};
    sums.fill(Vector3::Zero());
    for (const LabelledPoint& point : round.points) {
      if (point.marker != marker) continue;
      const std::size_t part = point.frame * k_sigma_parts / round.frames.size();
      const Quaternion& turn = round.bundle.poses[point.frame].rotation;
      sums[part] += turn.conjugate() * bundle_residual(round.bundle, point);
      ++counts[part];
    }
    double squares = 0;
    for (std::size_t part = 0; part < k_sigma_parts; ++part)
      squares += counts[part] > 0 ? (sums[part] / counts[part]).squaredNorm() : 0;
    constexpr double k_parts = k_sigma_parts;
    double& sigma_m = geometry.marker_sigma_m[marker];
    sigma_m = std::max(sigma_m, std::sqrt(squares / (3 * (k_parts - 1) * k_parts)));
    sigma_m = std::hypot(sigma_m, correlated_range_m / std::sqrt(3.0));
  }
}

ToolGeometry geometry_of(const ToolIteration& round, const ToolGeometrySettings& settings,
                         const std::string& what) {
  ToolGeometry geometry;
  geometry.markers_m = round.bundle.markers_m;
  geometry.frame_counts = frame_counts_by_marker(round);
  geometry.noise_m = round.noise_m;
  geometry.marker_sigma_m = marker_sigmas(round.bundle, round.points, round.noise_m);
  geometry.frames_used = static_cast<int>(round.frames.size());
  geometry.points_used = static_cast<int>(round.points.size());
  std::vector<double> squares(round.frames.size(), 0), count(round.frames.size(), 0);
  for (const LabelledPoint& point : round.points) {
    squares[point.frame] += bundle_residual(round.bundle, point).squaredNorm();
    ++count[point.frame];
  }
  for (std::size_t i = 0; i < squares.size(); ++i) {
    geometry.residuals_m.push_back(std::sqrt(squares[i] / count[i]));
  }
  std::vector<TimedPose> poses;
  for (const Pose& pose : round.bundle.poses) poses.push_back({Time{}, pose});
  geometry.rotation_spread_rad = rotation_spread(poses).spread_rad[0];
  count_slow_errors(round, settings.correlated_range_m, geometry);
  set_size(settings, geometry);
  set_frame(settings, what, geometry);
  return geometry;
}

}  // namespace

double slow_range_of_mean(std::span<const PointFrame> frames, const Camera& camera) {
  if (frames.empty()) return 0;
  const double seconds = std::max((frames.back().time - frames.front().time).seconds(), 1e-3);
  // Variance of the mean of a Gauss-Markov process over the recording, relative to its variance.
  const auto share = [&](double correlation_s) {
    const double x = correlation_s / seconds;
    return 2 * x * (1 - x * (1 - std::exp(-1 / x)));
  };
  const CameraUncertainty& sigma = camera.uncertainty;
  return sigma.correlated_range_m *
         std::sqrt(sigma.fast_share * share(camera.correlation.fast_s) +
                   (1 - sigma.fast_share) * share(camera.correlation.slow_s));
}

ToolGeometry calibrate_tool(std::span<const PointFrame> frames,
                            const ToolGeometrySettings& settings, const std::string& what) {
  if (frames.size() < static_cast<std::size_t>(k_tool_frames_min)) {
    throw InputError(what + ": " + std::to_string(frames.size()) + " frames; expected at least " +
                     std::to_string(k_tool_frames_min) + " of the tool in motion");
  }
  const std::vector<Segment> segments = segments_of(frames, settings.step_max_m);
  const Segment longest =
      *std::max_element(segments.begin(), segments.end(),
                        [](const Segment& a, const Segment& b) { return a.length() < b.length(); });

  const double first_noise_m = std::sqrt(2.0) * settings.noise_m;  // of two frames' difference
  LabelledFrames named =
      initial_labels(frames, longest, common_point_count(frames, what), first_noise_m);
  ToolIteration round = round_of(frames, longest.begin, named);
  if (named.tool.marker_count == 0) throw InputError(what + k_on_a_line);
  if (round.points.empty()) check_enough(round, longest.length(), what);
  fit(round, first_noise_m);
  for (int i = 1; i < settings.rounds; ++i) {
    if (on_a_line(round.bundle.markers_m, round.noise_m)) throw InputError(what + k_on_a_line);
    check_enough(round, i == 1 ? longest.length() : frames.size(), what);
    named.tool = tool_of(next_markers(frames, round, settings.frame_share_min));
    if (named.tool.marker_count == 0) throw InputError(what + k_on_a_line);
    named.labels.clear();
    for (const Segment& segment : segments) {
      const std::vector<Labeling> labels =
          label_segment(frames, segment, named.tool, 1.2 * round.noise_m);
      named.labels.insert(named.labels.end(), labels.begin(), labels.end());
    }
    const double noise_m = round.noise_m;
    round = round_of(frames, 0, named);
    if (round.points.empty()) break;
    fit(round, noise_m);
  }
  check_enough(round, frames.size(), what);

  ToolGeometry geometry = geometry_of(round, settings, what);
  geometry.frames = static_cast<int>(frames.size());
  geometry.segments = static_cast<int>(segments.size());
  for (const PointFrame& frame : frames) geometry.points += static_cast<int>(frame.points_m.size());
  if (geometry.rotation_spread_rad < settings.rotation_min_rad) {
    throw InputError(what + ": the least moving direction of the tool turned by only " +
                     format_degrees(geometry.rotation_spread_rad) + " rms; expected at least " +
                     format_degrees(settings.rotation_min_rad) + ": turn the tool to all sides");
  }
  return geometry;
}

}  // namespace glint
