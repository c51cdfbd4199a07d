// Windows time stamps: 100 ns since 1601 (FILETIME), or since the device's start (QPC).
#pragma once

#include <algorithm>
#include <cstdint>

#include "kernels/units.hpp"

namespace glint {

inline constexpr std::uint64_t k_file_time_of_unix = 116'444'736'000'000'000;  // 1970 in FILETIME

// A counter since the start reaches this value after 369 years.
[[nodiscard]] constexpr bool is_file_time(std::uint64_t stamp) {
  return stamp >= k_file_time_of_unix;
}

// Returns the Unix time of a FILETIME; of other stamps the time since their origin.
[[nodiscard]] constexpr Time time_of_file_time(std::uint64_t stamp) {
  const std::uint64_t since = is_file_time(stamp) ? stamp - k_file_time_of_unix : stamp;
  return {static_cast<std::int64_t>(std::min<std::uint64_t>(since, INT64_MAX / 100)) * 100};
}

}  // namespace glint
