// Hands the tools that are there to the frame group, a new version at each change.
//
// A version says by itself which they are, so that a recording, which keeps the version that each
// frame was given, replays every change without holding the sets.
#pragma once

#include <cstddef>
#include <cstdint>

#include "graph/latest.hpp"
#include "platform/cells/cell.hpp"
#include "platform/session/tool_requests.hpp"

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
  // Both outlive this; `requests` may be null.
  explicit ToolRoster(const Cell& cell, ToolRequests* requests = nullptr);

  [[nodiscard]] graph::TripleBuffer<ToolSet>& published() noexcept { return published_; }

  // Publishes what the cell's changes say of this time and what was asked for, if it is not what
  // holds already. To be called by one thread, not a real-time one: later than the change by as
  // much as it is called. A change of the cell touches the tools that it names, no others.
  void reach(Time now);

 private:
  void publish(ToolsPresent there, Time now);

  const Cell* cell_;
  graph::TripleBuffer<ToolSet> published_;
  ToolRequests* requests_;
  std::uint64_t number_ = 0;
  std::size_t next_ = 0;
  ToolsPresent planned_, there_;
};

}  // namespace glint
