// Clock synchronisation with a device: offset and drift from the arrival times of its time stamps.
//
// What:     maps a device's time stamp to this machine's monotonic clock.
// How:      a transport delay is never shorter than the earliest delay. Each of the newest k_bins
//           seconds keeps its minimum difference of arrival and stamp. A line fitted to these
//           minima has the drift as its slope; moved down to the lowest of them it has the earliest
//           delay. A stamp farther than k_step from the line is refused. After k_agreeing
//           consecutive refused stamps whose delays agree within k_agree, the device's clock was
//           set, and the estimate restarts. Stamps that waited in a stalled network arrive at once:
//           their delays fall by a gap each and do not agree.
// Cost:     k_bins steps a stamp; no heap.
// Accuracy: delays that vary by 5 ms: 0.1 to 0.3 ms rms at 45 stamps a second, 0.8 ms at 5. This
//           includes the first seconds, in which the error is up to the stamp's own delay.
// Source:   a line beneath all delays: Moon, Skelly, Towsley, "Estimation and removal of clock skew
//           from network delay measurements" (1999); here beneath the minimum of each second.
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
  static constexpr Duration k_agree = milliseconds(100);
  static constexpr Duration k_delay_sigma = milliseconds(5);  // beyond the earliest
  static constexpr double k_drift_max = 500e-6;               // crystals have tens of ppm

  // `earliest_delay`: minimum from the stamp to the arrival, as declared for the sensor.
  explicit ClockMap(Duration earliest_delay) : earliest_delay_(earliest_delay) {}

  // The stamp on this machine's clock, at most its arrival; nothing if refused.
  [[nodiscard]] std::optional<Time> map(Time stamp, Time arrival) noexcept;

  [[nodiscard]] double drift() const noexcept { return slope_; }  // d(arrival - stamp) / d stamp
  // One sigma of map()'s last result: the scatter of the bins' minima, and k_delay_sigma / n, the
  // expected excess of the minimum of n delays.
  [[nodiscard]] Duration uncertainty() const noexcept;
  [[nodiscard]] std::uint64_t refused() const noexcept { return refused_; }
  [[nodiscard]] std::uint64_t restarts() const noexcept { return restarts_; }

 private:
  struct Bin {
    std::int64_t number = -1;  // second on the device's clock since the origin
    double x_s = 0, y_s = 0;   // stamp and difference at the minimum, from the origin
  };
  void begin(Time stamp, Time arrival) noexcept;
  void fit() noexcept;
  [[nodiscard]] double x_of(Time stamp) const noexcept { return (stamp - origin_).seconds(); }

  Duration earliest_delay_;
  bool begun_ = false;
  Time origin_;    // device
  Duration base_;  // arrival - stamp at the origin
  std::array<Bin, k_bins> bins_{};
  double slope_ = 0, offset_s_ = 0, mean_s_ = 0;  // y = height + slope (x - middle)
  double scatter_s_ = 0;                          // of the bins' minima about the line
  std::int64_t mapped_ = 0;                       // stamps since the last restart
  std::uint64_t refused_ = 0, restarts_ = 0;
  int refused_in_row_ = 0;
  Duration refused_difference_;  // of the first one in the row
};

}  // namespace glint
