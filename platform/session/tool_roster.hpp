// Hands the tools that are there to the frame group, a new version at each change.
//
// A version says by itself which they are, so that a recording, which keeps the version that each
// frame was given, replays every change without holding the sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "graph/latest.hpp"
#include "platform/cells/cell.hpp"

namespace glint {

// The n-th set that was published, from 1 on, with these tools there.
[[nodiscard]] constexpr std::uint64_t tools_version(std::uint64_t number, ToolsPresent there) {
  return number << 16 | there;
}
// Recordings from before tools could change have version 1: all are there.
[[nodiscard]] constexpr ToolsPresent tools_in(std::uint64_t version) {
  return version >> 16 == 0 ? k_all_tools : static_cast<ToolsPresent>(version & 0xFFFF);
}

class ToolRoster {
 public:
  // `cell` outlives this.
  explicit ToolRoster(const Cell& cell);

  [[nodiscard]] graph::TripleBuffer<ToolSet>& published() noexcept { return published_; }

  // Publishes what the cell's changes say of this time, if it is not what holds already. To be
  // called by one thread, not a real-time one: later than the change by as much as it is called.
  void reach(Time now);

 private:
  void publish(ToolsPresent there, Time now);

  const Cell* cell_;
  graph::TripleBuffer<ToolSet> published_;
  std::uint64_t number_ = 0;
  std::size_t next_ = 0;
};

}  // namespace glint
