// Record of a rate group's external inputs at one release: all that a replay needs for equal
// decisions.
#pragma once

#include <array>
#include <cstdint>

#include "graph/overrun.hpp"
#include "kernels/units.hpp"

namespace glint {

inline constexpr int k_recorded_versions = 4;  // Latest<> inputs of one group, at most

struct ChoiceRecord {
  std::uint8_t group = 0;
  std::uint64_t activation = 0;  // counts from 1
  Time nominal;                  // the planned release, never the actual one
  std::array<std::uint64_t, k_recorded_versions> versions{};  // read of each Latest<>, in order
  std::uint8_t version_count = 0;                             // number of valid entries in versions
  graph::OverrunDecision overrun;                             // {}: none
  std::int64_t unix_offset_ns = 0;  // clock model at this release: + Time = ns since 1970 (UTC)

  bool operator==(const ChoiceRecord&) const = default;
};

}  // namespace glint
