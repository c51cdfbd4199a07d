#include "kernels/cloud/planes.hpp"

#include <cmath>

namespace glint {
Reason PlaneSearch::prepare(const PlaneSettings& settings, int points, Arena& arena) noexcept {
  prepared_ = false;
  if (points < 1 || points > k_cloud_points_max || settings.planes_max < 0 ||
      settings.planes_max > k_planes_max || settings.points_min < 3 ||
      settings.candidates_max < 1 || settings.scored_max < 1 || !(settings.gate.threshold_m > 0) ||
      !std::isfinite(settings.gate.threshold_m) ||
      !(std::abs(settings.gate.normal_cosine_min) <= 1)) {
    return Reason::out_of_range;
  }
  if (!free_.reserve(points, arena) || !plane_of_.reserve(points, arena)) {
    return Reason::not_prepared;
  }
  if (sample_.prepare(arena) != Reason::none) return Reason::not_prepared;
  settings_ = settings;
  capacity_ = points;
  prepared_ = true;
  cloud_ = nullptr;
  count_ = points_ = 0;
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

bool PlaneSearch::step(SliceSize most) noexcept {
  steps_ = 0;
  if (!prepared_ || phase_ == Phase::done) return true;
  steps_ = k_plane_call_steps;
  // End of the items of this call; counts their steps.
  const auto end_of = [&](int all, int steps_each) {
    const int items = std::min(all - at_, most.items_of(steps_each));
    steps_ += items * steps_each;
    return at_ + items;
  };
  switch (phase_) {
    case Phase::list:
      list_free(end_of(points_, k_plane_list_steps));
      if (at_ == points_) next_phase();
      break;
    case Phase::sample:
      draw_sample(end_of(sample_size_, k_plane_draw_steps));
      if (at_ == sample_size_) next_phase();
      break;
    case Phase::tries:
      try_planes(most);
      if (at_ == settings_.candidates_max || scored_ == settings_.scored_max) next_phase();
      break;
    case Phase::fit:
      add_to_fit(end_of(free_count_, k_plane_fit_steps));
      if (at_ == free_count_) finish_fit();
      break;
    case Phase::take:
      assign_points(end_of(free_count_, k_plane_take_steps));
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
      sample_.clear();
      sample_size_ = std::min(free_count_, k_plane_sample);
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
  // Stratified: one random point from each of sample_size_ equal parts, so that none is drawn
  // twice.
  for (; at_ < end; ++at_) {
    const auto part = [&](int i) {
      return static_cast<std::uint64_t>(free_count_) * static_cast<std::uint64_t>(i) /
             static_cast<std::uint64_t>(sample_size_);
    };
    const std::uint64_t first = part(at_), width = part(at_ + 1) - first;
    const std::uint64_t drawn = random_at(settings_.random_seed, count_, at_) % width;
    sample_.add(*cloud_, free_[static_cast<int>(first + drawn)]);
  }
}

void PlaneSearch::try_planes(SliceSize most) noexcept {
  for (int work = 0; work < most.items && steps_ - k_plane_call_steps < most.steps &&
                     at_ < settings_.candidates_max && scored_ < settings_.scored_max;
       ++work, ++at_) {
    steps_ += k_plane_try_steps;
    CandidatePlane candidate;
    const std::uint64_t drawn = random_at(settings_.random_seed, count_, k_plane_sample + at_);
    if (!sample_.candidate_of(drawn, settings_.gate, candidate)) continue;
    ++scored_;
    work += sample_size_;
    steps_ += k_plane_score_steps * sample_size_;
    const int found = sample_.score(candidate, settings_.gate);
    if (found > best_score_) {
      best_score_ = found;
      best_ = candidate;
    }
  }
}

bool PlaneSearch::is_on(const CandidatePlane& plane, int i) const noexcept {
  const float height =
      plane.nx * cloud_->x[i] + plane.ny * cloud_->y[i] + plane.nz * cloud_->z[i] - plane.offset_m;
  const float along = plane.nx * cloud_->normal_x[i] + plane.ny * cloud_->normal_y[i] +
                      plane.nz * cloud_->normal_z[i];
  return std::abs(height) <= settings_.gate.threshold_m &&
         std::abs(along) >= settings_.gate.normal_cosine_min;
}

void PlaneSearch::add_to_fit(int end) noexcept {
  for (; at_ < end; ++at_) {
    const int i = free_[at_];
    if (!is_on(best_, i)) continue;
    if (sums_.n == 0) {
      sum_origin_ = Vector3(static_cast<double>(cloud_->x[i]), static_cast<double>(cloud_->y[i]),
                            static_cast<double>(cloud_->z[i]));
    }
    sums_.add(static_cast<double>(cloud_->x[i]) - sum_origin_.x(),
              static_cast<double>(cloud_->y[i]) - sum_origin_.y(),
              static_cast<double>(cloud_->z[i]) - sum_origin_.z());
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
  const double offset = fitted.normal.dot(sum_origin_ + fitted.mean);
  best_ = {static_cast<float>(fitted.normal.x()), static_cast<float>(fitted.normal.y()),
           static_cast<float>(fitted.normal.z()), static_cast<float>(offset)};
  if (++fits_ < k_plane_fits) return;
  planes_[static_cast<std::size_t>(count_)] = {fitted.normal, offset,
                                               std::sqrt(std::max(fitted.variance, 0.0)), 0};
  phase_ = Phase::take;
}

void PlaneSearch::assign_points(int end) noexcept {
  for (; at_ < end; ++at_) {
    if (!is_on(best_, free_[at_])) continue;
    plane_of_[free_[at_]] = static_cast<std::uint8_t>(count_);
    ++planes_[static_cast<std::size_t>(count_)].points;
  }
}

}  // namespace glint
