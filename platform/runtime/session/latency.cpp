#include "platform/runtime/session/latency.hpp"

#include <algorithm>
#include <cmath>

namespace glint {
namespace {

LatencyFigures figures(std::vector<std::int64_t> nanoseconds) {
  LatencyFigures result;
  result.n = static_cast<std::int64_t>(nanoseconds.size());
  if (nanoseconds.empty()) return result;
  std::sort(nanoseconds.begin(), nanoseconds.end());
  const auto rank = [&](double part) {
    const auto at =
        static_cast<std::size_t>(std::ceil(part * static_cast<double>(nanoseconds.size())) - 1.0);
    return static_cast<double>(nanoseconds[std::min(at, nanoseconds.size() - 1)]) * 1e-3;
  };
  result.p50_us = rank(0.50);
  result.p99_us = rank(0.99);
  result.p99_9_us = rank(0.999);
  result.max_us = static_cast<double>(nanoseconds.back()) * 1e-3;
  return result;
}

}  // namespace

LatencyFigures figures_of(const std::vector<FrameToCan>& entries, Duration FrameToCan::*part) {
  std::vector<std::int64_t> nanoseconds;
  for (const FrameToCan& entry : entries) nanoseconds.push_back((entry.*part).nanoseconds);
  return figures(std::move(nanoseconds));
}

LatencyFigures figures_of_totals(const std::vector<FrameToCan>& entries) {
  std::vector<std::int64_t> nanoseconds;
  for (const FrameToCan& entry : entries) nanoseconds.push_back(entry.total().nanoseconds);
  return figures(std::move(nanoseconds));
}

}  // namespace glint
