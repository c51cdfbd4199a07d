// Measured communication delay between two cores.
#pragma once

#include <cstdint>

namespace glint::bench {

// Half the median round trip of a store between two cores. The caller runs on `from`.
[[nodiscard]] std::int64_t measured_core_delay_ns(int from, int to);

}  // namespace glint::bench
