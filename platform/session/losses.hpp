// What a run lost on the way out, in words for its table, its JSON and its exit code.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/session/sink_outcome.hpp"

namespace glint {

struct Loss {
  std::string kind;         // of LossKind's names
  std::uint64_t count = 0;  // frames, messages or lines; 0: unknown
  std::string text;         // what was lost and why
};

// Empty: everything that was produced left and is on the disk, and what DDS wrote was received.
[[nodiscard]] std::vector<Loss> losses_of(const SinkOutcome& outcome);

// One line each: "lost, KIND: TEXT".
[[nodiscard]] std::vector<std::string> lines_of(const std::vector<Loss>& losses);

}  // namespace glint
