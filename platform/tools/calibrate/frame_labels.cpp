#include "platform/tools/calibrate/frame_labels.hpp"

#include <algorithm>
#include <limits>
#include <memory>

#include "kernels/pose/correspond.hpp"

namespace glint {
namespace {

constexpr int k_initial_labelings_max =
    6;  // alternative labelings of the first frame that are followed
constexpr double k_linked_share = 0.6;  // of a frame's points
constexpr double k_found_share = 0.95;  // of the largest marker count of any initial labeling

CorrespondSettings settings_for(const Tool& tool, double noise_m) {
  CorrespondSettings settings = settings_for_points();
  settings.range_sigma_m = noise_m;
  settings.delta_min_m = 2 * noise_m;
  settings.max_rms_m = 4 * noise_m;
  settings.prior_gate_m = 0.05;
  settings.min_markers_without_prior = std::min(4, tool.marker_count);
  return settings;
}

double nearest(const Vector3& point, const std::vector<Vector3>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vector3& other : others) least = std::min(least, (other - point).norm());
  return least;
}

bool linked(const PointFrame& a, const PointFrame& b, double step_max_m) {
  int near = 0;
  for (const Vector3& point : b.points_m) near += nearest(point, a.points_m) <= step_max_m ? 1 : 0;
  return near >= 3 && near >= k_linked_share * static_cast<double>(b.points_m.size());
}

class Labeller {
 public:
  Labeller(std::span<const PointFrame> frames, const Tool& tool, double noise_m)
      : frames_(frames), tool_(as_points(tool)), settings_(settings_for(tool, noise_m)) {}

  const Labelings& propose(std::size_t frame, const Pose* prior) {
    propose_labelings(markers_from_points(frames_[frame].points_m), tool_, settings_, prior,
                      *scratch_, *found_);
    return *found_;
  }

  // Propagates the labels of `first` (frame `begin`) to the segment's end.
  std::vector<Labeling> follow(const Segment& segment, std::size_t begin, const Labeling& first) {
    std::vector<Labeling> labels(segment.length());
    labels[begin - segment.begin] = first;
    Pose prior = first.T_camera_tool;
    for (std::size_t f = begin + 1; f < segment.end; ++f) {
      const Labelings& found = propose(f, &prior);
      if (found.count == 0) continue;
      labels[f - segment.begin] = found.items[0];
      prior = found.items[0].T_camera_tool;
    }
    return labels;
  }

 private:
  std::span<const PointFrame> frames_;
  Tool tool_;
  CorrespondSettings settings_;
  std::unique_ptr<CorrespondScratch> scratch_ = std::make_unique<CorrespondScratch>();
  std::unique_ptr<Labelings> found_ = std::make_unique<Labelings>();
};

struct Score {
  int markers = 0;
  double mean_square = std::numeric_limits<double>::infinity();
};

Score score_of(const std::vector<Labeling>& labels) {
  Score score;
  double squares = 0, degrees_of_freedom = 0;
  for (const Labeling& label : labels) {
    score.markers += label.count;
    squares += label.count * label.rms_m * label.rms_m;
    if (label.count > 0) degrees_of_freedom += 3.0 * label.count - 6;
  }
  if (degrees_of_freedom > 0) score.mean_square = squares / degrees_of_freedom;
  return score;
}

}  // namespace

std::vector<Segment> segments_of(std::span<const PointFrame> frames, double step_max_m) {
  std::vector<Segment> segments;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (f == 0 || !linked(frames[f - 1], frames[f], step_max_m)) segments.push_back({f, f});
    segments.back().end = f + 1;
  }
  return segments;
}

std::vector<Labeling> label_segment(std::span<const PointFrame> frames, const Segment& segment,
                                    const Tool& tool, double noise_m) {
  Labeller labeller(frames, tool, noise_m);
  std::vector<Labeling> initial_labelings;
  std::size_t begin = segment.begin;
  for (; begin < segment.end && initial_labelings.empty(); ++begin) {
    const Labelings& found = labeller.propose(begin, nullptr);
    const int ways = std::min(found.count, k_initial_labelings_max);
    initial_labelings.assign(found.items.begin(), found.items.begin() + ways);
  }
  std::vector<Labeling> best(segment.length());
  Score best_score;
  for (const Labeling& first : initial_labelings) {
    std::vector<Labeling> labels = labeller.follow(segment, begin - 1, first);
    const Score score = score_of(labels);
    const bool as_many = score.markers >= k_found_share * best_score.markers;
    const bool more = score.markers * k_found_share > best_score.markers;
    if (more || (as_many && score.mean_square < best_score.mean_square)) {
      best = std::move(labels);
      best_score = score;
    }
  }
  return best;
}

}  // namespace glint
