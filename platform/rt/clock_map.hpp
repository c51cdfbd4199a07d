// A device's clock against this machine's: offset and drift from when stamped things arrive.
//
// What:     maps a device's stamp to this machine's monotonic clock.
// How:      a transport's delay is never less than its earliest. In each of the newest k_bins
//           seconds the least difference of arrival and stamp is kept. A line fitted to these has
//           the drift for its slope; moved down to the lowest of them it has the earliest delay. A
//           stamp that leaves the line by more than k_step is refused; after k_agreeing refused
//           ones in a row that agree among themselves the device's clock was set anew, and the
//           estimate starts again.
// Cost:     k_bins steps a stamp; no heap.
// Accuracy: delays that vary by 5 ms: 0.1 to 0.3 ms rms at 45 stamps a second, 0.8 ms at 5, the
// first
//           seconds included, in which a stamp is off by up to its own delay.
// Source:   a line beneath all delays: Moon, Skelly, Towsley, "Estimation and removal of clock skew
//           from network delay measurements" (1999); here beneath the least of each second.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "kernels/units.hpp"

namespace glint {

class ClockMap {
 public:
  static constexpr int k_bins = 32;
  static constexpr Duration k_bin = milliseconds(1000);
  static constexpr Duration k_step = milliseconds(200);
  static constexpr int k_agreeing = 8;
  static constexpr Duration k_delay_sigma = milliseconds(5);  // beyond the earliest
  static constexpr double k_drift_max = 500e-6;               // of crystals: tens of ppm

  // `earliest_delay`: from the stamp to the arrival, as the sensor declares it.
  explicit ClockMap(Duration earliest_delay) : earliest_delay_(earliest_delay) {}

  // The stamp by this machine's clock, never after its arrival; nothing: refused.
  [[nodiscard]] std::optional<Time> map(Time stamp, Time arrival) noexcept;

  [[nodiscard]] double drift() const noexcept { return slope_; }  // device seconds gained a second
  // One sigma of what map() returned last: the scatter of the seconds' least delays, and an n-th of
  // k_delay_sigma, by which the least of n delays lies above the earliest.
  [[nodiscard]] Duration uncertainty() const noexcept;
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }
  [[nodiscard]] std::uint64_t restarts() const noexcept { return restarts_; }

 private:
  struct Bin {
    std::int64_t number = -1;  // second of the device's clock since the origin
    double x_s = 0, y_s = 0;   // of the least difference: stamp and difference, from the origin
  };
  void begin(Time stamp, Time arrival) noexcept;
  void fit() noexcept;
  [[nodiscard]] double x_of(Time stamp) const noexcept { return (stamp - origin_).seconds(); }

  Duration earliest_delay_;
  bool begun_ = false;
  Time origin_;    // device
  Duration base_;  // arrival - stamp at the origin
  std::array<Bin, k_bins> bins_{};
  double slope_ = 0, height_s_ = 0, middle_s_ = 0;  // y = height + slope (x - middle)
  double scatter_s_ = 0;                            // of the bins' least differences about the line
  std::int64_t mapped_ = 0;                         // stamps since the beginning
  std::uint64_t refused_ = 0, restarts_ = 0;
  int refused_in_row_ = 0;
  Duration refused_difference_;
};

}  // namespace glint
