// What a rate group was given from outside at one release: all that a replay needs to decide alike.
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
  Time nominal;                  // the release as planned, never as it came
  std::array<std::uint64_t, k_recorded_versions> versions{};  // read of each Latest<>, in order
  std::uint8_t version_count = 0;                             // how many of them mean something
  graph::OverrunDecision overrun;                             // {}: there was none
  std::int64_t unix_offset_ns = 0;  // clock model at this release: + Time = ns since 1970 (UTC)

  bool operator==(const ChoiceRecord&) const = default;
};

}  // namespace glint
