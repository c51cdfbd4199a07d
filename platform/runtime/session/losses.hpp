// Output losses of a run as text, for its table, its JSON and its exit code.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/runtime/session/sink_outcome.hpp"

namespace glint {

struct Loss {
  std::string kind;         // name of the LossKind, headset or OpenIGTLink
  std::uint64_t count = 0;  // frames, messages or lines; 0: unknown
  std::string text;         // what was lost and why
};

// Returns an empty list if all output left, is on the disk, and was received by DDS.
[[nodiscard]] std::vector<Loss> losses_of(const SinkOutcome& outcome);

// One line per loss: "lost, KIND: TEXT".
[[nodiscard]] std::vector<std::string> lines_of(const std::vector<Loss>& losses);

}  // namespace glint
