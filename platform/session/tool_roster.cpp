#include "platform/session/tool_roster.hpp"

namespace glint {

ToolRoster::ToolRoster(const Cell& cell) : cell_(&cell) { publish(cell.tools_at_start, Time{}); }

void ToolRoster::reach(Time now) {
  const std::size_t before = next_;
  while (next_ < cell_->tool_changes.size() && cell_->tool_changes[next_].at <= now) ++next_;
  if (next_ > before) publish(cell_->tool_changes[next_ - 1].now_there, now);
}

void ToolRoster::publish(ToolsPresent there, Time now) {
  published_.write_slot() = tools_present(cell_->tools, there);
  published_.publish(tools_version(++number_, there), now.nanoseconds);
}

}  // namespace glint
