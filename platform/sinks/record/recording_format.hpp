// Metadata names of a recording and the content of each level, shared by writer and reader.
#pragma once

#include "platform/sinks/record/recording.hpp"

namespace glint {

inline constexpr int k_recording_format = 1;  // incremented if old readers would misread

inline constexpr const char* k_opening_metadata = "glint";
inline constexpr const char* k_fact_format = "format";
inline constexpr const char* k_fact_level = "level";
inline constexpr const char* k_fact_nominal_tick = "nominal_tick_ns";
inline constexpr const char* k_fact_unix_offset = "unix_offset_ns";

inline constexpr const char* k_closing_metadata = "glint_end";
inline constexpr const char* k_fact_complete = "complete";
inline constexpr const char* k_fact_dropped = "dropped";
inline constexpr const char* k_fact_ended_early = "ended_early";  // reason; empty: it did not
inline constexpr const char* k_fact_output_sha256 = "output_sha256";

[[nodiscard]] constexpr bool records_frames(RecordingLevel level) {
  return level == RecordingLevel::full || level == RecordingLevel::roi;
}
[[nodiscard]] constexpr bool records_inputs(RecordingLevel level) {
  return level != RecordingLevel::outputs;
}

}  // namespace glint
