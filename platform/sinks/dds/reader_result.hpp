// Result of the DDS reader process, and its JSON file.
#pragma once

#include <cstdint>
#include <string>

namespace glint {

struct ReaderResult {
  std::uint64_t received = 0;        // status messages
  std::uint64_t missed = 0;          // from gaps in the tick stamps
  std::uint64_t poses_received = 0;  // PoseStamped messages
  std::uint64_t poses_expected = 0;  // status messages that state a pose
  std::uint64_t first_tick = 0;      // tick numbers of the first and last status message
  std::uint64_t last_tick = 0;
  std::uint32_t streams = 0;        // requested tools
  std::uint32_t streams_ended = 0;  // tools whose end of stream was received
  // Latency: Unix time of receiving a status minus its tick's; p50 and p99 to 10 us, up to 1 s.
  double latency_p50_us = 0;
  double latency_p99_us = 0;
  double latency_max_us = 0;
};

// Writes a temporary file beside it, then renames it. Throws InputError.
void save_result(const ReaderResult& result, const std::string& file);
// Throws InputError if the file does not exist or is not a reader's result.
[[nodiscard]] ReaderResult load_result(const std::string& file);

}  // namespace glint
