// How long it takes until one core sees what another has stored.
#pragma once

#include <cstdint>

namespace glint::bench {

// Half the median of a store's way there and back between two cores. The caller runs on `from`.
[[nodiscard]] std::int64_t measured_handover_ns(int from, int to);

}  // namespace glint::bench
