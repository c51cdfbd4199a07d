// CLI11 validator for a number in a closed range; rejects nan. CLI::Range and CLI::PositiveNumber
// accept nan, as it is neither below nor above a limit.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace glint {

template <class Number>
[[nodiscard]] CLI::Validator in_range(Number low, Number high) {
  const std::string range = std::to_string(low) + " to " + std::to_string(high);
  return CLI::Validator(
      [low, high, range](std::string& given) -> std::string {
        Number value{};
        const bool is_number = CLI::detail::lexical_cast(given, value);
        if (is_number && value >= low && value <= high) return "";
        return "Value " + given + " not in range " + range;
      },
      "in [" + range + "]");
}

}  // namespace glint
