#include "platform/tools/inspect/label_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/motion/interpolate.hpp"
#include "kernels/pose/chi_square_limit.hpp"
#include "platform/runtime/session/gross.hpp"

namespace glint {
namespace {

constexpr double k_infinite = std::numeric_limits<double>::infinity();
// Cost of a jump that no hand makes: two unrelated labelings.
constexpr double k_jump = 60;
constexpr double k_noise_sigmas = 6;

using Costs = std::array<double, k_labelings_max>;

double rotation_between_rad(const Pose& a, const Pose& b) {
  return rotation_vector(a.rotation * b.rotation.conjugate()).norm();
}

class Paths {
 public:
  Paths(std::span<const LabeledFrame> frames, const Tool& tool, const PathSettings& settings)
      : frames_(frames), tool_(tool), settings_(settings), own_(frames.size()) {
    double square = 0;
    for (int i = 0; i < tool.marker_count; ++i)
      square += (tool.markers_m[static_cast<std::size_t>(i)] - tool.middle_m()).squaredNorm();
    radius_m_ = std::sqrt(square / tool.marker_count);
    const double ratio = settings.sigma_m / settings.repeated_error_m;
    const double frames_max = ratio * ratio;
    for (std::size_t begin = 0; begin < frames.size();) {
      std::size_t end = begin + 1;
      while (end < frames.size() && linked(end)) ++end;
      const double share = std::min(1.0, frames_max / static_cast<double>(end - begin));
      for (; begin < end; ++begin) own_[begin] = own_costs(frames[begin], share);
    }
  }

  [[nodiscard]] std::vector<PathChoice> choose() const {
    const std::vector<Costs> before = pass(1), after = pass(-1);
    std::vector<PathChoice> choices(frames_.size());
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      const std::size_t count = states(f);
      const auto total = [&](std::size_t k) { return before[f][k] + after[f][k] + own_[f][k]; };
      PathChoice& choice = choices[f];
      for (std::size_t k = 0; k < count; ++k) {
        if (choice.chosen < 0 || total(k) < total(static_cast<std::size_t>(choice.chosen)))
          choice.chosen = static_cast<int>(k);
      }
      if (choice.chosen < 0) continue;
      const auto best = static_cast<std::size_t>(choice.chosen);
      choice.margin = k_infinite;
      for (std::size_t k = 0; k < count; ++k) {
        if (differ(frames_[f].labelings[best].T_camera_tool, frames_[f].labelings[k].T_camera_tool))
          choice.margin = std::min(choice.margin, total(k) - total(best));
      }
      if (is_isolated(f, best)) choice.margin = 0;
    }
    return choices;
  }

 private:
  [[nodiscard]] std::size_t states(std::size_t f) const {
    return std::min(frames_[f].labelings.size(), static_cast<std::size_t>(k_labelings_max));
  }

  // Returns whether the time since the previous frame is too short for a rotation by 180 degrees.
  [[nodiscard]] bool linked(std::size_t f) const {
    const double seconds = (frames_[f].time - frames_[f - 1].time).seconds();
    return settings_.angular_speed_max_rad_s * seconds < std::numbers::pi;
  }

  [[nodiscard]] Costs own_costs(const LabeledFrame& frame, double share) const {
    Costs costs{};
    int count_max = 0;
    for (const Labeling& labeling : frame.labelings)
      count_max = std::max(count_max, labeling.count);
    for (std::size_t k = 0; k < std::min(frame.labelings.size(), costs.size()); ++k) {
      const Labeling& labeling = frame.labelings[k];
      const double sigmas = labeling.rms_m / settings_.sigma_m;
      costs[k] = share * labeling.count * sigmas * sigmas +
                 chi_square_limit(3) * (count_max - labeling.count);
    }
    return costs;
  }

  [[nodiscard]] bool can_follow(const Labeling& a, const Labeling& b, double seconds) const {
    const Vector3 middle = tool_.middle_m();
    const double noise_m = k_noise_sigmas * settings_.sigma_m;
    const double moved = (a.T_camera_tool * middle - b.T_camera_tool * middle).norm();
    if (moved > settings_.speed_max_m_s * seconds + noise_m) return false;
    return rotation_between_rad(a.T_camera_tool, b.T_camera_tool) <=
           settings_.angular_speed_max_rad_s * seconds + noise_m / radius_m_;
  }

  // Cost of a step between two frames' labelings, in either order.
  [[nodiscard]] double step_cost(std::size_t f, std::size_t k, std::size_t other,
                                 std::size_t l) const {
    const double seconds = std::abs((frames_[f].time - frames_[other].time).seconds());
    if (settings_.angular_speed_max_rad_s * seconds >= std::numbers::pi) return 0;
    const bool follows = can_follow(frames_[f].labelings[k], frames_[other].labelings[l], seconds);
    return follows ? 0 : k_jump;
  }

  // Least cost of all frames on one side of each labeling. direction 1: before it, -1: after it.
  [[nodiscard]] std::vector<Costs> pass(int direction) const {
    std::vector<Costs> costs(frames_.size());
    std::size_t last = frames_.size();  // the previous frame with labelings
    for (std::size_t n = 0; n < frames_.size(); ++n) {
      const std::size_t f = direction > 0 ? n : frames_.size() - 1 - n;
      if (states(f) == 0) continue;
      for (std::size_t k = 0; last < frames_.size() && k < states(f); ++k) {
        costs[f][k] = k_infinite;
        for (std::size_t l = 0; l < states(last); ++l)
          costs[f][k] =
              std::min(costs[f][k], costs[last][l] + own_[last][l] + step_cost(f, k, last, l));
      }
      last = f;
    }
    return costs;
  }

  // Returns whether both neighbours have labelings, but none can lead here.
  [[nodiscard]] bool is_isolated(std::size_t f, std::size_t k) const {
    for (const std::size_t other : {f - 1, f + 1}) {
      if (other >= frames_.size() || states(other) == 0) return false;
      for (std::size_t l = 0; l < states(other); ++l)
        if (step_cost(f, k, other, l) == 0) return false;
    }
    return true;
  }

  [[nodiscard]] bool differ(const Pose& a, const Pose& b) const {
    return (a * tool_.tip_m - b * tool_.tip_m).norm() > k_gross_misassigned_m ||
           rotation_between_rad(a, b) > k_gross_angle_rad;
  }

  std::span<const LabeledFrame> frames_;
  const Tool& tool_;
  const PathSettings& settings_;
  std::vector<Costs> own_;
  double radius_m_ = 0;
};

}  // namespace

std::vector<PathChoice> choose_path(std::span<const LabeledFrame> frames, const Tool& tool,
                                    const PathSettings& settings) {
  return Paths(frames, tool, settings).choose();
}

}  // namespace glint
