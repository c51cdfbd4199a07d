// Selection of the inputs of a measurement, from their running number only.
//
// Of every twenty inputs, twelve are typical, four recorded, two worst and two searched. Blocks of
// twenty alternate between the largest limits and a cell's. A hash selects the halves, so that both
// halves contain every variant.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "platform/budget/measured_kernel.hpp"

namespace glint {

inline constexpr std::uint64_t k_inputs_in_turn = 20;
inline constexpr std::uint64_t k_limit_sets = 2;  // 0: Limits{}, 1: measured_cell_limits()

struct MeasuredInput {
  InputKind kind = InputKind::typical;
  std::uint64_t number = 0;  // among inputs of its kind and limits
  std::uint64_t limits = 0;
};

[[nodiscard]] constexpr std::string_view name_of(InputKind kind) {
  constexpr std::array<std::string_view, 4> names = {"typical", "recorded", "worst", "searched"};
  return names[static_cast<std::size_t>(kind)];
}

[[nodiscard]] constexpr MeasuredInput input_of(std::uint64_t running) {
  struct Share {
    InputKind kind;
    std::uint64_t slots;
  };
  constexpr std::array<Share, 4> shares = {Share{InputKind::typical, 12},
                                           {InputKind::recorded, 4},
                                           {InputKind::worst, 2},
                                           {InputKind::searched, 2}};
  const std::uint64_t turn = running / k_inputs_in_turn;
  std::uint64_t slot = running % k_inputs_in_turn;
  MeasuredInput input;
  input.limits = turn % k_limit_sets;
  for (const Share& share : shares) {
    if (slot < share.slots) {
      input.kind = share.kind;
      input.number = turn / k_limit_sets * share.slots + slot;
      return input;
    }
    slot -= share.slots;
  }
  return input;
}

// Returns whether the envelope is fitted on this input; it is judged on the others. Source:
// SplitMix64's finalizer, Steele, Lea, Flood 2014, fig. 14.
[[nodiscard]] constexpr bool is_in_fit_half(const MeasuredInput& input) {
  std::uint64_t bits = input.number * 8 + static_cast<std::uint64_t>(input.kind) * 2 + input.limits;
  bits += 0x9E3779B97F4A7C15u;
  bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9u;
  bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBu;
  return ((bits ^ (bits >> 31)) & 1u) == 0;
}

}  // namespace glint
