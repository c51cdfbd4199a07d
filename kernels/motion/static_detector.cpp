#include "kernels/motion/static_detector.hpp"

#include <algorithm>
#include <limits>

#include "kernels/motion/cholesky.hpp"
#include "kernels/motion/interpolate.hpp"
#include "kernels/motion/motion_filter.hpp"

namespace glint {
namespace {

constexpr double k_axes = 6;
// Lower limit of a hand's tremor, each axis: 0.05 mm rms at about 8 Hz, which surgeons reach under
// a microscope; at 0.1 m from the grip it is 0.0005 rad. The mean of a hundred frames has a smaller
// standard deviation, but the tool at any one time is not that close to the mean.
constexpr double k_tremor_m = 0.00005, k_tremor_rad = 0.0005;

}  // namespace

void StaticDetector::restart(const UncertainPose& only, StaticWindowSums& sums) {
  anchor_ = only.pose;
  time_ = only.time;
  sums[newest_ + 1] = Sum{};
  sums[newest_ + 2] = {Vector6::Zero(), only.covariance, only.time};
  newest_ = (newest_ + 2) % StaticWindowSums::k_size;
  kept_ = frames_ = 1;
}

const StaticDetector::Sum& StaticDetector::sum_before(int frames,
                                                      const StaticWindowSums& sums) const {
  return sums[newest_ - frames + StaticWindowSums::k_size];
}

StaticDetector::Sum StaticDetector::newest(int frames, const StaticWindowSums& sums) const {
  const Sum& all = sum_before(0, sums);
  const Sum& before = sum_before(frames, sums);
  return {all.place - before.place, all.covariance - before.covariance, all.time};
}

StaticDetector::Halves StaticDetector::halves(int frames, const StaticWindowSums& sums) const {
  const int newer_frames = frames / 2;
  const double newer_share = 1.0 / newer_frames;
  const double older_share = 1.0 / (frames - newer_frames);
  const Sum all = newest(frames, sums);
  const Sum newer = newest(newer_frames, sums);
  const Sum older{all.place - newer.place, all.covariance - newer.covariance, newer.time};
  const Cholesky<6> factor(newer_share * newer_share * newer.covariance +
                           older_share * older_share * older.covariance +
                           halves_covariance(correlated_, times_, seconds_of(frames, sums)));
  const Vector6 difference = newer_share * newer.place - older_share * older.place;
  if (!factor.positive) return {difference, std::numeric_limits<double>::infinity()};
  return {difference, factor.squared_length(difference)};
}

int StaticDetector::push(Time time, const Sum& added, const StaticDetectorSettings& settings,
                         StaticWindowSums& sums) {
  const Sum& before = sum_before(0, sums);
  const Sum after{before.place + added.place, before.covariance + added.covariance, time};
  newest_ = (newest_ + 1) % StaticWindowSums::k_size;
  sums[newest_] = after;
  time_ = time;
  kept_ = std::min(kept_ + 1, k_static_frames_max);
  frames_ = 1;
  int tests = 0;
  for (int level = k_static_window_levels - 1; level >= 0; --level) {
    // n, 3/4 n, 1/2 n, 3/8 n ..
    const int frames = level % 2 == 0 ? kept_ >> level / 2 : 3 * kept_ >> (level / 2 + 2);
    if (frames < 2) continue;
    const bool is_short = frames <= settings.frames_min;
    const double limit = is_short ? settings.short_chi_square_max : settings.long_chi_square_max;
    ++tests;
    if (!(halves(frames, sums).chi_square <= limit)) {
      kept_ = is_short ? frames_ : kept_ - kept_ / 8;
      break;
    }
    frames_ = frames;
  }
  return tests;
}

int StaticDetector::add(const UncertainPose& measured, const CorrelatedErrors& correlated,
                        const StaticDetectorSettings& settings, StaticWindowSums& sums) noexcept {
  frames_min_ = settings.frames_min;
  drift_chi_square_ = settings.drift_chi_square;
  correlated_ = correlated;
  times_ = settings.correlation;
  Vector6 place = pose_difference(measured.pose, anchor_);
  const bool near = place.head<3>().norm() <= k_window_translation_max_m &&
                    place.tail<3>().norm() <= k_window_rotation_max_rad;
  if (kept_ == 0 || !near || measured.time - time_ > settings.gap_max) {
    restart(measured, sums);
    return 0;
  }
  const int tests =
      push(measured.time, {place, measured.covariance, measured.time}, settings, sums);
  // In motion the newest pose becomes the anchor.
  if (kept_ == 1) restart(measured, sums);
  return tests;
}

double StaticDetector::seconds_of(int frames, const StaticWindowSums& sums) const {
  return (sum_before(0, sums).time - sum_before(frames - 1, sums).time).seconds();
}

Matrix6 StaticDetector::correlated(const StaticWindowSums& sums) const noexcept {
  return covariance_of_mean(correlated_, times_, is_static() ? seconds_of(frames_, sums) : 0.0);
}

Pose StaticDetector::placed(const Vector6& place) const {
  return {(from_rotation_vector(place.tail<3>()) * anchor_.rotation).normalized(),
          anchor_.translation + place.head<3>()};
}

StaticEstimate StaticDetector::rest(const StaticWindowSums& sums) const noexcept {
  const double share = 1.0 / frames_;
  const Sum all = newest(frames_, sums);
  const Matrix6 mean_covariance = share * share * all.covariance;
  const Halves cut = halves(frames_, sums);
  // A steady drift moves the halves' means apart by its speed times half the window's duration, and
  // the newest frame from the mean by as much. Without drift the difference has four times the
  // mean's covariance. A significant excess is drift, shrunk by its ratio to the limit.
  const double drifting =
      cut.chi_square > drift_chi_square_ ? 1 - drift_chi_square_ / cut.chi_square : 0.0;
  const double unseen = cut.chi_square > k_axes ? 1 - k_axes / cut.chi_square : 0.0;
  const double left = (1 - drifting) * (1 - drifting) * unseen;
  StaticEstimate rest;
  rest.pose.time = time_;
  rest.pose.pose = placed(share * all.place + drifting * cut.difference);
  rest.pose.covariance = (1 + 4 * drifting * drifting) * mean_covariance +
                         left * (cut.difference * cut.difference.transpose());
  for (int i = 0; i < 3; ++i) {
    rest.pose.covariance(i, i) += k_tremor_m * k_tremor_m;
    rest.pose.covariance(3 + i, 3 + i) += k_tremor_rad * k_tremor_rad;
  }
  const double per_s = 2 / seconds_of(frames_, sums);
  rest.drift_per_s = (drifting * per_s) * cut.difference;
  rest.drift_covariance = (4 * per_s * per_s) * mean_covariance;
  return rest;
}

}  // namespace glint
