#include "kernels/cloud/planes.hpp"

#include <cmath>

#include "kernels/cloud/four_floats.hpp"

namespace glint {
namespace {

FourFloats absolute(const FourFloats& value) {
  return reinterpret_cast<FourFloats>(reinterpret_cast<FourMasks>(value) & 0x7FFFFFFF);
}

}  // namespace

Reason PlaneSearch::prepare(const PlaneSettings& settings, int points, Arena& arena) noexcept {
  prepared_ = false;
  if (points < 1 || points > k_cloud_points_max || settings.planes_max < 0 ||
      settings.planes_max > k_planes_max || settings.points_min < 3 || settings.tries < 1 ||
      settings.scored_max < 1 || !(settings.threshold_m > 0) ||
      !std::isfinite(settings.threshold_m) || !(std::abs(settings.normal_cosine_min) <= 1)) {
    return Reason::out_of_range;
  }
  if (!free_.reserve(points, arena) || !plane_of_.reserve(points, arena)) {
    return Reason::not_prepared;
  }
  for (Column<float>* column : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) {
    if (!column->reserve(k_plane_sample, arena)) return Reason::not_prepared;
  }
  settings_ = settings;
  capacity_ = points;
  prepared_ = true;
  count_ = 0;
  phase_ = Phase::done;
  return Reason::none;
}

void PlaneSearch::begin(const PointCloud& points) noexcept {
  if (!prepared_) return;
  cloud_ = &points;
  points_ = std::min(points.count, capacity_);
  count_ = at_ = free_count_ = 0;
  phase_ = settings_.planes_max > 0 ? Phase::list : Phase::done;
}

Reason PlaneSearch::reason() const noexcept {
  if (!prepared_) return Reason::not_prepared;
  return cloud_ != nullptr && cloud_->count > capacity_ ? Reason::cloud_full : Reason::none;
}

// Steele, Lea and Flood 2014, fig. 13, at the counter's place.
std::uint64_t PlaneSearch::random(std::uint64_t counter) const noexcept {
  const auto stream = static_cast<std::uint64_t>(count_) << 40;
  std::uint64_t z = settings_.seed + (stream + counter + 1) * 0x9E3779B97F4A7C15u;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
}

bool PlaneSearch::step(int most) noexcept {
  if (!prepared_ || phase_ == Phase::done) return true;
  const int wanted = std::max(most, 1);
  const auto end_of = [&](int all) { return std::min(all, at_ + wanted); };
  switch (phase_) {
    case Phase::list:
      list_free(end_of(points_));
      if (at_ == points_) next_phase();
      break;
    case Phase::sample:
      draw_sample(end_of(sample_count_));
      if (at_ == sample_count_) next_phase();
      break;
    case Phase::tries:
      try_planes(wanted);
      if (at_ == settings_.tries || scored_ == settings_.scored_max) next_phase();
      break;
    case Phase::fit:
      add_to_fit(end_of(free_count_));
      if (at_ == free_count_) finish_fit();
      break;
    case Phase::take:
      take_points(end_of(free_count_));
      if (at_ == free_count_) next_phase();
      break;
    case Phase::done:
      break;
  }
  return phase_ == Phase::done;
}

void PlaneSearch::next_phase() noexcept {
  at_ = 0;
  switch (phase_) {
    case Phase::list:
      sample_count_ = std::min(free_count_, k_plane_sample);
      phase_ = free_count_ < settings_.points_min ? Phase::done : Phase::sample;
      break;
    case Phase::sample:
      scored_ = best_score_ = fits_ = 0;
      phase_ = Phase::tries;
      break;
    case Phase::tries:
      sums_ = {};
      phase_ = best_score_ == 0 ? Phase::done : Phase::fit;
      break;
    case Phase::take:
      ++count_;
      free_count_ = 0;
      phase_ = count_ == settings_.planes_max ? Phase::done : Phase::list;
      break;
    default:
      break;
  }
}

void PlaneSearch::list_free(int end) noexcept {
  for (; at_ < end; ++at_) {
    if (count_ == 0) plane_of_[at_] = k_no_plane;
    const bool has_normal =
        cloud_->normal_x[at_] != 0 || cloud_->normal_y[at_] != 0 || cloud_->normal_z[at_] != 0;
    free_[free_count_] = at_;
    free_count_ += has_normal && plane_of_[at_] == k_no_plane ? 1 : 0;
  }
}

void PlaneSearch::draw_sample(int end) noexcept {
  // One out of each of as many equal parts: no point twice.
  for (; at_ < end; ++at_) {
    const auto part = [&](int i) {
      return static_cast<std::uint64_t>(free_count_) * static_cast<std::uint64_t>(i) /
             static_cast<std::uint64_t>(sample_count_);
    };
    const std::uint64_t first = part(at_), width = part(at_ + 1) - first;
    const std::uint64_t drawn = random(static_cast<std::uint64_t>(at_)) % width;
    const int point = free_[static_cast<int>(first + drawn)];
    x_[at_] = cloud_->x[point], y_[at_] = cloud_->y[point], z_[at_] = cloud_->z[point];
    nx_[at_] = cloud_->normal_x[point], ny_[at_] = cloud_->normal_y[point];
    nz_[at_] = cloud_->normal_z[point];
  }
}

// The plane through three points of the sample, if their normals are its own.
bool PlaneSearch::candidate_of(int attempt, Candidate& out) const noexcept {
  const std::uint64_t drawn = random(k_plane_sample + static_cast<std::uint64_t>(attempt));
  const auto pick = [&](int shift) {
    const std::uint64_t part = drawn >> shift & 0xFFFFF;  // 20 bits for at most 2,048 points
    return static_cast<int>(part * static_cast<std::uint64_t>(sample_count_) >> 20);
  };
  const int a = pick(0), b = pick(20), c = pick(40);
  const float ux = x_[b] - x_[a], uy = y_[b] - y_[a], uz = z_[b] - z_[a];
  const float vx = x_[c] - x_[a], vy = y_[c] - y_[a], vz = z_[c] - z_[a];
  const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
  const float least = settings_.normal_cosine_min * length;
  // Also false for points on a line, whose length is zero, and for what is no number.
  for (const int i : {a, b, c}) {
    const float along = std::abs(nx * nx_[i] + ny * ny_[i] + nz * nz_[i]);
    if (!(along >= least && length > 0)) return false;
  }
  out = {nx / length, ny / length, nz / length, 0};
  out.offset = out.nx * x_[a] + out.ny * y_[a] + out.nz * z_[a];
  return true;
}

int PlaneSearch::score(const Candidate& plane) const noexcept {
  const FourFloats nx = all_four(plane.nx), ny = all_four(plane.ny), nz = all_four(plane.nz);
  const FourFloats threshold = all_four(settings_.threshold_m);
  const FourFloats cosine = all_four(settings_.normal_cosine_min);
  FourMasks on{};
  for (int i = 0; i < sample_count_; i += 4) {
    const FourFloats height = nx * load_four(x_.data() + i) + ny * load_four(y_.data() + i) +
                              nz * load_four(z_.data() + i) - plane.offset;
    const FourFloats along = nx * load_four(nx_.data() + i) + ny * load_four(ny_.data() + i) +
                             nz * load_four(nz_.data() + i);
    on += (absolute(height) <= threshold) & (absolute(along) >= cosine) &
          first_lanes(sample_count_ - i);
  }
  return count_of(on);
}

void PlaneSearch::try_planes(int most) noexcept {
  for (int work = 0; work < most && at_ < settings_.tries && scored_ < settings_.scored_max;
       ++work, ++at_) {
    Candidate candidate;
    if (!candidate_of(at_, candidate)) continue;
    ++scored_;
    work += sample_count_;
    const int found = score(candidate);
    if (found > best_score_) {
      best_score_ = found;
      best_ = candidate;
    }
  }
}

bool PlaneSearch::is_on(const Candidate& plane, int i) const noexcept {
  const float height =
      plane.nx * cloud_->x[i] + plane.ny * cloud_->y[i] + plane.nz * cloud_->z[i] - plane.offset;
  const float along = plane.nx * cloud_->normal_x[i] + plane.ny * cloud_->normal_y[i] +
                      plane.nz * cloud_->normal_z[i];
  return std::abs(height) <= settings_.threshold_m &&
         std::abs(along) >= settings_.normal_cosine_min;
}

void PlaneSearch::add_to_fit(int end) noexcept {
  for (; at_ < end; ++at_) {
    const int i = free_[at_];
    if (!is_on(best_, i)) continue;
    if (sums_.n == 0) {
      around_ = Vector3(static_cast<double>(cloud_->x[i]), static_cast<double>(cloud_->y[i]),
                        static_cast<double>(cloud_->z[i]));
    }
    sums_.add(static_cast<double>(cloud_->x[i]) - around_.x(),
              static_cast<double>(cloud_->y[i]) - around_.y(),
              static_cast<double>(cloud_->z[i]) - around_.z());
  }
}

void PlaneSearch::finish_fit() noexcept {
  at_ = 0;
  if (sums_.n < settings_.points_min) {
    phase_ = Phase::done;
    return;
  }
  const FittedPlane fitted = fit_plane(sums_);
  sums_ = {};
  const double offset = fitted.normal.dot(around_ + fitted.mean);
  best_ = {static_cast<float>(fitted.normal.x()), static_cast<float>(fitted.normal.y()),
           static_cast<float>(fitted.normal.z()), static_cast<float>(offset)};
  if (++fits_ < k_plane_fits) return;
  planes_[static_cast<std::size_t>(count_)] = {fitted.normal, offset,
                                               std::sqrt(std::max(fitted.variance, 0.0)), 0};
  phase_ = Phase::take;
}

void PlaneSearch::take_points(int end) noexcept {
  for (; at_ < end; ++at_) {
    if (!is_on(best_, free_[at_])) continue;
    plane_of_[free_[at_]] = static_cast<std::uint8_t>(count_);
    ++planes_[static_cast<std::size_t>(count_)].points;
  }
}

int snap_to_planes(const PlaneSearch& planes, int from, int most, PointCloud& points) noexcept {
  const int end = std::min(points.count, from + std::max(most, 0));
  for (int i = from; i < end; ++i) {
    const std::uint8_t on = planes.plane_of(i);
    if (on == PlaneSearch::k_no_plane) continue;
    const Plane& plane = planes.plane(on);
    const Vector3 point(static_cast<double>(points.x[i]), static_cast<double>(points.y[i]),
                        static_cast<double>(points.z[i]));
    const Vector3 moved = point - (plane.normal.dot(point) - plane.offset_m) * plane.normal;
    points.x[i] = static_cast<float>(moved.x());
    points.y[i] = static_cast<float>(moved.y());
    points.z[i] = static_cast<float>(moved.z());
    points.normal_x[i] = static_cast<float>(plane.normal.x());
    points.normal_y[i] = static_cast<float>(plane.normal.y());
    points.normal_z[i] = static_cast<float>(plane.normal.z());
  }
  return end;
}

}  // namespace glint
