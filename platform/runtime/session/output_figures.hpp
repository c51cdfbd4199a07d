// Output statistics by frame rate: states, age and, if there is ground truth, the error.
//
// The frame rate of a tick follows from the larger of two times: between the two newest frames, or
// since the newest one. Nominal: up to 1.5 camera periods; reduced: up to 4.5; low: above.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "kernels/limits.hpp"
#include "kernels/wire/pose_sample.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

// True T_world_tool of the cell's tool at a session time; nullopt: no ground truth.
using GroundTruthOfTool = std::function<std::optional<Pose>(int tool, Time time)>;

inline constexpr int k_frame_rates = 3;    // nominal, reduced, low
inline constexpr int k_age_bins = 512;     // bins of 1 ms; the last one holds all larger values
inline constexpr int k_error_bins = 2048;  // bins of 0.1 mm; likewise

// Errors of poses with ground truth, at the time that they are predicted to, in the pose's frame.
struct OutputErrors {
  std::uint64_t count = 0, inside_position = 0, inside_rotation = 0;  // the stated 95 % ellipsoid
  std::uint64_t gross = 0;                                            // gross.hpp
  double square_m2 = 0, square_rad2 = 0;                              // sums of squared errors
  // Sums of the traces of the stated covariances and of their random parts.
  double stated_m2 = 0, stated_rad2 = 0, random_m2 = 0, random_rad2 = 0;
  double log_score = 0;  // sum of -ln of the stated Gaussian density at the true pose, in m and rad
  double largest_m = 0;
  std::array<std::uint64_t, k_error_bins> histogram{};
};

struct RateStatistics {
  std::uint64_t ticks = 0, measured = 0, predicted = 0;  // the others had no pose
  std::array<std::uint64_t, k_age_bins> ages{};          // of poses
  double largest_age_sigma_s = 0;
  OutputErrors of_measured, of_predicted;
};

struct OutputByRate {
  std::array<std::uint64_t, k_frame_rates> gaps{};  // between frames
  std::array<double, k_frame_rates> seconds{};      // total time
  std::array<std::array<RateStatistics, k_frame_rates>, k_tools_max> tools{};
};

// The given quantile of a histogram, in bins.
[[nodiscard]] double quantile(std::span<const std::uint64_t> counts, double share);

class OutputStatistics {
 public:
  // Requires that the simulator's world is the cell's and that its reference body is the cell's
  // reference tool.
  OutputStatistics(const Cell& cell, GroundTruthOfTool truth);

  // Call once per sample, in the order of the ticks. `newest_frame`: arrival of the newest frame at
  // that time; nullopt before the first.
  void add(const PoseSample& sample, std::optional<Time> newest_frame);

  [[nodiscard]] const OutputByRate& figures() const { return figures_; }

 private:
  void judge(const PoseSample& sample, OutputErrors& errors);
  [[nodiscard]] std::optional<Pose> true_tip(const PoseSample& sample) const;
  [[nodiscard]] int rate_of(Duration gap) const;

  const Cell& cell_;
  GroundTruthOfTool truth_;
  std::optional<Time> newest_;
  Duration gap_;
  OutputByRate figures_;
};

}  // namespace glint
