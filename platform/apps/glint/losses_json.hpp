// Losses of a recording as JSON, for --json.
#pragma once

#include <nlohmann/json.hpp>

#include "platform/sinks/record/recording_reader.hpp"

namespace glint {

[[nodiscard]] inline nlohmann::ordered_json losses_json(const RecordingLosses& losses) {
  return {{"frames", losses.frames},
          {"messages", losses.messages},
          {"bytes", losses.bytes},
          {"damaged_chunks", losses.chunks},
          {"at_least", losses.at_least}};
}

}  // namespace glint
