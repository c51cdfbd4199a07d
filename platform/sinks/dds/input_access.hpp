// Access control of the DDS inputs: a message is used only if the cell allows its input by name and
// the input's rate is not exceeded. Refused messages are counted by input.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "kernels/units.hpp"
#include "platform/cells/dds_input.hpp"

namespace glint {

// Numbers of messages.
struct InputRefusals {
  std::array<std::uint64_t, k_dds_inputs> not_allowed{}, too_fast{};
  [[nodiscard]] std::uint64_t total() const noexcept;
};

// "not allowed by the cell: buttons 3; too fast: tools 2"; empty without a refusal.
[[nodiscard]] std::string text_of(const InputRefusals& refusals);

class InputAccess {
 public:
  // Largest number of messages a second: a driver's fastest, or a person's.
  static constexpr std::array<int, k_dds_inputs> k_rates_max{2000, 10, 20, 400, 20};

  explicit InputAccess(const AllowedInputs& allowed) : allowed_(allowed) {}

  // From one thread. Returns whether a message that arrives now is used; counts it otherwise.
  [[nodiscard]] bool admits(DdsInput input, Time now) noexcept;

  // From any thread.
  [[nodiscard]] InputRefusals refusals() const noexcept;

 private:
  struct Window {
    Time start;
    int messages = 0;
  };

  AllowedInputs allowed_;
  std::array<Window, k_dds_inputs> windows_{};
  std::array<std::atomic<std::uint64_t>, k_dds_inputs> not_allowed_{}, too_fast_{};
};

}  // namespace glint
