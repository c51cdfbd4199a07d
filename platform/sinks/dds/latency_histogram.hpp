// Quantiles of an unlimited number of latencies in fixed memory: histogram with bins of 10 us up to
// 1 s, and the exact maximum.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/units.hpp"

namespace glint {

class LatencyHistogram {
 public:
  void add(Duration latency) {
    const std::int64_t bucket = std::clamp<std::int64_t>(
        latency.nanoseconds / k_bucket_ns, 0, static_cast<std::int64_t>(buckets_.size()) - 1);
    ++buckets_[static_cast<std::size_t>(bucket)];
    ++count_;
    max_ns_ = std::max(max_ns_, latency.nanoseconds);
  }
  // Upper edge of the quantile's bin, at most the maximum; 0 if empty.
  [[nodiscard]] double quantile_us(double fraction) const {
    const double wanted = fraction * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < buckets_.size() && count_ > 0; ++i) {
      seen += buckets_[i];
      if (static_cast<double>(seen) >= wanted && seen > 0) {
        return std::min(static_cast<double>(i + 1) * k_bucket_ns * 1e-3, max_us());
      }
    }
    return 0;
  }
  [[nodiscard]] double max_us() const { return static_cast<double>(max_ns_) * 1e-3; }

 private:
  static constexpr std::int64_t k_bucket_ns = 10'000;
  std::vector<std::uint64_t> buckets_ = std::vector<std::uint64_t>(100'000);
  std::uint64_t count_ = 0;
  std::int64_t max_ns_ = 0;
};

}  // namespace glint
