#include "platform/sinks/dds/input_access.hpp"

#include <numeric>

namespace glint {
namespace {

constexpr Duration k_window = milliseconds(1000);

using PerInput = std::array<std::uint64_t, k_dds_inputs>;

std::string counts_text(const char* heading, const PerInput& counts) {
  std::string text;
  for (std::size_t i = 0; i < k_dds_inputs; ++i) {
    if (counts[i] == 0) continue;
    text += (text.empty() ? std::string(heading) + ": " : ", ") + k_dds_input_names[i] + " " +
            std::to_string(counts[i]);
  }
  return text;
}

}  // namespace

std::uint64_t InputRefusals::total() const noexcept {
  const std::uint64_t first =
      std::accumulate(not_allowed.begin(), not_allowed.end(), std::uint64_t{0});
  return std::accumulate(too_fast.begin(), too_fast.end(), first);
}

std::string text_of(const InputRefusals& refusals) {
  const std::string not_allowed = counts_text("not allowed by the cell", refusals.not_allowed);
  const std::string too_fast = counts_text("too fast", refusals.too_fast);
  return not_allowed + (not_allowed.empty() || too_fast.empty() ? "" : "; ") + too_fast;
}

bool InputAccess::admits(DdsInput input, Time now) noexcept {
  const std::size_t i = index_of(input);
  if (!allowed_[input]) {
    not_allowed_[i].fetch_add(1, std::memory_order_relaxed);
    return false;
  }
  Window& window = windows_[i];
  if (now - window.start >= k_window) window = {now, 0};
  if (++window.messages <= k_rates_max[i]) return true;
  too_fast_[i].fetch_add(1, std::memory_order_relaxed);
  return false;
}

InputRefusals InputAccess::refusals() const noexcept {
  InputRefusals refusals;
  for (std::size_t i = 0; i < k_dds_inputs; ++i) {
    refusals.not_allowed[i] = not_allowed_[i].load(std::memory_order_relaxed);
    refusals.too_fast[i] = too_fast_[i].load(std::memory_order_relaxed);
  }
  return refusals;
}

}  // namespace glint
