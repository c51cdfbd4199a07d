// The rate groups' numbers, and a release as the recording keeps it.
#pragma once

#include <cstdint>

#include "graph/rate_group.hpp"
#include "platform/record/choice_record.hpp"

namespace glint {

inline constexpr std::uint8_t k_frame_group = 0;
inline constexpr std::uint8_t k_tick_group = 1;

[[nodiscard]] ChoiceRecord as_record(const graph::Choice& choice, std::int64_t unix_offset_ns);

}  // namespace glint
